"""Which work a scene needs, derived from the outputs it asks for."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace

import numpy as np

from galinx.app.methods import METHODS
from galinx.app.plan.fem import FemPlan, check_assembler, plan_fem
from galinx.app.plan.limits import (
    check_found,
    check_layers,
    check_mode,
    check_places,
    check_pressure,
    check_size,
    check_speeds,
    check_states,
    warnings_of,
    warnings_of_size,
)
from galinx.app.plan.starts import starts
from galinx.app.plan.states import enumerate_states, laws_followed, order, seconds_to_integrate
from galinx.app.plan.task import Plan, Tasks
from galinx.app.run.slider import check_sliders
from galinx.app.scene.scene import Scene
from galinx.app.scene.sense import FRICTIONS, oddities
from galinx.meshes import store
from galinx.postprocess.quantities import QUANTITIES, Quantity, stresses
from galinx.postprocess.quantities import strata as layers
from galinx.postprocess.quantities.quantity import ALONE, LOCAL, SWEPT
from galinx.postprocess.yielding.strength import places as yield_places
from galinx.solvers.layers.layered import Layered
from galinx.solvers.sie.linear import LinearPressure
from galinx.solvers.solution import Body, Places

#: What words of output.quantities ask for, where a plan says so.
_PLACES = {
    stresses.ON_SURFACE: "stresses on the surface",
    stresses.BELOW: "stresses inside",
    stresses.YIELD: "yield",
}


def make_plan(scene: Scene, done: Callable[[int, int], None] = lambda laws, of: None) -> Plan:
    """Plan the work; looks at the scene only, and does none of it but friction where that is needed.

    Args:
        scene: the scene.
        done: is told how many laws are followed, and of how many, where friction is.

    Raises:
        BadInput: finite elements are asked for where they have no answer.
    """
    known = order(scene)
    check_states(len(known))
    check_sliders(scene)
    pressure = LinearPressure(*np.array(scene.solve.pressure).T) if scene.solve.own_pressure else None
    body = replace(scene.body, pressure=pressure)
    methods = _methods(scene, body)
    for load in {min(known.loads), max(known.loads)}:
        check_size(body.loaded(load), methods)
    check_layers(scene, body, methods)
    check_found(scene, body, methods)
    check_assembler(scene)
    around = yield_places(body) if stresses.YIELD in scene.output.quantities else np.empty((0, 2))
    points = np.reshape(scene.output.inside, (-1, 2))
    places = Places(surface_grid(), points, around, *interface_grid(body))
    warnings = [*oddities(scene), *check_speeds(scene, known.speeds, "fem" in methods)]
    warnings += _left_out(scene, body, methods)
    friction = enumerate_states(scene, done) if "fem" in methods or scene.time else None
    fem = None
    if "fem" in methods:
        assert friction
        check_mode(scene, body)
        check_pressure(scene, body)
        check_places(scene, places)
        responses = [body.response(c) for c in known.speeds]
        fem = plan_fem(scene, responses, _asked(scene, places), friction.g)
        warnings += warnings_of(fem)
    modes = (*scene.modes, *(SWEPT,) * bool(fem and fem.sweep), *(ALONE,) * (len(methods) == 1))
    quantities, refused = _quantities(scene, body, methods, modes)
    skipped = (*_skipped(scene, body, methods, fem, quantities), *refused)
    plan = Plan(
        body=body, places=places, methods=methods, quantities=quantities,
        tasks=Tasks(body, places, known), tolerance=scene.solve.tolerance,
        strokes=laws_followed(scene) * len(scene.legs), fem=fem, skipped=skipped,
        warnings=tuple(warnings), integrated=seconds_to_integrate(scene),
        starts=starts(scene, friction) if friction else None, friction=friction,
    )  # fmt: skip
    heavy = warnings_of_size(plan.chunk * plan.numbers)
    return replace(plan, warnings=(*plan.warnings, *heavy))


def _contact(scene: Scene) -> bool:
    """Does anything ask for contact mechanics?"""
    return bool(set(scene.output.quantities) - FRICTIONS)


def _asked(scene: Scene, places: Places) -> Places:
    """Those places whose stresses are asked for."""
    surface, below = (word in scene.output.quantities for word in (stresses.ON_SURFACE, stresses.BELOW))
    X, points = places.X[: len(places.X) * surface], places.points[: len(places.points) * below]
    if layers.AT_INTERFACES in scene.output.quantities and len(places.along):
        X_along, depth = np.meshgrid(places.along, places.interfaces)
        points = np.concatenate([points, np.column_stack([X_along.ravel(), -depth.ravel()])])
    return Places(X, points, places.around)


def _methods(scene: Scene, body: Body) -> tuple[str, ...]:
    """Methods that solve the contact, if anything asks for it."""
    if not _contact(scene):
        return ()
    wanted = dict.fromkeys(scene.solve.methods)
    return tuple(name for name in wanted if not METHODS[name].refusal(scene, body, None))


def _left_out(scene: Scene, body: Body, methods: tuple[str, ...]) -> Iterator[str]:
    """Methods that the scene names and that do not solve it; the others' answers stand alone."""
    for name in dict.fromkeys(scene.solve.methods if methods else ()):
        kind = METHODS[name]
        if name not in methods and (body.layered or not kind.of_layers):
            yield f"solve.methods: {name} does not solve this: {kind.refusal(scene, body, None)}"


def _quantities(
    scene: Scene, body: Body, methods: tuple[str, ...], modes: tuple[str, ...]
) -> tuple[tuple[Quantity, ...], list[str]]:
    """What is read off the solutions, and what a method cannot give, with the reason."""
    asked: dict[str, Quantity] = {}
    refused = []
    # What is known of a punch's edges says nothing of a pressure of the user's own.
    sources = methods if body.pressure else (*methods, LOCAL)
    # What is computed from others comes after them, wherever it stands in the table.
    for path, quantity in sorted(QUANTITIES.items(), key=lambda row: row[1].of_data is not None):
        wanted = (
            bool(methods)
            and quantity.solved
            and quantity.method in sources
            and quantity.mode in modes
            and quantity.asked_by in ("", *scene.output.quantities)
            and all(need in asked for need in quantity.needs)
        )
        kind = METHODS.get(quantity.method)
        if wanted and kind and (why := kind.refusal(scene, body, quantity)):
            refused.append(f"{path}: {why}")
        elif wanted:
            asked[path] = quantity
    return tuple(asked.values()), refused


def _skipped(
    scene: Scene, body: Body, methods: tuple[str, ...], fem: FemPlan | None, asked: Iterable[Quantity]
) -> list[str]:
    """What is not done, and why."""
    if not _contact(scene):
        if scene.time:
            return ["contact mechanics of steady motion: only friction and time are asked for"]
        return ["contact mechanics: only friction is asked for"]
    skipped = [
        f"{kind.about}: {kind.refusal(scene, body, None) or f'{name} is not in solve.methods'}"
        for name, kind in METHODS.items()
        if name not in methods and (body.layered or not kind.of_layers)
    ]
    if fem and fem.cuts == 1 and store.is_kept(fem.pattern):
        skipped.append("gmsh: an earlier run made the same mesh")
    words = {quantity.asked_by for quantity in asked}
    for word, what in _PLACES.items():
        if word not in words:
            skipped.append(f"{what}: not in output.quantities")
    if stresses.YIELD in words and not body.pressure:
        skipped.append(
            "largest von Mises and shear stress, load at first yield: stresses are infinite at the sharp "
            "edges of a punch, and any load makes these yield"
        )
    return skipped


def surface_grid() -> np.ndarray:
    """Positions X/a of archived surface stresses: to ±5, clustered at ±1, without ±1 itself."""
    near = np.geomspace(1e-6, 0.1, 31)
    inside = np.concatenate([1.0 - near, np.linspace(0.0, 0.88, 23)])
    outside = 1.0 + np.concatenate([near, np.geomspace(0.1, 4.0, 25)[1:]])
    right = np.concatenate([inside, outside])
    return np.unique(np.concatenate([-right, right]))


#: Distance over a to which interfaces are looked at, and beyond which stresses only fall.
_FARTHEST = 40.0


def interface_grid(body: Body) -> tuple[np.ndarray, np.ndarray]:
    """Depths of interfaces over a, and positions along them: as fine at the edges as these are near, and
    so far that a largest stress behind the punch is among them."""
    if not isinstance(body.solid, Layered):
        return np.empty(0), np.empty(0)
    depths = body.solid.depths / body.half_width
    near = np.outer(np.minimum(depths, 1.0), np.linspace(-4.0, 4.0, 65)).ravel()
    far = np.geomspace(5.0, max(_FARTHEST, 5.0 * depths[-1]), 49)
    X = np.concatenate([np.linspace(-5.0, 5.0, 161), near - 1.0, near + 1.0, -far, far])
    return depths, np.unique(np.round(X, 9))
