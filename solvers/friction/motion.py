"""Motions: strokes along one axis, X = 0 to L, and the friction along them.

A stroke has a direction, a speed and a rest before it. Friction along it is the law's states and friction
coefficient at given positions, its work, its largest value and its slope at the start.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .integrate import INTEGRATORS, Integrator, work
from .law import FrictionLaw

#: Direction of sliding by the name of a stroke.
DIRECTION = {"forward": 1, "backward": -1}


@dataclass(frozen=True)
class Partial:
    """A stroke from the end of the stroke before it, the first from X = 0.

    Attributes:
        to: position of its end, over L.
        speed: its own [m/s], None: that of the state.
        rest: time at rest before it [s], None: as between all strokes.
    """

    to: float
    speed: float | None = None
    rest: float | None = None


@dataclass(frozen=True)
class Leg:
    """A stroke with its name, direction, ends, speed and rest.

    Attributes:
        name: FM1, BM1, FM2, ….
        s: direction, ±1.
        start, end: positions of its ends, over L.
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
        """Length of the stroke, over L."""
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
    """Legs of strokes one after the other.

    Args:
        strokes: ``"forward"`` goes from X = 0 to L and ``"backward"`` from L to 0, wherever the stroke
            before ended; partial strokes go on from its end.
        rest: time at rest between them [s].

    Raises:
        ValueError: a stroke has no length.
    """
    result, at = list[_Ends](), 0.0
    for n, stroke in enumerate(strokes):
        if isinstance(stroke, str):
            stroke, at = Partial(float(stroke == "forward")), float(stroke == "backward")
        if stroke.to == at:
            raise ValueError(f"stroke {n + 1} goes to {at:g} L, where it begins: expected another end")
        before = (rest if n else 0.0) if stroke.rest is None else stroke.rest
        result.append((at, stroke.to, stroke.speed, before))
        at = stroke.to
    return _named(result)


def legs_of_path(path: Sequence[tuple[float, float]], length: float) -> tuple[Leg, ...]:
    """Legs of a motion that is given point by point; two equal positions in turn are a rest.

    Args:
        path: time [s] and position [m] of each point; between points the speed is constant.
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
    result, speeds, rest = list[_Ends](), dict[str, float](), 0.0
    for (t, X), (t_next, X_next) in pairwise(path):
        if X_next == X:
            rest += t_next - t
            continue
        speed = abs(X_next - X) / (t_next - t)
        # Speeds that differ by rounding are one speed, at which a contact is solved once.
        speed = speeds.setdefault(f"{speed:.11e}", speed)
        result.append((X / length, X_next / length, speed, rest))
        rest = 0.0
    if not result:
        raise ValueError("found one position in all rows, expected a motion")
    return _named(result)


#: Ends over L, speed and rest of a stroke.
_Ends = tuple[float, float, float | None, float]


def _named(strokes: Sequence[_Ends]) -> tuple[Leg, ...]:
    """Legs with names and directions."""
    directions = [1 if end > start else -1 for start, end, *_ in strokes]
    return tuple(Leg(name, s, *ends) for name, s, ends in zip(names(directions), directions, strokes))


def last_cycle(all_legs: Sequence[Leg]) -> int | None:
    """Number of the first stroke of the last closed cycle of strokes; None where none is closed."""
    for first in range(len(all_legs) - 2, -1, -1):
        if all_legs[first].end != all_legs[first + 1].start:
            return None
        if all_legs[first].start == all_legs[-1].end:
            return first
    return None


#: Share of a stroke over which a slope is a difference, where no formula gives it.
_NEAR = 1e-6
#: Tops of friction along a stroke that are refined, refinements of each between its neighbours, places of
#: these, and least of the places that grow by ratios, over the stroke.
_TOPS, _CLOSER, _PLACES, _NEAREST = 3, 2, 101, 1e-9


@dataclass(frozen=True)
class Stroke:
    """One stroke of a law, or of many at once, whose arrays then begin with (laws, …).

    Attributes:
        z: states of the law at places in the order of travel, (n, states).
        f: friction coefficient there, positive forward, (n,).
    """

    z: NDArray[np.float64]
    f: NDArray[np.float64]


def friction_along(
    law: FrictionLaw,
    strokes: Sequence[str | Partial],
    length: float,
    X_over_L: ArrayLike,
    V: float = 0.0,
    integrator: str = "exact",
) -> list[Stroke]:
    """Friction at given positions of every stroke, starting from rest.

    Args:
        law: the law.
        strokes: ``"forward"``, ``"backward"`` or partial ones, in order of time.
        length: length L of a stroke (pre-sliding displacement) [m].
        X_over_L: positions in [0, 1], dimensionless.
        V: speed [m/s].
        integrator: ``"exact"`` or ``"rk4"``.

    Returns:
        A :class:`Stroke` for each of ``strokes``.

    Raises:
        ValueError: the integrator is unstable or not for this law, or a stroke has no length.
    """
    all_legs = legs(strokes)
    places = [positions(leg, X_over_L) for leg in all_legs]
    return follow(law, all_legs, length, places, V, INTEGRATORS[integrator])


def positions(leg: Leg, X_over_L: ArrayLike) -> NDArray[np.float64]:
    """Positions over L among ``X_over_L`` that a stroke passes, in the order of travel, (n,)."""
    X = np.unique(np.asarray(X_over_L, dtype=float))
    low, high = sorted((leg.start, leg.end))
    X = X[(low <= X) & (high >= X)]
    return X if leg.s > 0 else X[::-1]


def follow(
    law: FrictionLaw,
    all_legs: Sequence[Leg],
    length: float,
    places: Sequence[NDArray],
    V: float,
    advance: Integrator,
    many: bool = False,
) -> list[Stroke]:
    """Friction at given places of every stroke, starting from rest.

    Args:
        law: the law; with ``many`` its parameters are (laws, 1).
        all_legs: the strokes.
        length: L [m].
        places: over L, on each stroke, in the order of travel.
        V: speed of strokes that have none of their own [m/s].
        advance: how states advance.
        many: True if the law stands for many.

    Raises:
        ValueError: the integrator is unstable or not for this law, or friction is not finite.
    """
    result, z = [], _at_rest(law, many)
    for leg, X in zip(all_legs, places):
        speed = V if leg.speed is None else leg.speed
        slip, whole = length * np.abs(X - leg.start), length * leg.length
        with np.errstate(all="ignore"):  # both are checked below
            states = advance(law, law.pause(z, leg.rest), leg.s, speed, whole, np.append(slip, whole))
            passed = states[..., :-1, :]
            f = 1.0 * law.friction(passed, leg.s, speed)
        if odd := [
            what
            for what, of in (("friction coefficient", f), ("state", states))
            if not np.isfinite(of).all()
        ]:
            raise ValueError(
                f"along {leg.name} found a {odd[0]} that is not finite; expected parameters of "
                f"{law.about} with which doubles can compute it: is one of them far from its usual size?"
            )
        result.append(Stroke(passed, f))
        z = _last(states, z)
    return result


def works(
    law: FrictionLaw,
    all_legs: Sequence[Leg],
    length: float,
    V: float,
    advance: Integrator,
    many: bool = False,
) -> NDArray[np.float64]:
    """Work, largest friction and first slope of every stroke, starting from rest, per normal force.

    Args:
        law, all_legs, length, V, advance, many: as of :func:`follow`.

    Returns:
        ∫ s f dX [m], the largest s f, dimensionless, and s df/dX at the start [1/m]: (3, laws, strokes),
        one law without ``many``.
    """
    result, z = [], _at_rest(law, many)
    for leg in all_legs:
        speed = V if leg.speed is None else leg.speed
        z, whole = law.pause(z, leg.rest), length * leg.length
        dissipated = work(law, z, leg.s, speed, whole)
        largest, end = _largest(law, z, leg.s, speed, whole, advance)
        slope = law.slope(z, leg.s, speed)
        if slope is None:
            ends = advance(law, z, leg.s, speed, whole, np.array([0.0, _NEAR * whole]))
            f = law.friction(ends, leg.s, speed)
            slope = leg.s * (f[..., 1] - f[..., 0]) / (_NEAR * whole)
        elif many:
            slope = slope[..., 0]
        result.append(np.broadcast_arrays(np.atleast_1d(dissipated), largest, slope))
        z = _last(end, z)
    return np.moveaxis(result, 0, -1)


def _at_rest(law: FrictionLaw, many: bool) -> NDArray[np.float64]:
    z = law.rest()
    return np.reshape(z, (1, 1, -1)) if many and z.ndim == 1 else z


def _last(states: NDArray, z: NDArray) -> NDArray[np.float64]:
    """Last of the states of a stroke, in the form of ``z``."""
    return states[-1] if z.ndim == 1 else states[..., -1:, :]


def _largest(
    law: FrictionLaw, z: NDArray, s: int, V: float, length: float, advance: Integrator
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Largest s f of a stroke, and its states, the last one at its end.

    The largest value is refined for one law alone: friction of many laws at once is monotonic.
    """
    slip, single = np.linspace(0.0, length, _PLACES), z.ndim == 1
    if single:  # most happens where a stroke begins, and at the kinks of the law
        kinks = law.kinks(z, s, V)
        more = length * np.geomspace(_NEAREST, 1.0, _PLACES), kinks[(kinks > 0.0) & (kinks < length)]
        slip = np.unique(np.concatenate([slip, *more]))
    states = advance(law, z, s, V, length, slip)
    f = float(s) * law.friction(states, s, V)
    largest, padded = f.max(axis=-1), np.pad(f, 1, constant_values=-np.inf)
    tops = np.flatnonzero((f >= padded[:-2]) & (f >= padded[2:])) if single else np.empty(0, dtype=int)
    for n in tops[np.argsort(-f[tops], kind="stable")][:_TOPS]:
        at, top = slip, int(n)
        for _ in range(_CLOSER):
            sides = at[max(top - 1, 0)], at[top], at[min(top + 1, len(at) - 1)]
            at = np.unique(np.linspace(sides[:2], sides[1:], _PLACES // 2))
            f = float(s) * law.friction(advance(law, z, s, V, length, at), s, V)
            largest, top = np.maximum(largest, f.max()), int(np.argmax(f))
    return largest, states
