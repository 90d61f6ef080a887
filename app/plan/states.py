"""The states a scene asks for: every combination of its lists, in the order they are archived."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from galinx.app.errors import BadInput
from galinx.app.scene.scene import Scene
from galinx.app.scene.sense import oddities
from galinx.solvers.friction import FrictionLaw
from galinx.solvers.friction.strokes import Stroke, friction_along

#: Positions on a stroke at which loops are archived, and the most loops that are.
FINE, LOOPS = np.linspace(0.0, 1.0, 101), 1000


@dataclass(frozen=True)
class States:
    """Friction states, and the loops that they lie on.

    Attributes:
        columns: one entry a state in every array, by name as archived: motion, X_over_L, c (over the wave
            speed), the law's parameters, f = F/N signed, and g = σ_XY/σ_YY under the punch.
        loop: row of ``loops`` of each state, -1 for none, (states,).
        travel: positions X/L along all strokes in the order of travel, (steps,).
        loops: friction coefficient there, (loops, steps).
    """

    columns: dict[str, NDArray]
    loop: NDArray[np.int64]
    travel: NDArray[np.float64]
    loops: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.g)

    @property
    def g(self) -> NDArray[np.float64]:
        """σ_XY/σ_YY under the punch, (states,)."""
        return self.columns["g"]


def speeds(scene: Scene) -> tuple[float, ...]:
    """Speeds over the wave speed.

    Raises:
        BadInput: a speed given in m/s is not subsonic.
    """
    if scene.motion.c is not None:
        return tuple(dict.fromkeys(scene.motion.c))
    c_s = scene.solid.c_s
    for speed in scene.motion.speed or ():
        if speed >= c_s:
            raise BadInput(
                f"motion.speed = {speed:g} m/s: expected less than the shear wave speed {c_s:.6g} m/s"
                + "".join(f"; {text}" for text in oddities(scene))
            )
    return tuple(dict.fromkeys(speed / c_s for speed in scene.motion.speed or ()))


def states_a_speed(scene: Scene) -> int:
    """Number of states at each speed."""
    lists = [*scene.friction.parameters.values(), scene.motion.strokes, set(scene.motion.X_over_L)]
    return int(np.prod([len(entries) for entries in lists], dtype=np.int64))


def enumerate_states(scene: Scene) -> States:
    """Friction of every state; each law is followed once, or once a speed where it depends on that.

    Raises:
        BadInput: the integrator refuses the parameters.
    """
    friction = scene.friction
    try:
        laws = friction.laws()
        followed = speeds(scene) if friction.law.depends_on_speed else speeds(scene)[:1]
        histories = [_strokes(scene, law, c, scene.motion.X_over_L) for c in followed for _, law in laws]
        drawn = [_strokes(scene, law, c, FINE) for c in followed for _, law in laws][:LOOPS]
    except ValueError as error:
        raise BadInput(f"friction: {error}") from None
    f = np.array([_joined([stroke.f for stroke in strokes]) for strokes in histories])
    loop = np.arange(len(f))
    loop[LOOPS:] = -1
    if not friction.law.depends_on_speed:
        f, loop = np.tile(f, (len(speeds(scene)), 1)), np.tile(loop, len(speeds(scene)))
    first = histories[0]
    per_law = f.shape[1]
    values = {
        key: np.tile(np.repeat([given[key] for given, _ in laws], per_law), len(speeds(scene)))
        for key in friction.parameters
    }
    columns = {
        "motion": np.tile(np.repeat([s.name for s in first], len(first[0].X_over_L)), len(f)),
        "X_over_L": np.tile(_joined([stroke.X_over_L for stroke in first]), len(f)),
        "c": np.repeat(speeds(scene), len(laws) * per_law),
        **values,
        "f": f.ravel(),
        "g": friction.stress_ratio * f.ravel() + 0.0,
    }
    loops = np.array([_joined([stroke.f for stroke in strokes]) for strokes in drawn])
    travel = _joined([stroke.X_over_L for stroke in drawn[0]])
    return States(columns, np.repeat(loop, per_law), travel, loops)


def _strokes(
    scene: Scene, law: FrictionLaw, c: float, X_over_L: Sequence[float] | NDArray
) -> list[Stroke]:
    friction = scene.friction
    V = c * scene.solid.c_s
    return friction_along(
        law, scene.motion.strokes, friction.pre_sliding, X_over_L, V, friction.integrator
    )


def _joined(parts: list[NDArray]) -> NDArray:
    return np.concatenate(parts)
