"""Random stacks of layers by both methods: within the tolerance, and within what they say of it."""

from dataclasses import replace
from time import process_time

import numpy as np
import pytest
from agreement import check
from layers_cases import random_stack
from support import THOROUGH, computed, scene_of

import galinx
from galinx.app.scene.sections import GivenSolid
from galinx.meshes.layered import OnLayers
from galinx.postprocess.compare import judged
from galinx.solvers.contact.edges import under_punch
from galinx.solvers.contact.ends import Punch
from galinx.solvers.contact.equation import Equation, LayersUnderPunch, rule_of_ends
from galinx.solvers.layers.layered import Layer, Layered
from galinx.solvers.profiles.punches import Parabolic
from galinx.solvers.solids.isotropic import Isotropic

HARD, SOFT = Isotropic(7.5, 0.3, 1.2), Isotropic(2.5, 0.25, 1.0)


def of_stack(solid, c, f, quantities=("sif",), tolerance=1e-6):
    """A scene of a layered solid and a punch of half-width 1 m."""
    base = scene_of("coating", {
        "friction.mu_c": 0.4, "motion.speed": "447 m/s", "solve.tolerance": tolerance,
        "output.quantities": list(quantities), "solve.methods": ["sie", "fem"],
    })  # fmt: skip
    return replace(
        base,
        half_plane=GivenSolid(solid=solid.substrate),
        layers=solid.layers,
        punch=replace(base.punch, profile=replace(base.punch.profile, half_width=1.0), loads=(1e-3,)),
        motion=replace(base.motion, c=(c,), speed=None),
        friction=replace(base.friction, parameters={"mu_c": (abs(f),)}, sign=("eq25", "physical")[f > 0]),
    )


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


CASES = [(flat, 6, False, 1e-4), (cylinder, 4, False, 1e-3)]
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


@pytest.mark.parametrize(
    ("thickness", "E", "rho", "c", "f", "tolerance"),
    [(0.091, 686.65, 5395.8, 0.3591, 0.8, 1e-3), (0.0179, 39.383, 14541.8, 0.8, 0.8, 1e-2)],
    ids=["hard", "soft"],
)
def test_alone_over_thin_coatings_the_estimate_covers_the_pressure(thickness, E, rho, c, f, tolerance):
    """Their pressure passes through zero, or changes within the thickness."""
    solid = on(Isotropic(200.0, 0.3, 7.8), thickness, Isotropic(E, 0.3, rho / 1e3))
    both = of_stack(solid, c, f, ("sif", "surface"), tolerance)
    alone = galinx.compute(replace(both, solve=replace(both.solve, methods=("fem",))))
    exact = galinx.compute(
        replace(both, solve=replace(both.solve, methods=("sie",), tolerance=1e-6))
    ).data
    under = under_punch(exact["surface/X_over_a"])
    fem, sie = (
        of[f"surface/{by}/sigma_YY"][:, under] for of, by in ((alone.data, "fem"), (exact, "sie"))
    )
    assert alone.verdict == "PASS", alone.attributes["verdict_reasons"]
    assert (np.abs(fem - sie) / np.maximum(np.abs(sie), 0.1)).max() <= alone.data["states/fem/estimate"][
        0
    ]


def on(substrate, thickness, top, below=None):
    return Layered((Layer(thickness, top, below),), substrate)


_STIFF, _GRADED = Isotropic(200.0, -0.15, 4.2), Isotropic(45.0, 0.2, 7.0)
_TOP, _BELOW = Isotropic(2.187, 0.1076, 0.5076), Isotropic(0.4446, 0.3557, 0.6441)
#: Solid, share of its speed limit, f, and tolerance.
HARDEST = {
    # The pressure has logarithms next to the edges.
    **{f"a thick top graded to {E:g}":
       (on(_STIFF, 4.0, _GRADED, Isotropic(E, 0.15, 5.5)), 0.0, 0.4856549287, 2e-6)
       for E in [200.0, 40.0] * THOROUGH},
    # What the pressure's moments and the layer move reaches ever farther.
    "thin near its limit": (on(SOFT, 0.1, HARD), 0.98, 0.4, 1e-4),
    **({"thick near its limit": (on(SOFT, 3.0, HARD), 0.99, 0.4, 1e-4)} if THOROUGH else {}),
    # No degree mends innermost cells there.
    **{f"innermost cells under a graded top, {tolerance:g}":
       (on(Isotropic(1.3846, 0.3821, 0.5685), 2.312, _TOP, _BELOW), 0.06, 0.0077, tolerance)
       for tolerance in (*[2.4e-3] * THOROUGH, 1e-4)},
}  # fmt: skip


@pytest.mark.parametrize("solid, share, f, tolerance", HARDEST.values(), ids=HARDEST)
def test_the_hardest_stacks_are_within_their_estimates(solid, share, f, tolerance):
    result = galinx.compute(of_stack(solid, share * solid.limit(), f, tolerance=tolerance))
    check(result.data, tolerance)
    # Near the limit a thin layer would be pulled, by both methods alike.
    over = [text for text, (figure, most) in judged(result.attributes).items() if not figure <= most]
    assert all("tension under the punch" in text for text in over), over


@pytest.mark.parametrize(
    ("thickness", "ratio", "f", "R"),
    [*[(4.0, 30.0, 0.5, 5e3), (4.0, 100.0, 0.5, 1.6e4), (2.0, 100.0, 0.5, 8e3)] * THOROUGH,
     (1.0, 30.0, -0.3, 150.0)],
)  # fmt: skip
def test_the_far_boundary_under_stiff_thick_layers_is_in_the_estimate(
    monkeypatch, thickness, ratio, f, R
):
    """Nearer than the tolerance asks for, so that nearly all of the error is its effect."""
    solid = on(Isotropic(1.0, 0.3, 1.0), thickness, Isotropic(ratio, 0.25, ratio**0.5))
    monkeypatch.setattr(OnLayers, "reach", lambda self, required: R)
    data = galinx.compute(of_stack(solid, 0.0, f, tolerance=1e-6)).data
    off = check(data, np.inf)[""].max()
    assert off > 3e-6 and data["states/fem/estimate"][0] <= 5.0 * off


GRADED = {"layer[0].to": {"E": "2.5 GPa", "nu": 0.25, "rho": "1000 kg/m^3"}}


@pytest.mark.parametrize("tolerance", [1e-4, *(1e-6,) * THOROUGH])
@pytest.mark.parametrize("layers", [{}, GRADED], ids=["uniform", "graded"])
def test_stresses_on_the_surface_and_at_interfaces_are_those_of_the_integral_equation(layers, tolerance):
    result = computed("coating", layers | {
        "friction.mu_c": 0.4, "solve.methods": ["sie", "fem"], "solve.tolerance": tolerance,
        "output.quantities": ["sif", "surface", "interfaces"],
    })  # fmt: skip
    assert result.verdict == "PASS"
    assert {"", "_sigma_XX", "_interfaces"} == check(result.data, tolerance).keys()
    above, below = (result.data[f"interfaces/fem/sigma_XX_{side}"] for side in ("above", "below"))
    if layers:  # the solid does not jump there, nor does the stress
        assert np.abs(above - below).max() <= tolerance * np.abs(above).max()
    else:
        assert np.abs(above).max() > 2.0 * np.abs(below).max()


def sweep(solid, c, f, quantities, tolerance):
    """Speeds over c_s under frictions of both directions; how many were solved."""
    one = of_stack(solid, 0.0, f, quantities, tolerance)
    motion = replace(one.motion, c=tuple(c.tolist()), strokes=("forward", "backward"))
    data = galinx.compute(replace(one, motion=motion)).data
    check(data, tolerance)
    return np.count_nonzero(data["run/fem/factorisations"])


@pytest.mark.parametrize(
    ("top", "below", "tolerance", "quantities"),
    [*[(HARD, SOFT, 1e-4, ("sif",))] * THOROUGH, (SOFT, HARD, 1e-2, ("sif", "surface"))],
    ids=lambda value: "",
)
def test_a_dozen_speeds_tell_all_up_to_the_limit(top, below, tolerance, quantities):
    solid = on(below, 0.7, top)
    solved = sweep(solid, np.linspace(0.0, 0.98, 16) * solid.limit(), 0.4, quantities, tolerance)
    # Eleven for the fit, and two that measure its error at the ends of the sweep.
    assert solved <= 13


@pytest.mark.skipif(not THOROUGH, reason="half an hour")
@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("graded", [False, True])
def test_all_speeds_of_random_stacks(seed, graded):
    rng, (solid, _) = np.random.default_rng(300 + seed), random_stack(seed, graded)
    c = np.sort(rng.uniform(0.0, rng.uniform(0.5, 0.98), 24)) * solid.limit()
    tolerance = 10.0 ** rng.uniform(-6.0, -3.0)
    solved = sweep(solid, c, rng.uniform(0.1, 1.0), ("sif", "surface", "interfaces"), tolerance)
    print(seed, graded, f"{tolerance:.0e}", solved, "solved")
