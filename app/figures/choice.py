"""Options of figures, the archive that they are drawn from, and figures with their captions.

A choice says which figures, states and quantities are drawn, over what, how large and in which units.
Parameters that distinguish an archive's states say which of them a figure shows, and name them.
"""

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from galinx.postprocess.quantities import Quantity, column, solved_states, table
from galinx.postprocess.quantities.quantity import FEM, METHODS, TEXT
from galinx.postprocess.quantities.states import LOAD, MOTION, POSITION, SPEED, SPEED_LIMIT, VELOCITY
from galinx.postprocess.quantities.swept import WAVE_SPEED
from galinx.postprocess.tables import parameters
from galinx.postprocess.units import Scaled, Units
from galinx.texts import in_tex, number, plain, unit

from ..errors import BadInput
from ..scene.scene import Scene
from .measured import Measured
from .render import Curve, Film, Size, lines_and_markers
from .style import LINES, MARKERS, Look, looks

_INCHES = {"in": 1.0, "cm": 1.0 / 2.54, "mm": 1.0 / 25.4, "pt": 1.0 / 72.0}
#: Least and largest width and height that paper and films have [in].
_LEAST, _MOST = 1.5, 40.0


@dataclass(frozen=True)
class Choice:
    """Options of a figure; what an empty attribute leaves open is chosen automatically.

    Attributes:
        figures: their names.
        states: numbers of states.
        quantities: names of quantities, as the columns of ``csv`` end.
        method: of solution.
        x, by: names of the numbers that curves are drawn over, and of those that distinguish curves.
        y: names of the numbers drawn over ``x``.
        size: of every figure.
        units: of the result's numbers; None: dimensionless.
        measured: points that lie over figures, as :func:`galinx.app.figures.measured.read` gives them.
    """

    figures: tuple[str, ...] = ()
    states: tuple[int, ...] = ()
    quantities: tuple[str, ...] = ()
    method: str = ""
    x: str = ""
    y: tuple[str, ...] = ()
    by: str = ""
    size: Size | None = None
    units: Units | None = None
    measured: Measured | None = None

    @property
    def given(self) -> set[str]:
        """Names of the options set by the user that say what is drawn."""
        names = ("states", "quantities", "method", "x", "y", "by", "measured")
        return {name for name in names if getattr(self, name)}


def short_name(row: Quantity) -> str:
    """Name of a quantity, from the beginning of its description."""
    return re.split(r"[,;:]| \(", row.about)[0]


def words(names: str | Sequence[str]) -> tuple[str, ...]:
    """The words between commas, or those of a list.

    Raises:
        BadInput: they are no texts.
    """
    if not isinstance(names, str):
        several = tuple(names) if np.iterable(names) else (None,)
        if not all(isinstance(name, str) for name in several):
            raise BadInput(f"found {names!r:.60}, expected names, as a text or a list of texts")
        return several
    return tuple(word.strip() for word in names.split(",") if word.strip())


def size(text: str) -> Size | None:
    """Size of a figure from ``3.5in``, or with a height ``89mm x 60mm``; None where the text is empty.

    Raises:
        BadInput: it is no size, or one that no figure has.
    """
    if not text:
        return None
    length = re.compile(r"\s*(\d+(?:\.\d*)?|\.\d+)\s*(in|cm|mm|pt)\s*")
    sides = [length.fullmatch(side) for side in re.split("[x×]", text)]
    inches = [float(side[1]) * _INCHES[side[2]] for side in sides if side]
    if len(inches) < len(sides) or len(sides) > 2:
        raise BadInput(
            f"--size: found {text!r}, expected a width or width x height in in, cm, mm or pt, as 3.5in "
            "or 89mm x 60mm"
        )
    if not _LEAST <= min(inches) <= max(inches) <= _MOST:
        raise BadInput(f"--size: found {text}, expected {_LEAST:g} to {_MOST:g} in")
    return Size(*inches)


@dataclass(frozen=True)
class Drawing:
    """A figure with its caption.

    Attributes:
        name: for files.
        caption: what it shows, what to see in it, and what it leaves out; plain text.
        figure: the matplotlib figure.
        pixels: True where a page should embed it as pixels.
        left_out: which states it does not show and how to draw them; "" where it shows all.
        film: the film of which the figure is the first frame; None for figures.
    """

    name: str
    caption: str
    figure: Figure
    pixels: bool = False
    left_out: str = ""
    film: Film | None = None

    @property
    def full_caption(self) -> str:
        """Caption, with the states that are left out."""
        return f"{self.caption} {self.left_out}".strip()


#: Names of the stroke and the place on it, of the speed and the load.
STROKE, PLACE, C, N = (row.path.rpartition("/")[2] for row in (MOTION, POSITION, SPEED, LOAD))


class Archive:
    """Source of figures: an archive, its scene, and a choice of what is drawn.

    Parameters that distinguish its states say which of them a figure shows, and a legend names them.

    Args:
        data: datasets by path.
        scene: of the archive.
        choice: states, quantities, axes, size and units.

    Attributes:
        data, scene, choice: as given.
        units: of the figures' numbers.
        c_s: wave speed of the first solid [m/s].
        parameters: quantities of the parameters that distinguish states, by name.
        all: numbers of all states.
    """

    def __init__(self, data: dict[str, Any], scene: Scene, choice: Choice) -> None:
        self.data, self.scene, self.choice = data, scene, choice
        self.units = choice.units or Units(scene.body, data, dimensionless=True)
        self.c_s = scene.solid.c_s
        self.parameters = {path.rpartition("/")[2]: row for path, row in parameters(data).items()}
        self.all = np.arange(len(data[SPEED.path]))

    @property
    def law(self) -> list[str]:
        """Names of the friction law's parameters."""
        return [name for name in self.parameters if name not in (C, N, STROKE, PLACE)]

    def varied(self, states: NDArray | Sequence[int] | None = None) -> list[str]:
        """Names of the parameters that differ between some states, between all if not given."""
        return [name for name in self.parameters if len(self.distinct(name, states)) > 1]

    @cached_property
    def speeds(self) -> NDArray[np.float64]:
        """Speed of every state [m/s], (states,); those that differ by rounding alone are one."""
        return np.array([float(f"{speed:.12g}") for speed in self.data[VELOCITY.path]])

    @cached_property
    def by_c(self) -> bool:
        """True in a sweep over solids at few c, each of which is several speeds."""
        of_solids = WAVE_SPEED.path in self.data
        return of_solids and len(np.unique(self.data[SPEED.path])) < len(np.unique(self.speeds))

    def parameter(self, name: str) -> NDArray:
        """Values of a parameter in all states, (states,); speeds over the wave speed of the first solid.

        In a sweep over solids one speed has several c, or one c several speeds: fewer are the parameter.
        """
        if name == C and WAVE_SPEED.path in self.data and not self.by_c:
            return self.speeds / self.c_s
        return self.data[column(name)]

    def distinct(self, name: str, states: NDArray | Sequence[int] | None = None) -> list[Any]:
        """Distinct values of a parameter: numbers in ascending order, texts in the order of states."""
        values = self.parameter(name)[self.all if states is None else np.asarray(states)].tolist()
        return sorted(set(values)) if self.numeric(name) else list(dict.fromkeys(values))

    def numeric(self, name: str) -> bool:
        """Return True if a parameter is a number."""
        return self.parameters[name].type != TEXT

    def where(self, states: NDArray, **values: Any) -> NDArray[np.int64]:
        """States whose named parameters have the given values, among some states."""
        for name, value in values.items():
            states = states[self.parameter(name)[states] == value]
        return states

    def once(self, states: NDArray, *curves: NDArray) -> tuple[NDArray[np.int64], str]:
        """Some states, those with the first value of each swept number that changes no curve, and a
        sentence on these numbers.

        Args:
            states: numbers of states, all of which are kept where they were chosen.
            curves: numbers of all states, (states, …) each.
        """
        idle = list[str]()
        for name in self.varied(states) if not self.choice.states else ():
            each = [self.ordered(self.where(states, **{name: v})) for v in self.distinct(name, states)]
            if "." in name and all(
                len(other) == len(each[0])
                and np.allclose(y[other], y[each[0]], rtol=1e-9, atol=0.0, equal_nan=True)
                for other in each[1:] for y in curves
            ):  # fmt: skip
                states, idle = each[0], [*idle, plain(f"${self.axis(name)[0]}$")]
        return states, f" Results are the same for every {' and '.join(idle)}." * bool(idle)

    def ordered(self, states: NDArray) -> NDArray[np.int64]:
        """Some states in the order of their parameters, the first parameter slowest."""
        return states[np.lexsort([self._places(name, states) for name in self.parameters][::-1])]

    def _places(self, name: str, states: NDArray) -> NDArray[np.int64]:
        """Positions of some states' values of a parameter among its distinct values, (states,)."""
        values = self.distinct(name, states)
        return np.array([values.index(value) for value in self.parameter(name)[states].tolist()])

    def label(self, state: int, names: Sequence[str]) -> str:
        """Named parameters of a state, with formulas in TeX."""
        return ", ".join(self.values_label(name, [self.parameter(name)[state]]) for name in names)

    def text(self, state: int, names: Sequence[str]) -> str:
        """Named parameters of a state, as plain text."""
        return plain(self.label(state, names))

    def all_at(self, states: Sequence[int]) -> str:
        """Sentence on the parameters that some states share and others have otherwise; "" for none."""
        fixed = [name for name in self.varied() if name not in self.varied(states)]
        return f" All at {self.text(int(states[0]), fixed)}." if fixed else ""

    def formal(self, states: NDArray | Sequence[int]) -> str:
        """Sentence on states at speeds at which waves along the surface are slower; "" for none."""
        beyond = (self.data[VELOCITY.path] >= self.data[SPEED_LIMIT.path])[list(states)].any()
        return " Beyond the speed of waves along the surface the closed form is formal." * bool(beyond)

    def values_label(self, name: str, values: Sequence[Any]) -> str:
        """Parameter with several values, of many the first, with formulas in TeX."""
        if not self.numeric(name):
            return _short([str(value) for value in values])
        symbol, factor, in_unit = self.axis(name)
        text = f"${symbol} = {_short([number(factor * value) for value in values])}{unit(in_unit)}$"
        own = name == C and symbol != "V" and not self.by_c
        if own and self.units.dimensionless and len(values) == 1:
            text += f" (${number(values[0] * self.c_s)}{unit('m/s')}$)"
        return text

    def axis(self, name: str) -> tuple[str, float, str]:
        """Symbol in TeX of a numeric parameter, what its values are multiplied by, and its unit."""
        row = self.parameters[name]
        scaled = self.units(row, name)
        if name == C and self.by_c:
            return str(row.symbol), 1.0, "1"
        if name == C and scaled and WAVE_SPEED.path in self.data:
            if self.units.dimensionless:  # over c_s one speed has several numbers
                return "V", self.c_s, "m/s"
            return "V", float(self.c_s * np.max(scaled.factor / self.data[WAVE_SPEED.path])), scaled.unit
        if scaled is None or np.ndim(scaled.factor) or scaled.offset:
            return str(row.symbol), 1.0, row.unit
        symbol = "V" if name == C and scaled.unit != "1" else str(row.symbol)
        return symbol, float(scaled.factor), scaled.unit

    def fixed(self, names: Sequence[str], states: NDArray) -> dict[str, Any]:
        """Values of the named parameters at which the others are varied.

        They are a combination that most states have: the first stroke, its last place, and of other
        parameters the middle value, or the combination nearest to this one.
        """
        if not len(names):
            return {}
        values = {name: self.distinct(name, states) for name in names}
        chosen = {STROKE: 0, PLACE: -1}
        middle = [chosen.get(name, (len(values[name]) - 1) // 2) % len(values[name]) for name in names]
        places = np.stack([self._places(name, states) for name in names])
        combinations, counts = np.unique(places, axis=1, return_counts=True)
        most = combinations[:, counts == counts.max()]
        best = most[:, np.abs(most - np.array(middle)[:, None]).sum(axis=0).argmin()]
        return {name: values[name][n] for name, n in zip(names, best)}

    def looks(self, states: Sequence[int], names: Sequence[str]) -> list[Look]:
        """Colours, lines and markers of the curves of some states that differ in the named parameters.

        Two parameters have colours and lines of their own; else each curve has.
        """
        if len(names) != 2:
            return looks(len(states), bool(names) and self.numeric(names[0]))
        count = len(self.distinct(names[0], states))
        colours = looks(count, self.numeric(names[0]))
        places = [self._places(name, np.asarray(states)).tolist() for name in names]
        return [
            Look(colours[n].colour, LINES[m % len(LINES)], MARKERS[(n + m * count) % len(MARKERS)])
            for n, m in zip(*places)
        ]

    def has(self, *rows: Quantity) -> bool:
        """Return True if the archive holds all of these quantities."""
        return all(row.path in self.data for row in rows)

    def by_method(self, *over: str, method: str | None = None) -> dict[str, dict[str, Quantity]]:
        """Quantities over some dimensions, by name and method.

        Args:
            over: dimensions.
            method: the only one whose quantities are returned; "" for all, by default that of the choice.
        """
        method = self.choice.method if method is None else method
        quantities: dict[str, dict[str, Quantity]] = {}
        for path, row in table().items():
            selected = path in self.data and row.over == over and row.type != TEXT and not row.symbol
            if selected and method in ("", row.method):
                quantities.setdefault(path.rpartition("/")[2], {})[row.method] = row
        return quantities

    def scaled(self, row: Quantity) -> Scaled:
        """Unit and scale of a quantity."""
        return self.units(row, "") or Scaled("", row.unit)  # as archived

    def values(self, row: Quantity) -> NDArray[np.float64]:
        """Numbers of a quantity in the figure's units."""
        return self.scaled(row).of(self.data[row.path])

    def selected(self) -> NDArray[np.int64]:
        """Chosen states, by default all with a solution, or all where none has one."""
        if self.choice.states:
            return np.array(self.choice.states)
        solved = self.all[solved_states(self.data)]
        return solved if len(solved) else self.all

    def not_shown(self, shown: Sequence[int], how: str) -> str:
        """Sentence on the states that a figure leaves out, and how to draw them; "" where it shows all.

        Args:
            shown: states that the figure shows.
            how: options that draw others.
        """
        missing = sorted({*(self.choice.states or self.all.tolist())} - {*shown})
        if not missing:
            return ""
        absent = {
            name: [value for value in self.distinct(name) if value not in self.parameter(name)[shown]]
            for name in self.varied()
        }
        texts = [plain(self.values_label(name, values)) for name, values in absent.items() if values]
        without = f" ({'; '.join(texts)})" if texts else ""
        runs = np.split(missing, np.flatnonzero(np.diff(missing) > 1) + 1)
        ranges = [f"{run[0]}-{run[-1]}" if len(run) > 1 else f"{run[0]}" for run in runs]
        return (
            f"{len(missing)} of {len(self.all)} states not shown{without}: "
            f"state{'s' * (len(missing) > 1)} {_short(ranges, ',')}; choose by plot {how}."
        )


def drive_label(c: float, g: float, way: float) -> str:
    """Legend label of a motion: its speed over c_s, σ_XY/σ_YY, and its way ±1 along X."""
    towards = f", towards ${'-+'[int(way > 0)]}X$" * bool(c > 0.0 and way != 0)
    return f"$c = {c:.4g}$, $\\sigma_{{XY}}/\\sigma_{{YY}} = {g:.4g}${towards}"


def spread(values: Sequence[Any], most: int) -> list[Any]:
    """At most so many of some values, the first and the last among them, evenly between these."""
    if len(values) <= most:
        return list(values)
    return [values[n] for n in np.unique(np.linspace(0, len(values) - 1, most).round().astype(int))]


def states_for_panel(
    of: Archive, names: Sequence[str], states: NDArray, most: int
) -> tuple[list[str], NDArray]:
    """States for one panel: as many parameters vary as that leaves a readable number of curves.

    Args:
        of: the archive.
        names: parameters that differ between ``states``, slowest first.
        states: numbers of states.
        most: curves in a panel.

    Returns:
        The parameters that vary, and the states.
    """
    # A sweep is looked at for what it sweeps; without one, strokes and places are.
    swept = [name for name in names if name not in (STROKE, PLACE)]
    varying: list[str] = []
    count = 1
    for name in [*swept, *(name for name in names if name not in swept)]:
        values = len(of.distinct(name, states))
        if count * min(values, most) <= most or not varying:
            varying.append(name)
            count *= min(values, most)
    rest = [name for name in names if name not in varying]
    states = of.where(states, **of.fixed(rest, states))
    for name in varying:
        states = states[np.isin(of.parameter(name)[states], spread(of.distinct(name, states), most))]
    return [name for name in names if name in varying], states


def fewer(shown: int, count: int, things: str, how: str = "") -> str:
    """Sentence on things that a figure does not show; "" where it shows all."""
    return f"{count - shown} of {count} {things} not shown{how}." * (shown < count)


def _short(words: Sequence[str], comma: str = ", ") -> str:
    """The first six of some words with commas between them, and "…" where there are more."""
    return comma.join(words[:6]) + f"{comma}…" * (len(words) > 6)


def named(words: str, unit: str) -> str:
    """Name of an axis with its unit: ``load (N/mm)``, ``pressure $/(N/2a)$``."""
    if unit in ("", "1", "none"):
        return words
    over = {
        "a": "$/a$", "N/(2a)": " $/(N/2a)$", "N/(2mu)": r"$/(N/2\mu)$",
        "N^2/(4mu)": r" over $N^2/4\mu$",
    }  # fmt: skip
    return words + over.get(unit, f" ({in_tex(unit)})")


def both(
    x: NDArray, values: dict[str, NDArray], look: Look, label: str = "", turn: float = 0.0
) -> list[Curve]:
    """Curves of one solution: a line of the closed form or the integral equation, markers of finite
    elements; these joined where they are alone.

    Args:
        x: places, (n,).
        values: numbers there by method, (n,) each.
    """
    lines = [(method, y) for method, y in values.items() if method != FEM]
    curves = [Curve(x, y, look, label) for _, y in lines[:1]]
    if FEM in values:
        form = "markers" if curves else "joined"
        curves.append(Curve(x, values[FEM], look, "" if curves else label, form, turn=turn))
    return curves


def explained(*of: Collection[str]) -> list[Any]:
    """Handles that explain lines and markers, where the methods of all curves of a figure have both."""
    each = [[METHODS[name] for name in METHODS if name in methods and name != FEM] for methods in of]
    lines = " or ".join(dict.fromkeys(names[0] for names in each if names))
    fem = any(FEM in methods for methods in of)
    return lines_and_markers(lines, METHODS[FEM]) if lines and fem else []
