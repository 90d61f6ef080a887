"""Solids given by their stiffness in the plane: what orthotropic, cubic and anisotropic ones share."""

from abc import ABC, abstractmethod
from functools import cached_property
from math import cos, pi, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.solids.anisotropic_frame import AnisotropicFrame, surface_wave

#: A minor over the product of its diagonal that rounding alone could leave.
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
        """Are the constants enough for σ_ZZ?"""
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
        from galinx.solvers.transient.admittance import Admittance  # loaded where it is needed
        from galinx.solvers.transient.flutter import thresholds

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
    """Is a symmetric matrix positive definite?

    Args:
        matrix: (n, n).
        meaning: of minors by their rows, with the constants that make them, in order of size.

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
                "deformation would give energy instead of taking it"
            )
