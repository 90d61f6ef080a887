import numpy as np
import pytest
import sympy as sp
from conftest import run_scene
from galinx.meshes.halfplane import MESHES
from mpi4py import MPI

from galinx.app.errors import BadInput
from galinx.meshes.rings import TAGS, Refinement
from galinx.postprocess.stresses import stresses_inside
from galinx.solvers.errors import MeshError
from galinx.solvers.fem.distributed import distribute
from galinx.solvers.fem.interior import InteriorGradients
from galinx.solvers.fem.punch import SlidingPunch
from galinx.solvers.fem.space import Space


def random_points(count, seed):
    """Points within 5 a of the punch's middle, at least 0.01 a deep."""
    random = np.random.default_rng(seed)
    R, φ = 5.0 * np.sqrt(random.random(count)), -np.pi * random.random(count)
    return np.column_stack([R * np.cos(φ), np.minimum(R * np.sin(φ), -0.01)])


def with_points(points):
    """Changes to a scene that ask for stresses at points."""
    text = ", ".join(f"[{X!r}, {Y!r}]" for X, Y in points.tolist())
    wanted = f'quantities = ["sif", "interior"]\npoints = [{text}]'
    return ('quantities = ["friction", "sif", "surface"]', wanted)


@pytest.mark.parametrize("tolerance, limit", [(1e-6, 1e-4), (1e-9, 2e-6)])
def test_stresses_inside_are_those_of_the_potentials(tolerance, limit):
    data, _ = run_scene(
        "tables4_5",
        with_points(random_points(200, 7)),
        ("tolerance = 1e-6", f"tolerance = {tolerance}"),
        ("[4.786e-7, 0.6]", "[0.0, 4.786e-7, 0.6, 0.9]"),
    )
    for ij in ("XX", "YY", "XY"):
        fem, exact = (data[f"interior/{method}/sigma_{ij}"] for method in ("fem", "closed_form"))
        assert fem.shape == (24, 200)
        error = np.abs(fem - exact).max(axis=1) / np.abs(exact).max(axis=1)
        assert error.max() <= limit


def test_nothing_inside_is_computed_unasked(tables_run):
    data, _ = tables_run
    assert not any(name.startswith("interior/") for name in data)
    assert "stresses inside: not in output.quantities" in data["run/skipped"]


@pytest.mark.parametrize("mesh", ["graded", "box"])
def test_other_meshes_and_given_tractions(mesh):
    points = with_points(random_points(40, 3))
    for mode in ("contact", "traction"):
        changes = ('mesh = "confocal"', f'mesh = "{mesh}"\nmode = "{mode}"'), ("= 1e-6", "= 1e-4")
        data, _ = run_scene("tables4_5", points, *changes)
        fem, exact = (data[f"interior/{method}/sigma_XX"] for method in ("fem", "closed_form"))
        # The box is wrong by what its walls do; the graded mesh by its degree alone.
        assert np.abs(fem - exact).max() <= (3e-2 if mesh == "box" else 2e-3) * np.abs(exact).max()


def test_a_point_beyond_the_mesh_is_refused():
    with pytest.raises(BadInput, match="coordinate of 90 a, expected at most 60 a with the box mesh"):
        run_scene(
            "tables4_5", with_points(np.array([[0.0, -90.0]])), ('mesh = "confocal"', 'mesh = "box"')
        )
    kind = MESHES["graded"]
    cells = kind.build(Refinement(4, 0.5, 2, (1.0,) * 3))
    space = Space(*distribute(cells, MPI.COMM_SELF), TAGS, kind.chart, 2)
    punch = SlidingPunch(space, 2.0, 0.0)
    with pytest.raises(MeshError, match="X/a = 0, Y/a = -1e\\+06 lies outside"):
        InteriorGradients(space, 2.0, 0.0, punch.fields, np.array([[0.0, -1.0], [0.0, -1e6]]))
    punch.destroy()


def test_incompressible_solids_have_stresses_inside_in_closed_form_only():
    scene = ("tables4_5", with_points(np.array([[0.0, -1.0], [0.9, -0.1]])), ("nu = 0.25", "nu = 0.5"))
    with pytest.raises(BadInput, match=r"expected ν <= 0\.49"):
        run_scene(*scene)
    data, _ = run_scene(*scene, ('["closed_form", "fem"]', '["closed_form"]'))
    near, _ = run_scene(
        *scene[:2], ("nu = 0.25", "nu = 0.4999999"), ('["closed_form", "fem"]', '["closed_form"]')
    )
    for ij in ("XX", "YY", "XY"):
        name = f"interior/closed_form/sigma_{ij}"
        np.testing.assert_allclose(data[name], near[name], rtol=1e-5, atol=1e-7)


def test_stresses_of_a_gradient_follow_from_hookes_law():
    κ, u_X, u_Y, v_X, v_Y = sp.symbols("κ u_X u_Y v_X v_Y")
    λ = (3 - κ) / (κ - 1)
    σ = [2 * u_X + λ * (u_X + v_Y), 2 * v_Y + λ * (u_X + v_Y), u_Y + v_X]
    values = {κ: 2.2, u_X: 0.3, u_Y: -0.7, v_X: 0.2, v_Y: 1.1}
    found = stresses_inside(2.2, np.array([[0.3, -0.7], [0.2, 1.1]]))
    np.testing.assert_allclose(found, [float(s.subs(values)) for s in σ], rtol=1e-14)
