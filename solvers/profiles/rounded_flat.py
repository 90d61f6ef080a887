"""A flat punch with rounded shoulders."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from galinx.texts import with_prefix

from ..parameters import check, parameter
from .profile import PROFILES


@dataclass(frozen=True)
class RoundedFlat:
    """Flat up to ``flat_half_width``, parabolas of ``radius`` beyond.

    Raises:
        ValueError: a length is not positive.
    """

    about: ClassVar[str] = "flat with rounded shoulders"
    sharp: ClassVar[tuple[bool, bool]] = (False, False)

    flat_half_width: float = parameter(
        "flat_half_width", "half-width of the flat part", "m", symbol="b", above=0.0, usual=(1e-9, 0.5)
    )
    radius: float = parameter(
        "radius", "radius of the rounded shoulders", "m", symbol="R", above=0.0, usual=(1e-9, 1e3)
    )

    def __post_init__(self) -> None:
        check(self)

    @property
    def kinks(self) -> tuple[float, float]:
        """Ends of the flat part [m], at which the curvature jumps."""
        return -self.flat_half_width, self.flat_half_width

    def height(self, X: NDArray) -> NDArray[np.float64]:
        return np.maximum(np.abs(X) - self.flat_half_width, 0.0) ** 2 / (2.0 * self.radius)

    def slope(self, X: NDArray) -> NDArray[np.float64]:
        beyond = np.maximum(np.abs(X) - self.flat_half_width, 0.0)
        return np.sign(X) * beyond / self.radius

    def words(self) -> str:
        return (
            f"punch, flat up to {with_prefix(self.flat_half_width, 'm')} on both sides, "
            f"shoulders of radius {with_prefix(self.radius, 'm')}"
        )


PROFILES.register("rounded_flat", RoundedFlat)
