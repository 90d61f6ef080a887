"""Which motions in time a scene asks for."""

import numpy as np

from galinx.app.errors import BadInput
from galinx.app.plan.driving import Drive, constant, drives_at, headings, load_of, ways_at
from galinx.app.plan.known_in_time import check_in_time
from galinx.app.plan.over_time import Starts
from galinx.app.plan.states import States
from galinx.app.scene.scene import Scene
from galinx.postprocess.quantities.quantity import FEM, SIE

#: Starts of a scene at most, and unknowns of a mesh.
MOST, LARGEST = 24, 300_000
#: Largest step at a tolerance of 1e-3, of order four; and steps within which the load comes on.
_STEP, _OF_RAMP = 0.4, 8
#: Over layers steps are so much shorter: what echoes do to the centre of the pressure.
_OF_LAYERS = 3.5


def starts(scene: Scene, states: States) -> Starts | None:
    """The starts of a scene by its friction states, None where it asks for none.

    Raises:
        BadInput: they are known of other scenes only.
    """
    if scene.time is None:
        return None
    methods = tuple(name for name in (FEM, SIE) if name in scene.solve.methods)
    tolerance = scene.solve.tolerance
    check_in_time(scene, methods)
    load = load_of(scene)
    largest = min(_STEP, load.shortest / _OF_RAMP) / (_OF_LAYERS if scene.layers else 1.0)
    step = scene.time.step or largest * min(tolerance / 1e-3, 1.0) ** 0.3
    drives = _drives(scene, states)
    ways = ways_at(scene, next(iter(drives)), step)
    if methods == (SIE,) and len(ways) > 1:
        raise BadInput(
            f"solve.methods: found sie only, which knows no way back, and the punch turns round at "
            f"{ways[0].duration:.6g} a/c_s: expected fem, too, or time.end no later than that"
        )
    found = Starts(
        drives, methods, ways, load, scene.time.steady, tolerance, scene.time.every,
        scene.body.half_width,
    )  # fmt: skip
    if FEM in methods:
        _check_size(found, scene)
    return found


def _drives(scene: Scene, states: States) -> dict[float, tuple[Drive, ...]]:
    """Drives of all starts by speed.

    Raises:
        BadInput: there are too many, or their speed has no answer.
    """
    assert scene.time
    c = states.columns["c"]
    found: dict[float, tuple[Drive, ...]] = {}
    if scene.time.by_law:
        speeds = np.unique(c).tolist()
        if len(speeds) > 1 or speeds[0] == 0.0:
            raise BadInput(
                f'time.friction = "law": found {len(speeds)} speeds, the first {speeds[0]:g} over c_s; '
                "expected one that is not 0, for strokes of another take another time"
            )
        found[speeds[0]] = drives_at(scene, speeds[0])
    else:
        different = np.unique(np.column_stack([c, states.g, headings(scene, states.directions)]), axis=0)
        for speed, ratio, way in different.tolist():
            found[speed] = (*found.get(speed, ()), constant(round(way), ratio))
    if (many := sum(map(len, found.values()))) > MOST:
        raise BadInput(
            f"time: the scene has {many} states of different speed or friction, expected at most "
            f"{MOST}, each of which is followed in time: shorten its lists"
        )
    limit = scene.solid.limit()
    if fast := [f"{speed:g}" for speed in found if speed >= limit]:
        raise BadInput(
            f"time: c = {', '.join(fast)} is not below the Rayleigh speed {limit:.6g} (over c_s)"
        )
    return found


def _check_size(found: Starts, scene: Scene) -> None:
    for c in found.drives:
        _, level = found.levels(scene.solid, c)
        if level.unknowns > LARGEST:
            raise BadInput(
                f"time.end = {found.end:g} needs {level.unknowns} unknowns at c = {c:g}, as far "
                f"as waves come that are back by then, expected at most {LARGEST}: take an earlier "
                "end, a larger solve.tolerance, or a smaller Poisson's ratio"
            )
