"""Where `accuracy.py` looks at each factor: kinds of places, as ranges and what is made of what is drawn from them."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

SEED = 1994

Array = np.ndarray[Any, Any]
Columns = tuple[Array, ...]


@dataclass(frozen=True)
class Even:
    low: float
    high: float

    def draw(self, random: np.random.Generator, count: int) -> Array:
        return random.uniform(self.low, self.high, count)

    def __str__(self) -> str:
        return f"{self.low:g}" if self.low == self.high else f"{self.low:g}..{self.high:g}"


@dataclass(frozen=True)
class Powers:
    """Ten to a power that is drawn evenly."""

    low: float
    high: float

    def draw(self, random: np.random.Generator, count: int) -> Array:
        return 10 ** random.uniform(self.low, self.high, count)

    def __str__(self) -> str:
        return f"10^({self.low:g}..{self.high:g})"


@dataclass(frozen=True)
class Kind:
    """What is drawn, the factor's arguments that are made of it, and which of these places are kept."""

    ranges: Mapping[str, Even | Powers]
    made: Callable[..., Columns] | None = None
    kept: Callable[..., Array] | None = None

    def draw(self, count: int) -> Columns:
        random = np.random.default_rng(SEED)
        drawn = tuple(each.draw(random, count) for each in self.ranges.values())
        places = self.made(*drawn) if self.made else drawn
        return tuple(column[self.kept(*places)] for column in places) if self.kept else places

    def __str__(self) -> str:
        ranges = ", ".join(f"{name} {each}" for name, each in self.ranges.items())
        return f"{ranges}, {self.kept.__name__}" if self.kept else ranges


UNIT, NONE = Even(0, 1), Even(0, 0)

# Fresnel


def away(u: Array, eta: Array, kappa: Array | float = 0) -> Array:
    """From the critical angle, |w| > 0.45, and not reflected totally."""
    square = (eta + 1j * kappa) ** 2 - 1 + u * u
    return (np.abs(square) > 0.45**2) & ((square.real > 0) | (np.asarray(kappa) > 0))


def above_normal(y: Array, average_normal: Array, f: Array) -> Columns:
    return average_normal + y * (1 - average_normal), average_normal, f


_GLASS = {"u": UNIT, "eta": Even(1.05, 10)}
_INSIDE = {"u": UNIT, "eta": Even(0.5, 0.95)}
_NEARLY_NOTHING = {"u": Even(0.01, 1), "eta": Even(1 + 1e-6, 1.05)}
_INDICES = [
    (Even(0.02, 10), Even(1, 20)), (Even(1.5, 10), UNIT), (Even(1, 1.5), UNIT), (Even(0.02, 1), UNIT)
]  # fmt: skip

DIELECTRIC = [Kind(_GLASS), Kind(_INSIDE, kept=away), Kind(_NEARLY_NOTHING)]
CONDUCTOR = [Kind({"u": UNIT, "eta": eta, "kappa": kappa}, kept=away) for eta, kappa in _INDICES]
CONDUCTOR += [Kind(_GLASS | {"kappa": NONE}), Kind(_INSIDE | {"kappa": NONE}, kept=away)]
CONDUCTOR += [Kind(_NEARLY_NOTHING | {"kappa": Even(0, 1e-3)})]
NORMAL = [Kind({"eta": Even(0.02, 10), "kappa": kappa}) for kappa in (NONE, Even(0, 10))]
NORMAL_SCHLICK = [Kind({"u": UNIT, "eta": Even(0.02, 10), "kappa": Even(0, 10)})]
SPECTRAL = [Kind({"y": UNIT, "average_normal": UNIT, "f": UNIT}, above_normal)]
REFLECTANCE = [Kind({"f": UNIT})]
POWER = [Kind({"u": UNIT, "f": f}) for f in (NONE, UNIT)]
_QUARTERS = [Even(0, 0.25), Even(0.25, 0.5), Even(0.5, 0.75), Even(0.75, 1)]
EXPONENTIAL = [Kind({"u": u, "f": NONE}) for u in _QUARTERS] + [Kind({"u": UNIT, "f": Even(0.01, 1)})]

# Distributions


def at_slope(x: Array, *rough: Array) -> Columns:
    """tan = x alpha."""
    return 1 / np.sqrt(1 + (x * rough[0]) ** 2), *rough


def at_slope_of_root(x: Array, *rough: Array) -> Columns:
    """The same of a roughness that is the square of alpha, with an azimuth before it or not."""
    return 1 / np.sqrt(1 + x**2 * rough[-1]), *rough


def at_exponent(x: Array, alpha: Array) -> Columns:
    """tan^2/alpha^2 = x."""
    return at_slope(np.sqrt(x), alpha)


def at_elliptical_slope(x: Array, w: Array, m: Array, n: Array) -> Columns:
    return 1 / np.sqrt(1 + x**2 / ((w / m) ** 2 + (1 - w**2) / n**2)), w, m, n


def at_elliptical_exponent(x: Array, w: Array, m: Array, n: Array) -> Columns:
    return at_elliptical_slope(np.sqrt(x), w, m, n)


def schlick_lobe(x: Array, w: Array, r: Array, p: Array) -> Columns:
    return 1 / np.sqrt(1 + x**2 * r), w, r, p


def phong_lobe(x: Array, n: Array) -> Columns:
    """t^n = exp(-x)."""
    return np.exp(-x / n), n


def blinn_lobe(x: Array, rho: Array) -> Columns:
    return np.exp(-x / (2 / rho**2 - 2)), rho


def above_foot(y: Array, m: Array) -> Columns:
    """Between the foot of the fraction, t = 1 - m, and its peak."""
    return 1 - m * y, m


_ROUGH, _TO_ONE, _SLOPES = Powers(-2, 0.3), Powers(-2, 0), Powers(-2, 1)
_EXPONENTS = [Even(0, 1), Even(1, 4), Even(4, 16), Even(16, 64), Even(64, 600)]
_TWO = {"w": UNIT, "m": _ROUGH, "n": _ROUGH}

ROUND = [Kind({"t": UNIT, "alpha": _ROUGH}), Kind({"x": _SLOPES, "alpha": _ROUGH}, at_slope)]
ELLIPTICAL = [Kind({"t": UNIT} | _TWO), Kind({"x": _SLOPES} | _TWO, at_elliptical_slope)]
ZENITH = [Kind({"t": UNIT, "r": _TO_ONE}), Kind({"x": _SLOPES, "r": _TO_ONE}, at_slope_of_root)]
AZIMUTH = [Kind({"w": UNIT, "p": _TO_ONE})]
_SCHLICK = {"w": UNIT, "r": _TO_ONE, "p": _TO_ONE}
SCHLICK = [Kind({"t": UNIT} | _SCHLICK), Kind({"x": _SLOPES} | _SCHLICK, schlick_lobe)]
GAUSSIAN = [Kind({"x": x, "alpha": _ROUGH}, at_exponent) for x in _EXPONENTS]
ELLIPTICAL_GAUSSIAN = [Kind({"x": x} | _TWO, at_elliptical_exponent) for x in _EXPONENTS]
PHONG = [Kind({"x": x, "n": Powers(0, 4)}, phong_lobe) for x in _EXPONENTS]
BLINN = [Kind({"x": x, "rho": Powers(-2, -0.2)}, blinn_lobe) for x in _EXPONENTS]
FOOTED = [Kind({"y": UNIT, "m": _TO_ONE}, above_foot)]

# Masking


def near_normal(away: Array, rough: Array) -> Columns:
    return 1 - away, rough


def at_cotangent(a: Array, alpha: Array) -> Columns:
    """cot = a alpha."""
    return a * alpha / np.sqrt(1 + (a * alpha) ** 2), alpha


def of_vectors(y: Array, v: Array, v_prime: Array) -> Columns:
    """u of unit vectors with the half vector's cosine at most 1: (v + v')/2 or more."""
    least = (v + v_prime) / 2
    return least + y * (1 - least), v, v_prime


def one_sided(letter: str, rough: Even | Powers) -> Sequence[Kind]:
    """The whole range, and near each of its ends."""
    near = Kind({"1 - v": Powers(-10, -1), letter: rough}, near_normal)
    return [Kind({"v": UNIT, letter: rough}), Kind({"v": Powers(-10, -1), letter: rough}), near]


_MASKS, _COSINES = Powers(-2.5, 0.3), {"v": UNIT, "v'": UNIT}

MASKING_M, MASKING = one_sided("m", _MASKS), one_sided("alpha", _MASKS)
MASKING_EXPONENT, MASKING_R = one_sided("exponent", Powers(-0.6, 5)), one_sided("r", UNIT)
CORRELATED = [Kind(_COSINES | {"alpha": _MASKS})]
HIDDEN = [Kind({"a": a, "alpha": _MASKS}, at_cotangent) for a in (Even(0, 0.5), Even(0.5, 2), Even(2, 5), Even(5, 10))]
GROOVES = [Kind({"t": UNIT, "u": UNIT} | _COSINES)]
PRODUCT = [Kind(_COSINES)]
KELEMEN = [Kind({"y": UNIT} | _COSINES, of_vectors)]
VISIBILITY = [Kind({"u": UNIT})]
