"""How the normals of microfacets are spread: the distributions D of reflectance models.

Letters as in schlick1994: t = N.H, the cosine of the angle between a facet's normal and the surface's, in [-1, 1]; w,
the cosine of its azimuth against the tangent. Below the horizon (t < 0) every distribution is 0, at t = 0 it is the
limit from above, and t above 1 by rounding counts as 1. Values are per steradian: the integral of D(H) N.H over the
hemisphere is 1. The D of schlick1994 is pi times that (its Eq. 5); its factors Z and A are kept as it has them.

A roughness below `SMOOTH` counts as 0, a Dirac: infinite in its direction, 0 in all others; nothing is nan. A Gaussian
whose exponent is beyond `UNDERFLOW` is 0. Gradients are finite where there is no Dirac (in float32 for roughness from
1e-6 on). What roughness means in each: `ratfit.brdf.roughness`. For calculus take the `interior` of a formula.

Where lobes are narrow t has no digits of the angle left: a float32 is 1 - 6e-8 next to 1, an angle of 3e-4. Those who
know 1 - t^2 better, from the tangential part of H, give it as `sine_squared`; left out, it is made of t.

Accuracy in float64, roughness from 0.01 on, by `python benchmarks/accuracy.py 200000`, the worse of the whole range of
t and the lobe: how often D is within 4 ulp, and the most that was met, in ulp and in units of 2^-52 of D.

    `phong`, `azimuth`     all        3.1   1.9       `schlick`              99.6 %    6.4   3.6
    `zenith`               99.976 %   4.9   2.7       `beckmann_rational`    99.2 %    7.5   4.2
    `ggx`                  99.88 %    6.0   3.5       `ggx_anisotropic`      97.7 %    9.2   5.3
    `smoothie`             99.82 %    6.1   3.7

An exponential magnifies the error of its exponent, tan^2/alpha^2, and a power that of its own, which is rounded in
`blinn`. The most in units of 2^-52, by the exponent (of `blinn`, that of D/D(1) as a power of e):

    up to           1     4    16    64    600
    `beckmann`     2.6   6.2   24    97    933
    `ward`         3.0   7.3   34   136   1309
    `blinn`        2.0   5.9   22    89    831

Up to an exponent of 1 they are within 4 ulp at 99.97 % and more (4.9 at most), from there to 4 at 92 % and more.
"""

from ratfit.brdf.distribution._lobe import SMOOTH as SMOOTH
from ratfit.brdf.distribution.fractions import beckmann_rational as beckmann_rational
from ratfit.brdf.distribution.fractions import ggx as ggx
from ratfit.brdf.distribution.fractions import ggx_anisotropic as ggx_anisotropic
from ratfit.brdf.distribution.fractions import smoothie as smoothie
from ratfit.brdf.distribution.fractions import smoothie_as_printed as smoothie_as_printed
from ratfit.brdf.distribution.fractions import smoothie_energy as smoothie_energy
from ratfit.brdf.distribution.fractions import smoothie_energy_as_printed as smoothie_energy_as_printed
from ratfit.brdf.distribution.gaussian import beckmann as beckmann
from ratfit.brdf.distribution.gaussian import ward as ward
from ratfit.brdf.distribution.gaussian import ward_as_printed as ward_as_printed
from ratfit.brdf.distribution.gaussian import ward_third_form_as_printed as ward_third_form_as_printed
from ratfit.brdf.distribution.powers import MIRROR as MIRROR
from ratfit.brdf.distribution.powers import blinn as blinn
from ratfit.brdf.distribution.powers import phong as phong
from ratfit.brdf.distribution.zenith_azimuth import azimuth as azimuth
from ratfit.brdf.distribution.zenith_azimuth import azimuth_as_printed as azimuth_as_printed
from ratfit.brdf.distribution.zenith_azimuth import azimuth_as_printed_mean as azimuth_as_printed_mean
from ratfit.brdf.distribution.zenith_azimuth import schlick as schlick
from ratfit.brdf.distribution.zenith_azimuth import schlick_as_printed as schlick_as_printed
from ratfit.brdf.distribution.zenith_azimuth import zenith as zenith
