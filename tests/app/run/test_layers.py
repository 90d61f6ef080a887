"""Scenes with layers by the integral equation and by finite elements, from the text to the archive."""

import json
from itertools import product

import numpy as np
import pytest
from agreement import check
from scipy.integrate import trapezoid
from support import THOROUGH, areas, computed, of_sections, scene_of

import galinx
from galinx.meshes.kind import Requirements, check_cells
from galinx.meshes.layered import OnLayers
from galinx.meshes.rings import CONTACT, FAR, FREE
from galinx.solvers.contact import residual
from galinx.solvers.contact.stresses import von_mises
from galinx.solvers.errors import SolveError
from galinx.solvers.solids.isotropic import Isotropic

HARD, SOFT = Isotropic(7.5, 0.3, 1.2), Isotropic(2.5, 0.25, 1.0)
#: scenes/coating.toml for one state, by the integral equation.
ONE = {
    "friction.mu_c": 0.4, "motion.speed": "447.21359549995794 m/s", "solve.tolerance": 1e-6,
    "output.quantities": ["sif"],
}  # fmt: skip
GRADED = {"layer[0].to": {"E": "2.5 GPa", "nu": 0.25, "rho": "1000 kg/m^3"}}


def coated(*changes):
    """The result of that scene with changes."""
    whole = dict(ONE)
    for one in changes:
        whole |= one
    return computed("coating", whole)


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


def test_flat_punches_over_graded_tops_reach_the_usual_tolerance_by_finite_elements():
    """Their pressure has logarithms at the edges, which splines alone follow too near to them."""
    result = coated(GRADED, {"solve.methods": ["sie", "fem"]})
    assert result.verdict == "PASS"
    assert result.data["states/fem/estimate"].max() < 5e-7


@pytest.mark.parametrize("exponent", [1.5, 1.75, 2.0] if THOROUGH else [2.0])
def test_low_powers_of_the_depth_reach_the_usual_tolerance(exponent):
    """Their kernels go with a low power of the distance, which no polynomial follows."""
    powers = {"layer[0].grading": "power", "layer[0].exponent": exponent, "solve.methods": ["sie"]}
    assert coated(GRADED, powers, {"output.quantities": ["sif", "surface"]}).verdict == "PASS"


def test_rows_by_depth_are_linear_grading():
    rows = [[0, "7.5 GPa", 0.3, 1200], ["0.4 mm", "5.5 GPa", 0.28, 1120], ["1 mm", "2.5 GPa", 0.25, 1000]]
    of_rows = {"layer": [{"properties": rows, "yield_strength": "30 MPa"}]}
    assert [layer.yield_strength for layer in scene_of("coating", ONE | of_rows).layers] == [30e6] * 2
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
        assert more[name][1] == pytest.approx(data[name][0], rel=1e-6, abs=0.0) != more[name][0]
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


def test_steep_fibres_as_a_layer_on_themselves_are_one_solid():
    """Stress goes along them in a narrow beam: points of the pressure lie as close as its width."""
    fibres = {
        "kind": "orthotropic", "E1": "200 GPa", "E2": "3 GPa", "E3": "3 GPa", "G12": "2 GPa", "nu12": 0.3,
        "nu13": 0.3, "nu23": 0.3, "rho": "1600 kg/m^3", "angle": 70,
    }  # fmt: skip
    σ = {}
    for method, layer in (("sie", [{"thickness": "0.03 mm"} | fibres]), ("closed_form", None)):
        result = galinx.compute(of_sections(
            solid=fibres, layer=layer, friction={"mu": 0.3}, motion={"speed": "400 m/s"},
            punch={"half_width": "1 mm", "load": "100 N/mm"},
            solve={
                "mode": "traction", "pressure": [[-1, 0], [-0.2, -1], [0.3, -0.5], [1, 0]],
                "methods": [method],
            },
            output={
                "quantities": ["interior"],
                "points": [[x, -0.03] for x in np.linspace(-1.5, 1.5, 13).tolist()],
            },
        ))  # fmt: skip
        assert result.verdict == "PASS"
        σ[method] = [result.data[f"interior/{method}/sigma_{name}"][0] for name in ("XX", "YY", "XY")]
    size = np.abs(σ["closed_form"]).max()
    np.testing.assert_allclose(σ["sie"], σ["closed_form"], rtol=0, atol=1e-12 * size)


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


def test_largest_stresses_below_stiff_fibres_are_those_of_the_mirror_image():
    """Stresses along the interface vary there over a third of its depth, which samples alone miss."""
    fibres = {
        "kind": "orthotropic", "E1": 126e9, "E2": 11e9, "E3": 11e9, "nu12": 0.28, "nu13": 0.28,
        "nu23": 0.4, "G12": 6.6e9, "rho": 1600,
    }  # fmt: skip

    def interface(way, along):
        data = computed(changes={
            "solid": fibres | {"angle": 25 * way},
            "layer": [fibres | {"angle": -60 * way, "thickness": 4e-4}],
            "punch": {"half_width": 1e-3, "load": 4e5}, "motion": {"speed": 1200}, "output": None,
            "friction": {"along": along, "sign": "physical" if way > 0 else "eq25"},
            "solve": {"methods": ["sie"], "tolerance": 1e-4},
            "output.quantities": ["interfaces"],
        }).data  # fmt: skip
        named = {"sigma_YY_max": 1, "sigma_YY_min": 1, "sigma_XY_max": way, "sigma_XX_above_max": 1}
        return [
            sign * data[f"interfaces/sie/{name if sign > 0 else name.replace('max', 'min')}"][0, 0]
            for name, sign in named.items()
        ]

    one = interface(1, [[-1, 0.6], [-0.3, 0.1], [1, 0.4]])
    np.testing.assert_allclose(interface(-1, [[-1, 0.4], [0.3, 0.1], [1, 0.6]]), one, rtol=1e-7)


@pytest.mark.parametrize("wrong, verdict", [(0.0, "PASS"), (0.2, "FAIL")])
def test_alone_they_are_put_into_the_equation_of_layers(wrong, verdict, monkeypatch):
    """A pressure that leans leaves a part of the equation."""
    of_contact = residual.of_contact

    def leaning(response, g, local, body, pressure, *more):
        return of_contact(response, g, local, body, lambda r: pressure(r) * (1.0 + wrong * r), *more)

    monkeypatch.setattr("galinx.solvers.fem.solution.of_contact", leaning)
    result = coated({"solve.tolerance": 1e-3, "solve.methods": ["fem"]})
    assert result.verdict == verdict, result.data["states/fem/residual"]


@pytest.mark.parametrize("depths", [(0.01,), (1.0,), (100.0,), (0.05, 0.1, 7.0)])
def test_meshes_follow_interfaces(depths):
    kind = OnLayers(depths=depths)
    for wanted in (Requirements(1e-6), Requirements(1e-6, nearest=1e-6)):
        mesh = kind.drawn(wanted)
        check_cells(mesh)
        Y = -mesh.points[mesh.cells][..., 1]
        for depth in depths:
            assert not np.any((Y.min(axis=1) < depth - 1e-9) & (Y.max(axis=1) > depth + 1e-9))
        R = kind.reach(wanted)
        assert areas(mesh.points, mesh.cells).sum() == pytest.approx(2.0 * (1.0 + R) * R, rel=1e-12)
        assert all(len(mesh.edges[tag]) for tag in (CONTACT, FREE, FAR))
        contact = mesh.points[mesh.edges[CONTACT]]
        assert np.abs(contact[:, 1, 0] - contact[:, 0, 0]).sum() == pytest.approx(2.0)


@pytest.mark.parametrize("tilt, mu", [(-0.04, 0.4), (0.5, 0.4), (0.04, 0.0)])
def test_a_tilted_punch_on_a_layer_of_its_substrate_is_that_on_the_substrate(tilt, mu):
    """By finite elements against the closed form; an edge lifts off from -0.048° or 0.041° on."""
    scene = {"solid": {"E": "40 GPa", "nu": 0.3, "rho": 2000}, "friction": {"mu": mu},
             "punch": {"half_width": 1e-3, "tilt": tilt, "load": 5e4}, "motion": {"c": 0.3}}  # fmt: skip
    layer = scene["solid"] | {"thickness": "0.4 mm"}
    layered = of_sections(layer=[layer], solve={"methods": ["fem"], "tolerance": 1e-4}, **scene)
    data = galinx.compute(layered).data
    exact = galinx.compute(of_sections(solve={"methods": ["closed_form"]}, **scene)).data
    estimate = data["states/fem/estimate"][0]
    assert estimate < 1e-4
    h, of_exact = (of[f"states/{by}/half_width"][0] for by, of in (("fem", data), ("closed_form", exact)))
    assert abs(h / of_exact - 1.0) <= estimate
    for name in ("centre", "K_I_left", "K_I_right"):
        (one,), (other,) = data[f"states/fem/{name}"], exact[f"states/closed_form/{name}"]
        size = max(abs(other), {"centre": h}.get(name, 0.1))
        assert abs(one - other) <= estimate * size, name
    assert (h < 1e-3) == (tilt > 0.1)
    assert (exact["states/closed_form/K_I_right"][0] == 0.0) == (tilt > 0.1)


def test_an_edge_lifts_off_on_either_side_or_not_at_all_in_one_sweep():
    scene = of_sections(
        solid={"E": "40 GPa", "nu": 0.3, "rho": 2000},
        layer=[{"E": "120 GPa", "nu": 0.3, "rho": 2400, "thickness": "0.5 mm"}],
        punch={"half_width": 1e-3, "tilt": [-0.1, 0.0], "load": [5e4, 5e5]}, friction={"mu": 0.4},
        motion={"c": 0.3}, solve={"methods": ["sie", "fem"], "tolerance": 1e-2},
        output={"quantities": ["sif", "surface"]},
    )  # fmt: skip
    result = galinx.compute(scene)
    assert result.verdict == "PASS", result.attributes["verdict_reasons"]
    check(result.data, 1e-2)
    assert np.sum(result.data["states/fem/half_width"] < 1e-3) == 1
