"""Friction as it was measured."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..parameters import rows
from .law import LAWS, FrictionLaw, MeasuredFriction


@dataclass(frozen=True)
class Table(FrictionLaw):
    """Friction as it was measured: f over the slip since motion turned round, linear between pairs::

        f = F(d) forward,   f = B(d) backward

    Without B, backward is the mirror image, -F. Beyond the last pair f stays; before the first stroke the
    slip is zero. A loop is closed where F starts with what B ends with. Its state is d over the last slip
    of F, and the direction.

    Raises:
        ValueError: slips do not grow from zero.
    """

    about: ClassVar[str] = "a measured table"
    depends_on_speed: ClassVar[bool] = False

    shape: tuple[tuple[float, float], ...] = rows(
        "shape", "friction forward, pairs of slip since the reversal [m] and f", ("m", ""),
        measured=(1,), note="slips grow from 0",
    )  # fmt: skip
    shape_backward: tuple[tuple[float, float], ...] = rows(
        "shape_backward", "friction backward", ("m", ""), optional=True,
        note="f is negative there, as a rule; the mirror image of `shape` where it is not given",
    )  # fmt: skip

    def __post_init__(self) -> None:
        super().__post_init__()
        for key, table in (("shape", self.shape), ("shape_backward", self.shape_backward)):
            slips = [row[0] for row in table]
            if table and (slips[0] != 0.0 or slips != sorted(set(slips)) or len(slips) < 2):
                raise ValueError(
                    f"{key}: found the slips {slips} m, expected two or more that grow from 0"
                )

    @classmethod
    def guess(cls, measured: MeasuredFriction) -> dict[str, Any]:
        slips = np.linspace(0.0, measured.length, max(measured.rows, 2))
        return {"shape": tuple((float(d), measured.level * float(d > 0.0)) for d in slips)}

    def rest(self) -> NDArray[np.float64]:
        return np.zeros(2)

    def rate(self, z: NDArray, s: int, V: float = 0.0) -> NDArray[np.float64]:
        """Rates [1/m]: the scaled slip grows evenly, the direction stays."""
        return np.array([1.0 / self._scale, 0.0])

    def settle(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """State of the other branch at its start after a reversal."""
        return np.array([self._start(z, s) / self._scale, float(s)])

    def friction(self, z: NDArray, s: int, V: float = 0.0) -> NDArray[np.float64]:
        d, f = self._branch(s)
        return np.interp(z[..., 0] * self._scale, d, f)

    def exact(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64]:
        d = self._start(z, s) + np.asarray(slip, dtype=float)
        return np.stack([d / self._scale, np.full(np.shape(d), float(s))], axis=-1)

    def kinks(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        return self._branch(s)[0] - self._start(z, s)

    def work(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64]:
        first = self._start(z, s)
        return s * (self._area(first + np.asarray(slip), s) - self._area(np.array(first), s))

    def slope(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """Slope of the next piece of the table; at the start of a stroke z is of the stroke before."""
        d, f = self._branch(s)
        slopes = np.append(np.diff(f) / np.diff(d), 0.0)
        at = np.where(s * z[..., 1] > 0.0, z[..., 0] * self._scale, 0.0)
        return s * slopes[np.searchsorted(d, at, side="right") - 1]

    def _branch(self, s: int) -> NDArray[np.float64]:
        """Slips [m] and f, (2, pairs)."""
        if s > 0 or self.shape_backward:
            return np.array(self.shape if s > 0 else self.shape_backward).T
        d, f = np.array(self.shape).T
        return np.array([d, -f])

    @property
    def _scale(self) -> float:
        return self.shape[-1][0]

    def _start(self, z: NDArray, s: int) -> float:
        return float(z[0]) * self._scale if s * z[1] > 0.0 else 0.0

    def _area(self, slip: NDArray, s: int) -> NDArray[np.float64]:
        """∫ f dd from 0 [m]."""
        d, f = self._branch(s)
        areas = np.append(0.0, np.cumsum(0.5 * (f[1:] + f[:-1]) * np.diff(d)))
        piece = np.clip(np.searchsorted(d, slip, side="right") - 1, 0, len(d) - 1)
        return areas[piece] + 0.5 * (f[piece] + np.interp(slip, d, f)) * (slip - d[piece])


LAWS.register("table", Table)
