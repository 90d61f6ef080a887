"""A plan and its tasks, speed by speed."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.compare import FINITE, RULES
from galinx.postprocess.quantities import Quantity, layers, stresses
from galinx.postprocess.quantities.quantity import ALONG, INSIDE, INTERFACE, LAYER, POINT
from galinx.solvers.contact.fem_plan import FREE_ON_LAYERS, OWN_MESHES, OWN_MESHES_KEPT, FemPlan
from galinx.solvers.contact.solution import SOLVED, Contact, Places, Task

from .over_time import Starts
from .states import Order, States

#: Most floating-point numbers that the states of a chunk hold at once.
CHUNK_NUMBERS = 1_200_000


@dataclass(frozen=True)
class Tasks:
    """All tasks, each made when it is its turn: there may be a million.

    Attributes:
        body: contact of punch and solid, under the first of the loads.
        places: points where stresses are output.
        order: of the states.
    """

    body: Contact
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
    """Plan of the work of a scene.

    Attributes:
        body: contact of punch and solid, under the first of the loads.
        places: points where stresses are output.
        methods: names of the methods that solve the contact, none for friction alone.
        quantities: evaluated from their solutions, in the order of the table.
        tasks: one a speed.
        tolerance: relative accuracy to reach.
        starts: motions in time, None for none.
        friction: of all states, None where the plan does not depend on it.
        fem: plan of the finite elements, None without.
        skipped: messages about work that is not done, with the reason.
        warnings: messages to the user before the work starts.
    """

    body: Contact
    places: Places
    methods: tuple[str, ...]
    quantities: tuple[Quantity, ...]
    tasks: Tasks
    tolerance: float
    fem: FemPlan | None
    skipped: tuple[str, ...]
    warnings: tuple[str, ...]
    starts: Starts | None = None
    friction: States | None = None

    @property
    def states(self) -> int:
        """Number of states."""
        return len(self.tasks.order)

    @property
    def different(self) -> int:
        """Number of states that are solved: one for all loads where contacts are similar under them."""
        loads = self.tasks.order.loads
        return self.states // len(loads) * len(self.body.dissimilar(loads))

    @property
    def shared(self) -> bool:
        """True where several ranks work on the same solution."""
        return self.fem is not None or self.starts is not None

    def asks(self, word: str, method: str = "") -> bool:
        """True where a quantity of this name in output.quantities is computed, by a method or by any."""
        return any(
            quantity.asked_by == word and method in ("", quantity.method) for quantity in self.quantities
        )

    @property
    def positions(self) -> dict[str, NDArray]:
        """Datasets of the positions of archived stresses, by path."""
        datasets = {}
        if self.asks(stresses.ON_SURFACE):
            datasets[stresses.SURFACE_X.path] = self.places.X
        if self.asks(stresses.BELOW):
            X, Y = self.places.points.T
            datasets |= {stresses.INSIDE_X.path: X, stresses.INSIDE_Y.path: Y}
        if self.asks(layers.AT_INTERFACES):
            unit, depths = self.body.depths
            datasets[layers.DEPTHS[unit].path] = depths
            datasets[layers.ALONG_X.path] = self.places.along
        return datasets

    @property
    def rules(self) -> frozenset[str]:
        """Names of the rules by which computed quantities are compared.

        A prescribed pressure is compared with its own exact solution: it need not carry the load.
        """
        names = {FINITE, *(rule for quantity in self.quantities for rule in quantity.compared)}
        own = SOLVED in self.body.lacks
        in_time = self.starts.rules if self.starts else frozenset()
        return in_time | frozenset(name for name in names if RULES[name].own_pressure or not own)

    def shape(self, quantity: Quantity) -> tuple[int, ...]:
        """Shape of a quantity of one state."""
        sizes = {
            POINT: len(self.places.X), INSIDE: len(self.places.points),
            INTERFACE: len(self.places.interfaces), ALONG: len(self.places.along),
            LAYER: len(self.places.interfaces) + 1,
        }  # fmt: skip
        return tuple(sizes[dimension] for dimension in quantity.over[1:])

    @cached_property
    def chunk(self) -> int:
        """Number of states that are computed at once, which bounds their memory."""
        own_meshes = self.fem is not None and self.fem.mode in (FREE_ON_LAYERS, OWN_MESHES)
        most = OWN_MESHES_KEPT if own_meshes else 1000
        return int(np.clip(CHUNK_NUMBERS // max(self.numbers, 1), 1, most))

    @property
    def numbers(self) -> int:
        """Number of floating-point numbers of a state that methods give or evaluate."""
        around = 3 * len(self.places.around)
        return around + sum(int(np.prod(self.shape(quantity))) for quantity in self.quantities)

    def chunks(self, task: Task) -> list[slice]:
        """Rows of a task's states, at most :attr:`chunk` at a time."""
        return [
            slice(first, min(first + self.chunk, run.stop))
            for run in task.runs
            for first in range(run.start, run.stop, self.chunk)
        ]

    def load(self, rows: slice) -> NDArray[np.float64]:
        """Load of the states of these rows [N/m], (rows,)."""
        return self.tasks.order.load(rows)
