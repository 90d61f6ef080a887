"""Fits of noisy friction that was made with known parameters."""

import numpy as np
import pytest
import random_laws
from scipy.integrate import solve_ivp
from support import THOROUGH

from galinx.solvers.friction import LAWS
from galinx.solvers.friction.fit import Measured, fit, friction, moves
from galinx.solvers.parameters import build_model

#: Standard deviation of the noise.
NOISE = 0.003
L = 1e-4


def motion(speeds, times=400):
    """Forward, backward and so on over L, each at its speed [m/s]: time and position."""
    t, X, now, at = [0.0], [0.0], 0.0, 0.0
    for n, V in enumerate(speeds):
        some = np.linspace(0.0, 1.0, times // len(speeds) + 1)[1:]
        s = 1.0 if n % 2 == 0 else -1.0
        t += (now + some * L / V).tolist()
        X += (at + s * some * L).tolist()
        now, at = t[-1], X[-1]
    return np.array(t), np.array(X)


ONE, MANY = [1e-3] * 3, [1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3]
CASES = {
    "coulomb": (ONE, {"mu_c": 0.37}, {}),
    "dahl": (ONE, {"mu_c": 0.4, "sigma0_over_load": 2.2e4, "delta": 1.4}, {}),
    "bouc_wen": (ONE, {"mu_c": 0.4, "yield_displacement": 2e-5, "exponent": 2.3, "gamma": 0.3}, {}),
    "stribeck": (MANY, {"mu_c": 0.3, "mu_s": 0.5, "stribeck_velocity": 2e-3, "stribeck_exponent": 1.3,
                        "sigma2_over_load": 0.5}, {}),
    "maxwell_slip": (ONE, {"elements": ((1.5e4, 0.2), (2.5e3, 0.15))}, {}),
    "rate_and_state": (MANY, {"reference_friction": 0.6, "reference_speed": 1e-3, "a": 0.02, "b": 0.03,
                              "critical_slip": 2e-5, "state0": 3.0}, {"reference_speed": 1e-3}),
    "table": (ONE, {"shape": ((0.0, -0.3), (5e-5, 0.35), (1e-4, 0.41))}, {}),
    "lugre": (MANY, {"mu_c": 0.3, "mu_s": 0.5, "stribeck_velocity": 2e-3, "sigma0_over_load": 3e4,
                     "sigma2_over_load": 0.5}, {"sigma1_over_load": 0.0, "stribeck_exponent": 2.0}),
}  # fmt: skip


def numbers(values, names):
    """Those that were fitted, by the names that a fit gives them."""
    found = []
    for name in names:
        key, _, at = name.partition("[")
        row, column = map(int, at[:-1].split(", ")) if at else (0, 0)
        found.append(values[key][row][column] if at else values[key])
    return np.array(found)


@pytest.mark.parametrize("name", CASES)
def test_known_parameters_are_found_within_three_standard_deviations(name):
    speeds, true, fixed = CASES[name]
    kind, (t, X) = LAWS[name], motion(speeds)
    way = moves(t, X, kind.depends_on_speed)
    clean = friction(build_model(kind, true | fixed), way, len(t))
    f = clean + NOISE * np.random.default_rng(3).standard_normal(len(t))
    rows = len(next((value for value in true.values() if isinstance(value, tuple)), ()))
    found = fit(kind, [Measured(t, X, f)], fixed, {}, rows or 3)
    off = np.abs(found.best - numbers(true, found.names))
    errors = np.array([*found.deviations.values()])
    assert (off <= 3.0 * errors).all(), dict(zip(found.names, off / errors))
    assert np.nanstd(found.f[0] - f) == pytest.approx(NOISE, rel=0.15)
    assert len(found.names) >= len(true) - 1


def random_fit(name, seed):
    """Random parameters of a law, and its fit to noisy friction along random strokes."""
    rng = np.random.default_rng(seed)
    true = random_laws.parameters(name, rng)
    true = {key: value[:3] if key == "elements" else value for key, value in true.items()}
    fixed = {key: true[key] for key in ("reference_speed", "evolution") if key in true}
    t, X = motion(rng.permutation(np.geomspace(1e-4, 3e-2, 10)), 600)
    kind = LAWS[name]
    f = friction(build_model(kind, true), moves(t, X, kind.depends_on_speed), len(t))
    f = f + NOISE * rng.standard_normal(len(t))
    return true, fit(kind, [Measured(t, X, f)], fixed, {}, len(true.get("elements", ())) or 3)


@pytest.mark.parametrize("seed", range(5 if THOROUGH else 1))
@pytest.mark.parametrize("name", ["coulomb", "dahl", "bouc_wen", "stribeck", "lugre", "rate_and_state"])
def test_random_laws_are_found_within_four_standard_deviations(name, seed):
    true, found = random_fit(name, seed)
    off = np.abs(found.best - numbers({"state0": 1.0, "delta": 1.0} | true, found.names))
    sure, errors = ~np.isin(found.names, found.not_determined), np.array([*found.deviations.values()])
    assert (off[sure] <= 4.0 * errors[sure]).all(), dict(zip(found.names, off))
    assert found.rms == pytest.approx(NOISE, rel=0.1)


@pytest.mark.parametrize("seed", range(3 if THOROUGH else 1))
@pytest.mark.parametrize("name", ["elasto_plastic", "maxwell_slip", "gms"])
def test_laws_of_many_numbers_leave_little_more_than_noise(name, seed):
    """Elements have no order, and small ones hide behind others: friction tells, not the numbers."""
    _, found = random_fit(name, seed)
    assert found.rms <= 1.1 * NOISE


def test_deviations_are_those_of_repeated_measurements():
    t, X = motion(ONE, 150)
    way, kind = moves(t, X, False), LAWS["dahl"]
    clean = friction(build_model(kind, {"mu_c": 0.4, "sigma0_over_load": 2.2e4}), way, len(t))
    rng, best, told = np.random.default_rng(1), [], []
    for _ in range(30):
        f = clean + NOISE * rng.standard_normal(len(t))
        found = fit(kind, [Measured(t, X, f)], {"delta": 1.0}, {})
        best.append(found.best)
        told.append([*found.deviations.values()])
    np.testing.assert_allclose(np.std(best, axis=0), np.mean(told, axis=0), rtol=0.35)


def level(v, law):
    """Stribeck's curve with an exponent of 2."""
    decay = np.exp(-((v / law["stribeck_velocity"]) ** 2))
    return law["mu_c"] + (law["mu_s"] - law["mu_c"]) * decay


def lugre_along(v, t, law):
    """LuGre friction at times t of a speed v(t), by its differential equation in time."""

    def rate(t, ζ):
        return v(t) - abs(v(t)) * ζ / level(v(t), law)

    ζ = solve_ivp(
        lambda t, ζ: law["sigma0_over_load"] * rate(t, ζ), t[[0, -1]], [0.0], "LSODA", t,
        rtol=1e-9, atol=1e-12, max_step=t[1] - t[0],
    ).y[0]  # fmt: skip
    rates = np.array([*map(rate, t, ζ)])
    return ζ + law["sigma1_over_load"] * rates + law["sigma2_over_load"] * v(t)


def aged_along(v, t, law):
    """Rate and state friction with Dieterich's ageing, likewise."""
    a, b, V0, D_c = (law[key] for key in ("a", "b", "reference_speed", "critical_slip"))
    ϑ = solve_ivp(
        lambda t, ϑ: (V0 - abs(v(t)) * ϑ) / D_c, t[[0, -1]], [1.0], "LSODA", t,
        rtol=1e-9, atol=1e-12, max_step=t[1] - t[0],
    ).y[0]  # fmt: skip
    state = (law["reference_friction"] + b * np.log(ϑ)) / a
    return a * np.arcsinh(v(t) / (2.0 * V0) * np.exp(state))


#: Half amplitudes [m] and circular frequencies [1/s] of sums of 1 - cos.
SINE, TWO = [(5e-5, 10.0 * np.pi)], [(5e-5, 2.0 * np.pi / 0.3), (2e-5, 2.0 * np.pi / 0.11)]


@pytest.mark.parametrize(
    "waves, samples", [(SINE, 150), (SINE, 401), (SINE, 481), (TWO, 401)],
    ids=["few", "to a turn", "at turns", "two"],
)  # fmt: skip
@pytest.mark.parametrize("name", ["coulomb", "stribeck", "lugre", "rate_and_state"])
def test_a_smooth_motion_is_fitted_from_its_samples(name, waves, samples):
    """Friction is that of the true speed at each sample, which lies between those before and after."""
    true = {"mu_c": 0.3}
    fixed = {"stribeck_exponent": 2.0}

    def v(t):
        return sum(a * ω * np.sin(ω * t) for a, ω in waves)

    t = np.linspace(0.0, 0.6, samples)
    if name in ("stribeck", "lugre"):
        true |= {"mu_s": 0.5, "stribeck_velocity": 1e-3, "sigma2_over_load": 5.0}
    if name == "lugre":
        true |= {"sigma0_over_load": 3e4, "sigma1_over_load": 20.0}
        f = lugre_along(v, t, true)
    elif name == "rate_and_state":
        fixed = {"reference_speed": 1e-3}
        true = {
            "reference_friction": 0.6,
            "a": 0.04,
            "b": 0.05,
            "critical_slip": 5e-6,
            "state0": 1.0,
        } | fixed
        f = aged_along(v, t, true)
    elif name == "coulomb":
        fixed, f = {}, 0.3 * np.sign(v(t))
    else:
        f = np.sign(v(t)) * level(v(t), true) + true["sigma2_over_load"] * v(t)
    noise = 1e-3 * np.random.default_rng(1).standard_normal(samples)
    measured = Measured(t, sum(a * (1.0 - np.cos(ω * t)) for a, ω in waves), f + noise)
    found = fit(LAWS[name], [measured], fixed, {})
    assert found.rms == pytest.approx(np.sqrt(np.mean(noise**2)), rel=0.1)
    off = np.abs(found.best - numbers(true, found.names)) / np.array([*found.deviations.values()])
    assert (off <= 3.0).all(), dict(zip(found.names, off))


def test_positions_that_are_rounded_or_noisy_turn_no_more_often():
    """Strokes whose positions have steps of 0.2 µm, and a sine with noise of a sixth of a step."""
    t = np.linspace(0.0, 0.6, 388)
    strokes = 1e-4 * (1.0 - np.abs(1.0 - 10.0 * t % 2.0))
    sine = 5e-5 * (1.0 - np.cos(10.0 * np.pi * t))
    for X, v in (
        (2e-7 * np.round(strokes / 2e-7), np.sign(1.0 - 10.0 * t % 2.0)),
        (sine + 5e-8 * np.random.default_rng(7).standard_normal(388), np.sin(10.0 * np.pi * t)),
    ):
        law = fit(LAWS["coulomb"], [Measured(t, X, 0.4 * np.sign(v))], {}, {})
        wrong = np.abs(law.f[0] - 0.4 * np.sign(v)) > 0.1
        assert np.nansum(wrong) <= 3


def test_deviations_of_laws_with_kinks_are_no_smaller_than_their_errors():
    """Elements that just reach their limits are kinks of residuals, between which slopes say nothing."""
    true = {
        "mu_c": 0.4, "mu_s": 0.6, "stribeck_velocity": 1e-3, "attraction_rate": 20.0,
        "elements": ((4e4, 0.25), (1e4, 0.375), (4e3, 0.375)),
    }  # fmt: skip
    t = np.linspace(0.0, 0.6, 2001)
    X, by = sum(a * (1.0 - np.cos(ω * t)) for a, ω in TWO), {"stribeck_exponent": 2.0}
    f = friction(build_model(LAWS["gms"], true | by), moves(t, X, True), len(t))
    f = np.nan_to_num(f[::10]) + 2e-3 * np.random.default_rng(7).standard_normal(201)
    found = fit(LAWS["gms"], [Measured(t[::10], X[::10], f)], by, true, 3)
    stiffness = found.names.index("elements[2, 0]")
    assert abs(found.best[stiffness] - 4e3) < 5.0 * found.deviations["elements[2, 0]"]


def test_strokes_turn_between_samples():
    """Speeds are constant but at the turns, which no sample meets."""
    samples, law = np.linspace(0.0, 3.83, 300), {"mu_c": 0.4, "sigma0_over_load": 2.2e4}
    exact = np.union1d(samples, [1.0, 2.0, 3.0])
    X = 1e-4 * (1.0 - np.abs(1.0 - exact % 2.0))
    clean = friction(build_model(LAWS["dahl"], law), moves(exact, X, False), len(exact))
    at = np.isin(exact, samples)
    way = moves(samples, X[at], False)
    assert [move.s for move in way] == [1, -1, 1, -1]
    np.testing.assert_allclose(
        [move.way for move in way], np.array([1.0, 1.0, 1.0, 0.83]) * 1e-4, rtol=1e-12
    )
    np.testing.assert_allclose(
        friction(build_model(LAWS["dahl"], law), way, 300)[1:], clean[at][1:], atol=1e-12
    )


def test_moves_are_split_where_a_law_wants_it():
    t = np.array([0.0, 1.0, 2.0, 3.0, 5.0, 6.0, 7.0])
    X = np.array([0.0, 1.0, 2.0, 4.0, 4.0, 5.0, 3.0]) * 1e-6
    alike, apart = moves(t, X, False), moves(t, X, True)
    assert [(m.s, m.rest, m.samples) for m in alike] == [
        (1, 0.0, [1, 2, 3]), (1, 2.0, [5]), (-1, 0.0, [6]),
    ]  # fmt: skip
    assert [m.samples for m in apart] == [[1, 2], [3], [5], [6]]
    np.testing.assert_allclose([m.V for m in apart], [1e-6, 2e-6, 1e-6, 2e-6])
    np.testing.assert_allclose(alike[0].slip, [1e-6, 2e-6, 4e-6])


def test_too_few_samples_and_unknown_parameters_are_refused():
    t, X = np.array([0.0, 1.0, 2.0]), np.array([0.0, 1e-6, 2e-6])
    few = [Measured(t, X, np.array([0.0, 0.1, 0.2]))]
    with pytest.raises(ValueError, match="2 samples in motion for 3 parameters"):
        fit(LAWS["dahl"], few, {}, {})
    with pytest.raises(ValueError, match="the parameter 'mu', expected mu_c, sigma0_over_load, delta"):
        fit(LAWS["dahl"], few, {"mu": 1.0}, {})


@pytest.mark.parametrize(
    ("name", "true", "samples"),
    [
        ("stribeck", {"mu_c": 0.268, "mu_s": 0.402, "stribeck_velocity": 2.45e-5,
                      "stribeck_exponent": 1.0}, 800),
        ("maxwell_slip", {"elements": ((9.56e3, 0.194), (4.77e4, 0.159), (3.55e4, 0.234))}, 800),
        ("gms", {"mu_c": 0.4, "mu_s": 0.6, "stribeck_velocity": 5e-5, "attraction_rate": 8.0,
                 "elements": ((3e4, 0.2), (1e4, 0.3), (3e3, 0.5))}, 300),
    ],
)  # fmt: skip
def test_the_search_passes_by_minima_that_leave_more(name, true, samples):
    """Most starts end in one of several times the noise, or one that fewer samples have alone."""
    kind, t = LAWS[name], np.linspace(0.0, 10.0, samples)
    X = 1e-4 * (1.0 - np.cos(0.9 * t) + 0.3 * (1.0 - np.cos(2.9 * t)))
    law = build_model(kind, true)
    f = friction(law, moves(t, X, kind.depends_on_speed), samples)
    f[0] = 0.0
    f += NOISE * np.random.default_rng(0).standard_normal(samples)
    assert fit(kind, [Measured(t, X, f)], {}, {}).rms < 1.1 * NOISE


@pytest.mark.parametrize("seed", [11, 26, 37])
def test_three_springs_are_told_from_false_minima(seed):
    """Starts that knew nothing of one another left up to 20 times the noise of these."""
    rng, turns = np.random.default_rng(seed), 1e-4 * np.array([0.0, 1.0, 0.2, 0.8, 0.3, 1.0])
    limits, slips = 0.4 * rng.dirichlet([2, 2, 2]), np.exp(rng.uniform(*np.log([2e-6, 9e-5]), 3))
    reached = np.append(0.0, np.cumsum(np.abs(np.diff(turns))))
    t = np.linspace(0.0, reached[-1], 240)
    kind, X = LAWS["maxwell_slip"], np.interp(t, reached, turns)
    law = build_model(kind, {"elements": tuple(zip((limits / slips).tolist(), limits.tolist()))})
    f = friction(law, moves(t, X, kind.depends_on_speed), len(t)) + 1e-4 * rng.standard_normal(len(t))
    assert fit(kind, [Measured(t, X, f)], {}, {}, 3).rms < 1.2e-4
