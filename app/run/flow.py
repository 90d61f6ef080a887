"""Run a scene: plan, solve, judge, archive."""

import json
from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx import __version__
from galinx.app import ranks
from galinx.app.console.progress import Progress
from galinx.app.plan.plan import make_plan
from galinx.app.plan.states import States, enumerate_states
from galinx.app.plan.task import Plan
from galinx.app.plan.words import lines
from galinx.app.run.collector import Collector
from galinx.app.run.judge import Judge
from galinx.app.run.methods import make
from galinx.app.run.over_time import follow
from galinx.app.run.sinks import Nowhere, Sink
from galinx.app.run.slider import slide
from galinx.app.run.solve import Work
from galinx.app.run.told import of_scene
from galinx.app.run.versions import libraries, machine
from galinx.app.scene.scene import Scene
from galinx.clock import Clock
from galinx.postprocess.compare import comparisons
from galinx.postprocess.journal import Journal, Part
from galinx.postprocess.quantities import column, runs, stresses


def compute(
    scene: Scene,
    sink: Sink | None = None,
    progress: Progress | None = None,
    journal: Journal | None = None,
    clock: Clock | None = None,
) -> dict[str, Any]:
    """Compute what a scene asks for, into ``sink``.

    Under MPI this is collective; results reach the sink of rank 0.

    Args:
        scene: what is asked for.
        sink: takes the datasets.
        progress: is told what is being done.
        journal: keeps finished parts; what it already has is not computed again.
        clock: takes wall time by step.

    Returns:
        Root attributes of the archive, verdict among them.

    Raises:
        BadInput: the scene asks for what has no answer.
        SolveError: no speed could be solved.
    """
    if sink is None or not ranks.is_root():
        sink = Nowhere()
    progress, clock = progress or Progress(), Clock() if clock is None else clock
    with clock("friction"):
        progress.say("friction")
        followed = partial(progress.done, what="friction loops")
        plan = make_plan(scene, followed)
        states = plan.friction or enumerate_states(scene, followed)
        _put_states(sink, scene, plan, states)
    if scene.slider:
        with clock("slider"):
            progress.say("slider")
            for path, values in slide(scene, lambda n, of: progress.done(n, of, "sliders")).items():
                sink.put(path, values)
    judge = Judge(scene, plan.rules)
    if plan.starts:
        _put_starts(sink, plan, judge, progress, clock)
    if plan.methods and (plan.fem or ranks.is_root()):
        judge.validity.see({column(name): values for name, values in states.columns.items()})
        collector = Collector(sink, judge, progress, journal, plan, clock)
        for part in _parts(plan, states, collector.earlier(), progress, clock):
            collector.take(part)
        collector.finish()
    _put_work(sink, scene, plan, clock)
    return _attributes(scene, plan, judge)


def _put_states(sink: Sink, scene: Scene, plan: Plan, states: States) -> None:
    sink.put(runs.SCENE.path, scene.text)
    for path, values in states.datasets.items():
        sink.put(path, values)
    for path, positions in plan.positions.items():
        sink.put(path, positions)
    if plan.asks(stresses.BELOW) and scene.output.map:
        sink.put(stresses.MAP.path, np.array([axis.count for axis in reversed(scene.output.map)]))


def _put_starts(sink: Sink, plan: Plan, judge: Judge, progress: Progress, clock: Clock) -> None:
    """Starts from rest."""
    assert plan.starts
    progress.say("starts from rest")
    found = follow(plan.starts, plan.body.solid, clock, lambda n, of: progress.done(n, of, "starts"))
    for path, values in found.items():
        sink.put(path, values)
    if ranks.is_root():
        judge.see(comparisons(found, plan.body.load, plan.rules))


def _parts(
    plan: Plan, states: States, finished: NDArray[np.bool_], progress: Progress, clock: Clock
) -> Iterator[Part]:
    """Results of all tasks, in any order of states; on rank 0 only where speeds are shared out."""
    methods = {name: make(name, plan, progress, clock) for name in plan.methods}
    if ranks.size() > 1 and plan.fem:
        from galinx.app.run.share import same_on_all, shared_out

        finished = same_on_all(finished)
    work = Work(plan, states.g, methods, clock, finished)
    tasks = (task for task in plan.tasks if work.to_do(task))
    if plan.fem and plan.fem.shared_speeds:
        # The fastest are the dearest.
        to_do = sorted(tasks, key=lambda task: -task.response.c)
        if to_do:
            work.begin()
        yield from shared_out(to_do, work.parts)
    else:
        for task in tasks:
            yield from work.parts(task)


def _put_work(sink: Sink, scene: Scene, plan: Plan, clock: Clock) -> None:
    sink.put(runs.DONE.path, lines(scene, plan))
    sink.put(runs.SKIPPED.path, list(plan.skipped))
    clock.lap()
    names = sorted(clock)  # a run that goes on does them in another order
    sink.put(runs.STEPS.path, names)
    sink.put(runs.SECONDS.path, np.array([clock[name] for name in names], dtype=float))


def _attributes(scene: Scene, plan: Plan, judge: Judge) -> dict[str, Any]:
    verdict, reasons = judge.verdict()
    return {
        "version": __version__,
        "versions": json.dumps(libraries()),
        "machine": machine(),
        "scene_sha256": scene.sha256,
        **of_scene(scene),
        "rules": json.dumps(sorted(plan.rules)),
        "verdict": verdict,
        "verdict_reasons": json.dumps(reasons, ensure_ascii=False),
        "comparisons": json.dumps(judge.worst, ensure_ascii=False),
        "warnings": json.dumps([*plan.warnings, *judge.validity.words()], ensure_ascii=False),
    }
