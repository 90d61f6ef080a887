"""Where energy goes in a motion in time."""

from typing import Any

import numpy as np

from galinx.app.pictures.choice import Choice
from galinx.app.pictures.drawing import Drawing, there
from galinx.app.scene.scene import Scene
from galinx.postprocess.energy_over_time import left_over
from galinx.postprocess.figures.energies import energies_figure
from galinx.postprocess.quantities import energy_over_time as of
from galinx.postprocess.quantities import over_time as rows
from galinx.postprocess.quantities.quantity import FEM
from galinx.postprocess.quantities.work_over_time import OF_FRICTION, OF_LOAD

_DONE = {"load": OF_LOAD[FEM], "friction": OF_FRICTION[FEM], "being carried past the punch": of.CARRIED}
_HELD = {"strain near": of.STRAIN, "motion near": of.KINETIC, "radiated": of.RADIATED}


def has(data: dict[str, Any]) -> bool:
    """Does an archive hold energies over time?"""
    return there(data, *_DONE.values(), *_HELD.values())


def energies(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """Of the first start."""
    done, held = ({name: data[row.path][0] for name, row in of.items()} for of in (_DONE, _HELD))
    off = float(np.abs(left_over(data)[0]).max())
    heat = float(data[of.DISSIPATED.path][0, -1])
    caption = (
        "Work of the punch on the solid besides the heat of friction, and where it is: strained and "
        "moving within 3 a of the middle and 2 a below it, and what went beyond, finite elements. Sums "
        f"are within {off:.1e} of the largest work. Friction took {heat:.3g} N a meanwhile, of first "
        "order in the load, where all of these are of second."
    )
    count = len(data[rows.SPEED.path])
    left = f"{count - 1} of {count} starts not shown." * (count > 1)
    figure = energies_figure(data[rows.TIMES.path], done, held, choice.size)
    return Drawing("energies", caption, figure, left_out=left)
