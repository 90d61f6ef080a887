"""Memory that is planned, and the solver that goes with it."""

import re

import numpy as np
import pytest

from galinx import template
from galinx.app.plan import elements
from galinx.app.plan.plan import expense, lines, make_plan

#: Memory of a program with its libraries on the machine of the measurements, by its last method.
PROGRAM = {"fem": 0.3e9, "closed_form": 0.13e9}


def told(scene):
    """Memory and results of a scene as its plan has them [B]."""
    words = expense(make_plan(scene))
    units = {"bytes": 1.0, "kB": 1e3, "MB": 1e6, "GB": 1e9}
    return [float(n) * units[unit] for n, unit in re.findall(r"([\d.]+) (bytes|[kMG]B)", words)]


#: A mesh whose factor takes some 5 GB.
LARGE = {"solve.degree": 2, "solve.cuts": 64}


@pytest.mark.parametrize(
    "degree, cuts, measured",
    [(2, 24, 0.761e9), (2, 64, 4.72e9), (4, 24, 2.33e9), (4, 32, 4.13e9), (8, 8, 0.98e9)],
)
def test_planned_memory_covers_what_runs_took(degree, cuts, measured, monkeypatch):
    """Largest resident sets of runs with one speed, on one rank."""
    monkeypatch.setattr(elements, "free_memory", lambda: 64e9)
    mesh = {"solve.degree": degree, "solve.cuts": cuts, "output.quantities": ["sif"]}
    scene = template("tables4_5", mesh | {"solve.tolerance": 1e-4, "motion.c": 0.0})
    assert 0.95 * measured < PROGRAM["fem"] + told(scene)[0] < 1.6 * measured


def test_sizes_that_are_not_estimated_are_no_zeros():
    for name in ("slider", "start_from_rest", "table1"):
        assert "bytes" not in expense(make_plan(template(name)))


BOTH, EXACT = ["closed_form", "fem"], ["closed_form"]


@pytest.mark.parametrize(
    "positions, states, methods, pressure, memory",
    [
        (500, 1, BOTH, 0, 0.283e9), (500, 6, BOTH, 0, 0.296e9),
        (2000, 1, BOTH, 0, 1.03e9), (500, 6, EXACT, 0, 0.156e9),
        (2000, 1, EXACT, 0, 0.517e9),
        (300, 1, BOTH, 3, 0.28e9), (300, 1, BOTH, 9, 0.247e9),
    ],
)  # fmt: skip
def test_a_map_is_planned_as_what_it_takes(positions, states, methods, pressure, memory):
    """Largest resident sets of runs with maps of positions x positions."""
    knots = [[x, -1.0 - 0.5 * x * (i % 2)] for i, x in enumerate(np.linspace(-1.0, 1.0, pressure))]
    changes = {
        "motion.c": 0.6, "motion.strokes": ["forward"],
        "motion.X_over_L": np.linspace(0.1, 0.8, states).tolist(), "solve.methods": methods,
        "output.quantities": ["sif", "interior"],
        "output.map": {"X": [-2, 2, positions], "Y": [-2, -0.01, positions]},
    }  # fmt: skip
    if knots:
        changes |= {"solve.mode": "traction", "solve.pressure": knots}
    needed, archived = told(template("tables4_5", changes))
    assert 0.95 * memory < PROGRAM[methods[-1]] + needed < 1.6 * memory
    numbers = (2 + 6 * len(methods) * states) * positions**2
    assert archived == pytest.approx(8 * numbers, rel=0.05)


def test_a_map_that_memory_does_not_hold_is_warned_of(monkeypatch):
    monkeypatch.setattr(elements, "free_memory", lambda: 0.5e9)
    changes = {"output.quantities": ["sif", "interior"], "solve.methods": EXACT}
    grid = {"output.map": {"X": [-2, 2, 2000], "Y": [-2, -0.01, 2000]}}
    assert not make_plan(template("tables4_5", changes | grid)).warnings
    monkeypatch.setattr(elements, "free_memory", lambda: 0.2e9)
    (warning,) = make_plan(template("tables4_5", changes | grid)).warnings
    assert "need about 0.43 GB, of which this machine has 0.2 GB free: ask for fewer points" in warning


def test_a_factor_is_taken_where_memory_has_room_for_it(monkeypatch):
    scene = template("tables4_5", LARGE)
    monkeypatch.setattr(elements, "free_memory", lambda: 64e9)
    assert make_plan(scene).fem.solver == "direct"
    monkeypatch.setattr(elements, "free_memory", lambda: 8e9)
    plan = make_plan(scene)
    assert plan.fem.solver == "multigrid" and not plan.warnings
    assert any("conjugate gradients" in line and "one of a higher degree" in line for line in lines(plan))
