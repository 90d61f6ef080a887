"""A wedge with two equal flanks."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..parameters import check, parameter
from .profile import PROFILES


@dataclass(frozen=True)
class Wedge:
    """A wedge of the height ``slope_of_flanks``·|X|; the pressure at its tip is infinite.

    Raises:
        ValueError: the slope is not positive.
    """

    about: ClassVar[str] = "wedge"
    sharp: ClassVar[tuple[bool, bool]] = (False, False)
    kinks: ClassVar[tuple[float, ...]] = (0.0,)
    jumps: ClassVar[bool] = True
    exponent: ClassVar[float] = 1.0

    slope_of_flanks: float = parameter(
        "slope", "slope of both flanks", "rad", symbol="s", above=0.0, usual=(1e-6, 0.2),
        note='a number, or an angle to the surface as `"1 deg"`, which linear theory takes for the '
        "slope; it has to be small",
    )  # fmt: skip

    def __post_init__(self) -> None:
        check(self)

    def height(self, X: NDArray) -> NDArray[np.float64]:
        return self.slope_of_flanks * np.abs(X)

    def slope(self, X: NDArray) -> NDArray[np.float64]:
        return self.slope_of_flanks * np.sign(X)

    def words(self) -> str:
        return f"wedge, slope of its flanks {self.slope_of_flanks:g}"


PROFILES.register("wedge", Wedge)
