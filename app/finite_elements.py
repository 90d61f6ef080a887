"""The finite element work of a plan, from mesh to the numbers that are archived."""

import logging
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from time import perf_counter
from typing import Any

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

# FFCx's build tools announce every compilation on the root logger, whose level they set themselves.
logging.disable(logging.INFO)
logging.getLogger("py.warnings").setLevel(logging.ERROR)

from app.plan import Plan  # noqa: E402
from app.scene import Scene  # noqa: E402
from app.states import States, solid_of  # noqa: E402
from meshes.gmsh_model import distribute  # noqa: E402
from meshes.halfplane import MESHES, check_cells  # noqa: E402
from meshes.refine import DEGREES, truncation  # noqa: E402
from meshes.rings import TAGS  # noqa: E402
from postprocess.estimate import extrapolated  # noqa: E402
from postprocess.pressure import (  # noqa: E402
    ContactRecovery,
    JacobiPressure,
    contact_recovery,
    from_moments,
)
from postprocess.stresses import σ_XX_on_surface  # noqa: E402
from solvers.fem import surface  # noqa: E402
from solvers.fem.punch import ContactStates, SlidingPunch  # noqa: E402
from solvers.fem.space import Space  # noqa: E402
from solvers.fem.traction import LoadedHalfPlane  # noqa: E402
from solvers.materials import MovingFrame  # noqa: E402
from solvers.sie.closed_form import FlatPunch  # noqa: E402

#: States treated at once: their surface stresses take some ten megabytes.
CHUNK = 1000

#: Datasets of one entry a speed.
RECORD = ("c", "cells", "unknowns", "degree", "factorisations", "back_substitutions", "largest_residual")


@dataclass(frozen=True)
class Chunk:
    """Datasets of the states ``start`` to ``stop``, by path in the archive."""

    start: int
    stop: int
    data: dict[str, NDArray]


class FiniteElementRun:
    """Walks through the speeds of a plan; collective over MPI's world.

    Attributes:
        record: by name in ``RECORD``, one entry a speed, complete after the walk.
        seconds: wall time by step.
    """

    def __init__(
        self, scene: Scene, plan: Plan, states: States, grid: NDArray, progress: Callable[[str], None]
    ) -> None:
        self.scene, self.plan, self.states, self.grid = scene, plan, states, grid
        self.progress = progress
        self.world = MPI.COMM_WORLD
        self.comm = MPI.COMM_SELF if plan.shared_speeds else self.world
        self.κ = solid_of(scene).κ
        self.record: list[dict[str, float]] = []
        self.seconds = {"mesh": 0.0, "finite elements": 0.0}

    def chunks(self) -> Iterator[Chunk]:
        """Results, in any order of states; on rank 0 only where speeds are shared out."""
        started = perf_counter()
        self.progress(f"mesh: {self.scene.solve.mesh}")
        kind = MESHES[self.scene.solve.mesh]
        cells = kind.build(self.plan.refinement)
        check_cells(cells)
        mesh = distribute(cells, self.comm)
        self._spaces: dict[int, Space] = {}
        self._space_of = lambda p: Space(*mesh, TAGS, kind.plane, p)
        self.seconds["mesh"] = perf_counter() - started
        speeds = list(enumerate(self.plan.speeds))
        if not self.plan.shared_speeds:
            for i, speed in speeds:
                yield from self._at(i, speed.c, speed.degree)
        else:
            yield from self._shared_out(speeds)
        self.record.sort(key=lambda entry: entry["speed"])
        self.seconds["finite elements"] = perf_counter() - started - self.seconds["mesh"]

    def _shared_out(self, speeds: list[tuple[int, Any]]) -> Iterator[Chunk]:
        """Every rank its own speeds; rank 0 takes in what others send between its own chunks."""
        world = self.world
        mine = (
            chunk
            for i, speed in speeds[world.rank :: world.size]
            for chunk in self._at(i, speed.c, speed.degree)
        )
        if world.rank > 0:
            pending = [world.isend(chunk, 0) for chunk in mine]
            MPI.Request.waitall([*pending, world.isend(self.record, 0)])
            return
        working = world.size - 1
        while working or mine is not None:
            if mine is not None:
                chunk = next(mine, None)
                if chunk is None:
                    mine = None
                else:
                    yield chunk
            while working and (mine is None or world.iprobe()):
                message = world.recv()
                if isinstance(message, Chunk):
                    yield message
                else:  # a rank's record is the last it sends
                    self.record += message
                    working -= 1

    def space(self, degree: int) -> Space:
        """The space of a degree; speeds share it, its form and its numbering."""
        if degree not in self._spaces:
            self._spaces[degree] = self._space_of(degree)
        return self._spaces[degree]

    def _at(self, i: int, c: float, degree: int) -> Iterator[Chunk]:
        mine = np.flatnonzero(self.states.c == c)
        start, stop = int(mine[0]), int(mine[-1]) + 1  # the speed is the slowest index
        self.progress(f"finite elements at c = {c:g} ({i + 1} of {len(self.plan.speeds)})")
        speed = (_Contact if self.scene.solve.mode == "contact" else _Traction)(self, c, degree)
        speed.prepare(np.unique(self.states.g[start:stop]))
        for first in range(start, stop, CHUNK):
            last = min(first + CHUNK, stop)
            yield Chunk(first, last, speed.results(self.states.g[first:last]))
        self.record.append({"speed": i, "c": c} | speed.record())
        speed.destroy()


class _Slopes:
    """u,X and v,X of combinations of fields at the surface grid."""

    def __init__(self, space: Space, fields: list, grid: NDArray) -> None:
        s = space.plane.surface_coordinate(grid)
        trace = surface.gather(space, fields)
        self._basis = trace.derivative(s) / space.plane.surface_stretch(s)[:, None, None]
        self._under, self._beside = np.abs(grid) <= 0.9, np.abs(grid) >= 1.1

    def of(self, weights: NDArray) -> tuple[NDArray, NDArray]:
        """For weights (states, fields): u,X at the grid (states, points), and the flatness of v."""
        u_X, v_X = (weights @ self._basis[:, i].T for i in (0, 1))
        largest = [np.abs(v_X[:, part]).max(axis=1) for part in (self._under, self._beside)]
        return u_X, largest[0] / largest[1]


@dataclass(frozen=True)
class _Level:
    """A punch at one degree, and the maps that read its contact forces."""

    punch: SlidingPunch
    recovery: ContactRecovery

    def pressure(self, states: ContactStates, exact: FlatPunch) -> JacobiPressure:
        return from_moments(states.normal @ self.recovery.moments, exact.α, exact.β)


class _Contact:
    """Rigid punch, pressure unknown, at one speed."""

    def __init__(self, run: FiniteElementRun, c: float, degree: int) -> None:
        self.run, self.frame, self.degree = run, MovingFrame(run.κ, c), degree
        self.levels: list[_Level] = []
        self.solves, self.factorisations, self.residual = 0, 0, 0.0

    def prepare(self, g: NDArray) -> None:
        """Raise the degree until the measured error of the outermost states is within tolerance."""
        for degree in range(self.degree - 2, self.degree + 1):
            self._add_level(degree)
        probes = np.unique([g[0], g[-1]])
        tolerance = self.run.scene.solve.tolerance
        while self.degree < DEGREES[1] and self._estimates(probes).max() > tolerance:
            self.degree += 1
            self._add_level(self.degree)
        self.slopes = None
        self.levels[-1].punch.states(g)  # the basis is complete before its traces are taken
        if self.run.plan.surface:
            punch = self.levels[-1].punch
            self.slopes = _Slopes(punch.space, punch.fields, self.run.grid)

    def results(self, g: NDArray) -> dict[str, NDArray]:
        run, level = self.run, self.levels[-1]
        states, local = level.punch.states(g), FlatPunch(self.frame, g)
        pressure = level.pressure(states, local)
        exponents = level.recovery.exponents(states.normal)
        N, μ = run.scene.punch.load, solid_of(run.scene).μ
        data = {
            "states/fem/K_I_left": pressure.K_I[:, 0],
            "states/fem/K_I_right": pressure.K_I[:, 1],
            "states/fem/alpha": exponents[:, 0],
            "states/fem/beta": exponents[:, 1],
            "states/fem/normal_force": states.normal.sum(axis=1) * N / 2.0,
            "states/fem/tangential_force": states.tangential.sum(axis=1) * N / 2.0,
            "states/fem/v0": states.v0 * N / (2.0 * μ),
            "states/fem/estimate": self._estimates(g),
        }
        if self.slopes:
            u_X, flatness = self.slopes.of(states.weights)
            σ_YY = pressure.σ_YY(run.grid)
            data |= {
                "states/fem/slope_under_punch": flatness,
                "surface/fem/sigma_YY": σ_YY,
                "surface/fem/sigma_YY_raw": states.normal @ level.recovery.raw,
                "surface/fem/sigma_XX": σ_XX_on_surface(self.frame.κ, u_X, σ_YY),
            }
        return data

    def record(self) -> dict[str, float]:
        for level in self.levels:
            self._count(level.punch)
        space = self.levels[-1].punch.space
        return {
            "cells": space.cells,
            "unknowns": space.size,
            "degree": space.degree,
            "factorisations": self.factorisations,
            "back_substitutions": self.solves,
            "largest_residual": self.residual,
        }

    def destroy(self) -> None:
        for level in self.levels:
            level.punch.destroy()

    def _add_level(self, degree: int) -> None:
        space = self.run.space(degree)
        punch = SlidingPunch(space, self.frame.κ, self.frame.c)
        recovery = contact_recovery(space.contact.s, degree, space.plane, self.run.grid)
        self.levels.append(_Level(punch, recovery))
        if len(self.levels) > 3:
            old = self.levels.pop(0).punch
            self._count(old)
            old.destroy()

    def _count(self, punch: SlidingPunch) -> None:
        self.factorisations += 1
        self.solves += punch.factor.solves
        self.residual = max(self.residual, punch.factor.largest_residual)

    def _estimates(self, g: NDArray) -> NDArray[np.float64]:
        """Measured relative error of K_I and of the pressure's moments, (states,)."""
        quantities = []
        for level in self.levels:
            states = level.punch.states(g)
            local = FlatPunch(self.frame, g)
            K_I = level.pressure(states, local).K_I
            moments = states.normal @ level.recovery.moments[:, 1:6]
            quantities.append(np.column_stack([K_I * np.pi, moments / 2.0]))
        scene = self.run.scene
        return extrapolated(*quantities) + truncation(scene.solve.mesh, scene.solve.tolerance) * np.abs(g)


class _Traction:
    """σ_YY put in, σ_XY = g σ_YY, at one speed."""

    def __init__(self, run: FiniteElementRun, c: float, degree: int) -> None:
        self.run, self.frame = run, MovingFrame(run.κ, c)
        # One degree above the rule: no measured error corrects it here.
        self.loaded = LoadedHalfPlane(run.space(degree + 1), self.frame.κ, self.frame.c)
        self.given = run.scene.solve.pressure
        self.column: dict[float, int] = {}

    def prepare(self, g: NDArray) -> None:
        """Solve for every load; a pressure of the user's own is one load for every g."""
        for value in g if self.given == "closed_form" else [0.0]:
            self.column[value] = len(self.loaded.fields)
            self.loaded.load(self._load(value))
        self.slopes = None
        if self.run.plan.surface:
            self.slopes = _Slopes(self.loaded.space, self.loaded.fields, self.run.grid)

    def results(self, g: NDArray) -> dict[str, NDArray]:
        run, N = self.run, self.run.scene.punch.load
        columns = np.array([self.column[self._key(value)] for value in g])
        normal = np.array(self.loaded.resultants)[columns // 2] * N / 2.0
        data = {"states/fem/normal_force": normal, "states/fem/tangential_force": g * normal}
        if self.slopes:
            rows = np.arange(len(g))
            weights = np.zeros((len(g), len(self.loaded.fields)))
            weights[rows, columns], weights[rows, columns + 1] = 1.0, g
            u_X, flatness = self.slopes.of(weights)
            inside = np.abs(run.grid) < 1.0
            r = run.grid[inside]
            σ_YY = np.full((len(g), len(run.grid)), np.nan)
            σ_YY[:, inside] = [self._load(self._key(value))(1.0 + r, 1.0 - r) for value in g]
            data |= {
                "states/fem/slope_under_punch": flatness,
                "surface/fem/sigma_YY": σ_YY,
                "surface/fem/sigma_XX": σ_XX_on_surface(self.frame.κ, u_X, σ_YY),
            }
        return data

    def record(self) -> dict[str, float]:
        space, factor = self.loaded.space, self.loaded.factor
        return {
            "cells": space.cells,
            "unknowns": space.size,
            "degree": space.degree,
            "factorisations": 1,
            "back_substitutions": factor.solves,
            "largest_residual": factor.largest_residual,
        }

    def destroy(self) -> None:
        self.loaded.destroy()

    def _key(self, g: float) -> float:
        return g if self.given == "closed_form" else 0.0

    def _load(self, g: float) -> Callable[[NDArray, NDArray], NDArray]:
        if self.given == "closed_form":
            return FlatPunch(self.frame, g).σ_YY_by_distance
        X, σ = np.array(self.given).T
        return lambda left, right: np.interp(np.where(left < right, left - 1.0, 1.0 - right), X, σ)


def datasets(plan: Plan, mode: str, points: int) -> dict[str, tuple[int, ...]]:
    """Shape of a state's entry in every dataset that chunks will hold."""
    names: list[Any] = ["normal_force", "tangential_force"]
    if mode == "contact":
        names += ["K_I_left", "K_I_right", "alpha", "beta", "v0", "estimate"]
    surfaces = []
    if plan.surface:
        names.append("slope_under_punch")
        surfaces = ["sigma_YY", "sigma_XX"] + ["sigma_YY_raw"] * (mode == "contact")
    shapes: dict[str, tuple[int, ...]] = {f"states/fem/{name}": () for name in names}
    return shapes | {f"surface/fem/{name}": (points,) for name in surfaces}
