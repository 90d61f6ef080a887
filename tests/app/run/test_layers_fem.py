"""Finite elements on layered half-planes against the singular integral equation."""

from dataclasses import replace

import numpy as np
import pytest
from agreement import check
from support import THOROUGH
from test_layers import COAT, GRADED, scene

import galinx
from galinx.app.scene.sections import HalfPlane
from galinx.meshes.kind import Requirements, check_cells
from galinx.meshes.layered import OnLayers
from galinx.meshes.rings import CONTACT, FAR, FREE
from galinx.solvers.contact import residual
from galinx.solvers.layers.layered import Layer, Layered
from galinx.solvers.solids.half_plane import DATUM
from galinx.solvers.solids.isotropic import Isotropic


def scene_of(solid, c, f, quantities=("sif",), tolerance=1e-6):
    """Of a layered solid and a punch of half-width 1 m."""
    base = scene(tolerance=tolerance, quantities=quantities, methods=("sie", "fem"))
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


@pytest.mark.parametrize("tolerance", [1e-6, *(1e-8,) * THOROUGH])
def test_the_example(tolerance):
    result = galinx.compute(scene(tolerance=tolerance, methods=("sie", "fem"), quantities=("sif",)))
    data = result.data
    assert result.verdict == "PASS"
    assert off(data) <= data["states/fem/estimate"][0] <= tolerance
    assert data["states/fem/K_I_left"][0] == pytest.approx(0.46957498690109, rel=tolerance)
    assert "states/fem/v0" not in data


@pytest.mark.parametrize("deeper", [200.0, 40.0])
def test_a_thick_graded_top_has_tight_estimates_all_the_same(deeper):
    """Moments of functions that nearly depend on each other spoiled intensities at higher degrees."""
    top, bottom = Isotropic(45.0, 0.2, 7.0), Isotropic(deeper, 0.15, 5.5)
    solid = Layered((Layer(4.0, top, bottom),), Isotropic(200.0, -0.15, 4.2))
    result = galinx.compute(scene_of(solid, 0.0, 0.4856549287, tolerance=2e-6))
    assert result.verdict == "PASS", result.attributes["verdict_reasons"]
    assert off(result.data) <= result.data["states/fem/estimate"][0] <= 2e-6


def test_surface_stresses_within_the_estimate():
    assert "_sigma_XX" in check(galinx.compute(scene(tolerance=1e-4, methods=("sie", "fem"))).data, 1e-4)


@pytest.mark.parametrize(("thickness", "share"), [(0.1, 0.98), (3.0, 0.99)])
def test_near_the_speed_of_waves_along_the_substrate_the_boundary_is_farther(thickness, share):
    """There what the pressure's moments and the layer move reaches ever farther."""
    hard, soft = Isotropic(7.5, 0.3, 1.2), Isotropic(2.5, 0.25, 1.0)
    solid = Layered((Layer(thickness, hard),), soft)
    data = galinx.compute(scene_of(solid, share * solid.limit(), 0.4, tolerance=1e-4)).data
    assert off(data) <= 0.4 * data["states/fem/estimate"][0] <= 1e-4


@pytest.mark.parametrize("tolerance", [2.4e-3, 1e-4])
def test_innermost_cells_under_a_graded_top_are_in_the_estimate(tolerance):
    """No degree mends them, and the many functions of the pressure there enlarge what they leave."""
    top, below = Isotropic(2.187, 0.1076, 0.5076), Isotropic(0.4446, 0.3557, 0.6441)
    solid = Layered((Layer(2.312, top, below),), Isotropic(1.3846, 0.3821, 0.5685))
    data = galinx.compute(scene_of(solid, 0.06 * solid.limit(), 0.0077, tolerance=tolerance)).data
    assert off(data) <= 0.5 * data["states/fem/estimate"][0] <= 0.5 * tolerance


@pytest.mark.parametrize("tolerance", [1e-4, *(1e-6,) * THOROUGH])
@pytest.mark.parametrize("layers", [COAT, GRADED])
def test_stresses_at_interfaces_are_those_of_the_integral_equation(layers, tolerance):
    wanted = dict(tolerance=tolerance, methods=("sie", "fem"), quantities=("sif", "interfaces"))
    result = galinx.compute(scene(layers=layers, **wanted))
    data = result.data
    assert result.verdict == "PASS"
    assert "_interfaces" in check(data, tolerance)
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
    result = galinx.compute(scene(tolerance=1e-3, methods=("fem",), quantities=("sif",)))
    assert result.verdict == verdict, result.data["states/fem/residual"]


@pytest.mark.parametrize("V", [0.0, 0.6])
def test_layers_of_the_substrates_solid_move_as_it_does(V):
    """What is left of the expansion falls with the distance's square."""
    solid = Isotropic(2.5, 0.25, 1.0)
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
        area = sum(
            0.5 * (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum()
            for x, y in [np.moveaxis(mesh.points[mesh.cells], 2, 0)]
        )
        R = kind.radius(wanted)
        assert area == pytest.approx(2.0 * (1.0 + R) * R, rel=1e-12)
        assert all(len(mesh.edges[tag]) for tag in (CONTACT, FREE, FAR))
        contact = mesh.points[mesh.edges[CONTACT]]
        assert np.abs(contact[:, 1, 0] - contact[:, 0, 0]).sum() == pytest.approx(2.0)


@pytest.mark.parametrize(
    ("thickness", "ratio", "f", "R"),
    [(4.0, 30.0, 0.5, 5e3), (4.0, 100.0, 0.5, 1.6e4), (2.0, 100.0, 0.5, 8e3), (1.0, 30.0, -0.3, 150.0)],
)
def test_the_far_boundary_under_stiff_thick_layers_is_in_the_estimate(
    monkeypatch, thickness, ratio, f, R
):
    """Nearer than the tolerance asks for, so that nearly all of the error is its effect."""
    solid = Layered((Layer(thickness, Isotropic(ratio, 0.25, ratio**0.5)),), Isotropic(1.0, 0.3, 1.0))
    monkeypatch.setattr(OnLayers, "radius", lambda self, required: R)
    data = galinx.compute(scene_of(solid, 0.0, f, tolerance=1e-6)).data
    assert 3e-6 < off(data) <= data["states/fem/estimate"][0] <= 5.0 * off(data)
