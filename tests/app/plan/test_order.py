"""Which state is which: the product of speeds, loads, laws and places."""

from itertools import pairwise

import numpy as np
import pytest

from galinx.app.plan.states import Order


@pytest.mark.parametrize("seed", range(40))
def test_every_state_has_its_speed_and_its_load(seed):
    rng = np.random.default_rng(seed)
    speeds, loads, laws, places = rng.integers(1, 5, 4).tolist()
    own = rng.choice(
        [np.nan, 0.5, 0.6, 0.1], places, p=rng.choice([[1.0, 0, 0, 0], [0.4, 0.2, 0.2, 0.2]])
    )
    given = tuple((0.1 * np.arange(1, speeds + 1)).tolist())
    N = tuple(rng.permutation(np.arange(1.0, loads + 1)).tolist())
    order = Order(given, N, laws, own)
    expected = [
        (c if np.isnan(at) else at, load)
        for c in given for load in N for _ in range(laws) for at in own
    ]  # fmt: skip
    assert len(order) == len(expected) and order.states * speeds == len(order)
    assert list(zip(order.c, order.load(slice(0, len(order))))) == expected
    assert order.load(slice(1, len(order))).tolist() == [load for _, load in expected[1:]]
    # Every state is in one run of one speed, and each speed is met first in this order.
    assert order.speeds == tuple(dict.fromkeys(c for c, _ in expected))
    seen = []
    for c, runs in zip(order.speeds, order.runs(), strict=True):
        rows = [row for run in runs for row in range(run.start, run.stop)]
        assert rows == sorted(rows) and {expected[row][0] for row in rows} == {c}
        assert all(after.start > before.stop for before, after in pairwise(runs))
        seen += rows
    assert sorted(seen) == list(range(len(order)))


def test_many_speeds_are_one_run_each():
    order = Order(tuple(np.linspace(0.0, 0.9, 10**5).tolist()), (1.0,), 1, np.full(2, np.nan))
    runs = order.runs()
    assert next(runs) == (slice(0, 2),) and next(runs) == (slice(2, 4),) and len(order) == 2 * 10**5
