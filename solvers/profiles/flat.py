"""The flat punch of the study."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.parameters import check, parameter
from galinx.solvers.profiles.profile import PROFILES


@dataclass(frozen=True)
class Flat:
    """A flat punch with two sharp edges.

    Raises:
        ValueError: the half-width is not positive.
    """

    about: ClassVar[str] = "flat"

    half_width: float = parameter(
        "half_width", "half-width a", "m", symbol="a", above=0.0, usual=(1e-9, 0.5),
        note="dimensionless results do not depend on it",
    )  # fmt: skip

    def __post_init__(self) -> None:
        check(self)

    def height(self, X: NDArray) -> NDArray[np.float64]:
        return np.zeros_like(X)

    def slope(self, X: NDArray) -> NDArray[np.float64]:
        return np.zeros_like(X)

    def words(self) -> str:
        return f"flat punch, half-width {self.half_width:g} m"


PROFILES.register("flat", Flat)
