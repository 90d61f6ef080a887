"""Exact fields inside a half-plane from the complex potential of its loads.

The parts of a solid's fields are analytic in two complex planes X + pY; p are two roots of a quartic.
Only their sum and product are computed, which stay smooth where the roots meet, as they do in every
isotropic solid at rest.

Stresses under a known pressure are stable for every 0 <= c < 1. Of an isotropic solid the two potentials
are at z_j = (X + i β_j Y)/a. At slow speed they nearly coincide, and stresses depend on their difference
over c², which is therefore computed as such.

Displacements far from loads on the surface are those of line loads and of their moments. Tractions t(s)
at |s| <= a move a point z = X + Y G, a matrix with the eigenvalues X + pY, by

    u = Im[log(z) 𝐘 M₀ - Σ z⁻ⁿ 𝐘 Mₙ/n]/π,   Mₙ = ∫ sⁿ t ds,   𝐘 = L⁻¹,

where all |X + pY| > a. Functions of matrices by those of eigenvalues: nothing happens where these meet.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import log1p

from .solid import Potential

#: c² below which its part in the difference of the potentials, over c², is below rounding.
_AT_REST = 1e-30

#: Step over the distance from the contact above which a potential's two values differ by enough to be
#: subtracted; a longer step may end where another form of the potential serves.
_APART = 0.05


def value_and_change(
    Φ: Potential, z: NDArray, step: NDArray, share: complex
) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
    """Potential Φ(z) and its change (Φ(z + share·step) - Φ(z))/share, accurate for any step.

    Args:
        Φ: a pressure's potential.
        z, step: positions below the surface over a, and steps from there, of one shape.
        share: share of the step that is taken; 0 for the limit.
    """
    at, moved = Φ.at(z), z + share * step
    apart = np.abs(share * step) > _APART * np.minimum(_from_contact(z), _from_contact(moved))
    if not apart.any():
        return at, Φ.change(z, step, share)
    # Where the difference is not used, the potential is evaluated at z, where it is defined.
    difference = (Φ.at(np.where(apart, moved, z)) - at) / share
    if apart.all():
        return at, difference
    near = Φ.change(z, np.where(apart, 0.0, step), share)
    return at, np.where(apart, difference, near)


def _from_contact(z: NDArray) -> NDArray[np.float64]:
    """Distance of z from the contact -1 <= z <= 1."""
    return np.hypot(np.maximum(np.abs(z.real) - 1.0, 0.0), z.imag)


def stresses(frame: Any, Φ: Potential, g: Any, X: ArrayLike, Y: ArrayLike) -> NDArray[np.float64]:
    """σ_XX, σ_YY, σ_XY over N/(2a) at points below the surface.

    Args:
        frame: constants of the moving frame, :class:`galinx.solvers.solids.isotropic.MovingFrame`.
        Φ: the pressure's potential.
        g: σ_XY/σ_YY on the surface; broadcasts against points.
        X, Y: coordinates over a, of one shape; Y < 0.

    Returns:
        Array of shape (3, ...).

    Raises:
        ValueError: a point has Y >= 0; the surface has formulas of its own.
    """
    X, Y = np.broadcast_arrays(np.asarray(X, dtype=float), np.asarray(Y, dtype=float))
    if np.any(Y >= 0.0):
        raise ValueError(f"Y/a = {Y.max()!r}: expected Y < 0; use the formulas of the surface there")
    z = X + 1j * frame.β_s * Y
    δ = 1j * Y * (1.0 - frame.k) / (frame.β_d + frame.β_s)  # (z_d - z_s)/c²
    Φ_s, d = value_and_change(Φ, z, δ, frame.c**2 if frame.c**2 >= _AT_REST else 0.0)
    return np.array(field(frame, g, -Φ_s.imag, Φ_s.real, -d.imag, d.real))


def field(frame: Any, g: Any, s_s: Any, h_s: Any, s: Any, h: Any) -> tuple[Any, Any, Any]:
    """σ_XX, σ_YY, σ_XY of a potential Φ; plain arithmetic, so that a proof may insert symbols.

    Args:
        frame: constants of the moving frame.
        g: σ_XY/σ_YY on the surface.
        s_s, h_s: -Im and Re of Φ(z_s).
        s, h: -Im and Re of (Φ(z_d) - Φ(z_s))/c².
    """
    k, β_s, β_d, e, r, q, κ = (
        frame.k, frame.β_s, frame.β_d, frame.e, frame.r, frame.q, frame.κ
    )  # fmt: skip
    u_X = (e * s + β_s * g * (2.0 * h + h_s)) / r + q * s_s
    v_Y = (
        -(β_d**2) * e * s
        + β_d * (β_d - 2.0 * (1.0 - k) / (β_d + β_s)) * s_s
        + β_s * g * ((2.0 * k - 1.0) * h_s - 2.0 * β_d**2 * h)
    ) / r
    σ_XY = g * (4.0 * β_s * β_d * s / r + s_s) - 2.0 * β_d * e * h / r
    # (u,X + v,Y)/(κ - 1), in which κ - 1 has cancelled: it stays what it is up to ν = 1/2.
    S, c2 = 1.0 + β_s * β_d, frame.c**2
    of_s_s = 2.0 * (1.0 - c2) / S - c2 + 2.0 * (β_d + β_s * c2 / S) / (β_d + β_s)
    dilatation = (c2 * (e * s + 2.0 * g * β_s * h) + 2.0 * β_s * g * h_s + of_s_s * s_s) / ((κ + 1.0) * r)
    σ_XX = u_X - v_Y + 2.0 * dilatation  # Eq 6
    σ_YY = v_Y - u_X + 2.0 * dilatation  # Eq 7
    return σ_XX, σ_YY, σ_XY


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
        """Roots p₁ and p₂, with half the digits where they meet."""
        middle = self.sum / 2.0
        half = np.sqrt(middle**2 - self.product + 0j)
        return complex(middle + half), complex(middle - half)

    @cached_property
    def midpoint(self) -> complex:
        """Point midway between the roots in the hyperbolic metric of the upper half-plane."""
        p, other = self.each
        moved = (other - p.real) / p.imag  # where p is at i
        ζ = (moved - 1j) / (moved + 1j)
        ζ /= 1.0 + np.sqrt(1.0 - abs(ζ) ** 2)
        return complex(p.real + p.imag * 1j * (1.0 + ζ) / (1.0 - ζ))

    @cached_property
    def apart(self) -> float:
        """Hyperbolic distance of the roots; 0 where they meet."""
        p, other = self.each
        return float(2.0 * np.arcsinh(abs(p - other) / (2.0 * np.sqrt(p.imag * other.imag))))


def roots(coefficients: NDArray) -> Roots | None:
    """Two roots with Im p > 0 of a real quartic, or None where it has real roots.

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


#: Distance over a of the surface to which displacements are relative: that of the study's walls.
DATUM = 100.0
#: Unit loads: ∫σ_YY = 1 and ∫σ_XY = 1, as (σ_XY, σ_YY).
LOADS = np.array([[0.0, 1.0], [1.0, 0.0]])


def line_loads(
    solid: Any, X: NDArray, Y: NDArray, terms: int = 1, datum: float = DATUM
) -> NDArray[np.float64]:
    """Displacements over 1/μ of moments of surface tractions, normal and tangential, (terms, 2, 2, n).

    Args:
        solid: half-plane at its speed, with G, L and roots.
        X, Y: positions with Y <= 0, (n,).
        terms: number of moments: 1 for line loads alone, 2 for their first moment besides, ….
        datum: distance over a at which a line load does not move the surface, the mean of both sides.
    """
    p, other = solid.roots.each
    z = X + p * np.minimum(Y, 0.0) - 0.0j
    z = np.where(Y < 0.0, z, X + np.where(X < 0.0, -1e-300j, 0.0))
    step = (other - p) * Y / z
    # The argument goes from 0 ahead of the load to -π behind it; half of that is a translation.
    log = np.log(z / datum) + 0.5j * np.pi
    change = np.where(step == 0.0, Y / z, log1p(step) / np.where(step == 0, 1, other - p))
    identity = np.eye(2)
    function = log[:, None, None] * identity + change[:, None, None] * (solid.G - p * identity)
    inverse = np.linalg.inv(X[:, None, None] * identity + Y[:, None, None] * solid.G)
    of_loads = np.linalg.solve(solid.L, LOADS.T)
    functions, power = [function], identity
    for n in range(1, terms):
        power = power @ inverse
        functions.append(-power / n)
    return np.moveaxis(np.array(functions) @ of_loads, (0, 1, 2, 3), (0, 3, 2, 1)).imag / np.pi
