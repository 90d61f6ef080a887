"""Punches whose height is a power of the distance from their lowest point: parabola, wedge, any power."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from galinx.texts import with_prefix

from ..parameters import check, parameter
from .profile import PROFILES


@dataclass(frozen=True)
class Parabolic:
    """A parabola X²/(2R): a cylinder of radius R near its lowest point, as contact mechanics has it.

    Raises:
        ValueError: the radius is not positive.
    """

    about: ClassVar[str] = "parabolic"
    sharp: ClassVar[tuple[bool, bool]] = (False, False)
    exponent: ClassVar[float] = 2.0

    radius: float = parameter("radius", "radius R", "m", symbol="R", above=0.0, usual=(1e-9, 1e3))

    def __post_init__(self) -> None:
        check(self)

    def height(self, X: NDArray) -> NDArray[np.float64]:
        return np.asarray(X) ** 2 / (2.0 * self.radius)

    def slope(self, X: NDArray) -> NDArray[np.float64]:
        return np.asarray(X) / self.radius

    def words(self) -> str:
        return f"parabolic punch, radius {with_prefix(self.radius, 'm')}"


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


PROFILES.register("parabolic", Parabolic)
PROFILES.register("power", Power)
PROFILES.register("wedge", Wedge)
