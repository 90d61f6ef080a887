"""Stroh's solution by eigenvectors, in many digits: it shares no line with the program.

Fundamental matrix N = [[N₁, N₂], [N₃, N₁ᵀ]] (Ting, Anisotropic Elasticity, 1996, ch. 5), with Q - ρV²
for Q; its eigenvectors (a, b) for Im p > 0 give u = 2 Re Σ a f(z), stress functions φ = 2 Re Σ b f(z),
σ_i2 = φ_i,1 and σ_i1 = -φ_i,2 + ρV² u_i,1, z = X + pY.
"""

import mpmath as mp
import numpy as np

DIGITS = 90


class Stroh:
    """A half-plane Y < 0 at a speed.

    Args:
        C: c11, c12, c16, c22, c26, c66 over c66.
        c: speed over √(c66/ρ), complex for waves that grow.
    """

    def __init__(self, C, c):
        mp.mp.dps = DIGITS
        self.C = c11, c12, c16, c22, c26, c66 = [mp.mpf(float(x)) for x in C]
        # Where eigenvectors coincide, a speed of 1e-30 keeps them apart and changes 60 digits on nothing.
        c = c if isinstance(c, mp.mpf | mp.mpc) else mp.mpf(float(c))
        self.inertia = c**2 + mp.mpf(10) ** -50
        Q = mp.matrix([[c11 - self.inertia, c16], [c16, c66 - self.inertia]])
        R, T = mp.matrix([[c16, c12], [c66, c26]]), mp.matrix([[c66, c26], [c26, c22]])
        inverse = T**-1
        N1, N2, N3 = -inverse * R.T, inverse, R * inverse * R.T - Q
        N = mp.matrix(4)
        for i in range(2):
            for j in range(2):
                N[i, j], N[i, j + 2] = N1[i, j], N2[i, j]
                N[i + 2, j], N[i + 2, j + 2] = N3[i, j], N1[j, i]
        values, vectors = mp.eig(N)
        chosen = [k for k in range(4) if values[k].imag > 0]
        assert len(chosen) == 2
        self.p = [values[k] for k in chosen]
        self.A = mp.matrix([[vectors[i, k] for k in chosen] for i in range(2)])
        self.B = mp.matrix([[vectors[i + 2, k] for k in chosen] for i in range(2)])
        self.Y = self.A * self.B**-1

    @property
    def surface(self):
        """n, m, n12, q of u,X = Re(Y) t - Im(Y) H[t]."""
        Y = self.Y
        return [-Y[1, 1].imag, -Y[0, 0].imag, -Y[0, 1].imag, Y[0, 1].real]


def admittances(C, inertia, sign=1.0):
    """A B⁻¹ in double precision, by which tractions t move the surface by u = A B⁻¹ t/(ik), (n, 2, 2).

    Args:
        C: c11, c12, c16, c22, c26, c66.
        inertia: ρV² in their unit, complex, (n,).
        sign: of Im p of the waves that are kept, one or (n,).
    """
    c11, c12, c16, c22, c26, c66 = C
    Q = np.array([[c11, c16], [c16, c66]]) - np.asarray(inertia)[:, None, None] * np.eye(2)
    R, inverse = np.array([[c16, c12], [c66, c26]]), np.linalg.inv([[c66, c26], [c26, c22]])
    N = np.empty((len(Q), 4, 4), dtype=complex)
    N[:, :2, :2], N[:, :2, 2:] = -inverse @ R.T, inverse
    N[:, 2:, :2], N[:, 2:, 2:] = R @ inverse @ R.T - Q, -R @ inverse
    p, vectors = np.linalg.eig(N)
    order = np.argsort(-p.imag * np.reshape(sign, (-1, 1)), axis=1)[:, None, :2]
    A, B = (np.take_along_axis(vectors[:, rows], order, axis=2) for rows in (slice(2), slice(2, 4)))
    return A @ np.linalg.inv(B)


class Punch:
    """A flat punch with σ_XY = g σ_YY on it, load ∫σ_YY dX = -2 for half-width 1.

    Between the ends v,X = 0 asks (N H - g q) σ_YY = 0; σ_YY is a multiple of (1 - x)^α (1 + x)^β.
    """

    def __init__(self, solid, g):
        self.solid, self.g = solid, mp.mpf(float(g))
        n, _, n12, q = solid.surface
        # H[w] = cot(πα) w for that weight.
        self.α = mp.acot(self.g * q / (n + self.g * n12)) / mp.pi
        self.α -= self.α > 0
        self.β = -1 - self.α

    def cauchy(self, z):
        """∫ σ_YY/(t - z) dt; the weight's integral is -π/sin(πα)."""
        return 2 * (z - 1) ** self.α * (z + 1) ** self.β

    def σ_YY(self, x):
        """Under the punch."""
        return 2 * mp.sin(mp.pi * self.α) / mp.pi * (1 - x) ** self.α * (1 + x) ** self.β

    def stresses(self, X, Y):
        """σ_XX, σ_YY, σ_XY at a point with Y <= 0; on the surface beside the punch for Y = 0."""
        solid, X, Y = self.solid, mp.mpf(float(X)), mp.mpf(float(Y))
        weights = solid.B**-1 * mp.matrix([self.g, 1])
        σ = [mp.mpf(0)] * 3
        for k, p in enumerate(solid.p):
            # B f' has the given real part on the axis and no part from above it.
            # A point on the surface is looked at from below.
            z = mp.mpc(X, 0) + p * Y if Y else mp.mpc(X, -(mp.mpf(10) ** -60))
            f = -weights[k] * self.cauchy(z) / (2j * mp.pi)
            a, b = solid.A[:, k], solid.B[:, k]
            σ[0] += 2 * ((-p * b[0] + solid.inertia * a[0]) * f).real
            σ[1] += 2 * (b[1] * f).real
            σ[2] += 2 * (b[0] * f).real
        return σ
