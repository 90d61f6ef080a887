"""Single states of a scene, solved once more by finite elements to see all of their fields."""

from collections.abc import Callable, Generator, Iterable, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app import ranks
from galinx.app.console.progress import Progress
from galinx.app.errors import BadInput, finite_elements_installed
from galinx.app.plan.fem import FemPlan
from galinx.app.plan.plan import make_plan
from galinx.app.plan.states import enumerate_states, order
from galinx.app.plan.task import Plan, Task
from galinx.app.scene.scene import Output, Scene
from galinx.app.scene.sense import FRICTIONS
from galinx.clock import Clock
from galinx.meshes.kind import DEGREES
from galinx.postprocess.quantities.quantity import INTENSITIES


@dataclass(frozen=True)
class OneState:
    """One state, and what computes it.

    Attributes:
        number: of the state, from 0.
        plan: finite elements at the scene's speeds, on one mesh.
        task: the state's speed.
        g: σ_XY/σ_YY under the punch.
        degree: polynomial degree.
        exact: is there a closed form to compare with?
        told: what tells the state from others, by the names of archives' columns.
    """

    number: int
    plan: Plan
    task: Task
    g: float
    degree: int
    exact: bool
    told: dict[str, Any]


@dataclass(frozen=True)
class Solved:
    """A state's displacement.

    Attributes:
        state: the state.
        space: the finite element space.
        fields, weights: displacements over N/(2μ), and what of them makes the state's.
        pressure: σ_YY over N/(2a) at X over a under the punch.
        comm: the ranks that share the mesh.
    """

    state: OneState
    space: Any
    fields: Sequence[Any]
    weights: NDArray
    pressure: Callable[[NDArray], NDArray]
    comm: Any


def chosen(
    scene: Scene,
    numbers: Sequence[int],
    degrees: Sequence[int | None] | None = None,
    extent: float = 0.0,
) -> list[OneState]:
    """States of a scene, whatever it asks for and by whichever method.

    Args:
        scene: the scene.
        numbers: of the states, from 0, in the order of :func:`galinx.app.plan.states.enumerate_states`.
        degrees: polynomial degrees, one a state; None for that which the scene's tolerance suggests.
        extent: |X| and |Y| over a that the mesh holds, if it has no walls.

    Raises:
        BadInput: there is no such state, or finite elements have no answer for it.
    """
    states = enumerate_states(scene)
    for number in numbers:
        if not 0 <= number < len(states):
            raise BadInput(
                f"state {number}: no such state; expected 0 to {len(states) - 1}, the scene has "
                f"{len(states)}"
            )
    if not numbers:
        raise BadInput("states: found none, expected numbers of some")
    if scene.body.found:
        raise BadInput(
            f"states: found a {scene.punch.profile.words()}, whose contact has another half-width in "
            "every state; fields of single states are there for a given half-width only. Stresses "
            'inside are archived by output.map and the quantity "interior"'
        )
    wanted = degrees or [None] * len(numbers)
    _check(scene, wanted)
    columns = {name: values[list(numbers)].tolist() for name, values in states.columns.items()}
    plan = make_plan(_for_finite_elements(scene, set(columns["c"])))
    assert plan.fem
    fem = replace(reaching(plan.fem, extent, plan.tasks), shared_speeds=False)
    tasks = {task.response.c: task for task in plan.tasks}
    # Given tractions are solved one degree above the rule: no measured error corrects it here.
    more = scene.solve.mode == "traction"
    found = []
    for i, number in enumerate(numbers):
        told = {name: values[i] for name, values in columns.items()}
        task = tasks[told["c"]]
        task = replace(task, body=task.body.loaded(told.get("load")))
        degree = wanted[i] or fem.degrees[task.number] + more
        exact = "closed_form" in scene.solve.methods
        found.append(OneState(number, replace(plan, fem=fem), task, told["g"], degree, exact, told))
    return found


def solved(states: Sequence[OneState]) -> Generator[Solved, None, None]:
    """One state after the other, each as long as the next is not asked for; collective.

    Raises:
        SolveError: the equations could not be solved.
    """
    with finite_elements_installed():
        from galinx.app.run.methods.fem import FiniteElements
    fem = FiniteElements(states[0].plan, Progress(), Clock())
    for state in states:
        with fem.one_state(state.task, state.g, state.degree) as (space, fields, weights, pressure):
            yield Solved(state, space, fields, weights, pressure, fem.work.comm)


def reaching(fem: FemPlan, extent: float, tasks: Iterable[Task]) -> FemPlan:
    """The same with a mesh that holds |X|, |Y| <= extent, over a, if it has no walls."""
    corner = max(abs(X + task.response.contraction) for task in tasks for X in (-1.0, 1.0)) * extent
    if fem.kind.walls or corner <= fem.kind.reach(fem.wanted):
        return fem
    wanted = replace(fem.wanted, farthest=corner)
    return replace(fem, wanted=wanted, refinement=fem.kind.refinement(wanted))


def displacement(scene: Scene, number: int, degree: int | None = None, extent: float = 0.0) -> Any:
    """The displacement [m] of a state as a dolfinx function on a mesh of the solid [m].

    Arguments are those of :func:`chosen`.

    Raises:
        BadInput: no such state, finite elements have no answer there, or there are several ranks.
        MachineFailure: dolfinx is not installed.
        SolveError: the equations could not be solved.
    """
    if ranks.size() > 1:
        raise BadInput(
            f"displacement: found {ranks.size()} ranks, expected one: the mesh is not shared out"
        )
    (state,) = chosen(scene, [number], [degree], extent)
    body, response = state.task.body, state.task.response
    with closing(solved([state])) as states:
        from galinx.solvers.fem.physical import in_physical_plane

        found = next(states)
        half_width = body.half_width
        return in_physical_plane(
            found.space, response, found.fields, found.weights, half_width, body.displacement
        )


def under_punch(
    scene: Scene, numbers: Sequence[int], degree: int | None = None
) -> tuple[NDArray, NDArray]:
    """Displacements of states under the punch; not collective, of one rank only.

    Args:
        scene: the scene.
        numbers: of the states, as in :func:`chosen`.
        degree: polynomial degree; None for that which the scene's tolerance suggests.

    Returns:
        Positions over a, (n,), and u and v [m] relative to the surface 100 a away, (states, 2, n).

    Raises:
        BadInput: no such state, or finite elements have no answer there.
        SolveError: the equations could not be solved.
    """
    X, fields = np.empty(0), []
    for one in solved([_alone(state) for state in chosen(scene, numbers, [degree] * len(numbers))]):
        nodes = one.space.contact
        X = one.space.chart.surface_position(nodes.s)
        at_nodes = np.empty((2, len(nodes.s)))
        for i in (0, 1):
            values = [field.getValues(nodes.dofs(i)) for field in one.fields]
            at_nodes[i, nodes.owned] = scene.body.displacement * (one.weights @ np.array(values))
        fields.append(at_nodes)
    return X, np.array(fields)


def _alone(state: OneState) -> OneState:
    """The same with a mesh that no other rank shares."""
    assert state.plan.fem
    return replace(state, plan=replace(state.plan, fem=replace(state.plan.fem, shared_speeds=True)))


def _for_finite_elements(scene: Scene, wanted: set[float]) -> Scene:
    """The scene with finite elements, at all its speeds that these can do, and those that are wanted.

    All speeds share one mesh; with the same speeds and places it is that of a run. States are steady
    ones, whatever else the scene asks for.
    """
    steady = tuple(name for name in scene.output.quantities if name not in FRICTIONS)
    every = order(scene).speeds
    possible = tuple(v for v in every if v in wanted or scene.solid.response(v).margin > 0.0)
    strokes = tuple(
        stroke if isinstance(stroke, str) else replace(stroke, speed=None)
        for stroke in scene.motion.strokes
    )
    return replace(
        scene,
        motion=replace(scene.motion, c=possible, speed=None, strokes=strokes),
        solve=replace(scene.solve, methods=("fem",)),
        output=replace(scene.output, quantities=steady) if steady else Output(quantities=(INTENSITIES,)),
        slider=None,
        time=None,
    )


def _check(scene: Scene, degrees: Sequence[int | None]) -> None:
    if scene.layers:
        raise BadInput(
            "layer: found layers, expected a uniform solid for fields of finite elements; "
            'output.quantities = ["interior"] gives the stresses inside layers'
        )
    # What the scene fixes, or what its rule gives, which is one more for given tractions.
    lowest, highest = min(scene.solve.degree or DEGREES[0], DEGREES[0]), DEGREES[1] + 1
    for degree in degrees:
        if degree is not None and not lowest <= degree <= highest:
            raise BadInput(f"degree: found {degree}, expected {lowest} to {highest}")
    if scene.solid.nearly_incompressible:
        raise BadInput(
            f"solid: found {scene.solid.words()}, expected ν <= 0.49 for stresses inside from finite "
            "elements"
        )
