"""The whole field of one state, for ParaView: displacement and stresses from finite elements."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from galinx.app.errors import BadInput, finite_elements_installed
from galinx.app.plan.plan import INSIDE, Plan, has_closed_form, make_plan
from galinx.app.plan.states import enumerate_states, solid_of, speeds
from galinx.app.scene.scene import Scene
from galinx.app.scene.sections import Output
from galinx.meshes.halfplane import MESHES
from galinx.meshes.refine import DEGREES, reach
from galinx.meshes.rings import TAGS
from galinx.postprocess.stresses import maximum_shear, stresses_inside, von_mises, σ_ZZ
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.solids.isotropic import MovingFrame

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
    scene: Scene, number: int, path: Path, extent: float = 10.0, degree: int | None = None
) -> None:
    """Compute one state of a scene and write it for ParaView; an earlier file of that name is replaced.

    Collective over MPI's world; rank 0 writes. Arguments and failures are those of :func:`state_field`.

    Raises:
        UnwritableArchive: the file system refused.
    """
    state, sampled, comm = _piece(scene, number, extent, degree)
    mine = _in_si(scene, state, sampled)
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
    state, sampled, comm = _piece(scene, number, extent, degree)
    whole = sampled.gathered(comm)
    return None if whole is None else _in_si(scene, state, whole)


@dataclass(frozen=True)
class _State:
    """Speed over the shear wave speed, and σ_XY/σ_YY under the punch."""

    c: float
    g: float


def _piece(scene: Scene, number: int, extent: float, degree: int | None) -> tuple[_State, Any, Any]:
    """The state, this rank's piece of its field over a, N/(2μ) and N/(2a), and all the ranks."""
    states = enumerate_states(scene)
    if not 0 <= number < len(states):
        raise BadInput(
            f"state {number}: no such state; expected 0 to {len(states) - 1}, the scene has {len(states)}"
        )
    # What the scene fixes, or what its rule gives, which is one more for given tractions.
    lowest, highest = min(scene.solve.degree or DEGREES[0], DEGREES[0]), DEGREES[1] + 1
    if degree is not None and not lowest <= degree <= highest:
        raise BadInput(f"degree: found {degree}, expected {lowest} to {highest}")
    state = _State(float(states.c[number]), float(states.g[number]))
    asked = _for_finite_elements(scene, state.c)
    plan = make_plan(asked)
    _check(asked, plan, extent)
    planned = next(speed.degree for speed in plan.speeds if speed.c == state.c)
    if degree is None:
        # Given tractions are solved one degree above the rule, as in a run.
        degree = planned + (scene.solve.mode == "traction")
    return state, *_sampled(asked, plan, state, extent, degree)


def _for_finite_elements(scene: Scene, c: float) -> Scene:
    """The scene with finite elements, at all its speeds that these can do, and at c in any case.

    All speeds share one mesh; with the same speeds it is that of a run.
    """
    κ = solid_of(scene).κ
    possible = tuple(speed for speed in speeds(scene) if speed == c or MovingFrame(κ, speed).r > 0.0)
    return attrs.evolve(
        scene,
        motion=attrs.evolve(scene.motion, c=possible, speed=None),
        solve=attrs.evolve(scene.solve, methods=("fem",)),
        output=Output(quantities=("sif",)),
    )


def _check(scene: Scene, plan: Plan, extent: float) -> None:
    if plan.mixed:
        raise BadInput(
            f"solid.nu: found ν = {scene.solid.nu:g} in plane strain, expected ν <= 0.49 for stresses "
            "inside from finite elements"
        )
    limit = 0.6 * reach(scene.solve.mesh, scene.solve.tolerance)
    if not 0.0 < extent <= limit:
        raise BadInput(
            f"extent: found {extent:g} a, expected more than 0 and at most {limit:g} a with the "
            f"{scene.solve.mesh} mesh at the tolerance {scene.solve.tolerance:g}"
        )


@dataclass(frozen=True)
class _Work:
    """One solution's ingredients; the part of a run that a load at one speed asks for.

    Attributes:
        space: gives the space, whatever degree is named.
    """

    scene: Scene
    plan: Plan
    κ: float
    space: Callable[[int], Any]


def _sampled(scene: Scene, plan: Plan, state: _State, extent: float, degree: int) -> tuple[Any, Any]:
    with finite_elements_installed():
        from mpi4py import MPI

        from galinx.app.run.finite_elements import (
            shared_mesh,  # first: it silences the form compiler's tools
        )
        from galinx.solvers.fem.sampling import sample
        from galinx.solvers.fem.space import Space
    comm, κ, kind = MPI.COMM_WORLD, solid_of(scene).κ, MESHES[scene.solve.mesh]
    space = Space(*shared_mesh(scene, plan, plan.cuts, comm), TAGS, kind.chart, degree)
    solve = _punch if scene.solve.mode == "contact" else _load
    with solve(_Work(scene, plan, κ, lambda _: space), state) as (fields, weights):
        return sample(space, κ, state.c, fields, weights, extent, degree), comm


@contextmanager
def _punch(work: _Work, state: _State) -> Iterator[tuple[Any, NDArray]]:
    """Fields of the rigid punch, and the state's weights."""
    from galinx.solvers.fem.punch import SlidingPunch

    punch = SlidingPunch(work.space(0), work.κ, state.c, work.plan.solver)
    try:
        weights = punch.states(state.g).weights[0]  # the fields are complete after this
        yield punch.fields, weights
    finally:
        punch.destroy()


@contextmanager
def _load(work: _Work, state: _State) -> Iterator[tuple[Any, NDArray]]:
    """Fields of the given tractions, and the state's weights."""
    from galinx.app.run.traction_mode import LoadAtSpeed

    speed = LoadAtSpeed(work, state.c, 0)
    try:
        speed.prepare(np.array([state.g]))
        yield speed.loaded.fields, np.array([1.0, state.g])
    finally:
        speed.destroy()


def _in_si(scene: Scene, state: _State, sampled: Any) -> StateField:
    """Lengths in m, stresses in Pa, for the scene's load per depth."""
    solid, punch = solid_of(scene), scene.punch
    unit = punch.load / (2.0 * punch.half_width)
    found = stresses_inside(solid.κ, sampled.gradient)
    σ = dict(zip(INSIDE, unit * found))
    out_of_plane = σ_ZZ(solid.ν, solid.plane, σ["XX"], σ["YY"])
    displacement = punch.load / (2.0 * solid.μ) * sampled.displacement
    data = {
        "displacement": np.column_stack([displacement, np.zeros(len(displacement))]),
        **{f"sigma_{ij}": values for ij, values in σ.items()},
        "sigma_ZZ": out_of_plane,
        "von_mises": von_mises(σ["XX"], σ["YY"], σ["XY"], out_of_plane),
        "maximum_shear": maximum_shear(σ["XX"], σ["YY"], σ["XY"]),
    }
    if "closed_form" in scene.solve.methods and has_closed_form(scene):
        exact = FlatPunch(MovingFrame(solid.κ, state.c), state.g)
        data["sigma_error"] = unit * _error(exact, sampled.points, found)
    return StateField(punch.half_width * sampled.points, sampled.quads, data)


def _error(exact: FlatPunch, points: NDArray, found: NDArray) -> NDArray[np.float64]:
    """Largest difference of a component from the closed form over N/(2a); NaN on the surface, (n,)."""
    from galinx.solvers.sie.potentials import stresses  # SciPy's special functions, a slow import

    X, Y = points.T
    inside = -_SURFACE * np.maximum(1.0, np.abs(X)) > Y
    error = np.full(len(points), np.nan)
    error[inside] = np.abs(found[:, inside] - stresses(exact, X[inside], Y[inside])).max(axis=0)
    return error
