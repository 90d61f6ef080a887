"""The states a scene asks for: every combination of its lists, in the order they are archived."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from galinx.app.errors import BadInput
from galinx.app.scene.excerpt import listed
from galinx.app.scene.scene import Scene
from galinx.app.scene.sense import oddities
from galinx.solvers.friction import FrictionLaw
from galinx.solvers.friction.strokes import Stroke, friction_along

#: Positions on a stroke at which loops are archived, and the most loops that are.
FINE, LOOPS = np.linspace(0.0, 1.0, 101), 1000
#: Laws that are followed from word to word of how many are done.
_TOLD = 500


@dataclass(frozen=True)
class States:
    """Friction states, and the loops that they lie on.

    Attributes:
        columns: one entry a state in every array, by name as archived: motion, X_over_L, c (over the wave
            speed), the law's parameters, the speed in m/s, how often a wave crosses the contact in a
            stroke, f = F/N signed, and g = σ_XY/σ_YY under the punch.
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
    if fast := [f"{speed:g}" for speed in scene.motion.speed or () if speed >= c_s]:
        limit = f"the shear wave speed {c_s:.6g} m/s"
        if "fem" in scene.solve.methods:  # the one that is met first
            limit = (
                f"the Rayleigh speed {scene.solid.limit() * c_s:.6g} m/s (by closed_form alone, {limit})"
            )
        raise BadInput(
            f"motion.speed = {listed(fast)} m/s: expected less than {limit}"
            + "".join(f"; {text}" for text in oddities(scene))
        )
    return tuple(dict.fromkeys(speed / c_s for speed in scene.motion.speed or ()))


def states_a_speed(scene: Scene) -> int:
    """Number of states at each speed."""
    return scene.friction.count * _states_a_law(scene)


def _states_a_law(scene: Scene) -> int:
    return len(scene.motion.strokes) * len(set(scene.motion.X_over_L))


def laws_followed(scene: Scene) -> int:
    """Number of laws that are followed: once, or once a speed where they depend on that."""
    return scene.friction.count * (len(speeds(scene)) if scene.friction.law.depends_on_speed else 1)


def enumerate_states(scene: Scene, done: Callable[[int, int], None] = lambda laws, of: None) -> States:
    """Friction of every state; what is held at once is that and nothing else.

    Args:
        scene: the scene.
        done: is told now and then how many laws are followed, and of how many.

    Raises:
        BadInput: the integrator refuses the parameters.
    """
    friction, all_speeds, count = scene.friction, speeds(scene), laws_followed(scene)
    f, loops = np.empty((count, _states_a_law(scene))), []
    try:
        for i, (c, law) in enumerate(_laws(scene)):
            strokes = _strokes(scene, law, c, scene.motion.X_over_L)
            f[i] = _joined([stroke.f for stroke in strokes])
            if i < LOOPS:
                drawn = _strokes(scene, law, c, FINE)
                loops.append(_joined([stroke.f for stroke in drawn]))
            if i % _TOLD == _TOLD - 1:
                done(i + 1, count)
    except ValueError as error:
        raise BadInput(f"friction: {error}") from None
    loop = np.arange(count)
    loop[LOOPS:] = -1
    if not friction.law.depends_on_speed:
        f, loop = np.tile(f, (len(all_speeds), 1)), np.tile(loop, len(all_speeds))
    per_law = f.shape[1]
    values = {
        key: np.tile(np.repeat(column, per_law), len(all_speeds))
        for key, column in friction.columns().items()
    }
    columns = {
        "motion": np.tile(np.repeat([s.name for s in strokes], len(strokes[0].X_over_L)), len(f)),
        "X_over_L": np.tile(_joined([stroke.X_over_L for stroke in strokes]), len(f)),
        "c": np.repeat(all_speeds, friction.count * per_law),
        **values,
        "speed": np.repeat(np.multiply(all_speeds, scene.solid.c_s), friction.count * per_law),
        "wave_crossings": np.repeat(_crossings(scene, all_speeds), friction.count * per_law),
        "f": f.ravel(),
        "g": friction.stress_ratio * f.ravel() + 0.0,
    }
    travel = _joined([stroke.X_over_L for stroke in drawn])
    return States(columns, np.repeat(loop, per_law), travel, np.array(loops))


def _crossings(scene: Scene, all_speeds: Sequence[float]) -> NDArray[np.float64]:
    """How often a wave of the speed c_s crosses the contact in a stroke: L/(2 a c), NaN at rest."""
    c = np.array(all_speeds)
    with np.errstate(divide="ignore"):
        often = scene.friction.pre_sliding / (2.0 * scene.body.half_width * c)
    return np.where(c > 0.0, often, np.nan)


def _laws(scene: Scene) -> Iterator[tuple[float, FrictionLaw]]:
    """Every law that is followed, with its speed."""
    followed = speeds(scene) if scene.friction.law.depends_on_speed else speeds(scene)[:1]
    for c in followed:
        for law in scene.friction.laws():
            yield c, law


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
