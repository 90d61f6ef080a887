"""Checks of an archive that fits the schema, against its own scene and against numbers computed again.

Computed again is whatever is cheap, by whichever method the archived numbers were computed: closed forms
and the local analysis of all states, or of some spread over many; integral equations of layers at the
slowest and the fastest speed; indentations and contacts of finite elements against these; sizes of linear
systems; warnings. Not computed again are stresses inside and on the surface by finite elements, which are
held against the archived comparisons, their estimates, and motions in time.
"""

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx import __version__
from galinx.clock import Clock
from galinx.postprocess import compare
from galinx.postprocess.hdf5 import archive as reader
from galinx.postprocess.hdf5.archive import Archive
from galinx.postprocess.over_time import IN_TIME
from galinx.postprocess.quantities import (
    QUANTITIES,
    Quantity,
    runs,
    states,
    stresses,
    table,
    validity,
    yielding,
)
from galinx.postprocess.quantities.quantity import (
    ALONE,
    CLOSED_FORM,
    FEM,
    LOCAL,
    NEVER,
    SIE,
    STATE,
    TEXT,
)
from galinx.postprocess.schema import VERSION
from galinx.postprocess.validity import own_crossings
from galinx.solvers.contact import FREE_ENDS, YIELD
from galinx.solvers.contact.fem_plan import SHARP_ON_LAYERS, on_finer_cells, unknowns
from galinx.solvers.contact.solution import FLAT
from galinx.solvers.profiles import kinks

from ..console import Progress
from ..methods import METHODS
from ..plan.plan import Plan
from ..plan.variants import joined_positions, joined_states, make_plans
from ..run.flow import Judge, scene_attributes
from ..run.solve import Work
from ..scene import read as scenes
from ..scene.scene import Scene

#: States of a method that are computed again; under smooth punches without layers; all of them under flat
#: punches up to so many, and so many numbers of these.
_FEW, _SMOOTH, _FLAT, _NUMBERS = 6, 24, 2000, 1_000_000
#: Relative difference of closed forms, absolute one of places over a, and tolerances that equations are
#: apart which were solved with other frictions beside them.
_SAME_AGAIN, _PLACE, _TOLERANCES = 1e-6, 1e-3, 10.0
#: Relative difference of estimated errors, and absolute one by rounding.
_OF_ESTIMATES, _ROUNDED = 0.05, 1e-11
#: Relative difference of finite elements and closed forms; comparisons say more.
_FROM_EXACT = 1e-2
#: Modes in which all speeds have one mesh.
_ONE_MESH = ("contact", "traction", SHARP_ON_LAYERS, FREE_ENDS)


def _of_variant(archive: Archive, plan: Plan) -> Iterator[str]:
    """Differences between numbers of a variant and numbers computed again, one sentence each.

    States and their rows are numbered as in the archive of all variants.
    """
    if runs.RECORD["c"].path in archive.data and not len(archive.data[runs.FAILURES.path]):
        yield from _of_record(archive.data, plan)
    few = _spread(plan, _FEW)
    more = few if len(kinks(plan.body.profile)) else _spread(plan, _SMOOTH)
    for method in (CLOSED_FORM, SIE):
        by = (method, LOCAL) if method == CLOSED_FORM else (method,)
        # Residuals may be rounding alone; comparisons have them.
        rows = [row for row in plan.quantities if row.of and row.method in by and row.mode != ALONE]
        slow = [row for row in rows if row.asked_by == YIELD]
        quick = [row for row in rows if row not in slow]
        many = max(_NUMBERS // max(sum(int(np.prod(plan.shape(row))) for row in quick), 1), _FEW)
        again = few if method == SIE else more
        if method == CLOSED_FORM and FLAT not in plan.body.lacks:
            again = _spread(plan, min(_FLAT, many))
        for rows, selected in ((quick, again), (slow, few)):
            methods = (method,) * (method in plan.methods)
            for numbers, computed in _computed(archive, plan, methods, selected, rows) if rows else ():
                yield from _different(archive, plan, numbers, computed)
    if plan.fem and not plan.scene.layers:
        yield from _of_derived(archive, plan, more)
        yield from _of_finite_elements(archive, plan, more)


#: Words of earlier archives, and those that stand for them now.
_FORMER = {
    "of contacts whose ends are found": "of contacts with free ends",
    "over itself or": "relative to itself or",
    "over themselves or": "relative to themselves or",
    "in which yield is looked for": "from which yield is computed",
    "the steady state that is told is a limit which": "the reported steady state is a limit that",
    "the steady state is told, but": "the steady state is reported, but",
}


def _texts(archive: Archive, name: str) -> Any:
    """Attribute of an archive of any age that holds texts, in the words of now."""
    text = archive.attributes[name]
    for former, today in _FORMER.items():
        text = text.replace(former, today)
    return json.loads(text)


def _without_numbers(text: str) -> str:
    return re.sub(r"[-−]?\d[\d.]*(e[-+]?\d+)?|states?\b", "", text)


def _of_record(data: Mapping[str, Any], plan: Plan) -> Iterator[str]:
    """Speeds, cells and unknowns of finite elements that differ from those of the scene."""
    fem, c = plan.fem, plan.order.speeds
    own = slice(plan.speed, plan.speed + len(c))
    assert fem
    record = {name: data[row.path][own] for name, row in runs.RECORD.items()}
    if not np.allclose(record["c"], c, rtol=1e-12, atol=0.0):
        yield f"{runs.RECORD['c'].path} holds other speeds than its scene has"
    if fem.mode in _ONE_MESH:
        # Where no degree reaches the tolerance cells are finer.
        patterns = [each.pattern for each in (fem, on_finer_cells(fem))]
        by_cells = {len(pattern.cells) * fem.cuts**2: pattern for pattern in patterns}
        cells, degrees = (record[name].tolist() for name in ("cells", "degree"))
        if not by_cells.keys() >= {*cells}:
            yield (
                f"{runs.RECORD['cells'].path}: found {cells[0]}, its scene's mesh has "
                f"{' or '.join(map(str, by_cells))}"
            )
            return
        sizes = [unknowns(by_cells[n], fem.cuts * degree) for n, degree in zip(cells, degrees)]
        if record["unknowns"].tolist() != sizes:
            yield (
                f"{runs.RECORD['unknowns'].path}: found {record['unknowns'].tolist()}, meshes of the "
                f"degrees in {runs.RECORD['degree'].path} have {sizes}"
            )


def _spread(plan: Plan, most: int) -> NDArray[np.int64]:
    """Numbers of at most so many states of a variant, the first and the last among them."""
    first, last = plan.rows.start, plan.rows.stop - 1
    return np.unique(np.linspace(first, last, min(plan.states, most)).round().astype(int))


def _computed(
    archive: Archive, plan: Plan, methods: Sequence[str], selected: NDArray[np.int64],
    quantities: Sequence[Quantity],
) -> Iterator[tuple[NDArray[np.int64], dict[str, NDArray]]]:  # fmt: skip
    """Numbers and quantities of some states, speed by speed; nothing where a speed has no solution."""
    data = archive.data
    failed = [text.partition(":")[0] for text in data.get(runs.FAILURES.path, ())]
    alone = replace(plan, quantities=tuple(quantities), methods=tuple(methods), fem=None)
    made = {name: METHODS[name].made(alone, Progress(), Clock()) for name in methods}
    g, load = data[states.RATIO.path], data.get(states.LOAD.path)
    work = Work(alone, g, load, made, Clock(), np.zeros(len(g), dtype=bool))
    for task in plan.tasks:
        rows = np.concatenate(
            [selected[(run.start <= selected) & (selected < run.stop)] for run in task.runs]
        )
        if len(rows) and f"c = {task.response.c:g}" not in failed:
            yield rows, work.of_states(task, rows)


def _different(
    archive: Archive, plan: Plan, rows: NDArray[np.int64], computed: Mapping[str, NDArray]
) -> Iterator[str]:
    """Differences between archived and computed values, one sentence each."""
    for path, held in archive.rows(rows, computed).items():
        values = computed[path]
        with np.errstate(invalid="ignore"):
            finite = np.where(np.isfinite(values), np.abs(values), 0.0)
            axes = tuple(range(1, values.ndim))
            size = np.maximum(finite, 0.0 if values.ndim == 1 else finite.max(axis=axes, keepdims=True))
            allowed = _TOLERANCES * plan.tolerance if path.split("/")[1] == SIE else _SAME_AGAIN
            # The place of a largest value may lie anywhere where the values are flat.
            is_place = path.endswith(("_position", "_over_a", "_X", "_Y"))
            slack = _PLACE * is_place
            if path.endswith("/centre"):  # rounding of the half-width without friction
                size = np.maximum(size, computed[path.replace("centre", "half_width")])
            if path.rpartition("/")[2].startswith("estimate"):
                # Of changes that may be rounding, and of interpolation between many frictions.
                many = len(np.unique(archive.data[states.RATIO.path])) > len(rows)
                allowed, slack = _OF_ESTIMATES, _ROUNDED + plan.tolerance / 10.0 * many
            near = np.abs(held - values) <= allowed * size + slack
        same = near | (held == values) | (np.isnan(held) & np.isnan(values))
        if not same.all():
            i = int(np.flatnonzero(~same.reshape(len(rows), -1).all(axis=1))[0])
            yield f"{path} is not what is computed of state {rows[i]}"


def _of_finite_elements(archive: Archive, plan: Plan, selected: NDArray[np.int64]) -> Iterator[str]:
    """Comparisons of finite elements with the closed form that fail, even if the scene asks for none."""
    scene, body, refusal = plan.scene, plan.body, METHODS[CLOSED_FORM].refusal
    if archive.attributes["verdict"] == "FAIL" or refusal(scene, body, None):
        return
    if body.solid.limit() <= max(plan.order.speeds):
        return
    assert plan.fem
    loads = [row.path for row in yielding.FIRST_LOAD.values()]
    if {*loads} <= {*archive.names}:
        first, other = (archive.data[path][plan.rows] for path in loads)
        if not np.allclose(first, other, rtol=_FROM_EXACT, atol=0.0, equal_nan=True):
            yield f"{' and '.join(loads)} are not near each other"
    # Next to kinks numbers are infinite, or nearly so; and of yield a few states were looked at.
    exact = [
        row for row in QUANTITIES.values()
        if row.of and row.method == CLOSED_FORM and row.mode in scene.modes and row.asked_by != YIELD
        and (not len(kinks(body.profile)) or row.over == (STATE,)) and not refusal(scene, body, row)
    ]  # fmt: skip
    rules = {name: rule for name, rule in compare.RULES.items() if {*rule.needs} & {*exact}}
    needed = {row.path: row for rule in rules.values() for row in rule.needs}
    archived = [path for path in needed if path in archive.names and needed[path].method != CLOSED_FORM]
    v0 = states.INDENTATION
    if v0.path in archive.names and plan.fem.terms:
        exact.append(replace(v0, method=CLOSED_FORM))
    for rows, computed in _computed(archive, plan, (CLOSED_FORM,), selected, exact):
        if v0.path in computed:
            held, own = archive.data[v0.path][rows], computed.pop(v0.path)
            # At a tip the rule that integrates the pressure has few digits.
            for i in np.flatnonzero(np.abs(held - own) > 1e-3 * np.abs(own))[:1]:
                yield (
                    f"{v0.path}: found {held[i]:g} m in state {rows[i]}, the pressure of the closed form "
                    f"gives {own[i]:g} m"
                )
        computed |= archive.rows(rows, archived)
        load = np.array(plan.order.loads)[plan.order.numbers[1, rows - plan.rows.start]]
        for name, figure in compare.comparisons(computed, load, rules).items():
            allowed = compare.RULES[name].allowed(plan.tolerance)
            if allowed is not None and not figure <= max(_FROM_EXACT, _TOLERANCES * allowed):
                yield f"{rules[name].text}: {figure:.1e} in states {rows[0]} ..."


def _of_derived(archive: Archive, plan: Plan, selected: NDArray[np.int64]) -> Iterator[str]:
    """Stresses inside and tensions under the punch that do not follow from archived components."""
    body, given = plan.body, SimpleNamespace()  # a solution that has components alone
    for components, derived in (
        (stresses.STRESSES_INSIDE[FEM], stresses.INVARIANTS_INSIDE[FEM]),
        ((stresses.PRESSURE[FEM],), (validity.TENSION[FEM], validity.TENSION_X[FEM])),
    ):
        paths = [row.path for row in (*components, *derived)]
        if not {*paths} <= {*archive.names}:
            continue
        held = archive.rows(selected, paths)
        σ = np.array([held[row.path] for row in components])
        if len(σ) > 1:
            given.inside, given.σ_ZZ = σ, body.σ_ZZ(σ, archive.data[stresses.INSIDE_Y.path])
        else:
            under = plan.places.under
            given.pressed = plan.places.X[under], σ[0][:, under]
        for row in derived:
            assert row.of
            if not np.allclose(
                held[row.path], row.of(given, body), rtol=1e-9, atol=1e-12, equal_nan=True
            ):
                yield f"{row.path} is not what the components give"


#: States checked together; relative difference within which numbers computed again agree on any machine.
_ROWS, _SAME = 1000, 1e-9


def faults(path: Path) -> list[str]:
    """Faults of an archive, one sentence each; every byte of it is read.

    Raises:
        UnreadableArchive: no archive, a damaged one, or one that does not fit the schema.
        BadInput: its scene has a fault.
    """
    with reader.opened(path) as archive:
        scene = scenes.parse(archive.data[runs.SCENE.path], "the scene of the archive")
        plans = make_plans(scene)
        texts = [*_of_states(archive, plans)]
        if archive.attributes["version"] == __version__:  # other versions plan and tell otherwise
            texts += _of_plan(archive, scene, plans)
            fits = not texts
            if fits and plans[0].methods:
                judge = Judge(scene, ())
                judge.validity.see(archive.data)
                # Numbers in them follow the order in which states were solved.
                archived = {*map(_without_numbers, _texts(archive, "warnings"))}
                given = [
                    text for text in judge.validity.words() if _without_numbers(text) not in archived
                ]
                texts += [f'warnings does not have "{text}"' for text in given]
            for plan in plans if fits else ():
                name = f"with {plan.scene.variant}: " if len(plans) > 1 else ""
                texts += [name + text for text in _of_variant(archive, plan)]
        return [*texts, *_of_numbers(archive), *_of_verdict(archive, scene)]


def _of_states(archive: Archive, plans: Sequence[Plan]) -> Iterator[str]:
    """States and friction that differ from those of the scene, whose friction is followed once more."""
    data, older = archive.data, archive.attributes["schema_version"] < VERSION
    expected = joined_states(plans)
    count, held = len(expected), len(data[states.SPEED.path])
    if count != held:
        yield f"it holds {held} states, its scene has {count}"
        return
    own = own_crossings(expected.crossed, data)
    for name, values in (expected.datasets | own).items():
        if name not in data:
            if not older:  # whose layout has fewer
                yield f"{name} is missing, its scene has it"
        elif not _same(data[name], values):
            if name not in own:
                yield f"{name} holds something else than its scene gives"
            elif archive.attributes["version"] == __version__:  # earlier ones took the width at rest
                yield f"{name} is not what its half-widths give"


def _same(archived: Any, expected: Any) -> bool:
    if np.shape(archived) != np.shape(expected):
        return False
    if np.asarray(expected).dtype.kind != "f":
        return bool(np.all(archived == expected))
    size = np.nanmax(np.abs(expected), initial=0.0)
    return np.allclose(archived, expected, rtol=_SAME, atol=_SAME * size, equal_nan=True)


def _of_plan(archive: Archive, scene: Scene, plans: Sequence[Plan]) -> Iterator[str]:
    """Attributes, positions and names of datasets that differ from those of the scene."""
    plan = plans[0]
    attributes, data = archive.attributes, archive.data
    for name, value in scene_attributes(scene).items():
        if name in attributes and not _same(attributes[name], value):  # older layouts have fewer
            archived = np.asarray(attributes[name]).item()  # as Python writes it
            yield f"{name} says {archived!r}, its scene gives {value!r}"
    rules = frozenset[str]().union(*(each.rules for each in plans))
    rules = (rules - IN_TIME) | compare.comparisons(data, attributes["load"], rules & IN_TIME).keys()
    if not rules <= {*json.loads(attributes["rules"])}:
        yield f"rules says {attributes['rules']!r}, its scene gives {json.dumps(sorted(rules))!r}"
    for name, positions in joined_positions(plans).items():
        if not _same(data.get(name), positions):
            yield f"{name} holds other positions than its scene gives"
    rows, planned = table(), {quantity.path for quantity in plan.quantities}
    held = {name for name in archive.names if rows[name].solved}
    yield from (f"{name} is missing, its scene asks for it" for name in sorted(planned - held))
    yield from (f"{name} is not what its scene asks for" for name in sorted(held - planned))


def _of_numbers(archive: Archive) -> Iterator[str]:
    """Numbers that are not finite, not in balance, or not as the archived comparisons say."""
    rules = json.loads(archive.attributes["rules"])
    failures = archive.data.get(runs.FAILURES.path, ())
    worst: dict[str, float] = {}
    balance = compare.BALANCE.limit
    assert balance is not None
    for name, values in archive.data.items():
        row = table()[name]
        if row.type != TEXT and np.extract(~np.isnan(values), values) not in row.range:
            yield f"{name} has numbers out of its range, {row.range}"
    for start in range(0, len(archive.data[states.SPEED.path]), _ROWS):
        rows = _solved(archive.rows(slice(start, start + _ROWS)), failures)
        if not len(rows[states.SPEED.path]):
            continue
        yield from (f"{name} is not finite in states {start} ..." for name in compare.not_finite(rows))
        for name, row in table().items():
            if row.of_data is None or any(path not in rows for path in (name, *row.needs)):
                continue
            if not np.allclose(rows[name], row.of_data(rows), rtol=_SAME, atol=1e-15, equal_nan=True):
                yield f"{name} is not what {', '.join(row.needs)} give in states {start} ..."
        load = rows.get(states.LOAD.path, archive.attributes["load"])
        for name, value in compare.comparisons(rows, load, rules).items():
            rule = compare.RULES[name]
            worst[rule.text] = float(np.max([worst.get(rule.text, 0.0), value]))
            if rule is compare.BALANCE and not value <= balance:  # a fault whatever the verdict
                yield f"{rule.text} in states {start} ...: {value:.1e}, at most {balance:g}"
    in_time = compare.comparisons(archive.data, archive.attributes["load"], IN_TIME & {*rules})
    worst |= {compare.RULES[name].text: value for name, value in in_time.items()}
    archived = _texts(archive, "comparisons")
    if archived.keys() != worst.keys() or any(
        not np.isclose(worst[text], archived[text], rtol=_SAME, atol=0.0, equal_nan=True)
        for text in archived
    ):
        yield f"its numbers give {worst}, its comparisons say {archived}"


def _solved(rows: dict[str, Any], failures: Sequence[str]) -> dict[str, Any]:
    """Rows of the states that have a solution."""
    quantities, c = table(), rows[states.SPEED.path]
    failed = [x for x in np.unique(c) if any(text.startswith(f"c = {x:g}: ") for text in failures)]
    given = [
        np.isfinite(values) for name, values in rows.items()
        if (row := quantities[name]).solved and row.over == (STATE,) and row.nan_allowed == NEVER
    ]  # fmt: skip
    bad = np.isin(c, failed) & ~np.all(given, axis=0)
    for name, values in rows.items() if bad.any() else ():
        if quantities[name].over[:1] == (STATE,):
            rows[name] = values[~bad]
    return rows


def _of_verdict(archive: Archive, scene: Scene) -> Iterator[str]:
    """Verdict and reasons that do not follow from the archived comparisons."""
    attributes = archive.attributes
    rules = {
        compare.RULES[name].text: name
        for name in json.loads(attributes["rules"])
        if name in compare.RULES
    }
    judge = Judge(scene, rules.values())
    archived = _texts(archive, "comparisons")
    judge.see({rules[text]: archived[text] for text in archived if text in rules})
    judge.failures = list(archive.data.get(runs.FAILURES.path, ()))
    verdict, reasons = judge.verdict()
    if attributes["verdict"] != verdict:
        yield f"verdict says {attributes['verdict']}, its comparisons give {verdict}"
    if _texts(archive, "verdict_reasons") != reasons:
        yield f"verdict_reasons says {attributes['verdict_reasons']}, its comparisons give {reasons}"
