"""Stresses on the surface and inside, and flatness, from finite element displacements."""

import numpy as np
from numpy.typing import NDArray


def σ_XX_on_surface(κ: float, u_X: NDArray, σ_YY: NDArray) -> NDArray[np.float64]:
    """In-plane stress on Y = 0 over N/(2a), v,Y eliminated between Eqs 6 and 7.

    Args:
        κ: Kolosov's constant.
        u_X: tangential derivative of the displacement, in the units of σ/μ, (n,).
        σ_YY: contact stress over N/(2a); NaN where the surface is free, (n,).
    """
    return 8.0 / (κ + 1.0) * u_X + (3.0 - κ) / (κ + 1.0) * np.nan_to_num(σ_YY)


def stresses_inside(κ: float, G: NDArray) -> NDArray[np.float64]:
    """σ_XX, σ_YY, σ_XY over N/(2a) from displacement gradients (Eqs 6-8).

    Args:
        κ: Kolosov's constant, above 1.
        G: μ ∂u_i/∂X_j over N/(2a), (..., 2, 2).

    Returns:
        Array (3, ...).
    """
    u_X, v_Y = G[..., 0, 0], G[..., 1, 1]
    λ_div = (3.0 - κ) / (κ - 1.0) * (u_X + v_Y)
    return np.array([2.0 * u_X + λ_div, 2.0 * v_Y + λ_div, G[..., 0, 1] + G[..., 1, 0]])


def flatness(X: NDArray, v_X: NDArray) -> NDArray[np.float64]:
    """Largest |v,X| for |X| <= 0.9a over the largest for |X| >= 1.1a, dimensionless.

    Args:
        X: positions over a, (n,).
        v_X: slopes in any unit, (states, n).
    """
    under, beside = (np.abs(v_X[:, part]).max(axis=1) for part in (np.abs(X) <= 0.9, np.abs(X) >= 1.1))
    return under / beside


def σ_ZZ(ν: float, plane: str, σ_XX: NDArray, σ_YY: NDArray) -> NDArray[np.float64]:
    """Normal stress out of the plane, in the unit of the others: ν(σ_XX + σ_YY), or 0 in plane stress.

    Args:
        ν: Poisson's ratio.
        plane: ``"strain"`` or ``"stress"``.
        σ_XX, σ_YY: normal stresses in the plane, of one shape.
    """
    return (ν if plane == "strain" else 0.0) * (σ_XX + σ_YY)


def von_mises(σ_XX: NDArray, σ_YY: NDArray, σ_XY: NDArray, σ_ZZ: NDArray) -> NDArray[np.float64]:
    """√(½[(σ_XX - σ_YY)² + (σ_YY - σ_ZZ)² + (σ_ZZ - σ_XX)²] + 3σ_XY²), in the unit of the stresses."""
    normal = (σ_XX - σ_YY) ** 2 + (σ_YY - σ_ZZ) ** 2 + (σ_ZZ - σ_XX) ** 2
    return np.sqrt(normal / 2.0 + 3.0 * σ_XY**2)


def maximum_shear(σ_XX: NDArray, σ_YY: NDArray, σ_XY: NDArray) -> NDArray[np.float64]:
    """Largest shear stress in the plane, √(¼(σ_XX - σ_YY)² + σ_XY²), in the unit of the stresses."""
    return np.hypot((σ_XX - σ_YY) / 2.0, σ_XY)
