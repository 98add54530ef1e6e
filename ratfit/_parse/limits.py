"""What a text and its numbers may measure; together these bound the time that reading takes."""

MAX_LENGTH = 2000
"""Characters of a text."""
MAX_DEPTH = 50
"""Parentheses, calls, signs and powers within each other."""
MAX_HEIGHT = 150
"""Levels of the expression once the names are put in: sympy recurses over them, several frames a level."""
MAX_SIZE = 3000
"""Parts of the expression once the names are put in."""
MAX_DIGITS = 60
MAX_DECIMAL_EXPONENT = 300
MAX_EXPONENT = 1000
"""Of a power of anything but a rational."""
MAX_BITS = 4096
"""Of numerator and denominator of a rational."""
MAX_ROOT_BITS = 1024
"""Of the rationals under the roots of a product: sympy multiplies and factors them."""
MAX_ORDER_BITS = 1 << 15
"""These bits times the common order of the roots: it raises prime factors to the order."""
MAX_NAME = 32
MAX_ARGUMENTS = 8
SHORT = 12
"""Parts of what sympy may evaluate in its own way."""
