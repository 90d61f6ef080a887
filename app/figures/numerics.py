"""Mesh and convergence of an archive's finite elements."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.meshes.kind import edges, nodes
from galinx.postprocess.quantities import Quantity, runs, states
from galinx.postprocess.quantities.quantity import FEM
from galinx.solvers.contact.fem_plan import FREE_ON_LAYERS

from ..plan.plan import make_plan
from .choice import Archive, Drawing
from .render import JOINED, MARKERS, Curve, Panel, Size, marked, render
from .sketches import mesh_figure
from .states import C, spread
from .style import COLUMN, LINES, looks

#: Speeds that can be told apart in a figure.
_SPEEDS = 6


def has_degrees(of: Archive) -> bool:
    """Return True if an archive holds how its numbers converge with the polynomial degree."""
    return of.has(runs.CHANGES, runs.RECORD["c"], runs.RECORD["degree"], states.ESTIMATE[FEM])


def mesh(of: Archive) -> Drawing:
    """Figure of the mesh that finite elements used; it is laid out again, nothing is solved."""
    data, fem = of.data, make_plan(of.scene).fem
    assert fem
    cells, degree = fem.drawn, int(data[runs.RECORD["degree"].path].max())
    if cells is None:
        cells = fem.kind.build(fem.refinement, fem.cuts)
    figure = mesh_figure(edges(fem.kind, cells), nodes(fem.kind, cells, degree), of.size)
    caption = (
        f"The {fem.mesh} mesh under the punch (orange) and, nearer and nearer, its edge X = a: lines are "
        f"the {len(cells.cells)} cells, dots the nodes of degree {degree} that carry the unknowns, "
        f"{(degree + 1) ** 2} in each cell; it is their density that sets the accuracy."
    )
    if fem.mode == FREE_ON_LAYERS:
        most = int(data[runs.RECORD["cells"].path].max())
        caption += (
            f" Here that of the contact at rest; meshes that follow contacts have up to {most} cells."
        )
    return Drawing("mesh", caption, figure, pixels=True)


def degrees(of: Archive) -> Drawing:
    """Figure of the convergence of K_I and of the pressure's moments with the polynomial degree."""
    data, labels = of.data, of.labels
    c, c_of, change = (data[row.path] for row in (runs.RECORD["c"], states.SPEED, runs.CHANGES))
    measured = np.flatnonzero(change.any(axis=1)).tolist()
    shown = spread(measured, _SPEEDS)

    def largest(row: Quantity, speed: float) -> float:
        return float(data[row.path][c_of == speed].max())

    # Speeds stand beside one another: their errors are nearly the same.
    aside = 0.16 * (np.arange(len(shown)) - (len(shown) - 1) / 2.0) / max(1, len(shown) - 1)
    curves: list[Curve] = []
    errors = [(states.ESTIMATE[FEM], "_")] + [(states.TRUE_ERROR, "x")] * of.has(states.TRUE_ERROR)
    for i, look, off in zip(shown, looks(len(shown), ordered=True), aside):
        computed = np.flatnonzero(change[i] > 0.0)
        label = labels.label(int(np.argmax(c_of == c[i])), [C]) if len(shown) > 1 else ""
        curves.append(Curve(computed, change[i][computed], look, label, JOINED))
        at = np.array([data[runs.RECORD["degree"].path][i] + off])
        for row, marker in errors:
            curves.append(
                Curve(at, np.array([largest(row, c[i])]), look._replace(marker=marker), "", MARKERS)
            )
    notes: list[Any] = [marked("estimated error", "_"), *[marked("true error", "x")] * (len(errors) - 1)]
    panel = Panel(
        "polynomial degree", "relative change or error of $K_I$", curves=curves, log="y", whole=True
    )
    caption = (
        "How K_I and the moments of the pressure settle as the polynomial degree rises: markers are "
        "changes from the degree before, bars the error estimated at the last, crosses the true one, "
        "which has to lie below."
    )
    left_out = f"{len(c) - len(shown)} of {len(c)} speeds not shown." if len(shown) < len(c) else ""
    figure = render([panel], of.size or Size(COLUMN), notes=notes, high=0.72)
    return Drawing("degrees", caption, figure, left_out=left_out)


def lines_figure(
    x: NDArray, lines: dict[str, NDArray], x_label: str, y_label: str, title: str, log_x: bool
) -> Any:
    """Figure of lines by label over x, the y axis logarithmic."""
    curves = [
        Curve(x, y, look._replace(line=LINES[0]), label, JOINED)
        for (label, y), look in zip(lines.items(), looks(len(lines)))
    ]
    return render([Panel(x_label, y_label, curves=curves, title=title, log="y" + "x" * log_x)], Size(5.0))
