"""Flutter thresholds against Stroh's eigenvectors: in 30 digits, and by counting growing waves."""

from operator import attrgetter

import mpmath as mp
import numpy as np
import pytest
from random_solids import random_solid, stiffness
from stroh import Stroh, admittances

import galinx
from galinx.solvers.layers.layered import Layer, Layered
from galinx.solvers.solids import Isotropic
from galinx.solvers.solids.admittance import Admittance
from galinx.solvers.solids.flutter import Side, thresholds
from galinx.solvers.solids.pair import Pair

#: Solid, angle, smaller of both thresholds, and a speed near that at which waves neither grow nor decay.
TABLE = [
    ("carbon-epoxy", 0.0, 2.68875095, 3.712),
    ("carbon-epoxy", 90.0, 0.37191991, 1.3803),
    ("spruce", 90.0, 0.35101815, 1.142),
    ("copper", 0.0, 1.54691298, 0.936),
    ("copper", 30.0, 0.46258727, -1.8608),
    ("zinc", 30.0, 0.45207929, -1.3669),
    ("silicon", 30.0, 0.70962742, -1.6064),
]


def material(name, angle):
    changes = {"solid.material": name, "solid.angle": f"{angle} deg"}
    return galinx.template("tables4_5", changes).solid


def ratio(C, c):
    """-Y₂₂/Y₂₁ at a speed by eigenvectors of the fundamental matrix, c complex."""
    Y = Stroh(C, c).Y
    return -Y[1, 1] / Y[1, 0]


@pytest.mark.parametrize("name, angle, expected, near", TABLE)
def test_thresholds_are_those_of_waves_that_neither_grow_nor_decay(name, angle, expected, near):
    solid = material(name, angle)
    C = stiffness(solid.response(0.0))
    with mp.workdps(45):
        above = mp.mpc(0, mp.mpf(10) ** -40)  # from where waves grow

        def real(c):
            return ratio(C, c + above).real

        def imaginary(c):
            return ratio(C, c + above).imag

        near = mp.mpf(near)
        if abs(imaginary(near)) < 1e-20:  # all along: an extreme
            c = mp.findroot(
                lambda c: (real(c + 1e-9) - real(c - 1e-9)) * 1e9, (near, near * 1.0001), tol=1e-14
            )
        else:
            c = mp.findroot(imaginary, (near, near * 1.0001), tol=1e-30)
        exact = float(abs(real(c)))
    assert min(solid.flutter()) == pytest.approx(exact, rel=1e-12)
    assert min(solid.flutter()) == pytest.approx(expected, abs=1e-8)


def impedances(solid, speeds, mirrored=False):
    """Tractions by displacements of waves that decay below the surface of a solid [Pa], (n, 2, 2)."""
    C = solid.response(0.0).C[np.triu_indices(3)]
    C = C * [1, 1, -1, 1, -1, 1] if mirrored else C
    return solid.μ * np.linalg.inv(admittances(C, solid.ρ / solid.μ * speeds**2))


def turns(F, unit):
    """Number of zeros of F below the real axis of speeds, by its turns round that half-plane."""
    along = unit * (np.sinh(np.linspace(-8.0, 8.0, 2001)) / np.sinh(8.0) * 50.0 - 1e-5j)
    arc = along[-1].real * np.exp(-1j * np.linspace(0.0, np.pi, 101))[1:-1]
    C = np.concatenate([along, arc, along[:1]])
    values = F(C)
    for _ in range(20):  # where the phase changes fast the path is followed more closely
        fast = np.flatnonzero(np.abs(np.angle(values[1:] / values[:-1])) > 0.5)
        if not len(fast):
            break
        more = (C[fast] + C[fast + 1]) / 2.0
        C, values = np.insert(C, fast + 1, more), np.insert(values, fast + 1, F(more))
    return round(-np.angle(values[1:] / values[:-1]).sum() / (2.0 * np.pi))


def growing(solid, g):
    """Number of growing waves along a rigid punch.

    Fields with Im p > 0 decay below the surface for k < 0, where waves with Im C < 0 grow.
    """

    def F(C):
        L = impedances(solid, C)
        return L[:, 0, 0] - g * L[:, 1, 0]

    return turns(F, solid.response(0.0).C.max() ** 0.5 * solid.c_s)


@pytest.mark.parametrize("solid", [*map(random_solid, range(12)), material("carbon-epoxy", 30.0)])
def test_below_the_threshold_no_wave_grows_and_above_it_some_do(solid):
    """In the last one rounding turns the slope of a real ratio next to the speeds at which roots meet."""
    for sign, g in zip((1.0, -1.0), solid.flutter()):
        limited = min(g, 20.0)
        assert growing(solid, 0.97 * sign * limited) == 0
        if g == limited:
            assert growing(solid, 1.03 * sign * g) > 0


@pytest.mark.parametrize("ν", [-0.9, -0.2, 0.0, 0.01, 0.25, 0.4999])
@pytest.mark.parametrize("plane", ["strain", "stress"])
def test_isotropic_solids_have_1_where_they_grow_narrow_when_pulled(ν, plane):
    solid = Isotropic(2e11, ν, 7800.0, plane)
    np.testing.assert_allclose(solid.flutter(), thresholds(Side.of(solid)), rtol=1e-9)
    assert solid.flutter() == ((1.0, 1.0) if ν > 0.0 else (np.inf, np.inf))


def test_layers_have_that_of_their_surface():
    coating, below = material("carbon-epoxy", 90.0), Isotropic(2e11, 0.3, 7800.0)
    assert Layered((Layer(1e-3, coating),), below).flutter() == coating.flutter()
    assert Layered((Layer(1e-3, below),), coating).flutter() == (1.0, 1.0)


STEEL, CARBIDE = Isotropic(210e9, 0.3, 7850.0), Isotropic(669e9, 0.24, 15630.0)
TITANIUM, ACRYLIC = Isotropic(113.8e9, 0.342, 4430.0), Isotropic(3.3e9, 0.37, 1190.0)


def growing_between(plate, punch, V, V_punch, g):
    """Number of growing waves between two bodies, by a determinant's turns."""
    unit = max(
        plate.response(0.0).surface.C.max() ** 0.5 * plate.c_s,
        punch.response(0.0).C.max() ** 0.5 * punch.c_s,
    )

    def total(C):
        L, M = impedances(plate, C + V), impedances(punch, C + V_punch, True)
        return (
            (L[:, 0, 0] - g * L[:, 1, 0]) * np.linalg.det(M)
            + (M[:, 0, 0] + g * M[:, 1, 0]) * np.linalg.det(L)
        ) / np.abs(np.linalg.det(L) * np.linalg.norm(M, axis=(1, 2)))

    return turns(total, unit)


@pytest.mark.parametrize(
    "plate, punch, V, V_punch",
    [
        (STEEL, CARBIDE, 0.0, 0.0),
        (STEEL, CARBIDE, 950.0, 0.0),
        (STEEL, CARBIDE, 2500.0, 0.0),
        (ACRYLIC, STEEL, 400.0, 100.0),
        (TITANIUM, ACRYLIC, 900.0, 0.0),
        (STEEL, TITANIUM, 1000.0, 0.0),
        (material("copper", 30.0), material("zinc", -20.0), 300.0, 0.0),
        (material("carbon-epoxy", 40.0), STEEL, 200.0, 200.0),
    ],
)
def test_between_two_bodies_no_wave_grows_below_the_threshold_and_some_do_above(plate, punch, V, V_punch):
    for sign, g in zip((1.0, -1.0), Pair(plate, punch, V_punch).flutter(V / plate.c_s)):
        limited = min(g, 5.0)
        if g > 0.0:
            assert growing_between(plate, punch, V, V_punch, 0.97 * sign * limited) == 0
        if g == limited:
            assert growing_between(plate, punch, V, V_punch, sign * (1.5 * g + 0.1)) > 0


def test_like_bodies_flutter_only_where_they_slide_over_one_another():
    assert Pair(STEEL, STEEL, 0.0).flutter(0.0) == (np.inf, np.inf)
    assert Pair(STEEL, STEEL, 0.5 * STEEL.c_s).flutter(0.5) == (np.inf, np.inf)
    assert min(Pair(STEEL, STEEL, 0.0).flutter(0.3)) == 0.0


@pytest.mark.parametrize("ν", [-0.4, 0.0, 0.3, 0.49])
def test_waves_in_isotropic_solids_are_those_of_the_general_form(ν):
    """At complex speeds, and on both sides of the real ones at which roots meet."""
    rng, solid = np.random.default_rng(3), Isotropic(1.0, ν, 1.0).response(0.0)
    C = np.concatenate([rng.normal(0.0, 3.0, 30) + 2j * rng.normal(size=30), rng.uniform(-4.0, 4.0, 30)])
    own, general = solid.admittance, Admittance.of_stiffness(solid.C)
    np.testing.assert_allclose(own.meeting, general.meeting, rtol=1e-12)
    one, other = own.waves(C), general.waves(C)
    for name in ("roots.sum", "roots.product", "G", "L"):
        np.testing.assert_allclose(attrgetter(name)(one), attrgetter(name)(other), rtol=1e-10, atol=1e-11)


@pytest.mark.parametrize("seed", range(4))
def test_thresholds_of_a_pair_have_their_limit_at_ν_one_half(seed):
    """What differs from it goes as the ratio of the wave speeds, the root of 1 - 2ν."""
    rng = np.random.default_rng(seed)
    plate, E, ρ = Isotropic(1.0, rng.uniform(0.0, 0.45), 1.0), *10.0 ** rng.uniform(-1.0, 1.0, 2)
    for order in (1, -1):
        limit, near, nearer = (
            np.array(Pair(*(plate, Isotropic(E, ν, ρ))[::order], 0.0).flutter(0.3))
            for ν in (0.5, 0.5 - 1e-6, 0.5 - 1e-8)
        )
        assert (limit >= 0.0).all() and (
            np.abs(nearer - limit) <= 0.11 * np.abs(near - limit) + 1e-9
        ).all()


def test_under_a_stiff_punch_the_threshold_is_that_of_the_plate():
    stiff = Isotropic(1e25, 0.3, 5e17)
    for plate in (STEEL, material("copper", 30.0), material("carbon-epoxy", 90.0)):
        for c in (0.0, 0.3):
            np.testing.assert_allclose(Pair(plate, stiff, 0.0).flutter(c), plate.flutter(), rtol=1e-8)
