"""The whole field of one state, for ParaView: displacement and stresses from finite elements."""

from dataclasses import dataclass, replace
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.console.progress import Progress
from galinx.app.errors import BadInput, finite_elements_installed
from galinx.app.plan.limits import inner
from galinx.app.plan.plan import make_plan
from galinx.app.plan.states import enumerate_states, speeds
from galinx.app.plan.task import Plan, Task
from galinx.app.scene.scene import Output, Scene
from galinx.clock import Clock
from galinx.meshes.kind import DEGREES
from galinx.postprocess.quantities.quantity import FRICTION_ALONE, INTENSITIES
from galinx.postprocess.stresses import maximum_shear, von_mises
from galinx.postprocess.target import Target
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.sie.linear import GivenPressure

#: What a field may hold, by name: (unit, long name).
ABOUT = {
    "displacement": ("m", "displacement relative to the far boundary"),
    "sigma_XX": ("Pa", "in-plane normal stress along X"),
    "sigma_YY": ("Pa", "normal stress along Y"),
    "sigma_XY": ("Pa", "shear stress"),
    "sigma_ZZ": ("Pa", "normal stress out of the plane"),
    "von_mises": ("Pa", "von Mises stress"),
    "maximum_shear": ("Pa", "largest shear stress in the plane"),
    "sigma_error": (
        "Pa",
        "largest difference of sigma_XX, sigma_YY, sigma_XY from the closed form, NaN on the surface",
    ),
}

#: Depth over a above which a point counts as on the surface, where the potentials do not hold.
_SURFACE = 1e-14


@dataclass(frozen=True)
class StateField:
    """One state of a scene on small quadrilaterals, in SI.

    Attributes:
        points: positions [m], (n, 2).
        quads: points of each quadrilateral counterclockwise, (m, 4).
        data: quantities of ``ABOUT`` at the points, (n,), or (n, 3) for the displacement.
    """

    points: NDArray[np.float64]
    quads: NDArray[np.int64]
    data: dict[str, NDArray[np.float64]]


def write_field(
    scene: Scene, number: int, path: Path | Target, extent: float = 10.0, degree: int | None = None
) -> None:
    """Compute one state of a scene and write it for ParaView; nothing is replaced by a path alone.

    Collective over MPI's world; rank 0 writes. Arguments and failures are those of :func:`state_field`.

    Raises:
        Occupied: something is there that may not be replaced.
        UnwritableArchive: the file system refused.
    """
    state = _state(scene, number, extent, degree)
    sampled, comm = _sampled(state, extent)
    mine = _in_si(state, sampled)
    if comm.rank > 0:
        comm.send(mine, 0)
        return
    from galinx.postprocess.hdf5 import vtkhdf

    # Rank 0 has one piece of another rank at a time.
    others = (comm.recv(source=rank) for rank in range(1, comm.size))
    vtkhdf.write(path, chain([mine], others), ABOUT)


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
    state = _state(scene, number, extent, degree)
    sampled, comm = _sampled(state, extent)
    whole = sampled.gathered(comm)
    return None if whole is None else _in_si(state, whole)


@dataclass(frozen=True)
class _State:
    """One state, and what computes it.

    Attributes:
        plan: finite elements at the scene's speeds.
        task: the state's speed.
        g: σ_XY/σ_YY under the punch.
        degree: polynomial degree.
        exact: is there a closed form to compare with?
    """

    plan: Plan
    task: Task
    g: float
    degree: int
    exact: bool


def _state(scene: Scene, number: int, extent: float, degree: int | None) -> _State:
    states = enumerate_states(scene)
    if not 0 <= number < len(states):
        raise BadInput(
            f"state {number}: no such state; expected 0 to {len(states) - 1}, the scene has {len(states)}"
        )
    # What the scene fixes, or what its rule gives, which is one more for given tractions.
    lowest, highest = min(scene.solve.degree or DEGREES[0], DEGREES[0]), DEGREES[1] + 1
    if degree is not None and not lowest <= degree <= highest:
        raise BadInput(f"degree: found {degree}, expected {lowest} to {highest}")
    c = float(states.columns["c"][number])
    plan = make_plan(_for_finite_elements(scene, c))
    _check(scene, extent)
    task = next(task for task in plan.tasks if task.response.c == c)
    assert plan.fem
    if degree is None:
        # Given tractions are solved one degree above the rule: no measured error corrects it here.
        degree = plan.fem.degrees[task.number] + (scene.solve.mode == "traction")
    exact = "closed_form" in scene.solve.methods
    return _State(plan, task, float(states.g[number]), degree, exact)


def _for_finite_elements(scene: Scene, c: float) -> Scene:
    """The scene with finite elements, at all its speeds that these can do, and at c in any case.

    All speeds share one mesh; with the same speeds and places it is that of a run.
    """
    mechanics = bool(set(scene.output.quantities) - {FRICTION_ALONE})
    possible = tuple(v for v in speeds(scene) if v == c or scene.solid.response(v).margin > 0.0)
    return replace(
        scene,
        motion=replace(scene.motion, c=possible, speed=None),
        solve=replace(scene.solve, methods=("fem",)),
        output=scene.output if mechanics else Output(quantities=(INTENSITIES,)),
    )


def _check(scene: Scene, extent: float) -> None:
    if scene.solid.nearly_incompressible:
        raise BadInput(
            f"solid: found {scene.solid.words()}, expected ν <= 0.49 for stresses inside from finite "
            "elements"
        )
    limit = inner(scene)
    if not 0.0 < extent <= limit:
        raise BadInput(
            f"extent: found {extent:g} a, expected more than 0 and at most {limit:g} a with the "
            f"{scene.solve.mesh} mesh at the tolerance {scene.solve.tolerance:g}"
        )


def _sampled(state: _State, extent: float) -> tuple[Any, Any]:
    """This rank's piece of the state's field over a, N/(2μ) and N/(2a), and the ranks."""
    with finite_elements_installed():
        from galinx.app.run.methods.fem import FiniteElements
        from galinx.solvers.fem.sampling import sample
    task, degree = state.task, state.degree
    # One speed alone is never shared out.
    fem = FiniteElements(_on_one_mesh(state.plan), Progress(), Clock())
    with fem.one_state(task, state.g, degree) as (space, fields, weights):
        return sample(space, task.response, fields, weights, extent, degree), fem.work.comm


def _on_one_mesh(plan: Plan) -> Plan:
    assert plan.fem
    return replace(plan, fem=replace(plan.fem, shared_speeds=False))


def _in_si(state: _State, sampled: Any) -> StateField:
    """Lengths in m, stresses in Pa, for the scene's load per depth."""
    task = state.task
    body, solid = task.body, task.body.solid
    found = task.response.stresses(sampled.gradient)
    XX, YY, XY = body.stress * found
    ZZ = solid.σ_ZZ(XX, YY, XY)
    displacement = body.displacement * sampled.displacement
    data = {
        "displacement": np.column_stack([displacement, np.zeros(len(displacement))]),
        "sigma_XX": XX,
        "sigma_YY": YY,
        "sigma_XY": XY,
        "sigma_ZZ": ZZ,
        "von_mises": von_mises(XX, YY, XY, ZZ),
        "maximum_shear": maximum_shear(XX, YY, XY),
    }
    if state.exact:
        exact: FlatPunch | GivenPressure = FlatPunch(task.response, state.g)
        if body.pressure:
            exact = GivenPressure(task.response, state.g, body.pressure)
        data["sigma_error"] = body.stress * _error(exact, sampled.points, found)
    return StateField(body.profile.half_width * sampled.points, sampled.quads, data)


def _error(exact: FlatPunch | GivenPressure, points: NDArray, found: NDArray) -> NDArray[np.float64]:
    """Largest difference of a component from the closed form over N/(2a); NaN on the surface, (n,)."""
    X, Y = points.T
    inside = -_SURFACE * np.maximum(1.0, np.abs(X)) > Y
    error = np.full(len(points), np.nan)
    error[inside] = np.abs(found[:, inside] - exact.inside(X[inside], Y[inside])).max(axis=0)
    return error
