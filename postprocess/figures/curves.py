"""Curves of single numbers of states over a parameter."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import floor, log10

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from galinx.postprocess.figures.canvas import Legend, Room, Size, handle, lettered, of_methods, panels
from galinx.postprocess.figures.style import COLUMN, GREY, PAGE, Look, looks, styled
from galinx.postprocess.figures.typeset import folded

#: Axes become logarithmic where numbers span more than this; that of the parameter where it spans more
#: than that, by steps that are equal ratios rather than differences.
_DECADES, _RATIOS = 200.0, 30.0

#: Numbers beyond these have a power of ten beside their unit.
_SHORT, _LONG = 1e-2, 1e4

#: About how wide a letter of an axis is [in].
_LETTER = 0.055


@dataclass(frozen=True)
class Line:
    """Numbers over the parameter, in its order; methods without numbers have none.

    Attributes:
        label: names it in a legend.
        x: the parameter, (n,).
        exact, found: not by finite elements, and by these, (n,).
    """

    label: str
    x: NDArray
    exact: NDArray | None = None
    found: NDArray | None = None

    @property
    def all(self) -> NDArray:
        """Its numbers, whichever method's."""
        return np.concatenate([values for values in (self.exact, self.found) if values is not None])


@dataclass(frozen=True)
class Panel:
    """A quantity, with one line for each value of a second parameter; its unit in TeX."""

    label: str
    lines: Sequence[Line]
    unit: str = ""


@dataclass(frozen=True)
class Parameter:
    """What numbers are drawn over.

    Attributes:
        label: of the axis.
        beside: another axis on top, its label and what the parameter is multiplied by; None for none.
        now: where a grey line stands; None for none.
    """

    label: str
    beside: tuple[str, float] | None = None
    now: float | None = None


@styled
def curves_figure(
    shown: Sequence[Panel], over: Parameter, ordered: bool = True, size: Size | None = None,
    exactly: str = "closed form",
) -> Figure:  # fmt: skip
    """Quantities over a parameter, a panel for each.

    Args:
        shown: what to draw.
        over: the parameter.
        ordered: the lines of a panel follow a number.
        size: of the figure.
        exactly: what gives the numbers that are not found by finite elements.
    """
    size = size or Size(COLUMN if len(shown) == 1 else PAGE)
    columns = max(1, min(2 if len(shown) == 4 else 3, len(shown), int(size.width / 2.2)))
    rows = -(-len(shown) // columns)
    styles = looks(len(shown[0].lines), ordered)
    lines = [handle(look, line.label) for look, line in zip(styles, shown[0].lines) if len(styles) > 1]
    every = [line for panel in shown for line in panel.lines]
    exact, found = (any(values is not None for values in some) for some in zip(*map(_methods, every)))
    legend = Legend([*lines, *of_methods(exact, found, exactly)], size.width)
    label = folded(over.label, int((size.width / columns - 0.5) / _LETTER))
    below = 0.29 + 0.13 * (1 + label.count("\n"))
    top = (0.2 if len(shown) > 1 else 0.08) + (0.3 if over.beside else 0.0)
    room = Room(0.7, 0.12, below + legend.height, top, 0.74, 0.2 + below)
    figure, axes = panels(rows, columns, size, 0.6 if columns == 2 else 0.8, room)
    for axis in axes.flat[len(shown) :]:
        axis.remove()
    tall = axes[0, 0].get_position().height * figure.get_figheight()
    for n, (axis, panel) in enumerate(zip(axes.flat, shown)):
        power = _draw(axis, panel, styles)
        axis.set_xlabel(label)
        axis.set_ylabel(folded(_with_unit(panel, power), int(1.1 * tall / _LETTER)))
        if over.now is not None:
            axis.axvline(over.now, color=GREY, linewidth=0.4, zorder=0)
        if over.beside and n < columns:
            _beside(axis, *over.beside)
    lettered(axes.flat[: len(shown)], above=True)
    legend.put(figure)
    return figure


def _methods(line: Line) -> tuple[NDArray | None, NDArray | None]:
    return line.exact, line.found


def _with_unit(panel: Panel, power: int) -> str:
    unit = rf"10^{{{power}}}\,{panel.unit}" if power else panel.unit
    return f"{panel.label} $[{unit}]$" if unit else panel.label


def _draw(axis: Axes, panel: Panel, styles: Sequence[Look]) -> int:
    """Draw the lines of a panel; the power of ten that its numbers are over."""
    numbers = np.concatenate([line.all for line in panel.lines])
    decades = _spans_decades(numbers)
    power = 0 if decades else _power(numbers)
    for line, look in zip(panel.lines, styles):
        both = line.exact is not None and line.found is not None
        for values, marked in ((line.exact, False), (line.found, True)):
            if values is None:
                continue
            joined = {"linestyle": "none"} if both and marked else {"linestyle": look.line}
            axis.plot(
                line.x, values / 10.0**power, color=look.colour, markerfacecolor="none",
                marker=look.marker if marked else "" if both else ".",
                linewidth=0.6 if marked else 1.0, **joined,
            )  # fmt: skip
    x = np.concatenate([line.x for line in panel.lines])
    if _spans_decades(x, _RATIOS) and _rather_by_ratios(x):
        axis.set_xscale("log")
    if decades:
        axis.set_yscale("log")
    elif np.nanmin(numbers) < 0.0 < np.nanmax(numbers):
        axis.axhline(0.0, color=GREY, linewidth=0.4, zorder=0)
    return power


def _power(values: NDArray) -> int:
    """Of ten, by which numbers are neither long nor short; a multiple of three."""
    largest = float(np.nanmax(np.abs(values)))
    if not largest or _SHORT <= largest < _LONG:
        return 0
    return 3 * floor(log10(largest) / 3.0)


def _spans_decades(values: NDArray, more_than: float = _DECADES) -> bool:
    some = values[np.isfinite(values)]
    return len(some) > 0 and some.min() > 0.0 and some.max() > more_than * some.min()


def _rather_by_ratios(x: NDArray) -> bool:
    """Does the middle number lie midway by ratios, rather than by differences?"""
    low, middle, high = np.quantile(np.unique(x[np.isfinite(x)]), (0.0, 0.5, 1.0))
    return bool(middle**2 < (low * high) ** 0.5 * (low + high) / 2.0)


def _beside(axis: Axes, label: str, factor: float) -> None:
    """The same numbers in another unit, along the top."""
    axis.tick_params(top=False)
    other = axis.secondary_xaxis("top", functions=(lambda x: factor * x, lambda x: x / factor))
    other.set_xlabel(label)
