"""A punch on a mesh: rates of convergence, refinement of its solutions."""

import numpy as np
import pytest
from scipy.special import eval_chebyt
from support import small_punch, space_on

from galinx.meshes.rings import Refinement
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.fem import punch as punch_module
from galinx.solvers.fem.punch import SlidingPunch
from galinx.solvers.solids.isotropic import MovingFrame


def moment_error(mesh, refinement, degree, c=0.6, g=0.66):
    """Largest error of the pressure's first six Chebyshev moments over N."""
    space = space_on(mesh, refinement, degree)
    solver = SlidingPunch(space, MovingFrame(2.0, c))
    state = solver.states(g)
    X = space.chart.surface_position(space.contact.s)
    exact = FlatPunch(MovingFrame(2.0, c), g)
    t, w = np.polynomial.legendre.leggauss(200)
    τ, w = (t + 1.0) / 2.0, w / 2.0
    near, stretch = τ**8, 8.0 * τ**7
    errors = []
    for n in range(6):
        moment = np.sum(w * stretch * exact.traction(near, 2.0 - near) * eval_chebyt(n, near - 1.0))
        moment += np.sum(w * stretch * exact.traction(2.0 - near, near) * eval_chebyt(n, 1.0 - near))
        errors.append(abs(state.normal[0] @ eval_chebyt(n, X) - moment) / 2.0)
    solver.destroy()
    return max(errors)


def test_exponential_convergence_in_the_degree():
    refinement = Refinement(8, 0.35, 2, (3.0,) * 7)
    degrees = np.arange(3, 8)
    errors = [moment_error("confocal", refinement, p) for p in degrees]
    decades_a_degree = -np.polyfit(degrees, np.log10(errors), 1)[0]
    assert decades_a_degree > 0.9
    assert errors[-1] < 1e-7


def test_convergence_in_the_grading():
    """The energy in the innermost ring, of radius ρ, goes as ρ^(2 + 2α), α = -1/2 without friction."""
    ratio, levels = 0.5, np.array([3, 4, 5, 6])
    columns = (1.0,) * 15
    errors = [moment_error("graded", Refinement(n, ratio, 2, columns), 6, g=0.0) for n in levels]
    expected = 2.0 * (2.0 + 2.0 * -0.5)  # a ring of size s in (ξ, η) has the radius s²/2
    rate = np.polyfit(levels * np.log(ratio), np.log(errors), 1)[0]
    assert rate == pytest.approx(expected, rel=0.05)


@pytest.mark.parametrize("c, refines", [(0.0, False), (0.6, False), (0.9193, True)])
def test_solutions_are_refined_where_that_changes_forces(c, refines, monkeypatch):
    """Near the Rayleigh speed, 0.9194 c_s, rounding grows."""
    punches = []
    for share in (0.0, 1e-10):
        monkeypatch.setattr(punch_module, "NEGLIGIBLE", share)
        punches.append(small_punch(c))
    always, where_needed = punches
    wanted, found = (punch.states([-0.5, 0.5]) for punch in punches)
    fields = len(where_needed.fields)
    # Of the far boundary's motions those under resultants, two, are always refined.
    far = len(always._boundary.fields) + 2
    assert (where_needed.factor.solves == fields + 1 + far) == (not refines)
    # The loads that take away what refinement brought back are the only ones that it spares.
    assert 2 * len(always.fields) + far - 8 <= always.factor.solves <= 2 * len(always.fields) + far
    if refines:
        assert where_needed.factor.solves == always.factor.solves
    scale = np.linalg.norm(wanted.normal)
    assert np.linalg.norm(found.normal - wanted.normal) <= 2e-10 * scale


def test_flat_states_of_a_punch_with_a_profile_are_those_of_a_flat_punch():
    flat, g = small_punch(), [-0.5, 0.5]
    profile = small_punch(heights=0.1 * flat.space.contact.s**2)
    expected = flat.states(g).normal
    np.testing.assert_allclose(profile.states(g, flat=True).normal, expected, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("c", [0.0, 0.6, 0.91])
def test_friction_along_the_contact_that_does_not_vary_is_a_number(c):
    g = np.linspace(-0.9, 0.8, 7)
    number = small_punch(c)
    unit = np.eye(len(number.space.contact.s))
    matrix = small_punch(c, along=lambda g: g * unit)
    expected, states = (punch.states(g) for punch in (number, matrix))
    scale = np.abs(expected.normal).max()
    np.testing.assert_allclose(states.normal, expected.normal, rtol=0.0, atol=1e-10 * scale)
    np.testing.assert_allclose(states.tangential, g[:, None] * states.normal, rtol=0.0, atol=1e-9 * scale)
    np.testing.assert_allclose(states.v0, expected.v0, rtol=1e-9)
    fields = [
        sum(w * field.array for w, field in zip(state.weights[0], punch.fields))
        for state, punch in ((expected, number), (states, matrix))
    ]
    assert np.linalg.norm(fields[1] - fields[0]) <= 1e-9 * np.linalg.norm(fields[0])
