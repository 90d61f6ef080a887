"""Displacement gradients at points inside."""

import tracemalloc

import numpy as np
import pytest
from support import small_punch, space_on

from galinx.meshes.rings import Refinement
from galinx.solvers.errors import MeshError
from galinx.solvers.fem import fields
from galinx.solvers.fem.fields import InteriorGradients, KeptValues
from galinx.solvers.fem.punch import SlidingPunch
from galinx.solvers.solids.isotropic import MovingFrame


def values_at(punch, points):
    """Gradients of all fields of a punch at points."""
    values = KeptValues(punch.space, punch.response, punch.fields)
    return InteriorGradients(punch.space, punch.response, values, points)


def test_a_point_outside_the_mesh_is_named():
    space = space_on("graded", Refinement(4, 0.5, 2, (1.0,) * 3), 2)
    punch = SlidingPunch(space, MovingFrame(2.0, 0.0))
    with pytest.raises(MeshError, match="X/a = 0, Y/a = -1e\\+06 lies outside"):
        values_at(punch, np.array([[0.0, -1.0], [0.0, -1e6]]))
    punch.destroy()


@pytest.fixture(scope="module")
def punch():
    made = small_punch()
    made.states([0.3, 0.6])
    yield made
    made.destroy()


@pytest.mark.parametrize("states", [1, 40])
def test_batches_of_points_give_the_same(punch, states, monkeypatch):
    """Those with fewer states than fields, and those with more."""
    random = np.random.default_rng(3)
    points = random.uniform([-2.0, -2.0], [2.0, -0.01], (50, 2))
    points = np.concatenate([points, [[0.0, -0.5]]])  # which lies between two cells
    weights = random.standard_normal((states, len(punch.fields)))
    whole = values_at(punch, points).of(weights)
    monkeypatch.setattr(fields, "TOGETHER", 7)
    gradients = values_at(punch, points)
    pieces = [*gradients.by_batches(weights)]
    assert [some.stop - some.start for some, _ in pieces] == [7] * 7 + [2]
    assert whole.shape == (states, 51, 2, 2)
    np.testing.assert_allclose(gradients.of(weights), whole, rtol=1e-10, atol=1e-10)


def test_many_points_are_not_held_for_every_field(punch):
    count = 60_000
    points = np.random.default_rng(3).uniform([-2.0, -2.0], [2.0, -0.01], (count, 2))
    fields, weights = punch.fields, np.ones((1, len(punch.fields)))
    tracemalloc.start()
    gradients = values_at(punch, points)
    for _ in gradients.by_batches(weights):
        pass
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    # Gradients of every field would be 32 bytes a field and point.
    assert len(fields) >= 10 and peak < 250 * count


def test_a_point_has_the_gradient_of_the_cell_that_it_lies_in():
    """Cells whose displacements are their numbers times the position, of which many are no rectangles."""
    space = space_on("graded", Refinement(4, 0.5, 2, (1.0,) * 3), 1)
    corners, numbers = space.vertices[..., :2], np.arange(1.0, space.cells + 1.0)

    def values(cells):
        return (numbers[cells, None, None] * corners[cells])[..., None]

    points = np.random.default_rng(4).uniform([-2.0, -2.0], [2.0, -0.01], (400, 2))
    found = InteriorGradients(space, MovingFrame(2.0, 0.0), values, points).of_fields()[..., 0]
    around = corners[:, [0, 1, 3, 2]] - points[:, None, None]
    turns = np.cross(around, np.roll(around, -1, axis=2))
    held = np.all(turns > 0.0, axis=2) | np.all(turns < 0.0, axis=2)
    assert (held.sum(axis=1) == 1).all()
    np.testing.assert_allclose(found, numbers[held.argmax(axis=1), None, None] * np.eye(2), atol=1e-9)
