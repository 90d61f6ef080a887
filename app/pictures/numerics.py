"""Mesh and convergence of an archive's finite elements."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.meshes.kind import edges, nodes
from galinx.postprocess.figures.curves import degrees_figure
from galinx.postprocess.figures.sketches import mesh_figure
from galinx.postprocess.quantities import Quantity, runs, states
from galinx.solvers.contact.fem_plan import FREE_ON_LAYERS

from ..plan.plan import make_plan
from ..scene.scene import Scene
from .choice import Choice, Drawing, has_quantities
from .state_labels import C, StateLabels, spread

#: Speeds that can be distinguished in a figure.
_SPEEDS = 6


def has_degrees(data: dict[str, Any]) -> bool:
    """Return True if an archive holds how its numbers converge with the polynomial degree."""
    return has_quantities(data, runs.CHANGES, runs.RECORD["c"], runs.RECORD["degree"], states.ESTIMATE)


def mesh(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """Figure of the mesh that finite elements used; it is laid out again, nothing is solved."""
    fem = make_plan(scene).fem
    assert fem
    cells, degree = fem.drawn, int(data[runs.RECORD["degree"].path].max())
    if cells is None:
        cells = fem.kind.build(fem.refinement, fem.cuts)
    figure = mesh_figure(edges(fem.kind, cells), nodes(fem.kind, cells, degree), choice.size)
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


def degrees(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """Figure of the convergence of K_I and of the pressure's moments with the polynomial degree."""
    c, c_of, labels = data[runs.RECORD["c"].path], data[states.SPEED.path], StateLabels(data, scene)
    measured = np.flatnonzero(data[runs.CHANGES.path].any(axis=1)).tolist()
    shown = spread(measured, _SPEEDS)

    def largest(row: Quantity) -> NDArray:
        return np.array([data[row.path][c_of == speed].max() for speed in c[shown]])

    figure = degrees_figure(
        [labels.label(int(np.argmax(c_of == speed)), [C]) for speed in c[shown]],
        data[runs.CHANGES.path][shown],
        data[runs.RECORD["degree"].path][shown],
        largest(states.ESTIMATE),
        largest(states.TRUE_ERROR) if has_quantities(data, states.TRUE_ERROR) else None,
        choice.size,
    )
    caption = (
        "How K_I and the moments of the pressure settle as the polynomial degree rises: markers are "
        "changes from the degree before, bars the error estimated at the last, crosses the true one, "
        "which has to lie below."
    )
    left_out = f"{len(c) - len(shown)} of {len(c)} speeds not shown." if len(shown) < len(c) else ""
    return Drawing("degrees", caption, figure, left_out=left_out)
