"""Run a scene: plan, compute, judge, archive."""

import json
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx import __version__
from galinx.app import ranks
from galinx.app.console.progress import Progress
from galinx.app.errors import BadInput, finite_elements_installed
from galinx.app.plan.plan import INSIDE, Plan, make_plan
from galinx.app.plan.states import States, enumerate_states, pieces, solid_of
from galinx.app.plan.words import lines
from galinx.app.run.collector import Collector, Nowhere, Sink
from galinx.app.run.judge import Judge
from galinx.app.run.versions import libraries, machine
from galinx.app.scene.scene import Scene
from galinx.postprocess import compare
from galinx.postprocess.journal import Journal, Part
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.solids.isotropic import MovingFrame

#: What tells one state from another, and its friction.
STATE_FIELDS = ("motion", "X_over_L", "c", "mu_c", "sigma0_over_load", "delta", "f", "g")


def compute(
    scene: Scene,
    sink: Sink | None = None,
    progress: Progress | None = None,
    journal: Journal | None = None,
) -> dict[str, Any]:
    """Compute what a scene asks for, into ``sink``.

    Under MPI this is collective; results reach the sink of rank 0.

    Args:
        scene: what is asked for.
        sink: takes the datasets.
        progress: is told what is being done.
        journal: keeps finished parts; what it already has is not computed again.

    Returns:
        Root attributes of the archive, verdict among them.

    Raises:
        BadInput: the scene asks for what has no answer.
        SolveError: no speed could be solved.
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
        if scene.output.map:
            sink.put("interior/map", np.array([axis.count for axis in reversed(scene.output.map)]))
    seconds = {"friction": perf_counter() - started}
    if plan.fem or plan.closed_form:
        solve = _finite_elements if plan.fem else _closed_form_alone
        collector = Collector(sink, judge, progress, journal, len(states))
        seconds |= solve(scene, plan, states, collector)
        collector.finish(plan)
        seconds["archive"] = collector.seconds
    sink.put("run/done", lines(scene, plan))
    sink.put("run/skipped", list(plan.skipped))
    sink.put("run/steps", list(seconds))
    sink.put("run/seconds", np.array(list(seconds.values()), dtype=float))
    verdict, reasons = judge.verdict()
    return {
        "version": __version__,
        "versions": json.dumps(libraries()),
        "machine": machine(),
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
            from galinx.solvers.sie.potentials import stresses  # SciPy's special functions, a slow import

            for ij, values in zip(INSIDE, stresses(punch, *plan.points.T)):
                data[f"interior/closed_form/sigma_{ij}"] = values
    return data


def _closed_form_alone(
    scene: Scene, plan: Plan, states: States, collector: Collector
) -> dict[str, float]:
    """Walk through the states without finite elements; the wall times."""
    started = perf_counter()
    earlier = collector.earlier()
    for rows in pieces(states, plan.chunk):
        if rows.start not in earlier:
            collector.take(Part(rows, closed_form_of(scene, plan, states, rows), [], None))
    return {"closed form": perf_counter() - started - collector.seconds}


def _finite_elements(scene: Scene, plan: Plan, states: States, collector: Collector) -> dict[str, float]:
    """Walk through the speeds, the closed form beside the finite elements; the wall times."""
    started = perf_counter()
    with finite_elements_installed():
        from galinx.app.run import finite_elements
    imports = perf_counter() - started
    for name, shape in finite_elements.datasets(plan, scene.solve.mode).items():
        collector.sink.reserve(name, (len(states), *shape))
    true_error = plan.closed_form and scene.solve.mode == "contact"
    if true_error:
        collector.sink.reserve("states/fem/true_error", (len(states),))

    def complete(rows: slice, data: dict[str, NDArray]) -> list[compare.Comparison]:
        data |= closed_form_of(scene, plan, states, rows)
        if true_error:
            data["states/fem/true_error"] = compare.K_I_error(data)
        positions = {"states/g": states.g[rows], "surface/X_over_a": plan.grid}
        return compare.comparisons(data | positions, scene.punch.load)

    earlier = collector.earlier()
    run = finite_elements.FiniteElementRun(scene, plan, states, collector.progress, complete, earlier)
    for part in run.parts():
        collector.take(part)
    return {"import of dolfinx": imports} | run.clock


def check_output(path: Path, overwrite: bool) -> None:
    """Refuse an output that exists or cannot be written, before any work is done."""
    if path.is_dir():
        raise BadInput(f"{path} is a folder, expected a file name for the archive")
    if path.exists() and not overwrite:
        raise BadInput(f"{path} exists; name another file with -o, or add --overwrite")
    if not path.parent.is_dir():
        raise BadInput(f"the folder {path.parent} does not exist; make it, or choose another with -o")
