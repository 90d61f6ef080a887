"""Friction laws fitted to measured friction: parameters, a comparison of laws, a section of a scene.

Measured friction comes as arrays, or from tables (:func:`read`).
"""

import json
from collections.abc import Mapping, Sequence
from contextlib import nullcontext, suppress
from dataclasses import dataclass, field, replace
from itertools import product
from math import isfinite
from numbers import Integral
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx import files
from galinx.postprocess.tables import Sheet
from galinx.solvers.friction import LAWS
from galinx.solvers.friction import fit as solver
from galinx.solvers.friction.fit import FittedLaw, Measured
from galinx.solvers.parameters import parameters
from galinx.texts import with_prefix

from ..console import Progress
from ..errors import BadInput, listed, require_one_of, short
from ..scene import read as scenes
from ..scene.scene import unusual
from ..scene.values import Number, kind_of
from ..text_table import read_table

_FORM = '"slip [mm],f", "time [s],position [mm],f", or with "force [N],load [N]" for f'


@dataclass(frozen=True)
class Table:
    """Friction of a table.

    Attributes:
        name: of the file.
        measured: time, position and friction coefficient; the time is that of a slip at 1 m/s where slip
            was measured alone.
        timed: True where time was measured.
        notes: what a reader should know of how it was read.
    """

    name: str
    measured: Measured
    timed: bool
    notes: tuple[str, ...] = ()


def read(path: Path) -> Table:
    """Read a table of measured friction.

    Args:
        path: a file whose first line names the columns, units in brackets: slip, or time and position;
            and f, or friction force and normal load; in any order, with any others beside them.

    Raises:
        BadInput: it is none; the message names the line.
    """
    table, notes = read_table(path, _FORM), []
    forces: dict[int, str] = {}  # SI units of columns of forces
    for n, unit in product(range(len(table.names)), ("N", "N/m")):
        with suppress(BadInput):
            if table.units[n] not in ("", "1", "-") and table.factor(n, unit):
                forces[n] = unit
    columns: dict[str, int] = {}
    for n, (name, kind) in enumerate(zip(table.names, table.kinds)):
        if kind == "friction" and n in forces:  # F [N] is a force, N without a unit of one no load
            kind = "force"
        if name != "n" or n in forces:
            first = columns.setdefault(kind, n)
            if kind and first != n:
                notes.append(
                    f"{path}: columns {first + 1} and {n + 1} are both {kind}: the first is read"
                )

    def numbers(kind: str, unit: str) -> NDArray[np.float64]:
        column = columns[kind]
        values = table.numbers(column, unit)
        if not table.units[column] and len(values):
            notes.append(
                f"{path}: {table.names[column]} has no unit in its head and is read in {unit}, "
                f"{values.min():g} to {values.max():g} {unit}; else write it in brackets, as [mm] or [ms]"
            )
        return values

    timed = {"time", "position"} <= columns.keys()
    if not (timed or "slip" in columns) or not {"friction", "force"} & columns.keys():
        hint = "; alone, a slip since rest is named slip" if "position" in columns else table.near_miss
        raise BadInput(f"{path}, line 1: found {table.heads}, expected {_FORM}{hint}")
    if "friction" in columns:
        f = table.numbers(columns["friction"], "")
    elif "load" not in columns:
        raise BadInput(f"{path}, line 1: found a friction force without a load, expected {_FORM}")
    else:
        both = columns["force"], columns["load"]
        unit = forces.get(both[0], "")
        if not unit or unit != forces.get(both[1]):
            given = ", ".join(f"{table.names[n]} [{table.units[n]}]" for n in both)
            raise BadInput(f"{path}, line 1: found {given}, expected both in N, or both in N/m")
        force, load = (table.numbers(n, unit) for n in both)
        if wrong := np.flatnonzero(load * load[:1] <= 0.0).tolist():
            line, _ = table.rows[wrong[0]]
            what = "loads of two signs" if load[wrong[0]] else "no load"
            raise BadInput(f"{path}, line {line}: found {what}, expected loads of one sign")
        f = force / np.abs(load)
    clock = numbers("time", "s") if timed else numbers("slip", "m")
    X = numbers("position", "m") if timed else clock
    back, few = np.flatnonzero(np.diff(clock) <= 0.0), len(clock) < 3
    if few or len(back):
        row = len(clock) - 1 if few else int(back[0]) + 1
        line, name = (table.rows[row][0] if len(clock) else 1), "time" if timed else "slip"
        hint = "; where it falls, as in a loop, write time and position" * (len(back) > 0 and not timed)
        fault = f"{len(clock)} row" + "s" * (len(clock) != 1) if few else f"a {name} that does not grow"
        raise BadInput(
            f"{path}, line {line}: found {fault}, expected three or more rows in which the {name} grows"
            f"{hint}"
        )
    _require_friction(str(path), X, f)
    if not timed and X[0] < 0.0:
        raise BadInput(f"found the slip {X[0]:g} m, expected slips from 0 on")
    if not timed and X[0] > np.ptp(X):
        ends = " to ".join(with_prefix(x, "m") for x in (X[0], X[-1]))
        raise BadInput(
            f"{path}, line {table.rows[0][0]}: found slips from {ends}, expected slips from 0 on, since "
            "rest: most of the stroke is missing; if the motion begins there, take off the first slip"
        )
    if not timed and X[0] > 0.0:  # counted from rest, of which the table has no row
        clock = X = np.append(0.0, X)
        f = np.append(np.nan, f)
    return Table(path.name, Measured(clock, X, f), timed, tuple(notes))


def _of_arrays(measured: Measured) -> Table:
    """Table of arrays.

    Raises:
        BadInput: they are no friction along a motion.
    """
    given = {"t": measured.t, "X": measured.X, "f": measured.f}
    if any(np.ma.isMaskedArray(of) or np.iscomplexobj(of) for of in given.values()):
        raise BadInput("arrays: found masked or complex numbers, expected real ones without a mask")
    try:
        t, X, f = (np.asarray(of, dtype=float) for of in given.values())
    except (TypeError, ValueError) as error:
        raise BadInput(f"arrays: {error}, expected numbers") from None
    if t.ndim != 1 or not t.shape == X.shape == f.shape or len(t) < 3:
        shapes = ", ".join(f"{name} {np.shape(of)}" for name, of in given.items())
        raise BadInput(f"arrays: found the shapes {shapes}, expected (samples,) of each, 3 or more")
    for name, of in zip(given, (t, X, np.append(0.0, f[1:]))):  # at first it is at rest
        if len(wrong := np.flatnonzero(~np.isfinite(of))):
            n = wrong[0]
            raise BadInput(f"arrays: found {name}[{n}] = {of[n]:g}, expected a finite number")
    if len(wrong := np.flatnonzero(np.diff(t) <= 0.0) + 1):
        n = wrong[0]
        raise BadInput(f"arrays: found t[{n}] = {t[n]:g} s after {t[n - 1]:g} s, expected growing times")
    _require_friction("arrays", X, f)
    return Table("arrays", Measured(t, X, f), True)


def _require_friction(name: str, X: NDArray, f: NDArray) -> None:
    """Refuse a motion that is none, and no friction."""
    if not np.ptp(X):
        raise BadInput(f"{name}: found one position in all rows, expected a motion")
    if not np.nan_to_num(f).any():
        raise BadInput(f"{name}: found f = 0 in all rows, expected friction")


#: Name that stands for every law.
ALL = "all"
#: Most rows of a law's table.
MOST_ROWS = 20
#: What a law leaves of friction over its size from which on it does not follow it; the same where the
#: scatter from sample to sample is so many times less, and shows that more than noise is left.
_FOLLOWS, _MORE, _THAN_SCATTER = 0.5, 0.05, 3.0


@dataclass(frozen=True, repr=False)
class Fit(FittedLaw):
    """A friction law fitted to measured friction, with its parameters and their deviations.

    Attributes:
        model: name of the law.
        seconds: wall time.
        tables: the measurements.
        others: other laws fitted to the same data, best first.
        failed: reasons why further laws were not, by name.
    """

    model: str
    seconds: float
    tables: tuple[Table, ...]
    others: tuple["Fit", ...] = ()
    failed: Mapping[str, str] = field(default_factory=dict)

    def __repr__(self) -> str:
        return f"<galinx fit of {self.model}: RMS of f {self.rms:.3g}, AIC {self.aic:.1f}>"

    def scene(self, path: str | Path | None = None) -> str:
        """Section ``[friction]`` with the law, each number with its deviation as a comment.

        Args:
            path: a scene; its text is returned with the law in place of its own. ``pre_sliding``,
                ``integrator``, ``sign`` and everything else stay as written.

        Raises:
            BadInput: the file is no scene, or no scene with this law.
        """
        if path is None:
            return _section(self)
        from ..scene.changes import with_law  # a slow import

        scenes.read(path := Path(path))
        # The file's line ends stay.
        text = with_law(files.read(path).decode("utf-8-sig"), _section(self), str(path))
        scenes.parse(scenes.filled(text, path.parent, str(path)), f"{path} with this law")
        return text

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on assumptions, samples left out, and friction that the law does not follow."""
        f = np.concatenate([table.measured.f for table in self.tables])
        samples, size = len(f), float(np.sqrt(np.nanmean(f**2)))
        said = [note for table in self.tables for note in table.notes]
        left = [table.measured.f - f for table, f in zip(self.tables, self.f)]
        steps = np.abs(np.concatenate([np.diff(rest) for rest in left]))
        scatter = float(np.nanmedian(steps))
        more = self.rms >= max(_MORE * size, _THAN_SCATTER * scatter)
        if more or self.rms >= _FOLLOWS * size:
            said.append(
                f"{self.model} does not follow the data: {self.rms:.3g} is left of f, "
                f"{np.nanmean(np.concatenate(left)):.3g} on average, where the root mean square of f is "
                f"{size:.3g}, dimensionless; f has the sign of the motion and no offset: is it so there?"
            )
        for key, parameter in parameters(type(self.law)).items():
            if key in self.parameters and key not in self.not_determined:
                said += unusual(key, parameter, self.parameters[key])
        if self.every > 1:
            said.append(f"every {self.every}th sample is fitted, and those where the motion turns")
        elif self.samples < samples:
            said.append(
                f"not fitted: {samples - self.samples} of {samples} samples, the first of each "
                "file, before the motion, and those at rest or at a smooth turn"
            )
        return tuple(said)

    def sheet(self) -> Sheet:
        """Table of all laws, best first."""
        rows = [
            [
                fit.model, f"{fit.rms:.3g}", f"{fit.aic:.1f}", str(len(fit.deviations)),
                str(len(fit.not_determined)), f"{fit.seconds:.1f}",
            ]
            for fit in (self, *self.others)
        ]  # fmt: skip
        columns = ["law", "RMS of f [1]", "AIC", "parameters", "not determined", "time [s]"]
        notes = [f"{name}: {reason}" for name, reason in self.failed.items()]
        return Sheet("", columns, rows, ["AIC: the less the better; by 10, clearly", *notes])


def fit(
    data: str | Path | Measured | Sequence[str | Path | Measured],
    model: str = ALL,
    *,
    fix: Mapping[str, Any] | None = None,
    start: Mapping[str, Any] | None = None,
    speed: Any = (),
    rows: int = 3,
    progress: Progress | bool | None = None,
) -> Fit:
    """Friction law nearest to measured friction, of all laws that of the least Akaike's criterion.

    Args:
        data: table of measured friction, by its file's name, or as arrays; or several, with the same
            parameters, each of which begins at rest.
        model: name of a law, or ``"all"``.
        fix: parameters by key that are known, as numbers in SI, texts with units, or rows.
        start: parameters by key with which the search begins.
        speed: of tables of slips, in m/s or a text with a unit; one for all, or one for each.
        rows: number of rows of a law's table, as the springs of Maxwell slip.
        progress: shows the work; True for a bar on a terminal.

    Raises:
        BadInput: there is no such law, a table is none, its friction drives the motion, or no law can be
            fitted to it.
    """
    single = isinstance(data, (str, Path, Measured)) or not np.iterable(data)
    sources: list[Any] = [data] if single else list(data)  # type: ignore[arg-type]
    strange = [source for source in sources if not isinstance(source, (str, Path, Measured))]
    if strange or not sources:
        source = f"{strange[0]!r:.60}" if strange else "nothing"
        raise BadInput(f"data: found {source}, expected names of files, or galinx.Measured of arrays")
    paths = [str(source) for source in sources if isinstance(source, (str, Path))]
    if twice := [name for name in dict.fromkeys(paths) if paths.count(name) > 1]:
        raise BadInput(f"found {listed(twice)} more than once, expected each measurement once")
    if not isinstance(rows, Integral) or not 1 <= rows <= MOST_ROWS:
        raise BadInput(f"rows: found {rows!r}, expected a whole number from 1 to {MOST_ROWS}")
    names = [*LAWS] if require_one_of("friction law", model, [*LAWS, ALL]) == ALL else [model]
    # Parameters of each law that it has, from texts and numbers.
    fixed, started = (_values(names, given or {}) for given in (fix, start))
    given_tables = [_of_arrays(s) if isinstance(s, Measured) else read(Path(s)) for s in sources]
    tables, speedless = _at_speeds(given_tables, speed)
    for table in tables:  # friction takes work from the motion: it is positive forward
        X, f = table.measured.X, table.measured.f
        work = np.diff(X) * 0.5 * (f[1:] + f[:-1])
        if np.nansum(work) < -0.1 * np.nansum(np.abs(work)):  # less is noise
            raise BadInput(
                f"{table.name}: found friction that drives the motion, f mostly negative where X "
                "grows, expected it positive there; change the sign of f or of X"
            )
    fits: list[Fit] = []
    failed: dict[str, str] = {}
    own = progress if isinstance(progress, Progress) else None  # which its owner ends
    with nullcontext(own) if own else Progress(quiet=not progress) as shown:
        for n, name in enumerate(names):
            shown.say(LAWS[name].about)
            begun, kind = perf_counter(), LAWS[name]

            def step(done: int, of: int, before: int = n) -> None:
                shown.done(before + done / of, len(names), "laws")

            try:
                if speedless and kind.depends_on_speed:
                    raise ValueError("depends on the speed: give --speed, as in --speed '1 mm/s'")
                held, guess = (
                    {key: given[key] for key in parameters(kind) if key in given}
                    for given in (fixed, started)
                )
                result = solver.fit(kind, [table.measured for table in tables], held, guess, rows, step)
                seconds = perf_counter() - begun
                fits.append(Fit(**vars(result), model=name, seconds=seconds, tables=tables))
            except ValueError as error:
                failed[name] = str(error)
        shown.done(len(names), len(names), "laws")
    if not fits:
        where = listed([table.name for table in tables], 3)
        raise BadInput("\n".join(f"{where}, {name}: {reason}" for name, reason in failed.items()))
    best, *others = sorted(fits, key=lambda fit: fit.aic)
    return replace(best, others=tuple(others), failed=failed)


def _at_speeds(tables: list[Table], given: Any) -> tuple[tuple[Table, ...], bool]:
    """Tables of slips at their speeds, others as they are; and True where a slip has no speed.

    Raises:
        BadInput: there are other numbers of speeds than of tables of slips, or one is no speed.
    """
    texts = [] if given is None else [given] if np.ndim(given) == 0 else list(given)
    slips = sum(not table.timed for table in tables)
    if texts and not slips:
        raise BadInput("--speed: found one, but the table tells the time; leave it away")
    if len(texts) not in (0, 1, slips):
        raise BadInput(
            f"--speed: found {len(texts)} for {slips} tables of slips, expected one, or as many"
        )
    speeds = []
    for text in texts:
        try:
            with suppress(TypeError, ValueError):  # else a text with a unit
                text = text if isinstance(text, bytes) else float(text)
            speeds.append(Number("m/s")(text))
        except ValueError as error:
            raise BadInput(f"--speed: {error}") from None
        if speeds[-1] <= 0.0:
            raise BadInput(f"--speed: found {speeds[-1]:g} m/s, expected > 0")
    left = iter(speeds * slips if len(speeds) == 1 else speeds)
    clocks = [t.measured.t / (1.0 if t.timed or not speeds else next(left)) for t in tables]
    moving = [replace(t, measured=replace(t.measured, t=clock)) for t, clock in zip(tables, clocks)]
    return tuple(moving), bool(slips and not speeds)


def _rows(given: Any) -> list[list[Any]]:
    """Rows of a table, from such or a text.

    Raises:
        ValueError: they are none.
    """
    try:
        return [list(row) for row in (json.loads(given) if isinstance(given, str) else given)]
    except (TypeError, ValueError):
        raise ValueError(f"found {given!r:.60}, expected rows, as [[1e4, 0.1], [1e3, 0.2]]") from None


def _values(names: list[str], given: Mapping[str, Any]) -> dict[str, Any]:
    """Parameters by key, of one or the other law, from numbers or texts.

    Raises:
        BadInput: a key is of no law, or a value none of that parameter.
    """
    declared = {key: entry for name in names for key, entry in parameters(LAWS[name]).items()}
    values: dict[str, Any] = {}
    if not isinstance(given, Mapping):
        raise BadInput(f"fix or start: found {given!r:.60}, expected numbers by key, as {{'mu_c': 0.3}}")
    for key, value in given.items():
        if key not in declared:
            raise BadInput(f"fix or start: found {short(key)!r}, expected one of {', '.join(declared)}")
        try:
            if declared[key].columns:
                value = _rows(value)
            elif not declared[key].options:
                with suppress(TypeError, ValueError):  # else a text with a unit
                    value = float(value)
            values[key] = kind_of(declared[key])(value)
        except ValueError as error:
            raise BadInput(f"{key}: {error}") from None
    return values


def _section(fit: Fit) -> str:
    declared = parameters(type(fit.law))
    files = ", ".join(table.name for table in fit.tables)
    lines = [
        f"# Fitted by galinx: {type(fit.law).about} to {fit.samples} samples",
        f"# of {files}; root mean square of the residuals of f: {fit.rms:.3g} (dimensionless);",
        "# ± is one standard deviation",
        "[friction]",
        f"model = {json.dumps(fit.model)}  # fitted to {files}",
    ]
    for key, value in fit.parameters.items():
        parameter = declared[key]
        text: Any = value
        if parameter.columns:
            text = [[float(f"{number:.9g}") for number in row] for row in value]
        elif not isinstance(value, str):
            text = f"{value:.9g} {parameter.unit}" if parameter.unit else float(f"{value:.9g}")
        unit = (
            "in SI" if parameter.columns else parameter.unit or "dimensionless" * (not parameter.options)
        )
        # The unit, and the deviation of each number.
        said = [
            ("not determined" + f" (± {error:.2g})" * isfinite(error))
            if name in fit.not_determined
            else f"± {error:.2g}"
            for name, error in fit.deviations.items()
            if name.partition("[")[0] == key
        ]
        comment = ", ".join(filter(None, [unit, *(said or ["not fitted"])]))
        lines.append(f"{key} = {json.dumps(text)}  # {comment}")
    return "\n".join(lines) + "\n"
