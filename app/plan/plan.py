"""Which work a scene needs, derived from the outputs it asks for."""

from dataclasses import dataclass

import numpy as np

from galinx.app.plan.fem import FemPlan, plan_fem
from galinx.app.plan.limits import check_places, check_speeds, warnings_of
from galinx.app.plan.states import speeds, states_a_speed
from galinx.app.scene.scene import Scene
from galinx.app.scene.sense import oddities
from galinx.meshes import store
from galinx.postprocess.quantities import FRICTION, QUANTITIES, Quantity
from galinx.postprocess.quantities.quantity import INSIDE, LOCAL, POINT
from galinx.solvers.solids.solid import Response
from galinx.solvers.solution import Body, Places

#: Floating-point numbers that the states of a chunk may have at once.
CHUNK_NUMBERS = 1_200_000


@dataclass(frozen=True)
class Task:
    """One speed: what every method is asked.

    Attributes:
        number: of the speed, from 0.
        body: what slides over what.
        response: of the half-plane at that speed.
        places: where stresses are wanted.
        rows: of the states at that speed.
    """

    number: int
    body: Body
    response: Response
    places: Places
    rows: slice


@dataclass(frozen=True)
class Plan:
    """Work of a scene.

    Attributes:
        body: what slides over what.
        places: where stresses are wanted.
        methods: names of those that solve, none where only friction is asked for.
        quantities: read off their solutions, in the order of the table.
        tasks: one a speed.
        fem: finite element work, None without.
        skipped: what is not done, and why.
        warnings: what the user should know before starting.
    """

    body: Body
    places: Places
    methods: tuple[str, ...]
    quantities: tuple[Quantity, ...]
    tasks: tuple[Task, ...]
    fem: FemPlan | None
    skipped: tuple[str, ...]
    warnings: tuple[str, ...]

    @property
    def states(self) -> int:
        """Number of states."""
        return self.tasks[-1].rows.stop

    def asks(self, word: str) -> bool:
        """Is a quantity computed that this word of output.quantities asks for?"""
        return any(quantity.asked_by == word for quantity in self.quantities)

    def shape(self, quantity: Quantity) -> tuple[int, ...]:
        """Shape of a state's entry."""
        sizes = {POINT: len(self.places.X), INSIDE: len(self.places.points)}
        return tuple(sizes[dimension] for dimension in quantity.over[1:])

    @property
    def chunk(self) -> int:
        """States treated at once: what they hold in memory is bounded."""
        numbers = sum(int(np.prod(self.shape(quantity))) for quantity in self.quantities)
        return int(np.clip(CHUNK_NUMBERS // max(numbers, 1), 1, 1000))

    def chunks(self, task: Task) -> list[slice]:
        """A task's rows, so many at a time."""
        rows = range(task.rows.start, task.rows.stop, self.chunk)
        return [slice(first, min(first + self.chunk, task.rows.stop)) for first in rows]


def make_plan(scene: Scene) -> Plan:
    """Plan the work; looks at the scene only, does none of it.

    Raises:
        BadInput: finite elements are asked for where they have no answer.
    """
    methods = _methods(scene)
    all_speeds, count = speeds(scene), states_a_speed(scene)
    body = Body(scene.solid, scene.punch.profile, scene.punch.load)
    places = Places(surface_grid(), np.reshape(scene.output.inside, (-1, 2)))
    warnings = [*oddities(scene), *check_speeds(scene, all_speeds, "fem" in methods)]
    responses = [scene.solid.response(c) for c in all_speeds]
    fem = None
    if "fem" in methods:
        check_places(scene, places)
        fem = plan_fem(scene, responses)
        warnings += warnings_of(fem)
    tasks = tuple(
        Task(i, body, response, places, slice(i * count, (i + 1) * count))
        for i, response in enumerate(responses)
    )
    quantities = _quantities(scene, methods)
    skipped = _skipped(scene, methods, quantities, fem)
    return Plan(body, places, methods, quantities, tasks, fem, tuple(skipped), tuple(warnings))


def own_pressure(scene: Scene) -> bool:
    """Is a pressure of the user's own put in? Then there is no closed form."""
    return scene.solve.mode == "traction" and scene.solve.pressure != "closed_form"


def _contact(scene: Scene) -> bool:
    """Does anything ask for contact mechanics?"""
    return bool(set(scene.output.quantities) - {FRICTION})


def _methods(scene: Scene) -> tuple[str, ...]:
    """Methods that solve the contact, if anything asks for it."""
    if not _contact(scene):
        return ()
    return tuple(
        method for method in dict.fromkeys(scene.solve.methods)
        if not (method == "closed_form" and own_pressure(scene))
    )  # fmt: skip


def _quantities(scene: Scene, methods: tuple[str, ...]) -> tuple[Quantity, ...]:
    """What is read off the solutions."""
    asked: dict[str, Quantity] = {}
    if not methods:
        return ()
    for path, quantity in QUANTITIES.items():
        wanted = (
            quantity.method in (*methods, LOCAL)
            and quantity.mode in ("", scene.solve.mode)
            and quantity.asked_by in ("", *scene.output.quantities)
            and all(need in asked for need in quantity.needs)
        )
        if quantity.solved and wanted:
            asked[path] = quantity
    return tuple(asked.values())


def _skipped(
    scene: Scene, methods: tuple[str, ...], quantities: tuple[Quantity, ...], fem: FemPlan | None
) -> list[str]:
    if not _contact(scene):
        return ["contact mechanics: only friction is asked for"]
    skipped = []
    if "closed_form" not in methods:
        why = "the pressure is given" if own_pressure(scene) else "not in solve.methods"
        skipped.append(f"closed form: {why}")
    if fem is None:
        skipped.append("mesh and finite elements: fem is not in solve.methods")
    elif fem.cuts == 1 and store.is_kept(fem.pattern):
        skipped.append("gmsh: an earlier run made the same mesh")
    computed = {quantity.asked_by for quantity in quantities}
    for word, what in (("surface", "stresses on the surface"), ("interior", "stresses inside")):
        if word not in computed:
            skipped.append(f"{what}: not in output.quantities")
    return skipped


def surface_grid() -> np.ndarray:
    """Positions X/a of archived surface stresses: to ±5, clustered at ±1, without ±1 itself."""
    near = np.geomspace(1e-6, 0.1, 31)
    inside = np.concatenate([1.0 - near, np.linspace(0.0, 0.88, 23)])
    outside = 1.0 + np.concatenate([near, np.geomspace(0.1, 4.0, 25)[1:]])
    right = np.concatenate([inside, outside])
    return np.unique(np.concatenate([-right, right]))
