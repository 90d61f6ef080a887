"""Every law against its equations, integrated elsewhere, and laws that are others' limits."""

import mpmath
import numpy as np
import pytest
import random_laws as random
import reference
from support import THOROUGH

from galinx.solvers.friction import LAWS
from galinx.solvers.friction.elasto_plastic import ElastoPlastic
from galinx.solvers.friction.integrate import adaptively, closely, exactly, work
from galinx.solvers.friction.motion import legs, works
from galinx.solvers.parameters import build_model

#: Random sets of parameters, each with a motion of its own.
SETS = 20 if THOROUGH else 2
PLACES = 6


def follow(law, strokes, places=PLACES):
    """f at places of each stroke, and ∫ f v dt over each, as in the reference."""
    z, f, done = law.rest(), [], []
    for s, V, length, rest in strokes:
        z = law.pause(z, rest)
        done.append(float(work(law, z, s, V, length)))
        states = exactly(law, z, s, V, length, np.linspace(0.0, length, places))
        f.append(law.friction(states, s, V))
        z = states[-1]
    return np.array(f), np.array(done)


@pytest.mark.parametrize("name", random.EXACT)
@pytest.mark.parametrize("seed", range(SETS))
def test_exact_laws_are_their_equations(name, seed):
    rng = np.random.default_rng([seed, *name.encode()])
    parameters, strokes = random.parameters(name, rng), random.strokes(rng)
    f, done = follow(build_model(LAWS[name], parameters), strokes)
    f_wanted, wanted = getattr(reference, name)(strokes, PLACES, **parameters)
    scale = np.abs(f_wanted).max()
    np.testing.assert_allclose(f, f_wanted, rtol=0.0, atol=1e-12 * max(scale, 1.0))
    np.testing.assert_allclose(done, wanted, rtol=0.0, atol=1e-12 * max(scale, 1.0) * random.LENGTH)


class Integrated(ElastoPlastic):
    """A law of one's own whose rate alone is known."""

    def exact(self, z, s, V, slip):
        return None

    def work(self, z, s, V, slip):
        return None


@pytest.mark.parametrize("seed", range(SETS))
def test_a_rate_alone_is_integrated(seed):
    """Each state to the last digits, a curve as well as a figure wants, against the formula."""
    rng = np.random.default_rng([seed, 5])
    parameters = random.parameters("elasto_plastic", rng)
    by_formula, law = build_model(ElastoPlastic, parameters), build_model(Integrated, parameters)
    d, starts = np.linspace(0.0, random.LENGTH, 23), ((0.0, 1), (-0.9 * law.μ_C, 1), (0.5 * law.μ_C, -1))
    for z, s in starts:
        z = np.array([z])
        wanted = exactly(by_formula, z, s, 1e-3, random.LENGTH, d)
        closest = exactly(law, z, s, 1e-3, random.LENGTH, d)
        curve = closely(law, z, s, 1e-3, random.LENGTH, d)
        np.testing.assert_allclose(closest, wanted, rtol=0.0, atol=1e-10)
        np.testing.assert_allclose(curve, wanted, rtol=0.0, atol=1e-8)
        assert curve[0] == z and not np.array_equal(curve, closest)


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("seed", range(SETS))
def test_laws_far_from_usual_sizes_are_their_equations(name, seed):
    """Of any stiffness, at any speed, along strokes of a hundredth to ten times what friction needs."""
    rng = np.random.default_rng([seed, 77, *name.encode()])
    parameters = random.parameters(name, rng, wide=True)
    slip = random.slip_of(parameters)
    strokes = [
        (
            int(rng.choice([-1, 1])),
            random.power(rng, -7.0, 1.0),
            slip * random.power(rng, -2.0, 1.0),
            rest,
        )
        for rest in (0.0, 2.0, 0.0, 0.3)
    ]
    f, done = follow(build_model(LAWS[name], parameters), strokes)
    f_wanted, wanted = getattr(reference, name)(strokes, PLACES, **parameters)
    scale = np.abs(f_wanted).max()
    # Integrated in time, the reference itself has no more digits on bristles as stiff as these.
    np.testing.assert_allclose(f, f_wanted, rtol=0.0, atol=1e-9 * scale)
    np.testing.assert_allclose(done, wanted, rtol=0.0, atol=1e-9 * scale * max(s[2] for s in strokes))


def of(name, **parameters):
    return build_model(LAWS[name], parameters)


CURVE = {"mu_c": 0.4, "mu_s": 0.4, "stribeck_velocity": 1e-3}
ELEMENTS = ((1e4, 0.1), (4e3, 0.15), (5e4, 0.15))


@pytest.mark.parametrize(
    "name, own, limit, those, changed",
    [
        ("dahl", {"mu_c": 0.4, "sigma0_over_load": 3e4}, "lugre",
         {"sigma0_over_load": 3e4, **CURVE}, {"sigma1_over_load": 30.0}),
        ("coulomb", {"mu_c": 0.4}, "stribeck", CURVE, {"mu_s": 0.6}),
        ("dahl", {"mu_c": 0.4, "sigma0_over_load": 0.4 / 3e-5}, "bouc_wen",
         {"mu_c": 0.4, "yield_displacement": 3e-5, "gamma": 0.0}, {"gamma": 0.5}),
        ("maxwell_slip", {"elements": ELEMENTS}, "gms",
         {"elements": ELEMENTS, "attraction_rate": 1e15, **CURVE},
         {"attraction_rate": 10.0, "mu_s": 0.6}),
    ],
)  # fmt: skip
def test_laws_that_are_limits_of_others(name, own, limit, those, changed):
    """Without damping, with a constant curve, at infinite attraction: f and work on random motions."""
    rng = np.random.default_rng(1)

    def off(changes):
        worst = 0.0
        for _ in range(20):
            strokes = random.strokes(rng)
            (f, done), (g, wanted) = (
                follow(law, strokes) for law in (of(name, **own), of(limit, **those | changes))
            )
            worst = max(worst, np.abs(f - g).max(), np.abs(done - wanted).max() / random.LENGTH)
        return worst

    assert off({}) <= 1e-12 and off(changed) > 1e-3


@pytest.mark.parametrize("evolution", ["ageing", "slip"])
@pytest.mark.parametrize("factor", [10.0, 0.1])
def test_steps_of_the_speed_show_both_effects_of_rate_and_state(evolution, factor):
    """f jumps by a ln(V/V') and ends (a - b) ln(V/V') away from where it was."""
    law = of("rate_and_state", reference_friction=0.6, reference_speed=1e-6, a=0.01, b=0.015,
             critical_slip=1e-5, evolution=evolution)  # fmt: skip
    V, far = 3e-5, np.array([0.0, 1.0])
    before = law.exact(law.rest(), 1, V, far)[-1]
    after = law.exact(before, 1, factor * V, far)
    f = law.friction(after, 1, factor * V) - law.friction(before, 1, V)
    np.testing.assert_allclose(f, np.log(factor) * np.array([0.01, 0.01 - 0.015]), rtol=0.0, atol=1e-15)
    steady = 0.6 + (0.01 - 0.015) * np.log(V / 1e-6)
    assert law.friction(before, 1, V) == pytest.approx(steady, rel=1e-14)


def test_no_places_have_no_states():
    law = of("dahl", mu_c=0.5, sigma0_over_load=1e4)
    for stops in (True, False):
        states = adaptively(law, law.rest(), 1, 1e-2, 1e-3, np.empty(0), stops)
        assert states.shape == (0, len(law.rest()))


def test_contacts_that_rested_for_ages_are_renewed():
    """A state far above steady sliding loses no digits on its way there: closed form, 40 digits."""
    law = of("rate_and_state", reference_friction=0.6, reference_speed=1e-6, a=0.01, b=0.015,
             critical_slip=1e-5)  # fmt: skip
    V, slips = 10.0, np.array([1e-4, 3e-4, 5e-4, 1e-3])
    f0, V0, a, b, D_c = (mpmath.mpf(value) for value in (0.6, 1e-6, 0.01, 0.015, 1e-5))
    with mpmath.workdps(40):
        steady, ϑ0 = V0 / V, 1.0 + V0 * 1e13 / D_c
        ϑ = [steady + (ϑ0 - steady) * mpmath.exp(-mpmath.mpf(d) / D_c) for d in slips]
        each = [V / (2.0 * V0) * mpmath.exp((f0 + b * mpmath.log(t)) / a) for t in ϑ]
        wanted = [float(a * mpmath.asinh(value)) for value in each]
    f = law.friction(law.exact(law.pause(law.rest(), 1e13), 1, V, slips), 1, V)
    np.testing.assert_allclose(f, wanted, rtol=1e-13)


@pytest.mark.parametrize(
    "name, changes, said",
    [
        ("maxwell_slip", {"elements": ((1e4, 0.0),)}, "above 0"),
        ("maxwell_slip", {"elements": ((1e4,),)}, "rows of 2 finite numbers"),
        ("gms", {"elements": ((-1.0, 0.1),)}, "above 0"),
        ("table", {"shape": ((1e-6, 0.1), (2e-6, 0.2))}, "grow from 0"),
        ("table", {"shape": ((0.0, 0.1), (0.0, 0.2))}, "grow from 0"),
        ("bouc_wen", {"gamma": 1.0}, "< 1"),
        ("elasto_plastic", {"breakaway_ratio": 1.0}, "< 1"),
        ("rate_and_state", {"evolution": "both"}, "'ageing' or 'slip'"),
    ],
)
def test_parameters_outside_their_range_are_refused(name, changes, said):
    good = random.parameters(name, np.random.default_rng(0))
    build_model(LAWS[name], good)
    with pytest.raises(ValueError, match=said):
        build_model(LAWS[name], good | changes)


@pytest.mark.parametrize("r, damping", [(0.7, 0.5), (0.98, 0.02), (0.9999, 0.02), (0.9999, 5.0)])
def test_the_largest_friction_just_after_breakaway(r, damping):
    """It is that of the deflections w passed: w + σ₁V/g (1 - α w), over g."""
    g, σ0, V = 0.4, 2e4, 1e-2
    law = ElastoPlastic(μ_C=g, μ_S=g, v_S=1e-3, σ0=σ0, σ1=damping * g / V, r=r)
    w = np.append(np.linspace(0.0, r, 11), r + (1.0 - r) * np.geomspace(1e-6, 1.0 - 1e-9, 200_001))
    α = np.where(w > r, 0.5 * (1.0 + np.sin(np.pi * (w - 0.5 * (1.0 + r)) / (1.0 - r))), 0.0)
    largest = g * (w + damping * (1.0 - α * w)).max()
    _, found, _ = works(law, legs(["forward"]), 7.0 * g / σ0, V, exactly)
    assert found[0, 0] == pytest.approx(largest, rel=1e-8)
