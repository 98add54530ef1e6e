"""docs/reflectance.md: its tables name functions that exist with their arguments; its example gives its numbers."""

import inspect
import math
import re
from pathlib import Path

import numpy as np
import pytest
import sympy as sp

from ratfit import brdf
from ratfit._lower import lower

PAGE = Path(__file__).parents[1] / "docs" / "reflectance.md"
SECTIONS = {re.search(r"`brdf\.(\w+)`", part)[1]: part for part in PAGE.read_text().split("\n## ")[1:]}


@pytest.mark.parametrize("module", SECTIONS)
def test_the_tables_name_functions_with_their_arguments(module):
    for name, arguments in re.findall(r"`(\w+)\(([^`]*)\)`", SECTIONS[module]):
        function = getattr(getattr(brdf, module), name)
        known = inspect.signature(function).parameters
        needed = [each.name for each in known.values() if each.default is inspect.Parameter.empty]
        said = arguments.split(", ")
        assert said == [*known][: len(said)] and len(said) >= len(needed), name


@pytest.mark.parametrize("module", ["fresnel", "distribution", "masking"])
def test_no_right_formula_is_left_out(module):
    room = getattr(brdf, module)
    functions = {name: each for name, each in vars(room).items() if inspect.isfunction(each)}
    own = {name for name, each in functions.items() if each.__module__.startswith(room.__name__)}
    derived = {"kelemen_visibility", "azimuth_as_printed_mean"}
    right = {name for name in own - derived if not name.startswith("_") and not name.endswith("_as_printed")}
    assert {name for name in right if f"`{name}" not in SECTIONS[module]} == set()


def test_the_example_gives_its_numbers():
    """The Fresnel factor by complex refraction, GGX and its Lambda by hand, at the cosines 1, 0.8, 0.8, 0.8."""
    eta, kappa = brdf.metals.material("gold").at(sp.Rational("0.6168"))
    squared = complex(eta, kappa) ** 2
    bent = np.sqrt(squared - 1 + 0.64)
    across, along = abs((0.8 - bent) / (0.8 + bent)) ** 2, abs((squared * 0.8 - bent) / (squared * 0.8 + bent)) ** 2
    hidden = (math.sqrt(1 + 0.09 * 0.36 / 0.64) - 1) / 2
    expected = (across + along) / 2 / (math.pi * 0.09) / (1 + 2 * hidden) / (4 * 0.64)

    t, u, v, v_prime = sp.symbols("t u v v_prime")
    alpha = sp.Rational(3, 10)
    product = brdf.distribution.ggx(t, alpha) * brdf.fresnel.conductor(u, eta, kappa)
    product *= brdf.masking.ggx_correlated(v, v_prime, alpha) / (4 * v * v_prime)
    found = lower(product, (t, u, v, v_prime))(1.0, 0.8, 0.8, 0.8)
    assert found == pytest.approx(expected, rel=1e-14)
    assert float(re.search(r"N @ L\) +# ([\d.]+)", PAGE.read_text())[1]) == pytest.approx(found, rel=1e-15)

    a = 0.5 / (0.3 * math.sqrt(0.75))
    g = a * math.sqrt(math.pi) * (1 + math.erf(a))
    printed = float(re.search(r"evalf\(20\) +# ([\d.]+)", PAGE.read_text())[1])
    assert printed == pytest.approx(g / (g + math.exp(-a * a)), rel=1e-14)
