"""The flat punch of the study, which may be tilted."""

from dataclasses import dataclass
from math import pi
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from galinx.texts import with_prefix

from ..parameters import check, parameter
from .profile import PROFILES


@dataclass(frozen=True)
class Flat:
    """A flat punch with two sharp edges, the base of which may be tilted.

    Raises:
        ValueError: the half-width is not positive, or the tilt is no small angle.
    """

    about: ClassVar[str] = "flat"

    half_width: float = parameter(
        "half_width", "half-width a", "m", symbol="a", above=0.0, usual=(1e-9, 0.5),
        note="dimensionless results do not depend on it",
    )  # fmt: skip
    tilt: float = parameter(
        "tilt", "tilt of the base, counterclockwise", "deg", symbol=r"\theta", default=0.0,
        above=-45.0, below=45.0, usual=(-5.0, 5.0),
        note="positive: the right edge is the higher one, and lifts off first",
    )  # fmt: skip

    def __post_init__(self) -> None:
        check(self)

    @property
    def sharp(self) -> tuple[bool, bool]:
        """True for the edge that always touches, left and right: the higher edge may lift off."""
        return self.tilt >= 0.0, self.tilt <= 0.0

    @property
    def rise(self) -> float:
        """Slope of the base, dimensionless: by linear theory the angle itself."""
        return self.tilt * pi / 180.0

    def height(self, X: NDArray) -> NDArray[np.float64]:
        lowest = -self.half_width if self.tilt >= 0.0 else self.half_width
        return self.rise * (np.asarray(X) - lowest) if self.tilt else np.zeros_like(X)

    def slope(self, X: NDArray) -> NDArray[np.float64]:
        return np.full_like(X, self.rise, dtype=float)

    def words(self) -> str:
        tilted = f", tilted by {self.tilt:g}° counterclockwise" * bool(self.tilt)
        return f"flat punch, half-width {with_prefix(self.half_width, 'm')}{tilted}"


PROFILES.register("flat", Flat)
