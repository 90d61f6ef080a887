"""Quantities of a run: the record of it, the friction loops that its states lie on, and sliders.

A slider is a mass that is pulled through a spring, one for each load and law.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.parameters import Range

from . import states
from .quantity import (
    ANYWHERE,
    FEM,
    LOOP,
    NOT_NEGATIVE,
    OVER_C_S,
    QUANTITIES,
    SPEED,
    STATE,
    STEP,
    STROKE,
    Quantity,
)

#: Dimensions of texts, and of times.
LINE, TIMED = "lines", "steps"

SCENE = Quantity("scene/text", "none", "scene as given (TOML)")

LOOP_OF_STATE = Quantity(
    "loops/of_state", "1", "row of loops/f that each state lies on, -1 for none", (STATE,),
    whole=True, range=Range(at_least=-1.0),
)  # fmt: skip
LOOP_X = Quantity(
    "loops/X_over_L", "1", "positions along all strokes, in the order of travel", (STEP,),
    range=Range(at_least=0.0, at_most=1.0),
)  # fmt: skip
LOOP_F = Quantity(
    "loops/f", "1", "friction coefficient there, a row for each law and speed", (LOOP, STEP)
)

LOOP_WORK = Quantity(
    "loops/dissipated", "J/m",
    "energy dissipated in each stroke, N times the integral of f over X; this and other forces of loops "
    "are those of the first load",
    (LOOP, STROKE),
)  # fmt: skip
LOOP_CYCLE = Quantity(
    "loops/cycle_dissipated", "J/m",
    "energy dissipated in a closed loop, the last strokes that come back to where they began; NaN for "
    "none",
    (LOOP,), nan_allowed=ANYWHERE,
)  # fmt: skip
LOOP_BREAKAWAY = Quantity(
    "loops/breakaway", "N/m", "breakaway force, the largest against the motion in each stroke",
    (LOOP, STROKE),
)  # fmt: skip
LOOP_STIFFNESS = Quantity(
    "loops/tangent_stiffness", "N/m^2",
    "tangent stiffness, N times the slope of f over X where each stroke begins", (LOOP, STROKE),
)  # fmt: skip

_COUNTS = ("cells", "unknowns", "degree", "factorisations", "back_substitutions", "iterations")

#: One value a speed that finite elements solved, by the name in a method's record.
RECORD = {
    name: Quantity(
        f"run/fem/{name}",
        "1",
        about,
        (SPEED,),
        method=FEM,
        whole=name in _COUNTS,
        range=NOT_NEGATIVE,
        scale=OVER_C_S if name == "c" else "",
    )
    for name, about in {
        "c": "speeds with finite elements, over shear wave speed",
        "cells": "cells of the mesh",
        "unknowns": "unknowns",
        "degree": "polynomial degree",
        "factorisations": "factorisations",
        "back_substitutions": "back-substitutions",
        "iterations": "most steps of conjugate gradients in a solve; 0: direct solver",
        "largest_residual": "largest |b - Ax|/|b| of a back-substitution",
        "largest_condition": "largest lower bound of a matrix's condition number in the maximum norm, by "
        "its solutions; 0: conjugate gradients",
    }.items()
}
CHANGES = Quantity(
    "run/fem/change_by_degree", "1",
    "largest relative change of K_I and moments from the degree before, by degree; 0: not computed",
    (SPEED, "degrees"), method=FEM, range=NOT_NEGATIVE,
)  # fmt: skip


def states_of_speeds(data: Mapping[str, Any], variants: int) -> list[NDArray[np.int64]]:
    """Numbers of the states of each speed that finite elements solved.

    Args:
        data: datasets of an archive with finite elements, by path.
        variants: number of variants of its scene, whose speeds stand one after another.
    """
    c, c_of = (data[row.path] for row in (RECORD["c"], states.SPEED))
    each, count = (len(of) // variants for of in (c, c_of))
    return [
        first + np.flatnonzero(c_of[first : first + count] == speed)
        for speed, first in zip(c, np.arange(len(c)) // each * count)
    ]


FAILURES = Quantity("run/failures", "none", "speeds that could not be solved, and why", (LINE,))
DONE = Quantity("run/done", "none", "steps done", (LINE,))
SKIPPED = Quantity("run/skipped", "none", "steps skipped, and why", (LINE,))
SECONDS = Quantity(
    "run/seconds", "s", "wall time of the steps done, in the order of run/steps", (TIMED,),
    range=NOT_NEGATIVE,
)  # fmt: skip
STEPS = Quantity("run/steps", "none", "names of the timed steps", (TIMED,))


#: Word of output.quantities.
SLIDER = "slider"

#: Dimensions: laws, times, and steps of a cycle.
LAW, TIME, CYCLE = "laws", "times", "steps of a cycle"


def _row(name: str, unit: str, about: str, over: tuple[str, ...], **options: Any) -> Quantity:
    nan = ANYWHERE if TIME not in over else "never"
    return Quantity(
        f"slider/{name}", unit, about, over, asked_by=SLIDER, nan_allowed=nan, **options
    )  # fmt: skip


TIMES = _row("time", "s", "times", (TIME,), range=NOT_NEGATIVE)
POSITION = _row("position", "m", "position of the slider", (LAW, TIME))
VELOCITY = _row("velocity", "m/s", "velocity of the slider", (LAW, TIME))
FRICTION = _row("f", "1", "friction coefficient of the slider, the spring's pull over N where it sticks",
                (LAW, TIME))  # fmt: skip
CYCLE_VELOCITY = _row(
    "cycle_velocity", "m/s", "velocity in the last cycle of stick-slip; NaN for none", (LAW, CYCLE)
)
CYCLE_FRICTION = _row(
    "cycle_f", "1", "friction coefficient in the last cycle of stick-slip; NaN for none", (LAW, CYCLE)
)
OUTCOME = Quantity(
    "slider/outcome", "none",
    "what becomes of the slider: stick-slip, swings about the drive, slides steadily, one slip only, "
    "has not broken away yet, or not settled yet",
    (LAW,), asked_by=SLIDER,
)  # fmt: skip
PERIOD = _row("period", "s", "period of stick-slip, the last; NaN for none", (LAW,), range=NOT_NEGATIVE)
SLIP = _row("slip_per_cycle", "m", "slip per cycle of stick-slip; NaN for none", (LAW,))
PEAK = _row("peak_velocity", "m/s", "peak velocity in a cycle of stick-slip; NaN for none", (LAW,))
LEAST = _row("least_velocity", "m/s", "least velocity in a cycle of stick-slip; NaN for none", (LAW,))

QUANTITIES.add_all(globals())
