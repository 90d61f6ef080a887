"""Punches: flat, a power of the distance from the lowest point, rounded, given by points."""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from math import pi
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from galinx.texts import with_prefix

from ..parameters import parameter, rows
from .profile import PROFILES, Profile


@dataclass(frozen=True)
class Flat(Profile):
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
        "tilt", "tilt of the base, counterclockwise", "deg", symbol=r"\phi", default=0.0,
        above=-45.0, below=45.0, usual=(-5.0, 5.0),
        note="positive: the right edge is the higher one, and lifts off first",
    )  # fmt: skip

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

    def middle(self, half_width: Any) -> Any:
        """Middle [m] of a contact of this half-width [m] from which the higher edge has lifted off."""
        return np.sign(self.rise) * (half_width - self.half_width)

    def words(self) -> str:
        tilted = f", tilted by {self.tilt:g}° counterclockwise" * bool(self.tilt)
        return f"flat punch, half-width {with_prefix(self.half_width, 'm')}{tilted}"


def is_level(profile: Any) -> bool:
    """Return True for a flat punch that is not tilted."""
    return isinstance(profile, Flat) and not profile.tilt


@dataclass(frozen=True)
class Parabolic(Profile):
    """A parabola X²/(2R): a cylinder of radius R near its lowest point, as contact mechanics has it.

    Raises:
        ValueError: the radius is not positive.
    """

    about: ClassVar[str] = "parabolic"
    sharp: ClassVar[tuple[bool, bool]] = (False, False)
    exponent: ClassVar[float] = 2.0

    radius: float = parameter("radius", "radius R", "m", symbol="R", above=0.0, usual=(1e-9, 1e3))

    def height(self, X: NDArray) -> NDArray[np.float64]:
        return np.asarray(X) ** 2 / (2.0 * self.radius)

    def slope(self, X: NDArray) -> NDArray[np.float64]:
        return np.asarray(X) / self.radius

    def words(self) -> str:
        return f"parabolic punch, radius {with_prefix(self.radius, 'm')}"


@dataclass(frozen=True)
class Power(Profile):
    """The height ``coefficient``·|X|^``exponent``, X in m.

    Raises:
        ValueError: the exponent is not above 1, or the coefficient is not positive.
    """

    about: ClassVar[str] = "power"
    sharp: ClassVar[tuple[bool, bool]] = (False, False)

    exponent: float = parameter("exponent", "exponent k", "", symbol="k", above=1.0, at_most=20.0)
    coefficient: float = parameter(
        "coefficient", "height at X = 1 m, as a number", "", symbol="c", above=0.0,
        note="for a height of 1 µm at 1 mm with the exponent 3: 1e-6/(1e-3)^3 = 1000",
    )  # fmt: skip

    @property
    def kinks(self) -> tuple[float, ...]:
        return () if self.exponent % 2.0 == 0.0 else (0.0,)

    def height(self, X: NDArray) -> NDArray[np.float64]:
        return self.coefficient * np.abs(X) ** self.exponent

    def slope(self, X: NDArray) -> NDArray[np.float64]:
        size = np.abs(X) ** (self.exponent - 1.0)
        return self.coefficient * self.exponent * np.sign(X) * size

    def words(self) -> str:
        return f"punch of the height {self.coefficient:g}·|X|^{self.exponent:g} (m)"


@dataclass(frozen=True)
class Wedge(Profile):
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
        "slope", "slope of both flanks, their angle", "rad", symbol="s", above=0.0, usual=(1e-6, 0.2),
        note='a number, or an angle as `"1 deg"`, which linear theory takes for the slope; '
        "it has to be small",
    )  # fmt: skip

    def height(self, X: NDArray) -> NDArray[np.float64]:
        return self.slope_of_flanks * np.abs(X)

    def slope(self, X: NDArray) -> NDArray[np.float64]:
        return self.slope_of_flanks * np.sign(X)

    def words(self) -> str:
        return f"wedge, slope of its flanks {self.slope_of_flanks:g}"


@dataclass(frozen=True)
class RoundedFlat(Profile):
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
        "radius", "radius R, of the rounded shoulders", "m", symbol="R", above=0.0, usual=(1e-9, 1e3)
    )

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


#: Relative difference of slopes that is rounding of the given numbers; most that a slope changes next to
#: a point of a table over its change at the next one: 0 next to three points on a straight line.
_ROUNDING, _BEND = 1e-12, 1e3


@dataclass(frozen=True)
class Table(Profile):
    """A profile through given points, with a continuous slope.

    Between two points the height is one parabola, or two that meet (Schumaker, SIAM Journal on Numerical
    Analysis 20 (1983) 853), so that a convex table gives a convex profile; at the points the slope is
    the mean of those beside, weighted by the neighbouring lengths, or that of a straight run of points.

    Raises:
        ValueError: fewer than three points, not in their order, not convex, with a corner between two
            straight runs, or without a lowest point between the first and the last; the message says
            where.
    """

    about: ClassVar[str] = "table"
    sharp: ClassVar[tuple[bool, bool]] = (False, False)

    shape: tuple[tuple[float, float], ...] = rows(
        "shape", "points [X, P] of the punch's surface, P its height", ("m", "m"),
        note="convex, with the lowest point inside; the contact must not reach beyond them",
    )  # fmt: skip

    def __post_init__(self) -> None:
        super().__post_init__()
        X, _ = self._points
        if len(X) < 3:
            raise ValueError(f"shape: found {len(X)} points, expected at least 3")
        if np.any(np.diff(X) <= 0.0):
            at = X[1:][np.diff(X) <= 0.0][0]
            raise ValueError(f"shape: found X = {at:g} m after a larger or equal one, expected growing X")
        secants, rounding = self._secants, self._rounding
        falls = np.diff(secants) < -rounding
        if falls.any():
            at = ", ".join(f"X = {x:g} m" for x in X[1:-1][falls][:3])
            raise ValueError(
                f"shape: not convex at {at}, where the slope falls; expected one that never does: a "
                "punch with two bumps would have two contacts, which are not solved"
            )
        if not secants[0] < 0.0 < secants[-1]:
            raise ValueError("shape: expected a lowest point between the first and the last")
        least, most = self._bounds
        if len(corners := X[1:-1][least > most + rounding]):
            at = ", ".join(f"X = {x:g} m" for x in corners[:3])
            raise ValueError(
                f"shape: found a corner between straight runs of points at {at}, under which pressure is "
                "infinite; expected a rounded one: points beside it that are not in a straight line"
            )

    @property
    def _points(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        X, P = np.array(self.shape, dtype=float).reshape(-1, 2).T
        return X, P

    @cached_property
    def _secants(self) -> NDArray[np.float64]:
        """Mean slopes between neighbouring points, (points - 1,)."""
        X, P = self._points
        return np.asarray(np.diff(P) / np.diff(X))

    @property
    def _rounding(self) -> float:
        """Difference of two slopes that is rounding."""
        return _ROUNDING * float(np.abs(self._secants).max())

    @property
    def reach(self) -> tuple[float, float]:
        """First and last position [m] at which the punch is known."""
        return self.shape[0][0], self.shape[-1][0]

    @cached_property
    def _bounds(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Least and largest slope at each inner point, the least above the largest at a corner.

        A piece on which the slope changes at one of its points, and hardly else, would have a jump there.
        """
        secants, change = self._secants, np.diff(self._secants)
        change[change < self._rounding] = 0.0
        beside = _BEND * np.concatenate([[np.inf], change, [np.inf]])
        return secants[1:] - beside[2:], secants[:-1] + beside[:-2]

    @cached_property
    def _knots(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Knots [m] between which the slope is linear, and slopes there, (knots,) each."""
        X, _ = self._points
        δ, Δ = self._secants, np.diff(X)
        d = np.empty(len(X))
        d[1:-1] = np.clip((Δ[1:] * δ[:-1] + Δ[:-1] * δ[1:]) / (Δ[1:] + Δ[:-1]), *self._bounds)
        d[0], d[-1] = 2.0 * δ[0] - d[1], 2.0 * δ[-1] - d[-2]
        knots, slopes = [X[0]], [d[0]]
        for i, ((x0, x1), (d0, d1)) in enumerate(zip(pairwise(X), pairwise(d))):
            # Two parabolas, whose slopes meet at ξ, where one cannot have both slopes and the height.
            if abs(d0 + d1 - 2.0 * δ[i]) > self._rounding:
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


PROFILES.register("flat", Flat)
PROFILES.register("parabolic", Parabolic)
PROFILES.register("power", Power)
PROFILES.register("wedge", Wedge)
PROFILES.register("rounded_flat", RoundedFlat)
PROFILES.register("table", Table)
