"""The slider against published numbers, closed forms, another integration and its energy."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp, trapezoid

from galinx.solvers.friction import LAWS
from galinx.solvers.friction.slider import (
    SHORT,
    STAYS,
    STEADY,
    STICK_SLIP,
    Ride,
    Slider,
    _Motion,
    _Piece,
    pull,
)
from galinx.solvers.parameters import build_model

CURVE = {"mu_c": 1.0, "mu_s": 1.5, "stribeck_velocity": 1e-3}
BRISTLES = {"sigma0_over_load": 1e5, "sigma1_over_load": np.sqrt(1e5), "sigma2_over_load": 0.4}


def of(name, **parameters):
    return build_model(LAWS[name], parameters)


def test_lugre_sticks_and_slips_as_published():
    """Canudas de Wit et al. 1995, Table 1 and Fig 6, to the digits of another program."""
    slider = Slider(1.0, 2.0, 0.0, 0.1, 16.0)
    found = pull(slider, of("lugre", **CURVE, **BRISTLES), 1.0)
    assert f"{found.period:.4f}" == "6.3627"
    assert f"{found.slip:.5f}" == "0.63627"
    assert f"{found.peak:.5f}" == "0.36982"
    assert abs(found.least) < 1e-3


def test_with_a_larger_friction_at_rest_it_sticks():
    """It breaks away at N μ_S; Stribeck's curve with μ_S only at rest leaves Coulomb's motion."""
    law = of("stribeck", mu_c=0.5, mu_s=0.7, stribeck_velocity=1e-6)
    slider = Slider(2.0, 8.0, 0.0, 0.1, 40.0)
    found = pull(slider, law, 1.0)
    swing = np.hypot(0.1, 0.2 / 8.0 * 2.0)  # of v, as (μ_S - μ_C) N/k is let go at once
    assert found.peak == pytest.approx(0.1 + swing, rel=1e-3)
    assert found.least == pytest.approx(0.0, abs=1e-9)
    assert found.slip == pytest.approx(0.1 * found.period, rel=1e-9)


@pytest.mark.parametrize("δ", [1.0, 0.5])
def test_dahls_slider_is_the_equations_integrated_by_somebody_else(δ):
    """In one piece, with signed velocities and another scheme; below δ = 1 full slip is reached."""
    slider, N, μ, λ = Slider(1.0, 2.0, 0.3, 0.1, 3.0), 1.0, 0.5, 50.0

    def rates(t, y):
        x, v, f = y
        force = 2.0 * (0.1 * t - x) + 0.3 * (0.1 - v) - N * f
        return [v, force, λ * v * max(1.0 - np.sign(v) * f / μ, 0.0) ** δ]

    times = np.linspace(0.0, 3.0, 7)
    wanted = solve_ivp(
        rates, (0.0, 3.0), [0.0] * 3, "DOP853", times, rtol=1e-12, atol=1e-14, max_step=1e-2
    )
    ride = pull(slider, of("dahl", mu_c=μ, sigma0_over_load=λ, delta=δ), N)
    np.testing.assert_allclose(ride.at(times), wanted.y, atol=1e-7)


OVERDAMPED = {"mu_c": 0.4, "mu_s": 0.4, "stribeck_velocity": 1e-3, "sigma0_over_load": 1e3}
ROCK = {"reference_friction": 0.6, "reference_speed": 1e-6, "a": 0.01, "b": 0.012, "critical_slip": 1e-5}


@pytest.mark.parametrize(
    "law, load, slider, said",
    [
        (of("lugre", **OVERDAMPED, sigma1_over_load=30.0, sigma2_over_load=5.0), 1.0,
         Slider(1.0, 2.0, 0.0, 0.1, 15.0), SHORT),
        # A creep of 80 000 periods of the mass on its spring that follows every digit of the pull.
        (of("lugre", mu_c=0.4, mu_s=0.5, stribeck_velocity=1e-3, sigma0_over_load=1e6,
            sigma1_over_load=100.0), 300.0, Slider(0.1, 1e6, 0.0, 1e-6, 165.0), STEADY),
        # Stiffer than (b - a) N/D_c; friction slows so light a mass down within 1e-18 s.
        (of("rate_and_state", **ROCK), 1e5, Slider(1.0, 1e8, 0.0, 1e-6, 1000.0), STEADY),
        (of("dahl", mu_c=0.5, sigma0_over_load=50.0), 1e3, Slider(1.0, 2.0, 0.0, 0.1, 1.0), STAYS),
        # The swing after it has broken away dies out, by 1.6 % a cycle.
        (of("dahl", mu_c=0.4, sigma0_over_load=2e4), 1e3, Slider(2.0, 2e6, 10.0, 0.01, 0.2), SHORT),
    ],
)  # fmt: skip
def test_sliders_without_a_cycle_are_followed_to_their_end(law, load, slider, said):
    assert pull(slider, law, load).outcome == said


def test_a_cycle_with_two_slips_ends_where_the_first_one_comes_back():
    """The spring says which slip is like which: it gets longer by the drive less the slip."""
    T, V, end = 2.0, 0.1, 13.0
    motion = _Motion(Slider(1.0, 2.0, 0.0, V, end), of("dahl", mu_c=0.5, sigma0_over_load=50.0), 1.0)
    t, ω = np.linspace(0.0, end, 4001), 2.0 * np.pi / T * np.array([[1.0], [2.0]])

    def moved(t):  # v - V = V [sin ωt + 2 sin 2ωt], which rises through 0 twice a period
        (e1, e2), (v1, v2) = V / ω * (np.cos(ω * t) - 1.0), V * np.sin(ω * t)
        return np.vstack([e1 + 2.0 * e2, V + v1 + 2.0 * v2, 0.0 * t])

    motion.pieces = [_Piece(0.0, end, 1, t, moved)]
    rises = np.sort(np.append(np.arange(1.0, 7.0) * T, np.arange(0.0, 6.0) * T + T / 2.0))
    motion.crossings = [(at, moved(np.array([at]))[[0, 2], 0]) for at in rises.tolist()]
    ride = Ride(motion)
    np.testing.assert_allclose([ride.period, ride.slip], [T, V * T], rtol=1e-12)
    assert ride.peak == pytest.approx(ride.v.max(), rel=1e-4) and ride.outcome == STICK_SLIP
    motion.crossings = motion.crossings[:2]  # one of each
    assert np.isnan(Ride(motion).period) and Ride(motion).outcome == SHORT


#: A LuGre slider whose steady sliding is unstable: it grows by e within 0.6 s, and sticks after 16 s.
RINGS = of("lugre", mu_c=1.0, mu_s=1.5, stribeck_velocity=1e-3, sigma0_over_load=1e5,
           sigma1_over_load=100.0, sigma2_over_load=0.4)  # fmt: skip


@pytest.mark.parametrize("end", [9.0, 12.0])
def test_a_swing_that_grows_is_neither_steady_nor_a_cycle(end):
    ride = pull(Slider(1.0, 2000.0, 0.0, 1e-4, end), RINGS, 1.0)
    assert ride.outcome == SHORT and np.isnan(ride.period)


ELEMENTS = ((300.0, 0.3), (100.0, 0.3))


@pytest.mark.parametrize(
    "law",
    [
        of("dahl", mu_c=0.6, sigma0_over_load=300.0), of("maxwell_slip", elements=ELEMENTS),
        of("bouc_wen", mu_c=0.6, yield_displacement=2e-3, exponent=2.0),
        of("elasto_plastic", **CURVE | {"stribeck_velocity": 1e-2}, sigma0_over_load=300.0),
        of("gms", **CURVE | {"stribeck_velocity": 1e-1}, elements=ELEMENTS, attraction_rate=20.0),
        of("stribeck", mu_c=0.5, mu_s=0.7, stribeck_velocity=1e-2),
        of("table", shape=((0.0, 0.0), (5e-3, 0.4), (1e-2, 0.5))),
        of("rate_and_state", reference_friction=0.6, reference_speed=1e-2, a=0.1, b=0.12,
           critical_slip=0.02),
    ],
    ids=lambda law: type(law).__name__,
)  # fmt: skip
def test_the_drive_gives_what_friction_takes_and_the_spring_and_the_mass_hold(law):
    slider, N = Slider(1.0, 20.0, 2.0, 0.1, 4.0), 1.3
    ride = pull(slider, law, N)
    assert ride.t[-1] == pytest.approx(4.0) and (np.diff(ride.t) >= 0.0).all()
    t = np.linspace(0.0, 4.0, 8001)
    x, v, f = ride.at(t)
    e, over = 0.1 * t - x, 0.1 - v
    given = trapezoid(0.1 * (20.0 * e + 2.0 * over), t)
    taken = trapezoid(N * f * v + 2.0 * over**2, t)
    held = 0.5 * v[-1] ** 2 + 10.0 * e[-1] ** 2
    assert given == pytest.approx(taken + held, rel=1e-4)
    np.testing.assert_allclose(np.diff(x), 0.5 * (v[1:] + v[:-1]) * np.diff(t), atol=1e-5)


@pytest.mark.parametrize("stiffness, duration", [(8.0, 20.0), (1e8, 2.0)])
def test_a_slider_is_told_between_steps_as_it_is_at_them(stiffness, duration):
    """v = V (1 - cos ωt) at any time, in six cycles and in 3183: a cycle that comes back goes on so."""
    slider = Slider(1.0, stiffness, 0.0, 0.1, duration)
    ride = pull(slider, of("coulomb", mu_c=0.5), 1.0)
    t, ω = np.linspace(0.0, duration, 4001), np.sqrt(stiffness)
    later = np.maximum(t - 0.5 / (stiffness * 0.1), 0.0)
    x, v, f = ride.at(t)
    np.testing.assert_allclose(v, 0.1 * (1.0 - np.cos(ω * later)), rtol=0.0, atol=1e-8 * 0.2)
    np.testing.assert_allclose(x, 0.1 * (later - np.sin(ω * later) / ω), rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(f[later > 0.0], 0.5, rtol=1e-9)
    assert ride.peak == pytest.approx(0.2, rel=1e-8)
    assert abs(ride.least) < 1e-9
    assert len(ride.t) < 2000  # not of thousands of cycles


def test_a_stick_slip_that_comes_back_goes_on_so():
    """Bristles wiped out by each stick: the last of many cycles is that of a few."""
    law, load = of("stribeck", **CURVE), 1.0
    short, long = (pull(Slider(1.0, 2.0, 0.0, 0.1, end), law, load) for end in (60.0, 400.0))
    assert long.t[-1] < 100.0
    t = np.linspace(30.0, 60.0, 101)
    np.testing.assert_allclose(long.at(t), short.at(t), rtol=0.0, atol=1e-7)
    x, v, f = long.at(t + 40.0 * long.period)
    np.testing.assert_allclose([x - 40.0 * long.slip, v, f], short.at(t), rtol=0.0, atol=1e-7)


def test_every_slip_has_its_peak_among_the_times_of_slips():
    """Each lasts a hundredth of the time between two; the drive's distance is that of the slips."""
    slider, end = Slider(2.0, 2e6, 10.0, 0.01, 20.0), 20.0
    law = of("stribeck", mu_c=0.4, mu_s=0.6, stribeck_velocity=1e-3)
    ride = pull(slider, law, 1e4)
    times = ride.slips(end, 100_000)
    v = ride.at(times)[1]
    tops = np.flatnonzero((v[1:-1] > v[:-2]) & (v[1:-1] >= v[2:])) + 1
    assert len(tops) == int((end - ride.crossings[0]) / ride.period) + 1
    np.testing.assert_allclose(v[tops], ride.peak, rtol=1e-6)
    np.testing.assert_allclose(np.diff(times[tops]), ride.period, rtol=1e-5)
    few = ride.slips(end, 4 * len(tops))
    assert set(times[tops]) <= set(few)
    few = ride.slips(end, 500)
    assert 250 < len(few) <= 500 and set(few) <= set(times)


def test_what_rings_without_end_is_told(monkeypatch):
    import galinx.solvers.friction.slider as module

    monkeypatch.setattr(module, "PIECES", 3)
    with pytest.raises(ValueError, match="stopped, started and switched 3 times"):
        law = of("stribeck", mu_c=0.5, mu_s=0.7, stribeck_velocity=1e-2)
        pull(Slider(2.0, 8.0, 0.0, 0.1, 40.0), law, 1.0)


def test_a_friction_that_would_drive_the_mass_is_refused():
    """A measured loop's branch begins below zero: at a reversal, not where a mass starts from rest."""
    rows, slider = [(5e-3, 0.1), (3e-2, 0.35)], Slider(1.0, 100.0, 0.0, 0.01, 1.0)
    with pytest.raises(ValueError, match=r"coefficient -0\.4 where motion starts.*drives the mass"):
        pull(slider, of("table", shape=((0.0, -0.4), *rows)), 1.0)
    assert pull(slider, of("table", shape=((0.0, 0.0), *rows)), 1.0).v.max() > 0.0
