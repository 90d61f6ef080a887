"""Run a scene: plan, compute, judge, archive."""

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from time import perf_counter
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from app import __version__
from app.errors import BadInput, MachineFailure
from app.plan import Plan, has_closed_form, lines, make_plan, surface_grid
from app.scene import Scene
from app.states import States, enumerate_states, solid_of
from postprocess import compare
from solvers.materials import MovingFrame
from solvers.sie.closed_form import FlatPunch

#: A balance of nodal forces further off than this, over N, is a fault whatever the tolerance.
BALANCE_LIMIT = 1e-9

#: In the traction mode v,X under the punch has to vanish; it is a derivative of the displacement and
#: so has about half the digits of the moments that the tolerance speaks of.
SLOPE_FACTOR = 10.0

#: States of the closed form treated at once.
CHUNK = 1000

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


def compute(
    scene: Scene, sink: Sink | None = None, progress: Callable[[str], None] = lambda text: None
) -> dict[str, Any]:
    """Compute what a scene asks for, into ``sink``.

    Under MPI this is collective; results reach the sink of rank 0.

    Returns:
        Root attributes of the archive, verdict among them.

    Raises:
        BadInput: the scene asks for what has no answer.
    """
    sink = Memory() if sink is None else sink
    plan = make_plan(scene)
    states = enumerate_states(scene)
    judge = Judge(scene)
    grid = surface_grid()
    seconds: dict[str, float] = {}
    sink.put("scene/text", scene.text)
    for name in STATE_FIELDS:
        sink.put(f"states/{name}", getattr(states, name))
    exponents = _closed_form_of(scene, states, ("α", "β"))
    sink.put("states/alpha", exponents[0])
    sink.put("states/beta", exponents[1])
    if plan.surface:
        sink.put("surface/X_over_a", grid)
    if plan.closed_form:
        started = perf_counter()
        _closed_form(scene, plan, states, grid, sink)
        seconds["closed form"] = perf_counter() - started
    if plan.fem:
        seconds |= _finite_elements(scene, plan, states, grid, sink, judge, progress)
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


def _punches(scene: Scene, states: States) -> Iterator[tuple[slice, FlatPunch]]:
    """Closed forms of the states, chunk by chunk; a chunk has one speed."""
    κ = solid_of(scene).κ
    for c in dict.fromkeys(states.c.tolist()):
        mine = np.flatnonzero(states.c == c)
        for first in range(mine[0], mine[-1] + 1, CHUNK):
            rows = slice(first, min(first + CHUNK, mine[-1] + 1))
            yield rows, FlatPunch(MovingFrame(κ, c), states.g[rows, None])


def _closed_form_of(scene: Scene, states: States, names: tuple[str, ...]) -> list[NDArray]:
    """Properties of the closed form, one entry a state."""
    parts = [[getattr(punch, name)[:, 0] for name in names] for _, punch in _punches(scene, states)]
    return [np.concatenate(column) for column in zip(*parts)]


def _closed_form(scene: Scene, plan: Plan, states: States, grid: NDArray, sink: Sink) -> None:
    sink.put("states/closed_form/K_I", _closed_form_of(scene, states, ("K_I",))[0])
    if plan.surface:
        for name in ("sigma_YY", "sigma_XX"):
            sink.reserve(f"surface/closed_form/{name}", (len(states), len(grid)))
        for rows, punch in _punches(scene, states):
            for name, values in _surface_of(punch, grid).items():
                sink.write(f"surface/closed_form/{name}", rows, values)


def _surface_of(punch: FlatPunch, grid: NDArray) -> dict[str, NDArray]:
    σ_YY = np.where(np.abs(grid) > 1.0, np.nan, punch.σ_YY(grid))
    return {"sigma_YY": σ_YY, "sigma_XX": punch.σ_XX(grid)}


def _finite_elements(
    scene: Scene,
    plan: Plan,
    states: States,
    grid: NDArray,
    sink: Sink,
    judge: "Judge",
    progress: Callable[[str], None],
) -> dict[str, float]:
    """Write the finite element datasets; returns the wall times."""
    started = perf_counter()
    try:
        from app import finite_elements
    except ImportError as error:
        raise MachineFailure(
            f"finite elements need {error.name}, which is not installed; "
            "run ./run.sh once, it installs what is missing"
        ) from error
    imports = perf_counter() - started
    for name, shape in finite_elements.datasets(plan, scene.solve.mode, len(grid)).items():
        sink.reserve(name, (len(states), *shape))
    true_error = plan.closed_form and scene.solve.mode == "contact"
    if true_error:
        sink.reserve("states/fem/true_error", (len(states),))
    run = finite_elements.FiniteElementRun(scene, plan, states, grid, progress)
    κ = solid_of(scene).κ
    for chunk in run.chunks():
        rows, data = slice(chunk.start, chunk.stop), chunk.data
        punch = FlatPunch(MovingFrame(κ, states.c[chunk.start]), states.g[rows, None])
        known = {"states/g": states.g[rows], "surface/X_over_a": grid}
        known |= {"states/alpha": punch.α[:, 0], "states/beta": punch.β[:, 0]}
        if plan.closed_form:
            known["states/closed_form/K_I"] = punch.K_I[:, 0]
            if plan.surface:
                for name, values in _surface_of(punch, grid).items():
                    known[f"surface/closed_form/{name}"] = values
            if true_error:
                data["states/fem/true_error"] = compare.K_I_error(data | known)
        judge.see(data | known)
        for name, values in data.items():
            sink.write(name, rows, values)
    for name in finite_elements.RECORD:
        sink.put(f"run/fem/{name}", np.array([entry[name] for entry in run.record]))
    return {"import of dolfinx": imports, **run.seconds}


class Judge:
    """Watches chunks of results and says PASS or FAIL; keeps the worst of every comparison.

    Attributes:
        worst: largest value by the comparison's text, dimensionless.
    """

    def __init__(self, scene: Scene) -> None:
        self._load = scene.punch.load
        self.worst: dict[str, float] = {}
        tolerance = scene.solve.tolerance
        self._limits = {compare.BALANCE: BALANCE_LIMIT, compare.K_I: tolerance}
        self._limits[compare.ESTIMATE] = tolerance
        if scene.solve.mode == "traction":
            self._limits[compare.SLOPE] = SLOPE_FACTOR * tolerance
        if not has_closed_form(scene):
            self._limits = {}
        self._judged: dict[str, float] = {}

    def see(self, data: dict[str, Any]) -> None:
        """Take the next chunk into account; NaN is worse than any number."""
        for found in compare.comparisons(data, self._load):
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
