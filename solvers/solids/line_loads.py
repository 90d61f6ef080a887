"""A half-plane's displacement far from loads on its surface: of line loads, and of their moments.

Tractions t(s) at |s| <= a move a point z = X + Y G, a matrix with the eigenvalues X + pY, by

    u = Im[log(z) 𝐘 M₀ - Σ z⁻ⁿ 𝐘 Mₙ/n]/π,   Mₙ = ∫ sⁿ t ds,   𝐘 = L⁻¹,

where all |X + pY| > a. Functions of matrices by those of eigenvalues: nothing happens where these meet.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import log1p  # NumPy's loses digits for small complex arguments

#: Distance over a of the surface to which displacements are relative: that of the study's walls.
DATUM = 100.0
#: Unit loads: ∫σ_YY = 1 and ∫σ_XY = 1, as (σ_XY, σ_YY).
LOADS = np.array([[0.0, 1.0], [1.0, 0.0]])


def line_loads(
    solid: Any, X: NDArray, Y: NDArray, terms: int = 1, datum: float = DATUM
) -> NDArray[np.float64]:
    """Displacements over 1/μ of moments of surface tractions, normal and tangential, (terms, 2, 2, n).

    Args:
        solid: has G, L and roots of the half-plane at its speed.
        X, Y: positions with Y <= 0, (n,).
        terms: how many: line loads alone, their first moment besides, ….
        datum: distance over a at which a line load does not move the surface, the mean of both sides.
    """
    p, other = solid.roots.each
    z = X + p * np.minimum(Y, 0.0) - 0.0j
    z = np.where(Y < 0.0, z, X + np.where(X < 0.0, -1e-300j, 0.0))
    step = (other - p) * Y / z
    # The argument goes from 0 ahead of the load to -π behind it; half of that is a translation.
    log = np.log(z / datum) + 0.5j * np.pi
    change = np.where(step == 0.0, Y / z, log1p(step) / np.where(step == 0, 1, other - p))
    one = np.eye(2)
    function = log[:, None, None] * one + change[:, None, None] * (solid.G - p * one)
    inverse = np.linalg.inv(X[:, None, None] * one + Y[:, None, None] * solid.G)
    of_loads = np.linalg.solve(solid.L, LOADS.T)
    found, power = [function], one
    for n in range(1, terms):
        power = power @ inverse
        found.append(-power / n)
    return np.moveaxis(np.array(found) @ of_loads, (0, 1, 2, 3), (0, 3, 2, 1)).imag / np.pi
