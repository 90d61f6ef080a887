"""Layered half-planes in many digits: it shares no line with the program.

The field e^(ikX) (u, t)(Y) of a layer obeys four linear equations whose exponential carries it
from the layer's lower face to the upper one; growing parts are paid for in digits. The equation of the
punch is collocated with the kernel's integral over k taken as a sum of products.
"""

from itertools import pairwise

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


def jacobi_rule(count, α, β):
    """Gauss's nodes and weights for (1 - t)^α (1 + t)^β in many digits, by the recurrence's matrix."""
    J, s = mp.zeros(count), α + β
    for n in range(count):
        first = n == 0
        J[n, n] = (β - α) / (s + 2) if first else (β**2 - α**2) / ((2 * n + s) * (2 * n + s + 2))
        if n:
            top = 4 * n * (n + α) * (n + β)
            # At n = 1 the factor n + s cancels 2n + s - 1.
            top *= 1 if n == 1 else (n + s)
            below = (2 * n + s) ** 2 * (2 * n + s + 1) * (1 if n == 1 else 2 * n + s - 1)
            J[n, n - 1] = J[n - 1, n] = mp.sqrt(top / below)
    nodes, vectors = mp.eigsy(J)
    whole = mp.beta(α + 1, β + 1) * 2 ** (s + 1)
    return [nodes[n] for n in range(count)], [whole * vectors[0, n] ** 2 for n in range(count)]


def punch(layers, substrate, V2, g, count, digits=30, panels=10, points=18):
    """A flat punch: α, K_I left and right, σ_YY(0) over N/a."""
    mp.mp.dps = digits
    g, V2 = mp.mpf(g), mp.mpf(V2)
    top = admittance([], layers[0][1:], V2, mp.mpf(1))  # Ŷ of the half-plane of the surface's solid
    # Ŷ = conj(Y): v,X = (n + g n₁₂) H σ - g q σ of it, stresses over one.
    n, q = mp.im(top[1, 1]) + g * mp.im(top[1, 0]), -mp.re(top[1, 0])
    α = mp.acot(g * q / n) / mp.pi
    α -= α > 0
    β = -1 - α
    t, w = jacobi_rule(count, α, β)
    r, _ = jacobi_rule(count - 1, -α, -β)
    kernel = mp.zeros(count - 1, count)
    x, y = np.polynomial.legendre.leggauss(points)
    rule = [_polished(points, node) for node in x]
    del y
    H = layers[0][0]
    edges = [0] + [mp.mpf(2) ** (j - 5) * 16 / H for j in range(panels - 3)]
    for low, high in pairwise(edges):
        for node, weight in rule:
            k = (low + high) / 2 + (high - low) / 2 * node
            Δ = admittance(layers, substrate, V2, k) - top
            f = (Δ[1, 1] + g * Δ[1, 0]) * weight * (high - low) / 2 / mp.pi
            from_t = [mp.expj(-k * one) for one in t]
            for i, place in enumerate(r):
                turned = f * mp.expj(k * place)
                for j in range(count):
                    kernel[i, j] += mp.re(turned * from_t[j])
    A, b = mp.zeros(count), mp.zeros(count, 1)
    for j in range(count):
        for i in range(count - 1):
            A[i, j] = w[j] * (n / mp.pi / (t[j] - r[i]) + kernel[i, j])
        A[count - 1, j] = w[j]
    b[count - 1] = -2
    p = mp.lu_solve(A, b)

    def at(place):
        """The polynomial through p, by Lagrange."""
        terms = [p[j] * mp.fprod((place - o) / (t[j] - o) for o in t if o != t[j]) for j in range(count)]
        return mp.fsum(terms)

    return α, -at(mp.mpf(-1)) / 2, -at(mp.mpf(1)) / 2, at(mp.mpf(0)) / 2


def _polished(points, x):
    """Gauss-Legendre node and weight in many digits."""
    x = mp.mpf(float(x))
    for _ in range(4):
        P, before = mp.legendre(points, x), mp.legendre(points - 1, x)
        slope = points * (x * P - before) / (x**2 - 1)
        x -= P / slope
    slope = points * (-mp.legendre(points - 1, x)) / (x**2 - 1)
    return x, 2 / ((1 - x**2) * slope**2)
