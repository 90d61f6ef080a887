"""A plan in words: its steps with their sizes, and what they will cost."""

from galinx.app import ranks
from galinx.app.methods import DOLFINX, METHODS
from galinx.app.plan import cost
from galinx.app.plan.fem import FOLLOWED, OWN_MESHES, FemPlan, levels, unknowns
from galinx.app.plan.sweep import BESIDES, LADDERS
from galinx.app.plan.task import CHUNK_NUMBERS, Plan
from galinx.app.scene.excerpt import listed
from galinx.app.scene.scene import Scene
from galinx.postprocess.quantities import stresses
from galinx.postprocess.quantities.quantity import CLOSED_FORM, FEM, SIE
from galinx.solvers.layers.layered import Layered
from galinx.solvers.profiles import kinks
from galinx.texts import counted

#: Seconds of a state that has a mesh of its own, and of a speed at which the ends of all are found.
_SECONDS_OF_OWN_MESH, _SECONDS_OF_ENDS = 1.5, 1.0
#: Ladders that finding the ends of a contact over layers takes, with that of the contact itself.
_MESHES_A_CONTACT = 3.0


def lines(scene: Scene, plan: Plan) -> list[str]:
    """The plan in words, one step a line."""
    law, integrator = scene.friction.law.about, scene.friction.integrator
    result = [f"friction: {counted(plan.states, 'state')}, {law}, integrator {integrator}"]
    if scene.slider:
        count = scene.friction.count * len(scene.punch.loads)
        result.append(f"slider: {counted(count, 'motion')} of {scene.slider.duration:g} s")
    if plan.starts:
        result += plan.starts.words(scene.solid)  # type: ignore[arg-type]
    for name in plan.methods:
        if name != FEM:
            result.append(f"{METHODS[name].about}: {counted(plan.states, 'state')}")
    if plan.fem:
        result += _fem_lines(scene, plan, plan.fem)
    if plan.asks(stresses.ON_SURFACE):
        result.append(f"stresses on the surface: {plan.states} x {len(plan.places.X)} points")
    if plan.asks(stresses.BELOW):
        result.append(f"stresses inside: {plan.states} x {len(plan.places.points)} points")
    return result


def _fem_lines(scene: Scene, plan: Plan, fem: FemPlan) -> list[str]:
    if fem.mode == OWN_MESHES:
        return [
            f"finite elements: {plan.different} states, each on a confocal mesh of its own, graded "
            f"towards the kinks of the punch, degree {max(fem.degrees)} or what the measured error asks "
            "for; where their contacts end is found once a speed"
        ]
    if fem.mode == FOLLOWED:
        return [
            f"finite elements: {plan.different} states, each on meshes along the interfaces that follow "
            f"its contact until this carries the load, degree {max(fem.degrees)} or what the measured "
            "error asks for"
        ]
    pattern = fem.pattern
    cells = len(pattern.cells) * fem.cuts**2
    result = [f"mesh: {fem.mesh}, {cells} quadrilaterals, shared by all speeds"]
    pressure = " and those of a pressure" * scene.solid.nearly_incompressible
    others = "one of a higher degree measures" if fem.fixed else "two of lower degree measure"
    by = ", assembled by dolfinx" * (fem.assembler == DOLFINX)
    solver = "one factorisation" if fem.solver == "direct" else f"conjugate gradients with {fem.solver}"
    speeds: dict[int, list[str]] = {}
    for task, degree in zip(plan.tasks, fem.degrees):
        speeds.setdefault(degree, []).append(f"{task.response.c:g}")
    if fem.sweep:
        c, degree = [task.response.c for task in plan.tasks], max(fem.degrees)
        result.append(
            f"finite elements at {len(set(c))} speeds, c = {min(c):g} to {max(c):g} (over c_s): degree "
            f"{degree}, {unknowns(pattern, fem.cuts * degree)} unknowns{pressure}{by}; so many are "
            f"solved as a fit needs to tell the others, {LADDERS + BESIDES} or so; at each of these "
            f"{solver} serves all states, at {LADDERS} {others} its error"
        )
        speeds = {}
    result += [
        f"finite elements at c = {listed(some)} (over c_s): degree {degree}, "
        f"{unknowns(pattern, fem.cuts * degree)} unknowns{pressure}{by}; at each speed {solver} serves "
        f"all states, {others} its error"
        for degree, some in speeds.items()
    ]
    if ranks.size() > 1:
        how = "each takes whole speeds" if fem.shared_speeds else "together on one mesh"
        result.append(f"ranks: {ranks.size()}, {how}")
    return result


def expense(plan: Plan) -> str:
    """Estimated time and memory of a plan, and the size of its archive."""
    together = plan.chunk * plan.numbers
    positions = sum(len(values) for values in plan.positions.values())
    numbers = plan.states * (plan.numbers + len(plan.quantities)) + positions
    archived = f"an archive of {_size(cost.bytes_archived(numbers, len(plan.quantities)))}"
    if not plan.fem:
        seconds = cost.START_WITHOUT_FEM + plan.integrated + _inside(plan) + cost.seconds_of_states(
            plan.strokes, len(plan.tasks), plan.states, len(plan.quantities), plan.numbers
        )  # fmt: skip
        seconds += _in_time(plan) + _equations(plan)
        memory = cost.bytes_without_fem(plan.states, together)
        return f"about {seconds:.2g} s, {_size(memory)} and {archived}"
    fem = plan.fem
    speeds = _seconds_of_levels(fem, plan.different) / ranks.size()
    states = cost.STATE * plan.states + plan.integrated
    sharing = 1 if fem.shared_speeds else ranks.size()
    inside = _inside(plan) * sharing / ranks.size()
    most = unknowns(fem.pattern, max(p * k for p, k in _levels(fem))) / sharing
    numbers = max(CHUNK_NUMBERS, together)
    memory = cost.bytes_of(most, max(fem.degrees), fem.solver == "direct", numbers)
    parts = {
        "start": cost.START,
        "starts from rest": _in_time(plan),
        "finite elements": speeds,
        "states": states,
        "stresses inside": inside,
        "integral equations": _equations(plan),
    }
    told = ", ".join(f"{name} {seconds:.2g}" for name, seconds in parts.items() if seconds)
    total = sum(parts.values())
    return f"about {total:.2g} s ({told}) on cores of 3 GHz, {_size(memory)} a rank and {archived}"


def _in_time(plan: Plan) -> float:
    """Seconds of starts from rest."""
    return plan.starts.seconds(plan.body.solid) if plan.starts else 0.0  # type: ignore[arg-type]


def _equations(plan: Plan) -> float:
    """Seconds of contacts over layers whose integral equations are solved one by one."""
    body = plan.body
    if not (body.found and isinstance(body.solid, Layered) and SIE in plan.methods):
        return 0.0
    kinked = bool(len(kinks(body.profile)))
    if not kinked and body.free:
        return 0.0  # of a few frictions, which tell all others
    graded = body.solid.layers[0].bottom is not None
    return cost.seconds_of_equations(plan.states, kinked, graded)


def _inside(plan: Plan) -> float:
    """Seconds for stresses inside, those to archive them among them."""
    shape = len(plan.places.points), len(plan.tasks), plan.different
    pieces = len(plan.body.pressure.knots) - 1 if plan.body.pressure else 0
    by_fem, exact = (plan.asks(stresses.BELOW, method) for method in (FEM, CLOSED_FORM))
    seconds = cost.seconds_inside(*shape, pieces, by_fem, exact)
    if not plan.fem:
        return seconds  # the law for states knows of all their numbers
    return seconds + cost.seconds_to_archive(plan.states * plan.numbers_inside)


def _levels(fem: FemPlan) -> list[tuple[int, int]]:
    """Degrees and cuts that speeds are solved with, all that are."""
    if fem.sweep:
        degree = max(fem.degrees)
        ladder = levels(degree, fem.cuts, fem.fixed)
        return LADDERS * ladder + BESIDES * [(degree, fem.cuts)]
    return [level for degree in fem.degrees for level in levels(degree, fem.cuts, fem.fixed)]


def _seconds_of_levels(fem: FemPlan, states: int) -> float:
    """Seconds of the levels of every speed, one after the other."""
    mesh, direct = fem.pattern, fem.solver == "direct"
    if fem.mode == OWN_MESHES:
        return _SECONDS_OF_OWN_MESH * states + _SECONDS_OF_ENDS * len(fem.degrees)
    found = sum(
        cost.seconds_of_level(len(mesh.cells) * k**2, p, unknowns(mesh, k * p), direct)
        for p, k in _levels(fem)
    )
    return found * (_MESHES_A_CONTACT * states / len(fem.degrees) if fem.mode == FOLLOWED else 1.0)


def _size(count: float) -> str:
    """Bytes for a reader."""
    for unit, size in (("GB", 1e9), ("MB", 1e6)):
        if count >= 0.1 * size:
            return f"{count / size:.2g} {unit}"
    return f"{count / 1e3:.2g} kB"
