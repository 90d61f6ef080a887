"""Run a scene: plan, compute, judge, archive."""

import json
from pathlib import Path
from time import perf_counter
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from app import __version__, ranks
from app.errors import BadInput, MachineFailure
from app.plan import INSIDE, Plan, has_closed_form, lines, make_plan
from app.progress import Progress
from app.scene import Scene
from app.states import States, enumerate_states, pieces, solid_of
from postprocess import compare
from solvers.materials import MovingFrame
from solvers.sie.closed_form import FlatPunch

#: A balance of nodal forces further off than this, over N, is a fault whatever the tolerance.
BALANCE_LIMIT = 1e-9

#: In the traction mode v,X under the punch has to vanish; it is a derivative of the displacement and
#: so has about half the digits of the moments that the tolerance speaks of.
SLOPE_FACTOR = 10.0

#: What tells one state from another, and its friction.
STATE_FIELDS = ("motion", "X_over_L", "c", "mu_c", "sigma0_over_load", "delta", "f", "g")


class Sink(Protocol):
    """Where results go: an archive in the making, or memory."""

    def put(self, name: str, value: Any) -> None:
        """A whole dataset."""

    def reserve(self, name: str, shape: tuple[int, ...]) -> None:
        """Room for a dataset that comes by rows."""

    def write(self, name: str, rows: slice, values: NDArray) -> None:
        """Rows of a reserved dataset."""


class Memory(dict[str, Any]):
    """A sink that keeps the datasets by path."""

    def put(self, name: str, value: Any) -> None:
        self[name] = value

    def reserve(self, name: str, shape: tuple[int, ...]) -> None:
        self[name] = np.full(shape, np.nan)

    def write(self, name: str, rows: slice, values: NDArray) -> None:
        self[name][rows] = values


class Nowhere:
    """The sink of ranks other than 0."""

    def put(self, name: str, value: Any) -> None:
        pass

    def reserve(self, name: str, shape: tuple[int, ...]) -> None:
        pass

    def write(self, name: str, rows: slice, values: NDArray) -> None:
        pass


def compute(scene: Scene, sink: Sink | None = None, progress: Progress | None = None) -> dict[str, Any]:
    """Compute what a scene asks for, into ``sink``.

    Under MPI this is collective; results reach the sink of rank 0.

    Returns:
        Root attributes of the archive, verdict among them.

    Raises:
        BadInput: the scene asks for what has no answer.
    """
    if sink is None or not ranks.is_root():
        sink = Nowhere()
    progress = progress or Progress()
    started = perf_counter()
    plan = make_plan(scene)
    states = enumerate_states(scene)
    judge = Judge(scene)
    sink.put("scene/text", scene.text)
    for name in STATE_FIELDS:
        sink.put(f"states/{name}", getattr(states, name))
    for name, shape in closed_form_datasets(plan).items():
        sink.reserve(name, (len(states), *shape))
    if plan.surface:
        sink.put("surface/X_over_a", plan.grid)
    if plan.interior:
        for i, name in enumerate(("X_over_a", "Y_over_a")):
            sink.put(f"interior/{name}", plan.points[:, i])
    seconds = {"friction": perf_counter() - started}
    if plan.fem:
        seconds |= _finite_elements(scene, plan, states, sink, judge, progress)
    elif plan.closed_form:
        started = perf_counter()
        for rows in pieces(states, plan.chunk):
            _write(sink, rows, closed_form_of(scene, plan, states, rows))
            progress.done(rows.stop, len(states))
        seconds["closed form"] = perf_counter() - started
    sink.put("run/done", lines(scene, plan))
    sink.put("run/skipped", list(plan.skipped))
    sink.put("run/steps", list(seconds))
    sink.put("run/seconds", np.array(list(seconds.values()), dtype=float))
    verdict, reasons = judge.verdict()
    return {
        "version": __version__,
        "scene_sha256": scene.sha256,
        "title": scene.title,
        "load": scene.punch.load,
        "verdict": verdict,
        "verdict_reasons": json.dumps(reasons, ensure_ascii=False),
        "comparisons": json.dumps(judge.worst, ensure_ascii=False),
        "warnings": json.dumps(plan.warnings, ensure_ascii=False),
    }


def closed_form_datasets(plan: Plan) -> dict[str, tuple[int, ...]]:
    """Shape of a state's entry in every dataset of :func:`closed_form_of`."""
    shapes: dict[str, tuple[int, ...]] = {}
    if plan.closed_form or plan.fem:
        shapes = {"states/alpha": (), "states/beta": ()}
    if plan.closed_form:
        shapes["states/closed_form/K_I"] = ()
        if plan.surface:
            shapes |= {f"surface/closed_form/sigma_{ij}": (len(plan.grid),) for ij in ("YY", "XX")}
        if plan.interior:
            shapes |= {f"interior/closed_form/sigma_{ij}": (len(plan.points),) for ij in INSIDE}
    return shapes


def closed_form_of(scene: Scene, plan: Plan, states: States, rows: slice) -> dict[str, NDArray]:
    """Exponents, and what else of the closed form is asked for, of states at one speed."""
    punch = FlatPunch(MovingFrame(solid_of(scene).κ, states.c[rows.start]), states.g[rows, None])
    data = {"states/alpha": punch.α[:, 0], "states/beta": punch.β[:, 0]}
    if plan.closed_form:
        data["states/closed_form/K_I"] = punch.K_I[:, 0]
        if plan.surface:
            σ_YY = np.where(np.abs(plan.grid) > 1.0, np.nan, punch.σ_YY(plan.grid))
            data["surface/closed_form/sigma_YY"] = σ_YY
            data["surface/closed_form/sigma_XX"] = punch.σ_XX(plan.grid)
        if plan.interior:
            from solvers.sie.field import stresses  # SciPy's special functions, a slow import

            for ij, values in zip(INSIDE, stresses(punch, *plan.points.T)):
                data[f"interior/closed_form/sigma_{ij}"] = values
    return data


def _write(sink: Sink, rows: slice, data: dict[str, NDArray]) -> None:
    for name, values in data.items():
        sink.write(name, rows, values)


def _finite_elements(
    scene: Scene, plan: Plan, states: States, sink: Sink, judge: "Judge", progress: Progress
) -> dict[str, float]:
    """Write the datasets of finite elements and of the closed form beside them; the wall times."""
    started = perf_counter()
    try:
        from app import finite_elements
    except ImportError as error:
        raise MachineFailure(
            f"finite elements need {error.name}, which is not installed; "
            "run ./run.sh once, it installs what is missing"
        ) from error
    seconds = {"import of dolfinx": perf_counter() - started, "archive": 0.0}
    for name, shape in finite_elements.datasets(plan, scene.solve.mode).items():
        sink.reserve(name, (len(states), *shape))
    true_error = plan.closed_form and scene.solve.mode == "contact"
    if true_error:
        sink.reserve("states/fem/true_error", (len(states),))

    def complete(rows: slice, data: dict[str, NDArray]) -> list[compare.Comparison]:
        """Add the closed form to a chunk and compare, on the rank that computed the chunk."""
        data |= closed_form_of(scene, plan, states, rows)
        if true_error:
            data["states/fem/true_error"] = compare.K_I_error(data)
        positions = {"states/g": states.g[rows], "surface/X_over_a": plan.grid}
        return compare.comparisons(data | positions, scene.punch.load)

    run = finite_elements.FiniteElementRun(scene, plan, states, progress, complete)
    finished = 0
    for rows, data, found in run.chunks():
        if not ranks.is_root():
            continue  # all ranks share one mesh and have the same results
        started = perf_counter()
        judge.see(found)
        _write(sink, rows, data)
        finished += rows.stop - rows.start
        progress.done(finished, len(states))
        seconds["archive"] += perf_counter() - started
    for name in finite_elements.RECORD:
        sink.put(f"run/fem/{name}", np.array([entry[name] for entry in run.record]))
    return seconds | run.clock


class Judge:
    """Watches chunks of results and says PASS or FAIL; keeps the worst of every comparison.

    Attributes:
        worst: largest value by the comparison's text, dimensionless.
    """

    def __init__(self, scene: Scene) -> None:
        self.worst: dict[str, float] = {}
        tolerance = scene.solve.tolerance
        self._limits = {compare.BALANCE: BALANCE_LIMIT, compare.K_I: tolerance}
        self._limits[compare.ESTIMATE] = tolerance
        if scene.solve.mode == "traction":
            self._limits[compare.SLOPE] = SLOPE_FACTOR * tolerance
        if not has_closed_form(scene):
            self._limits = {}
        self._judged: dict[str, float] = {}

    def see(self, comparisons: list[compare.Comparison]) -> None:
        """Take a chunk's comparisons into account; NaN is worse than any number."""
        for found in comparisons:
            value = float(np.max([self.worst.get(found.text, 0.0), found.value]))
            self.worst[found.text] = value
            if found.name in self._limits:
                self._judged[found.text] = self._limits[found.name]

    def verdict(self) -> tuple[str, list[str]]:
        """PASS or FAIL, with the figures; ``not judged`` where there is nothing to compare."""
        if not self._judged:
            return "not judged", []
        good = all(self.worst[text] <= limit for text, limit in self._judged.items())
        reasons = [f"{text}: {self.worst[text]:.1e}, at most {x:g}" for text, x in self._judged.items()]
        return "PASS" if good else "FAIL", reasons


def check_output(path: Path, overwrite: bool) -> None:
    """Refuse an output that exists or cannot be written, before any work is done."""
    if path.is_dir():
        raise BadInput(f"{path} is a folder, expected a file name for the archive")
    if path.exists() and not overwrite:
        raise BadInput(f"{path} exists; name another file with -o, or add --overwrite")
    if not path.parent.is_dir():
        raise BadInput(f"the folder {path.parent} does not exist; make it, or choose another with -o")
