"""Curves of single numbers of states over a parameter."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from galinx.postprocess.figures.canvas import Legend, Room, Size, handle, lettered, of_methods, panels
from galinx.postprocess.figures.style import COLUMN, GREY, PAGE, Look, looks, styled
from galinx.postprocess.figures.typeset import folded

#: Axes become logarithmic where numbers span more than this.
_DECADES = 200.0


@dataclass(frozen=True)
class Line:
    """Numbers over the parameter, in its order; methods without numbers have none.

    Attributes:
        label: names it in a legend.
        x: the parameter, (n,).
        exact, found: in closed form, and by finite elements, (n,).
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
    """A quantity, with one line for each value of a second parameter."""

    label: str
    lines: Sequence[Line]


@dataclass(frozen=True)
class Parameter:
    """What numbers are drawn over.

    Attributes:
        label: of the axis.
        beside: another axis on top, its label and what the parameter is multiplied by; None for none.
    """

    label: str
    beside: tuple[str, float] | None = None


@styled
def curves_figure(
    shown: Sequence[Panel], over: Parameter, ordered: bool = True, size: Size | None = None
) -> Figure:
    """Quantities over a parameter, a panel for each.

    Args:
        shown: what to draw.
        over: the parameter.
        ordered: the lines of a panel follow a number.
        size: of the figure.
    """
    size = size or Size(COLUMN if len(shown) == 1 else PAGE)
    columns = max(1, min(len(shown), 3, int(size.width / 2.2)))
    rows = -(-len(shown) // columns)
    first = shown[0].lines
    styles = looks(len(first), ordered)
    lines = [handle(look, line.label) for look, line in zip(styles, first) if len(first) > 1]
    every = [line for panel in shown for line in panel.lines]
    exact, found = (any(values is not None for values in some) for some in zip(*map(_methods, every)))
    legend = Legend([*lines, *of_methods(exact, found)], size.width)
    above = 0.3 if over.beside else 0.0
    room = Room(0.68, 0.12, 0.38 + legend.height, 0.2 + above, 0.68, 0.56 + above)
    figure, axes = panels(rows, columns, size, 0.8, room)
    for axis in axes.flat[len(shown) :]:
        axis.remove()
    tall = axes[0, 0].get_position().height * figure.get_figheight()
    for axis, panel in zip(axes.flat, shown):
        _draw(axis, panel, styles)
        axis.set_xlabel(over.label)
        axis.set_ylabel(folded(panel.label, int(tall / 0.058)))
        if over.beside:
            _beside(axis, *over.beside)
    lettered(axes.flat[: len(shown)])
    legend.put(figure)
    return figure


def _methods(line: Line) -> tuple[NDArray | None, NDArray | None]:
    return line.exact, line.found


def _draw(axis: Axes, panel: Panel, styles: Sequence[Look]) -> None:
    for line, look in zip(panel.lines, styles):
        both = line.exact is not None and line.found is not None
        for values, marked in ((line.exact, False), (line.found, True)):
            if values is None:
                continue
            drawn = "" if both and marked else look.line
            axis.plot(
                line.x, values, color=look.colour, linestyle=drawn or "none",
                marker=look.marker if marked else "." if not both else "", markerfacecolor="none",
            )  # fmt: skip
    if _spans_decades(np.concatenate([line.x for line in panel.lines])):
        axis.set_xscale("log")
    numbers = np.concatenate([line.all for line in panel.lines])
    if _spans_decades(numbers):
        axis.set_yscale("log")
    else:
        axis.ticklabel_format(axis="y", useMathText=True, scilimits=(-3, 4))
        if np.nanmin(numbers) < 0.0 < np.nanmax(numbers):
            axis.axhline(0.0, color=GREY, linewidth=0.4, zorder=0)


def _spans_decades(values: NDArray) -> bool:
    some = values[np.isfinite(values)]
    return len(some) > 0 and some.min() > 0.0 and some.max() > _DECADES * some.min()


def _beside(axis: Axes, label: str, factor: float) -> None:
    """The same numbers in another unit, along the top."""
    axis.tick_params(top=False)
    other = axis.secondary_xaxis("top", functions=(lambda x: factor * x, lambda x: x / factor))
    other.set_xlabel(label)
    axis.title.set_visible(True)
