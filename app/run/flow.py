"""Run of a scene: plan, solve, judge, archive.

:func:`compute` is the run as a program. Its parts: the attributes of an archive, in SI, that describe the
scene and the versions with which results were computed (:func:`scene_attributes`, :func:`libraries`);
sinks, the destinations of results (:class:`Sink`); the verdict on a run (:class:`Judge`); and motions of
sliders (:func:`slide`).
"""

import json
import platform
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import chain, product
from math import inf
from time import perf_counter
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from galinx import __version__
from galinx.clock import Clock
from galinx.postprocess.compare import RULES, comparisons
from galinx.postprocess.journal import Journal, Part, joined
from galinx.postprocess.over_time import IN_TIME
from galinx.postprocess.quantities import declared, runs
from galinx.postprocess.quantities.runs import CHANGES, FAILURES, RECORD
from galinx.postprocess.quantities.states import RATIO, SPEED
from galinx.postprocess.quantities.validity import CROSSINGS
from galinx.postprocess.validity import THRESHOLDS, Steady, Validity, own_crossings
from galinx.solvers.errors import SolveError
from galinx.solvers.friction.slider import Ride, pull
from galinx.solvers.parameters import values as constants
from galinx.solvers.profiles.punches import is_level
from galinx.solvers.solids import SOLIDS
from galinx.solvers.transient.late_time import approach
from galinx.texts import counted

from .. import ranks
from ..console import Progress
from ..errors import BadInput
from ..methods import METHODS
from ..plan.plan import Plan
from ..plan.states import States
from ..plan.variants import joined_positions, joined_states, lines_of, make_plans
from ..scene.scene import Scene
from .over_time import solve_motions
from .solve import Work


def scene_attributes(scene: Scene) -> dict[str, Any]:
    """Attributes of an archive's root that say what slides over what."""
    half_plane, solid = scene.half_plane, scene.solid
    kind = next((name for name, law in SOLIDS.items() if law is type(half_plane.solid)), "")
    solid_words: dict[str, Any] = {"kind": kind, **constants(half_plane.solid)}
    if half_plane.yield_strength:
        solid_words["yield_strength"] = half_plane.yield_strength
    if scene.layers:
        solid_words |= {f"layer {i}": layer.words() for i, layer in enumerate(scene.layers, 1)}
    if punch := scene.elastic_punch:
        solid_words["punch"] = punch.solid.words() + f", at {punch.speed:g} m/s over the contact"
        if punch.yield_strength:
            solid_words["punch yield_strength"] = punch.yield_strength
    return {
        "title": scene.title,
        "material": half_plane.material or "",
        "solid": json.dumps(solid_words, ensure_ascii=False),
        "half_width": scene.body.half_width,
        "load": scene.punch.load,
        "c_s": solid.c_s,
        "speed_limit": solid.limit() * solid.c_s,
    }


def libraries() -> dict[str, str]:
    """Versions of Python and of the libraries that numbers depend on, as far as they are imported."""
    versions = {"Python": platform.python_version()}
    for name in ("numpy", "scipy", "dolfinx", "petsc4py", "mpi4py", "h5py"):
        version = getattr(sys.modules.get(name), "__version__", None)
        if version:
            versions[name] = str(version)
    return versions


class Sink(Protocol):
    """Destination of results: an archive in the making, or memory.

    Every path has to be in the table of quantities; any other raises KeyError.
    """

    def put(self, name: str, value: Any) -> None:
        """Take a whole dataset."""

    def reserve(self, name: str, shape: tuple[int, ...]) -> None:
        """Make room for a dataset that comes by rows."""

    def write(self, name: str, rows: slice, values: NDArray) -> None:
        """Take rows of a reserved dataset."""


class Memory(dict[str, Any]):
    """A sink that keeps the datasets by path, as an archive would give them back."""

    def put(self, name: str, value: Any) -> None:
        self[declared(name).path] = np.array(value, dtype=object) if isinstance(value, list) else value

    def reserve(self, name: str, shape: tuple[int, ...]) -> None:
        self[declared(name).path] = np.full(shape, np.nan)

    def write(self, name: str, rows: slice, values: NDArray) -> None:
        self[name][rows] = values


#: Most speeds that are named one by one, unsolved or with errors beyond the tolerance.
_FAILURES = 10


class Judge:
    """Verdict on parts of results, PASS or FAIL, with the worst value of every comparison.

    Args:
        scene: sets the tolerance.
        names: names of the rules by which results are compared.

    Attributes:
        worst: largest value by the comparison's text, dimensionless.
        failures: speeds that could not be solved, with the reasons.
        missed: warnings that finite elements do not reach the tolerance.
        validity: collects states for which the theory does not hold.
    """

    def __init__(self, scene: Scene, names: Iterable[str]) -> None:
        self.worst: dict[str, float] = {}
        self.failures: list[str] = []
        self.missed: list[str] = []
        self.validity = Validity(_steady(scene))
        rules = {name: RULES[name] for name in names if RULES[name].mode in scene.modes}
        #: Largest values of a PASS by name, None for rules that are only reported.
        self._limits = {name: rule.allowed(scene.solve.tolerance) for name, rule in rules.items()}
        self._judged: dict[str, float] = {}

    def see(self, comparisons: Mapping[str, float]) -> None:
        """Take comparisons by the rule's name into account; NaN is worse than any number."""
        for name, value in comparisons.items():
            text, limit = RULES[name].text, self._limits.get(name)
            self.worst[text] = float(np.max([self.worst.get(text, 0.0), value]))
            if limit is not None:
                self._judged[text] = limit

    def verdict(self) -> tuple[str, list[str]]:
        """PASS or FAIL, with the figures; ``not judged`` where there is nothing to compare."""
        if not self._judged and not self.failures:
            return "not judged", []
        good = all(self.worst[text] <= limit for text, limit in self._judged.items())
        good = good and not self.failures
        reasons = [f"{text}: {self.worst[text]:.1e}, at most {x:g}" for text, x in self._judged.items()]
        reasons += [f"not solved, {text}" for text in self.failures[:_FAILURES]]
        if len(self.failures) > _FAILURES:
            reasons.append(f"not solved, and {len(self.failures) - _FAILURES} more speeds")
        return "PASS" if good else "FAIL", reasons


def _steady(scene: Scene) -> Steady | None:
    """Time until starts are steady, for flat punches on uniform solids that are not swept; else None.

    It is infinite from the speed of the wave along the surface on.
    """
    solid = scene.solid
    if scene.layers or scene.elastic_punch or scene.variants or not is_level(scene.punch.profile):
        return None

    def within(c: float, g: float) -> float:
        return approach(solid, c, g).within(0.01) if c < solid.limit() else inf

    return Steady(within, scene.body.half_width / solid.c_s)


#: Seconds after which small parts wait no longer for others: the most that a killed run loses.
_PATIENCE = 1.0


def gathered(parts: Iterable[Part], most: int) -> Iterator[Part]:
    """Parts of the same rows, small ones joined: a file a part, and a look at the archive, take time.

    Args:
        parts: in any order of states.
        most: states from which on a part is large enough.
    """
    small: list[Part] = []
    since = perf_counter()
    for part in parts:
        if small and ("failure" in (part.record or {}) or small[-1].rows.stop != part.rows.start):
            yield joined(small)
            small, since = [], perf_counter()
        small.append(part)
        states = part.rows.stop - small[0].rows.start
        if part.record or states >= most or perf_counter() - since > _PATIENCE:
            yield joined(small)
            small, since = [], perf_counter()
    if small:
        yield joined(small)


#: Archived times of a slider, evenly spaced, and at most in its slips; times of its last cycle.
_TIMES, _IN_SLIPS, _STEPS = 4001, 20_000, 1001


def slide(scene: Scene, done: Callable[[float, int], None] = lambda n, of: None) -> dict[str, NDArray]:
    """Motions of a scene's slider under each of its loads and laws: datasets by path.

    Args:
        scene: the scene.
        done: takes the number of motions done, the one under way by its share, and the number of all.

    Raises:
        BadInput: a motion could not be followed.
    """
    slider, motions, rides = scene.slider, list[dict[str, Any]](), list[Ride]()
    assert slider is not None
    of = len(scene.punch.loads) * scene.friction.count
    for n, (load, law) in enumerate(product(scene.punch.loads, scene.friction.laws())):
        try:
            rides.append(pull(slider, law, load, lambda share, n=n: done(n + share, of)))  # type: ignore[misc]
        except ValueError as error:
            raise BadInput(f"slider: {error}") from None
    slips = [ride.slips(slider.duration, max(_IN_SLIPS // of, 1)) for ride in rides]
    times = np.unique(np.concatenate([np.linspace(0.0, slider.duration, _TIMES), *slips]))
    for ride in rides:
        x, v, f = ride.at(times)
        cycle_v, cycle_f = np.full((2, _STEPS), np.nan)
        if np.isfinite(ride.period):
            t = ride.t[ride.cycle]  # dense where the integration took small steps
            steps = np.linspace(0.0, len(t) - 1.0, _STEPS)
            _, cycle_v, cycle_f = ride.at(np.interp(steps, np.arange(len(t)), t))
        motions.append({
            runs.POSITION.path: x, runs.VELOCITY.path: v, runs.FRICTION.path: f,
            runs.CYCLE_VELOCITY.path: cycle_v, runs.CYCLE_FRICTION.path: cycle_f,
            runs.OUTCOME.path: ride.outcome, runs.PERIOD.path: ride.period,
            runs.SLIP.path: ride.slip, runs.PEAK.path: ride.peak, runs.LEAST.path: ride.least,
        })  # fmt: skip
    return {runs.TIMES.path: times} | {
        path: np.array([motion[path] for motion in motions]) for path in motions[0]
    }  # fmt: skip


def compute(
    scene: Scene,
    sink: Sink | None = None,
    progress: Progress | None = None,
    journal: Journal | None = None,
    clock: Clock | None = None,
) -> dict[str, Any]:
    """Compute the results of a scene, into ``sink``.

    Under MPI this is collective; results reach the sink of rank 0.

    Args:
        scene: the scene.
        sink: takes the datasets.
        progress: shows the work under way.
        journal: keeps finished parts; parts it already has are not computed again.
        clock: takes wall time by step.

    Returns:
        Root attributes of the archive, verdict among them.

    Raises:
        BadInput: the scene has a quantity without an answer.
        SolveError: no speed could be solved.
    """
    if sink is None or not ranks.is_root():
        sink = Memory()
    progress, clock = progress or Progress(), Clock() if clock is None else clock

    def put(datasets: Mapping[str, Any]) -> None:
        for path, values in datasets.items():
            sink.put(path, values)

    with clock("friction"):
        progress.say("friction")
        plans = make_plans(scene, partial(progress.done, what="friction loops"))
        plan, states = plans[0], joined_states(plans)
        put({runs.SCENE.path: scene.text} | states.datasets | joined_positions(plans))
    if scene.slider:
        with clock("slider"):
            progress.say("slider")
            put(slide(scene, lambda n, of: progress.done(n, of, "sliders")))
    rules = frozenset[str]().union(*(each.rules for each in plans))
    judge = Judge(scene, rules)
    if plan.starts:
        progress.say("starts from rest")
        motions = solve_motions(plan.starts, clock, partial(progress.done, what="starts"))
        put(motions)
        if ranks.is_root():
            made = comparisons(motions, plan.body.load, rules & IN_TIME)
            judge.see(made)
            rules = (rules - IN_TIME) | made.keys()
    if plan.methods and (plan.fem or ranks.is_root()):
        _solve(sink, judge, progress, journal, plans, states, clock)
    clock.lap()
    names = sorted(clock)  # a run that goes on does them in another order
    put({
        runs.DONE.path: lines_of(plans),
        runs.SKIPPED.path: list(dict.fromkeys(chain(*(each.skipped for each in plans)))),
        runs.STEPS.path: names,
        runs.SECONDS.path: np.array([clock[name] for name in names], dtype=float),
    })  # fmt: skip
    verdict, reasons = judge.verdict()
    planned = dict.fromkeys(chain(*(each.warnings for each in plans)))
    warnings = [*planned, *judge.missed, *judge.validity.words()]
    texts = {
        "versions": libraries(), "rules": sorted(rules), "verdict_reasons": reasons,
        "comparisons": judge.worst, "warnings": warnings,
    }  # fmt: skip
    machine = f"{platform.system()} {platform.machine()}, {counted(ranks.size(), 'rank')}"
    return {
        "version": __version__, "machine": machine, "scene_sha256": scene.sha256, "verdict": verdict,
        **scene_attributes(scene),
        **{name: json.dumps(text, ensure_ascii=False) for name, text in texts.items()},
    }  # fmt: skip


def _solve(
    sink: Sink, judge: Judge, progress: Progress, journal: Journal | None, plans: Sequence[Plan],
    states: States, clock: Clock,
) -> None:  # fmt: skip
    """Solve the contacts of all variants; rank 0 judges and writes their parts. Collective.

    Raises:
        SolveError: no speed could be solved.
    """
    finished, records = np.zeros(len(states), dtype=bool), dict[int, dict[str, Any]]()
    # A ratio that varies along the contact is known with the contact.
    of_validity = SPEED.path, RATIO.path, CROSSINGS.path, *THRESHOLDS
    planned = {path: values for path, values in states.datasets.items() if path in of_validity}

    def take(part: Part) -> None:
        data = part.data | own_crossings(states.crossed[part.rows], part.data)
        judge.see(part.comparisons)
        judge.validity.see({path: values[part.rows] for path, values in planned.items()} | data)
        with clock("archive"):
            for name, values in data.items():
                sink.write(name, part.rows, values)
        if part.record:
            records[part.record["speed"]] = part.record
        finished[part.rows] = True
        progress.done(int(finished.sum()), len(states))

    if ranks.is_root():
        for quantity in plans[0].quantities:
            sink.reserve(quantity.path, (len(states), *plans[0].shape(quantity)))
        if journal and journal.damaged:
            progress.warn(f"kept parts that are damaged: {journal.damaged}; computed again")
        for part in journal.parts() if journal else ():
            take(part)
    before = finished.copy()
    if ranks.size() > 1 and plans[0].fem:  # else this rank is alone here
        from mpi4py import MPI

        before = MPI.COMM_WORLD.bcast(before)
    for part in gathered(_parts(plans, states, before, progress, clock), plans[0].chunk):
        if ranks.is_root():  # all ranks that share one mesh have the same results
            if journal and part.whole and "failure" not in (part.record or {}):
                with clock("archive"):
                    journal.keep(part)
            take(part)
    if ranks.is_root():
        in_order = [records[i] for i in sorted(records)]
        judge.failures = _put_records(sink, plans, in_order)
        judge.missed = [text for record in in_order for text in record.get("missed", ())]
        if len(judge.missed) > _FAILURES:
            judge.missed[_FAILURES:] = [f"and so at {len(judge.missed) - _FAILURES} more speeds"]


def _parts(
    plans: Sequence[Plan], states: States, finished: NDArray[np.bool_], progress: Progress, clock: Clock
) -> Iterator[Part]:
    """Results of all tasks, in any order of states; on rank 0 only where speeds are shared out."""
    for plan in plans:
        if plan.scene.swept:
            progress.say(plan.scene.variant)
        methods = {name: METHODS[name].made(plan, progress, clock) for name in plan.methods}
        work = Work(plan, states.g, states.load, methods, clock, finished)
        tasks = (task for task in plan.tasks if work.batches(task))
        if not plan.fem or not plan.fem.shared_speeds:
            yield from chain.from_iterable(map(work.parts, tasks))
            continue
        if to_do := sorted(tasks, key=lambda task: -task.response.c):  # the fastest are the dearest
            work.begin()
        yield from ranks.shared_out(to_do, work.parts)


def _put_records(sink: Sink, plans: Sequence[Plan], records: Sequence[dict[str, Any]]) -> list[str]:
    """Write the records of the speeds; return those that could not be solved, with the reasons.

    Raises:
        SolveError: no speed could be solved.
    """
    failures = [f"c = {record['c']:g}: {record['failure']}" for record in records if "failure" in record]
    if len(failures) == sum(len(plan.order.speeds) for plan in plans) and not any(
        record["solved"] for record in records
    ):
        raise SolveError(failures[0])
    if plans[0].fem or failures:
        sink.put(FAILURES.path, failures)
    if plans[0].fem:
        for name, quantity in RECORD.items():
            sink.put(quantity.path, np.array([record[name] for record in records], quantity.type))
        changes = [record.get("change_by_degree", []) for record in records]
        if longest := max(map(len, changes)):
            padded = [change + [0.0] * (longest - len(change)) for change in changes]
            sink.put(CHANGES.path, np.array(padded))
    return failures
