"""The exact formulas of reflectance, in sympy: each with its source, safe at every limit."""

from ratfit.brdf import distribution as distribution
from ratfit.brdf import fresnel as fresnel
from ratfit.brdf import masking as masking
from ratfit.brdf import metals as metals
from ratfit.brdf import roughness as roughness
from ratfit.brdf import sampling as sampling
from ratfit.brdf.interior import interior as interior
