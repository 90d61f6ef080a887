"""Punches through points: convex, through all of them, without a corner."""

import numpy as np
import pytest

from galinx.solvers.profiles.punches import Table


@pytest.mark.parametrize("straight", [0.0, 1e-13, 1e-5])
@pytest.mark.parametrize("seed", range(4))
def test_the_slope_is_continuous_beside_straight_runs(seed, straight):
    """Three points on a line, or nearly so, are followed by a bend: the slope does not jump there."""
    rng = np.random.default_rng(seed)
    X = np.cumsum(rng.uniform(0.2, 1.0, 12))
    bends = rng.uniform(0.1, 1.0, 10)
    bends[[1, 4, 7, 8]] *= straight
    P = np.append(0.0, np.cumsum(np.append(0.0, np.cumsum(bends)) * np.diff(X)))
    P -= P[6] / (X[6] - X[0]) * (X - X[0])
    table = Table(tuple(zip(X.tolist(), P.tolist())))
    np.testing.assert_allclose(table.height(X) - table.height(X[0]), P - P[0], atol=1e-13)
    dense = np.linspace(X[0], X[-1], 200_001)
    steps = np.diff(table.slope(dense))
    assert steps.min() > -1e-12
    # A piece with both slopes and the height changes its slope over a thousandth of itself, or more.
    assert steps.max() < 1e-2


def test_a_corner_between_straight_runs_is_refused():
    chamfered = [(-3.0, 2.0), (-2.0, 1.0), (-1.0, 0.0), (0.0, 0.0), (1.0, 0.0), (2.0, 1.0), (3.0, 2.0)]
    with pytest.raises(ValueError, match=r"corner between straight runs of points at X = -1 m, X = 1 m"):
        Table(tuple(chamfered))
    Table(tuple(point for point in chamfered if point[0]))  # both slopes are means at the points
