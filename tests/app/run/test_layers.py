"""Scenes with layers by the integral equation and by finite elements, from the text to the archive."""

import json
from dataclasses import replace
from itertools import product
from time import process_time

import numpy as np
import pytest
from agreement import check
from layers_cases import SUBSTRATE, random_stack
from scipy.integrate import trapezoid
from support import THOROUGH, computed, scene_of

import galinx
from galinx.app.plan.plan import make_plan
from galinx.app.results.check import faults
from galinx.app.scene.sections import HalfPlane
from galinx.meshes.kind import Requirements, check_cells
from galinx.meshes.layered import OnLayers
from galinx.meshes.rings import CONTACT, FAR, FREE
from galinx.solvers.contact import equation, residual
from galinx.solvers.contact.edges import under_punch
from galinx.solvers.contact.ends import Punch
from galinx.solvers.contact.equation import Equation, LayersUnderPunch, rule_of_ends
from galinx.solvers.contact.stresses import von_mises
from galinx.solvers.errors import SolveError
from galinx.solvers.layers.layered import Layer, Layered
from galinx.solvers.profiles.punches import Parabolic
from galinx.solvers.solids.half_plane import DATUM
from galinx.solvers.solids.isotropic import Isotropic

BOTH = ["sie", "fem"]
HARD, SOFT = Isotropic(7.5, 0.3, 1.2), Isotropic(2.5, 0.25, 1.0)
#: scenes/coating.toml for one state, by the integral equation.
ONE = {
    "friction.mu_c": 0.4, "motion.speed": "447.21359549995794 m/s", "solve.tolerance": 1e-6,
    "output.quantities": ["sif"],
}  # fmt: skip
ALL = {
    "output.quantities": ["sif", "surface", "interior", "interfaces"],
    "output.points": [[0.2, -0.5], [-1.0, -1.4]],
}
GRADED = {"layer[0].to": {"E": "2.5 GPa", "nu": 0.25, "rho": "1000 kg/m^3"}}
#: No layer, and two of the solid below.
_SOFT = {"E": "2.5 GPa", "nu": 0.25, "rho": 1000.0}
BARE = {"layer": None, "solve.methods": ["closed_form"]}
SAME = {"layer": [_SOFT | {"thickness": "1 mm"}] * 2}
CYLINDER = {"punch": {"profile": "parabolic", "radius": "20 mm", "load": 1e5}}
HUMP = [[-1, -1], [0, -1], [0.3, -4], [1, 0]]
GIVEN = {"solve.mode": "traction", "solve.pressure": HUMP}


def coated(*changes):
    """The result of that scene with changes."""
    whole = dict(ONE)
    for one in changes:
        whole |= one
    return computed("coating", whole)


def of_stack(solid, c, f, quantities=("sif",), tolerance=1e-6):
    """A scene of a layered solid and a punch of half-width 1 m."""
    base = scene_of("coating", ONE | {
        "solve.tolerance": tolerance, "output.quantities": list(quantities), "solve.methods": BOTH,
    })  # fmt: skip
    return replace(
        base,
        half_plane=HalfPlane(solid=solid.substrate),
        layers=solid.layers,
        punch=replace(base.punch, profile=replace(base.punch.profile, half_width=1.0), loads=(1e-3,)),
        motion=replace(base.motion, c=(c,), speed=None),
        friction=replace(base.friction, parameters={"mu_c": (abs(f),)}, sign=("eq25", "physical")[f > 0]),
    )


def off(data):
    """Relative differences of K_I at both ends."""
    pairs = [(data[f"states/fem/K_I_{end}"], data[f"states/sie/K_I_{end}"]) for end in ("left", "right")]
    return max(float(np.abs(fem / sie - 1.0).max()) for fem, sie in pairs)


def test_the_example_from_scene_to_archive(tmp_path):
    """Its numbers are those of tests/solvers/layers/test_contact.py."""
    result = coated({"solve.tolerance": 1e-9, "output.quantities": ["sif", "surface"]})
    data = result.data
    assert result.verdict == "PASS"
    assert data["states/sie/K_I_left"][0] == pytest.approx(0.46957498690109, rel=1e-10)
    assert data["states/sie/K_I_right"][0] == pytest.approx(0.44068899120707, rel=1e-10)
    assert data["states/sie/estimate"][0] <= 1e-9
    assert data["states/alpha"][0] == pytest.approx(-0.46191902660637, rel=1e-12)
    X, σ = data["surface/X_over_a"], data["surface/sie/sigma_YY"][0]
    middle = np.flatnonzero(X == 0.0)
    assert σ[middle] / 2.0 == pytest.approx(-0.17306141207014, rel=1e-9)
    assert np.isnan(σ[np.abs(X) > 1.0]).all()
    assert data["states/speed"][0] == pytest.approx(447.21359549995794)
    assert data["states/c"][0] == pytest.approx(0.2**0.5 / np.sqrt(7.5 / 2.6 / 1.2))
    assert data["states/speed_limit"][0] == pytest.approx(919.4016867619661, rel=1e-12)
    result.save(tmp_path / "coated.h5")
    again = galinx.load(tmp_path / "coated.h5")
    assert again.scene.layers == result.scene.layers
    assert json.loads(again.attributes["solid"])["layer 1"].startswith("1 mm of E = 7.5 GPa")


@pytest.mark.parametrize("tolerance", [1e-6, *(1e-8,) * THOROUGH])
def test_the_example_by_finite_elements(tolerance):
    result = coated({"solve.tolerance": tolerance, "solve.methods": BOTH})
    data = result.data
    assert result.verdict == "PASS"
    assert off(data) <= data["states/fem/estimate"][0] <= tolerance
    assert data["states/fem/K_I_left"][0] == pytest.approx(0.46957498690109, rel=tolerance)
    assert "states/fem/v0" not in data


def test_rows_by_depth_are_linear_grading():
    rows = [[0, "7.5 GPa", 0.3, 1200], ["0.4 mm", "5.5 GPa", 0.28, 1120], ["1 mm", "2.5 GPa", 0.25, 1000]]
    of_rows = {"layer": [{"properties": rows}]}
    solids = [scene_of("coating", ONE | layers).body.solid for layers in (GRADED, of_rows)]
    for depth in (0.0, 0.1e-3, 0.4e-3, 0.7e-3, 0.999e-3, 2e-3):
        one, other = (solid.at(depth) for solid in solids)
        assert (one.E, one.ν, one.ρ) == pytest.approx((other.E, other.ν, other.ρ), rel=1e-12)
    assert coated(of_rows).data["states/sie/K_I_left"][0] == pytest.approx(0.505526, rel=1e-5)


@pytest.mark.parametrize("mu", [1e5, 1e16, 1e308])
def test_friction_that_leaves_no_pressure_but_at_an_edge_is_told(mu):
    with pytest.raises(SolveError, match="exponent at an edge is -1"):
        coated({"friction.mu_c": mu})


def test_interfaces_and_inside():
    """Tractions are continuous, in-plane stress is not, and points at the interface lie above it."""
    asked = {"solve.tolerance": 1e-7, "output.quantities": ["interfaces", "interior"],
             "output.points": [[0.5, -1.0], [0.5, -1.0001], [-1.2, -0.4]]}  # fmt: skip
    data = coated(asked).data
    σ = [data[f"interior/sie/sigma_{ij}"][0] for ij in ("XX", "YY", "XY")]
    for points, solid in (([0, 2], HARD), ([1], SOFT)):  # in plane strain, of the solid at each depth
        XX, YY, XY = (of[points] for of in σ)
        expected = von_mises(XX, YY, XY, solid.ν * (XX + YY))
        assert data["interior/sie/von_mises"][0, points] == pytest.approx(expected, rel=1e-12)
    # Estimates are those of each state.
    more = coated(asked, {"friction.mu_c": [0.05, 0.4]}).data
    for name in ("states/sie/estimate_interfaces", "states/sie/estimate_inside"):
        assert more[name][1] == pytest.approx(data[name][0], rel=1e-6) != more[name][0]
    X = data["interfaces/X_over_a"]
    assert data["interfaces/depth_over_a"] == pytest.approx([1.0])
    at = np.argmin(np.abs(X - 0.5))
    assert X[at] == 0.5
    for name, other in (
        ("sigma_YY", "sigma_YY"), ("sigma_XY", "sigma_XY"), ("sigma_XX", "sigma_XX_above"),
    ):  # fmt: skip
        there = data[f"interior/sie/{name}"][0, :2]
        assert there[0] == pytest.approx(data[f"interfaces/sie/{other}"][0, 0, at], abs=1e-8)
    below = data["interior/sie/sigma_XX"][0, 1]
    assert below == pytest.approx(data["interfaces/sie/sigma_XX_below"][0, 0, at], abs=1e-3)
    shear = data["interfaces/sie/sigma_XY"][0, 0]
    assert data["interfaces/sie/sigma_XY_max"][0, 0] == pytest.approx(shear.max(), rel=1e-3)
    assert data["interfaces/sie/sigma_XY_max"][0, 0] >= shear.max()
    place = data["interfaces/sie/sigma_XY_max_X_over_a"][0, 0]
    assert abs(place - X[shear.argmax()]) <= 0.1
    # Tractions along the interface carry the load but for what lies beyond the positions.
    far = np.abs(trapezoid(data["interfaces/sie/sigma_YY"][0, 0], X) + 2.0)
    assert far <= 0.05


@pytest.mark.parametrize(
    "modulus, thickness",
    product(("1 GPa", "450 GPa"), ("2 um", "20 um", "200 um", "2 mm"))
    if THOROUGH
    else [("450 GPa", "20 um"), ("1 GPa", "2 mm")],
)
def test_largest_stresses_along_an_interface_lie_inside_the_window(modulus, thickness):
    """A thin stiff layer has its largest tension six half-widths behind the punch, others farther."""
    data = coated({
        "solid": {"material": "steel"}, "punch": {"half_width": "0.15 mm", "load": "100 N/mm"},
        "layer": [{"E": modulus, "nu": 0.25, "rho": "5220 kg/m^3", "thickness": thickness}],
        "friction.mu_c": 0.15, "motion.speed": "100 m/s", "motion.X_over_L": [1.0],
        "output.quantities": ["interfaces"],
    }).data  # fmt: skip
    X = data["interfaces/X_over_a"]
    for side in ("above", "below"):
        σ = data[f"interfaces/sie/sigma_XX_{side}"][0, 0]
        largest = data[f"interfaces/sie/sigma_XX_{side}_max"][0, 0]
        assert largest >= σ.max() * (1.0 - 1e-12)
        assert X[0] < data[f"interfaces/sie/sigma_XX_{side}_max_X_over_a"][0, 0] < X[-1]
        assert max(σ[0], σ[-1]) < 0.9 * largest


def _on(substrate, thickness, top, below=None):
    return Layered((Layer(thickness, top, below),), substrate)


_STIFF, _GRADED = Isotropic(200.0, -0.15, 4.2), Isotropic(45.0, 0.2, 7.0)
_TOP, _BELOW = Isotropic(2.187, 0.1076, 0.5076), Isotropic(0.4446, 0.3557, 0.6441)
#: Solid, share of its speed limit, f, tolerance, and the share of the estimate that covers the error.
HARDEST = {
    # Moments of functions that nearly depend on each other spoiled intensities at higher degrees.
    **{f"a thick top graded to {E:g}":
       (_on(_STIFF, 4.0, _GRADED, Isotropic(E, 0.15, 5.5)), 0.0, 0.4856549287, 2e-6, 1.0)
       for E in (200.0, *[40.0] * THOROUGH)},
    # What the pressure's moments and the layer move reaches ever farther.
    "thin near its limit": (_on(SOFT, 0.1, HARD), 0.98, 0.4, 1e-4, 0.4),
    "thick near its limit": (_on(SOFT, 3.0, HARD), 0.99, 0.4, 1e-4, 0.4),
    # No degree mends innermost cells there, and the pressure's many functions enlarge what they leave.
    **{f"innermost cells under a graded top, {tolerance:g}":
       (_on(Isotropic(1.3846, 0.3821, 0.5685), 2.312, _TOP, _BELOW), 0.06, 0.0077, tolerance, 0.5)
       for tolerance in (*[2.4e-3] * THOROUGH, 1e-4)},
}  # fmt: skip


@pytest.mark.parametrize("solid, share, f, tolerance, covered", HARDEST.values(), ids=HARDEST)
def test_the_hardest_stacks_are_within_their_estimates(solid, share, f, tolerance, covered):
    result = galinx.compute(of_stack(solid, share * solid.limit(), f, tolerance=tolerance))
    most = tolerance if covered == 0.4 else covered * tolerance
    assert off(result.data) <= covered * result.data["states/fem/estimate"][0] <= most
    assert result.verdict == "PASS" or covered < 1.0, result.attributes["verdict_reasons"]


@pytest.mark.parametrize(
    ("thickness", "ratio", "f", "R"),
    [(4.0, 30.0, 0.5, 5e3), (4.0, 100.0, 0.5, 1.6e4), (2.0, 100.0, 0.5, 8e3), (1.0, 30.0, -0.3, 150.0)],
)
def test_the_far_boundary_under_stiff_thick_layers_is_in_the_estimate(
    monkeypatch, thickness, ratio, f, R
):
    """Nearer than the tolerance asks for, so that nearly all of the error is its effect."""
    solid = _on(Isotropic(1.0, 0.3, 1.0), thickness, Isotropic(ratio, 0.25, ratio**0.5))
    monkeypatch.setattr(OnLayers, "radius", lambda self, required: R)
    data = galinx.compute(of_stack(solid, 0.0, f, tolerance=1e-6)).data
    assert 3e-6 < off(data) <= data["states/fem/estimate"][0] <= 5.0 * off(data)


@pytest.mark.parametrize("tolerance", [1e-4, *(1e-6,) * THOROUGH])
@pytest.mark.parametrize("layers", [{}, GRADED], ids=["uniform", "graded"])
def test_stresses_on_the_surface_and_at_interfaces_are_those_of_the_integral_equation(layers, tolerance):
    asked = {"solve.methods": BOTH, "solve.tolerance": tolerance}
    result = coated(layers, asked, {"output.quantities": ["sif", "surface", "interfaces"]})
    data = result.data
    assert result.verdict == "PASS"
    assert {"", "_sigma_XX", "_interfaces"} == check(data, tolerance).keys()
    above, below = (data[f"interfaces/fem/sigma_XX_{side}"] for side in ("above", "below"))
    if layers == GRADED:  # the solid does not jump there, nor does the stress
        assert np.abs(above - below).max() <= tolerance * np.abs(above).max()
    else:
        assert np.abs(above).max() > 2.0 * np.abs(below).max()


@pytest.mark.parametrize("wrong, verdict", [(0.0, "PASS"), (0.2, "FAIL")])
def test_alone_they_are_put_into_the_equation_of_layers(wrong, verdict, monkeypatch):
    """A pressure that leans leaves a part of the equation."""
    of_contact = residual.of_contact

    def leaning(response, g, local, body, pressure, *more):
        return of_contact(response, g, local, body, lambda r: pressure(r) * (1.0 + wrong * r), *more)

    monkeypatch.setattr("galinx.solvers.fem.solution.of_contact", leaning)
    result = coated({"solve.tolerance": 1e-3, "solve.methods": ["fem"]})
    assert result.verdict == verdict, result.data["states/fem/residual"]


@pytest.mark.parametrize("V", [0.0, 0.6])
def test_layers_of_the_substrates_solid_move_as_it_does(V):
    """What is left of the expansion falls with the distance's square."""
    solid = SOFT
    stack = Layered((Layer(0.7, solid), Layer(0.5, solid)), solid)
    response = stack.response(V / solid.c_s)

    def left(R):
        X, Y = R * np.array([1.0, -1.0, 0.3, -0.7]), np.array([-0.4, -1.0, -R, -0.8 * R])
        datum = DATUM * max(1.0, response.far_length)
        exact = solid.response(response.c).far(X, Y, datum=datum)
        return np.abs(response.far(X, Y, 1) - exact).max()

    near, far = left(50.0), left(100.0)
    assert near < 1e-3
    # A rank may have no node of the far boundary.
    assert response.far(np.empty(0), np.empty(0), 1).shape == (1, 2, 2, 0)
    assert 3.5 < near / far < 4.5


@pytest.mark.parametrize("depths", [(0.01,), (1.0,), (100.0,), (0.05, 0.1, 7.0)])
def test_meshes_follow_interfaces(depths):
    kind = OnLayers(depths=depths)
    for wanted in (Requirements(1e-6), Requirements(1e-6, nearest=1e-6)):
        mesh = kind.drawn(wanted)
        check_cells(mesh)
        Y = -mesh.points[mesh.cells][..., 1]
        for depth in depths:
            assert not np.any((Y.min(axis=1) < depth - 1e-9) & (Y.max(axis=1) > depth + 1e-9))
        x, y = np.moveaxis(mesh.points[mesh.cells], 2, 0)
        area = 0.5 * (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum()
        R = kind.radius(wanted)
        assert area == pytest.approx(2.0 * (1.0 + R) * R, rel=1e-12)
        assert all(len(mesh.edges[tag]) for tag in (CONTACT, FREE, FAR))
        contact = mesh.points[mesh.edges[CONTACT]]
        assert np.abs(contact[:, 1, 0] - contact[:, 0, 0]).sum() == pytest.approx(2.0)


@pytest.mark.parametrize(
    "punch, mu, share",
    [(CYLINDER, mu, c) for mu in ([1e-9, 0.4, 1.0] if THOROUGH else [0.4])
     for c in ([0.0, 0.5, 0.95] if THOROUGH else [0.95])]
    + [(GIVEN, 0.6, c) for c in ([0.0, 0.9] if THOROUGH else [0.9])],
    ids=lambda value: "" if isinstance(value, dict) else str(value),
)  # fmt: skip
def test_layers_of_one_solid_are_the_half_plane(punch, mu, share):
    """All that is told of a contact is that of the closed form."""
    asked = ALL | punch | {
        "motion.speed": None, "friction.mu_c": mu, "solve.tolerance": 1e-9,
        "motion.c": share * SUBSTRATE.limit(), "output.quantities": ["sif", "surface", "interior"],
        "output.points": [[0.2, -0.5], [-1.0, -0.3], [0.7, -3.0]],
    }  # fmt: skip
    layered, plain = (coated(asked, layers).data for layers in (SAME, BARE))
    names = ["surface/{}/sigma_YY", "surface/{}/sigma_XX",
             *(f"interior/{{}}/sigma_{ij}" for ij in ("XX", "YY", "XY"))]  # fmt: skip
    if punch == CYLINDER:
        names.append("states/{}/largest_pressure")
        h = plain["states/closed_form/half_width"][0]
        assert layered["states/sie/half_width"][0] == pytest.approx(h, rel=1e-10)
        centre = plain["states/closed_form/centre"][0]
        assert layered["states/sie/centre"][0] == pytest.approx(centre, abs=1e-10 * h)
    else:
        names.append("states/{}/normal_force")
    for name in names:
        one, other = (data[name.format(by)] for data, by in ((layered, "sie"), (plain, "closed_form")))
        known = np.isfinite(other)
        assert np.array_equal(known, np.isfinite(one)) and known.any()
        most = (1e-8 if punch == CYLINDER else 1e-10) * np.abs(other[known]).max()
        assert np.abs(one - other)[known].max() <= most


@pytest.mark.parametrize("mu", [0.3, 0.9] if THOROUGH else [0.9])
def test_between_a_thick_coating_and_a_thin_one(mu):
    """What the other solid does falls with the thickness over the width, and with its inverse."""
    asked = CYLINDER | {"friction.mu_c": mu}
    hard = {"solid": {"E": "7.5 GPa", "nu": 0.3, "rho": 1200.0}}
    of_coat, below = (
        coated(asked, BARE, more).data["states/closed_form/half_width"][0] for more in (hard, {})
    )
    of = {
        H: coated(asked, {"layer[0].thickness": f"{H} mm"}).data["states/sie/half_width"][0]
        for H in (0.02, 0.04, 1.0, 30.0, 60.0)
    }
    assert of_coat < of[30.0] < of[1.0] < of[0.04] < of[0.02] < below
    off_thick = [of[H] / of_coat - 1.0 for H in (30.0, 60.0)]
    assert off_thick[0] <= 2e-3 and 1.8 < off_thick[0] / off_thick[1] < 4.5
    off_thin = [1.0 - of[H] / below for H in (0.04, 0.02)]
    assert off_thin[0] <= 0.05 and 1.5 < off_thin[0] / off_thin[1] < 2.1  # H, and H log H


def test_many_frictions_and_loads_are_those_of_each():
    many, loads = np.linspace(0.05, 0.9, 12).tolist(), [1e5, 1e6]

    def under(mu, load):
        asked = {"friction.mu_c": mu, "punch.load": load, "output.quantities": ["sif", "surface"]}
        return coated(CYLINDER, asked).data

    together = under(many, loads)
    h = together["states/sie/half_width"].reshape(2, 12)
    # A wider contact sees more of the soft substrate: it grows faster than the root of the load.
    assert np.all(np.diff(np.log(h), axis=0) > 0.5 * np.log(10.0))
    for i, j in ((0, 3), (1, 7)):
        alone, row = under(many[j], loads[i]), 12 * i + j
        for path in ("states/sie/half_width", "surface/sie/sigma_XX"):
            differ = np.abs(together[path][row] - alone[path][0]).max() / np.abs(alone[path][0]).max()
            assert differ <= 1e-6, path


def test_the_search_for_a_half_width_takes_few_trials():
    """Two at a low degree, which tell how loads grow, two at the usual one; then four degrees."""
    asked = {"solve.methods": ["fem"], "solve.tolerance": 1e-6, "friction.mu_c": [0.1, 0.4]}
    data = coated(CYLINDER, asked).data
    assert data["run/fem/factorisations"].sum() <= 2 * (2 + 2 + 4)


def test_finite_elements_know_nothing_of_the_integral_equation(monkeypatch):
    """But where to begin: from another half-width they find the same."""
    asked = CYLINDER | {"solve.methods": ["fem"], "solve.tolerance": 1e-3}
    one = coated(asked).data
    true = equation.half_width_at_rest
    monkeypatch.setattr(equation, "half_width_at_rest", lambda *of: 1.7 * true(*of))
    other = coated(asked).data
    for name in ("half_width", "centre"):
        found = one[f"states/fem/{name}"], other[f"states/fem/{name}"]
        assert np.abs(found[0] - found[1]) <= 1e-4 * one["states/fem/half_width"]
        assert (found[0] != found[1]).all()


def test_both_methods_tell_all_of_a_cylinder_and_the_archive_is_whole(tmp_path):
    result = coated(CYLINDER, ALL, {"solve.tolerance": 1e-3, "solve.methods": BOTH})
    assert result.verdict == "PASS", result.attributes["verdict_reasons"]
    assert {"", "_sigma_XX", "_inside", "_interfaces"} == check(result.data, 1e-3).keys()
    told = " ".join(result.comparisons)
    for text in ("ends of the contact against", "largest contact pressure against", "σ_YY of contacts",
                 "stresses at interfaces against", "stresses inside against"):  # fmt: skip
        assert text in told
    assert result.data["interfaces/depth"] == pytest.approx([1e-3])
    assert "interfaces/depth_over_a" not in result.data
    path = tmp_path / "a.h5"
    result.save(path)
    assert not faults(path)
    again = galinx.load(path)
    again.report(tmp_path / "r.html")
    assert "half-width" in (tmp_path / "r.html").read_text(encoding="utf-8")
    assert any(drawing.name == "interfaces" for drawing in again.drawings(figures=("all",)))


@pytest.mark.parametrize("layers", [{}, *(GRADED,) * THOROUGH])
@pytest.mark.parametrize("tolerance", [1e-3, *(1e-6,) * THOROUGH])
def test_both_methods_tell_all_of_a_given_pressure_and_the_archive_is_whole(layers, tolerance, tmp_path):
    points = {"output.points": [[0.2, -0.5], [-1.0, -0.3], [0.7, -3.0]]}
    asked = {"solve.tolerance": tolerance, "solve.methods": BOTH}
    result = coated(ALL, points, GIVEN, layers, asked)
    data = result.data
    assert result.verdict == "PASS", result.attributes["verdict_reasons"]
    for text, word in (("σ_XX against", "sigma_XX"), ("stresses inside against", "inside"),
                       ("stresses at interfaces against", "interfaces")):  # fmt: skip
        differ = next(value for name, value in result.comparisons.items() if name.startswith(text))
        allowed = sum(data[f"states/{by}/estimate_{word}"].max() for by in ("fem", "sie"))
        assert 0.0 < differ <= min(tolerance, allowed), word
    X, σ = np.array(HUMP).T
    resultant = 55.3e3 * (np.diff(X) * (σ[1:] + σ[:-1])).sum() / 4.0
    assert data["states/fem/normal_force"] == pytest.approx(resultant, rel=1e-12)
    assert "states/fem/K_I_left" not in data and "states/sie/K_I_left" not in data
    result.save(tmp_path / "a.h5")
    assert not faults(tmp_path / "a.h5")


#: Punches other than cylinders.
OTHERS = {
    "wedge": {"profile": "wedge", "slope": "1 deg"},
    "shoulders": {"profile": "rounded_flat", "flat_half_width": "0.5 mm", "radius": "20 mm"},
    "tilted": {"profile": "flat", "half_width": "1 mm", "tilt": "4 deg"},
    "cusp": {"profile": "power", "exponent": 1.5, "coefficient": 0.3},
    "quartic": {"profile": "power", "exponent": 4.0, "coefficient": 1e7},
}


@pytest.mark.parametrize("name", OTHERS if THOROUGH else ["wedge", "tilted"])
def test_the_integral_equation_tells_all_of_every_punch(name):
    """By its own estimates; finite elements say that they do not follow."""
    punch = {"punch": OTHERS[name] | {"load": 2e5}}
    result = coated(punch, ALL)
    assert result.verdict == "PASS", result.attributes["verdict_reasons"]
    infinite = np.isnan(result.data["states/sie/largest_pressure"][0])
    assert infinite == (name in ("wedge", "tilted"))
    α, β = (result.data[f"states/{end}"][0] for end in ("alpha", "beta"))
    assert α + β == pytest.approx(0.0 if name == "tilted" else 1.0)
    plan = make_plan(scene_of("coating", ONE | punch | {"solve.methods": BOTH}))
    if name == "wedge":
        assert plan.methods == ("sie",)
        assert any("smooth punches with two free ends" in text for text in plan.skipped)


def flat(seed, graded, quantities, tolerance):
    """A random stack under a flat punch; one that would have to pull is none the less solved."""
    solid, c = random_stack(seed, graded)
    f = np.random.default_rng(1000 + seed).uniform(-1.0, 1.0)
    return of_stack(solid, c, f, quantities, tolerance)


def cylinder(seed, graded, quantities, tolerance):
    """A random stack under a cylinder whose contact has the half-width 1 m at rest without friction."""
    solid, c = random_stack(seed, graded)
    f = np.random.default_rng(2000 + seed).uniform(-1.0, 1.0)
    base = of_stack(solid, c, f, quantities, tolerance)
    load, response = 1e-3, solid.response(0.0)
    punch = Punch(Parabolic(1.0), 1.0, load / solid.μ)
    kernel = LayersUnderPunch(response, response.stack(1.0), 1e-4, punch).kernel
    equation = Equation(response, kernel, 0.0, np.zeros_like)
    s, lifting, carrying = rule_of_ends(equation, 0.5 if kernel.rough else 60)(())
    m = -(lifting @ s) / lifting.sum()
    profile = Parabolic(float(carrying @ punch.slope(m, 1.0)(s)) / 2.0)
    return replace(base, punch=replace(base.punch, profile=profile, loads=(load,)))


CASES = [(flat, 6, False, 1e-6), (cylinder, 4, False, 1e-3)]
if THOROUGH:
    CASES = [(kind, n, graded, 1e-6)
             for kind in (flat, cylinder) for n in range(15) for graded in (False, True)]  # fmt: skip


@pytest.mark.parametrize(
    "kind, seed, graded, tolerance", CASES, ids=lambda value: getattr(value, "__name__", str(value))
)
def test_random_stacks_are_within_the_tolerance_and_the_estimate(kind, seed, graded, tolerance):
    """GALINX_THOROUGH=1 prints the table of docs/verification.md, by pytest -s -k flat."""
    start = process_time()
    quantities = ("sif", "surface", "interfaces") if THOROUGH else ("sif",)
    data = galinx.compute(kind(seed, graded, quantities, tolerance)).data
    row = [f"seed {seed}, {'graded' if graded else 'uniform'}: {process_time() - start:.0f} s"]
    if "surface/fem/sigma_YY" in data and kind is flat:  # which fixes the moments
        under = under_punch(data["surface/X_over_a"])
        fem, sie = (data[f"surface/{by}/sigma_YY"][:, under] for by in ("fem", "sie"))
        # Below a tenth of the largest stress its own size is not asked for.
        differ = float((np.abs(fem - sie) / np.maximum(np.abs(sie), 0.1)).max())
        row.append(f"pressure {differ:.1e}")
        assert differ <= tolerance
    for what, differ in check(data, tolerance).items():
        estimate = data[f"states/fem/estimate{what}"][0]
        row.append(f"{what.strip('_') or 'K_I'} {differ.max():.1e} of {estimate:.1e}")
    print(", ".join(row))


def sweep(solid, c, f, quantities, tolerance):
    """Speeds over c_s under frictions of both directions."""
    one = of_stack(solid, 0.0, f, quantities, tolerance)
    motion = replace(one.motion, c=tuple(c.tolist()), strokes=("forward", "backward"))
    return galinx.compute(replace(one, motion=motion)).data


@pytest.mark.parametrize(
    ("top", "below", "tolerance", "quantities"),
    [*[(HARD, SOFT, 1e-4, ("sif",))] * THOROUGH, (SOFT, HARD, 1e-2, ("sif", "surface"))],
    ids=lambda value: "",
)
def test_a_dozen_speeds_tell_all_up_to_the_limit(top, below, tolerance, quantities):
    solid = _on(below, 0.7, top)
    data = sweep(solid, np.linspace(0.0, 0.98, 24) * solid.limit(), 0.4, quantities, tolerance)
    # Eleven for the fit, and two that measure its error at the ends of the sweep.
    assert np.count_nonzero(data["run/fem/factorisations"]) <= 13
    check(data, tolerance)


@pytest.mark.skipif(not THOROUGH, reason="half an hour")
@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("graded", [False, True])
def test_all_speeds_of_random_stacks(seed, graded):
    rng, (solid, _) = np.random.default_rng(300 + seed), random_stack(seed, graded)
    c = np.sort(rng.uniform(0.0, rng.uniform(0.5, 0.98), 24)) * solid.limit()
    tolerance = 10.0 ** rng.uniform(-6.0, -3.0)
    data = sweep(solid, c, rng.uniform(0.1, 1.0), ("sif", "surface", "interfaces"), tolerance)
    print(seed, graded, f"{tolerance:.0e}", np.count_nonzero(data["run/fem/factorisations"]), "solved")
    check(data, tolerance)


def test_all_is_linear_in_a_given_pressure_and_in_friction():
    """Two halves of a pressure add up, and a friction between two is between them."""
    asked = GIVEN | {"output.quantities": ["sif", "surface", "interfaces"]}
    parts = [[[-1, -1], [0, -1], [0.3, 0], [1, 0]], [[-1, 0], [0, 0], [0.3, -4], [1, 0]]]
    whole, *halves = (coated(asked, {"solve.pressure": one}).data for one in (HUMP, *parts))
    low, high = (coated(asked, {"friction.mu_c": mu}).data for mu in (0.1, 0.7))
    for path in ("surface/sie/sigma_XX", "interfaces/sie/sigma_XY", "interfaces/sie/sigma_XX_below"):
        size = np.abs(whole[path]).max()
        assert np.abs(whole[path] - sum(one[path] for one in halves)).max() <= 1e-9 * size
        assert np.abs(whole[path] - (low[path] + high[path]) / 2.0).max() <= 1e-9 * size
