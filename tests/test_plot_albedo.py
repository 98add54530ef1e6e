"""The picture of a checked model: what its legend says, whole and within the picture."""

import numpy as np
import pytest

from ratfit.models import named
from ratfit.models.albedo import Albedo
from ratfit.models.check import Check
from ratfit.models.laws.energy import Brightest
from ratfit.plot.albedo import plot_albedo
from ratfit.plot.style import LETTERS

NAMES = ["C", "r_prime", "specular_threshold", "diffuse_threshold", "eta", "kappa", "alpha", "p", "q", "sigma"]


def checked(setting, name="lambert", azimuth=0.0):
    cosines = np.array([1.0, 0.5, 0.1])
    found = Albedo(cosines, np.full(3, 0.5), np.full(3, 0.01))
    return Check(named(name), {}, (), setting, found, found, Brightest(setting, azimuth, found, 40))


@pytest.mark.parametrize("count", [0, 1, 3, 6, 10])
def test_the_legend_has_every_value_whole(count):
    setting = {name: 10.0 ** -(k + 1) for k, name in enumerate(NAMES[:count])}
    figure = plot_albedo(checked(setting)).figure
    (axes,) = figure.axes
    line, worst, samples = (text.get_text() for text in axes.get_legend().get_texts())
    assert samples == "by samples, two standard deviations"
    for text, what in ((line, "albedo"), (worst, "brightest found")):
        lines = text.split("\n")
        assert all(len(each) <= LETTERS for each in lines)
        assert " ".join(lines) == what + ": " * bool(count) + ", ".join(f"{k} = {v:.3g}" for k, v in setting.items())
        for name, value in setting.items():
            assert sum(f"{name} = {value:.3g}" in each for each in lines) == 1


@pytest.mark.parametrize("count", [1, 10])
def test_the_legend_is_within_the_picture_and_takes_nothing_from_the_axes(count):
    figure = plot_albedo(checked(dict.fromkeys(NAMES[:count], 0.123))).figure
    figure.draw_without_rendering()
    (axes,) = figure.axes
    legend = axes.get_legend().get_window_extent()
    assert figure.bbox.x0 <= legend.x0 and legend.x1 <= figure.bbox.x1
    assert figure.bbox.y0 <= legend.y0 and legend.y1 < axes.get_window_extent().y0
    assert axes.get_window_extent().height / figure.dpi > 3.2  # inches, of the 4.2 without a legend


@pytest.mark.parametrize(("azimuth", "told"), [(0.0, ""), (np.pi / 2, "view's azimuth 90 degrees, ")])
def test_the_legend_says_the_azimuth_of_the_brightest_view(azimuth, told):
    (axes,) = plot_albedo(checked({"r": 0.5}, azimuth=azimuth)).figure.axes
    line, worst, _ = (text.get_text() for text in axes.get_legend().get_texts())
    assert line == "albedo: r = 0.5" and worst.replace("\n", " ") == f"brightest found: {told}r = 0.5"
