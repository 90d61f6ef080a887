"""Results beside each other: numbers of paired states in common units, and their differences."""

import textwrap
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.quantities import runs, states
from galinx.postprocess.tables import (
    LIMIT,
    Column,
    Sheet,
    parameters,
    sliders_sheet,
    starts_sheet,
    state_columns,
)
from galinx.postprocess.units import Units

from ..errors import BadInput, excerpt, listed, short
from ..scene.changes import differences
from ..scene.read import constants
from .result import Result

#: Difference [%] that rounding may make.
_ROUNDING = 1e-9


class Comparison:
    """States of results, paired by the parameters that vary in them, or else by their order.

    Args:
        results: two or more; differences are those from the first.
        dimensionless: stresses over N/(2a), lengths over a, speeds over c_s.
        chosen: states of the first; () for all.

    Attributes:
        results: as given.
        labels: of the results: their titles, or the names of their files where titles are alike.
        units: of the results, the same for all.
        pairs: a state of each result, (pairs, results).

    Raises:
        BadInput: the first has no such state, or it has no partner.
    """

    def __init__(
        self, results: Sequence[Result], dimensionless: bool = False, chosen: Sequence[int] = ()
    ) -> None:
        self.results, self.labels = results, _labels(results)
        own = [result.units(dimensionless) for result in results]
        self.units = [Units(r.scene.body, r.data, dimensionless, own) for r in results]
        self._counts = [len(result.data[states.FRICTION.path]) for result in results]
        whole = []
        for result, units, count in zip(results, self.units, self._counts):
            # What varies in one result may be a constant of another's scene.
            own = {f"states/{key}": of for key, of in constants(result.data[runs.SCENE.path]).items()}
            own[states.LOAD.path] = units.load
            whole.append({path: np.full(count, of) for path, of in own.items()} | result.data)
        self._by, self.pairs = _paired(whole, dimensionless)
        self._alone = [n - len({*self.pairs[:, k].tolist()}) for k, n in enumerate(self._counts)]
        if chosen:
            if missing := sorted({*chosen} - {*self.pairs[:, 0].tolist()}):
                raise BadInput(
                    f"--states: found {missing[0]}, expected numbers of states of {self.labels[0]} that "
                    f"have a partner: {listed([str(i) for i in self.pairs[:, 0]])}"
                )
            self.pairs = self.pairs[np.isin(self.pairs[:, 0], chosen)]
        # By their heads, places by what they are places of as well: methods do not matter.
        tables = [
            {(c.owner.head, c.head) if c.owner else (c.head,): c for c in state_columns(r.data, u)}
            for r, u in zip(results, self.units)
        ]
        #: Columns of each result by head, in the rows of the pairs; None where a result has none.
        self._rows: dict[tuple[str, ...], list[Column | None]] = {
            key: [
                column.of(of_result) if column else None
                for column, of_result in zip((table.get(key) for table in tables), self.pairs.T.tolist())
            ]
            for key in dict.fromkeys(key for table in tables for key in table)
        }
        #: Differences from the first [%] by head, of each other result; None where there are none.
        self._off = {
            key: [self._difference(first, other, n) for n, other in enumerate(others, 1)]
            for key, (first, *others) in self._rows.items()
        }

    @property
    def titles(self) -> list[str]:
        """Numbers of the states of each pair, and the parameters that pair them."""
        of_key = [row[0] for row in self._rows.values() if row[0] and self._pairs(row)]
        titles = []
        for p, pair in enumerate(self.pairs.tolist()):
            same = len(set(pair)) == 1
            numbers = f"state {pair[0]}" if same else f"states {', '.join(map(str, pair))}"
            values = [f"{c.head} {c.words(p)}" if c.unit != "none" else c.words(p) for c in of_key]
            titles.append(numbers + f" ({', '.join(values)})" * bool(values))
        return titles

    def _pairs(self, row: Sequence[Column | None]) -> bool:
        """True for a parameter that pairs states; equal speeds over c_s may differ in m/s, and do not."""
        if not any(column and column.path and column.path in self._by for column in row):
            return False
        return len({tuple(column.texts()) for column in row if column}) == 1

    def columns(self) -> list[Column]:
        """One row a pair: each quantity of every result, then its difference from the first [%]."""
        columns = []
        for key, row in self._rows.items():
            for n, (column, percent) in enumerate(zip(row, [None, *self._off[key]])):
                if column is None:
                    continue
                head, name = ", ".join([*key, self.labels[n]]), f"{column.name}_{n + 1}"
                values = column.values if column.unit == "none" else np.array(column.values, dtype=float)
                columns.append(replace(column, head=head, values=values, name=name, path=""))
                if percent is not None:
                    columns.append(Column(f"{head}, difference", percent, "%", f"{name}_difference"))
        return columns

    def _difference(
        self, first: Column | None, other: Column | None, n: int
    ) -> NDArray[np.float64] | None:
        """Difference of a result from the first [%], of places over the half-width, (pairs,).

        NaN where units differ; None of texts, and of what one of both has not.
        """
        if not first or not other or "none" in (first.unit, other.unit):
            return None
        a, b = (np.asarray(column.values, dtype=float) for column in (first, other))
        size, dimensionless = np.abs(a), self.units[0].dimensionless
        width = self._rows.get(("half-width",), [None])[0]
        if first.place and dimensionless:
            size = np.ones(len(a))
        elif width and (first.place or first.head == "centre"):
            size = np.asarray(width.values, dtype=float)
        with np.errstate(divide="ignore", invalid="ignore"):
            percent = np.where(a == b, 0.0, 100.0 * (b - a) / size)
        percent[~np.isfinite(percent) | np.isnan(a) | np.isnan(b)] = np.nan
        if first.head.startswith("K_I") and not dimensionless:  # its unit has the power of the exponent
            path = (states.BETA if first.head.endswith("left") else states.ALPHA).path
            exponents = [self.results[m].data.get(path) for m in (0, n)]
            if exponents[0] is not None and exponents[1] is not None:
                apart = exponents[0][self.pairs[:, 0]] - exponents[1][self.pairs[:, n]]
                percent[np.abs(apart) > 1e-9] = np.nan
        return percent if first.unit == other.unit else np.full(len(a), np.nan)

    def sheets(self) -> Iterator[Sheet]:
        """A table for each pair of states, results side by side; of many the first."""
        first, *others = (textwrap.fill(label, 18) for label in self.labels)
        heads = [first, *(head for label in others for head in (label, "difference\n[%]"))]
        titles, shown = self.titles[:LIMIT], []
        for key, columns in self._rows.items():
            if not self._pairs(columns):
                several = len({column.unit for column in columns if column}) > 1  # as of shares
                texts = [
                    [""] * len(titles) if column is None
                    else [column.words(p) for p in range(len(titles))] if several
                    else column.texts(len(titles))
                    for column in columns
                ]  # fmt: skip
                column = next(column for column in columns if column)
                label = column.head if several else column.label
                shown.append((column, label, [*zip(*texts)], self._off[key]))
        for p, title in enumerate(titles):
            rows = []
            for column, label, texts_of_pairs, percents in shown:
                cells = texts_of_pairs[p]
                same_motion = column.path == states.MOTION.path and len({*cells}) == 1
                if not any(cells) or same_motion:
                    continue
                row = [f"{'  ' * column.place}{label}", cells[0]]
                for cell, percent in zip(cells[1:], percents):
                    off = np.nan if percent is None else percent[p]
                    words = f"{off:+.3g}" if abs(off) >= _ROUNDING else "0"
                    row += [cell, "" if np.isnan(off) else words]
                rows.append(row)
            yield Sheet(title, ["", *heads], rows)
        for result, units, label in zip(self.results, self.units, self.labels):
            for made in (sliders_sheet(result.data, units), starts_sheet(result.data, units)):
                if made.rows:
                    yield replace(made, title=f"{made.title}: {label}")

    def notes(self) -> Iterator[str]:
        """In what the scenes differ, how states are paired, and what differences are."""
        texts = [result.data[runs.SCENE.path] for result in self.results]
        apart = differences(texts)
        apart.pop("title", None)
        said = [f"{key}: {' | '.join(short(v, 40) for v in values)}" for key, values in apart.items()]
        yield f"scenes differ in {'; '.join(said)}" if said else "scenes do not differ"
        if len(self.pairs) > LIMIT:
            more = len(self.pairs) - LIMIT
            yield f"and {more} more {'pair' if more == 1 else 'pairs'} of states; choose by --states"
        if any(self._alone):
            alone = ", ".join(f"{n} of {label}" for n, label in zip(self._alone, self.labels) if n)
            yield f"states without a partner: {alone}"
        if not self._by and max(self._counts) > 1:
            yield "states are paired by their order: their parameters do not agree"
        intensities = any(key[0].startswith("K_I") and row[0] for key, row in self._rows.items())
        yield "difference: from the first, of places and the centre over its half-width" + (
            "; of K_I none where the exponents, and so the units, differ" * intensities
        )
        if self.units[0].dimensionless and ("half-width",) in self._rows:
            yield f"half-width, centre: {self.units[0].of_a}"
        verdicts = [result.verdict for result in self.results]
        if set(verdicts) != {"PASS"}:
            yield f"verdicts: {' | '.join(verdicts)}"

    def drawing(self, measured: Any = None) -> Any:
        """Figure of contact pressure and in-plane stress, a :class:`galinx.app.figures.choice.Drawing`.

        Colours are by result, and lines by pair of states, of many of the first, middle and last one.

        Args:
            measured: points over it, of :func:`galinx.app.figures.measured.read`; None for none.

        Raises:
            BadInput: a result has no stresses along the surface, or no measured point lies in the figure.
        """
        from ..figures.choice import Archive, Choice, Drawing, explained, fewer, spread
        from ..figures.render import TooSmall, as_text, render
        from ..figures.stresses import Shown, stresses_along, surface_panel
        from ..figures.style import LINES, looks

        if measured and not measured.lies_in("surface"):
            raise BadInput(
                f"--measured {measured.name}: found {', '.join(measured.points)}, expected pressure or "
                "sigma_XX, which compare draws"
            )
        stressed = [
            stresses_along(Archive(result.data, result.scene, Choice(units=units)))
            for result, units in zip(self.results, self.units)
        ]
        if not all(stressed):
            raise BadInput(
                f"{self.labels[stressed.index({})]} holds no stresses along the surface; add "
                '"surface" to output.quantities'
            )
        pairs, titles = self.pairs.tolist(), self.titles
        chosen, styles = spread(range(len(pairs)), 3), looks(len(self.labels))
        labels = [as_text(label) for label in self.labels]
        indices = {0x2080 + n: f"$_{n}$" for n in range(10)}  # which the type of figures lacks
        panels = []
        for name in dict.fromkeys(name for of_result in stressed for name in of_result):
            shown = [
                Shown(
                    of_result[name], pairs[k][n],
                    look._replace(line=LINES[order % len(LINES)]) if len(chosen) > 1 else look,
                    f"{label}, {titles[k].translate(indices)}" if len(chosen) > 1 else label,
                    1.0 if n else 2.0,  # the first shows below others that are the same
                )
                for n, (of_result, look, label) in enumerate(zip(stressed, styles, labels))
                if name in of_result
                for order, k in enumerate(chosen)
            ]  # fmt: skip
            panel = surface_panel(shown)
            panels.append(measured.over_stress(panel, name, self.units[0]) if measured else panel)
        notes = explained(*(along.values for of_result in stressed for along in of_result.values()))
        try:
            figure = render(panels, None, min(2, len(panels)), notes)
        except TooSmall as error:
            raise BadInput(f"the titles of these archives leave no room for curves: {error}") from error
        left_out = fewer(len(chosen), len(pairs), "pairs of states", "; choose by --states")
        caption = f"Stresses along the surface: {', '.join(self.labels)}."
        return Drawing("compare", caption, figure, left_out=left_out)


def compare(first: Result, *others: Result, dimensionless: bool = False) -> list[Column]:
    """Results beside each other, one row a pair of states: columns with head, unit and values.

    States are paired by the parameters that vary in them where these agree, else by their order. All
    results have common units. After the numbers of each further result stand their differences from the
    first [%], of places and centres over the half-width; NaN where there is none, as for K_I whose edges
    have different exponents.

    Args:
        first, others: results.
        dimensionless: stresses over N/(2a), lengths over a, speeds over c_s.

    Raises:
        BadInput: one is no result.
    """
    for result in (first, *others):
        if not isinstance(result, Result):
            raise BadInput(f"compare: found {excerpt(result)}, expected results, as load gives")
    return Comparison([first, *others], dimensionless).columns()


def _labels(results: Sequence[Result]) -> list[str]:
    """Titles of results, or names of their files, or numbers: the first of these that differ."""
    titles = [str(result.attributes["title"]) for result in results]
    files = [result.inputs[0] if result.inputs else Path() for result in results]
    for labels in (titles, [file.stem for file in files], [str(file) for file in files]):
        if len(set(labels)) == len(results) and all(labels):
            return labels
    return [f"{title} ({n})" for n, title in enumerate(titles, 1)]


def _paired(results: Sequence[dict[str, Any]], over_c_s: bool) -> tuple[list[str], NDArray[np.int64]]:
    """Paths of the parameters that pair states, [] where order does, and pairs, (pairs, results).

    A parameter that is constant in every result pairs nothing, whatever its values are. Speeds pair in
    m/s or over c_s, whichever pairs more states; with ``over_c_s`` only by the latter.
    """
    common = [path for path in parameters(results[0]) if all(path in data for data in results)]
    best: tuple[list[str], list[list[int]]] = [], []
    for speed in (states.SPEED.path, *(() if over_c_s else (states.VELOCITY.path,))):
        taken = [speed if path == states.SPEED.path and speed in results[0] else path for path in common]
        by = [
            (path, of) for path, of in zip(common, taken)
            if any(len(set(_values(data, of))) > 1 for data in results)
        ]  # fmt: skip
        keys = [[*zip(*(_values(data, of) for _, of in by))] for data in results]
        if by and all(len(set(key)) == len(key) for key in keys):
            places = [{key: n for n, key in enumerate(of_result)} for of_result in keys]
            pairs = [[place[key] for place in places] for key in keys[0] if all(key in p for p in places)]
            if len(pairs) > len(best[1]):
                best = [path for path, _ in by], pairs
    if best[1]:
        return best[0], np.array(best[1])
    count = min(len(data[states.FRICTION.path]) for data in results)
    return [], np.tile(np.arange(count)[:, None], len(results))


def _values(data: dict[str, Any], path: str) -> list[Any]:
    values = np.asarray(data[path]).tolist()
    return [float(f"{v:.9g}") if isinstance(v, float) else v for v in values]
