"""Models of a user's own, registered from outside: solved by two methods, archived, drawn, refused."""

from contextlib import contextmanager

import numpy as np
import pytest
from support import command, computed, here

import galinx
from galinx.solvers.errors import SolveError


class Failing:
    """A method that solves the first speed only."""

    @contextmanager
    def at(self, task, g):
        if task.number:
            raise SolveError("provoked")
        yield self

    def states(self, g):
        return self

    def record(self):
        return {}


def test_a_method_of_ones_own_that_fails_is_told_of(monkeypatch):
    kind = galinx.MethodKind("failing method", lambda plan, progress, clock: Failing())
    monkeypatch.setitem(galinx.METHODS, "failing", kind)
    row = galinx.Quantity(
        "states/failing/one", "1", "one", ("states",), lambda s, body: np.ones(6), "failing"
    )
    monkeypatch.setitem(galinx.QUANTITIES, row.path, row)
    result = computed("tables4_5", {"solve.methods": ["closed_form", "failing"]})
    assert result.verdict == "FAIL" and list(result.data["run/failures"]) == ["c = 0.6: provoked"]
    np.testing.assert_array_equal(result.data[row.path], [1.0] * 6 + [np.nan] * 6)
    assert "failing method: 12 states" in list(result.data["run/done"])
    with pytest.raises(SolveError, match="provoked"):
        monkeypatch.setattr(Failing, "states", _refuse)
        computed("tables4_5", {"solve.methods": ["failing"]})


def _refuse(self, g):
    raise SolveError("provoked")


OWN = """
from dataclasses import dataclass
import galinx
from galinx.solvers.solids import Isotropic

@dataclass(frozen=True)
class Cork(Isotropic):
    about = "cork"
    def __post_init__(self):
        if self.ν > 0.1:
            raise ValueError("expected cork, which hardly widens")

galinx.SOLIDS.register("cork", Cork)
"""


def test_a_file_of_models_is_run_before_a_command(tmp_path):
    (tmp_path / "own.py").write_text(OWN, encoding="utf-8")
    changes = ("--set", "solid.kind=cork", "--set", 'solve.methods=["closed_form"]')
    table = galinx.template("tables4_5").text
    (tmp_path / "s.toml").write_text(table, encoding="utf-8")
    good = command("-x", "own.py", "run", "s.toml", *changes, "--set", "solid.nu=0.05", cwd=tmp_path)
    assert good.returncode == 0, good.stderr
    bad = command("-x", "own.py", "plan", "s.toml", *changes, cwd=tmp_path)
    assert bad.returncode == 2 and "solid: expected cork" in bad.stderr
    without = here("plan", "s.toml", *changes, cwd=tmp_path)
    assert without.returncode == 2 and "-x FILE.py" in without.stderr
