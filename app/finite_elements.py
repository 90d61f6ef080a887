"""The finite element work of a plan, from mesh to the numbers that are archived."""

import logging
from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter
from typing import Any

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

# FFCx's build tools announce every compilation on the root logger, whose level they set themselves.
logging.disable(logging.INFO)
logging.getLogger("py.warnings").setLevel(logging.ERROR)

from app.plan import Plan, SpeedPlan  # noqa: E402
from app.scene import Scene  # noqa: E402
from app.states import States, solid_of  # noqa: E402
from meshes.gmsh_model import distribute  # noqa: E402
from meshes.halfplane import MESHES, check_cells  # noqa: E402
from meshes.rings import TAGS  # noqa: E402
from postprocess.pressure import edge_exponents, from_moments, raw_pressure  # noqa: E402
from postprocess.stresses import σ_XX_on_surface  # noqa: E402
from solvers.fem import surface  # noqa: E402
from solvers.fem.punch import SlidingPunch  # noqa: E402
from solvers.fem.space import Space  # noqa: E402
from solvers.fem.traction import LoadedHalfPlane  # noqa: E402
from solvers.materials import MovingFrame  # noqa: E402
from solvers.sie.closed_form import FlatPunch  # noqa: E402

Progress = Callable[[str], None]


@dataclass(frozen=True)
class Results:
    """One entry a state; NaN where the mode has no such quantity.

    Attributes:
        K_I: at X = -a and X = a, (states, 2).
        exponents: fitted, at X = a and X = -a, (states, 2).
        forces: resultants of σ_YY and σ_XY over N, (states, 2).
        v0: indentation relative to the far boundary over N/(2μ), (states,).
        slope: largest |v,X| for |X| <= 0.9a over the largest for 1.1a <= |X| <= 5a, (states,).
        σ_YY, σ_XX, σ_YY_raw: over N/(2a) at the surface grid, (states, points).
        counts: sizes and operations, for the archive.
        seconds: wall time by step.
    """

    K_I: NDArray[np.float64]
    exponents: NDArray[np.float64]
    forces: NDArray[np.float64]
    v0: NDArray[np.float64]
    slope: NDArray[np.float64]
    σ_YY: NDArray[np.float64]
    σ_XX: NDArray[np.float64]
    σ_YY_raw: NDArray[np.float64]
    counts: dict[str, NDArray]
    seconds: dict[str, float]


def solve(scene: Scene, plan: Plan, states: States, grid: NDArray, progress: Progress) -> Results:
    """Do the finite element part of the plan; collective over MPI's world."""
    comm, kind = MPI.COMM_WORLD, MESHES[scene.solve.mesh]
    shape = (len(states), len(grid))
    results = Results(
        *(np.full((len(states), 2), np.nan) for _ in range(3)),
        *(np.full(len(states), np.nan) for _ in range(2)),
        *(np.full(shape, np.nan) for _ in range(3)),
        counts={name: np.zeros(len(plan.speeds), dtype=int) for name in _COUNTS}
        | {"largest_residual": np.zeros(len(plan.speeds))},
        seconds={"mesh": 0.0, "finite elements": 0.0},
    )
    started = perf_counter()
    progress(f"mesh: {scene.solve.mesh}")
    cells = kind.build(plan.refinement)
    check_cells(cells)
    mesh, facet_tags = distribute(cells, comm)
    results.seconds["mesh"] = perf_counter() - started
    for i, speed in enumerate(plan.speeds):
        progress(f"finite elements: c = {speed.c:g}, degree {speed.degree} ({i + 1}/{len(plan.speeds)})")
        space = Space(mesh, facet_tags, TAGS, kind.plane, speed.degree)
        mine = np.flatnonzero(states.c == speed.c)
        work = _contact if scene.solve.mode == "contact" else _traction
        solver = work(scene, plan, speed, space, states, mine, grid, results)
        for name, value in (
            ("cells", space.cells),
            ("unknowns", space.size),
            ("degree", speed.degree),
            ("factorisations", 1),
            ("back_substitutions", solver.factor.solves),
            ("largest_residual", solver.factor.largest_residual),
        ):
            results.counts[name][i] = value
        solver.destroy()
    results.seconds["finite elements"] = perf_counter() - started - results.seconds["mesh"]
    return results


_COUNTS = ("cells", "unknowns", "degree", "factorisations", "back_substitutions")


def _contact(
    scene: Scene, plan: Plan, speed: SpeedPlan, space: Space, states: States,
    mine: NDArray, grid: NDArray, results: Results,
) -> SlidingPunch:  # fmt: skip
    """Rigid punch, pressure unknown: all states at one speed."""
    frame = MovingFrame(solid_of(scene).κ, speed.c)
    punch = SlidingPunch(space, frame.κ, frame.c)
    plane, s = space.plane, space.contact.s
    X = plane.surface_position(s)
    solved = {g: punch.state(g) for g in np.unique(states.g[mine])}
    slopes = _Slopes(space, punch.fields, grid) if plan.surface else None
    for i in mine:
        state = solved[states.g[i]]
        local = FlatPunch(frame, states.g[i])
        pressure = from_moments(X, state.normal, local.α, local.β)
        raw = raw_pressure(s, state.normal, space.degree)
        results.K_I[i] = pressure.K_I
        results.exponents[i] = edge_exponents(raw, plane)
        results.forces[i] = state.normal.sum() / 2.0, state.tangential.sum() / 2.0
        results.v0[i] = state.v0
        if slopes:
            u_X, v_X = slopes.of(state.weights)
            σ_YY = pressure.σ_YY(grid)
            results.slope[i] = _flatness(grid, v_X)
            results.σ_YY[i] = σ_YY
            results.σ_YY_raw[i] = raw.σ_YY(grid, plane)
            results.σ_XX[i] = σ_XX_on_surface(frame.κ, u_X, σ_YY)
    return punch


def _traction(
    scene: Scene, plan: Plan, speed: SpeedPlan, space: Space, states: States,
    mine: NDArray, grid: NDArray, results: Results,
) -> LoadedHalfPlane:  # fmt: skip
    """σ_YY put in, σ_XY = g σ_YY: all states at one speed."""
    frame = MovingFrame(solid_of(scene).κ, speed.c)
    loaded = LoadedHalfPlane(space, frame.κ, frame.c)
    given = scene.solve.pressure
    first: dict[float, int] = {}
    for i in mine:
        g = states.g[i]
        key = g if given == "closed_form" else 0.0  # a given pressure is one load for every g
        if key not in first:
            first[key] = len(loaded.fields)
            loaded.load(_load(frame, g, given))
        results.forces[i] = _resultants(loaded, first[key], g)
    slopes = _Slopes(space, loaded.fields, grid) if plan.surface else None
    for i in mine if slopes else ():
        g = states.g[i]
        at = first[g if given == "closed_form" else 0.0]
        weights = np.zeros(len(loaded.fields))
        weights[at : at + 2] = 1.0, g
        u_X, v_X = slopes.of(weights)
        inside = np.abs(grid) < 1.0
        σ_YY = np.full_like(grid, np.nan)
        σ_YY[inside] = _load(frame, g, given)(1.0 + grid[inside], 1.0 - grid[inside])
        results.slope[i] = _flatness(grid, v_X)
        results.σ_YY[i] = σ_YY
        results.σ_XX[i] = σ_XX_on_surface(frame.κ, u_X, σ_YY)
    return loaded


def _load(frame: MovingFrame, g: float, given: Any) -> Callable[[NDArray, NDArray], NDArray]:
    if given == "closed_form":
        return FlatPunch(frame, g).σ_YY_by_distance
    X, σ = np.array(given).T
    return lambda left, right: np.interp(np.where(left < right, left - 1.0, 1.0 - right), X, σ)


def _resultants(loaded: LoadedHalfPlane, at: int, g: float) -> tuple[float, float]:
    total = loaded.resultants[at // 2] / 2.0
    return total, g * total


class _Slopes:
    """u,X and v,X of combinations of fields at the surface grid."""

    def __init__(self, space: Space, fields: list, grid: NDArray) -> None:
        s = space.plane.surface_coordinate(grid)
        trace = surface.gather(space, fields)
        self._basis = trace.derivative(s) / space.plane.surface_stretch(s)[:, None, None]

    def of(self, weights: NDArray) -> tuple[NDArray, NDArray]:
        combined = self._basis[..., : len(weights)] @ weights
        return combined[:, 0], combined[:, 1]


def _flatness(grid: NDArray, v_X: NDArray) -> float:
    under, beside = np.abs(grid) <= 0.9, np.abs(grid) >= 1.1
    return float(np.abs(v_X[under]).max() / np.abs(v_X[beside]).max())
