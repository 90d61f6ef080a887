"""Curves of numbers: of states over a parameter, errors, angles, waves, and oscillating loads.

Lines over an axis show errors and whatever else spans decades. Polar curves show numbers over the angle
of a solid. Dispersion curves show how fast waves along layers run, over how short they are; response
curves show stiffness and damping of a punch under loads that oscillate, over frequency.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import floor, log10

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from .canvas import (
    Legend,
    Room,
    Size,
    TooSmall,
    handle,
    lettered,
    of_methods,
    panels,
)
from .style import COLUMN, GREY, PAGE, SMALL, Look, folded, looks, styled

#: Axes become logarithmic where numbers span more than this; that of the parameter where it spans more
#: than that, by steps that are equal ratios rather than differences.
_DECADES, _RATIOS = 200.0, 30.0

#: Numbers beyond these have a power of ten beside their unit.
_SHORT, _LONG = 1e-2, 1e4

#: Approximate width of an axis's letter [in].
_LETTER = 0.055


@dataclass(frozen=True)
class Line:
    """Numbers over the parameter, in its order; a method without numbers is None.

    Attributes:
        label: its name in a legend.
        x: the parameter, (n,).
        exact: numbers of the other methods, (n,).
        found: numbers of finite elements, (n,).
    """

    label: str
    x: NDArray
    exact: NDArray | None = None
    found: NDArray | None = None

    @property
    def all(self) -> NDArray:
        """All its numbers, of whichever method, (m,)."""
        return np.concatenate([values for values in (self.exact, self.found) if values is not None])


@dataclass(frozen=True)
class Panel:
    """Panel of a quantity, with one line for each value of a second parameter; its unit in TeX."""

    label: str
    lines: Sequence[Line]
    unit: str = ""


@dataclass(frozen=True)
class Parameter:
    """Parameter over which numbers are drawn.

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
        exactly: name of the method of the numbers that are not of finite elements.
    """
    size = size or Size(COLUMN if len(shown) == 1 else PAGE)
    columns = max(1, min(2 if len(shown) == 4 else 3, len(shown), int(size.width / 2.2)))
    rows = -(-len(shown) // columns)
    styles = looks(len(shown[0].lines), ordered)
    lines = [handle(look, line.label) for look, line in zip(styles, shown[0].lines) if len(styles) > 1]
    every = [line for panel in shown for line in panel.lines]
    exact, fem = (any(values is not None for values in of_all) for of_all in zip(*map(_methods, every)))
    legend = Legend([*lines, *of_methods(exact, fem, exactly)], size.width)
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
    """Draw the lines of a panel; return the power of ten that its numbers are over."""
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
    """Power of ten over which numbers are neither long nor short; a multiple of three."""
    largest = float(np.nanmax(np.abs(values)))
    if not largest or _SHORT <= largest < _LONG:
        return 0
    return 3 * floor(log10(largest) / 3.0)


def _spans_decades(values: NDArray, more_than: float = _DECADES) -> bool:
    finite = values[np.isfinite(values)]
    return len(finite) > 0 and finite.min() > 0.0 and finite.max() > more_than * finite.min()


def _rather_by_ratios(x: NDArray) -> bool:
    """True where the middle number lies midway by ratios, rather than by differences."""
    low, middle, high = np.quantile(np.unique(x[np.isfinite(x)]), (0.0, 0.5, 1.0))
    return bool(middle**2 < (low * high) ** 0.5 * (low + high) / 2.0)


def _beside(axis: Axes, label: str, factor: float) -> None:
    """Add an axis along the top, with the numbers in another unit."""
    axis.tick_params(top=False)
    other = axis.secondary_xaxis("top", functions=(lambda x: factor * x, lambda x: x / factor))
    other.set_xlabel(label)


@styled
def lines_figure(
    x: NDArray, lines: dict[str, NDArray], x_label: str, y_label: str, title: str, log_x: bool
) -> Figure:
    """Figure of lines by label over x, the y axis logarithmic."""
    styles = looks(len(lines))
    legend = Legend([handle(look, label) for look, label in zip(styles, lines)], 5.0)
    figure, axes = panels(1, 1, Size(5.0), 0.65, Room(0.62, 0.1, 0.43 + legend.height, 0.22))
    axis = axes[0, 0]
    for y, look in zip(lines.values(), styles):
        axis.plot(x, y, color=look.colour, linestyle=look.line, marker=look.marker)
    axis.set(yscale="log", xlabel=x_label, ylabel=y_label, title=title)
    if log_x:
        axis.set_xscale("log")
    legend.put(figure)
    return figure


@styled
def degrees_figure(
    labels: list[str],
    change: NDArray,
    degree: NDArray,
    estimate: NDArray,
    true_error: NDArray | None,
    size: Size | None = None,
) -> Figure:
    """Figure of the numbers' convergence with the polynomial degree, by speed.

    Args:
        labels: of the speeds, n.
        change: largest relative change of K_I and moments from the degree before, by degree; 0 where
            not computed, (n, degrees).
        degree: the one whose numbers are archived, (n,).
        estimate, true_error: largest of each speed's states, relative, (n,).
        size: of the figure.
    """
    size, styles = size or Size(COLUMN), looks(len(labels), ordered=True)
    handles = [handle(look, label, marker=look.marker) for look, label in zip(styles, labels)]
    handles.append(
        Line2D([], [], color=GREY, marker="_", markersize=9, linestyle="none", label="estimated error")
    )
    if true_error is not None:
        handles.append(Line2D([], [], color=GREY, marker="x", linestyle="none", label="true error"))
    legend = Legend(handles, size.width)
    figure, axes = panels(1, 1, size, 0.72, Room(0.62, 0.1, 0.43 + legend.height, 0.1))
    axis = axes[0, 0]
    # Speeds stand beside one another: their errors are nearly the same.
    aside = 0.16 * (np.arange(len(labels)) - (len(labels) - 1) / 2.0) / max(1, len(labels) - 1)
    for n, look in enumerate(styles):
        computed = np.flatnonzero(change[n] > 0.0)
        axis.plot(
            computed, change[n][computed], color=look.colour, linestyle=look.line, marker=look.marker
        )
        at = degree[n] + aside[n]
        axis.plot(at, estimate[n], "_", color=look.colour, markersize=9, markeredgewidth=1.2)
        if true_error is not None:
            axis.plot(at, true_error[n], "x", color=look.colour, markersize=4)
    axis.set(yscale="log", xlabel="polynomial degree", ylabel="relative change or error of $K_I$")
    axis.xaxis.get_major_locator().set_params(integer=True)
    axis.margins(x=0.12)
    legend.put(figure)
    return figure


#: Least width of a panel [in], and heights of the space above and below panels.
_LEAST, _ABOVE, _BELOW = 1.6, 0.45, 0.25


@dataclass(frozen=True)
class PolarPanel:
    """Panel of curves over an angle with one radius.

    Attributes:
        title: what the radius is, with its unit.
        curves: values at the angles by label, each (angles,); NaN where there is none.
    """

    title: str
    curves: dict[str, NDArray]


@styled
def polar_figure(
    angles: NDArray, shown: Sequence[PolarPanel], now: float, size: Size | None = None
) -> Figure:
    """Panels side by side, in rows where the figure is narrow; radii begin at 0.

    Args:
        angles: of the solid's axis from X [°], (n,).
        shown: the panels.
        now: an angle that is marked [°].
        size: of the figure.

    Raises:
        TooSmall: it does not fit.
    """
    size = size or Size(PAGE)
    if size.width < _LEAST:
        raise TooSmall(f"expected at least {_LEAST} in of width")
    columns = min(len(shown), int(size.width / _LEAST))
    columns = -(-len(shown) // -(-len(shown) // columns))  # as even as rows can be
    rows = -(-len(shown) // columns)
    legends = [Legend(_entries(panel), size.width / columns) for panel in shown]
    below = max(legend.height for legend in legends) + _BELOW
    circle = 0.72 * size.width / columns
    height = size.height or rows * (circle + _ABOVE + below)
    figure = Figure((size.width, height))
    FigureCanvasAgg(figure)
    place = {"left": 0.06, "right": 0.94, "bottom": below / height, "top": 1.0 - _ABOVE / height}
    between = (_ABOVE + below) / max(height / rows - _ABOVE - below, 0.1)
    every = figure.subplots(
        rows, columns, squeeze=False, subplot_kw={"projection": "polar"},
        gridspec_kw=place | {"wspace": 0.4, "hspace": between},
    ).ravel()  # fmt: skip
    axes = every[: len(shown)]
    for axis in every[len(shown) :]:
        axis.remove()
    φ = np.deg2rad(angles)
    for axis, panel in zip(axes, shown):
        for (_, values), look in zip(panel.curves.items(), looks(len(panel.curves))):
            axis.plot(φ, values, color=look.colour, linestyle=look.line)
        largest = max(np.nanmax(values, initial=0.0) for values in panel.curves.values())
        axis.set_rlim(0.0, 1.2 * largest if largest > 0.0 else 1.0)
        # None at the rim, where the angles' own numbers are.
        axis.yaxis.set_major_locator(MaxNLocator(3, prune="both"))
        axis.plot(np.deg2rad([now, now]), axis.get_ylim(), color=GREY, linewidth=0.5)
        axis.set_thetagrids(range(0, 360, 30))
        axis.tick_params(labelsize=SMALL, pad=0.5)
        axis.set_rlabel_position(45.0)
        if len(panel.curves) > 1:
            axis.legend(
                handles=_entries(panel), loc="upper center", bbox_to_anchor=(0.5, -0.12), fontsize=SMALL,
                labelspacing=0.2, borderaxespad=0.0,
            )  # fmt: skip
    lettered(axes, [panel.title for panel in shown], above=True)
    return figure


def _entries(panel: PolarPanel) -> list:
    if len(panel.curves) == 1:
        return []
    return [handle(look, label) for label, look in zip(panel.curves, looks(len(panel.curves)))]


@styled
def dispersion_figure(
    kH: NDArray, speed: NDArray, limit: float, ends: tuple[float, float], size: Size | None = None
) -> Figure:
    """Figure of the slowest wave's speed, the highest speed of a punch, and limits at both ends.

    Args:
        kH: wavenumber times the thickness of all layers, (n,).
        speed: of the slowest wave [m/s], NaN for none, (n,).
        limit: highest speed of a punch [m/s].
        ends: speeds of the waves along the substrate and the surface's solid alone [m/s].
        size: of the figure.
    """
    size = size or Size(COLUMN)
    figure, axes = panels(1, 1, size, 0.72, Room(0.62, 0.1, 0.48, 0.1))
    axis, (look, *_) = axes[0, 0], looks(1)
    axis.plot(kH, speed, color=look.colour, linestyle=look.line)
    axis.axhline(limit, color=GREY, linewidth=0.7, linestyle="--")
    for x, y in zip((kH[0], kH[-1]), ends):
        axis.plot([x], [y], marker="o", color=look.colour, markerfacecolor="none", clip_on=False)
    axis.set(xscale="log", xlabel="wavenumber $kH$", ylabel="speed [m/s]", xlim=(kH[0], kH[-1]))
    axis.margins(y=0.1)
    return figure


_LABELS = (
    r"stiffness $\mathrm{Re}\,(\hat N/\hat v_0)/2\mu$",
    r"damping $\mathrm{Im}\,(\hat N/\hat v_0)/2\mu\;/\;(\omega a/c_s)$",
)


@dataclass(frozen=True)
class Curve:
    """Response of a speed with a friction.

    Attributes:
        label: its name in a legend.
        ω: angular frequencies over c_s/a, (n,).
        parts: real part of N̂/v̂₀ over 2μ, and its imaginary part over that and ω, (2, n).
        plane_waves: limit of the latter at high frequencies.
    """

    label: str
    ω: NDArray
    parts: NDArray
    plane_waves: float


@styled
def response_figure(curves: Sequence[Curve], size: Size | None = None) -> Figure:
    """Figure of stiffness and damping over frequency.

    Args:
        curves: what to draw.
        size: of the figure.
    """
    size = size or Size(PAGE)
    styles = looks(len(curves))
    legend = Legend([handle(look, curve.label) for look, curve in zip(styles, curves)], size.width)
    wide = size.width > 4.5
    room = Room(0.6, 0.1, 0.42 + legend.height, 0.2, 0.65, 0.5)
    figure, axes = panels(1 if wide else 2, 2 if wide else 1, size, 0.72, room)
    for n, (axis, label) in enumerate(zip(axes.flat, _LABELS)):
        for look, curve in zip(styles, curves):
            axis.plot(curve.ω, curve.parts[n], color=look.colour, linestyle=look.line)
            if n == 1:
                axis.axhline(
                    curve.plane_waves, color=look.colour, linewidth=0.5, linestyle="--", zorder=0
                )
        ends = curves[0].ω[0], curves[0].ω[-1]
        axis.set(xscale="log", xlabel=r"frequency $\omega a/c_s$", ylabel=label, xlim=ends)
    lettered(axes.flat)
    legend.put(figure)
    return figure
