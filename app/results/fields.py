"""Whole fields of single states from finite elements: displacement and stresses, as a dolfinx function or
for ParaView.

A state of a scene is solved once more, whatever the scene asks for and by whichever method. Its fields
are given in SI on the mesh of the solid, or on small quadrilaterals within it.
"""

from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from itertools import chain
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx import __version__
from galinx.clock import Clock
from galinx.meshes.kind import DEGREES
from galinx.postprocess.quantities.quantity import CLOSED_FORM
from galinx.postprocess.quantities.stresses import STRESSES_INSIDE
from galinx.postprocess.target import Target
from galinx.solvers.contact import INTENSITIES
from galinx.solvers.contact.edges import under_punch
from galinx.solvers.contact.solution import GIVEN_ENDS, Task
from galinx.solvers.contact.stresses import maximum_shear, von_mises

from .. import ranks
from ..console import Progress
from ..errors import BadInput, finite_elements_installed, listed
from ..methods import METHODS
from ..plan.elements import farthest_inside
from ..plan.plan import make_plan
from ..plan.states import enumerate_states, order
from ..plan.variants import of_state
from ..scene.scene import FRICTIONS, Scene
from ..scene.sections import Output


@dataclass(frozen=True)
class Solved:
    """A state of a scene, and its displacement by finite elements.

    Attributes:
        scene: the scene, of a sweep the one that has this state.
        number: of the state, from 0.
        parameters: values that distinguish the state, by the names of archives' columns.
        task: the state's speed.
        degree: polynomial degree.
        space: the finite element space.
        fields, weights: displacements over N/(2μ), and their factors in the state's displacement.
        pressure: σ_YY over N/(2a) at X over a under the punch.
        comm: the ranks that share the mesh.
    """

    scene: Scene
    number: int
    parameters: dict[str, Any]
    task: Task
    degree: int
    space: Any
    fields: Sequence[Any]
    weights: NDArray
    pressure: Callable[[NDArray], NDArray]
    comm: Any

    def sampled(self, extent: float) -> Any:
        """This rank's piece of the state's field over a, N/(2μ) and N/(2a)."""
        from galinx.solvers.fem.export import sample

        return sample(self.space, self.task.response, self.fields, self.weights, extent, self.degree)


def solve_states(
    scene: Scene,
    numbers: Sequence[int],
    degrees: Sequence[int | None] | None = None,
    extent: float = 0.0,
    shared: bool = True,
) -> Generator[Solved, None, None]:
    """Solve states by finite elements, one after the other, whatever the scene asks for.

    Collective. Each solution is valid until the next is requested; faults are raised at once.

    Args:
        scene: the scene.
        numbers: of the states, from 0, in the order of :func:`galinx.app.plan.states.enumerate_states`.
        degrees: polynomial degrees, one a state; None for the degree that the scene's tolerance suggests.
        extent: |X| and |Y| over a that the mesh holds, if it has no walls.
        shared: all ranks share the mesh.

    Raises:
        BadInput: there is no such state, or finite elements have no answer for it.
        SolveError: the equations could not be solved.
    """
    if not numbers:
        raise BadInput("states: found none, expected numbers of some")
    count = len(order(scene)) * len(scene.each)
    if missing := [number for number in numbers if not 0 <= number < count]:
        raise BadInput(
            f"state {missing[0]}: no such state; expected 0 to {count - 1}, the scene has {count}"
        )
    own = [of_state(scene, number) for number in numbers]
    if any(variant is not own[0][0] for variant, _ in own):
        raise BadInput(
            f"states: found {listed([*map(str, numbers)])}, expected states of one solid and one "
            f"punch, with the same {listed([*scene.swept])}"
        )
    scene, rows, degrees = own[0][0], [row for _, row in own], degrees or [None] * len(numbers)
    _refuse(scene, degrees)
    columns = {name: values[rows] for name, values in enumerate_states(scene).columns.items()}
    plan = make_plan(_for_finite_elements(scene, {*columns["c"].tolist()}))
    assert plan.fem
    corner = extent * max(abs(X + task.response.contraction) for task in plan.tasks for X in (-1.0, 1.0))
    fem = replace(plan.fem, shared_speeds=not shared)
    if not fem.kind.walls and corner > fem.kind.reach(fem.wanted):
        wider = replace(fem.wanted, farthest=corner)
        fem = replace(fem, wanted=wider, refinement=fem.kind.refinement(wider))
    with finite_elements_installed():
        from galinx.solvers.fem.method import FiniteElements

    method: Any = FiniteElements(replace(plan, fem=fem), Progress(), Clock())
    tasks = {task.response.c: task for task in plan.tasks}
    # Prescribed tractions are solved one degree above the rule: no measured error corrects it here.
    more = scene.solve.mode == "traction"

    def solved() -> Generator[Solved, None, None]:
        for i, number in enumerate(numbers):
            parameters = {name: values[i].item() for name, values in columns.items()}
            task = tasks[parameters["c"]]
            task = replace(task, body=task.body.loaded(parameters.get("load")))
            degree = degrees[i] or fem.degrees[task.number] + more
            with method.one_state(task, parameters["g"], degree) as (space, fields, weights, pressure):
                yield Solved(
                    scene, number, parameters, task, degree, space, fields, weights, pressure,
                    method.work.comm,
                )  # fmt: skip

    return solved()


def _refuse(scene: Scene, degrees: Sequence[int | None]) -> None:
    """Refuse scenes and degrees for which finite elements have no fields.

    Raises:
        BadInput: this is one; the message says what to do.
    """
    if GIVEN_ENDS in scene.body.lacks:
        raise BadInput(
            f"fields: found a {scene.punch.profile.words()}, whose contact ends where the pressure says, "
            "expected ends that are given, as of a flat punch. Stresses inside are archived by "
            'output.map and the quantity "interior"'
        )
    if scene.layers:
        raise BadInput(
            "layer: found layers, expected a uniform solid for fields of finite elements; "
            'output.quantities = ["interior"] gives the stresses inside layers'
        )
    # The scene fixes the degree, or its rule gives it, which is one more for prescribed tractions.
    lowest, highest = min(scene.solve.degree or DEGREES[0], DEGREES[0]), DEGREES[1] + 1
    for degree in degrees:
        if degree is not None and not lowest <= degree <= highest:
            raise BadInput(f"degree: found {degree}, expected {lowest} to {highest}")
    if scene.solid.nearly_incompressible:
        raise BadInput(
            f"solid: found {scene.solid.words()}, expected ν <= 0.49 for stresses inside from finite "
            "elements"
        )


def _for_finite_elements(scene: Scene, speeds: set[float]) -> Scene:
    """Scene with finite elements, at all its speeds that these can solve, and at the given speeds.

    All speeds share one mesh; with the same speeds and places it is that of a run. States are steady
    ones, whatever else the scene asks for.
    """
    steady = tuple(name for name in scene.output.quantities if name not in FRICTIONS)
    possible = tuple(
        c for c in order(scene).speeds if c in speeds or scene.solid.response(c).margin > 0.0
    )
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


def _check_extent(scene: Scene, extent: float) -> None:
    """Raise BadInput for what is no distance over a that a scene's mesh holds."""
    limit = farthest_inside(scene)
    if not (isinstance(extent, Real) and 0.0 < extent <= limit):
        given = f"{extent:g} a" if isinstance(extent, Real) else f"{extent!r:.60}"
        raise BadInput(
            f"extent: found {given}, expected more than 0 and at most {limit:g} a with the "
            f"{scene.solve.mesh} mesh at the tolerance {scene.solve.tolerance:g}"
        )


def displacement(scene: Scene, number: int, degree: int | None = None, extent: float = 10.0) -> Any:
    """Displacement [m] of a state as a dolfinx function on a mesh of the solid [m].

    Arguments are those of :func:`solve_states`.

    Raises:
        BadInput: no such state, finite elements have no answer there, or there are several ranks.
        MachineFailure: dolfinx is not installed.
        SolveError: the equations could not be solved.
    """
    if ranks.size() > 1:
        raise BadInput(
            f"displacement: found {ranks.size()} ranks, expected one: the mesh is not shared out"
        )
    _check_extent(scene, extent)
    with closing(solve_states(scene, [number], [degree], extent)) as states:
        from galinx.solvers.fem.export import in_physical_plane

        solved = next(states)
        body, response = solved.task.body, solved.task.response
        return in_physical_plane(
            solved.space, response, solved.fields, solved.weights, body.half_width, body.displacement
        )


def displacement_under_punch(
    scene: Scene, numbers: Sequence[int], degree: int | None = None
) -> tuple[NDArray, NDArray]:
    """Displacements of states under the punch; not collective, of one rank only.

    Args:
        scene: the scene.
        numbers: of the states, as in :func:`solve_states`.
        degree: polynomial degree; None for the degree that the scene's tolerance suggests.

    Returns:
        Positions over a, (n,), and u and v [m] relative to the surface 100 a away, (states, 2, n).

    Raises:
        BadInput: no such state, or finite elements have no answer there.
        SolveError: the equations could not be solved.
    """
    X, fields = np.empty(0), []
    for solved in solve_states(scene, numbers, [degree] * len(numbers), shared=False):
        nodes, of_state = solved.space.contact, np.empty((2, len(solved.space.contact.s)))
        X = solved.space.chart.surface_position(nodes.s)
        for i in (0, 1):
            values = np.array([field.getValues(nodes.dofs(i)) for field in solved.fields])
            of_state[i, nodes.owned] = solved.task.body.displacement * (solved.weights @ values)
        fields.append(of_state)
    return X, np.array(fields)


#: Quantities of a field, by name: (unit, long name).
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
#: Quantity by which viewers colour a field by default.
COLOURED = "von_mises_for_colours"


def write_fields(
    scene: Scene,
    numbers: Sequence[int],
    target: Target,
    extent: float = 10.0,
    degrees: Sequence[int | None] | None = None,
) -> None:
    """Compute states of a scene and write them for ParaView, several as a series over their numbers.

    Collective over MPI's world; rank 0 writes.

    Args:
        scene, numbers, degrees: as for :func:`solve_states`.
        target: the file.
        extent: fields are cut at |X|, |Y| = extent, over a.

    Raises:
        BadInput: there is no such state, or finite elements have no answer for it.
        SolveError: the equations could not be solved.
        UnwritableArchive: the file system refused.
    """
    _check_extent(scene, extent)
    states = solve_states(scene, numbers, degrees, extent)
    from mpi4py import MPI

    if MPI.COMM_WORLD.rank > 0:
        for solved in states:
            solved.comm.send(in_si(solved, solved.sampled(extent)), 0)
        return
    from galinx.postprocess.hdf5 import vtkhdf

    def step(solved: Solved) -> Any:
        """A state and the pieces of its field of all ranks, of which rank 0 holds one of another at a
        time."""
        body = solved.task.body
        attributes = {
            "title": solved.scene.title,
            "state": solved.number,
            **solved.parameters,
            "speed": solved.parameters["c"] * body.solid.c_s,
            "load": body.load,
            "half_width": body.half_width,
            "mean_pressure": body.stress,
            "degree": solved.degree,
            "program": f"galinx {__version__}",
        }
        others = (solved.comm.recv(source=rank) for rank in range(1, solved.comm.size))
        pieces = chain([in_si(solved, solved.sampled(extent))], others)
        return vtkhdf.Step(float(solved.number), pieces, attributes)

    vtkhdf.write(target, map(step, states), ABOUT, COLOURED, series=len(numbers) > 1)


def in_si(solved: Solved, sampled: Any) -> Any:
    """Field of a state in SI, for the scene's load per depth: lengths in m, stresses in Pa.

    Returns:
        A :class:`galinx.postprocess.hdf5.vtkhdf.Piece` with the quantities of ``ABOUT``.
    """
    from galinx.postprocess.hdf5.vtkhdf import Piece

    scene, task = solved.scene, solved.task
    body = task.body
    stresses = task.response.stresses(sampled.gradient)
    XX, YY, XY = body.stress * stresses
    ZZ = body.solid.σ_ZZ(XX, YY, XY)
    mises = von_mises(XX, YY, XY, ZZ)
    displacement, points = body.displacement * sampled.displacement, sampled.points
    X, Y = points.T
    on = -1e-14 * np.maximum(1.0, np.abs(X)) <= Y  # on the surface the potentials do not hold
    # Pressure under the punch, 0 beside it, NaN at its edges and inside.
    under, pressure = on & under_punch(X), np.full(len(points), np.nan)
    pressure[on & (np.abs(X) > 1.0)] = 0.0
    pressure[under] = -solved.pressure(X[under])
    data = {
        "displacement": np.column_stack([displacement, np.zeros(len(displacement))]),
        "sigma_XX": XX,
        "sigma_YY": YY,
        "sigma_XY": XY,
        "sigma_ZZ": ZZ,
        "von_mises": mises,
        COLOURED: np.minimum(mises, 2.0 * body.stress),  # N/a
        "maximum_shear": maximum_shear(XX, YY, XY),
        "contact_pressure": body.stress * pressure,
    }
    refused = METHODS[CLOSED_FORM].refusal(scene, body, STRESSES_INSIDE[CLOSED_FORM][0])
    if CLOSED_FORM in scene.solve.methods and not refused:
        # The largest difference of a component from the closed form; NaN on the surface.
        g = np.array([solved.parameters["g"]])
        exact = body.contacts(task.response, g).stresses(*points[~on].T)[:, 0]
        error = np.full(len(points), np.nan)
        error[~on] = np.abs(stresses[:, ~on] - exact).max(axis=0)
        data["sigma_error"] = body.stress * error
    return Piece(body.half_width * points, sampled.quads, data)
