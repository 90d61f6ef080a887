"""What the angle of an archive's solid does: its speed limit, edges or contacts; closed form."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import fields, replace
from typing import Any

import numpy as np

from galinx.app.pictures.choice import Choice
from galinx.app.pictures.drawing import Drawing
from galinx.app.plan.plan import surface_grid
from galinx.app.scene.scene import Scene
from galinx.postprocess.figures.polar import Panel, polar_figure
from galinx.postprocess.figures.typeset import number
from galinx.postprocess.quantities import states
from galinx.postprocess.scale import NEAR
from galinx.solvers.errors import SolveError
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.sie.found import contacts
from galinx.solvers.solution import Body

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
    panels = [Panel("speed limit [m/s]", {"": limits})]
    bodies = [replace(scene.body, solid=solid) for solid in turned]
    if scene.body.found:
        panels += _of_contacts(bodies, V, steepest)
        what = (
            "half-width, largest pressure and tension on the surface of the contact under "
            f"{number(scene.punch.load)} N/m"
        )
    else:
        panels += _of_edges(bodies, V, steepest)
        what = "how strong the pressure's singularity is at either end"
        what += ", and K_I, the same at both" * scene.body.flat
    around = np.concatenate([_ANGLES, _ANGLES[1:] + 180.0])
    twice = [
        Panel(
            panel.title,
            {label: np.concatenate([values, values[1:]]) for label, values in panel.curves.items()},
        )
        for panel in panels
    ]
    caption = (
        f"The solid turned under the punch, closed form at {number(V)} m/s and σ_XY/σ_YY = "
        f"{number(steepest)}: over the angle from X to its first axis the speed of the wave along its "
        f"surface, {what}. "
        "The grey line is the angle of the archive; where there is no curve the solid's limit is slower."
    )
    now = float(scene.solid.angle)  # type: ignore[attr-defined]
    return Drawing("angles", caption, polar_figure(around, twice, now, choice.size))


def _of_edges(bodies: list[Body], V: float, g: float) -> list[Panel]:
    """-α and -β of sharp edges, and K_I of a flat punch."""
    flat = [_at(body, V, lambda response, body: FlatPunch(response, g)) for body in bodies]
    left, right = (
        np.array([np.nan if punch is None else -getattr(punch, name) for punch in flat])
        for name in ("β", "α")
    )
    panels = [
        Panel("$-\\alpha$, $-\\beta$", {"$-\\alpha$, at $X = a$": right, "$-\\beta$, at $X = -a$": left})
    ]
    if bodies[0].flat:
        K_I = np.array([np.nan if punch is None else punch.K_I for punch in flat])
        panels.append(Panel("$K_I$", {"": K_I}))
    return panels


def _of_contacts(bodies: list[Body], V: float, g: float) -> list[Panel]:
    """Half-width, largest pressure and tension, and intensities of an end that is sharp."""

    def numbers(response: Any, body: Body) -> list[float]:
        found = contacts(response, np.array([g]), body.profile, body.compression)
        h = float(found.of("half_width")[0])
        unit = 1e-6 * body.load / (2.0 * h)
        X = surface_grid()
        if not body.free:  # beside a sharp edge it is infinite
            X = X[np.abs(np.abs(X) - 1.0) >= NEAR]
        tension = float(found.σ_XX(X).max())
        return [1e3 * h, unit * float(found.largest()[0][0]), unit * tension, *found.of("K_I")[0]]

    rows = [_at(body, V, numbers) for body in bodies]
    h, pressure, tension, left, right = np.array([row or [np.nan] * 5 for row in rows]).T
    titles = {"half-width [mm]": h, "largest pressure [MPa]": pressure, "largest tension [MPa]": tension}
    panels = [Panel(title, {"": values}) for title, values in titles.items() if np.isfinite(values).any()]
    if np.nan_to_num([left, right]).any():
        ends = {"at $X = a$": right, "at $X = -a$": left}
        panels.append(Panel("$K_I$", {label: values for label, values in ends.items() if values.any()}))
    return panels


def _at(body: Body, V: float, of: Callable[[Any, Body], Any]) -> Any:
    """Of a body at a speed [m/s]; None at the limit and beyond, and where there is no contact."""
    c = V / body.solid.c_s
    if c >= body.solid.limit():
        return None
    with suppress(SolveError):
        return of(body.solid.response(c), body)
    return None
