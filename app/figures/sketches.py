"""Sketches: the problem, and the way from friction to stresses."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from .render import arrow
from .style import COLOURS, GREY, PAGE, SMALL, TEXT, styled

_BLUE, _ORANGE, _GREEN = COLOURS[:3]


def _blank(width: float, height: float) -> tuple[Figure, Axes]:
    """Figure without axes whose unit is an inch."""
    figure = Figure((width, height))
    FigureCanvasAgg(figure)
    axis = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axis.set(xlim=(0.0, width), ylim=(0.0, height))
    axis.set_axis_off()
    return figure, axis


@styled
def problem_figure() -> Figure:
    """Figure of a rigid flat punch that slides over a half-plane: loads, axes, ends, speed."""
    figure, axis = _blank(5.0, 2.1)
    X, Y, a = 2.5, 0.92, 0.85
    # The half-plane, which has no end: its lower edge is a broken line.
    depth = Y - 0.78 - 0.06 * np.sin(np.linspace(0.0, 9.0 * np.pi, 200))
    across = np.linspace(0.25, 4.75, 200)
    axis.fill_between(across, depth, Y, color="#E6E6E6", linewidth=0.0)
    axis.plot([0.25, 4.75], [Y, Y], color="black", linewidth=0.8)
    axis.add_patch(
        Rectangle((X - a, Y), 2.0 * a, 0.62, facecolor="#BFBFBF", edgecolor="black", linewidth=0.8)
    )
    axis.text(X - a + 0.08, Y + 0.46, "rigid punch", fontsize=SMALL, va="center")
    axis.text(0.4, Y - 0.58, r"half-plane: $E$, $\nu$, $\rho$", va="center")
    # Loads, per depth.
    arrow(axis, (X, Y + 1.12), (X, Y + 0.62), _BLUE)
    axis.text(X + 0.07, Y + 0.98, "$N$", color=_BLUE, va="center")
    arrow(axis, (X + a, Y + 0.3), (X + a + 0.5, Y + 0.3), _BLUE)
    axis.text(X + a + 0.55, Y + 0.3, "$F = f N$", color=_BLUE, va="center")
    arrow(axis, (X - a - 0.75, Y + 0.78), (X - a - 0.1, Y + 0.78), _ORANGE)
    axis.text(X - a - 0.8, Y + 0.78, "$V$", color=_ORANGE, va="center", ha="right")
    axis.text(
        X - a - 0.1, Y + 0.62, "forward (FM)", color=_ORANGE, va="center", ha="right", fontsize=SMALL
    )  # fmt: skip
    # Tractions of the punch on the surface: friction drags it along.
    for at in np.linspace(X - 0.75 * a, X + 0.55 * a, 4):
        arrow(axis, (at, Y - 0.09), (at + 0.2, Y - 0.09), _GREEN)
    axis.text(X + a + 0.08, Y - 0.14, r"$\sigma_{XY} = -f\,\sigma_{YY} > 0$", color=_GREEN, va="center")
    # Axes, which move along, and the ends.
    arrow(axis, (X, Y), (X, Y + 0.42))
    axis.text(X + 0.06, Y + 0.36, "$Y$", va="center")
    arrow(axis, (4.2, Y), (4.75, Y))
    axis.text(4.7, Y + 0.11, "$X = x - V t$", va="center", ha="right")
    for end, name in ((-1.0, "trailing end\n$X = -a$"), (1.0, "leading end\n$X = a$")):
        axis.plot([X + end * a] * 2, [Y - 0.06, Y], color="black", linewidth=0.8)
        axis.text(X + end * a, Y - 0.24, name, ha="center", va="top", fontsize=SMALL, linespacing=1.1)
    return figure


#: Boxes of the procedure: middle and width [in], colour, lines.
_BOXES = {
    "motion": (0.75, 1.3, GREY, ("motion", "$X/L$ along", "FM1, BM1, FM2;", "speed $V$, $c = V/c_s$")),
    "friction": (
        2.4, 1.45, _ORANGE, ("Dahl's law (2–5)", "by its solution or", "Runge–Kutta (46–51)", "$f = F/N$")
    ),
    "exact": (
        4.2, 1.65, _BLUE,
        ("integral equation (30)", "closed form (38–43)", "response at $c$", r"$\alpha$, $\beta$"),
    ),
    "fem": (
        4.2, 1.65, _GREEN,
        ("finite elements", "weak form of (15, 16)", "friction under the punch", "pressure unknown"),
    ),
    "stresses": (
        5.95, 1.35, "black",
        ("contact stress (55)", "in-plane stress (32)", "$K_I$ (56–58)", "compared"),
    ),
}  # fmt: skip


@styled
def procedure_figure() -> Figure:
    """Figure of the way from Dahl's friction to stresses, by both methods; numbers are the study's."""
    figure, axis = _blank(PAGE, 2.1)
    places = {"exact": 1.55, "fem": 0.55}
    high = 0.8
    for name, (x, width, colour, words) in _BOXES.items():
        y = places.setdefault(name, 1.05)
        corner = x - width / 2.0, y - high / 2.0
        axis.add_patch(Rectangle(corner, width, high, facecolor="white", edgecolor=colour))
        axis.text(x, y, "\n".join(words), ha="center", va="center", fontsize=TEXT, linespacing=1.15)

    def side(name: str, end: float) -> tuple[float, float]:
        x, width, *_ = _BOXES[name]
        return x + end * width / 2.0, places[name]

    arrow(axis, side("motion", 1.0), side("friction", -1.0))
    for method in ("exact", "fem"):
        arrow(axis, side("friction", 1.0), side(method, -1.0))
        arrow(axis, side(method, 1.0), side("stresses", -1.0))
    return figure
