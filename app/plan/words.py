"""A plan in words: its steps with their sizes, and what they will cost."""

from galinx.app import ranks
from galinx.app.plan import cost
from galinx.app.plan.fem import FemPlan, levels, unknowns
from galinx.app.plan.task import CHUNK_NUMBERS, Plan
from galinx.app.run.methods import METHODS
from galinx.app.scene.excerpt import listed
from galinx.app.scene.scene import Scene
from galinx.postprocess.quantities import stresses
from galinx.postprocess.quantities.quantity import FEM


def lines(scene: Scene, plan: Plan) -> list[str]:
    """The plan in words, one step a line."""
    law, integrator = scene.friction.law.about, scene.friction.integrator
    result = [f"friction: {plan.states} states, {law}, integrator {integrator}"]
    for name in plan.methods:
        if name != FEM:
            result.append(f"{METHODS[name].about}: {plan.states} states")
    if plan.fem:
        result += _fem_lines(scene, plan, plan.fem)
    if plan.asks(stresses.ON_SURFACE):
        result.append(f"stresses on the surface: {plan.states} x {len(plan.places.X)} points")
    if plan.asks(stresses.BELOW):
        result.append(f"stresses inside: {plan.states} x {len(plan.places.points)} points")
    return result


def _fem_lines(scene: Scene, plan: Plan, fem: FemPlan) -> list[str]:
    pattern = fem.pattern
    cells = len(pattern.cells) * fem.cuts**2
    result = [f"mesh: {scene.solve.mesh}, {cells} quadrilaterals, shared by all speeds"]
    pressure = " and those of a pressure" * scene.solid.nearly_incompressible
    others = "one of a higher degree measures" if fem.fixed else "two of lower degree measure"
    solver = "one factorisation" if fem.solver == "direct" else f"conjugate gradients with {fem.solver}"
    speeds: dict[int, list[str]] = {}
    for task, degree in zip(plan.tasks, fem.degrees):
        speeds.setdefault(degree, []).append(f"{task.response.c:g}")
    result += [
        f"finite elements at c = {listed(some)} (over c_s): degree {degree}, "
        f"{unknowns(pattern, fem.cuts * degree)} unknowns{pressure}; at each speed {solver} serves all "
        f"states, {others} its error"
        for degree, some in speeds.items()
    ]
    if ranks.size() > 1:
        how = "each takes whole speeds" if fem.shared_speeds else "together on one mesh"
        result.append(f"ranks: {ranks.size()}, {how}")
    return result


def expense(plan: Plan) -> str:
    """Estimated time and memory of a plan."""
    fem = plan.fem
    if not fem:
        seconds = cost.START_WITHOUT_FEM + cost.seconds_of_states(
            plan.strokes, len(plan.tasks), plan.states, len(plan.quantities), plan.numbers
        )
        memory = cost.bytes_without_fem(plan.states, plan.chunk * plan.numbers)
        return f"about {seconds:.2g} s and {memory / 1e9:.1g} GB"
    mesh = fem.pattern
    solved = [level for degree in fem.degrees for level in levels(degree, fem.cuts, fem.fixed)]
    direct = fem.solver == "direct"
    seconds = sum(
        cost.seconds_of_level(len(mesh.cells) * k**2, p, unknowns(mesh, k * p), direct) for p, k in solved
    )
    speeds, states = seconds / ranks.size(), cost.STATE * plan.states
    highest = max(fem.degrees)
    together = 1 if fem.shared_speeds else ranks.size()
    most = unknowns(mesh, max(p * k for p, k in solved)) / together
    memory = cost.bytes_of(most, highest, direct, CHUNK_NUMBERS)
    parts = f"start {cost.START:g}, finite elements {speeds:.2g}, states {states:.2g}"
    total = cost.START + speeds + states
    return f"about {total:.2g} s ({parts}) on cores of 3 GHz, and {memory / 1e9:.2g} GB a rank"
