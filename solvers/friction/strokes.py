"""Friction along strokes: states, and what a stroke costs and begins with."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from galinx.solvers.friction.integrate import INTEGRATORS, Integrator, work
from galinx.solvers.friction.law import FrictionLaw
from galinx.solvers.friction.motion import Leg, Partial, legs

#: Share of a stroke over which a slope is a difference, where no formula gives it.
_NEAR = 1e-6
#: Times that the largest friction of a stroke is looked for between its neighbours, and places there.
_CLOSER, _PLACES = 2, 101


@dataclass(frozen=True)
class Stroke:
    """One stroke of a law, or of many at once, whose arrays then begin with (laws, …).

    Attributes:
        name: FM1, BM1, FM2, ….
        direction: ±1.
        X_over_L: positions in the order of travel, (n,).
        z: states of the law there, (n, states).
        f: friction coefficient there, positive forward, (n,).
    """

    name: str
    direction: int
    X_over_L: NDArray[np.float64]
    z: NDArray[np.float64]
    f: NDArray[np.float64]


@dataclass(frozen=True)
class Work:
    """What a stroke takes, per normal force: of one law (), of many (laws,).

    Attributes:
        dissipated: ∫ s f dX [m].
        breakaway: largest s f.
        slope: s df/dX where it begins [1/m].
    """

    dissipated: NDArray[np.float64]
    breakaway: NDArray[np.float64]
    slope: NDArray[np.float64]


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
        One :class:`Stroke` a stroke.

    Raises:
        ValueError: the integrator cannot do it, or a stroke has no length.
    """
    all_legs = legs(strokes)
    places = [positions(leg, X_over_L) for leg in all_legs]
    return follow(law, all_legs, length, places, V, INTEGRATORS[integrator])


def positions(leg: Leg, X_over_L: ArrayLike) -> NDArray[np.float64]:
    """Those of some positions over L that a stroke passes, in the order of travel."""
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
        law: the law; with ``many`` one whose parameters are (laws, 1).
        all_legs: the strokes.
        length: L [m].
        places: over L, on each stroke, in the order of travel.
        V: speed of strokes that have none of their own [m/s].
        advance: how states advance.
        many: does the law stand for many?

    Raises:
        ValueError: the integrator cannot do it, or friction is beyond what doubles can hold.
    """
    result, z = [], _at_rest(law, many)
    for leg, X in zip(all_legs, places):
        speed = V if leg.speed is None else leg.speed
        slip, whole = length * np.abs(X - leg.start), length * leg.length
        with np.errstate(all="ignore"):  # what comes of it is looked at
            states = advance(law, law.pause(z, leg.rest), leg.s, speed, whole, np.append(slip, whole))
            passed = states[..., :-1, :]
            f = law.friction(passed, leg.s, speed)
        if not np.isfinite(f).all():
            raise ValueError(
                f"along {leg.name} found a friction coefficient that is not finite; expected "
                f"parameters of {law.about} with which doubles can compute it: is one of them far from "
                "its usual size?"
            )
        result.append(Stroke(leg.name, leg.s, X, passed, f))
        z = _last(states, z)
    return result


def works(
    law: FrictionLaw,
    all_legs: Sequence[Leg],
    length: float,
    V: float,
    advance: Integrator,
    many: bool = False,
) -> list[Work]:
    """What every stroke takes, starting from rest; arguments as of :func:`follow`."""
    result, z = [], _at_rest(law, many)
    for leg in all_legs:
        speed = V if leg.speed is None else leg.speed
        z, whole = law.pause(z, leg.rest), length * leg.length
        dissipated = work(law, z, leg.s, speed, whole, advance)
        largest, end = _largest(law, z, leg.s, speed, whole, advance)
        slope = law.slope(z, leg.s, speed)
        if slope is None:
            ends = advance(law, z, leg.s, speed, whole, np.array([0.0, _NEAR * whole]))
            f = law.friction(ends, leg.s, speed)
            slope = leg.s * (f[..., 1] - f[..., 0]) / (_NEAR * whole)
        elif many:
            slope = slope[..., 0]
        result.append(Work(dissipated, largest, slope))
        z = _last(end, z)
    return result


def _at_rest(law: FrictionLaw, many: bool) -> NDArray[np.float64]:
    z = law.rest()
    return np.reshape(z, (1, 1, -1)) if many and z.ndim == 1 else z


def _last(states: NDArray, z: NDArray) -> NDArray[np.float64]:
    """The last of some states, in the form of ``z``."""
    return states[-1] if z.ndim == 1 else states[..., -1:, :]


def _largest(
    law: FrictionLaw, z: NDArray, s: int, V: float, length: float, advance: Integrator
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The largest s f of a stroke, and states that end with that at its end.

    Many laws at once all build up or fall all along.
    """
    slip = np.linspace(0.0, length, _PLACES)
    states = advance(law, z, s, V, length, slip)
    f = s * law.friction(states, s, V)
    largest, at = f.max(axis=-1), slip
    for _ in range(_CLOSER if z.ndim == 1 else 0):
        n = int(np.argmax(f))
        if not 0 < n < len(at) - 1:
            break
        at = np.linspace(at[n - 1], at[n + 1], _PLACES)
        f = s * law.friction(advance(law, z, s, V, length, at), s, V)
        largest = np.maximum(largest, f.max())
    return largest, states
