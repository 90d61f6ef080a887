"""Contacts whose ends are found, end to end: Hertz, rounding at free ends, kinks, names of a parabola."""

import itertools

import numpy as np
import pytest
from agreement import of_method
from support import THOROUGH, computed, of_sections

import galinx
from galinx.meshes.kind import check_cells
from galinx.meshes.rings import Refinement, with_kinks
from galinx.solvers.errors import SolveError
from galinx.solvers.fem.own_meshes import EndsBetweenKinks

CYLINDER = {"profile": "parabolic", "radius": 0.02}
SOLID = {"E": 1e9, "nu": 0.3, "rho": 1000.0}


def scene(punch, words=("sif",), points=None, c=0.4, mu=0.6, X_over_L=(0.1, 0.7), solve=None, **solid):
    """A punch on steel, and words of what is asked for."""
    return of_sections(
        solid={"E": "200 GPa", "nu": 0.3, "rho": 7850} | solid, punch={"load": 5e4} | punch, solve=solve,
        friction={"mu_c": mu, "sigma0_over_load": 6e4},
        motion={"c": c, "X_over_L": [*map(float, X_over_L)]},
        output={"quantities": list(words)} | ({"points": points} if points else {}),
    )  # fmt: skip


def test_hertz_and_where_the_solid_yields_below():
    """τ_max 0.300283 p₀ at 0.786151 a, von Mises 0.557516 p₀ at 0.704290 a below the middle."""
    result = galinx.compute(scene(CYLINDER, ("sif", "yield"), c=0.0, mu=1e-9, yield_strength="300 MPa"))
    assert result.verdict == "PASS", result.attributes["verdict_reasons"]
    h0 = np.sqrt(4.0 * 5e4 * 0.02 * (1.0 - 0.3**2) / (np.pi * 200e9))
    for method, digits in (("closed_form", 1e-6), ("fem", 1e-5)):
        of = {path.partition("/")[2]: v[0] for path, v in of_method(result.data, method).items()}
        p0 = of["largest_pressure"]
        assert (of["half_width"], p0) == pytest.approx((h0, 4.0 / np.pi), rel=1e-7)
        assert of["max_shear"] / p0 == pytest.approx(0.300283, rel=digits, abs=6e-7)
        assert of["von_mises"] / p0 == pytest.approx(0.557516, rel=digits, abs=6e-7)
        assert of["max_shear_Y_over_a"] == pytest.approx(-0.786151, abs=1e-4)
        assert of["von_mises_Y_over_a"] == pytest.approx(-0.704290, abs=1e-4)
        # von Mises grows with the pressure, like the root of the load.
        at_yield = 5e4 * (300e6 / (of["von_mises"] * 5e4 / (2.0 * h0))) ** 2
        assert of["first_yield_load"] == pytest.approx(at_yield, rel=1e-6)


def test_a_tolerance_below_the_rounding_at_free_ends_is_given_up_at_once():
    """Stresses a millionth of the half-width from an end are rounded; those inside keep their digits."""
    places = ("sif", "surface", "interior"), [[1.0009, -0.0024], [0.0446, -0.0018], [2.1, -0.2]]
    result = galinx.compute(scene(CYLINDER | {"radius": 0.1}, *places, solve={"tolerance": 1.3e-9}))
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
    punch = {"profile": "rounded_flat", "flat_half_width": flat, "radius": 0.02, "load": 1e5}
    body = scene(punch, c=0.0).body
    EndsBetweenKinks(body, (0.0, flat * 2.0 / 1.1e-3), 1e-6)
    with pytest.raises(SolveError, match=r"or 0\.001 of another"):
        EndsBetweenKinks(body, (0.0, flat * 2.0 / 0.9e-3), 1e-6)


@pytest.mark.parametrize("load, gap", [*[(50.0, 0.02)] * THOROUGH, (4.0, 0.004)])
def test_kinks_next_to_the_ends_of_a_contact(load, gap):
    """A flat whose shoulders hardly touch: splines and cells follow the pressure beside kinks."""
    punch = {"profile": "rounded_flat", "flat_half_width": 1e-3, "radius": 0.05, "load": load}
    result = galinx.compute(of_sections(
        solid=SOLID, punch=punch, friction={"model": "coulomb", "mu_c": 0.3}, motion={"c": 0.4},
        solve={"methods": ["closed_form", "fem"], "tolerance": 1e-4},
        output={"quantities": ["sif", "surface"]},
    ))  # fmt: skip
    assert result.verdict == "PASS", result.comparisons
    ends = 1e-3 / result.data["states/fem/half_width"]
    assert 1.0 - ends == pytest.approx(gap, rel=0.3)


@pytest.mark.parametrize(
    ("punch", "frictions"),
    [
        ({"half_width": 1e-3}, 30),  # more than are solved one by one
        ({"half_width": 1e-3, "tilt": 0.05}, 2),
        (CYLINDER, 2),
        ({"profile": "wedge", "slope": 0.01}, 2),
    ],
)
def test_the_integral_equation_alone_solves_uniform_solids(punch, frictions):
    places, at = (("sif", "surface", "interior"), [[0.0, -0.5]]), np.linspace(0.1, 0.7, frictions)
    by = {
        method: galinx.compute(scene(punch, *places, X_over_L=at, solve={"methods": [method]}))
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


def test_a_mesh_that_another_replaced_gives_no_warning():
    """Over layers the first mesh of a cusp is for a half-width near by, and its tip is not resolved."""
    result = galinx.compute(of_sections(
        solid=SOLID, layer=[SOLID | {"E": 2e9, "thickness": 9e-4}],
        punch={"profile": "power", "exponent": 1.5, "coefficient": 0.17, "load": 1608.0},
        friction={"model": "coulomb", "mu_c": 0.9}, motion={"c": 0.05},
        solve={"methods": ["fem"], "tolerance": 2.26e-3}, output={"quantities": ["interfaces"]},
    ))  # fmt: skip
    assert result.verdict == "PASS" and "do not reach" not in result.attributes["warnings"]


def test_a_contact_over_layers_that_leans_beyond_what_is_known_of_the_punch_is_refused():
    """Friction moves the contact of a parabola on a coating to -0.39 mm … 0.50 mm."""
    known = [[X, 10.0 * X**2] for X in (-1e-3, -6e-4, 0.0, 4.6e-4)]
    punch = {"profile": "table", "shape": known, "load": "2e4 N/m"}
    changes = {"punch": punch, "solve.methods": ["fem"], "solve.tolerance": 0.1}
    with pytest.raises(SolveError, match=r"known from -0\.001 m to 0\.00046 m only"):
        computed("coating", changes | {"friction.mu_c": 0.4, "motion.strokes": ["backward"]})


@pytest.mark.parametrize("tolerance, mu", [(1e-6, 0.15), (1e-3, 0.9)])
def test_a_point_inside_asks_for_few_cells_and_is_within_its_estimate(tolerance, mu):
    """At free ends the energy in the innermost cells falls faster than the square of their size."""
    result = computed("cylinder_on_steel", {
        "friction.mu": mu, "solve.tolerance": tolerance,
        "output": {"quantities": ["interior"], "points": [[0.0, -1.0]]},
    })  # fmt: skip
    assert result.verdict == "PASS", result.attributes["verdict_reasons"]
    fem, exact = (result.data[f"interior/{method}/von_mises"] for method in ("fem", "closed_form"))
    assert np.abs(fem / exact - 1.0).max() < result.data["states/fem/estimate_inside"][0] < tolerance
    assert result.data["run/fem/cells"][0] < 60


def test_an_edge_that_lifts_off_at_low_degrees_alone_is_down():
    """By the closed form the right edge lifts off at 0.041355311°; finite elements change their mind."""
    tilted = of_sections(
        solid={"E": "40 GPa", "nu": 0.3, "rho": 2000}, friction={"mu": 0.4}, motion={"c": 0.3},
        punch={"half_width": 1e-3, "tilt": 0.0413, "load": 5e4}, solve={"tolerance": 1e-2},
    )  # fmt: skip
    result = galinx.compute(tilted)
    assert result.verdict == "PASS", result.attributes["verdict_reasons"]
    assert result.data["states/fem/half_width"] == [1e-3]
    one, other = (result.data[f"states/{by}/K_I_right"] for by in ("fem", "closed_form"))
    assert 0.0 < other < 0.01 and one == pytest.approx(other, abs=1e-4)
