"""Motions: strokes along one axis, X = 0 to L, and the direction, speed and rest that each has."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

#: Digits after the point by which speeds differ.
_DIGITS = 11
#: Direction of sliding by the name of a stroke.
DIRECTION = {"forward": 1, "backward": -1}


@dataclass(frozen=True)
class Partial:
    """A stroke from where the one before it ended, the first from X = 0.

    Attributes:
        to: where it ends, over L.
        speed: its own [m/s], None: that of the state.
        rest: time at rest before it [s], None: as between all strokes.
    """

    to: float
    speed: float | None = None
    rest: float | None = None


@dataclass(frozen=True)
class Leg:
    """A stroke with all that is known of it.

    Attributes:
        name: FM1, BM1, FM2, ….
        s: direction, ±1.
        start, end: where it begins and ends, over L.
        speed: its own [m/s], None: that of the state.
        rest: time at rest before it [s].
    """

    name: str
    s: int
    start: float
    end: float
    speed: float | None = None
    rest: float = 0.0

    @property
    def length(self) -> float:
        """Of the stroke, over L."""
        return abs(self.end - self.start)


def names(directions: Sequence[int]) -> list[str]:
    """Names of strokes in the study's manner: FM1, BM1, FM2 for forward, backward, forward."""
    counts = {1: 0, -1: 0}
    result = []
    for s in directions:
        counts[s] += 1
        result.append(f"{'FM' if s > 0 else 'BM'}{counts[s]}")
    return result


def legs(strokes: Sequence[str | Partial], rest: float = 0.0) -> tuple[Leg, ...]:
    """Strokes one after the other.

    Args:
        strokes: ``"forward"`` goes from X = 0 to L and ``"backward"`` from L to 0, wherever the one
            before ended; others go on from there.
        rest: time at rest between them [s].

    Raises:
        ValueError: a stroke has no length.
    """
    found: list[Leg] = []
    at = 0.0
    for n, stroke in enumerate(strokes):
        if isinstance(stroke, str):
            stroke, at = Partial(float(stroke == "forward")), float(stroke == "backward")
        if stroke.to == at:
            raise ValueError(f"stroke {n + 1} goes to {at:g} L, where it begins: expected another end")
        before = (rest if n else 0.0) if stroke.rest is None else stroke.rest
        found.append(Leg("", 1 if stroke.to > at else -1, at, stroke.to, stroke.speed, before))
        at = stroke.to
    return _named(found)


def legs_of_path(path: Sequence[tuple[float, float]], length: float) -> tuple[Leg, ...]:
    """The strokes of a motion that is given point by point; where it stays is a rest.

    Args:
        path: time [s] and position [m] of each point; between them it moves at one speed.
        length: L [m].

    Raises:
        ValueError: time does not grow, a position is not on the axis, or nothing moves.
    """
    if any(not later > earlier for (earlier, _), (later, _) in pairwise(path)):
        raise ValueError("found times that do not grow, expected later ones in every row")
    outside = [X for _, X in path if not 0.0 <= X <= length]
    if outside:
        raise ValueError(
            f"found the position {outside[0]:g} m, expected 0 to pre_sliding = {length:g} m in all rows"
        )
    found: list[Leg] = []
    speeds: dict[str, float] = {}
    rest = 0.0
    for (t, X), (t_next, X_next) in pairwise(path):
        if X_next == X:
            rest += t_next - t
            continue
        speed = abs(X_next - X) / (t_next - t)
        # What rounding alone tells apart is one speed, at which a contact is solved once.
        speed = speeds.setdefault(f"{speed:.{_DIGITS}e}", speed)
        found.append(Leg("", 1 if X_next > X else -1, X / length, X_next / length, speed, rest))
        rest = 0.0
    if not found:
        raise ValueError("found one position in all rows, expected a motion")
    return _named(found)


def _named(found: Sequence[Leg]) -> tuple[Leg, ...]:
    called = names([leg.s for leg in found])
    return tuple(
        Leg(name, leg.s, leg.start, leg.end, leg.speed, leg.rest) for name, leg in zip(called, found)
    )


def last_cycle(all_legs: Sequence[Leg]) -> int | None:
    """The first of the last strokes that together come back to where they began; None where none do."""
    for first in range(len(all_legs) - 2, -1, -1):
        if all_legs[first].end != all_legs[first + 1].start:
            return None
        if all_legs[first].start == all_legs[-1].end:
            return first
    return None
