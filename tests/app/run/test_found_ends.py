"""Contacts whose ends are found, end to end: Hertz, rounding at free ends, kinks, names of a parabola."""

import itertools

import numpy as np
import pytest
from support import computed

import galinx
from galinx.app.scene.read import parse
from galinx.meshes.kind import check_cells
from galinx.meshes.rings import Refinement, with_kinks
from galinx.solvers.errors import SolveError
from galinx.solvers.fem.own_meshes import EndsBetweenKinks


def scene(
    punch, solid='E = "200 GPa"\nnu = 0.3\nrho = 7850', c="0.4", solve="", output='["sif"]', mu=0.6,
    X_over_L=(0.1, 0.7),
):  # fmt: skip
    return parse(
        f"[solid]\n{solid}\n[punch]\nload = 5e4\n{punch}\n"
        f"[friction]\nmu_c = {mu}\nsigma0_over_load = 6e4\n"
        f"[motion]\nc = {c}\nX_over_L = {list(X_over_L)}\n[solve]\n{solve}\n"
        f"[output]\nquantities = {output}\n"
    )


def test_hertz_and_where_the_solid_yields_below():
    """τ_max 0.300283 p₀ at 0.786151 a, von Mises 0.557516 p₀ at 0.704290 a below the middle."""
    punch = 'profile = "parabolic"\nradius = 0.02'
    solid = 'E = "200 GPa"\nnu = 0.3\nrho = 7850\nyield_strength = "300 MPa"'
    result = galinx.compute(scene(punch, solid, "0", output='["sif", "yield"]', mu=1e-9))
    assert result.verdict == "PASS", result.attributes["verdict_reasons"]
    h0 = np.sqrt(4.0 * 5e4 * 0.02 * (1.0 - 0.3**2) / (np.pi * 200e9))
    for method, digits in (("closed_form", 1e-6), ("fem", 1e-5)):
        of = {
            name.removeprefix(f"states/{method}/"): v[0]
            for name, v in result.data.items()
            if method in name
        }
        p0 = of["largest_pressure"]
        assert of["half_width"] == pytest.approx(h0, rel=1e-7) and p0 == pytest.approx(
            4.0 / np.pi, rel=1e-7
        )
        assert of["max_shear"] / p0 == pytest.approx(0.300283, rel=digits, abs=6e-7)
        assert of["von_mises"] / p0 == pytest.approx(0.557516, rel=digits, abs=6e-7)
        assert of["max_shear_Y_over_a"] == pytest.approx(-0.786151, abs=1e-4)
        assert of["von_mises_Y_over_a"] == pytest.approx(-0.704290, abs=1e-4)
        # von Mises grows with the pressure, like the root of the load.
        at_yield = 5e4 * (300e6 / (of["von_mises"] * 5e4 / (2.0 * h0))) ** 2
        assert of["first_yield_load"] == pytest.approx(at_yield, rel=1e-6)


def test_a_tolerance_below_the_rounding_at_free_ends_is_given_up_at_once():
    """Stresses a millionth of the half-width from an end are rounded; those inside keep their digits."""
    points = "[[1.0009, -0.0024], [0.0446, -0.0018], [2.1, -0.2]]"
    output = f'["sif", "surface", "interior"]\npoints = {points}'
    punch = 'profile = "parabolic"\nradius = 0.1'
    result = galinx.compute(scene(punch, solve="tolerance = 1.3e-9", output=output))
    data = result.data
    σ_XX, exact = (data[f"surface/{method}/sigma_XX"] for method in ("fem", "closed_form"))
    error = np.abs(σ_XX - exact).max() / np.abs(exact).max()
    assert result.verdict == "FAIL"
    assert 1.3e-9 < error <= data["states/fem/estimate_sigma_XX"].max() <= 100.0 * error
    assert data["states/fem/estimate_inside"].max() <= 0.1 * data["states/fem/estimate_sigma_XX"].max()
    # No finer cells, of which there would be four times as many.
    assert data["run/fem/cells"].max() < 400


def test_kinks_with_no_room_for_cells_between_them_are_refused():
    """Least distance between kinks: just above it cells have a shape, below it no mesh is drawn."""
    for sectors, rings, more in itertools.product((1, 2, 4, 8), (3, 8, 12), (0, 4)):
        for at in (-0.97, 0.0, 0.5):
            places = np.array([at, at + 1e-3])
            check_cells(with_kinks(Refinement(rings, 0.35, sectors, (1.0,)), places, more))
    flat = 1e-6
    body = parse(
        "[solid]\nE = 2e11\nnu = 0.3\nrho = 7800\n[punch]\nload = 1e5\nprofile = 'rounded_flat'\n"
        f"flat_half_width = {flat}\nradius = 0.02\n[friction]\nmodel = 'coulomb'\nmu_c = 0.1\n"
        "[motion]\nc = 0\nstrokes = ['forward']\nX_over_L = [0.5]\n"
    ).body
    EndsBetweenKinks(body, (0.0, flat * 2.0 / 1.1e-3), 1e-6)
    with pytest.raises(SolveError, match=r"or 0\.001 of another"):
        EndsBetweenKinks(body, (0.0, flat * 2.0 / 0.9e-3), 1e-6)


@pytest.mark.parametrize(
    ("punch", "frictions"),
    [
        ("half_width = 1e-3", 30),  # more than are solved one by one
        ("half_width = 1e-3\ntilt = 0.05", 2),
        ('profile = "parabolic"\nradius = 0.02', 2),
        ('profile = "wedge"\nslope = 0.01', 2),
    ],
)
def test_the_integral_equation_alone_solves_uniform_solids(punch, frictions):
    output = '["sif", "surface", "interior"]\npoints = [[0.0, -0.5]]'
    at = np.linspace(0.1, 0.7, frictions).tolist()
    by = {
        method: galinx.compute(scene(punch, solve=f'methods = ["{method}"]', output=output, X_over_L=at))
        for method in ("sie", "closed_form")
    }
    assert by["sie"].verdict == by["closed_form"].verdict == "PASS"
    for name in ("sigma_XX", "sigma_YY"):
        value, exact = (result.data[f"surface/{method}/{name}"] for method, result in by.items())
        assert value == pytest.approx(exact, rel=1e-8, abs=1e-8 * np.nanmax(np.abs(exact)), nan_ok=True)
    assert not any(name.startswith("interior") for name in by["sie"].data)
    assert "stresses inside cannot be computed: in a uniform solid closed_form gives it" in str(
        by["sie"].attributes["warnings"]
    )


def test_a_parabola_is_one_by_every_name():
    """A power of the exponent 2 is the cylinder of its curvature, by both methods."""
    few = {"motion.c": 0.5, "motion.strokes": ["forward"], "motion.X_over_L": [0.7],
           "solve.tolerance": 1e-5, "punch.half_width": None}  # fmt: skip
    names = {"punch.profile": "parabolic", "punch.radius": 0.02}, {
        "punch.profile": "power", "punch.exponent": 2.0, "punch.coefficient": 25.0,
    }  # fmt: skip
    cylinder, power = (computed("tables4_5", few | name).data for name in names)
    for path in (f"states/{by}/{of}" for by in ("closed_form", "fem") for of in ("half_width", "centre")):
        np.testing.assert_allclose(power[path], cylinder[path], rtol=1e-13)
