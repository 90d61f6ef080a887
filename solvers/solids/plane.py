"""Solids given by their stiffness in the plane, and their half-plane seen from a load that moves over it.

Orthotropic, cubic and anisotropic solids share this base. With the stiffness C over c₆₆ in the frame of
the scene, c the speed over √(c₆₆/ρ) and

    Q = [[c₁₁ - c², c₁₆], [c₁₆, c₆₆ - c²]],  R = [[c₁₆, c₁₂], [c₆₆, c₂₆]],  T = [[c₆₆, c₂₆], [c₂₆, c₂₂]]

the equations of motion are Q u,XX + (R + Rᵀ) u,XY + T u,YY = 0. Their solutions that decay below the
surface have u,Y = G u,X, where G solves T G² + (R + Rᵀ) G + Q = 0 and has the two roots p of

    det(Q + p (R + Rᵀ) + p² T) = 0,  Im p > 0,

as eigenvalues. Functions of the matrix G replace eigenvectors, so that nothing happens where roots meet.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from math import cos, pi, sin, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .potentials import Roots, line_loads, roots, value_and_change
from .solid import Potential


@dataclass(frozen=True)
class AnisotropicFrame:
    """Half-plane of an anisotropic solid at a speed, see :class:`galinx.solvers.solids.solid.Response`.

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

    #: Stiffnesses are over c₆₆.
    c66 = 1.0

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
    def T_inverse(self) -> NDArray[np.float64]:
        """Inverse T⁻¹ of the stiffness across, (2, 2)."""
        return np.asarray(np.linalg.inv(self._matrices[2]), dtype=float)

    @cached_property
    def _Y(self) -> NDArray[Any]:
        return np.linalg.inv(self.L)

    @cached_property
    def n(self) -> float:
        """Slope v,X by the Hilbert transform of σ_YY."""
        return float(-self._Y[1, 1].imag)

    @cached_property
    def m(self) -> float:
        """Strain u,X by the Hilbert transform of σ_XY."""
        return float(-self._Y[0, 0].imag)

    @cached_property
    def n12(self) -> float:
        """Slope v,X by the Hilbert transform of σ_XY, and strain by that of σ_YY."""
        return float(-(self._Y[0, 1] + self._Y[1, 0]).imag / 2.0)

    @cached_property
    def q(self) -> float:
        """Strain u,X by σ_YY, slope -v,X by σ_XY."""
        return float((self._Y[0, 1] - self._Y[1, 0]).real / 2.0)

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
    def contraction(self) -> complex:
        """Point midway between the roots in the hyperbolic metric of the half-plane."""
        return self.roots.midpoint

    @property
    def spread(self) -> float:
        """Hyperbolic distance of the roots."""
        return self.roots.apart

    @property
    def mirrored(self) -> bool:
        """True if the solid is its own mirror image in X = 0."""
        return self.c16 == 0.0 == self.c26

    def at(self, c: float) -> "AnisotropicFrame":
        """Half-plane of this solid at another speed c."""
        return AnisotropicFrame(self.c11, self.c12, self.c16, self.c22, self.c26, c)

    @cached_property
    def _C(self) -> NDArray[np.float64]:
        """Stiffness over c₆₆: σ_XX, σ_YY, σ_XY by ε_XX, ε_YY, 2ε_XY, (3, 3)."""
        return np.array(
            [
                [self.c11, self.c12, self.c16],
                [self.c12, self.c22, self.c26],
                [self.c16, self.c26, self.c66],
            ]
        )

    @cached_property
    def _along(self) -> NDArray[np.float64]:
        """Coefficients of u,X, σ_YY and σ_XY in σ_XX, (3,): Hooke's law, u,Y and v,Y eliminated."""
        s11, s12, s16 = np.linalg.inv(self._C)[0]
        return np.array([1.0, -s12, -s16]) / s11

    def σ_XX(self, u_X: Any, σ_YY: Any, σ_XY: Any) -> Any:
        """In-plane stress σ_XX from the strain μ u,X and the tractions, of one shape."""
        by_u_X, by_σ_YY, by_σ_XY = self._along
        return by_u_X * u_X + by_σ_YY * σ_YY + by_σ_XY * σ_XY

    def stresses(self, G: NDArray) -> NDArray[np.float64]:
        """Hooke's law: σ_XX, σ_YY, σ_XY over c₆₆ of displacement gradients (..., 2, 2)."""
        strains = [G[..., 0, 0], G[..., 1, 1], G[..., 0, 1] + G[..., 1, 0]]
        return np.einsum("ij,j...->i...", self._C, np.array(strains))

    def far(self, X: NDArray, Y: NDArray, terms: int) -> NDArray[np.float64]:
        """Displacements far away by moments of tractions."""
        return line_loads(self, X, Y, terms)

    def inside(self, Φ: Potential, g: Any, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """Stresses below a pressure by its potential at the matrix X + Y G; Y < 0.

        u,X = Re iΦ(X + Y G) 𝐘 (g, 1)ᵀ, and the tractions are those of the surface with 𝐘⁻¹ G 𝐘 for G.

        Raises:
            ValueError: a point has Y >= 0; the surface has formulas of its own.
        """
        X, Y = np.broadcast_arrays(np.asarray(X, dtype=float), np.asarray(Y, dtype=float))
        if np.any(Y >= 0.0):
            raise ValueError(f"Y/a = {Y.max()!r}: expected Y < 0; use the formulas of the surface there")
        p, other = self.roots.each
        z = X + p * Y
        # Φ of a matrix with two eigenvalues: Φ(z₁) + Φ[z₁, z₂] Y (G - p₁).
        at, change = (1j * part for part in value_and_change(Φ, z, Y + 0j, other - p))
        beyond = self.G - p * np.eye(2)
        strain = self._Y[0], (beyond @ self._Y)[0]
        tractions = np.eye(2), self.L @ beyond @ self._Y

        def part(first: NDArray, second: NDArray) -> NDArray[np.float64]:
            return ((first[0] * g + first[1]) * at + (second[0] * g + second[1]) * change).real

        u_X = part(*strain)
        σ_XY, σ_YY = (part(tractions[0][i], tractions[1][i]) for i in (0, 1))
        return np.array([self.σ_XX(u_X, σ_YY, σ_XY), σ_YY, σ_XY])


def surface_wave(solid: AnisotropicFrame) -> float:
    """Speed over √(c₆₆/ρ) of the wave along the surface, to the last digits.

    The surface's stiffness falls with speed until it has a zero, before that of the slowest wave inside
    is reached: bisection.
    """
    low, high = 0.0, 1.0
    while low < (middle := (low + high) / 2.0) < high:
        low, high = (middle, high) if _surface_is_stiff(solid, middle) else (low, middle)
    return low


def _surface_is_stiff(solid: AnisotropicFrame, c: float) -> bool:
    """True if the surface's stiffness is positive at the speed c."""
    try:
        return solid.at(c).least_stiffness > 0.0
    except ValueError:
        return False


#: Minor over the product of its diagonal that may be rounding alone.
_ROUNDING = 1e-13


class PlaneSolid(ABC):
    """A solid with a plane of symmetry normal to Z, in plane strain or plane stress."""

    form = "anisotropic"
    nearly_incompressible = False

    ρ: float
    plane: str

    @property
    @abstractmethod
    def stiffness(self) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY by ε_XX, ε_YY, 2ε_XY in the frame of the scene [Pa], (3, 3)."""

    @property
    def knows_σ_ZZ(self) -> bool:
        """True if the constants are enough for σ_ZZ."""
        return True

    @property
    def μ(self) -> float:
        """c₆₆ in the frame of the scene [Pa]."""
        return float(self.stiffness[2, 2])

    @property
    def c_s(self) -> float:
        """√(c₆₆/ρ) [m/s], the speed of the wave along X that shears across it, if there is one."""
        return sqrt(self.μ / self.ρ)

    @cached_property
    def _at_rest(self) -> AnisotropicFrame:
        (c11, c12, c16), (_, c22, c26), _ = (self.stiffness / self.μ).tolist()
        return AnisotropicFrame(c11, c12, c16, c22, c26, 0.0)

    @cached_property
    def _limit(self) -> float:
        return surface_wave(self._at_rest)

    def limit(self) -> float:
        """Speed of the wave along the surface over ``c_s``."""
        return self._limit

    @cached_property
    def flutter(self) -> tuple[float, float]:
        """Least σ_XY/σ_YY of either sign from which on short waves grow, infinite for none."""
        from ..transient.admittance import (
            Admittance,  # loaded where it is needed
            thresholds,
        )

        return thresholds(Admittance.of(self._at_rest))

    def response(self, c: float) -> AnisotropicFrame:
        """The half-plane at a speed over ``c_s``.

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
