"""A slider under every law of a scene."""

from collections.abc import Callable
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.errors import BadInput
from galinx.app.scene.scene import Scene
from galinx.postprocess.quantities import slider as rows
from galinx.solvers.friction.slider import Ride, cycle, pull

#: Sliders of a scene, times at which each is archived, and steps of the last cycle.
MOST, TIMES, STEPS = 200, 4001, 1001


def check_sliders(scene: Scene) -> None:
    """
    Raises:
        BadInput: a scene asks for more sliders than are followed.
    """
    count = scene.friction.count * len(scene.punch.loads)
    if rows.SLIDER in scene.output.quantities and count > MOST:
        raise BadInput(
            f"the scene's lists multiply to {count} friction laws and loads, expected at most {MOST} "
            "with a slider each: shorten them, or make several scenes"
        )


def slide(scene: Scene, done: Callable[[int, int], None] = lambda n, of: None) -> dict[str, NDArray]:
    """How the slider of a scene moves under each of its loads and laws: datasets by path.

    Raises:
        BadInput: a motion could not be followed.
    """
    slider, found = scene.slider, list[dict[str, Any]]()
    assert slider is not None
    times = np.linspace(0.0, slider.duration, TIMES)
    both = product(scene.punch.loads, scene.friction.laws())
    for n, (load, law) in enumerate(both):
        try:
            ride = pull(slider, law, load)
        except ValueError as error:
            raise BadInput(f"slider: {error}") from None
        last = cycle(ride, slider.drive_speed)
        whole = np.isfinite(last.period)
        found.append({
            rows.POSITION.path: np.interp(times, ride.t, ride.x),
            rows.VELOCITY.path: np.interp(times, ride.t, ride.v),
            rows.FRICTION.path: np.interp(times, ride.t, ride.f),
            rows.CYCLE_VELOCITY.path: _steps(ride, ride.v) if whole else np.full(STEPS, np.nan),
            rows.CYCLE_FRICTION.path: _steps(ride, ride.f) if whole else np.full(STEPS, np.nan),
            rows.PERIOD.path: last.period, rows.SLIP.path: last.slip,
            rows.PEAK.path: last.peak, rows.LEAST.path: last.least,
        })  # fmt: skip
        done(n + 1, len(scene.punch.loads) * scene.friction.count)
    return {rows.TIMES.path: times} | {
        path: np.array([one[path] for one in found]) for path in found[0]
    }  # fmt: skip


def _steps(ride: Ride, values: NDArray) -> NDArray[np.float64]:
    """Values in the last cycle, close where the integration went by small steps."""
    assert ride.cycle is not None
    some = values[ride.cycle]
    return np.interp(np.linspace(0.0, len(some) - 1.0, STEPS), np.arange(len(some)), some)
