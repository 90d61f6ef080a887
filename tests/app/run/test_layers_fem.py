"""Finite elements on layered half-planes against the singular integral equation."""

import os
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import trapezoid

import galinx
from galinx.app.scene.scene import HalfPlane
from galinx.meshes.cells import check_cells
from galinx.meshes.kind import Wanted
from galinx.meshes.layered import on_layers
from galinx.meshes.rings import CONTACT, FAR, FREE
from galinx.solvers.layers.far import line_load
from galinx.solvers.layers.medium import Medium
from galinx.solvers.solids.isotropic import Isotropic

sys.path.insert(0, str(Path(__file__).parents[2] / "solvers" / "layers"))
from test_layers import scene
from test_stack import random_stack

THOROUGH = bool(os.environ.get("GALINX_THOROUGH"))


def scene_of(solid, c, f, quantities=("sif",), tolerance=1e-6):
    """Of a layered solid and a punch of half-width 1 m."""
    base = scene(tolerance=tolerance, quantities=quantities, methods=("sie", "fem"))
    return replace(
        base,
        half_plane=HalfPlane(solid.substrate, None, None),
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


def test_surface_stresses_within_the_estimate():
    data = galinx.compute(scene(tolerance=1e-4, methods=("sie", "fem"))).data
    one, other = data["surface/fem/sigma_XX"][0], data["surface/sie/sigma_XX"][0]
    X = data["surface/X_over_a"]
    largest = np.abs(other[np.abs(np.abs(X) - 1.0) >= 1e-2]).max()
    error = (np.abs(one - other) / np.maximum(np.abs(other), largest)).max()
    assert error <= data["states/fem/estimate_sigma_XX"][0] <= 1e-4


@pytest.mark.parametrize("seed", range(30) if THOROUGH else [6])
def test_random_stacks(seed):
    solid, c = random_stack(seed)
    f = np.random.default_rng(1000 + seed).uniform(-1.0, 1.0)
    data = galinx.compute(scene_of(solid, c, f)).data
    assert off(data) <= data["states/fem/estimate"][0] + data["states/sie/estimate"][0]
    assert off(data) <= 1e-6


@pytest.mark.parametrize("depths", [(0.01,), (1.0,), (100.0,), (0.05, 0.1, 7.0)])
def test_meshes_follow_interfaces(depths):
    kind = on_layers(depths)
    for wanted in (Wanted(1e-6), Wanted(1e-6, nearest=1e-6)):
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


@pytest.mark.parametrize("V", [0.0, 0.6])
def test_line_load_balances_and_solves_the_equations(V):
    """Its displacements answer the tractions of a moving line load on the surface, and no others."""
    solid = Isotropic(2.5, 0.25, 1.0)
    medium = Medium(solid.response(V / solid.c_s), 1.0)
    h = 1e-4
    points = np.array([[2.0, -1.0], [-3.0, -0.5], [0.4, -2.0]])
    X, Y = points.T

    def gradients(x, y):
        along = (line_load(medium, x + h, y) - line_load(medium, x - h, y)) / (2.0 * h)
        across = (line_load(medium, x, y + h) - line_load(medium, x, y - h)) / (2.0 * h)
        return np.stack([along, across], axis=-1)  # (loads, component, n, axis)

    def stresses(x, y):
        return medium.response.stresses(np.moveaxis(gradients(x, y), 1, 2))

    # Equation of motion along X and Y, ρV² over μ times the second derivative along X.
    step = 1e-2
    σ_X = (stresses(X + step, Y) - stresses(X - step, Y)) / (2.0 * step)
    σ_Y = (stresses(X, Y + step) - stresses(X, Y - step)) / (2.0 * step)
    u = [line_load(medium, X + shift * step, Y) for shift in (-1.0, 0.0, 1.0)]
    inertia = (V / solid.c_s) ** 2 * (u[0] - 2.0 * u[1] + u[2]) / step**2
    assert np.abs(σ_X[0] + σ_Y[2] - inertia[:, 0]).max() <= 2e-4
    assert np.abs(σ_X[2] + σ_Y[1] - inertia[:, 1]).max() <= 2e-4
    # All of the load passes through a line below.
    x = np.tan(np.linspace(-1.57, 1.57, 20001))
    through = stresses(x, np.full_like(x, -1.0))
    resultants = trapezoid(through[[1, 2]], x, axis=-1)
    assert np.abs(resultants - [[1.0, 0.0], [0.0, 1.0]]).max() <= 2e-3
