"""Stresses in an elastic punch: the plate's of the swapped problem, mirrored at the surface."""

from dataclasses import replace

import numpy as np
import pytest

from galinx.solvers.contact.exact import ExactSolution
from galinx.solvers.contact.solution import Places, Task, make_contact
from galinx.solvers.profiles import PROFILES
from galinx.solvers.solids import SOLIDS, Isotropic
from galinx.solvers.solids.pair import Pair

STEEL = Isotropic(210e9, 0.3, 7850.0)
POLYMER = Isotropic(3e9, 0.38, 1200.0)
FIBRES = SOLIDS["orthotropic"](140e9, 10e9, 10e9, 0.3, 0.3, 0.4, 5e9, 1600.0, 30.0)
POINTS = np.array([[-1.2, -0.1], [0.3, -0.4], [0.0, 0.0], [0.9, -2.0], [-0.4, 0.0]])


def _solution(plate, punch, V=0.0, V_punch=0.0, g=(0.0,), **keys):
    """Stresses of a parabola on a plate at V, under a punch at V_punch over the contact [m/s]."""
    solid = Pair(plate, punch, V_punch, keys.get("strength"))
    body = make_contact(solid, PROFILES["parabolic"](20e-3), 1e5, None, keys.get("of_plate"))
    task = Task(
        0, body, body.response(V / plate.c_s), Places(np.array([0.0]), POINTS), (slice(0, 9),), (1e5,)
    )
    return ExactSolution(task, np.array(g))


def test_the_largest_stress_in_the_punch_is_hertzs():
    """0.557516 of the largest pressure, 0.704290 half-widths deep, at ν = 0.3 in plane strain."""
    found = _solution(POLYMER, STEEL, strength=1e9)
    peak, p0 = found.strength_of_punch.von_mises, 4.0 / np.pi
    np.testing.assert_allclose(
        [peak.value[0] / p0, peak.X[0], peak.Y[0]], [0.557516, 0.0, -0.704290], atol=3e-6
    )
    # The largest pressure goes with the root of the load.
    stress = peak.value[0] * 1e5 / (2.0 * found.half_width[0])
    np.testing.assert_allclose(found.strength_of_punch.first_load, 1e5 * (1e9 / stress) ** 2, rtol=1e-9)


@pytest.mark.parametrize("plate, punch", [(STEEL, POLYMER), (FIBRES, STEEL), (POLYMER, FIBRES)])
@pytest.mark.parametrize("V, V_punch", [(0.0, 0.0), (300.0, 100.0)])
def test_punch_and_plate_change_places(plate, punch, V, V_punch):
    """Seen upside down, g and the angles of fibres have the other sign."""

    def mirrored(solid):
        return replace(solid, angle=-solid.angle) if solid is FIBRES else solid

    g = np.array([-0.4, 0.3])
    found = _solution(plate, punch, V, V_punch, g, strength=2e8, of_plate=1e8)
    swapped = _solution(mirrored(punch), mirrored(plate), V_punch, V, -g, strength=1e8, of_plate=2e8)
    signs = np.array([1.0, 1.0, -1.0])[:, None, None]
    for one, other in ((found, swapped), (swapped, found)):
        np.testing.assert_allclose(one.inside_punch, signs * other.inside, rtol=1e-9, atol=1e-11)
        for name in ("value", "X", "Y"):
            of = getattr(one.strength_of_punch.von_mises, name), getattr(other.strength.von_mises, name)
            np.testing.assert_allclose(*of, rtol=1e-6, atol=1e-4 * (name != "value"))
        np.testing.assert_allclose(one.strength_of_punch.first_load, other.strength.first_load, rtol=1e-6)


def test_tractions_of_both_bodies_are_one():
    found = _solution(STEEL, FIBRES, 400.0, 0.0, (-0.5,))
    on = POINTS[:, 1] == 0.0
    np.testing.assert_allclose(found.inside_punch[1:, :, on], found.inside[1:, :, on], rtol=1e-12)


def test_like_bodies_without_friction_have_mirrored_stresses():
    found = _solution(STEEL, STEEL)
    np.testing.assert_allclose(
        found.inside_punch, found.inside * [[[1.0]], [[1.0]], [[-1.0]]], atol=1e-14
    )
