"""Pressures made of linear pieces on one mesh, against their exact solution."""

import numpy as np
import pytest
from support import space_on

from galinx.meshes import MESHES, Requirements
from galinx.solvers import rays
from galinx.solvers.contact.prescribed_pressure import LinearPressure
from galinx.solvers.errors import MeshError
from galinx.solvers.fem.traction import LinearLoads, Pieces
from galinx.solvers.solids.isotropic import MovingFrame

FRAME = MovingFrame(2.0, 0.6)
#: A narrow piece beside wide ones, a knot where nothing kinks, a jump at one end.
KNOTS = np.array([-1.0, -0.3, 0.2, 0.2 + 1e-5, 0.7, 1.0])
VALUES = np.array([-1.0, -2.0, -1.0, -4.0, -2.0, 0.0])


@pytest.fixture(scope="module")
def loads():
    """The mesh of a tolerance of 1e-6, at a degree to which measured errors raise it there."""
    refinement = MESHES["confocal"].refinement(Requirements(1e-6, rays.NEAR, 1e7))
    return LinearLoads(space_on("confocal", refinement, 10), FRAME)


@pytest.fixture(scope="module")
def pressure():
    return LinearPressure(KNOTS, VALUES)


def strain(loads, X):
    """μ u,X of the pressure on the surface, of σ_YY and of σ_XY equal to it, (2, n)."""
    points = np.column_stack([X, np.zeros(len(X))])
    return Pieces(KNOTS, VALUES).gradients(loads, points)[:, 0, 0].T


def exact_strain(pressure, X):
    return np.array([FRAME.q * pressure(X), FRAME.m * pressure.hilbert(X)])


def test_the_pieces_are_the_pressure(loads, pressure):
    X = np.concatenate([np.linspace(-0.99, 0.99, 67), 1.0 + np.geomspace(1e-6, 4.0, 12)])
    found, exact = strain(loads, X), exact_strain(pressure, X)
    np.testing.assert_allclose(found, exact, atol=1e-6)
    assert Pieces(KNOTS, VALUES).resultant(loads) == pytest.approx(pressure.resultant, rel=1e-14)


@pytest.mark.parametrize("away", [0.0, 1e-300, 1e-15, 1e-12, -1e-12, 1e-9, -1e-9, 1e-7])
def test_at_knots_infinite_stresses_cancel(loads, pressure, away):
    X = KNOTS[1:-1] + away
    found, exact = strain(loads, X), exact_strain(pressure, X)
    np.testing.assert_allclose(found, exact, atol=2e-6)


@pytest.mark.parametrize("depth", [1e-14, 1e-12, 1e-9, 1e-6, 1e-3])
def test_below_knots_and_ends_too(loads, pressure, depth):
    points = np.column_stack([KNOTS, np.full(len(KNOTS), -depth)])
    basis = Pieces(KNOTS, VALUES).gradients(loads, points)
    found = FRAME.stresses(basis[..., 0] - 0.66 * basis[..., 1])
    exact = FRAME.inside(pressure, -0.66, *points.T)
    np.testing.assert_allclose(found, exact, atol=5e-6)


def test_a_point_beyond_the_mesh_is_told(loads):
    with pytest.raises(MeshError, match="lies outside the mesh"):
        loads.gradients(np.array([[1e16, 0.0]]))


def test_next_to_an_end_a_field_has_its_digits(loads):
    """1e-8 of the half-width from the end, where displacements alone would leave five digits."""
    x = 1e-8 * 2.0 ** np.arange(8)
    u_X = loads.gradients(np.column_stack([1.0 - x, np.zeros(8)]))[:, 0, 0, 3]
    single = LinearPressure(np.array([-1.0, 1.0]), np.array([0.0, 1.0])).hilbert(1.0 - x)
    np.testing.assert_allclose(u_X, FRAME.m * single, atol=2e-7)
