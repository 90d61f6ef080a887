"""Anisotropic solids with a plane of symmetry normal to Z."""

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from galinx.texts import with_prefix

from ..parameters import check, numbers
from .plane import PlaneSolid, check_minors
from .solid import SOLIDS, USUAL_STIFFNESS, density, in_plane


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
        check(self)
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


SOLIDS.register("anisotropic", Anisotropic)
