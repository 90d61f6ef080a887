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

from app.contact_mode import PunchAtSpeed  # noqa: E402
from app.plan import Plan  # noqa: E402
from app.scene import Scene  # noqa: E402
from app.states import States, solid_of  # noqa: E402
from app.traction_mode import LoadAtSpeed  # noqa: E402
from meshes.distributed import distribute  # noqa: E402
from meshes.halfplane import MESHES, check_cells  # noqa: E402
from meshes.rings import TAGS  # noqa: E402
from solvers.fem.space import Space  # noqa: E402

#: What works at one speed, by the scene's mode.
MODES = {"contact": PunchAtSpeed, "traction": LoadAtSpeed}

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
        speed = MODES[self.scene.solve.mode](self, c, degree)
        speed.prepare(np.unique(self.states.g[start:stop]))
        for first in range(start, stop, CHUNK):
            last = min(first + CHUNK, stop)
            yield Chunk(first, last, speed.results(self.states.g[first:last]))
        self.record.append({"speed": i, "c": c} | speed.record())
        speed.destroy()


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
