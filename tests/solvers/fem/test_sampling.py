"""Whole fields of one state, sampled."""

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from scipy.spatial import cKDTree
from support import areas, space_on

from galinx.meshes.rings import Refinement
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.fem.export import sample
from galinx.solvers.fem.punch import SlidingPunch
from galinx.solvers.solids.isotropic import MovingFrame

κ, C, G, EXTENT = 2.0, 0.6, -0.66, 4.0


@pytest.fixture(scope="module", params=["confocal", "graded"])
def solved(request):
    """A punch and one of its states, on a mesh of the given kind."""
    refinement = Refinement(8, 0.35, 3, (1.0, 2.0, 3.0, 3.0, 3.0, 3.0))
    punch = SlidingPunch(space_on(request.param, refinement, 7), MovingFrame(κ, C))
    yield punch, punch.states(G)
    punch.destroy()


def sampled(solved, n=7, extent=EXTENT):
    punch, states = solved
    return sample(punch.space, MovingFrame(κ, C), punch.fields, states.weights[0], extent, n)


def test_quadrilaterals_tile_the_part_asked_for(solved):
    found = sampled(solved, n=5)
    area = areas(found.points, found.quads)
    assert area.min() >= 0.0  # counterclockwise
    # All of it, and nothing else: quadrilaterals that reach further are cut.
    assert area.sum() == pytest.approx(2.0 * EXTENT**2, rel=1e-9)
    assert np.abs(found.points).max() <= EXTENT * (1.0 + 1e-12)
    assert found.points[:, 1].max() <= 0.0
    np.testing.assert_array_equal(np.unique(found.quads), np.arange(len(found.points)))


def test_the_displacement_is_continuous_and_that_of_the_closed_form(solved):
    _, states = solved
    found = sampled(solved)
    X, Y = found.points.T
    near, at = cKDTree(found.points).query(found.points, k=2)
    same = near[:, 1] < 1e-12
    jump = np.abs(found.displacement[same] - found.displacement[at[same, 1]]).max()
    assert same.sum() > 500 and jump <= 1e-9 * np.abs(found.displacement).max()
    surface = Y > -1e-12
    under = surface & (np.abs(X) <= 1.0)
    np.testing.assert_allclose(found.displacement[under, 1], -states.v0[0], rtol=1e-9)
    # Beside the punch v is the integral of the exact slope.
    beside = np.flatnonzero(surface & (np.abs(X - 2.5) < 1.4))
    beside = beside[np.argsort(X[beside])]
    frame = MovingFrame(κ, C)
    t, w = leggauss(60)
    start, half = X[beside[0]], (X[beside] - X[beside[0]])[:, None] / 2.0
    slopes = frame.n * FlatPunch(frame, G).hilbert(start + half * (1.0 + t))
    rise = (slopes * w * half).sum(axis=1)
    v = found.displacement[beside, 1]
    assert len(beside) >= 10
    np.testing.assert_allclose(v - v[0], rise, atol=1e-3 * np.abs(rise).max())
