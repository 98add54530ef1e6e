"""Importance sampling on arrays: random pairs become directions of light, drawn as a lobe reflects."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import sympy as sp

from ratfit._lower import lower
from ratfit._parse import RatfitError, named_in
from ratfit._target import Parameter, parameter
from ratfit.brdf import distribution, roughness, sampling
from ratfit.models import named as model_named
from ratfit.models._model import Formula, Model
from ratfit.models.directions import SINE2, V_PRIME, T, U, W, as_directions, library, traced

A, B = (parameter(name, 0, 1) for name in ("a", "b"))
"""The two uniform numbers that the formulas of a sampler are written in, beside its parameters."""

ALPHA = parameter("alpha", "1/10000", 1)
EXPONENT = parameter("exponent", 0, 1_000_000)
ROUGHNESS = parameter("roughness", "1/100", 1)
M, N = (parameter(name, "1/100", 1) for name in ("m", "n"))
R, P = parameter("r", "1/1000000", 1), parameter("p", "1/1000", 1)


@dataclass(frozen=True)
class Sampler:
    """How a direction is drawn from a pair of uniform numbers, and its density per steradian of the light.

    `cosine`, `sine` (of the angle to the normal) and `azimuth` (against the tangent) are formulas of `A`, `B` and
    parameters, of the half vector or, where not `is_half`, of the light itself. `pdf` is the density as a formula of
    the model's letters: written without these, so that one may be tested by the other.
    """

    name: str
    cosine: sp.Expr
    sine: sp.Expr
    azimuth: sp.Expr
    pdf: Model
    is_half: bool = True

    def sample(self, view: Any, pair: Any, **values: Any) -> Any:
        """Directions of light for views.

        **Arguments:** `view`, directions of shape (..., 3); `pair`, uniform numbers in [0, 1) of shape (..., 2); NumPy
        or JAX, traced too; `values`, the sampler's parameters by name.

        **Returns** unit directions. Some are below the horizon: they are part of the density's whole and carry nothing.
        **Fails** with `RatfitError` for other shapes, for numbers outside [0, 1] (not inside a transformation of JAX,
        which has no numbers to look at), and for a parameter that is unknown or outside its range.
        """
        view, pair = as_directions(view, "view"), _pairs(pair)
        known = self.pdf.settings(values)
        backend, numpy = library(view, pair, *known.values())
        a, b = numpy.asarray(pair[..., 0]), numpy.asarray(pair[..., 1])
        arguments = [A, B, *self.pdf.parameters]
        typed = [numpy.asarray(known[p.name], pair.dtype) for p in self.pdf.parameters]
        cosine, sine, azimuth = (
            lower(formula, arguments, backend)(a, b, *typed) for formula in (self.cosine, self.sine, self.azimuth)
        )
        across, cosine = numpy.broadcast_arrays(azimuth, cosine)
        drawn = numpy.stack([sine * numpy.cos(across), sine * numpy.sin(across), cosine], axis=-1)
        if not self.is_half:
            return drawn + numpy.zeros_like(view)
        return 2 * numpy.sum(view * drawn, axis=-1, keepdims=True) * drawn - view

    def density(self, view: Any, light: Any, **values: Any) -> Any:
        """The density of the light per steradian for that view; 0 below the horizon, where light carries nothing."""
        return self.pdf(view, light, **values)


@dataclass(frozen=True)
class Blend:
    """Several samplers in equal shares: its density is nowhere far below that of the best of them.

    Each has the parameters that are stated with it, and the others from the values that the methods are given.
    """

    parts: Sequence[tuple[Sampler, Mapping[str, float]]] = field(default_factory=tuple)

    def sample(self, view: Any, pair: Any, **values: Any) -> Any:
        """As `Sampler.sample`. The first number says which part draws, and what is left of it is used again."""
        view, pair = as_directions(view, "view"), _pairs(pair)
        _, numpy = library(view, pair)
        scaled = pair[..., 0] * len(self.parts)
        whole = numpy.minimum(numpy.floor(scaled), len(self.parts) - 1)
        inside = numpy.stack([scaled - whole, pair[..., 1]], axis=-1)
        drawn = [sampler.sample(view, inside, **_own(sampler, stated, values)) for sampler, stated in self.parts]
        return sum(numpy.where((whole == k)[..., None], light, 0) for k, light in enumerate(drawn))

    def density(self, view: Any, light: Any, **values: Any) -> Any:
        densities = (s.density(view, light, **_own(s, stated, values)) for s, stated in self.parts)
        return sum(densities) / len(self.parts)

    def weight(self, model: str | Model, view: Any, light: Any, **values: Any) -> Any:
        """As the function `weight`; the mean of the weights is the albedo."""
        return weight(self, model, view, light, **values)


def weight(sampler: str | Sampler | Blend, model: str | Model, view: Any, light: Any, **values: Any) -> Any:
    """What a sample counts: a model's reflectance times the cosine to the light over a sampler's density.

    0 below the horizon. **Arguments:** a sampler and a model, or their names; `values`, the model's parameters; the
    sampler takes those it has by name.
    """
    model, view, light = model_named(model), as_directions(view, "view"), as_directions(light, "light")
    density = as_blend(sampler).density(view, light, **values)
    value = model(view, light, **values)
    _, numpy = library(density, value)
    drawn = density > 0
    return numpy.where(drawn, value * light[..., 2] / numpy.where(drawn, density, 1), 0).astype(value.dtype)


def _own(sampler: Sampler, stated: Mapping[str, float], values: Mapping[str, Any]) -> dict[str, Any]:
    """A part's own parameters, within its range: a lobe beyond what it can draw is drawn as the last one it can."""
    held = {}
    for p in (p for p in sampler.pdf.parameters if p.name in values):
        _, numpy = library(values[p.name])
        held[p.name] = numpy.clip(values[p.name], float(p.low), float(p.high))
    return {**held, **stated}


def _pairs(given: Any) -> Any:
    """An array of pairs of numbers in [0, 1]. **Fails** with `RatfitError` for another shape and for others."""
    _, numpy = library(given)
    array = numpy.asarray(given)
    if array.ndim == 0 or array.shape[-1] != 2 or not numpy.issubdtype(array.dtype, numpy.floating):
        raise RatfitError(f"a random pair of the shape {array.shape}: two uniform floats are needed, shape (..., 2)")
    if not traced(array) and not bool(numpy.all((array >= 0) & (array <= 1))):
        raise RatfitError("a random pair has a number outside [0, 1]: draw both uniformly from there")
    return array


def _density(name: str, formula: Formula, defaults: Mapping[Parameter, float], source: str) -> Model:
    named = {p.name: value for p, value in defaults.items()}
    return Model(name, f"density of the sampler {name}", formula, tuple(defaults), source, named)


def _facets(
    name: str,
    angles: tuple[sp.Expr, sp.Expr],
    azimuth: sp.Expr,
    facets: Callable[[], sp.Expr],
    defaults: Mapping[Parameter, float],
    source: str,
) -> Sampler:
    """A sampler of half vectors: cosine and sine, azimuth, and the distribution they are drawn from."""
    pdf = _density(name, lambda: sampling.light_density(facets(), T, U), defaults, source)
    return Sampler(name, *angles, azimuth, pdf)


def _ggx(alpha: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    return sampling.ggx_cosine(A, alpha), sampling.ggx_sine(A, alpha)


def _beckmann(alpha: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    return sampling.beckmann_cosine(A, alpha), sampling.beckmann_sine(A, alpha)


def _phong(n: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    return sampling.phong_cosine(A, n), sampling.phong_sine(A, n)


def _printed_azimuth(b: sp.Expr, p: sp.Expr) -> sp.Expr:
    """The azimuth in print, drawn in one quadrant, in all four: each quarter of b turns or mirrors it."""
    quarter = sp.Min(sp.floor(4 * b), 3)
    first = sampling.azimuth_as_printed(4 * b - quarter, p)
    return quarter * sp.pi / 2 + sp.Piecewise((first, sp.Eq(quarter, 0) | sp.Eq(quarter, 2)), (sp.pi / 2 - first, True))


ROUND = sampling.uniform_azimuth(B)
ELLIPSE = sp.atan2(sp.sin(2 * sp.pi * B), M / N * sp.cos(2 * sp.pi * B))
"""`sampling.full_azimuth` without its limit, which m does not come near: its cosine goes into a condition."""

WIDE = roughness.alpha_from_perceived(ROUGHNESS)

COSINE = Sampler(
    "cosine", sampling.cosine_cosine(A), sampling.cosine_sine(A), ROUND,
    _density("cosine", sampling.cosine_density(V_PRIME), {}, "schlick1994, Eq. 8"), is_half=False,
)  # fmt: skip
GGX = _facets(
    "ggx", _ggx(ALPHA), ROUND, lambda: distribution.ggx(T, ALPHA, SINE2), {ALPHA: 0.3}, "walter2007, Eqs. 35 and 36"
)

SAMPLERS: Mapping[str, Sampler] = MappingProxyType(
    {
        sampler.name: sampler
        for sampler in (
            COSINE,
            GGX,
            _facets("beckmann", _beckmann(ALPHA), ROUND,
                    lambda: distribution.beckmann(T, ALPHA, SINE2), {ALPHA: 0.3}, "walter2007, Eqs. 28 and 29"),
            _facets("phong", _phong(EXPONENT), ROUND,
                    lambda: distribution.phong(T, EXPONENT), {EXPONENT: 20.0}, "walter2007, Eqs. 31 and 32"),
            _facets("blinn", _phong(2 / ALPHA**2 - 2), ROUND,
                    lambda: distribution.blinn(T, ALPHA), {ALPHA: 0.3}, "polimi2024, D; walter2007, Eq. 31"),
            _facets("ward", _beckmann(roughness.alpha_at(sp.cos(ELLIPSE), M, N)), ELLIPSE,
                    lambda: distribution.ward(T, W, M, N, SINE2), {M: 0.15, N: 0.4}, "ward1992"),
            _facets("smoothie", _ggx(roughness.ggx_from_wide(WIDE)), ROUND,
                    lambda: distribution.smoothie(T, WIDE, SINE2), {ROUGHNESS: 0.4}, "smoothie; walter2007, Eq. 35"),
            _facets("schlick", _ggx(sp.sqrt(R)), sampling.full_azimuth(B, P),
                    lambda: distribution.schlick(T, W, R, P, SINE2), {R: 0.3, P: 0.5},
                    "schlick1994, Eq. 29, the azimuth corrected"),
            _facets("schlick-as-printed", _ggx(sp.sqrt(R)), _printed_azimuth(B, P),
                    lambda: distribution.schlick_as_printed(T, W, R, P, SINE2), {R: 0.3, P: 0.5},
                    "schlick1994, Eq. 29"),
        )
    }
)  # fmt: skip
"""Every sampler by its name; the one in print draws neither A that schlick1994 could mean."""

ANY = Blend(((COSINE, {}), *((GGX, {"alpha": alpha}) for alpha in (0.3, 0.03, 0.003))))
"""Draws for any model, as a diffuse surface and as facets of three roughnesses would."""


def named(sampler: str | Sampler) -> Sampler:
    """The sampler of that name; a sampler is itself. **Fails** with `RatfitError`, which says the nearest names."""
    if isinstance(sampler, Sampler):
        return sampler
    return named_in(SAMPLERS, sampler, "sampler", "ratfit.models.samplers.SAMPLERS")


def as_blend(sampler: str | Sampler | Blend) -> Blend:
    """A sampler, or that of the name, as a blend of it alone; a blend is itself."""
    return sampler if isinstance(sampler, Blend) else Blend(((named(sampler), {}),))


def sampler_for(model: str | Model) -> Blend:
    """The model's own sampler and the cosine in equal shares; `ANY` for a model that has none."""
    own = model_named(model).sampler
    return ANY if own is None else Blend(((COSINE, {}), (named(own), {})))
