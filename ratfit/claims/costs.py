"""What models and formulas cost, where the slides and the smoothie article compare them, in operations.

No source names a machine. So operations are counted, each shared part once, with the weights that
`ratfit bench --backend cost-model` has for them.
"""

from __future__ import annotations

import sympy as sp

from ratfit.brdf import masking
from ratfit.claims._agreement import Above, AtMost, Below, Between
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._models import V_PRIME, U, V, made
from ratfit.claims.highlights import operations

LIGHT, VIEW, NORMAL = (sp.Matrix(sp.symbols(f"{name}1:4", real=True)) for name in ("l", "v", "n"))
HALF = LIGHT + VIEW
ALPHA, GLOSS, EXPONENT = sp.symbols("alpha gloss exponent", positive=True)


def unit(vector: sp.Matrix) -> sp.Matrix:
    return vector / sp.sqrt(vector.dot(vector))


def blinn(fresnel: bool) -> sp.Expr:
    """Blinn's highlight by components: a power, with a colour or with Schlick's Fresnel factor."""
    h = unit(HALF)
    colour = GLOSS + (1 - GLOSS) * power_of_five() if fresnel else GLOSS
    return colour * NORMAL.dot(h) ** EXPONENT


def phong() -> sp.Expr:
    """Phong's, not normalised: the reflected light and a power."""
    mirror = 2 * NORMAL.dot(LIGHT) * NORMAL - LIGHT
    return GLOSS * mirror.dot(VIEW) ** EXPONENT


def power_of_five() -> sp.Expr:
    """(1 - L.H)^5, which needs the half vector at unit length."""
    return (1 - LIGHT.dot(unit(HALF))) ** 5


def exponential() -> sp.Expr:
    """2**(a + b L.h); exp with constants that hold log(2) costs the same."""
    return sp.exp(sp.Symbol("a") + sp.Symbol("b") * LIGHT.dot(HALF))


def interpolated() -> sp.Expr:
    """lerp(gloss, 1, F)."""
    return GLOSS + exponential() * (1 - GLOSS)


def smoothie() -> sp.Expr:
    """The article's listing: (H d).(H d) below, d = alpha + 4 (1 - (N.H)^2)/alpha."""
    h = unit(HALF)
    d = ALPHA + 4 * (1 - NORMAL.dot(h) ** 2) / ALPHA
    return interpolated() / (h * d).dot(h * d)


def approximate() -> sp.Expr:
    """The listing of the approximate version: d d below, d = alpha + p.p/alpha, p = h - N (N.h)."""
    p = HALF - NORMAL * NORMAL.dot(HALF)
    d = ALPHA + p.dot(p) / ALPHA
    return interpolated() / (d * d)


def ratio(one: sp.Expr, other: sp.Expr) -> float:
    """The weight of the operations of one formula over that of another."""
    return operations(one) / operations(other)


def ward(third: bool) -> sp.Expr:
    """What the second and the third form of Ward's model do with the exponential e and the constant k = 4 pi m n."""
    e, k, to_light, to_view = sp.symbols("e k to_light to_view")  # not known to be positive: so sympy keeps the roots
    return e / (k * sp.sqrt(to_light * to_view)) * to_light if third else e / (k * sp.sqrt(to_view / to_light))


CLAIMS = (
    Claim(
        "PM-ward-cost",
        "Ward",
        "the form of many books is less performant than the form in dot products",
        Above(1.0),
        lambda: ratio(ward(third=True), ward(third=False)),
        instead=Reading(
            "it trades a division for two multiplications, which weigh less by the cost model; the found number is the "
            "weight of its operations beside the exponential over that of the form in dot products",
            lambda: ratio(ward(third=True), ward(third=False)) < 1,
        ),
    ),
    Claim(
        "SM-cost",
        "Introduction",
        "the price of Smoothie is roughly that of Blinn and Phong's highlight",
        "roughly",
        None,
        readings=(
            Reading(
                "by weight of operations 0.8 to 1.25 times a power of N.H with Schlick's Fresnel factor",
                lambda: ratio(smoothie(), blinn(fresnel=True)),
                Between(0.8, 1.25),
            ),
        ),
        open="the listing it is compared with is not there, and no machine is named; the found number is the weight of "
        "its operations over that of a power of N.H with Schlick's Fresnel factor, which makes the half vector too",
    ),
    Claim(
        "SM-cost-approximate",
        "Introduction",
        "the approximate version costs about as much as Phong's highlight that is not normalised",
        "similar",
        None,
        readings=(
            Reading(
                "by weight of operations 0.8 to 1.25 times that, its own Fresnel factor included",
                lambda: ratio(approximate(), phong()),
                Between(0.8, 1.25),
            ),
        ),
        open="similar means no number",
    ),
    Claim(
        "SM-cost-simpler",
        "Approximate Smoothie",
        "the approximate version is simpler to compute than the microfacet version",
        Below(1.0),
        lambda: ratio(approximate(), smoothie()),
        how="weight of the operations of the two listings",
    ),
    Claim(
        "SM-G-cost",
        "Microfacet Smoothie",
        "Kelemen's G is much cheaper than Smith's",
        AtMost(0.5),
        lambda: ratio(masking.kelemen(U, V, V_PRIME), made(masking.separable, masking.ggx, V, V_PRIME, ALPHA)),
        how="weight of its operations over that of GGX's Smith masking",
        word="much cheaper",
    ),
    Claim(
        "SM-F-cheaper",
        "Fresnel term, conclusion",
        "2^(a + b L.h) is cheaper than the power with exponent 5",
        Below(1.0),
        lambda: ratio(exponential(), power_of_five()),
        how="weight of the operations from the vectors on: the power needs the half vector at unit length",
    ),
)
