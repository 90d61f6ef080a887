"""A punch whose height is a power of the distance from its lowest point."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..parameters import check, parameter
from .profile import PROFILES


@dataclass(frozen=True)
class Power:
    """The height ``coefficient``·|X|^``exponent``, X in m.

    Raises:
        ValueError: the exponent is not above 1, or the coefficient is not positive.
    """

    about: ClassVar[str] = "power"
    sharp: ClassVar[tuple[bool, bool]] = (False, False)
    kinks: ClassVar[tuple[float, ...]] = (0.0,)

    exponent: float = parameter("exponent", "exponent k", "", symbol="k", above=1.0, at_most=20.0)
    coefficient: float = parameter(
        "coefficient", "height at X = 1 m, as a number", "", symbol="c", above=0.0,
        note="for a height of 1 µm at 1 mm with the exponent 3: 1e-6/(1e-3)^3 = 1000",
    )  # fmt: skip

    def __post_init__(self) -> None:
        check(self)

    def height(self, X: NDArray) -> NDArray[np.float64]:
        return self.coefficient * np.abs(X) ** self.exponent

    def slope(self, X: NDArray) -> NDArray[np.float64]:
        size = np.abs(X) ** (self.exponent - 1.0)
        return self.coefficient * self.exponent * np.sign(X) * size

    def words(self) -> str:
        return f"punch of the height {self.coefficient:g}·|X|^{self.exponent:g} (m)"


PROFILES.register("power", Power)
