"""What tells an archive's states apart, which of them a figure shows, and what it says of the others."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.figures.style import LINES, MARKERS, Look, looks, number, plain, unit
from galinx.postprocess.quantities import column
from galinx.postprocess.quantities.quantity import TEXT
from galinx.postprocess.quantities.states import LOAD, MOTION, POSITION, SPEED
from galinx.postprocess.tables import parameters

from ..scene.scene import Scene

#: States and values that a sentence names.
_NAMED = 6

#: Names of what tells places on a loop apart, of the speed and the load.
STROKE, PLACE, C, N = (row.path.rpartition("/")[2] for row in (MOTION, POSITION, SPEED, LOAD))


class Told:
    """What tells an archive's states apart, and how a legend says it.

    Args:
        data: the archive's.
        scene: the archive's.
    """

    def __init__(self, data: dict[str, Any], scene: Scene) -> None:
        self._data, self.c_s = data, scene.solid.c_s
        self.parameters = {path.rpartition("/")[2]: row for path, row in parameters(data).items()}
        self.all = np.arange(len(data[SPEED.path]))

    @property
    def law(self) -> list[str]:
        """Names of the friction law's parameters."""
        return [name for name in self.parameters if name not in (C, N, STROKE, PLACE)]

    def varied(self, some: NDArray | Sequence[int] | None = None) -> list[str]:
        """Parameters that differ between some states, between all if not given."""
        return [name for name in self.parameters if len(self.distinct(name, some)) > 1]

    def values(self, name: str) -> NDArray:
        """A parameter of all states."""
        return self._data[column(name)]

    def distinct(self, name: str, some: NDArray | Sequence[int] | None = None) -> list[Any]:
        """Values of a parameter: numbers by size, texts as states follow each other."""
        values = self.values(name)[self.all if some is None else np.asarray(some)].tolist()
        return sorted(set(values)) if self.numeric(name) else list(dict.fromkeys(values))

    def numeric(self, name: str) -> bool:
        """Is a parameter a number?"""
        return self.parameters[name].type != TEXT

    def where(self, some: NDArray, **values: Any) -> NDArray[np.int64]:
        """Those of some states whose named parameters have the given values."""
        for name, value in values.items():
            some = some[self.values(name)[some] == value]
        return some

    def label(self, state: int, names: Sequence[str]) -> str:
        """Some parameters of a state."""
        return ", ".join(self._told(name, self.values(name)[state]) for name in names)

    def ordered(self, some: NDArray) -> NDArray[np.int64]:
        """Some states in the order of what tells them apart, the first parameter slowest."""
        return some[np.lexsort([self._places(name, some) for name in self.parameters][::-1])]

    def _places(self, name: str, some: NDArray) -> NDArray[np.int64]:
        """Where a parameter of some states stands among its distinct values."""
        place = {value: n for n, value in enumerate(self.distinct(name, some))}
        return np.array([place[value] for value in self.values(name)[some].tolist()])

    def text(self, state: int, names: Sequence[str]) -> str:
        """The same without formulas."""
        return plain(self.label(state, names))

    def listed(self, name: str, values: Sequence[Any]) -> str:
        """Some values of a parameter as plain text."""
        row = self.parameters[name]
        if not self.numeric(name):
            return _short(values)
        told = _short([plain(f"${number(value)}$") for value in values])
        return f"{plain(f'${row.symbol}$')} = {told}{plain(f'${unit(row.unit)}$')}"

    def _told(self, name: str, value: Any) -> str:
        row = self.parameters[name]
        if not self.numeric(name):
            return str(value)
        told = f"${row.symbol} = {number(value)}{unit(row.unit)}$"
        return f"{told} ({self.speed(value)})" if name == C else told

    def speed(self, c: float) -> str:
        """A speed over the wave speed in m/s."""
        return f"${number(c * self.c_s)}{unit('m/s')}$"

    def fixed(self, names: Sequence[str], some: NDArray) -> dict[str, Any]:
        """A value for each of some parameters, at which others are varied.

        Of the combinations that most states have: the first stroke, its last place, and of other lists
        the middle, or what is nearest to these.
        """
        if not len(names):
            return {}
        values = {name: self.distinct(name, some) for name in names}
        chosen = {STROKE: 0, PLACE: -1}
        middle = [chosen.get(name, (len(values[name]) - 1) // 2) % len(values[name]) for name in names]
        places = np.stack([self._places(name, some) for name in names])
        combinations, counts = np.unique(places, axis=1, return_counts=True)
        most = combinations[:, counts == counts.max()]
        best = most[:, np.abs(most - np.array(middle)[:, None]).sum(axis=0).argmin()]
        return {name: values[name][n] for name, n in zip(names, best)}

    def looks(self, states: Sequence[int], names: Sequence[str]) -> list[Look]:
        """Of the curves of some states that differ in the named parameters.

        Two parameters have colours and lines of their own; else each curve has.
        """
        if len(names) != 2:
            return looks(len(states), bool(names) and self.numeric(names[0]))
        first, second = (self.distinct(name, states) for name in names)
        colours = looks(len(first), self.numeric(names[0]))
        found = [
            (first.index(self.values(names[0])[state]), second.index(self.values(names[1])[state]))
            for state in states
        ]
        return [
            Look(colours[n].colour, LINES[m % len(LINES)], MARKERS[(n + m * len(first)) % len(MARKERS)])
            for n, m in found
        ]


def drive_label(c: float, g: float, way: float) -> str:
    """How a legend names a motion: its speed over c_s, σ_XY/σ_YY, and the way ±1 it goes along X."""
    towards = f", towards ${'-+'[way > 0]}X$" * (c > 0.0 and way != 0)
    return f"$c = {c:.4g}$, $\\sigma_{{XY}}/\\sigma_{{YY}} = {g:.4g}${towards}"


def spread(values: Sequence[Any], most: int) -> list[Any]:
    """At most so many of some values, the first and the last among them, evenly between these."""
    if len(values) <= most:
        return list(values)
    return [values[n] for n in np.unique(np.linspace(0, len(values) - 1, most).round().astype(int))]


def few(told: Told, names: Sequence[str], some: NDArray, most: int) -> tuple[list[str], NDArray]:
    """States for one panel: as many parameters vary as that leaves a readable number of curves.

    Args:
        told: of the archive.
        names: parameters that differ between ``some``, slowest first.
        some: states.
        most: curves in a panel.

    Returns:
        The parameters that vary, and the states.
    """
    # A sweep is looked at for what it sweeps; without one, strokes and places are.
    swept = [name for name in names if name not in (STROKE, PLACE)]
    varying: list[str] = []
    count = 1
    for name in [*swept, *(name for name in names if name not in swept)]:
        values = len(told.distinct(name, some))
        if count * min(values, most) <= most or not varying:
            varying.append(name)
            count *= min(values, most)
    rest = [name for name in names if name not in varying]
    some = told.where(some, **told.fixed(rest, some))
    for name in varying:
        some = some[np.isin(told.values(name)[some], spread(told.distinct(name, some), most))]
    return [name for name in names if name in varying], some


def not_shown(told: Told, shown: Sequence[int], how: str, wanted: Sequence[int] = ()) -> str:
    """What a figure does not show, and how to get it; nothing where it shows all.

    Args:
        told: of the archive.
        shown: states.
        how: options that draw others.
        wanted: states that are asked for, all if none are.
    """
    missing = sorted(set(wanted or told.all.tolist()) - set(shown))
    if not missing:
        return ""
    values = [
        told.listed(name, absent)
        for name in told.varied()
        if (absent := [value for value in told.distinct(name) if value not in told.values(name)[shown]])
    ]
    without = f" ({'; '.join(values)})" if values else ""
    noun = "state" if len(missing) == 1 else "states"
    ranges = _short(_ranges(missing), ",")
    count = f"{len(missing)} of {len(told.all)} states not shown{without}"
    return f"{count}: {noun} {ranges}; choose by {how}."


def _short(words: Sequence[str], comma: str = ", ") -> str:
    """The first of them, and that there are more."""
    return comma.join(words[:_NAMED]) + f"{comma}…" * (len(words) > _NAMED)


def _ranges(numbers: Sequence[int]) -> list[str]:
    runs: list[list[int]] = []
    for number_ in numbers:
        if runs and number_ == runs[-1][-1] + 1:
            runs[-1].append(number_)
        else:
            runs.append([number_])
    return [f"{run[0]}" if len(run) == 1 else f"{run[0]}-{run[-1]}" for run in runs]
