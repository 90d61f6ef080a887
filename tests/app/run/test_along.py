"""Friction that varies along the contact, from a scene to an archive: both methods, what is refused."""

import numpy as np
import pytest
from support import THOROUGH, computed

from galinx.postprocess.tables import loops_sheet
from galinx.solvers.contact.equation import LayersUnderPunch
from galinx.solvers.errors import SolveError

ISOTROPIC = {"E": "40 GPa", "nu": 0.3, "rho": 2000}
ORTHOTROPIC = {
    "kind": "orthotropic", "E1": "40 GPa", "E2": "10 GPa", "E3": "10 GPa", "G12": "5 GPa", "nu12": 0.3,
    "nu13": 0.3, "nu23": 0.35, "rho": 1600,
}  # fmt: skip


def slid(friction, solid=ISOTROPIC, c=0.3, **sections):
    """The result of a scene of this friction, and of other sections."""
    scene = {"solid": solid, "friction": friction, "motion": {"c": c}}
    return computed(changes=scene | dict.fromkeys(("punch", "solve", "output")) | sections)


def advected(model, **parameters):
    return {"state": "advected", "model": model} | parameters


def random_scene(seed):
    """A random friction, solid and speed."""
    rng = np.random.default_rng(seed)
    solid = ORTHOTROPIC | {"angle": rng.uniform(0.0, 180.0)} if seed % 3 == 1 else ISOTROPIC
    laws = [
        advected("dahl", mu_c=rng.uniform(0.1, 0.8), sigma0_over_load=10.0 ** rng.uniform(2.0, 5.0)),
        advected("dahl", mu_c=rng.uniform(0.1, 0.8), sigma0_over_load=rng.uniform(200.0, 1000.0),
                 delta=float(rng.choice([0.5, 1.5]))),
        advected("maxwell_slip", elements=[[rng.uniform(200.0, 700.0), 0.2], [1000, 0.3]]),
        advected("lugre", mu_c=0.3, mu_s=0.5, stribeck_velocity=1e-3,
                 sigma0_over_load=rng.uniform(300.0, 3e4)),
    ]  # fmt: skip
    inner = np.sort(rng.uniform(-0.9, 0.9, rng.integers(0, 4)))
    f = rng.uniform(0.0, 0.9, len(inner) + 2)
    rows = [[float(X), float(y)] for X, y in zip([-1.0, *inner, 1.0], f)]
    tabulated = {"along": rows, "sign": str(rng.choice(["physical", "eq25"]))}
    friction = tabulated if seed % 2 else laws[seed // 2 % len(laws)]
    return friction, solid, rng.uniform(0.0, 0.6)


@pytest.mark.parametrize("seed", range(20) if THOROUGH else (1, 2))
def test_both_methods_agree_within_tolerance_and_estimate(seed):
    result = slid(*random_scene(seed))
    data = result.data
    assert result.attributes["verdict"] == "PASS", result.attributes["verdict_reasons"]
    for side in ("left", "right"):
        fem, exact = (data[f"states/{name}/K_I_{side}"] for name in ("fem", "closed_form"))
        assert (np.abs(fem / exact - 1.0) <= data["states/fem/estimate"]).all()
    # Without any form of the pressure: from the nodal forces through the mass matrix.
    X = data["surface/X_over_a"]
    raw, exact = data["surface/fem/sigma_YY_raw"], data["surface/closed_form/sigma_YY"]
    np.testing.assert_allclose(raw[:, np.abs(X) < 0.9], exact[:, np.abs(X) < 0.9], rtol=2e-3)


def random_cylinder(seed):
    """A random friction, solid, speed and load under a cylinder."""
    rng = np.random.default_rng(seed)
    solid = ORTHOTROPIC | {"angle": rng.uniform(0.0, 180.0)} if seed % 3 == 1 else ISOTROPIC
    friction = [
        advected("dahl", mu_c=rng.uniform(0.1, 0.8), sigma0_over_load=10.0 ** rng.uniform(2.0, 4.0)),
        advected("lugre", mu_c=0.3, mu_s=0.5, stribeck_velocity=1e-3,
                 sigma0_over_load=rng.uniform(300.0, 3e4)),
        {"along": [[-1, rng.uniform(0.0, 0.8)], [1, rng.uniform(0.1, 0.8)]]},
    ][seed % 3]  # fmt: skip
    return friction, solid, rng.uniform(0.0, 0.6), {"load": f"{rng.uniform(10.0, 200.0)} N/mm"}


@pytest.mark.parametrize("seed", range(20) if THOROUGH else (0, 2))
def test_free_ends_by_both_methods(seed):
    *of_scene, load = random_cylinder(seed)
    result = slid(*of_scene, punch={"profile": "parabolic", "radius": "50 mm"} | load)
    data = result.data
    assert result.attributes["verdict"] == "PASS", result.attributes["verdict_reasons"]
    # Slip follows the half-width, and the mean over X with it.
    assert "mean_f" not in {column.name for column in result.table()}
    fem, sie = (data[f"states/{name}/half_width"] for name in ("fem", "sie"))
    assert (np.abs(fem / sie - 1.0) <= data["states/fem/estimate"] + 1e-6).all()


@pytest.mark.parametrize("seed", range(20) if THOROUGH else (0,))
def test_free_ends_over_layers_by_both_methods(seed):
    friction, _, c, load = random_cylinder(seed)
    layer = {
        "thickness": f"{np.random.default_rng(seed).uniform(0.1, 1.0)} mm",
        "E": "120 GPa",
        "nu": 0.3,
        "rho": 2400,
    }
    result = slid(
        friction, c=c, layer=[layer], punch={"profile": "parabolic", "radius": "50 mm"} | load,
        solve={"methods": ["sie", "fem"], "tolerance": 1e-4},
    )  # fmt: skip
    data = result.data
    assert result.attributes["verdict"] == "PASS", result.attributes["verdict_reasons"]
    # Both ends by two methods, and the resultant of shear, which follows the friction along the contact.
    for name in ("half_width", "centre", "resultant_ratio"):
        fem, sie = (data[f"states/{method}/{name}"] for method in ("fem", "sie"))
        scale = np.abs(data["states/sie/half_width"]) if name == "centre" else np.abs(sie)
        assert (np.abs(fem - sie) <= (data["states/fem/estimate"] + 1e-6) * scale).all()


def test_one_friction_along_a_coated_cylinder_is_a_number():
    layer = {"thickness": "0.5 mm", "E": "120 GPa", "nu": 0.3, "rho": 2400}
    punch = {"profile": "parabolic", "radius": "50 mm", "load": "100 N/mm"}
    sections = {"layer": [layer], "punch": punch, "solve": {"methods": ["fem"], "tolerance": 1e-4}}
    along, number = (slid(f, **sections).data for f in ({"along": [[-1, 0.4], [1, 0.4]]}, {"mu": 0.4}))
    for name in ("half_width", "centre", "largest_pressure"):
        of_along, of_number = (of[f"states/fem/{name}"] for of in (along, number))
        np.testing.assert_allclose(of_along, of_number, rtol=1e-5)


@pytest.mark.parametrize("tilt", ["0.001 deg", "0.02 deg"])
def test_one_friction_along_a_tilted_punch_is_a_number(tilt):
    """Between both edges, and where one lifts off; the mirror image has the opposite tilt and shear."""
    punch = {"half_width": "1 mm", "load": "20 N/mm", "tilt": tilt}
    by = {"punch": punch, "solve": {"methods": ["sie"]}}
    along = slid({"along": [[-1, 0.4], [1, 0.4]]}, **by).data
    number = slid({"mu": 0.4}, punch=punch, solve={"methods": ["closed_form"]}).data
    names = "K_I_left", "K_I_right", "half_width", "centre"
    for name in names:
        of_along, of_number = along[f"states/sie/{name}"], number[f"states/closed_form/{name}"]
        np.testing.assert_allclose(of_along, of_number, rtol=1e-7, atol=1e-12)
    one = slid({"along": [[-1, 0.2], [1, 0.5]]}, **by).data
    by["punch"] = punch | {"tilt": f"-{tilt}"}
    other = slid({"along": [[-1, 0.5], [1, 0.2]], "sign": "eq25"}, **by).data
    for name, mirrored, sign in zip(names, ("K_I_right", "K_I_left", *names[2:]), (1, 1, 1, -1)):
        of_one, of_other = one[f"states/sie/{name}"], sign * other[f"states/sie/{mirrored}"]
        np.testing.assert_allclose(of_one, of_other, rtol=1e-7, atol=1e-12)


def test_an_edge_is_free_where_its_intensity_vanishes():
    """The edge of a tilted punch lifts off at another tilt than with the mean friction all along."""
    tilts = {"from": "0.0225 deg", "to": "0.0235 deg", "number": 11}
    punch = {"half_width": "1 mm", "load": "20 N/mm", "tilt": tilts}
    friction = {"along": [[-1, 0.0], [0.6, 0.0], [1, 0.9]]}
    data = slid(friction, c=0.6, punch=punch, solve={"methods": ["sie"]}).data
    free = data["states/sie/K_I_right"] == 0.0
    assert 0 < free.sum() < 11
    np.testing.assert_array_equal(data["states/alpha"] > 0.0, free)


def test_a_load_without_a_contact_leaves_the_others_theirs(monkeypatch):
    """Each contact is solved once, the one that has no solution once to its tolerance, once to 1e-6."""
    solve, tried = LayersUnderPunch.contact, []

    def contact(self, g, h=1.0, checked=True):
        tried.append(self.punch.profile.radius / self.punch.unit)
        if tried[-1] == max(tried):
            raise SolveError("not resolved")
        return solve(self, g, h, checked)

    monkeypatch.setattr(LayersUnderPunch, "contact", contact)
    friction = advected("dahl", mu_c=0.4, sigma0_over_load=1e4)
    loads = {"profile": "parabolic", "radius": "50 mm", "load": ["10 N/mm", "100 N/mm", "30 N/mm"]}
    only = {"solve": {"methods": ["sie"], "tolerance": 1e-6}}
    result = slid(friction, punch=loads, **only)
    (failure,) = result.data["run/failures"]
    assert failure.endswith("N = 10000 N/m: not resolved") and result.verdict == "FAIL"
    assert len(tried) == 4
    alone = slid(friction, punch=loads | {"load": "30 N/mm"}, **only)
    units, of_alone = ({column.name: column.unit for column in of.table()} for of in (result, alone))
    assert {name: units[name] for name in of_alone} == of_alone
    for path in ("states/sie/half_width", "states/alpha", "states/sie/resultant_ratio"):
        of_all = result.data[path]
        assert np.isnan(of_all[0]) and of_all[2] == alone.data[path][0]


def test_flat_punches_over_layers_by_both_methods():
    layer = {"thickness": "1 mm", "E": "120 GPa", "nu": 0.3, "rho": 2400}
    sections = {"layer": [layer], "solve": {"methods": ["sie", "fem"], "tolerance": 1e-4}}
    result = slid({"along": [[-1, 0.1], [1, 0.5]]}, **sections)
    data = result.data
    assert result.attributes["verdict"] == "PASS", result.attributes["verdict_reasons"]
    for name in ("pressure_centre", "resultant_ratio"):
        fem, sie = (data[f"states/{method}/{name}"] for method in ("fem", "sie"))
        assert np.abs(fem - sie).max() <= 1e-6 and np.abs(sie).min() > 1e-2


def test_archive_has_friction_over_x_its_resultant_and_the_centre():
    data = slid({"along": [[-1, 0.2], [1, 0.5]]}).data
    X = data["surface/X_over_a"]
    np.testing.assert_allclose(data["surface/g"][0], np.where(np.abs(X) < 1.0, -0.35 - 0.15 * X, np.nan))
    assert data["states/f"] == pytest.approx(0.35) and data["states/g"] == pytest.approx(-0.35)
    ratio, centre = (data[f"states/fem/{name}"][0] for name in ("resultant_ratio", "pressure_centre"))
    # σ_XY = g σ_YY with g linear: its resultant is g at the centre of pressure.
    assert ratio == pytest.approx(-0.35 - 0.15 * centre, abs=1e-7) and -0.1 < centre < 0.0


def test_friction_in_the_table_is_the_force_over_the_load():
    """By the forces at nodes; mean f stands beside it, and for one f along the contact both are that."""
    result = slid({"along": [[-1, 0.5], [0.2, 0.5], [1, 0.2]]})
    row = {column.name: column.values for column in result.table()}
    forces = (result.data[f"states/fem/{name}_force"] for name in ("tangential", "normal"))
    assert row["f"] == pytest.approx(abs(np.divide(*forces)), rel=1e-6)
    assert row["mean_f"] == pytest.approx([0.44], rel=1e-12)
    # Loops are those of the law alone: their work and force are none of this contact.
    assert not loops_sheet(result.data, result.units()).rows


@pytest.mark.parametrize("row", [*[[0.203, 0.1]] * THOROUGH, [0.2011, 0.6989]])
def test_kinks_near_each_other_have_cells_between_them(row):
    result = slid({"along": [[-1, 0.2], [0.2, 0.7], row, [1, 0.5]]}, solve={"tolerance": 1e-4})
    assert result.attributes["verdict"] == "PASS", result.attributes["verdict_reasons"]
