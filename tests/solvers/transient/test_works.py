"""Works of the load and of friction, and σ_XX beside the contact, of starts from rest."""

import numpy as np
import pytest
from random_solids import random_solid
from started import THOROUGH, ByFiniteElements, by_integral_equation

from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.solids.isotropic import Isotropic
from galinx.solvers.transient.history import smooth
from galinx.solvers.transient.punch import BESIDE

ISOTROPIC = Isotropic(1.0, 0.25, 1.0)


@pytest.mark.parametrize(
    ("solid", "c", "g"),
    [(ISOTROPIC, 0.6, -0.4), pytest.param(random_solid(0), 0.4, 0.3, marks=THOROUGH)],
)
def test_works_are_the_energy_that_finite_elements_hold(solid, c, g):
    """Both methods know nothing of each other; friction and load give what moves and is strained."""
    found = by_integral_equation(solid, c, g, 4.0, 20, terms=20)
    run = ByFiniteElements(solid, c, 4.0, 20).run(g, lambda t: smooth(t, 3.0))
    work = found.work_of_load + found.work_of_friction
    assert np.abs(work - run.energy).max() < 1e-4 * np.abs(work).max()
    assert abs(found.work_of_friction[-1]) > 0.05 * work[-1]


def test_without_friction_it_does_no_work():
    found = by_integral_equation(ISOTROPIC, 0.3, 0.0, 2.0, 10)
    assert not found.work_of_friction.any()
    assert np.all(np.diff(found.work_of_load) > 0.0)


@pytest.mark.parametrize(
    ("solid", "c", "g"),
    [(random_solid(2), 0.25, 0.4), pytest.param(ISOTROPIC, 0.6, -0.4, marks=THOROUGH)],
)
def test_stress_beside_the_contact_comes_to_that_of_steady_motion(solid, c, g):
    one, two = (by_integral_equation(solid, c, g, end, 40, 4.0, 14) for end in (40.0, 80.0))
    expected = FlatPunch(solid.response(c), g).σ_XX(np.array([-1.0 - BESIDE, 1.0 + BESIDE]))
    for side, exact in zip(("σ_XX_left", "σ_XX_right"), expected):
        early, late = getattr(one, side)[-1], getattr(two, side)[-1]
        assert abs(2.0 * late - early - exact) < 5e-3 * np.abs(expected).max()
