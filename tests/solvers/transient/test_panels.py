"""Panels of distances hold the waves of short steps."""

import numpy as np
from support import THOROUGH

from galinx.solvers.solids.isotropic import Isotropic
from galinx.solvers.transient.transform import Transformed, divided


def test_waves_within_a_short_time_are_held():
    """Steps of 0.008 a/c_s ask for these s: the slowest wave turns by 2 000 for each a."""
    solid, c = Isotropic(200e9, 0.25, 7800.0), 0.6
    s = np.array([80.0 + 700.0j, 80.0 + 200.0j][: 2 if THOROUGH else 1])
    found, finer = (
        punch.sinking(basis := punch.basis(-0.4), basis.tests)
        for punch in (
            Transformed(solid.response(c), solid.limit(), s, 8),
            Transformed(solid.response(c), solid.limit(), s, 8, 2.5e-3),
        )
    )
    np.testing.assert_allclose(found, finer, rtol=0.0, atol=1e-6 * np.abs(finer).max())


def test_what_is_gone_asks_for_no_panels():
    edges = np.array([0.0, 0.01, 0.1, 0.5, 2.0])
    np.testing.assert_array_equal(divided(edges, np.array([1.0 + 1.0j]), 3.0), edges)
    fast = divided(edges, np.array([80.0 + 700.0j]), 3.0)
    assert set(edges) <= set(fast) and np.diff(fast)[fast[1:] < 0.08].max() < 10.0 / 2100.0
