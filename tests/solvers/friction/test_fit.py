"""Fits of noisy friction that was made with known parameters."""

import numpy as np
import pytest
import random_laws
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


def test_moves_are_split_where_a_law_wants_it():
    t = np.array([0.0, 1.0, 2.0, 3.0, 5.0, 6.0, 7.0])
    X = np.array([0.0, 1.0, 2.0, 4.0, 4.0, 5.0, 3.0]) * 1e-6
    alike, apart = moves(t, X, False), moves(t, X, True)
    assert [(m.s, m.rest, m.samples.tolist()) for m in alike] == [
        (1, 0.0, [1, 2, 3]), (1, 2.0, [5]), (-1, 0.0, [6]),
    ]  # fmt: skip
    assert [m.samples.tolist() for m in apart] == [[1, 2], [3], [5], [6]]
    np.testing.assert_allclose([m.V for m in apart], [1e-6, 2e-6, 1e-6, 2e-6])
    np.testing.assert_allclose(alike[0].slip, [1e-6, 2e-6, 4e-6])


def test_too_few_samples_and_unknown_parameters_are_refused():
    t, X = np.array([0.0, 1.0, 2.0]), np.array([0.0, 1e-6, 2e-6])
    few = [Measured(t, X, np.array([0.0, 0.1, 0.2]))]
    with pytest.raises(ValueError, match="2 samples in motion for 3 parameters"):
        fit(LAWS["dahl"], few, {}, {})
    with pytest.raises(ValueError, match="the parameter 'mu', expected mu_c, sigma0_over_load, delta"):
        fit(LAWS["dahl"], few, {"mu": 1.0}, {})
