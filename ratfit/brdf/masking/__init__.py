"""Masking and shadowing: the part of a facet that is seen, and the part that is seen and lit.

v = N.V and v' = N.L are the cosines of the two directions, t = N.H, u = H.V. Roughness is either m, the RMS slope along
one axis, or alpha = sqrt(2) m, the RMS slope over both axes (Beckmann's letter; GGX has an alpha of its own). The
variable of every Smith function is a = cot(theta)/alpha = v/(alpha sqrt(1 - v**2)).

What holds for every function of v here, those `_as_printed` of `torrance_sparrow` and `ggx` left out: it is 0 for
v <= 0; from v = 1 on, which rounding may bring about, and for a roughness of 0 it is 1; it is never nan for a roughness
from 0 on whose square is finite. Gradients are finite where the squares of v and of v/roughness do not underflow.

Accuracy in float64, roughness from 1/300 to 2, by `python benchmarks/accuracy.py 200000`: on v in [0, 1] every G1 and G
is within 4 ulp, but for `beckmann_correlated` at three places of 200 000 (4.1). At grazing view, v from 1e-10 to 0.1,

    `smith`               99.964 %, 6.1 at most       `phong`                99.995 %, 4.5
    `beckmann`            99.984 %, 5.1               `beckmann_rational`    99.999 %, 4.1
    `smith_as_printed`    99.997 %, 4.4               `ggx`, `schlick`       all

and near normal view, 1 - v from 1e-10 to 0.1, all, within 2.3. `ggx_lambda` is within 4 at 99.96 % and 5.6 at most,
Lambda of a Gaussian surface see there. No exponential magnifies an error here: where it is small it is added to
something that is not.
"""

from ratfit.brdf.masking.first_order import schlick as schlick
from ratfit.brdf.masking.first_order import schlick_roughness as schlick_roughness
from ratfit.brdf.masking.gaussian import beckmann as beckmann
from ratfit.brdf.masking.gaussian import beckmann_correlated as beckmann_correlated
from ratfit.brdf.masking.gaussian import beckmann_lambda as beckmann_lambda
from ratfit.brdf.masking.gaussian import smith as smith
from ratfit.brdf.masking.gaussian import smith_as_printed as smith_as_printed
from ratfit.brdf.masking.ggx_surface import ggx as ggx
from ratfit.brdf.masking.ggx_surface import ggx_as_printed as ggx_as_printed
from ratfit.brdf.masking.ggx_surface import ggx_correlated as ggx_correlated
from ratfit.brdf.masking.ggx_surface import ggx_lambda as ggx_lambda
from ratfit.brdf.masking.grooves import implicit as implicit
from ratfit.brdf.masking.grooves import kelemen as kelemen
from ratfit.brdf.masking.grooves import kelemen_visibility as kelemen_visibility
from ratfit.brdf.masking.grooves import torrance_sparrow as torrance_sparrow
from ratfit.brdf.masking.grooves import torrance_sparrow_as_printed as torrance_sparrow_as_printed
from ratfit.brdf.masking.product import separable as separable
from ratfit.brdf.masking.walter import beckmann_rational as beckmann_rational
from ratfit.brdf.masking.walter import beckmann_rational_as_printed as beckmann_rational_as_printed
from ratfit.brdf.masking.walter import phong as phong
from ratfit.brdf.masking.walter import phong_as_printed as phong_as_printed
