"""Flutter thresholds of layers by wavelength: limits, and roots counted by the argument principle."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from galinx.solvers.layers.flutter import LayeredSide, thresholds_by_length
from galinx.solvers.layers.layered import Layer, Layered
from galinx.solvers.solids import SOLIDS, Isotropic

STEEL = Isotropic(210e9, 0.3, 7850.0)
CARBON = Isotropic(300e9, 0.2, 2500.0)
POLYMER = Isotropic(3e9, 0.38, 1200.0)
FIBRES = SOLIDS["orthotropic"](140e9, 10e9, 10e9, 0.3, 0.3, 0.4, 5e9, 1600.0, 60.0)
MM = 1e-3


def _layered(top, below):
    return Layered((Layer(MM, top),), below)


def growing(solid, length, g, fastest=6.0):
    """Number of growing waves with 0.02 < ±C/c_s < fastest and a growth of 1e-4 to 3, for k < 0."""
    side, each = LayeredSide.of_length(solid, length), []
    for low, high in ((-fastest, -0.02), (0.02, fastest)):
        corners = [low - 3j, high - 3j, high - 1e-4j, low - 1e-4j, low - 3j]
        way = np.concatenate([np.linspace(*ends, int(250 * fastest)) for ends in pairwise(corners)])
        L11, L21, _ = side.stiffness(way)
        f = L11 - g * L21  # L₁₁ - g L₂₁ over det L is Y₂₂ + g Y₂₁
        each.append(round(float(np.angle(f[1:] / f[:-1]).sum() / (2.0 * np.pi))))
    return sum(each)


@pytest.mark.parametrize("solid", [STEEL, FIBRES])
def test_a_layer_of_the_solid_below_changes_nothing(solid):
    found = thresholds_by_length(_layered(solid, solid), MM * np.array([0.1, 3.0, 1e3]))
    np.testing.assert_allclose(found.T, [solid.flutter()] * 3, rtol=1e-7)


@pytest.mark.parametrize(
    "top, below, ratio", [(CARBON, STEEL, 2.1), (CARBON, STEEL, 60.0), (FIBRES, POLYMER, 6.0)]
)
def test_waves_grow_from_the_threshold_on(top, below, ratio):
    """The number of roots in the half-plane of growing waves goes from none to one there."""
    solid = _layered(top, below)
    for sign, g in zip((1.0, -1.0), thresholds_by_length(solid, np.array([ratio * MM]))[:, 0]):
        if top is CARBON or sign > 0.0:
            assert growing(solid, ratio * MM, sign * 0.98 * g) == 0
            assert growing(solid, ratio * MM, sign * 1.03 * g) == 1


def test_waves_to_and_fro_across_turned_layers_grow_at_high_speeds():
    """The least crossing of another search, by Stroh's impedances of the layers, is at -177 091 m/s."""
    crystal = SOLIDS["cubic"](165.7e9, 63.9e9, 79.6e9, 2330.0, 20.0)
    stack = Layered((Layer(MM, crystal), Layer(0.5 * MM, STEEL)), Isotropic(70e9, 0.33, 2700.0))
    length = 20.0 * MM
    g = float(thresholds_by_length(stack, np.array([length]))[0, 0])
    assert g == pytest.approx(0.3345, abs=2e-4)
    assert [growing(stack, length, share * g, 40.0) for share in (0.98, 1.03)] == [0, 1]


def test_long_waves_over_a_fast_layer_are_those_of_the_solid_below():
    found = thresholds_by_length(_layered(CARBON, STEEL), np.array([6e3 * MM, 6e4 * MM]))
    np.testing.assert_allclose(found, [[1.002, 1.0002]] * 2, atol=2e-4)


def test_in_a_slow_layer_waves_grow_under_any_friction():
    solid = _layered(POLYMER, STEEL)
    assert (thresholds_by_length(solid, np.array([6.0 * MM])) == 0.0).all()
    assert growing(solid, 6.0 * MM, 0.05) > 0


def test_graded_layers_are_refused():
    graded = Layered((Layer(MM, STEEL, replace(STEEL, E=100e9)),), STEEL)
    with pytest.raises(ValueError, match="graded"):
        thresholds_by_length(graded, np.array([MM]))
