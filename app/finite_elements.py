"""The finite element work of a plan, from mesh to the numbers that are archived."""

import logging
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

# FFCx's build tools announce every compilation on the root logger, whose level they set themselves.
logging.disable(logging.INFO)
logging.getLogger("py.warnings").setLevel(logging.ERROR)

from app.contact_mode import PunchAtSpeed  # noqa: E402
from app.counter import Counter  # noqa: E402
from app.plan import INSIDE, Plan  # noqa: E402
from app.progress import Progress  # noqa: E402
from app.scene import Scene  # noqa: E402
from app.states import States, pieces, solid_of  # noqa: E402
from app.traction_mode import LoadAtSpeed  # noqa: E402
from meshes.distributed import distribute  # noqa: E402
from meshes.halfplane import MESHES, check_cells  # noqa: E402
from meshes.rings import TAGS  # noqa: E402
from meshes.store import obtain  # noqa: E402
from postprocess.compare import Comparison  # noqa: E402
from solvers.fem.clock import Clock  # noqa: E402
from solvers.fem.space import Space  # noqa: E402

#: What works at one speed, by the scene's mode.
MODES = {"contact": PunchAtSpeed, "traction": LoadAtSpeed}

#: Chunks that a rank may have computed and rank 0 not yet taken in.
AHEAD = 4

#: Datasets of one entry a speed.
RECORD = ("c", "cells", "unknowns", "degree", "factorisations", "back_substitutions", "largest_residual")


#: Rows of the archive, their datasets by path, and what comparing them found.
Chunk = tuple[slice, dict[str, NDArray], list[Comparison]]


class FiniteElementRun:
    """Walks through the speeds of a plan; collective over MPI's world.

    Args:
        scene, plan, states: what is to be done.
        progress: is told about it.
        complete: adds to a chunk's datasets what does not come from finite elements, and compares;
            called on the rank that computed the chunk.

    Attributes:
        record: by name in ``RECORD``, one entry a speed, complete after the walk.
        clock: wall time by step, of this rank.
    """

    def __init__(
        self,
        scene: Scene,
        plan: Plan,
        states: States,
        progress: Progress,
        complete: Callable[[slice, dict[str, NDArray]], list[Comparison]],
    ) -> None:
        self.scene, self.plan, self.states, self.progress = scene, plan, states, progress
        self.complete = complete
        self.world = MPI.COMM_WORLD
        self.comm = MPI.COMM_SELF if plan.shared_speeds else self.world
        self.κ = solid_of(scene).κ
        self.record: list[dict[str, float]] = []
        self.clock = Clock()

    def chunks(self) -> Iterator[Chunk]:
        """Results, in any order of states; on rank 0 only where speeds are shared out."""
        self.progress.say(f"mesh: {self.scene.solve.mesh}")
        with self.clock("mesh"):
            kind = MESHES[self.scene.solve.mesh]
            cells = kind.build(self.plan.refinement)
            check_cells(cells)
            mesh = distribute(obtain(cells) if self.comm.rank == 0 else cells, self.comm)
        self._spaces: dict[int, Space] = {}
        self._space_of = lambda p: Space(*mesh, TAGS, kind.plane, p, self.clock)
        if not self.plan.shared_speeds:
            for i in range(len(self.plan.speeds)):
                yield from self._at(i)
        else:
            yield from self._shared_out()
        self.record.sort(key=lambda entry: entry["speed"])

    def _shared_out(self) -> Iterator[Chunk]:
        """Ranks take speeds as they become free; rank 0 works too, and takes in the others' results.

        Nobody is more than ``AHEAD`` chunks ahead of rank 0, so memory stays bounded.
        """
        world = self.world
        counter = Counter(world)
        # The fastest are the dearest: begun last, they would leave the other ranks waiting.
        order = np.argsort([-speed.c for speed in self.plan.speeds])
        mine = (chunk for i in counter.until(len(order)) for chunk in self._at(int(order[i])))
        if world.rank > 0:
            pending: list[MPI.Request] = []
            for chunk in mine:
                pending.append(world.issend(chunk, 0))
                if len(pending) > AHEAD:
                    pending.pop(0).wait()
            MPI.Request.waitall([*pending, world.isend(self.record, 0)])
        else:
            yield from self._taken_in(mine)
        counter.free()

    def _taken_in(self, mine: Iterator[Chunk]) -> Iterator[Chunk]:
        working, busy = self.world.size - 1, True
        while working or busy:
            if busy:
                chunk = next(mine, None)
                busy = chunk is not None
                if chunk:
                    yield chunk
            while working and (not busy or self.world.iprobe()):
                message = self.world.recv()
                if isinstance(message, tuple):
                    yield message
                else:  # a rank's record is the last it sends
                    self.record += message
                    working -= 1

    def space(self, degree: int) -> Space:
        """The space of a degree; speeds share it, its form and its numbering."""
        if degree not in self._spaces:
            self._spaces[degree] = self._space_of(degree)
        return self._spaces[degree]

    def _at(self, i: int) -> Iterator[Chunk]:
        c, degree = self.plan.speeds[i].c, self.plan.speeds[i].degree
        self.progress.say(f"finite elements at c = {c:g} ({i + 1} of {len(self.plan.speeds)})")
        speed = MODES[self.scene.solve.mode](self, c, degree)
        speed.prepare(np.unique(self.states.g[self.states.c == c]))
        for rows in pieces(self.states, self.plan.chunk, c):
            with self.clock("recovery"):
                data = speed.results(self.states.g[rows])
            with self.clock("closed form and comparison"):
                found = self.complete(rows, data)
            yield rows, data, found
        self.record.append({"speed": i, "c": c} | speed.record())
        speed.destroy()


def datasets(plan: Plan, mode: str) -> dict[str, tuple[int, ...]]:
    """Shape of a state's entry in every dataset that chunks will hold."""
    names: list[Any] = ["normal_force", "tangential_force"]
    if mode == "contact":
        names += ["K_I_left", "K_I_right", "alpha", "beta", "v0", "estimate"]
    if plan.surface:
        names.append("slope_under_punch")
    shapes: dict[str, tuple[int, ...]] = {f"states/fem/{name}": () for name in names}
    if plan.surface:
        surfaces = ["sigma_YY", "sigma_XX"] + ["sigma_YY_raw"] * (mode == "contact")
        shapes |= {f"surface/fem/{name}": (len(plan.grid),) for name in surfaces}
    if plan.interior:
        shapes |= {f"interior/fem/sigma_{ij}": (len(plan.points),) for ij in INSIDE}
    return shapes
