"""A plan: what is to be done, speed by speed."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.compare import FINITE, RULES
from galinx.postprocess.quantities import Quantity, layers, stresses
from galinx.postprocess.quantities.quantity import ALONG, INSIDE, INTERFACE, POINT
from galinx.solvers.solids.solid import Response
from galinx.solvers.solution import Body, Places

from .fem import FOLLOWED, OWN_MESHES, FemPlan
from .over_time import Starts
from .states import Order, States

#: Floating-point numbers that the states of a chunk may have at once.
CHUNK_NUMBERS = 1_200_000

#: States whose own meshes are held at once.
OWN_MESHES_KEPT = 32


@dataclass(frozen=True)
class Task:
    """One speed: what every method is asked.

    Attributes:
        number: of the speed, from 0.
        body: what slides over what, under the first of its loads.
        response: of the half-plane at that speed.
        places: where stresses are wanted.
        runs: rows of the states at that speed, those that follow one another together.
        loads: of these states [N/m], each once.
    """

    number: int
    body: Body
    response: Response
    places: Places
    runs: tuple[slice, ...]
    loads: tuple[float, ...]

    def of(self, values: NDArray) -> NDArray:
        """Those of its states, of values of all."""
        return np.concatenate([values[run] for run in self.runs])


@dataclass(frozen=True)
class Tasks:
    """All tasks, each made when it is its turn: there may be a million.

    Attributes:
        body: what slides over what, under the first of its loads.
        places: where stresses are wanted.
        order: of the states.
    """

    body: Body
    places: Places
    order: Order

    def __len__(self) -> int:
        return len(self.order.speeds)

    def __iter__(self) -> Iterator[Task]:
        for i, (c, runs) in enumerate(zip(self.order.speeds, self.order.runs())):
            response = self.body.response(c)
            yield Task(i, self.body, response, self.places, runs, self.order.loads)


@dataclass(frozen=True)
class Plan:
    """Work of a scene.

    Attributes:
        body: what slides over what, under the first of its loads.
        places: where stresses are wanted.
        methods: names of those that solve, none where only friction is asked for.
        quantities: read off their solutions, in the order of the table.
        tasks: one a speed.
        tolerance: wanted relative accuracy.
        strokes: number of strokes along which friction laws are followed.
        integrated: seconds that laws without a formula take for that.
        starts: from rest that are followed in time, None for none.
        friction: of all states, None where nothing has asked for it so far.
        fem: finite element work, None without.
        skipped: what is not done, and why.
        warnings: what the user should know before starting.
    """

    body: Body
    places: Places
    methods: tuple[str, ...]
    quantities: tuple[Quantity, ...]
    tasks: Tasks
    tolerance: float
    strokes: int
    fem: FemPlan | None
    skipped: tuple[str, ...]
    warnings: tuple[str, ...]
    integrated: float = 0.0
    starts: Starts | None = None
    friction: States | None = None

    @property
    def states(self) -> int:
        """Number of states."""
        return len(self.tasks.order)

    @property
    def different(self) -> int:
        """Number of states that differ by more than their load, where contacts of all loads are alike."""
        return self.states // (len(self.tasks.order.loads) if self.body.alike else 1)

    @property
    def shared(self) -> bool:
        """Is there something that several ranks do together?"""
        return self.fem is not None or self.starts is not None

    def asks(self, word: str, method: str = "") -> bool:
        """Is a quantity computed, by a method or by any, that this word of output.quantities asks for?"""
        return any(
            quantity.asked_by == word and method in ("", quantity.method) for quantity in self.quantities
        )

    @property
    def positions(self) -> dict[str, NDArray]:
        """Datasets of where stresses are archived, by path."""
        found = {}
        if self.asks(stresses.ON_SURFACE):
            found[stresses.SURFACE_X.path] = self.places.X
        if self.asks(stresses.BELOW):
            X, Y = self.places.points.T
            found |= {stresses.INSIDE_X.path: X, stresses.INSIDE_Y.path: Y}
        if self.asks(layers.AT_INTERFACES):
            if self.body.found:
                found[layers.INTERFACE_DEPTH_IN_M.path] = self.body.solid.depths  # type: ignore[attr-defined]
            else:
                found[layers.INTERFACE_DEPTH.path] = self.places.interfaces
            found[layers.ALONG_X.path] = self.places.along
        return found

    @property
    def rules(self) -> frozenset[str]:
        """Names of the rules by which what is computed is compared.

        A pressure of the user's own is held against its own exact solution: it need not carry the load.
        """
        names = {FINITE, *(rule for quantity in self.quantities for rule in quantity.compared)}
        own = self.body.pressure is not None
        in_time = self.starts.rules if self.starts else frozenset()
        return in_time | frozenset(name for name in names if RULES[name].own_pressure or not own)

    def shape(self, quantity: Quantity) -> tuple[int, ...]:
        """Shape of a state's entry."""
        sizes = {
            POINT: len(self.places.X), INSIDE: len(self.places.points),
            INTERFACE: len(self.places.interfaces), ALONG: len(self.places.along),
        }  # fmt: skip
        return tuple(sizes[dimension] for dimension in quantity.over[1:])

    @cached_property
    def chunk(self) -> int:
        """States treated at once: what they hold in memory is bounded."""
        own_meshes = self.fem is not None and self.fem.mode in (FOLLOWED, OWN_MESHES)
        most = OWN_MESHES_KEPT if own_meshes else 1000
        return int(np.clip(CHUNK_NUMBERS // max(self.numbers, 1), 1, most))

    @property
    def numbers(self) -> int:
        """Numbers of a state that methods give, or look at."""
        looked_at = 3 * len(self.places.around)
        return looked_at + sum(int(np.prod(self.shape(quantity))) for quantity in self.quantities)

    @property
    def numbers_inside(self) -> int:
        """Those of them at points inside."""
        inside = (quantity for quantity in self.quantities if INSIDE in quantity.over)
        return sum(int(np.prod(self.shape(quantity))) for quantity in inside)

    def chunks(self, task: Task) -> list[slice]:
        """A task's rows, so many at a time."""
        return [
            slice(first, min(first + self.chunk, run.stop))
            for run in task.runs
            for first in range(run.start, run.stop, self.chunk)
        ]

    def load(self, rows: slice) -> NDArray[np.float64]:
        """Load of some states [N/m]."""
        return self.tasks.order.load(rows)
