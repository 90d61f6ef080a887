"""A cylinder, as contact mechanics has it: a parabola."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..parameters import check, parameter
from .profile import PROFILES


@dataclass(frozen=True)
class Parabolic:
    """A parabola X²/(2R), which a cylinder of radius R is near its lowest point.

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
        return f"parabolic punch, radius {self.radius:g} m"


PROFILES.register("parabolic", Parabolic)
