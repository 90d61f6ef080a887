"""The states a scene asks for: every combination of its lists, in the order they are archived."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from galinx.app.errors import BadInput
from galinx.app.scene.scene import Scene
from galinx.solvers.friction.dahl import Dahl
from galinx.solvers.friction.strokes import friction_along
from galinx.solvers.solids.isotropic import Solid


@dataclass(frozen=True)
class States:
    """One entry a state in every array.

    Attributes:
        motion: name of the stroke, FM1, BM1, ….
        X_over_L, c, mu_c, sigma0_over_load, delta: as the scene's; 1/m for sigma0_over_load.
        f: friction coefficient F/N, signed.
        g: σ_XY/σ_YY under the punch.
    """

    motion: NDArray[np.str_]
    X_over_L: NDArray[np.float64]
    c: NDArray[np.float64]
    mu_c: NDArray[np.float64]
    sigma0_over_load: NDArray[np.float64]
    delta: NDArray[np.float64]
    f: NDArray[np.float64]
    g: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.f)


def solid_of(scene: Scene) -> Solid:
    """The scene's solid."""
    return Solid(scene.solid.E, scene.solid.nu, scene.solid.rho, scene.solid.plane)


def speeds(scene: Scene) -> tuple[float, ...]:
    """Speeds over the shear wave speed.

    Raises:
        BadInput: a speed given in m/s is not subsonic.
    """
    if scene.motion.c is not None:
        return tuple(dict.fromkeys(scene.motion.c))
    c_s = solid_of(scene).c_s
    for speed in scene.motion.speed or ():
        if speed >= c_s:
            raise BadInput(
                f"motion.speed = {speed:g} m/s: expected less than the shear wave speed {c_s:.6g} m/s"
                + "".join(f"; {text}" for text in scene.warnings)
            )
    return tuple(dict.fromkeys(speed / c_s for speed in scene.motion.speed or ()))


def pieces(states: States, size: int, c: float | None = None) -> Iterator[slice]:
    """Runs of at most ``size`` states, each at one speed; of all speeds, or of one."""
    for speed in dict.fromkeys(states.c.tolist()) if c is None else (c,):
        mine = np.flatnonzero(states.c == speed)  # the speed is the slowest index
        for first in range(int(mine[0]), int(mine[-1]) + 1, size):
            yield slice(first, min(first + size, int(mine[-1]) + 1))


def enumerate_states(scene: Scene) -> States:
    """Friction of every state; each set of friction parameters is integrated once.

    Raises:
        BadInput: the integrator refuses the parameters.
    """
    friction = scene.friction
    sign = -1.0 if friction.sign == "physical" else 1.0
    rows = []
    laws = list(product(friction.mu_c, friction.sigma0_over_load, friction.delta))
    try:
        histories = [
            friction_along(
                Dahl(*law),
                scene.motion.strokes,
                friction.pre_sliding,
                scene.motion.X_over_L,
                friction.integrator,
            )
            for law in laws
        ]
    except ValueError as error:
        raise BadInput(f"friction: {error}") from None
    for c in speeds(scene):
        for law, history in zip(laws, histories):
            rows += [
                (stroke.name, X, c, *law, f, sign * f + 0.0)
                for stroke in history
                for X, f in zip(stroke.X_over_L, stroke.f)
            ]
    columns = list(zip(*rows))
    return States(np.array(columns[0]), *(np.array(column, dtype=float) for column in columns[1:]))
