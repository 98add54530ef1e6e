"""The exact formulas of reflectance, in sympy: each with its source, safe at every limit."""
