"""Cubic crystals: silicon, copper, nickel and many more."""

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from galinx.texts import with_prefix

from ..parameters import check, parameter
from .plane import PlaneSolid, check_minors, rotated
from .solid import SOLIDS, angle, density, in_plane, modulus


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
    angle: float = angle("[100]")
    plane: str = in_plane()

    def __post_init__(self) -> None:
        check(self)
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


SOLIDS.register("cubic", Cubic)
