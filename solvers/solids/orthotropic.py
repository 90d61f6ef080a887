"""Orthotropic solids: fibre composites, wood, rolled sheets; hexagonal crystals, too."""

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from galinx.texts import with_prefix

from ..parameters import check, parameter
from .plane import PlaneSolid, along_axes, check_minors, rotated
from .solid import SOLIDS, angle, density, in_plane, modulus


def _modulus(key: str, about: str) -> float:
    return modulus(key, about, f"{key[0]}_{{{key[1:]}}}")


def _ratio(key: str, one: int, other: int) -> float:
    about = f"Poisson's ratio: contraction along {other} over extension along {one} where {one} is pulled"
    return parameter(key, about, symbol=rf"\nu_{{{one}{other}}}")


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
        check(self)
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


SOLIDS.register("orthotropic", Orthotropic)
