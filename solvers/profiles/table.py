"""A convex punch given by points of its surface."""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from galinx.texts import with_prefix

from ..parameters import check, rows
from .profile import PROFILES

#: Relative difference of slopes that is rounding of the given numbers.
_ROUNDING = 1e-12


@dataclass(frozen=True)
class Table:
    """A profile through given points, with a continuous slope.

    Between two points the height is one parabola, or two that meet (Schumaker, SIAM Journal on Numerical
    Analysis 20 (1983) 853), so that a convex table gives a convex profile; at the points the slope is
    the mean of those beside, weighted by the neighbouring lengths.

    Raises:
        ValueError: fewer than three points, not in their order, not convex, or without a lowest point
            between the first and the last; the message says where.
    """

    about: ClassVar[str] = "table"
    sharp: ClassVar[tuple[bool, bool]] = (False, False)

    shape: tuple[tuple[float, float], ...] = rows(
        "shape", "points [X, P] of the punch's surface, P its height", ("m", "m"),
        note="convex, with the lowest point inside; the contact must not reach beyond them",
    )  # fmt: skip

    def __post_init__(self) -> None:
        check(self)
        X, P = self._points
        if len(X) < 3:
            raise ValueError(f"shape: found {len(X)} points, expected at least 3")
        if np.any(np.diff(X) <= 0.0):
            at = X[1:][np.diff(X) <= 0.0][0]
            raise ValueError(f"shape: found X = {at:g} m after a larger or equal one, expected growing X")
        secants = np.diff(P) / np.diff(X)
        falls = np.diff(secants) < -_ROUNDING * np.abs(secants).max()
        if falls.any():
            at = ", ".join(f"X = {x:g} m" for x in X[1:-1][falls][:3])
            raise ValueError(
                f"shape: not convex at {at}, where the slope falls; expected one that never does: a "
                "punch with two bumps would have two contacts, which are not solved"
            )
        if not secants[0] < 0.0 < secants[-1]:
            raise ValueError("shape: expected a lowest point between the first and the last")

    @property
    def _points(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        X, P = np.array(self.shape, dtype=float).reshape(-1, 2).T
        return X, P

    @property
    def reach(self) -> tuple[float, float]:
        """First and last position [m] at which the punch is known."""
        return self.shape[0][0], self.shape[-1][0]

    @cached_property
    def _knots(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Knots [m] between which the slope is linear, and slopes there, (knots,) each."""
        X, P = self._points
        δ, Δ = np.diff(P) / np.diff(X), np.diff(X)
        d = np.empty(len(X))
        d[1:-1] = (Δ[1:] * δ[:-1] + Δ[:-1] * δ[1:]) / (Δ[1:] + Δ[:-1])
        d[0], d[-1] = 2.0 * δ[0] - d[1], 2.0 * δ[-1] - d[-2]
        knots, slopes = [X[0]], [d[0]]
        for i, ((x0, x1), (d0, d1)) in enumerate(zip(pairwise(X), pairwise(d))):
            # Two parabolas, whose slopes meet at ξ, where one cannot have both slopes and the height.
            if abs(d0 + d1 - 2.0 * δ[i]) > _ROUNDING * np.abs(δ).max():
                near_left = δ[i] - d0 > d1 - δ[i]
                share = (d1 - δ[i] if near_left else δ[i] - d0) / (d1 - d0)
                ξ = x0 + Δ[i] * share if near_left else x1 - Δ[i] * share
                knots.append(ξ)
                slopes.append((2.0 * δ[i] * Δ[i] - (ξ - x0) * d0 - (x1 - ξ) * d1) / Δ[i])
            knots.append(x1)
            slopes.append(d1)
        return np.array(knots), np.array(slopes)

    @cached_property
    def _pieces(self) -> tuple[NDArray[np.float64], ...]:
        """Lowest places [m] of pieces; heights [m], slopes, curvatures [1/m] there, (knots - 1,) each.

        Heights are summed from the lowest point on, where no term takes away from another: rounding of
        the height of a far point would be a step at the next kink, under which the pressure is infinite.
        """
        x, s = self._knots
        lowest = np.interp(0.0, s, x)
        at = np.asarray(np.clip(lowest, x[:-1], x[1:]))
        slope = np.where(x[1:] <= lowest, s[1:], np.where(x[:-1] >= lowest, s[:-1], 0.0))
        rises = (x[1:] - at) * (slope + s[1:]) / 2.0
        falls = (x[:-1] - at) * (slope + s[:-1]) / 2.0
        height = np.append(0.0, np.cumsum(rises[:-1])) + np.append(np.cumsum(falls[:0:-1])[::-1], 0.0)
        return at, height, slope, np.asarray(np.diff(s) / np.diff(x))

    def _piece(self, X: NDArray) -> tuple[NDArray[np.float64], ...]:
        """Distance [m] of X [m] from its piece's lowest place; height, slope and curvature there."""
        x, _ = self._knots
        X = np.asarray(X, dtype=float)
        i = np.clip(np.searchsorted(x, X) - 1, 0, len(x) - 2)
        at, height, slope, curvature = (each[i] for each in self._pieces)
        return np.asarray(X - at), height, slope, curvature

    @property
    def kinks(self) -> tuple[float, ...]:
        """Positions [m] at which parabolas meet, and the curvature jumps."""
        return tuple(self._knots[0].tolist())

    def height(self, X: NDArray) -> NDArray[np.float64]:
        d, height, slope, curvature = self._piece(X)
        return height + slope * d + curvature * d**2 / 2.0

    def slope(self, X: NDArray) -> NDArray[np.float64]:
        """Slope at X [m], linear between knots; beyond the table as in its first and last piece."""
        d, _, slope, curvature = self._piece(X)
        return slope + curvature * d

    def words(self) -> str:
        first, last = (with_prefix(end, "m") for end in self.reach)
        return f"punch through {len(self.shape)} points from X = {first} to {last}"


PROFILES.register("table", Table)
