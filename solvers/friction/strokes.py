"""Sequences of strokes: forward from X = 0 to L, backward from X = L to 0, always on one axis."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from galinx.solvers.friction.dahl import Dahl, exact, runge_kutta

#: Direction of sliding by the name of a stroke.
DIRECTION = {"forward": 1, "backward": -1}

#: (law, f at the start, direction, length [m], slip since the start [m]) -> f.
Integrator = Callable[[Dahl, float, int, float, NDArray[np.float64]], NDArray[np.float64]]


@dataclass(frozen=True)
class Stroke:
    """One stroke's ``name`` (FM1, BM1, FM2, …), ``direction`` (±1), positions and friction."""

    name: str
    direction: int
    X_over_L: NDArray[np.float64]
    f: NDArray[np.float64]


def names(strokes: Sequence[str]) -> list[str]:
    """Names of the strokes in the study's manner: FM1, BM1, FM2 for forward, backward, forward."""
    counts = {"forward": 0, "backward": 0}
    result = []
    for stroke in strokes:
        counts[stroke] += 1
        result.append(f"{stroke[0].upper()}M{counts[stroke]}")
    return result


def integrate_exactly(law: Dahl, f0: float, s: int, length: float, d: NDArray) -> NDArray:
    """The exact solution as an :data:`Integrator`."""
    return exact(law, f0, s, d)


def integrate_by_runge_kutta(law: Dahl, f0: float, s: int, length: float, d: NDArray) -> NDArray:
    """The study's scheme, 20 steps a stroke, as an :data:`Integrator`.

    A position between two steps is reached by a shorter last step, so no interpolation error enters.
    """
    steps = runge_kutta(law, f0, s, length, 20)
    f = np.empty_like(d)
    for i, slip in enumerate(d):
        j = min(int(np.floor(slip / length * 20 + 1e-9)), 20)
        rest = max(slip - steps.d[j], 0.0)
        f[i] = runge_kutta(law, steps.f[j], s, rest, 1).f[1] if rest > 1e-12 * length else steps.f[j]
    return f


#: Integrators by the name that scenes use.
INTEGRATORS: dict[str, Integrator] = {"exact": integrate_exactly, "rk4": integrate_by_runge_kutta}


def friction_along(
    law: Dahl,
    strokes: Sequence[str],
    length: float,
    X_over_L: ArrayLike,
    integrator: str = "exact",
) -> list[Stroke]:
    """Friction coefficient at given positions of every stroke, starting from rest (f = 0).

    Args:
        law: parameters of Dahl's law.
        strokes: ``"forward"`` or ``"backward"``, in order of time.
        length: length L of a stroke (pre-sliding displacement) [m].
        X_over_L: positions in [0, 1], dimensionless; each stroke lists them in the order of travel.
        integrator: ``"exact"`` or ``"rk4"``.

    Returns:
        One :class:`Stroke` a stroke.
    """
    advance = INTEGRATORS[integrator]
    positions = np.unique(np.asarray(X_over_L, dtype=float))
    result, f0 = [], 0.0
    for name, stroke in zip(names(strokes), strokes):
        s = DIRECTION[stroke]
        X = positions if s > 0 else positions[::-1]
        slip = length * (X if s > 0 else 1.0 - X)
        values = advance(law, f0, s, length, np.append(slip, length))
        result.append(Stroke(name, s, X, values[:-1]))
        f0 = float(values[-1])
    return result
