"""Motion of a scene's slider under each of its loads and friction laws."""

from collections.abc import Callable
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.quantities import runs as rows
from galinx.solvers.friction.slider import Ride, cycle, outcome, pull

from ..errors import BadInput
from ..scene.scene import Scene

#: Most sliders of a scene, archived times of each, and times of the last cycle.
MOST, TIMES, STEPS = 200, 4001, 1001


def check_sliders(scene: Scene) -> None:
    """Check the number of sliders of a scene.

    Raises:
        BadInput: a scene has more sliders than are followed.
    """
    count = scene.friction.count * len(scene.punch.loads)
    if rows.SLIDER in scene.output.quantities and count > MOST:
        raise BadInput(
            f"the scene's lists multiply to {count} friction laws and loads, expected at most {MOST} "
            "with a slider each: shorten them, or make several scenes"
        )


def slide(scene: Scene, done: Callable[[float, int], None] = lambda n, of: None) -> dict[str, NDArray]:
    """Motions of a scene's slider under each of its loads and laws: datasets by path.

    Args:
        scene: the scene.
        done: takes the number of motions done, the one under way by its share, and the number of all.

    Raises:
        BadInput: a motion could not be followed.
    """
    slider, motions = scene.slider, list[dict[str, Any]]()
    assert slider is not None
    times, of = np.linspace(0.0, slider.duration, TIMES), len(scene.punch.loads) * scene.friction.count
    for n, (load, law) in enumerate(product(scene.punch.loads, scene.friction.laws())):
        try:
            ride = pull(slider, law, load, lambda share, n=n: done(n + share, of))  # type: ignore[misc]
        except ValueError as error:
            raise BadInput(f"slider: {error}") from None
        last, (x, v, f) = cycle(ride, slider.drive_speed), ride.at(times)
        cycle_v, cycle_f = np.full((2, STEPS), np.nan)
        if np.isfinite(last.period):
            _, cycle_v, cycle_f = ride.at(_close(ride))
        motions.append({
            rows.POSITION.path: x, rows.VELOCITY.path: v, rows.FRICTION.path: f,
            rows.CYCLE_VELOCITY.path: cycle_v, rows.CYCLE_FRICTION.path: cycle_f,
            rows.OUTCOME.path: outcome(ride, slider.drive_speed),
            rows.PERIOD.path: last.period, rows.SLIP.path: last.slip,
            rows.PEAK.path: last.peak, rows.LEAST.path: last.least,
        })  # fmt: skip
    return {rows.TIMES.path: times} | {
        path: np.array([motion[path] for motion in motions]) for path in motions[0]
    }  # fmt: skip


def _close(ride: Ride) -> NDArray[np.float64]:
    """Times in the last cycle [s], (STEPS,), dense where the integration took small steps."""
    assert ride.cycle is not None
    t = ride.t[ride.cycle]
    return np.interp(np.linspace(0.0, len(t) - 1.0, STEPS), np.arange(len(t)), t)
