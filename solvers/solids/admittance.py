"""Waves below the surface of a uniform solid at real and complex speeds, and its half-plane.

Fields e^(ik(X - Ct)) below the surface have u,Y = G u,X. With the stiffness c_ij over c₆₆, the speed C
over √(c₆₆/ρ) and

    Q = [[c₁₁, c₁₆], [c₁₆, c₆₆]],  R = [[c₁₆, c₁₂], [c₆₆, c₂₆]],  T = [[c₆₆, c₂₆], [c₂₆, c₂₂]]

the equations of motion are T G² + (R + Rᵀ) G + Q - C² = 0. Eigenvalues of G are the two roots p of

    det(Q - C² + p (R + Rᵀ) + p² T) = 0

of which e^(ik p Y) decays: Im p > 0 where k < 0. Only their sum and product are computed, which keep
their digits where the roots meet. The tractions over c₆₆ are (σ_XY, σ_YY) = L u,X, L = Rᵀ + T G, and the
admittance is 𝐘 = L⁻¹.

Away from the real axis no root is real (the solid is one of real speeds), so that 𝐘 is analytic in the
whole plane but where |C| is real and at least the least speed at which a decaying root meets a growing
one; there the value is that of Im C → -0. Its poles are the speeds of the wave along the surface.
"""

from dataclasses import dataclass
from functools import cached_property
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .half_plane import HalfPlane, Roots, UniformHalfPlane, Waves

#: Imaginary part over the size of a root below which the root is real, where C is real.
_REAL = 1e-9
#: Directions at which speeds of waves are computed, and halvings of the angle between two of them.
_DIRECTIONS, _HALVINGS = 1440, 60
#: Points on a circle round the pole, which halves the way to the next speed at which 𝐘 is not analytic.
_CIRCLE = 64


@dataclass(frozen=True)
class Admittance:
    """Admittance 𝐘(C) of the surface of a uniform solid: u,X over tractions/μ.

    Args:
        c11, c12, c16, c22, c26: stiffness over c₆₆.
    """

    c11: float
    c12: float
    c16: float
    c22: float
    c26: float

    @classmethod
    def of(cls, half_plane: HalfPlane) -> "Admittance":
        """Admittance of a uniform half-plane's solid."""
        return half_plane.surface.admittance

    @classmethod
    def of_stiffness(cls, C: NDArray) -> "Admittance":
        """Admittance of a solid by its stiffness of σ_XX, σ_YY, σ_XY by ε_XX, ε_YY, 2ε_XY, (3, 3)."""
        (c11, c12, c16), (_, c22, c26), _ = (C / C[2, 2]).tolist()
        return cls(c11, c12, c16, c22, c26)

    @property
    def stiffness(self) -> NDArray[np.float64]:
        """Stiffness over c₆₆, (3, 3)."""
        upper = [[self.c11, self.c12, self.c16], [0.0, self.c22, self.c26], [0.0, 0.0, 1.0]]
        return np.triu(upper) + np.triu(upper, 1).T

    @property
    def mirrored(self) -> "Admittance":
        """Admittance of the solid's mirror image in X = 0."""
        return Admittance(self.c11, self.c12, -self.c16, self.c22, -self.c26)

    def __call__(self, C: NDArray) -> NDArray[np.complex128]:
        """𝐘 of the roots with Im p > 0 at speeds (n,): (n, 2, 2)."""
        return np.asarray(np.linalg.inv(self.waves(C).L), dtype=complex)

    def waves(self, C: NDArray) -> Waves:
        """Two waves with Im p > 0 at speeds C, (n,)."""
        C = np.asarray(C, dtype=complex)
        s, d = self._sum_and_product(C)
        return Waves(
            Roots(s, d), *self.fields(s[:, None, None], d[:, None, None], (C * C)[:, None, None])
        )

    def fields(self, s: Any, d: Any, C2: Any) -> tuple[NDArray, NDArray]:
        """G and L, (..., 2, 2), of roots with the sum s and the product d at C², (..., 1, 1) each."""
        Q, mixed, T = self._parts
        G = np.linalg.solve(mixed + s * T, d * T - Q + C2 * np.eye(2))
        return G, np.array([[self.c16, 1.0], [self.c12, self.c26]]) + T @ G

    @cached_property
    def _parts(self) -> NDArray[np.float64]:
        """Q, R + Rᵀ and T, (3, 2, 2)."""
        mixed = [[2.0 * self.c16, self.c12 + 1.0], [self.c12 + 1.0, 2.0 * self.c26]]
        across = [[1.0, self.c26], [self.c26, self.c22]]
        return np.array([[[self.c11, self.c16], [self.c16, 1.0]], mixed, across])

    def _quartic(self, C2: Any) -> list[Any]:
        """Coefficients of p⁰ to p⁴ of the determinant at C²."""
        c11, c12, c16, c22, c26 = self.c11, self.c12, self.c16, self.c22, self.c26
        return [
            (c11 - C2) * (1.0 - C2) - c16 * c16,
            2.0 * (c16 * (1.0 - C2) + c26 * (c11 - C2) - (c12 + 1.0) * c16),
            (1.0 - C2) + 2.0 * c16 * c26 + c22 * (c11 - C2) - (c12 + 1.0) ** 2,
            2.0 * (c16 * c22 - c26 * c12) + 0.0 * C2,
            c22 - c26 * c26 + 0.0 * C2,
        ]

    def _sum_and_product(self, C: NDArray) -> tuple[NDArray, NDArray]:
        """Sum and product of the two roots with Im p > 0, (n,) each; polished.

        They keep their digits where the roots meet.
        """
        size = np.maximum(1.0, np.abs(C))
        a = np.array(self._quartic(C * C))
        b = (a / a[4] * size ** (np.arange(5)[:, None] - 4.0))[:4]  # of p over its size
        p = _roots(b)
        p = np.take_along_axis(p, np.argsort(-self._imaginary(p, C, size, b), axis=1), axis=1)
        s, d = _polished(p[:, :2].sum(axis=1), p[:, :2].prod(axis=1), p[:, 2:].prod(axis=1), b)
        return s * size, d * size**2

    def _imaginary(self, p: NDArray, C: NDArray, size: NDArray, b: NDArray) -> NDArray[np.float64]:
        """Imaginary parts of roots, (n, 4); where a root is real, its sign for Im C → -0."""
        imaginary = p.imag.copy()
        at = (C.imag == 0.0)[:, None] & (np.abs(p.imag) < _REAL * np.maximum(np.abs(p), 1.0))
        slope_p = 4.0 * p**3 + 3.0 * b[3][:, None] * p**2 + 2.0 * b[2][:, None] * p + b[1][:, None]
        whole = p * size[:, None]
        C2, a4 = (C * C)[:, None], self.c22 - self.c26**2
        by_C2 = (2.0 * C2 - self.c11 - 1.0) - 2.0 * (self.c16 + self.c26) * whole
        by_C2 = (by_C2 - (1.0 + self.c22) * whole**2) / a4
        with np.errstate(divide="ignore", invalid="ignore"):  # where two meet it does not matter which
            rate = -by_C2 * 2.0 * C[:, None] / (slope_p * size[:, None] ** 3)
        imaginary[at] = -_REAL * rate.real[at]
        return imaginary

    @cached_property
    def meeting(self) -> NDArray[np.float64]:
        """Real speeds > 0 at which a decaying root meets a growing one, from below.

        There the root is real, and the square of the speed of waves e^(ik(X + pY)) stationary in p.
        """
        φ = (np.arange(_DIRECTIONS + 1) / _DIRECTIONS - 0.5) * pi * (1.0 - 1.0 / _DIRECTIONS)
        low, high = np.tan(φ[:-1]), np.tan(φ[1:])
        speeds = []
        for sheet in (0, 1):
            below, above = self._slope(low, sheet), self._slope(high, sheet)
            turns = (below > 0.0) != (above > 0.0)
            start, end, rising = low[turns], high[turns], below[turns] > 0.0
            for _ in range(_HALVINGS):
                middle = (start + end) / 2.0
                first = (self._slope(middle, sheet) > 0.0) == rising
                start, end = np.where(first, middle, start), np.where(first, end, middle)
            speeds.append(np.linalg.eigvalsh(self._acoustic(start))[:, sheet])
        return np.unique(np.sqrt(np.concatenate(speeds)))

    def _acoustic(self, p: NDArray) -> NDArray[np.float64]:
        """Q(0) + p (R + Rᵀ) + p² T at real p (n,), (n, 2, 2)."""
        Q, mixed, T = self._parts
        return np.asarray(Q + np.multiply.outer(p, mixed) + np.multiply.outer(p * p, T))

    def _slope(self, p: NDArray, sheet: int) -> NDArray[np.float64]:
        """Derivative by p of the squared speed of the slower or the faster wave, (n,)."""
        _, mixed, across = self._parts
        wave = np.linalg.eigh(self._acoustic(p))[1][:, :, sheet]
        return np.einsum("ni,nij,nj->n", wave, mixed + 2.0 * np.multiply.outer(p, across), wave)

    @cached_property
    def fastest(self) -> float:
        """Largest speed of a wave inside, over all directions in the plane."""
        φ = np.linspace(-pi / 2.0, pi / 2.0, _DIRECTIONS, endpoint=False)[1:]
        waves = np.linalg.eigvalsh(self._acoustic(np.tan(φ)))[:, 1] * np.cos(φ) ** 2
        return float(np.sqrt(max(waves.max(), np.linalg.eigvalsh(self._parts[2])[1])))

    def residue(self, speed: float) -> NDArray[np.complex128]:
        """Residue of 𝐘 at the speed of the wave along the surface, (2, 2)."""
        radius = (self.meeting[0] - speed) / 2.0  # 𝐘 is analytic below the least of these speeds
        turn = np.exp(2j * pi * (np.arange(_CIRCLE) + 0.5) / _CIRCLE)
        around = self(speed + radius * turn)
        return np.asarray((radius * turn[:, None, None] * around).mean(axis=0))

    @property
    def impedance(self) -> NDArray[np.float64]:
        """Impedance over √(μρ) of plane waves straight down: tractions by surface velocities, (2, 2)."""
        λ, vectors = np.linalg.eigh(self._parts[2])
        return np.asarray(vectors * np.sqrt(λ) @ vectors.T)


def _roots(b: NDArray) -> NDArray[np.complex128]:
    """Roots of p⁴ + b₃p³ + …, (n, 4), from the coefficients of p⁰ to p³, (4, n)."""
    if not (b[1].any() or b[3].any()):
        middle = -b[2] / 2.0
        apart = np.sqrt(middle**2 - b[0])
        larger = middle + np.where((middle * apart.conj()).real < 0.0, -apart, apart)
        roots = np.sqrt(np.array([larger, b[0] / np.where(larger == 0.0, 1.0, larger)]))
        return np.concatenate([roots, -roots]).T
    companion = np.zeros((b.shape[1], 4, 4), dtype=complex)
    companion[:, [1, 2, 3], [0, 1, 2]] = 1.0
    companion[:, :, 3] = -b.T
    return np.asarray(np.linalg.eigvals(companion), dtype=complex)


def _polished(s: NDArray, d: NDArray, e: NDArray, b: NDArray) -> tuple[NDArray, NDArray]:
    """Sum and product of two roots of p⁴ + b₃p³ + …, by Newton's method for both quadratic factors.

    Args:
        s, d: approximate sum and product of the two, (n,).
        e: approximate product of the other two, (n,).
        b: coefficients of p⁰ to p³, (4, n).
    """
    for _ in range(3):  # roots begin with half the digits where two of them meet
        t = -b[3] - s  # sum of the other two
        rest = np.array([d + e + s * t - b[2], -(s * e + t * d) - b[1], d * e - b[0]])
        ones = np.ones_like(s)
        slopes = np.array([[t - s, ones, ones], [d - e, -t, -s], [0.0 * s, e, d]])
        with np.errstate(all="ignore"):
            try:
                step = np.linalg.solve(np.moveaxis(slopes, 2, 0), rest.T[..., None])[..., 0].T
            except np.linalg.LinAlgError:
                break  # a decaying root meets a growing one
        small = np.abs(step).max(axis=0) < 0.1 * np.maximum(1.0, np.abs(d))
        s, d, e = (value - np.where(small, change, 0.0) for value, change in zip((s, d, e), step))
    return s, d


@dataclass(frozen=True)
class AnisotropicFrame(UniformHalfPlane):
    """Half-plane of an anisotropic solid at a speed.

    Args:
        solid: its waves at all speeds.
        c: speed over √(c₆₆/ρ), 0 <= c < 1.

    Raises:
        ValueError: a wave in the solid is not faster.
    """

    solid: Admittance
    c: float

    def __post_init__(self) -> None:
        if (
            not 0.0 <= self.c < 1.0
            or (np.roots(self.solid._quartic(self.c**2)[::-1]).imag > 0.0).sum() != 2
        ):
            raise ValueError(f"c = {self.c!r}: expected a speed below that of all waves in the solid")

    @cached_property
    def roots(self) -> Roots:
        waves = self.solid.waves(np.array([self.c]))
        s, d = complex(waves.roots.sum[0]), complex(waves.roots.product[0])
        return Roots(1j * s.imag, complex(d.real)) if self.mirrored else Roots(s, d)

    @cached_property
    def _fields(self) -> tuple[NDArray[Any], NDArray[Any]]:
        return self.solid.fields(self.roots.sum, self.roots.product, self.c**2)

    @property
    def G(self) -> NDArray[Any]:
        return self._fields[0]

    @property
    def L(self) -> NDArray[Any]:
        return self._fields[1]

    @cached_property
    def least_stiffness(self) -> float:
        """Smallest eigenvalue of the surface's Hermitian stiffness -iL; it falls with speed."""
        Z = -1j * self.L
        return float(np.linalg.eigvalsh((Z + Z.conj().T) / 2.0)[0])

    @cached_property
    def margin(self) -> float:
        """Least stiffness over its value at rest; 0 at the speed of a wave along the surface."""
        return self.least_stiffness / AnisotropicFrame(self.solid, 0.0).least_stiffness

    @property
    def mirrored(self) -> bool:
        return self.solid.c16 == 0.0 == self.solid.c26

    @property
    def mirror_image(self) -> "AnisotropicFrame":
        return AnisotropicFrame(self.solid.mirrored, self.c)

    @property
    def admittance(self) -> Admittance:
        """Admittance of the surface at all speeds."""
        return self.solid

    @cached_property
    def C(self) -> NDArray[np.float64]:
        return self.solid.stiffness
