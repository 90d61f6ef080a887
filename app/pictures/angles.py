"""What the angle of an archive's solid does: its speed limit, the exponents, K_I; closed form."""

from dataclasses import fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.pictures.choice import Choice
from galinx.app.pictures.drawing import Drawing
from galinx.app.scene.scene import Scene
from galinx.postprocess.figures.polar import Panel, polar_figure
from galinx.postprocess.figures.typeset import number
from galinx.postprocess.quantities import states
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.solids import Solid

#: Angles that are drawn [°]; a half turn leaves a solid as it is.
_ANGLES = np.arange(0.0, 181.0, 3.0)


def has(scene: Scene) -> bool:
    """Has the scene's solid an angle?"""
    return any(field.name == "angle" for field in fields(scene.solid))  # type: ignore[arg-type]


def angles(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """The scene's solid, turned, under the steepest friction and at the fastest speed of the archive."""
    g = data[states.RATIO.path]
    steepest = float(g[np.argmax(np.abs(g))])
    V = float(data[states.SPEED.path].max()) * scene.solid.c_s
    turned: list[Any] = [replace(scene.solid, angle=angle) for angle in _ANGLES.tolist()]  # type: ignore[type-var]
    limits = np.array([solid.limit() * solid.c_s for solid in turned])
    found = np.array([_at_edges(solid, V, steepest) for solid in turned]).T
    panels = [
        Panel("speed limit [m/s]", {"": limits}),
        Panel(
            "$-\\alpha$, $-\\beta$",
            {"$-\\alpha$, at $X = a$": found[0], "$-\\beta$, at $X = -a$": found[1]},
        ),
        Panel("$K_I$", {"": found[2]}, from_zero=False),
    ]
    around = np.concatenate([_ANGLES, _ANGLES[1:] + 180.0])
    twice = [
        Panel(
            panel.title,
            {label: np.concatenate([values, values[1:]]) for label, values in panel.curves.items()},
            panel.from_zero,
        )
        for panel in panels
    ]
    caption = (
        f"The solid turned under the punch, closed form at {number(V)} m/s and σ_XY/σ_YY = "
        f"{number(steepest)}: over the angle from X to its first axis the speed of the wave along its "
        "surface, how strong the pressure's singularity is at either end, and K_I, the same at both. "
        "The grey line is the angle of the archive; where there is no curve the solid's limit is slower."
    )
    now = float(scene.solid.angle)  # type: ignore[attr-defined]
    return Drawing("angles", caption, polar_figure(around, twice, now, choice.size))


def _at_edges(solid: Solid, V: float, g: float) -> NDArray[np.float64]:
    """-α, -β and K_I at a speed [m/s]; NaN at the limit and beyond."""
    c = V / solid.c_s
    if c >= solid.limit():
        return np.full(3, np.nan)
    punch = FlatPunch(solid.response(c), g)
    return np.array([-punch.α, -punch.β, punch.K_I])
