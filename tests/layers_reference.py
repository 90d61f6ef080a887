"""Layered half-planes in many digits: it shares no line with the program.

The field e^(ikX) (u, t)(Y) of a layer obeys four linear equations whose exponential carries it
from the layer's lower face to the upper one; growing parts are paid for in digits.
"""

import mpmath as mp
import numpy as np
from scipy.integrate import solve_ivp


def plane_strain(E, ν):
    """c11, c12, c16, c22, c26, c66 of an isotropic solid."""
    E, ν = mp.mpf(E), mp.mpf(ν)
    λ, μ = E * ν / ((1 + ν) * (1 - 2 * ν)), E / (2 * (1 + ν))
    return [λ + 2 * μ, λ, mp.mpf(0), λ + 2 * μ, mp.mpf(0), μ]


def system(C, ρ, V2, k):
    """d/dY of (u, v, σ_XY, σ_YY), 4 × 4."""
    c11, c12, c16, c22, c26, c66 = C
    Q = mp.matrix([[c11 - ρ * V2, c16], [c16, c66 - ρ * V2]])
    R, T = mp.matrix([[c16, c12], [c66, c26]]), mp.matrix([[c66, c26], [c26, c22]])
    i, inverse = mp.mpc(0, 1), T**-1
    blocks = [
        [-i * k * inverse * R.T, inverse],
        [k**2 * (Q - R * inverse * R.T), -i * k * R * inverse],
    ]
    N = mp.matrix(4)
    for row in range(4):
        for column in range(4):
            N[row, column] = blocks[row // 2][column // 2][row % 2, column % 2]
    return N


def admittance(layers, substrate, V2, k):
    """i k u t⁻¹ on top, 2 × 2.

    Args:
        layers: (thickness, C, ρ) from the top down.
        substrate: (C, ρ).
    """
    values, vectors = mp.eig(system(*substrate, V2, k))
    chosen = [n for n in range(4) if mp.re(values[n]) > 0]
    assert len(chosen) == 2
    field = mp.matrix([[vectors[row, n] for n in chosen] for row in range(4)])
    for H, C, ρ in reversed(layers):
        field = mp.expm(system(C, ρ, V2, k) * H) * field
    return mp.mpc(0, 1) * k * field[:2, :] * field[2:, :] ** -1


def graded_admittance(properties, H, V2, k):
    """The same over a graded layer on its own lower face's solid, in double precision, k H of order 1.

    Args:
        properties: C and ρ at a depth.
    """

    def N(depth):
        C, ρ = properties(depth)
        return np.array(system(C, ρ, V2, k).tolist(), dtype=complex)

    values, vectors = np.linalg.eig(N(H))
    start = vectors[:, values.real > 0]
    found = solve_ivp(
        lambda Y, field: (N(-Y) @ field.reshape(4, 2)).ravel(), (-H, 0.0), start.ravel(), method="DOP853",
        rtol=1e-12, atol=1e-13,
    )  # fmt: skip
    field = found.y[:, -1].reshape(4, 2)
    return 1j * k * field[:2] @ np.linalg.inv(field[2:])
