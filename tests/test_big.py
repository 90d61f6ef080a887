"""Meshes cut finely at a fixed degree, and multigrid where a factor is too large."""

import re

import numpy as np
import pytest
from conftest import run_scene
from galinx.meshes.halfplane import MESHES
from galinx.meshes.refine import refinement

from galinx.app.errors import BadInput
from galinx.app.plan import cost
from galinx.app.plan.plan import make_plan
from galinx.app.plan.words import expense, lines
from galinx.app.results.paraview import state_field
from galinx.app.scene.changes import changed
from galinx.app.scene.scene import parse
from galinx.app.scene.templates import templates
from galinx.solvers.fem.multigrid import LIMIT, available

TEXT = templates()["tables4_5"].text


def cut(degree, cuts, *changes):
    """Archive of a scene with one state, at a fixed degree."""
    mesh = ('mesh = "confocal"', f'mesh = "confocal"\ndegree = {degree}\ncuts = {cuts}')
    one = ("X_over_L = [0.2, 0.8]", "X_over_L = [0.8]")
    return run_scene("tables4_5", mesh, one, *changes)[0]


def test_the_error_falls_at_twice_the_rate_of_the_energy_norm():
    """K_I is a moment of the contact forces: h^(2p) at degree p = 2."""
    at = ("c = [4.786e-7, 0.6]", "c = 0.6")
    coarse, fine = (cut(2, cuts, at)["states/fem/true_error"] for cuts in (8, 16))
    assert np.all(coarse / fine > 0.8 * 2**4)


@pytest.mark.parametrize("degree, cuts", [(2, 16), (3, 4), (4, 4)])
def test_the_estimate_covers_the_true_error(degree, cuts):
    data = cut(degree, cuts, ("c = [4.786e-7, 0.6]", "c = 0.9"))
    assert np.all(data["states/fem/true_error"] <= data["states/fem/estimate"])
    assert list(data["run/fem/factorisations"]) == [3]
    assert "run/fem/change_by_degree" not in data


@pytest.mark.parametrize("solver", available())
def test_multigrid_gives_what_a_factor_gives(solver):
    at = ("c = [4.786e-7, 0.6]", "c = 0.6")
    direct, iterative = (
        cut(2, 4, at, ("tolerance", f'solver = "{name}"\ntolerance')) for name in ("direct", solver)
    )
    for side in ("left", "right"):
        name = f"states/fem/K_I_{side}"
        np.testing.assert_allclose(iterative[name], direct[name], rtol=1e-9)
    assert not direct["run/fem/iterations"].any()
    assert np.all(np.isin(iterative["run/fem/iterations"], np.arange(1, LIMIT)))


@pytest.mark.parametrize(
    "degree, cuts, measured",
    [(2, 24, 0.741e9), (2, 64, 4.93e9), (4, 24, 2.47e9), (4, 32, 4.48e9), (8, 8, 1.03e9)],
)
def test_planned_memory_covers_what_runs_took(degree, cuts, measured):
    """Largest resident sets of runs with one speed, on one rank."""
    scene = parse(
        changed(
            TEXT,
            {"solve.degree": degree, "solve.cuts": cuts, "solve.tolerance": 1e-4, "motion.c": 0.0},
        )
    )
    planned = float(re.search(r"and (\S+) GB a rank", expense(scene, make_plan(scene)))[1]) * 1e9
    assert 0.95 * measured < planned < 1.6 * measured


def test_a_factor_is_taken_where_memory_has_room_for_it(monkeypatch):
    scene = parse(changed(TEXT, {"solve.degree": 2, "solve.cuts": 64}))
    monkeypatch.setattr(cost, "free_memory", lambda: 64e9)
    assert make_plan(scene).solver == "direct"
    monkeypatch.setattr(cost, "free_memory", lambda: 6e9)
    plan = make_plan(scene)
    assert plan.solver == "multigrid" and not plan.warnings
    assert any(
        "conjugate gradients" in line and "half and a quarter" in line for line in lines(scene, plan)
    )


def test_memory_that_is_not_there_is_warned_of(monkeypatch):
    monkeypatch.setattr(cost, "free_memory", lambda: 3e9)
    for solver in ("direct", "auto", "boomeramg"):
        scene = parse(changed(TEXT, {"solve.degree": 2, "solve.cuts": 64, "solve.solver": solver}))
        assert any(
            re.search(r"need about \S+ GB, of which this machine has 3 GB free", warning)
            for warning in make_plan(scene).warnings
        )
    assert not make_plan(parse(TEXT)).warnings


@pytest.mark.parametrize(
    "changes, message",
    [
        ({"solve.degree": 2}, "multiple of 4"),
        ({"solve.cuts": 4}, "multiple of 4"),
        ({"solve.degree": 2, "solve.cuts": 6}, "multiple of 4"),
        ({"solve.degree": 2.5, "solve.cuts": 4}, "whole number"),
        ({"solve.degree": 13, "solve.cuts": 4}, "13"),
        ({"solve.degree": 2, "solve.cuts": 4, "solve.mode": "traction"}, "contact"),
        ({"solve.solver": "jacobi"}, "jacobi"),
        ({"solve.solver": "gamg", "solid.nu": 0.5}, "indefinite"),
        ({"solve.degree": 2, "solve.cuts": 4, "solid.nu": 0.5}, "two degrees less"),
    ],
)
def test_what_cannot_be_is_refused(changes, message):
    with pytest.raises(BadInput, match=message):
        make_plan(parse(changed(TEXT, changes)))


@pytest.mark.parametrize("mesh", MESHES)
def test_cut_meshes_hold_the_points_of_the_uncut(mesh):
    coarse = refinement(mesh, 1e-3, 1.0)
    whole, fine = (MESHES[mesh].build(coarse, cuts) for cuts in (1, 3))
    assert len(fine.cells) == 9 * len(whole.cells)
    np.testing.assert_array_equal(fine.points[: len(whole.points)], whole.points)
    # The first of the nine at a cell's first vertex, the last at the one across.
    first, last = fine.cells.reshape(-1, 9, 4)[:, [0, -1]].transpose(1, 0, 2)
    np.testing.assert_array_equal(np.column_stack([first[:, 0], last[:, 2]]), whole.cells[:, [0, 2]])


@pytest.mark.parametrize("mesh", MESHES)
def test_pieces_of_a_mesh_make_the_whole(mesh):
    kind, pattern = MESHES[mesh], refinement(mesh, 1e-3, 1.0)
    whole, pieces = kind.build(pattern, 4), [kind.build(pattern, 4, i, 3) for i in range(3)]
    for name in ("points", "cells"):
        np.testing.assert_array_equal(
            np.concatenate([getattr(p, name) for p in pieces]), getattr(whole, name)
        )
    for tag, edges in whole.edges.items():
        np.testing.assert_array_equal(np.concatenate([p.edges[tag] for p in pieces]), edges)


def test_fields_of_a_cut_mesh_come_from_it():
    changes = {"solve.degree": 2, "solve.cuts": 8, "motion.c": 0.6}
    field = state_field(parse(changed(TEXT, changes)), 0, extent=3.0, degree=2)
    coarse = state_field(parse(changed(TEXT, changes | {"solve.cuts": 4})), 0, extent=3.0, degree=2)
    assert len(field.quads) > 3 * len(coarse.quads)
    deep = field.points[:, 1] < -0.5e-3  # half a punch's half-width
    unit = np.abs(field.data["sigma_YY"][deep]).max()
    assert np.nanmax(field.data["sigma_error"][deep]) < 0.02 * unit
