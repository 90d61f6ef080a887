"""How starts from rest come to steady sliding, against starts that are followed to late times."""

import numpy as np
import pytest
from random_solids import random_solid
from started import THOROUGH, by_integral_equation

from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.solids.isotropic import Isotropic
from galinx.solvers.transient.late_time import approach

RAMP = 4.0


def left(solid, c, g, end):
    """Centre, K_I left and right, less those of steady motion, and the time since the load was half."""
    steady = FlatPunch(solid.response(c), g)
    found = by_integral_equation(solid, c, g, end, 40, RAMP, 12)
    ratios = found.K_left[-1] / steady.K_I - 1.0, found.K_right[-1] / steady.K_I - 1.0
    return np.array([found.centre[-1] - (steady.β - steady.α), *ratios]), end - RAMP / 2.0


@pytest.mark.parametrize(
    "solid", [Isotropic(1.0, 0.25, 1.0), pytest.param(random_solid(2), marks=THOROUGH)]
)
def test_what_is_left_falls_like_1_over_t(solid):
    """The first term of a series with t log t in the next: two times tell it without most of that."""
    c, g = 0.5 * solid.limit(), -0.4
    told = approach(solid, c, g)
    (one, t), (two, twice) = (left(solid, c, g, end) for end in (40.0, 80.0))
    found = 2.0 * two * twice - one * t
    expected = np.array([told.centre, told.K_left, told.K_right])
    np.testing.assert_allclose(found, expected, rtol=0.05)


def test_at_rest_it_falls_like_the_square():
    solid = Isotropic(1.0, 0.25, 1.0)
    told, (found, t) = approach(solid, 0.0, 0.0), left(solid, 0.0, 0.0, 20.0)
    assert told.centre == told.K_left == told.K_right == 0.0
    np.testing.assert_allclose(found[1:] * t**2, told.at_rest, rtol=0.05)
    assert told.within(0.01) == pytest.approx((100.0 * told.at_rest) ** 0.5)


def test_time_to_be_near_grows_with_speed_and_friction():
    solid = Isotropic(1.0, 0.25, 1.0)
    by_speed = [approach(solid, c, -0.4).within(0.01) for c in (0.0, 0.2, 0.4, 0.6, 0.8, 0.9)]
    assert np.all(np.diff(by_speed) > 0.0)
    assert approach(solid, 0.6, -0.8).within(0.01) > by_speed[3] > approach(solid, 0.6, 0.0).within(0.01)
