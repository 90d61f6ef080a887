"""Cells that are another one moved and scaled share its matrix, and no others do."""

import numpy as np
import pytest
from mpi4py import MPI

from galinx.meshes.charts import Physical
from galinx.meshes.kind import Requirements
from galinx.meshes.layered import OnLayers
from galinx.solvers.fem import space as spaces
from galinx.solvers.fem.cells import congruent_cells, model_cells
from galinx.solvers.fem.space import Space, distribute
from galinx.solvers.layers.layered import Layer, Layered
from galinx.solvers.solids import Isotropic

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [0.1, 1.0], [1.0, 1.2]])


def cells(*moved):
    return np.array([size * SQUARE + [x, y] for size, x, y in moved])


def test_what_differs_stands_alone():
    corners = cells(*[(1.0, 0.0, 0.0)] * 5)
    corners[1, 3, 0] += 1e-9  # less than digits by which they are looked for
    corners[2] = corners[2] * [1.0, 2.0]
    corners[3] = corners[3] * [-1.0, 1.0]  # its mirror image
    models, like = congruent_cells(corners, np.array([0, 0, 0, 0, 7]))
    assert len(models) == 5 and len(set(like)) == 5


def test_digits_that_a_small_cell_cannot_have_are_not_asked_of_it():
    """At 1 a double has sixteen digits, of a cell of 1e-10 six."""
    for off, count in ((1e-15, 1), (1e-12, 2)):
        corners = cells((1.0, 5.0, 0.0), (1e-10, 1.0, 0.0))
        corners[1, 2, 0] += off
        assert len(congruent_cells(corners, np.zeros(2, dtype=int))[0]) == count


STEEL, SOFT = (Isotropic(E, ν, 1.0) for E, ν in ((2.5, 0.25), (1.0, 0.4)))
TO_SOFT = Layered((Layer(1.0, STEEL, SOFT),), SOFT)
COATED = Layered((Layer(1.0, SOFT),), STEEL)


@pytest.mark.parametrize("solid, fewer", [(COATED, 3.0), (TO_SOFT, 1.2)], ids=["coating", "graded"])
def test_the_matrix_is_that_of_each_cell_by_itself(solid, fewer, monkeypatch):
    """Of a graded layer only cells below it have others that are like them."""
    response = solid.response(0.2)
    mesh = OnLayers(depths=(1.0,)).drawn(Requirements(1e-6, nearest=1e-2))
    space = Space(*distribute(mesh, MPI.COMM_SELF), Physical(), 5, solid.form)
    models, members = model_cells(space.vertices, response, space.form.constants)
    assert sorted(np.concatenate(members)) == list(range(space.cells))
    assert space.cells > fewer * len(models)
    A = space.assemble(response)
    each = np.arange(space.cells)[:, None]
    monkeypatch.setattr(spaces, "model_cells", lambda *_: (space.vertices, each))
    B = space.assemble(response)
    size = B.norm()
    B.axpy(-1.0, A)
    assert B.norm() < 1e-11 * size
