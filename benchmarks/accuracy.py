"""Every exact factor of reflectance in float64 against the printed formula at more than 50 digits.

`python benchmarks/accuracy.py [PLACES] [NAME ...]`: PLACES random places of each kind (20 000 unless given), of the
factors with one of the NAMEs in theirs. `ratfit.lower` evaluates the factor on NumPy arrays, `textbook.py` the formula
of the source in balls of 512 bits; a ball of less than 50 digits ends the run. A line says how often a value is within
4 ulp (`numpy.spacing` of the exact value), and the worst, in ulp and in units of 2^-52 of the exact value.

Places (`places.py`): `0..1` is drawn evenly, `10^(-2..0)` evenly in the logarithm, `away` is from the critical angle
and without total reflection. Of x the cosine is made: x is tan/alpha in the lobe of a fraction, the exponent of an
exponential or of a power; y is a share of the way from one end to the other.

Left out: what is kept as it is misprinted, `schlick_clamped` and `separable`, which add nothing to others, and the
integrals of Smoothie's distribution and of the azimuth's factor.
"""

import sys
from collections.abc import Callable, Iterator, Sequence
from types import ModuleType

import flint
import numpy as np
import places as at
import sympy as sp
import textbook as book
from flint import arb

import ratfit as rf
from ratfit.brdf import distribution, fresnel, masking

BITS, FIFTY_DIGITS = 512, 167

Row = tuple[ModuleType, str, Callable[..., arb], Sequence[at.Kind]]

FACTORS: list[Row] = [
    (fresnel, "conductor", book.conductor, at.CONDUCTOR),
    (fresnel, "dielectric", book.dielectric, at.DIELECTRIC),
    (fresnel, "normal", book.normal, at.NORMAL),
    (fresnel, "index", book.index, at.REFLECTANCE),
    (fresnel, "lazanyi", book.lazanyi, at.NORMAL_SCHLICK),
    (fresnel, "schlick", book.fresnel_schlick, at.POWER),
    (fresnel, "spectral", book.spectral, at.SPECTRAL),
    (fresnel, "spherical_gaussian", book.spherical_gaussian, at.EXPONENTIAL),
    (fresnel, "karis", book.karis, at.EXPONENTIAL),
    (fresnel, "smoothie", book.fresnel_smoothie, at.EXPONENTIAL),
    (distribution, "ggx", book.ggx, at.ROUND),
    (distribution, "ggx_anisotropic", book.ggx_anisotropic, at.ELLIPTICAL),
    (distribution, "zenith", book.zenith, at.ZENITH),
    (distribution, "azimuth", book.azimuth, at.AZIMUTH),
    (distribution, "schlick", book.distribution_schlick, at.SCHLICK),
    (distribution, "beckmann_rational", book.beckmann_rational, at.FOOTED),
    (distribution, "smoothie", book.distribution_smoothie, at.ROUND),
    (distribution, "beckmann", book.beckmann, at.GAUSSIAN),
    (distribution, "ward", book.ward, at.ELLIPTICAL_GAUSSIAN),
    (distribution, "phong", book.phong, at.PHONG),
    (distribution, "blinn", book.blinn, at.BLINN),
    (masking, "smith", book.smith, at.MASKING_M),
    (masking, "smith_as_printed", book.smith_as_printed, at.MASKING_M),
    (masking, "beckmann", book.masking_beckmann, at.MASKING),
    (masking, "beckmann_correlated", book.beckmann_correlated, at.CORRELATED),
    (masking, "beckmann_lambda", book.beckmann_lambda, at.HIDDEN),
    (masking, "beckmann_rational", book.masking_beckmann_rational, at.MASKING),
    (masking, "phong", book.masking_phong, at.MASKING_EXPONENT),
    (masking, "ggx", book.masking_ggx, at.MASKING),
    (masking, "ggx_correlated", book.ggx_correlated, at.CORRELATED),
    (masking, "ggx_lambda", book.ggx_lambda, at.MASKING),
    (masking, "schlick", book.masking_schlick, at.MASKING_M),
    (masking, "schlick_roughness", book.schlick_roughness, at.MASKING_R),
    (masking, "torrance_sparrow", book.torrance_sparrow, at.GROOVES),
    (masking, "kelemen", book.kelemen, at.KELEMEN),
    (masking, "kelemen_visibility", book.kelemen_visibility, at.VISIBILITY),
    (masking, "implicit", book.implicit, at.PRODUCT),
]


def main() -> None:
    count = int(float(sys.argv[1])) if sys.argv[1:] else 20_000
    print(f"{'factor':33}{'places':54}{'number':>8}{'<= 4 ulp':>12}{'worst ulp':>11}{'in 2^-52':>10}")
    for room, name, formula, kinds in FACTORS:
        factor = f"{room.__name__.rpartition('.')[2]}.{name}"
        if not sys.argv[2:] or any(part in factor for part in sys.argv[2:]):
            arguments = sp.symbols(f"x:{len(kinds[0].draw(1))}", real=True)
            function = rf.lower(getattr(room, name)(*arguments), arguments)
            for kind in kinds:
                print(line(factor, kind, function, formula, count), flush=True)


def line(factor: str, kind: at.Kind, function: Callable[..., at.Array], formula: Callable[..., arb], count: int) -> str:
    columns = kind.draw(count)
    off, exact = np.array(list(differences(formula, columns, function(*columns)))).T
    ulp, units = off / np.spacing(exact), off / exact * 2.0**52
    share = f"{100 * np.mean(ulp <= 4):.4f} %"
    return f"{factor:33}{kind!s:54}{len(ulp):8}{share:>12}{ulp.max():11.2f}{units.max():10.2f}"


def differences(formula: Callable[..., arb], columns: at.Columns, found: at.Array) -> Iterator[tuple[float, float]]:
    """Of each place how far the value is from the exact one, and that; both are rounded only here."""
    with flint.ctx.workprec(BITS):
        for *place, value in zip(*(column.tolist() for column in columns), found.tolist(), strict=True):
            exact = formula(*map(arb, place))
            if exact.rel_accuracy_bits() < FIFTY_DIGITS:
                sys.exit(f"the formula of the source has lost its digits at {place}: raise BITS")
            yield float(abs(arb(value) - exact)), float(exact)


if __name__ == "__main__":
    main()
