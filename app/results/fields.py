"""Whole fields of states, for ParaView: displacement and stresses from finite elements.

Single states of a scene, solved once more by finite elements to see all of their fields.
"""

from collections.abc import Callable, Generator, Iterable, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx import __version__
from galinx.clock import Clock
from galinx.meshes.kind import DEGREES
from galinx.postprocess.quantities.quantity import INTENSITIES
from galinx.postprocess.stresses import maximum_shear, von_mises
from galinx.postprocess.target import Target
from galinx.solvers.contact import under_punch
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.sie.prescribed_pressure import GivenPressure

from .. import ranks
from ..console import Progress
from ..errors import BadInput, finite_elements_installed
from ..plan.fem import FemPlan
from ..plan.plan import inner, make_plan
from ..plan.states import enumerate_states, order
from ..plan.task import Plan, Task
from ..scene.scene import FRICTIONS, Output, Scene


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
    _check_states(scene, wanted)
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
        from ..run.methods.fem import FiniteElements
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
        from galinx.solvers.fem.fields import in_physical_plane

        found = next(states)
        half_width = body.half_width
        return in_physical_plane(
            found.space, response, found.fields, found.weights, half_width, body.displacement
        )


def displacement_under_punch(
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


def _check_states(scene: Scene, degrees: Sequence[int | None]) -> None:
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


#: What a field may hold, by name: (unit, long name).
ABOUT = {
    "displacement": ("m", "displacement relative to the surface 100 a away"),
    "sigma_XX": ("Pa", "in-plane normal stress along X"),
    "sigma_YY": ("Pa", "normal stress along Y"),
    "sigma_XY": ("Pa", "shear stress"),
    "sigma_ZZ": ("Pa", "normal stress out of the plane"),
    "von_mises": ("Pa", "von Mises stress"),
    "von_mises_for_colours": ("Pa", "von Mises stress, N/a where it is larger: infinite at the edges"),
    "maximum_shear": ("Pa", "largest shear stress in the plane"),
    "contact_pressure": ("Pa", "pressure under the punch, 0 beside it, NaN at its edges and inside"),
    "sigma_error": (
        "Pa",
        "largest difference of sigma_XX, sigma_YY, sigma_XY from the closed form, NaN on the surface",
    ),
}
#: What viewers colour by unasked.
COLOURED = "von_mises_for_colours"

#: Stress over N/(2a) from which that has one colour.
_BRIGHT = 2.0

#: Depth over a above which a point counts as on the surface, where the potentials do not hold.
_SURFACE = 1e-14


@dataclass(frozen=True)
class StateField:
    """One state of a scene on small quadrilaterals, in SI.

    Attributes:
        points: positions [m], (n, 2).
        quads: points of each quadrilateral counterclockwise, (m, 4); a triangle's last is doubled.
        data: quantities of ``ABOUT`` at the points, (n,), or (n, 3) for the displacement.
    """

    points: NDArray[np.float64]
    quads: NDArray[np.int64]
    data: dict[str, NDArray[np.float64]]


def write_fields(
    scene: Scene,
    numbers: Sequence[int],
    path: Path | Target,
    extent: float = 10.0,
    degrees: Sequence[int | None] | None = None,
) -> None:
    """Compute states of a scene and write them for ParaView, several as a series over their numbers.

    Collective over MPI's world; rank 0 writes. Nothing is replaced by a path alone. Arguments and
    failures are those of :func:`state_field`, with a list for each number.

    Raises:
        Occupied: something is there that may not be replaced.
        UnwritableArchive: the file system refused.
    """
    _check(scene, extent)
    states = chosen(scene, numbers, degrees, extent)
    with finite_elements_installed():
        from mpi4py import MPI
    if MPI.COMM_WORLD.rank > 0:
        for found in solved(states):
            found.comm.send(_piece(found, extent), 0)
        return
    from galinx.postprocess.hdf5 import vtkhdf

    steps = (
        vtkhdf.Step(float(found.state.number), _pieces(found, extent), _told(scene, found.state))
        for found in solved(states)
    )
    vtkhdf.write(path, steps, ABOUT, COLOURED, series=len(states) > 1)


def _pieces(found: Solved, extent: float) -> Iterable[StateField]:
    """Those of all ranks, on rank 0, which has one of another rank at a time."""
    comm = found.comm
    others = (comm.recv(source=rank) for rank in range(1, comm.size))
    return chain([_piece(found, extent)], others)


def state_field(
    scene: Scene, number: int, extent: float = 10.0, degree: int | None = None
) -> StateField | None:
    """One state of a scene from one factorisation, on rank 0; None on the others. Collective.

    Whatever the scene asks for and by whichever method, this is done with finite elements.

    Args:
        scene: the scene.
        number: of the state, from 0, in the order of :func:`galinx.app.plan.states.enumerate_states`.
        extent: what is shown is |X|, |Y| <= extent, over a.
        degree: polynomial degree; that which the scene's tolerance suggests if not given.

    Raises:
        BadInput: there is no such state, or finite elements have no answer for it.
        SolveError: the equations could not be solved.
    """
    _check(scene, extent)
    (state,) = chosen(scene, [number], [degree], extent)
    with closing(solved([state])) as states:
        found = next(states)
        whole = _sampled(found, extent).gathered(found.comm)
        return None if whole is None else _in_si(found, whole)


def _check(scene: Scene, extent: float) -> None:
    limit = inner(scene)
    if not 0.0 < extent <= limit:
        raise BadInput(
            f"extent: found {extent:g} a, expected more than 0 and at most {limit:g} a with the "
            f"{scene.solve.mesh} mesh at the tolerance {scene.solve.tolerance:g}"
        )


def _told(scene: Scene, state: OneState) -> dict[str, Any]:
    """What a file says of a state beside its fields; numbers in SI."""
    body = state.task.body
    return {
        "title": scene.title,
        "state": state.number,
        **state.told,
        "speed": state.told["c"] * body.solid.c_s,
        "load": body.load,
        "half_width": body.half_width,
        "mean_pressure": body.stress,
        "degree": state.degree,
        "program": f"galinx {__version__}",
    }


def _piece(found: Solved, extent: float) -> StateField:
    """This rank's."""
    return _in_si(found, _sampled(found, extent))


def _sampled(found: Solved, extent: float) -> Any:
    """This rank's piece of the state's field over a, N/(2μ) and N/(2a)."""
    from galinx.solvers.fem.fields import sample

    state = found.state
    return sample(
        found.space, state.task.response, found.fields, found.weights, extent, state.degree
    )  # fmt: skip


def _in_si(solution: Solved, sampled: Any) -> StateField:
    """Lengths in m, stresses in Pa, for the scene's load per depth."""
    state, task = solution.state, solution.state.task
    body, solid = task.body, task.body.solid
    found = task.response.stresses(sampled.gradient)
    XX, YY, XY = body.stress * found
    ZZ = solid.σ_ZZ(XX, YY, XY)
    mises = von_mises(XX, YY, XY, ZZ)
    displacement = body.displacement * sampled.displacement
    data = {
        "displacement": np.column_stack([displacement, np.zeros(len(displacement))]),
        "sigma_XX": XX,
        "sigma_YY": YY,
        "sigma_XY": XY,
        "sigma_ZZ": ZZ,
        "von_mises": mises,
        COLOURED: np.minimum(mises, _BRIGHT * body.stress),
        "maximum_shear": maximum_shear(XX, YY, XY),
        "contact_pressure": body.stress * _pressure(solution, sampled.points),
    }
    if state.exact:
        exact: FlatPunch | GivenPressure = FlatPunch(task.response, state.g)
        if body.pressure:
            exact = GivenPressure(task.response, state.g, body.pressure)
        data["sigma_error"] = body.stress * _error(exact, sampled.points, found)
    return StateField(body.half_width * sampled.points, sampled.quads, data)


def _inside(points: NDArray) -> NDArray[np.bool_]:
    """Which points lie below the surface, (n,)."""
    X, Y = points.T
    return -_SURFACE * np.maximum(1.0, np.abs(X)) > Y


def _pressure(solution: Solved, points: NDArray) -> NDArray[np.float64]:
    """Under the punch over N/(2a), 0 beside it, NaN at its edges and inside, (n,)."""
    X = points[:, 0]
    on, found = ~_inside(points), np.full(len(points), np.nan)
    under = on & under_punch(X)
    found[on & (np.abs(X) > 1.0)] = 0.0
    found[under] = -solution.pressure(X[under])
    return found


def _error(exact: FlatPunch | GivenPressure, points: NDArray, found: NDArray) -> NDArray[np.float64]:
    """Largest difference of a component from the closed form over N/(2a); NaN on the surface, (n,)."""
    inside, error = _inside(points), np.full(len(points), np.nan)
    X, Y = points[inside].T
    error[inside] = np.abs(found[:, inside] - exact.inside(X, Y)).max(axis=0)
    return error
