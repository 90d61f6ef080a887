"""Whole fields of states, for ParaView: displacement and stresses from finite elements."""

from collections.abc import Iterable, Sequence
from contextlib import closing
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx import __version__
from galinx.app.errors import BadInput, finite_elements_installed
from galinx.app.plan.limits import inner
from galinx.app.results.one_state import OneState, Solved, chosen, solved
from galinx.app.scene.scene import Scene
from galinx.postprocess.stresses import maximum_shear, von_mises
from galinx.postprocess.target import Target
from galinx.solvers.contact import under_punch
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.sie.linear import GivenPressure

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
    from galinx.solvers.fem.sampling import sample

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
