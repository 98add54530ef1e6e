"""Tests the conditions as they were stated, never a cleared form of them; rejects what fails or has a pole."""

from ratfit._verify.numerically import numerical_residual as numerical_residual
from ratfit._verify.verify import verify as verify
