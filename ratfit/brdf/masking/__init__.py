"""Masking and shadowing: the part of a facet that is seen, and the part that is seen and lit.

v = N.V and v' = N.L are the cosines of the two directions, t = N.H, u = H.V. Roughness is either m, the RMS slope along
one axis, or alpha = sqrt(2) m, the RMS slope over both axes (Beckmann's letter; GGX has an alpha of its own). The
variable of every Smith function is a = cot(theta)/alpha = v/(alpha sqrt(1 - v**2)).

What holds for every function of v here, those `_as_printed` of `torrance_sparrow` and `ggx` left out: it is 0 for
v <= 0; from v = 1 on, which rounding may bring about, and for a roughness of 0 it is 1; it is never nan for a roughness
from 0 on whose square is finite. Gradients are finite where the squares of v and of v/roughness do not underflow.

Accuracy in float64, measured on a million places (100 000 with an exponential), v in (0, 1) and roughness from 1/300 to
2: G1 is within 4 ulp, `phong` and `beckmann` but for one place in 100 000, at 4.2; `ggx_lambda` is within 4 at 99.96
places of 100 and within 5.5 at all; Lambda of a Gaussian surface see there. No exponential magnifies an error here:
where it is small it is added to something that is not.
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
