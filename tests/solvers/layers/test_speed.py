"""Dispersion of the slowest waves along layers."""

import numpy as np
import pytest
from layers_cases import COAT, SUBSTRATE

from galinx.solvers.layers.layered import Layer, Layered, dispersion
from galinx.solvers.solids.isotropic import Isotropic


def curve(solid, k):
    return dispersion(lambda c: solid.response(c).stack(1.0), 1.0, k, 1e-8)


def test_waves_along_one_solid_have_one_speed():
    solid = Layered((Layer(0.7, COAT),), COAT)
    assert curve(solid, np.array([0.1, 1.0, 10.0])) == pytest.approx(COAT.limit(), rel=1e-7)


def test_long_waves_see_the_substrate_and_short_ones_the_coating():
    solid = Layered((Layer(1.0, SUBSTRATE),), Isotropic(2.6, 0.25, 1.0))
    found = curve(solid, np.array([1e-4, 50.0]))
    ends = [(2.6 / 2.5) ** 0.5 * SUBSTRATE.limit(), SUBSTRATE.limit()]
    assert found == pytest.approx(ends, rel=1e-3)


def test_stiff_coatings_make_waves_faster_until_none_is_left():
    """Beyond the shear speed of the substrate the wave would leak."""
    solid = Layered((Layer(1.0, COAT),), SUBSTRATE)
    found = curve(solid, np.geomspace(0.03, 30.0, 9)) * COAT.c_s
    known = found[np.isfinite(found)]
    assert 2 <= len(known) < 9 and np.all(np.diff(known) > 0.0)
    assert SUBSTRATE.limit() < known[0] < known[-1] < SUBSTRATE.c_s


def test_the_limit_is_the_least_speed_of_all_waves():
    solid = Layered(
        (Layer(1.0, Isotropic(1.0, 0.3, 1.0)), Layer(0.5, Isotropic(5.0, 0.3, 12.0))),
        Isotropic(1.0, 0.3, 1.0),
    )
    found = curve(solid, np.geomspace(1.0, 6.0, 41))
    assert np.nanmin(found) == pytest.approx(solid.limit(), rel=1e-4)
    assert np.nanmin(found) >= solid.limit() * (1.0 - 1e-7)
