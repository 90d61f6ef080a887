"""Solids given by their stiffness in the plane, and their half-plane seen from a load that moves over it.

Orthotropic, cubic and anisotropic solids share this base. With the stiffness C over c₆₆ in the frame of
the scene, c the speed over √(c₆₆/ρ) and

    Q = [[c₁₁ - c², c₁₆], [c₁₆, c₆₆ - c²]],  R = [[c₁₆, c₁₂], [c₆₆, c₂₆]],  T = [[c₆₆, c₂₆], [c₂₆, c₂₂]]

the equations of motion are Q u,XX + (R + Rᵀ) u,XY + T u,YY = 0. Their solutions that decay below the
surface have u,Y = G u,X, where G solves T G² + (R + Rᵀ) G + Q = 0 and has the two roots p of

    det(Q + p (R + Rᵀ) + p² T) = 0,  Im p > 0,

as eigenvalues. Functions of the matrix G replace eigenvectors, so that nothing happens where roots meet.
"""

from abc import abstractmethod
from dataclasses import dataclass
from functools import cached_property
from math import cos, pi, sin
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..approximation import bisected
from .half_plane import Roots, UniformHalfPlane
from .solid import Solid


@dataclass(frozen=True)
class AnisotropicFrame(UniformHalfPlane):
    """Half-plane of an anisotropic solid at a speed.

    Args:
        c11, c12, c16, c22, c26: stiffness over c₆₆, positive definite.
        c: speed over √(c₆₆/ρ), 0 <= c < 1.

    Raises:
        ValueError: a wave in the solid is not faster.
    """

    c11: float
    c12: float
    c16: float
    c22: float
    c26: float
    c: float

    def __post_init__(self) -> None:
        if not 0.0 <= self.c < 1.0 or self._decaying_roots is None:
            raise ValueError(f"c = {self.c!r}: expected a speed below that of all waves in the solid")

    @cached_property
    def _matrices(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Matrices Q, R and T of the equations of motion, (2, 2) each."""
        inertia = (self.c * self.c) * np.eye(2)
        Q = np.array([[self.c11, self.c16], [self.c16, self.c66]]) - inertia
        R = np.array([[self.c16, self.c12], [self.c66, self.c26]])
        T = np.array([[self.c66, self.c26], [self.c26, self.c22]])
        return Q, R, T

    @cached_property
    def _decaying_roots(self) -> Roots | None:
        """Roots p with Im p > 0, None where a root is real."""
        Q, R, T = self._matrices
        mixed = R + R.T
        first, second, third = np.array([T, mixed, Q])[:, [0, 0, 1], [0, 1, 1]].T
        return roots(np.convolve(first, third) - np.convolve(second, second))

    @property
    def roots(self) -> Roots:
        """Roots p of the planes X + pY in which the fields are analytic, Im p > 0."""
        assert self._decaying_roots
        return self._decaying_roots

    @cached_property
    def G(self) -> NDArray[Any]:
        """Matrix of u,Y = G u,X of decaying fields: the quadratic less T times that of the roots."""
        Q, R, T = self._matrices
        return np.linalg.solve(R + R.T + self.roots.sum * T, self.roots.product * T - Q)

    @cached_property
    def L(self) -> NDArray[Any]:
        """Stiffness of the surface, (σ_XY, σ_YY) = L u,X of decaying fields, (2, 2)."""
        _, R, T = self._matrices
        return R.T + T @ self.G

    @cached_property
    def least_stiffness(self) -> float:
        """Smallest eigenvalue of the surface's Hermitian stiffness -iL; it falls with speed."""
        Z = -1j * self.L
        return float(np.linalg.eigvalsh((Z + Z.conj().T) / 2.0)[0])

    @cached_property
    def margin(self) -> float:
        """Least stiffness over its value at rest; 0 at the speed of a wave along the surface."""
        return self.least_stiffness / self.at(0.0).least_stiffness

    @property
    def mirrored(self) -> bool:
        """True if the solid is its own mirror image in X = 0."""
        return self.c16 == 0.0 == self.c26

    @property
    def mirror_image(self) -> "AnisotropicFrame":
        return AnisotropicFrame(self.c11, self.c12, -self.c16, self.c22, -self.c26, self.c)

    def at(self, c: float) -> "AnisotropicFrame":
        """Half-plane of this solid at another speed c."""
        return AnisotropicFrame(self.c11, self.c12, self.c16, self.c22, self.c26, c)

    @cached_property
    def C(self) -> NDArray[np.float64]:
        """Stiffness over c₆₆: σ_XX, σ_YY, σ_XY by ε_XX, ε_YY, 2ε_XY, (3, 3)."""
        return np.array(
            [
                [self.c11, self.c12, self.c16],
                [self.c12, self.c22, self.c26],
                [self.c16, self.c26, self.c66],
            ]
        )


#: Steps of Newton's method at most: it begins with half the digits where the roots meet.
_STEPS = 10


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


def _surface_is_stiff(solid: AnisotropicFrame, c: float) -> bool:
    """True if the surface's stiffness is positive at the speed c."""
    try:
        return solid.at(c).least_stiffness > 0.0
    except ValueError:
        return False


#: Minor over the product of its diagonal that may be rounding alone.
_ROUNDING = 1e-13


class PlaneSolid(Solid):
    """A solid with a plane of symmetry normal to Z, in plane strain or plane stress."""

    form = "anisotropic"

    ρ: float
    plane: str

    @property
    @abstractmethod
    def stiffness(self) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY by ε_XX, ε_YY, 2ε_XY in the frame of the scene [Pa], (3, 3)."""

    @property
    def μ(self) -> float:
        """c₆₆ in the frame of the scene [Pa]."""
        return float(self.stiffness[2, 2])

    @cached_property
    def _at_rest(self) -> AnisotropicFrame:
        (c11, c12, c16), (_, c22, c26), _ = (self.stiffness / self.μ).tolist()
        return AnisotropicFrame(c11, c12, c16, c22, c26, 0.0)

    @cached_property
    def _limit(self) -> float:
        return bisected(lambda c: _surface_is_stiff(self._at_rest, c), 1.0)

    def limit(self) -> float:
        """Speed of the wave along the surface over ``c_s``: there the surface's stiffness, which falls
        with speed, vanishes, before the speed of the slowest wave inside is reached."""
        return self._limit

    @cached_property
    def _flutter(self) -> tuple[float, float]:
        from ..transient.flutter import Side, thresholds  # loaded where it is needed

        return thresholds(Side.of(self))

    def flutter(self, c: float = 0.0) -> tuple[float, float]:
        return self._flutter

    def response(self, c: float, a: float = 1.0) -> AnisotropicFrame:
        """The half-plane at a speed over ``c_s``; it has no length, whatever a is.

        Raises:
            ValueError: a wave in the solid is not faster.
        """
        return self._at_rest.at(c)


def rotated(stiffness: NDArray, angle: float) -> NDArray[np.float64]:
    """A stiffness (3, 3) whose first axis is turned by an angle [°] from X towards Y.

    Right angles are exact.
    """
    quarters, rest = divmod(angle, 90.0)
    φ = rest * pi / 180.0
    c, s = cos(φ), sin(φ)
    for _ in range(int(quarters % 4.0)):
        c, s = -s, c
    T = np.array(
        [[c * c, s * s, -2.0 * s * c], [s * s, c * c, 2.0 * s * c], [s * c, -s * c, c * c - s * s]]
    )
    turned = T @ stiffness @ T.T
    return (turned + turned.T) / 2.0


def along_axes(σ_XX: NDArray, σ_YY: NDArray, σ_XY: NDArray, angle: float) -> tuple[NDArray, NDArray]:
    """Normal stresses along the solid's axes 1 and 2, the first at an angle [°] from X towards Y."""
    mean, half = (σ_XX + σ_YY) / 2.0, (σ_XX - σ_YY) / 2.0
    twice = angle % 180.0 * pi / 90.0  # of any angle, however large
    deviation = half * cos(twice) + σ_XY * sin(twice)
    return mean + deviation, mean - deviation


def check_minors(matrix: NDArray, meaning: dict[tuple[int, ...], str]) -> None:
    """Check that a symmetric matrix is positive definite.

    Args:
        matrix: (n, n).
        meaning: formulas of minors in the constants, by the rows of the minor, in order of size.

    Raises:
        ValueError: a minor is not positive; the message has its meaning and value.
    """
    diagonal = np.sqrt(np.abs(np.diag(matrix)))
    for rows, constants in meaning.items():
        part = matrix[np.ix_(rows, rows)] / np.outer(diagonal[list(rows)], diagonal[list(rows)])
        if not np.diag(part).min() > 0.0:
            minor = float(np.diag(part).min())
        else:
            minor = float(np.linalg.det(part))
        if not minor > _ROUNDING:
            raise ValueError(
                f"{constants}: found {minor:.3g}, expected a number > 0; with these constants some "
                "deformation would release energy instead of storing it"
            )
