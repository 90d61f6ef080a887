"""Exact stresses inside the half-plane under a known pressure, stable for every 0 <= c < 1.

The two potentials live at z_j = (X + i β_j Y)/a. At slow speed they nearly coincide, and what counts
is their difference over c², which is therefore computed as such.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from galinx.solvers.solids.solid import Potential

#: c² below which its part in the difference of the potentials, over c², has no digit left.
_AT_REST = 1e-30

#: A step over the distance from the contact from which on a potential's two values differ by enough to be
#: subtracted; a longer one may lead from where one form of the potential serves to where another does.
_APART = 0.05


def value_and_change(
    Φ: Potential, z: NDArray, step: NDArray, share: complex
) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
    """Φ(z) and (Φ(z + share·step) - Φ(z))/share, to full accuracy for steps of any length.

    Args:
        Φ: a pressure's potential.
        z, step: positions below the surface over a, and steps from there, of one shape.
        share: how much of the step is gone; its limit is taken where it is 0.
    """
    at, moved = Φ.at(z), z + share * step
    apart = np.abs(share * step) > _APART * np.minimum(_from_contact(z), _from_contact(moved))
    if not apart.any():
        return at, Φ.change(z, step, share)
    # Where a potential is not asked for it is looked at in a place that it knows.
    difference = (Φ.at(np.where(apart, moved, z)) - at) / share
    if apart.all():
        return at, difference
    near = Φ.change(z, np.where(apart, 0.0, step), share)
    return at, np.where(apart, difference, near)


def _from_contact(z: NDArray) -> NDArray[np.float64]:
    """Distance from -1 <= z <= 1."""
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
    """σ_XX, σ_YY, σ_XY of a potential Φ; plain arithmetic, so that a proof's symbols may be put in.

    Args:
        frame: constants of the moving frame.
        g: σ_XY/σ_YY on the surface.
        s_s, h_s: -Im and Re of Φ(z_s).
        s, h: the same of (Φ(z_d) - Φ(z_s))/c².
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
