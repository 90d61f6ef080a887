"""Sequences of strokes: forward from X = 0 to L, backward from X = L to 0, always on one axis."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from galinx.solvers.friction.integrate import INTEGRATORS
from galinx.solvers.friction.law import FrictionLaw

#: Direction of sliding by the name of a stroke.
DIRECTION = {"forward": 1, "backward": -1}


@dataclass(frozen=True)
class Stroke:
    """One stroke.

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


def names(strokes: Sequence[str]) -> list[str]:
    """Names of the strokes in the study's manner: FM1, BM1, FM2 for forward, backward, forward."""
    counts = {"forward": 0, "backward": 0}
    result = []
    for stroke in strokes:
        counts[stroke] += 1
        result.append(f"{stroke[0].upper()}M{counts[stroke]}")
    return result


def friction_along(
    law: FrictionLaw,
    strokes: Sequence[str],
    length: float,
    X_over_L: ArrayLike,
    V: float = 0.0,
    integrator: str = "exact",
) -> list[Stroke]:
    """Friction at given positions of every stroke, starting from rest.

    Args:
        law: the law.
        strokes: ``"forward"`` or ``"backward"``, in order of time.
        length: length L of a stroke (pre-sliding displacement) [m].
        X_over_L: positions in [0, 1], dimensionless.
        V: speed [m/s].
        integrator: ``"exact"`` or ``"rk4"``.

    Returns:
        One :class:`Stroke` a stroke.

    Raises:
        ValueError: the integrator cannot do it.
    """
    advance = INTEGRATORS[integrator]
    positions = np.unique(np.asarray(X_over_L, dtype=float))
    result, z = [], law.rest()
    for name, stroke in zip(names(strokes), strokes):
        s = DIRECTION[stroke]
        X = positions if s > 0 else positions[::-1]
        slip = length * (X if s > 0 else 1.0 - X)
        states = advance(law, z, s, V, length, np.append(slip, length))
        result.append(Stroke(name, s, X, states[:-1], law.friction(states[:-1], s, V)))
        z = states[-1]
    return result
