"""The finite element work of a plan, from mesh to the numbers that are archived."""

import logging
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

# FFCx's build tools announce every compilation on the root logger, whose level they set themselves.
logging.disable(logging.INFO)
logging.getLogger("py.warnings").setLevel(logging.ERROR)

from galinx.app.console.progress import Progress  # noqa: E402
from galinx.app.plan.plan import INSIDE, RECORD, Plan  # noqa: E402
from galinx.app.plan.states import States, pieces, solid_of  # noqa: E402
from galinx.app.run.contact_mode import PunchAtSpeed  # noqa: E402
from galinx.app.run.counter import Counter  # noqa: E402
from galinx.app.run.traction_mode import LoadAtSpeed  # noqa: E402
from galinx.app.scene.scene import Scene  # noqa: E402
from galinx.meshes.halfplane import MESHES, check_cells  # noqa: E402
from galinx.meshes.rings import TAGS  # noqa: E402
from galinx.meshes.store import obtain  # noqa: E402
from galinx.postprocess.compare import Comparison  # noqa: E402
from galinx.postprocess.journal import Part  # noqa: E402
from galinx.solvers.errors import SolveError  # noqa: E402
from galinx.solvers.fem.clock import Clock  # noqa: E402
from galinx.solvers.fem.distributed import distribute  # noqa: E402
from galinx.solvers.fem.space import Space  # noqa: E402

#: What works at one speed, by the scene's mode.
MODES = {"contact": PunchAtSpeed, "traction": LoadAtSpeed}

#: Adds to a part's datasets what does not come from finite elements, and compares.
Complete = Callable[[slice, dict[str, NDArray]], list[Comparison]]

#: Parts that a rank may have computed and rank 0 not yet taken in.
AHEAD = 4


class FiniteElementRun:
    """Walks through the speeds of a plan; collective over MPI's world.

    Args:
        scene, plan, states: what is to be done.
        progress: is told about it.
        complete: called for every part on the rank that computed it.
        finished: first rows of the parts that need not be computed again; looked at on rank 0.

    Attributes:
        clock: wall time by step, of this rank.
    """

    def __init__(
        self,
        scene: Scene,
        plan: Plan,
        states: States,
        progress: Progress,
        complete: Complete,
        finished: frozenset[int] = frozenset(),
    ) -> None:
        self.scene, self.plan, self.states, self.progress = scene, plan, states, progress
        self.complete = complete
        self.world = MPI.COMM_WORLD
        self.comm = MPI.COMM_SELF if plan.shared_speeds else self.world
        self.κ = solid_of(scene).κ
        self.finished = self.world.bcast(finished)
        self._meshes: dict[int, tuple[Any, Any]] = {}
        self._spaces: dict[tuple[int, int], Space] = {}
        self.clock = Clock()

    def parts(self) -> Iterator[Part]:
        """Results, in any order of states; on rank 0 only where speeds are shared out.

        The part that is a speed's last has its record: numbers by name in ``RECORD``, the ``speed``, and
        a ``failure`` where it could not be solved.
        """
        todo = [i for i, speed in enumerate(self.plan.speeds) if self._todo(speed.c)]
        if not todo:
            return
        self.progress.say(f"mesh: {self.scene.solve.mesh}")
        with self.clock("mesh"):
            self._mesh(self.plan.cuts)
        if self.plan.shared_speeds:
            yield from self._shared_out(todo)
        else:
            for i in todo:
                yield from self._at(i)

    def _todo(self, c: float) -> list[slice]:
        return [
            rows for rows in pieces(self.states, self.plan.chunk, c) if rows.start not in self.finished
        ]

    def _shared_out(self, speeds: list[int]) -> Iterator[Part]:
        """Ranks take speeds as they become free; rank 0 works too, and takes in the others' results.

        Nobody is more than ``AHEAD`` parts ahead of rank 0, so memory stays bounded.
        """
        world = self.world
        counter = Counter(world)
        # The fastest are the dearest: begun last, they would leave the other ranks waiting.
        order = sorted(speeds, key=lambda i: -self.plan.speeds[i].c)
        mine = (part for i in counter.until(len(order)) for part in self._at(order[i]))
        if world.rank > 0:
            pending: list[MPI.Request] = []
            for part in mine:
                pending.append(world.issend(part, 0))
                if len(pending) > AHEAD:
                    pending.pop(0).wait()
            MPI.Request.waitall([*pending, world.isend(None, 0)])
        else:
            yield from self._taken_in(mine)
        counter.free()

    def _taken_in(self, mine: Iterator[Part]) -> Iterator[Part]:
        working, busy = self.world.size - 1, True
        while working or busy:
            if busy:
                part = next(mine, None)
                busy = part is not None
                if part:
                    yield part
            while working and (not busy or self.world.iprobe()):
                message = self.world.recv()
                if message is None:  # the last that a rank sends
                    working -= 1
                else:
                    yield message

    def _mesh(self, cuts: int) -> tuple[Any, Any]:
        """The mesh with every cell cut; speeds and degrees share it."""
        if cuts not in self._meshes:
            self._meshes[cuts] = shared_mesh(self.scene, self.plan, cuts, self.comm)
        return self._meshes[cuts]

    def space(self, degree: int, cuts: int = 1) -> Space:
        """The space of a degree on a mesh; speeds share it, its form and its numbering."""
        if (degree, cuts) not in self._spaces:
            chart = MESHES[self.scene.solve.mesh].chart
            space = Space(*self._mesh(cuts), TAGS, chart, degree, self.plan.mixed, self.clock)
            self._spaces[degree, cuts] = space
        return self._spaces[degree, cuts]

    def _at(self, i: int) -> Iterator[Part]:
        c, degree = self.plan.speeds[i].c, self.plan.speeds[i].degree
        self.progress.say(f"finite elements at c = {c:g} ({i + 1} of {len(self.plan.speeds)})")
        speed = None
        try:
            speed = MODES[self.scene.solve.mode](self, c, degree)
            speed.prepare(np.unique(self.states.g[self.states.c == c]))
            *others, last = self._todo(c)
            for rows in others:
                yield self._part(rows, speed.results)
            part = self._part(last, speed.results)
            yield replace(part, record={"speed": i, "c": c} | speed.record())
        except SolveError as error:
            yield from self._failed(i, str(error))
        finally:
            if speed:
                speed.destroy()

    def _part(self, rows: slice, results: Callable[[NDArray], dict[str, NDArray]]) -> Part:
        with self.clock("recovery"):
            data = results(self.states.g[rows])
        with self.clock("closed form and comparison"):
            found = self.complete(rows, data)
        return Part(rows, data, found, None)

    def _failed(self, i: int, why: str) -> Iterator[Part]:
        """Parts of a speed that could not be solved: NaN, and nothing compared."""
        c, shapes = self.plan.speeds[i].c, datasets(self.plan, self.scene.solve.mode)
        for rows in self._todo(c):
            count = rows.stop - rows.start
            data = {name: np.full((count, *shape), np.nan) for name, shape in shapes.items()}
            self.complete(rows, data)
            record = {"speed": i, **dict.fromkeys(RECORD, 0.0), "c": c, "failure": why}
            yield Part(rows, data, [], record)


def shared_mesh(scene: Scene, plan: Plan, cuts: int, comm: MPI.Comm) -> tuple[Any, Any]:
    """The scene's mesh with every cell cut, shared out over ranks, and its facet tags."""
    assert plan.refinement
    kind = MESHES[scene.solve.mesh]
    pattern = kind.build(plan.refinement)
    check_cells(pattern)
    if cuts > 1:  # gmsh's copy of a cut mesh would only be large
        return distribute(kind.build(plan.refinement, cuts, comm.rank, comm.size), comm)
    return distribute(obtain(pattern) if comm.rank == 0 else None, comm)


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
