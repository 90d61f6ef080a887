"""Contacts whose ends are found, end to end: finite elements against the integral equation, archives."""

import itertools
from contextlib import nullcontext
from dataclasses import dataclass
from types import SimpleNamespace
from typing import ClassVar

import numpy as np
import pytest
from random_solids import random_solid
from support import THOROUGH, computed

import galinx
from galinx import PROFILES, parameter
from galinx.app.plan.plan import make_plan
from galinx.app.scene.read import parse
from galinx.meshes.kind import check_cells
from galinx.meshes.rings import Refinement, with_kinks
from galinx.solvers.contact.solution import make_contact
from galinx.solvers.errors import SolveError
from galinx.solvers.fem.own_meshes import EndsBetweenKinks, OverLayers
from galinx.solvers.fem.solution import SolvedStates
from galinx.solvers.profiles.punches import Table
from galinx.solvers.solids import Isotropic


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


def of_solid(seed, share):
    """A random solid's section, and a share of its limit."""
    solid = random_solid(seed)
    C = solid.stiffness * 1e10
    constants = [float(C[i, j]) for i, j in zip(*np.triu_indices(3))]
    return f'kind = "anisotropic"\nstiffness = {constants!r}\nrho = 1000.0', repr(share * solid.limit())


@pytest.mark.parametrize("seed", range(60) if THOROUGH else (0, 1))
@pytest.mark.parametrize("tolerance", (1e-6, 1e-9) if THOROUGH else (1e-6,))
def test_finite_elements_find_a_parabolas_ends_in_any_solid(seed, tolerance):
    rng = np.random.default_rng(seed)
    solid, c = of_solid(seed, float(rng.uniform(0.0, 0.99 if THOROUGH else 0.9)))
    punch = 'profile = "parabolic"\nradius = 0.02'
    mu = float(rng.uniform(0.1, 1.2))
    result = galinx.compute(scene(punch, solid, c, f"tolerance = {tolerance}", mu=mu))
    # Of the hardest solids at 0.99 of their limit the estimate says more than 1e-9, the error does not.
    assert result.verdict == "PASS" or tolerance < 1e-6, result.attributes["verdict_reasons"]
    error = result.comparisons["ends of the contact, over its half-width"]
    assert error <= tolerance and error <= result.data["states/fem/estimate"].max()
    assert result.comparisons["largest contact pressure, relative"] <= tolerance


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


def test_a_tilted_punch_through_lift_off():
    """Both edges, then one: finite elements know of neither until they see the intensity."""
    found = []
    for tilt in (0.002, 0.02, -0.02, 0.2):
        result = galinx.compute(scene(f"half_width = 1e-3\ntilt = {tilt}", c="[0.0, 0.5]"))
        assert result.verdict == "PASS", result.attributes["verdict_reasons"]
        data = result.data
        higher = "right" if tilt > 0.0 else "left"
        free = data[f"states/closed_form/K_I_{higher}"] == 0.0
        np.testing.assert_array_equal(data[f"states/fem/K_I_{higher}"] == 0.0, free)
        np.testing.assert_allclose(data["states/fem/half_width"][~free], 1e-3, rtol=1e-15)
        assert np.all(data["states/fem/half_width"][free] < 1e-3)
        found.append(free.mean())
    assert found[0] == 0.0 and found[-1] == 1.0


KINKED = {
    "wedge": {"punch.profile": "wedge", "punch.half_width": None, "punch.slope": 0.005},
    "power": {"punch.profile": "power", "punch.half_width": None, "punch.exponent": 3.0,
              "punch.coefficient": 1e3},
    "rounded": {"punch.profile": "rounded_flat", "punch.half_width": None,
                "punch.flat_half_width": 1e-4, "punch.radius": 0.02},
    "table": {
        "punch.profile": "table", "punch.half_width": None,
        "punch.shape": [["-2 mm", "20 µm"], [-1e-3, 6e-6], [0.0, 0.0], [1e-3, 3e-6], [2e-3, 15e-6]],
    },
}  # fmt: skip


def figure(result, begin):
    """Of the comparison that begins so."""
    return next(value for text, value in result.comparisons.items() if text.startswith(begin))


@pytest.mark.parametrize("name", KINKED if THOROUGH else ["table"])
def test_finite_elements_find_the_ends_of_every_profile(name):
    """From polynomial shapes, the rest on cells graded towards kinks; without the integral equation."""
    few = {"motion.c": 0.5, "motion.strokes": ["forward"], "motion.X_over_L": [0.7]}
    tolerance = 1e-6 if THOROUGH else 1e-5
    asked = {"solve.tolerance": tolerance, "friction.mu_c": 0.6}
    result = computed("tables4_5", KINKED[name] | few | asked)
    assert result.verdict == "PASS", result.attributes["verdict_reasons"]
    error = result.comparisons["ends of the contact, over its half-width"]
    assert 0.0 < error <= tolerance and np.all(error <= result.data["states/fem/estimate"])
    assert 0.0 < figure(result, "σ_YY of contacts") <= 10.0 * tolerance
    in_plane = figure(result, "σ_XX pointwise")
    assert 0.0 < in_plane <= tolerance and in_plane <= result.data["states/fem/estimate_sigma_XX"].max()


def test_a_parabola_is_one_by_every_name():
    """A power of the exponent 2 is the cylinder of its curvature, by both methods."""
    few = {"motion.c": 0.5, "motion.strokes": ["forward"], "motion.X_over_L": [0.7],
           "solve.tolerance": 1e-5, "punch.half_width": None}  # fmt: skip
    names = {"punch.profile": "parabolic", "punch.radius": 0.02}, KINKED["power"] | {
        "punch.exponent": 2.0, "punch.coefficient": 25.0,
    }  # fmt: skip
    cylinder, power = (computed("tables4_5", few | name).data for name in names)
    for path in (f"states/{by}/{of}" for by in ("closed_form", "fem") for of in ("half_width", "centre")):
        np.testing.assert_allclose(power[path], cylinder[path], rtol=1e-13)


def random_punch(seed, rng):
    """A profile with kinks, by turns, in a solid and at a speed."""
    name = list(KINKED)[seed % 4]
    changes = KINKED[name] | {"wedge": {"punch.slope": float(rng.uniform(1e-3, 1e-2))}}.get(name, {})
    if name == "power":
        changes |= {"punch.exponent": float(rng.uniform(1.2, 5.0))}
    if name == "rounded":
        changes |= {"punch.flat_half_width": float(10.0 ** rng.uniform(-4.2, -3.0))}
    return changes


@pytest.mark.parametrize("seed", range(60) if THOROUGH else (1, 2))
@pytest.mark.parametrize("tolerance", (1e-4, 1e-6) if THOROUGH else (1e-4,))
def test_kinks_in_any_solid_have_honest_estimates(seed, tolerance):
    """Ends, pressure, σ_XX and stresses inside: any profile, solid, speed and friction."""
    rng = np.random.default_rng(seed)
    solid = random_solid(seed)
    C = solid.stiffness * 1e10
    constants = [float(C[i, j]) for i, j in zip(*np.triu_indices(3))]
    changes = random_punch(seed, rng) | {
        "solid.E": None, "solid.nu": None, "solid.plane": None, "solid.kind": "anisotropic",
        "solid.stiffness": constants, "solid.rho": 1000.0, "punch.load": 5e4,
        "friction.mu_c": float(rng.uniform(0.1, 1.0)),
        "motion.c": float(rng.uniform(0.0, 0.85)) * solid.limit(),
        "motion.strokes": ["forward"], "motion.X_over_L": [0.7], "solve.tolerance": tolerance,
        "output.quantities": ["sif", "surface", "interior"],
        "output.points": [[0.0, -0.5], [-1.0, -0.1], [0.3, -1.5]],
    }  # fmt: skip
    try:
        result = computed("tables4_5", changes)
    except SolveError as error:
        if "none within 0.01 of an end" not in str(error):
            raise
        pytest.skip("a kink is too near to an end, which is told")
    data = result.data
    assert not len(data.get("run/failures", ())), data["run/failures"]
    ends, in_plane, inside = (
        figure(result, begin) for begin in ("ends of the contact", "σ_XX pointwise", "stresses inside")
    )
    assert 0.0 < ends <= min(tolerance, data["states/fem/estimate"][0])
    assert 0.0 < in_plane <= data["states/fem/estimate_sigma_XX"][0]
    assert 0.0 < inside <= data["states/fem/estimate_inside"][0]
    # What the estimate does not promise the verdict does not either.
    assert in_plane <= 10.0 * tolerance or result.verdict == "FAIL"
    assert figure(result, "σ_YY of contacts") <= 10.0 * tolerance or result.verdict == "FAIL"


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


@dataclass(frozen=True)
class Skew:
    """Height b (e^(±X/b) - 1 ∓ X/b): smooth, of no power, and not its own mirror image."""

    about: ClassVar[str] = "skew"
    sharp: ClassVar[tuple[bool, bool]] = (False, False)

    b: float = parameter("length", "length b", "m", above=0.0)
    way: float = parameter("way", "1, or -1 for its mirror image")

    def height(self, X):
        return self.b * (np.expm1(self.way * X / self.b) - self.way * X / self.b)

    def slope(self, X):
        return self.way * np.expm1(self.way * X / self.b)

    def words(self):
        return f"skew punch, length {self.b:g} m"


@pytest.fixture
def skew(monkeypatch):
    monkeypatch.setitem(PROFILES, "skew", Skew)


#: A scene's keys of punches that are smooth, and how wide they bend over a contact.
SMOOTH = {
    "a user's, gently bent": 'profile = "skew"\nlength = 0.02\nway = 1',
    "a user's, strongly bent": 'profile = "skew"\nlength = 1e-4\nway = 1',
    "|X|⁴": 'profile = "power"\nexponent = 4\ncoefficient = 1e6',
}


@pytest.mark.parametrize(
    "name, seed, share", list(zip(SMOOTH, (0, 1, 2), (0.3, 0.85, 0.6)))[not THOROUGH :]
)
def test_smooth_punches_take_the_parabolas_way(name, seed, share, skew):
    """All states of a speed from one mesh, and the verdict of the defaults."""
    outputs = '["sif", "surface", "interior"]\npoints = [[0.0, -0.7], [1.1, -0.05]]'
    solid, c = of_solid(seed, share)
    asked = scene(SMOOTH[name], solid, c, output=outputs, mu=0.4)
    plan = make_plan(asked)
    assert plan.fem.mode == "found ends" and 3 <= plan.fem.shapes <= 30
    result = galinx.compute(asked)
    assert result.verdict == "PASS", result.attributes["verdict_reasons"]
    assert result.comparisons["ends of the contact, over its half-width"] < 1e-9
    assert result.comparisons["largest contact pressure, relative"] < 1e-8
    data = result.data
    np.testing.assert_allclose(
        data["interior/fem/sigma_YY"], data["interior/closed_form/sigma_YY"], rtol=1e-5
    )


def test_what_is_beyond_the_shapes_is_in_the_estimate(skew, monkeypatch):
    """With three polynomials a strongly bent punch is not itself, and the estimate says so."""
    monkeypatch.setattr("galinx.app.plan.elements._MOST_SHAPES", 3)
    punch = SMOOTH["a user's, strongly bent"]
    result = galinx.compute(scene(punch, c="0.2", output='["sif"]', mu=0.4))
    estimate = result.data["states/fem/estimate"].max()
    assert result.verdict == "FAIL"
    assert result.comparisons["largest contact pressure, relative"] < estimate < 1.0


@pytest.mark.parametrize(
    "exponent, tolerance",
    itertools.product((1.2, 1.35, 1.6), (1e-3, 1e-5, 1e-8)) if THOROUGH else [(1.2, 1e-5), (1.6, 1e-3)],
)
def test_the_error_of_the_pressure_at_a_cusp_is_in_the_estimate(exponent, tolerance):
    """It is a limit, and there is less in it than in the pressure beside it."""
    changes = {
        "motion.c": 0.5, "motion.strokes": ["forward"], "motion.X_over_L": [0.7],
        "solve.tolerance": tolerance, "output.quantities": ["sif"],
        "punch.exponent": exponent, "punch.coefficient": 0.02,
    }  # fmt: skip
    result = computed("tables4_5", KINKED["power"] | changes)
    largest = [result.data[f"states/{method}/largest_pressure"][0] for method in ("fem", "closed_form")]
    error = abs(largest[0] / largest[1] - 1.0)
    assert error <= result.data["states/fem/estimate"][0] <= tolerance


@pytest.mark.parametrize("lean, known", [(0.0, True), (-0.2, False), (0.2, False)])
def test_over_layers_no_contact_is_wider_than_its_punch_is_known(lean, known):
    """From -1.1 to 1.1 of the half-width: a contact whose middle is 0.2 away reaches farther."""
    shape = ((-1.1e-3, 2e-6), (0.0, 0.0), (1.1e-3, 2e-6))
    body = make_contact(Isotropic(2e11, 0.3, 7800.0), Table(shape), 1e5)
    state = SolvedStates(None, body, SimpleNamespace(between=lambda *ends: ends), None)
    search = SimpleNamespace(
        _kept={}, _half_width=lambda h: 1e-3, _contact=lambda h: (state, lean, h),
        _work=SimpleNamespace(plan=SimpleNamespace(tolerance=1e-6)),
    )  # fmt: skip
    with nullcontext() if known else pytest.raises(SolveError, match="the punch is known from"):
        task = SimpleNamespace(body=SimpleNamespace(load=1e5, half_width=1e-3, profile=body.profile))
        OverLayers._solved(search, np.array([0.3]), task)


@pytest.mark.parametrize(
    ("punch", "frictions"),
    [
        ("half_width = 1e-3", 2),
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
