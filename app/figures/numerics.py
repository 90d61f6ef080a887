"""Mesh and convergence of an archive's finite elements."""

import numpy as np
from matplotlib.figure import Figure

from galinx.meshes.kind import edges, nodes
from galinx.postprocess.quantities import runs, states
from galinx.postprocess.quantities.quantity import FEM
from galinx.solvers.contact.fem_plan import FREE_ON_LAYERS, FemPlan

from ..plan.plan import make_plan
from .choice import Archive, C, Drawing, fewer, spread
from .render import DOTS, JOINED, MARKERS, Curve, Panel, Size, note, render
from .style import COLOURS, COLUMN, GREY, Look, looks

#: Quantities that an archive has that tells how its numbers converge with the polynomial degree.
DEGREES = runs.CHANGES, runs.RECORD["c"], runs.RECORD["degree"], states.ESTIMATE[FEM]


def mesh(of: Archive) -> Drawing:
    """Figure of the mesh that finite elements used; it is laid out again, nothing is solved."""
    data, fem = of.data, make_plan(of.scene).fem
    assert fem
    degree = int(data[runs.RECORD["degree"].path].max())
    figure, cells = mesh_figure(fem, degree, of.choice.size)
    caption = (
        f"The {fem.mesh} mesh under the punch (black) and, nearer and nearer, its edge X = a: lines are "
        f"the {cells} cells, dots the nodes of degree {degree} that carry the unknowns, "
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
    data = of.data
    change, solved = data[runs.CHANGES.path], runs.states_of_speeds(data, len(of.scene.each))
    measured = np.flatnonzero(change.any(axis=1)).tolist()
    shown = spread(measured, 6)  # speeds that can be told apart
    first = [int(solved[i][0]) for i in shown]
    names = [name for name in of.varied(first) if name == C or "." in name]

    # Speeds stand beside one another: their errors are nearly the same.
    aside = 0.16 * (np.arange(len(shown)) - (len(shown) - 1) / 2.0) / max(1, len(shown) - 1)
    curves: list[Curve] = []
    # K_I is 0 at free ends, and its error no number for a logarithmic axis.
    exact = of.has(states.TRUE_ERROR) and bool(data[states.TRUE_ERROR.path].any())
    errors = [(states.ESTIMATE[FEM], "_")] + [(states.TRUE_ERROR, "x")] * exact
    for i, state, look, off in zip(shown, first, looks(len(shown), ordered=True), aside):
        computed = np.flatnonzero(change[i] > 0.0)
        label = of.label(state, names) if len(shown) > 1 else ""
        curves.append(Curve(computed, change[i][computed], look, label, JOINED))
        at = np.array([data[runs.RECORD["degree"].path][i] + off])
        for row, marker in errors:
            largest = data[row.path][solved[i]].max(keepdims=True)
            curves.append(Curve(at, largest, look._replace(marker=marker), "", MARKERS))
    words = "estimated error", "true error"
    notes = [note(Look(GREY, "-", m), word, MARKERS) for (_, m), word in zip(errors, words)]
    panel = Panel(
        "polynomial degree", f"relative change or error{' of $K_I$' * exact}", curves=curves, log="y",
        whole=True,
    )  # fmt: skip
    caption = (
        "How K_I and the moments of the pressure settle as the polynomial degree rises: markers are "
        "changes from the degree before, bars the error estimated at the last"
        f"{', crosses the true one, which has to lie below' * exact}."
    )
    figure = render([panel], of.choice.size or Size(COLUMN), notes=notes, high=0.72)
    return Drawing("degrees", caption, figure, left_out=fewer(len(shown), len(solved), "solutions"))


def mesh_figure(
    fem: FemPlan,
    degree: int = 0,
    size: Size | None = None,
    zooms: tuple[float, ...] = (4.0, 0.5, 0.01),
    first: str = "under the punch",
) -> tuple[Figure, int]:
    """Figure of a mesh below the punch, then nearer and nearer to the edge X = a; and its cells' number.

    Args:
        fem: plan of finite elements; the mesh is laid out again where the plan does not hold it.
        degree: polynomial degree whose nodes are drawn; 0 for none.
        size: of the figure.
        zooms: half-widths of the panels over a; the first is centred on the punch.
        first: title of that one.
    """
    cells = fem.kind.build(fem.refinement, fem.cuts) if fem.drawn is None else fem.drawn
    borders = edges(fem.kind, cells)
    unknowns = nodes(fem.kind, cells, degree) if degree else np.empty((0, 2))

    def panel(n: int, half: float) -> Panel:
        centre = (0.0 if n == 0 else 1.0, 0.0)
        # Coordinates from the panel's centre: far-away points would lose the picture's digits.
        lines, dots = borders - centre, unknowns - centre
        lines = lines[np.abs(lines).min(axis=1).max(axis=1) < 2.0 * half]
        x, y = (np.append(z, np.full((len(z), 1), np.nan), 1).ravel() for z in np.moveaxis(lines, -1, 0))
        # Nodes nearer to each other than a five-hundredth of a panel print as one.
        dots, step = dots[np.abs(dots).max(axis=1) < 1.5 * half], 2.0 * half / 500.0
        dots = np.unique(np.round(dots / step), axis=0) * step
        return Panel(
            "$X/a$" if n == 0 else "$X/a - 1$", "$Y/a$", xlim=(-half, half),
            ylim=(-1.18 * half, 0.06 * half),
            bar=(max(-1.0 - centre[0], -half), min(1.0 - centre[0], half)),
            curves=[
                Curve(x, y, Look("#555555", "-", ""), width=0.5),
                Curve(dots[:, 0], dots[:, 1], Look(COLOURS[0], "none", "."), form=DOTS, width=0.65),
            ],
            title=first if n == 0 else f"{zooms[0] / half:.0f} times larger",
        )  # fmt: skip

    # As high as their limits are: to scale.
    figure = render([panel(n, half) for n, half in enumerate(zooms)], size, high=0.62)
    return figure, len(cells.cells)
