"""Orthotropic, cubic and anisotropic solids: stiffness in the plane of the scene."""

from abc import abstractmethod
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from math import cos, pi, sin
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from galinx.texts import with_prefix

from ..approximation import bisected
from ..parameters import numbers, parameter
from .admittance import Admittance, AnisotropicFrame
from .flutter import Side, thresholds
from .solid import USUAL_STIFFNESS, Solid, angle, density, in_plane, modulus

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
        return AnisotropicFrame(Admittance.of_stiffness(self.stiffness), 0.0)

    @cached_property
    def _limit(self) -> float:
        def stiff(c: float) -> bool:
            with suppress(ValueError):
                return self.response(c).least_stiffness > 0.0
            return False

        return bisected(stiff, 1.0)

    def limit(self) -> float:
        """Speed of the wave along the surface over ``c_s``: there the surface's stiffness, which falls
        with speed, vanishes, before the speed of the slowest wave inside is reached."""
        return self._limit

    @cached_property
    def _flutter(self) -> tuple[float, float]:
        return thresholds(Side(self._at_rest.solid))

    def flutter(self, c: float = 0.0) -> tuple[float, float]:
        return self._flutter

    def response(self, c: float, a: float = 1.0) -> AnisotropicFrame:
        """The half-plane at a speed over ``c_s``; it has no length, whatever a is.

        Raises:
            ValueError: a wave in the solid is not faster.
        """
        return AnisotropicFrame(self._at_rest.solid, c)


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


def _modulus(key: str, about: str) -> float:
    return modulus(key, about, f"{key[0]}_{{{key[1:]}}}")


def _ratio(key: str, i: int, j: int) -> float:
    about = f"Poisson's ratio: contraction along {j} over extension along {i} where {i} is pulled"
    return parameter(key, about, symbol=rf"\nu_{{{i}{j}}}")


@dataclass(frozen=True)
class Orthotropic(PlaneSolid):
    """A solid with three planes of symmetry, whose axis 3 is Z.

    Raises:
        ValueError: a constant is outside its range, or together they are no elastic solid.
    """

    about: ClassVar[str] = "with axes 1 and 2 in the plane, at an angle, 3 along Z"

    E1: float = _modulus("E1", "Young's modulus along axis 1")
    E2: float = _modulus("E2", "Young's modulus along axis 2")
    E3: float = _modulus("E3", "Young's modulus along axis 3")
    ν12: float = _ratio("nu12", 1, 2)
    ν13: float = _ratio("nu13", 1, 3)
    ν23: float = _ratio("nu23", 2, 3)
    G12: float = _modulus("G12", "shear modulus in the plane of axes 1 and 2")
    ρ: float = density()
    angle: float = angle("axis 1")
    plane: str = in_plane()

    def __post_init__(self) -> None:
        super().__post_init__()
        meaning = {
            (0, 1): "1 - nu12² E2/E1",
            (0, 2): "1 - nu13² E3/E1",
            (1, 2): "1 - nu23² E3/E2",
            (0, 1, 2): "1 - nu12² E2/E1 - nu13² E3/E1 - nu23² E3/E2 - 2 nu12 nu13 nu23 E3/E1",
        }
        check_minors(self._compliance, meaning)

    @property
    def _compliance(self) -> NDArray[np.float64]:
        """ε₁, ε₂, ε₃ by σ₁, σ₂, σ₃ [1/Pa]."""
        s12, s13, s23 = -self.ν12 / self.E1, -self.ν13 / self.E1, -self.ν23 / self.E2
        return np.array([[1.0 / self.E1, s12, s13], [s12, 1.0 / self.E2, s23], [s13, s23, 1.0 / self.E3]])

    @cached_property
    def stiffness(self) -> NDArray[np.float64]:
        of_axes = np.zeros((3, 3))
        count = 3 if self.plane == "strain" else 2
        of_axes[:2, :2] = np.linalg.inv(self._compliance[:count, :count])[:2, :2]
        of_axes[2, 2] = self.G12
        return rotated(of_axes, self.angle)

    def σ_ZZ(self, σ_XX: NDArray, σ_YY: NDArray, σ_XY: NDArray) -> NDArray[np.float64]:
        """Normal stress out of the plane: no strain along axis 3, or 0 in plane stress."""
        σ_1, σ_2 = along_axes(σ_XX, σ_YY, σ_XY, self.angle)
        held = self.E3 * (self.plane == "strain")
        return held * (self.ν13 / self.E1 * σ_1 + self.ν23 / self.E2 * σ_2)

    def words(self) -> str:
        E1, E2, E3, G12 = (with_prefix(value, "Pa") for value in (self.E1, self.E2, self.E3, self.G12))
        return (
            f"E1 = {E1}, E2 = {E2}, E3 = {E3}, ν12 = {self.ν12:g}, ν13 = {self.ν13:g}, "
            f"ν23 = {self.ν23:g}, G12 = {G12}, axis 1 at {self.angle:g}° from X, ρ = {self.ρ:g} kg/m³ "
            f"in plane {self.plane}"
        )


@dataclass(frozen=True)
class Cubic(PlaneSolid):
    """A cubic crystal whose axis [001] is Z.

    Raises:
        ValueError: a constant is outside its range, or together they are no elastic solid.
    """

    about: ClassVar[str] = "with [100] and [010] in the plane, at an angle, [001] along Z"

    c11: float = modulus("c11", "stiffness c11", "c_{11}")
    c12: float = parameter("c12", "stiffness c12", "Pa", symbol="c_{12}")
    c44: float = modulus("c44", "stiffness c44", "c_{44}")
    ρ: float = density()
    angle: float = angle("axis 1, [100]")
    plane: str = in_plane()

    def __post_init__(self) -> None:
        super().__post_init__()
        normal = np.full((3, 3), self.c12) + (self.c11 - self.c12) * np.eye(3)
        check_minors(normal, {(0, 1): "1 - (c12/c11)²", (0, 1, 2): "(1 - c12/c11)² (1 + 2 c12/c11)"})

    @cached_property
    def stiffness(self) -> NDArray[np.float64]:
        c11, c12 = self.c11, self.c12
        if self.plane == "stress":
            c11, c12 = c11 - c12**2 / c11, c12 - c12**2 / self.c11
        return rotated(np.array([[c11, c12, 0.0], [c12, c11, 0.0], [0.0, 0.0, self.c44]]), self.angle)

    def σ_ZZ(self, σ_XX: NDArray, σ_YY: NDArray, σ_XY: NDArray) -> NDArray[np.float64]:
        """Normal stress out of the plane: no strain along [001], or 0 in plane stress."""
        share = self.c12 / (self.c11 + self.c12) if self.plane == "strain" else 0.0
        return share * (σ_XX + σ_YY)

    def words(self) -> str:
        c11, c12, c44 = (with_prefix(value, "Pa") for value in (self.c11, self.c12, self.c44))
        return (
            f"c11 = {c11}, c12 = {c12}, c44 = {c44}, [100] at {self.angle:g}° from X, "
            f"ρ = {self.ρ:g} kg/m³ in plane {self.plane}"
        )


@dataclass(frozen=True)
class Anisotropic(PlaneSolid):
    """A solid by its stiffness in the plane.

    Raises:
        ValueError: a constant is not finite, or together they are no elastic solid.
    """

    about: ClassVar[str] = "by its stiffness in the frame of the scene, X the motion, Y up"

    constants: tuple[float, ...] = numbers(
        "stiffness", "stiffness c11, c12, c16, c22, c26, c66", "Pa", 6, usual=USUAL_STIFFNESS,
        note="σ_XX, σ_YY, σ_XY by ε_XX, ε_YY, 2ε_XY with no strain along Z; in plane stress with no "
        "stress along Z",
    )  # fmt: skip
    ρ: float = density()
    along_Z: tuple[float, ...] = numbers(
        "stiffness_Z", "stiffness c13, c23, c36", "Pa", 3, optional=True,
        note="determines σ_ZZ in plane strain, which is NaN without it",
    )  # fmt: skip
    plane: str = in_plane()

    def __post_init__(self) -> None:
        super().__post_init__()
        for name, value in zip(("c11", "c22", "c66"), np.diag(self.stiffness).tolist()):
            if value <= 0.0:
                raise ValueError(f"stiffness: found {name} = {value:g} Pa, expected a number > 0")
        rows = "[[c11, c12, c16], [c12, c22, c26], [c16, c26, c66]]"
        meaning = {
            (0, 1): "stiffness: 1 - c12²/(c11 c22)",
            (0, 2): "stiffness: 1 - c16²/(c11 c66)",
            (1, 2): "stiffness: 1 - c26²/(c22 c66)",
            (0, 1, 2): f"stiffness: the determinant of {rows} over c11 c22 c66",
        }
        check_minors(self.stiffness, meaning)

    @cached_property
    def stiffness(self) -> NDArray[np.float64]:
        c11, c12, c16, c22, c26, c66 = self.constants
        return np.array([[c11, c12, c16], [c12, c22, c26], [c16, c26, c66]])

    @property
    def knows_σ_ZZ(self) -> bool:
        return self.plane == "stress" or bool(self.along_Z)

    def σ_ZZ(self, σ_XX: NDArray, σ_YY: NDArray, σ_XY: NDArray) -> NDArray[np.float64]:
        """Normal stress out of the plane: no strain along Z, or 0 in plane stress; NaN if not known."""
        if self.plane == "stress":
            return 0.0 * σ_XX
        if not self.knows_σ_ZZ:
            return np.full(np.shape(σ_XX), np.nan)
        by_XX, by_YY, by_XY = np.linalg.solve(self.stiffness, self.along_Z)
        return by_XX * σ_XX + by_YY * σ_YY + by_XY * σ_XY

    def words(self) -> str:
        names = ("c11", "c12", "c16", "c22", "c26", "c66")
        constants = ", ".join(
            f"{name} = {with_prefix(value, 'Pa')}" for name, value in zip(names, self.constants)
        )
        return f"{constants}, ρ = {self.ρ:g} kg/m³ in plane {self.plane}"
