"""A plan in words: its steps with their sizes, and what they will cost."""

from galinx.app import ranks
from galinx.app.plan import cost
from galinx.app.plan.plan import CHUNK_NUMBERS, Plan, unknowns
from galinx.app.scene.scene import Scene
from galinx.meshes.halfplane import MESHES


def lines(scene: Scene, plan: Plan) -> list[str]:
    """The plan in words, one step a line."""
    result = [f"friction: {plan.states} states, Dahl's law, integrator {scene.friction.integrator}"]
    if plan.closed_form:
        result.append(f"closed form: {plan.states} states")
    if plan.refinement:
        result += _fem_lines(scene, plan)
    if plan.surface:
        result.append(f"stresses on the surface: {plan.states} x {len(plan.grid)} points")
    if plan.interior:
        result.append(f"stresses inside: {plan.states} x {len(plan.points)} points")
    return result


def _fem_lines(scene: Scene, plan: Plan) -> list[str]:
    assert plan.refinement
    cells = len(MESHES[scene.solve.mesh].build(plan.refinement).cells) * plan.cuts**2
    result = [f"mesh: {scene.solve.mesh}, {cells} quadrilaterals, shared by all speeds"]
    pressure = " and those of a pressure" * plan.mixed
    lower = "half and a quarter of the cuts" if scene.solve.degree else "lower degree"
    solver = "one factorisation" if plan.solver == "direct" else f"conjugate gradients with {plan.solver}"
    result += [
        f"finite elements at c = {speed.c:g} (over c_s): degree {speed.degree}, "
        f"{_unknowns(scene, plan, speed.degree)} unknowns{pressure}; {solver} serves all states, two of "
        f"{lower} measure its error"
        for speed in plan.speeds
    ]
    if ranks.size() > 1:
        how = "each takes whole speeds" if plan.shared_speeds else "together on one mesh"
        result.append(f"ranks: {ranks.size()}, {how}")
    return result


def _unknowns(scene: Scene, plan: Plan, degree: int) -> int:
    """Unknowns of the finest mesh, exactly."""
    assert plan.refinement
    return unknowns(MESHES[scene.solve.mesh].build(plan.refinement), plan.cuts * degree)


def expense(scene: Scene, plan: Plan) -> str:
    """Estimated time and memory of a plan."""
    if not plan.refinement:
        return f"about {cost.START_WITHOUT_FEM + cost.STATE * plan.states:.2g} s and 0.1 GB"
    mesh = MESHES[scene.solve.mesh].build(plan.refinement)
    if scene.solve.degree:
        levels = [(scene.solve.degree, plan.cuts // k) for k in (4, 2, 1)] * len(plan.speeds)
    else:
        levels = [(p, 1) for s in plan.speeds for p in range(s.degree - 2, s.degree + 1)]
    direct = plan.solver == "direct"
    seconds = sum(
        cost.seconds_of_level(len(mesh.cells) * k**2, p, unknowns(mesh, k * p), direct) for p, k in levels
    )
    speeds, states = seconds / ranks.size(), cost.STATE * plan.states
    highest = max(speed.degree for speed in plan.speeds)
    together = 1 if plan.shared_speeds else ranks.size()
    most = unknowns(mesh, plan.cuts * highest) / together
    memory = cost.bytes_of(most, highest, direct, CHUNK_NUMBERS)
    parts = f"start {cost.START:g}, finite elements {speeds:.2g}, states {states:.2g}"
    total = cost.START + speeds + states
    return f"about {total:.2g} s ({parts}) on cores of 3 GHz, and {memory / 1e9:.2g} GB a rank"
