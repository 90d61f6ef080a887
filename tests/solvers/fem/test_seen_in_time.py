"""Energies, strains and pressures of motions in time where they are known, and their balance."""

import numpy as np
import pytest
from starts import SOLID, motion

from galinx.meshes.waves import Reached
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.fem.dynamic import BOX, Energies, of_both
from galinx.solvers.fem.in_time import SlidingInTime, SurfaceInTime
from galinx.solvers.layers.layered import Layer, Layered
from galinx.solvers.solids.admittance import Admittance
from galinx.solvers.solids.isotropic import Isotropic
from galinx.solvers.transient.history import Way, smooth
from galinx.solvers.transient.punch import ON_SURFACE

#: A mesh of 4.3 a to either side and 3.1 a below.
NEAR = Reached(4.3, 3.1, 1.0, 0.3, 1e-2)


@pytest.fixture(scope="module")
def moving():
    return motion(SOLID, 0.5, NEAR)


@pytest.mark.parametrize("sharp", [False, True])
@pytest.mark.parametrize(
    "solid", [SOLID, Layered((Layer(0.7, Isotropic(3.0, 0.1, 2.0)),), SOLID)], ids=["uniform", "layer"]
)
def test_products_by_quadrature_are_those_of_the_matrices(solid, sharp):
    mesh = Reached(4.3, 3.1, 1.0, 0.3, 1e-2, depths=(0.7,), finest=0.5, around=(2.0, 1.0))
    of = motion(solid, 0.5, mesh, 5, sharp)
    u = np.random.default_rng(0).normal(size=of.size)
    for product, expected in (
        (of.stiffness(u), of.K @ u),
        (of.momentum(u), of_both(of.M, u)),
        (of.dissipation(u), u @ of_both(of.D, u)),
    ):
        np.testing.assert_allclose(product, expected, atol=1e-13 * np.abs(expected).max())


def test_energies_in_the_box_of_a_field_that_is_known(moving):
    """Its sides cut cells; where all is strained alike its energy is by its area."""
    X, Y = moving.space.coordinates.T
    u = np.column_stack([0.3 * X + 0.1 * Y, -0.2 * Y]).ravel()
    w = np.column_stack([0.7 + 0.0 * X, Y]).ravel()
    strain, kinetic, *_ = Energies(moving)(u, w, 1)
    λ, area = 1.0, 2.0 * BOX[0] * BOX[1]
    density = 0.3**2 + 0.2**2 + 0.1**2 / 2.0 + λ * (0.3 - 0.2) ** 2 / 2.0
    assert strain == pytest.approx(density * area, rel=1e-12)
    expected = (0.7 - 0.5 * 0.3) ** 2 / 2.0 * area + BOX[0] * BOX[1] ** 3 / 3.0
    assert kinetic == pytest.approx(expected, rel=1e-12)


def test_work_of_a_random_motion_is_its_energy():
    """All that the punch does on the solid, which is strained and moves, or was absorbed."""
    random = np.random.default_rng(4)
    solid = Isotropic(1.0, random.uniform(0.0, 0.4), 1.0)
    c, (f, more) = random.uniform(0.2, 0.8) * solid.limit(), random.uniform(0.0, 0.6, 2)
    fast, T = Admittance.of(solid.response(c)).fastest, 3.0
    mesh = Reached(3.0 + fast * T / 2.0, 1.0 + fast * T / 2.0, 1.0, 0.15, 1e-4)
    of = motion(solid, c, mesh, 7)
    solver = SlidingInTime(of)
    run = solver.run(
        [Way(1, T, 15)], lambda t: -f - more * np.sin(t) ** 2, lambda t: float(smooth(t, 2.5)),
        watching=[Energies(of)],
    )  # fmt: skip
    solver.destroy()
    watched = run.watched[0] - run.watched[0][0]
    done = run.work_of_load + run.work_of_friction + c * watched[1:, 4]
    held = watched[1:, 2] + watched[1:, 3] + run.absorbed
    assert np.abs(done - held).max() < 1e-4 * np.abs(done).max()
    assert 0.1 * done[-1] < watched[-1, 0] + watched[-1, 1] < 0.95 * held[-1]


def test_energy_is_kept_where_the_punch_turns_round():
    """The solid goes on as it did, only the velocities seen from the punch jump; waves are sharp then."""
    c = 0.5
    of = motion(SOLID, c, Reached(4.6, 2.6, 0.5, 0.3, 1e-3, 0.0, 0.5), 6, sharp=True)
    ways = [Way(1, 1.0, 8), Way(-1, 0.25, 8), Way(-1, 0.25, 2)]
    solver = SlidingInTime(of)
    run = solver.run(
        ways, lambda t: -0.4 if t < 1.0 + 1e-9 else 0.4, lambda t: float(smooth(t, 1.0)),
        watching=[Energies(of)],
    )  # fmt: skip
    solver.destroy()
    watched = run.watched[0]
    V = c * np.repeat([way.direction for way in ways], [way.steps for way in ways])
    done = run.work_of_load + run.work_of_friction + np.cumsum(V * np.diff(watched[:, 4]))
    left = np.abs(done - watched[1:, 2] - watched[1:, 3] - run.absorbed)
    assert left[:8].max() < 1e-4 * done[7]
    assert left.max() < 5e-3 * np.abs(done).max()


def test_surface_of_steady_motion():
    """Held 1000 a away; by the closed form further than 0.01 a from the edges."""
    c, g = 0.5, -0.5
    of = motion(SOLID, c, Reached(3.0, 2.0, 1.0, 0.5, 1e-3, 1000.0), 7)
    solver, along = SlidingInTime(of), SurfaceInTime(of, ON_SURFACE)
    run = solver.run(
        [Way(1, 0.2, 2)], lambda t: g, lambda t: 1.0, True, [lambda u, w, way: along.strain(u)]
    )
    solver.destroy()
    exact = FlatPunch(of.response, g)
    σ_YY = along.pressure(run.forces[-1], exact.α, exact.β)
    σ_XX = of.response.σ_XX(run.watched[0][-1], σ_YY, g * σ_YY)
    far = np.abs(np.abs(ON_SURFACE) - 1.0) > 0.01
    for found, expected in ((σ_YY, exact.σ_YY(ON_SURFACE)), (σ_XX, exact.σ_XX(ON_SURFACE))):
        assert np.abs(found - expected)[far].max() < 1e-3 * np.abs(expected[far]).max()
