"""What the thickness of an archive's uppermost layer does: K_I, and stresses at its lower face."""

from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.pictures.choice import Choice
from galinx.app.pictures.drawing import Drawing
from galinx.app.plan.plan import interface_grid
from galinx.app.plan.task import Task
from galinx.app.run.methods import layers
from galinx.app.scene.scene import Scene
from galinx.postprocess.figures.curves import Line, Panel, Parameter, curves_figure
from galinx.postprocess.figures.typeset import number
from galinx.postprocess.quantities import states
from galinx.postprocess.quantities.quantity import SIE
from galinx.solvers.errors import SolveError
from galinx.solvers.layers.layered import Layered
from galinx.solvers.solution import Body, Places

#: Thicknesses over that of the archive: from the first to the last, so many.
_FIRST, _LAST, _COUNT = 0.1, 10.0, 17
#: The thinnest layer over a that is drawn: thinner ones take the equation many seconds.
_THINNEST = 0.05
#: Relative accuracy: more than a figure shows.
_TOLERANCE = 1e-4
#: Panels, in their order.
_SHOWN = (
    "$K_I$ at $X = -a$",
    "$K_I$ at $X = a$",
    r"largest $-\sigma_{YY}/(N/2a)$ below the layer",
    r"largest shear traction $|\sigma_{XY}|/(N/2a)$ there",
    r"largest $\sigma_{XX}/(N/2a)$ in the layer",
    r"largest $\sigma_{XX}/(N/2a)$ below the layer",
)


def has(data: dict[str, Any], scene: Scene) -> bool:
    """Has a punch with two sharp edges been solved over uniform layers by the integral equation?"""
    solved = any(path.startswith(f"states/{SIE}/") for path in data)
    sharp = not (scene.body.found or scene.solve.own_pressure)
    least = _THINNEST * scene.body.half_width
    # Graded ones take a second or two a thickness.
    quick = all(layer.bottom is None and layer.thickness >= least for layer in scene.layers)
    return solved and sharp and bool(scene.layers) and quick


def thicknesses(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """The uppermost layer thinner and thicker, under the steepest friction and at the fastest speed."""
    assert isinstance(scene.solid, Layered)
    g = data[states.RATIO.path]
    steepest = float(g[np.argmax(np.abs(g))])
    c = float(data[states.SPEED.path].max())
    top, a = scene.solid.layers[0].thickness, scene.body.half_width
    H = np.geomspace(max(_FIRST * top, _THINNEST * a), _LAST * top, _COUNT)
    found = np.full((_COUNT, len(_SHOWN)), np.nan)
    for row, thickness in zip(found, H.tolist()):
        body = _with_top(scene.body, thickness)
        with suppress(SolveError):
            if c < body.solid.limit():
                row[:] = _at(body, c, steepest)
    titles: tuple[str, ...] = _SHOWN
    if choice.in_si:
        found[:, 2:] *= 1e-6 * scene.body.stress
        titles = tuple(title.replace("/(N/2a)$", "$ [MPa]") for title in _SHOWN)
    panels = [Panel(title, [Line("", H / a, values)]) for title, values in zip(titles, found.T)]
    over = Parameter("thickness of the uppermost layer over $a$", ("thickness [mm]", 1e3 * a), top / a)
    caption = (
        "The uppermost layer thinner and thicker, by the integral equation at "
        f"{number(c * scene.solid.c_s)} m/s and σ_XY/σ_YY = {number(steepest)}: K_I at both ends, and "
        "the largest stresses along the layer's lower face: pressure, the shear that it has to bear, and "
        "σ_XX in the layer and in what is below. The grey line is the archive's; where there is no curve "
        "the limit is slower than the punch, or the equation has no answer."
    )
    return Drawing("thicknesses", caption, curves_figure(panels, over, size=choice.size))


def _with_top(body: Body, thickness: float) -> Body:
    solid = body.solid
    assert isinstance(solid, Layered)
    top, *others = solid.layers
    return replace(body, solid=replace(solid, layers=(replace(top, thickness=thickness), *others)))


def _at(body: Body, c: float, g: float) -> NDArray[np.float64]:
    """What is drawn at one thickness.

    Raises:
        SolveError: the equation has no answer.
    """
    depths, along = interface_grid(body)
    places = Places(np.empty(0), np.empty((0, 2)), interfaces=depths[:1], along=along)
    response = body.response(c)
    task = Task(0, body, response, places, (), ())
    stack = response.stack(body.half_width)  # type: ignore[attr-defined]
    punch = layers.at_speed(task, stack, _TOLERANCE, np.array([g])).states(np.array([g]))
    σ_YY, σ_XY, above, below = punch.interfaces[:, 0, 0]
    return np.array([*punch.K_I[0], -σ_YY.min(), np.abs(σ_XY).max(), above.max(), below.max()])
