"""The complex planes X + pY in which the parts of a solid's fields are analytic: two roots of a quartic.

Only their sum and their product are found, which stay smooth where the roots meet; so do they in every
isotropic solid at rest.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

#: Steps of Newton's method at most: it begins with half the digits where the roots meet.
_STEPS = 10


@dataclass(frozen=True)
class Roots:
    """Two roots p₁, p₂ with Im p > 0.

    Attributes:
        sum, product: of the two.
    """

    sum: complex
    product: complex

    @cached_property
    def each(self) -> tuple[complex, complex]:
        """p₁ and p₂; half the digits where they meet, but sum and product stay."""
        middle = self.sum / 2.0
        half = np.sqrt(middle**2 - self.product + 0j)
        return complex(middle + half), complex(middle - half)

    @cached_property
    def midpoint(self) -> complex:
        """Midway between them in the hyperbolic metric of the upper half-plane."""
        p, other = self.each
        seen = (other - p.real) / p.imag  # where p is at i
        ζ = (seen - 1j) / (seen + 1j)
        ζ /= 1.0 + np.sqrt(1.0 - abs(ζ) ** 2)
        return complex(p.real + p.imag * 1j * (1.0 + ζ) / (1.0 - ζ))

    @cached_property
    def apart(self) -> float:
        """Their hyperbolic distance; 0 where they meet."""
        p, other = self.each
        return float(2.0 * np.arcsinh(abs(p - other) / (2.0 * np.sqrt(p.imag * other.imag))))


def roots(coefficients: NDArray) -> Roots | None:
    """The two roots with Im p > 0 of a real quartic, or None where it has real ones.

    Args:
        coefficients: of p⁴ to p⁰, (5,).
    """
    b3, b2, b1, b0 = coefficients[1:] / coefficients[0]
    upper = [p for p in np.roots(coefficients) if p.imag > 0.0]
    if len(upper) != 2:
        return None
    # p⁴ + … = (p² - s p + d)(p² - s̄ p + d̄), where Re s = -b₃/2 is known.
    s, d = sum(upper), np.prod(upper)
    a, x = -b3 / 2.0, np.array([s.imag, d.real, d.imag])
    for _ in range(_STEPS):
        b, e, f = x
        rest = [a * a + b * b + 2.0 * e - b2, -2.0 * (a * e + b * f) - b1, e * e + f * f - b0]
        slopes = [[2.0 * b, 2.0, 0.0], [-2.0 * f, -2.0 * a, -2.0 * b], [0.0, 2.0 * e, 2.0 * f]]
        try:
            step = np.linalg.solve(slopes, rest)
        except np.linalg.LinAlgError:  # all four meet on the real axis
            return None
        x = x - step
        if np.abs(step).max() <= 1e-15 * np.abs(x).max():
            break
    return Roots(complex(a, x[0]), complex(x[1], x[2]))
