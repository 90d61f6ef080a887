"""Memory that is planned, and the solver that goes with it."""

import re

import pytest

from galinx import template
from galinx.app.plan import cost
from galinx.app.plan.plan import make_plan
from galinx.app.plan.words import expense, lines

#: A mesh whose factor takes some 5 GB.
LARGE = {"solve.degree": 2, "solve.cuts": 64}


@pytest.mark.parametrize(
    "degree, cuts, measured",
    [(2, 24, 0.741e9), (2, 64, 4.93e9), (4, 24, 2.47e9), (4, 32, 4.48e9), (8, 8, 1.03e9)],
)
def test_planned_memory_covers_what_runs_took(degree, cuts, measured):
    """Largest resident sets of runs with one speed, on one rank."""
    mesh = {"solve.degree": degree, "solve.cuts": cuts, "output.quantities": ["sif"]}
    scene = template("tables4_5", mesh | {"solve.tolerance": 1e-4, "motion.c": 0.0})
    planned = float(re.search(r"and (\S+) GB a rank", expense(make_plan(scene)))[1]) * 1e9
    assert 0.95 * measured < planned < 1.6 * measured


def test_a_factor_is_taken_where_memory_has_room_for_it(monkeypatch):
    scene = template("tables4_5", LARGE)
    monkeypatch.setattr(cost, "free_memory", lambda: 64e9)
    assert make_plan(scene).fem.solver == "direct"
    monkeypatch.setattr(cost, "free_memory", lambda: 6e9)
    plan = make_plan(scene)
    assert plan.fem.solver == "multigrid" and not plan.warnings
    assert any(
        "conjugate gradients" in line and "half and a quarter" in line for line in lines(scene, plan)
    )


def test_memory_that_is_not_there_is_warned_of(monkeypatch):
    monkeypatch.setattr(cost, "free_memory", lambda: 3e9)
    for solver in ("direct", "auto", "boomeramg"):
        scene = template("tables4_5", LARGE | {"solve.solver": solver})
        assert any(
            re.search(r"need about \S+ GB, of which this machine has 3 GB free", warning)
            for warning in make_plan(scene).warnings
        )
    assert not make_plan(template("tables4_5")).warnings
