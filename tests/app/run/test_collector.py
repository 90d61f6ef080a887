"""Small parts wait for one another, and nothing of the results depends on that."""

import numpy as np
import pytest
from support import computed

from galinx import template
from galinx.app.run import flow
from galinx.app.run.flow import Memory, compute
from galinx.postprocess.journal import Journal, Part, joined

SPEEDS = 85
MANY = {
    "motion.c": np.linspace(0.0, 0.9, SPEEDS).tolist(),
    "motion.X_over_L": [0.2, 0.4, 0.6, 0.8],
    "solve.methods": ["closed_form"],
    "output.quantities": ["friction", "sif", "surface"],
}


@pytest.fixture(scope="module")
def alone():
    """Results of which every speed was taken in alone."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(flow, "_PATIENCE", -1.0)
        return computed("tables4_5", MANY).data


def equal(data, other):
    """The same to the last bit, but for wall times."""
    assert data.keys() == other.keys()
    for name in data.keys() - {"run/seconds"}:
        one, two = np.asarray(data[name]), np.asarray(other[name])
        if name.endswith("residual"):  # what rounding leaves, which depends on what is summed together
            assert max(one.max(), two.max()) <= 1e-11, name
            continue
        same = one.tobytes() == two.tobytes() if one.dtype.kind == "f" else np.array_equal(one, two)
        assert same, name


class Counting(Memory):
    """Counts what is written."""

    writes = 0

    def write(self, name, rows, values):
        self.writes += name == "states/alpha"
        super().write(name, rows, values)


def test_parts_of_many_speeds_are_written_and_kept_together(alone, tmp_path, monkeypatch):
    monkeypatch.setattr(flow, "_PATIENCE", 1e9)
    data = Counting()
    with Journal(tmp_path / "a.h5", "key") as journal:
        compute(template("tables4_5", MANY), data, None, journal)
        assert journal.states == 12 * SPEEDS
    assert data.writes == 2  # 1 000 states at once
    equal(data, alone)


def test_parts_join_in_order_and_the_worst_of_a_comparison_stays():
    def part(first, value, record=None):
        rows, values = slice(first, first + 2), np.array([first, first + 1.0])
        return Part(rows, {"states/f": values}, {"a": value}, record)

    whole = joined([part(4, 1.0), part(6, np.nan), part(8, 3.0, {"speed": 1})])
    assert whole.rows == slice(4, 10) and whole.data["states/f"].tolist() == [4, 5, 6, 7, 8, 9]
    assert [*whole.comparisons] == ["a"] and np.isnan(whole.comparisons["a"])
    assert whole.record == {"speed": 1}
