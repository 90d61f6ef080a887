"""Random parameters of every law, and random motions."""

import numpy as np

#: Laws whose states and work have formulas.
EXACT = (
    "bouc_wen",
    "coulomb",
    "dahl",
    "elasto_plastic",
    "gms",
    "lugre",
    "maxwell_slip",
    "rate_and_state",
    "stribeck",
    "table",
)
#: Laws that know no time and no speed.
RATE_INDEPENDENT = ("coulomb", "dahl", "bouc_wen", "maxwell_slip", "table")

#: Length of a stroke that brings every law from one friction to another [m].
LENGTH = 1e-4


def _curve(rng):
    mu_c = rng.uniform(0.1, 1.0)
    return {
        "mu_c": mu_c, "mu_s": mu_c * rng.uniform(1.0, 2.0),
        "stribeck_velocity": 10.0 ** rng.uniform(-4, -2),
        "stribeck_exponent": rng.uniform(0.5, 2.0),
    }  # fmt: skip


def _bristles(rng):
    curve = _curve(rng)
    return curve | {
        "sigma0_over_load": rng.uniform(0.5, 5.0) * curve["mu_c"] / LENGTH,
        "sigma1_over_load": rng.uniform(0.0, 50.0), "sigma2_over_load": rng.uniform(0.0, 20.0),
    }  # fmt: skip


def _elements(rng):
    count = int(rng.integers(1, 6))
    μ = rng.uniform(0.02, 0.2, count)
    return tuple(zip((μ / (LENGTH * rng.uniform(0.05, 1.5, count))).tolist(), μ.tolist()))


def _table(rng):
    slips = np.append(0.0, np.cumsum(rng.uniform(0.05, 0.4, int(rng.integers(2, 7))))) * LENGTH
    return tuple(zip(slips.tolist(), rng.uniform(-0.5, 1.0, len(slips)).tolist()))


def parameters(name, rng):
    """Random parameters of a law, by the keys of scenes."""
    if name == "coulomb":
        return {"mu_c": rng.uniform(0.1, 1.0)}
    if name == "dahl":
        mu_c = rng.uniform(0.1, 1.0)
        stiffness = rng.uniform(0.5, 8.0) * mu_c / LENGTH
        return {
            "mu_c": mu_c,
            "sigma0_over_load": stiffness,
            "delta": rng.choice([1.0, rng.uniform(1, 3)]),
        }
    if name == "stribeck":
        return _curve(rng) | {"sigma2_over_load": rng.uniform(0.0, 20.0)}
    if name == "lugre":
        return _bristles(rng)
    if name == "elasto_plastic":
        return _bristles(rng) | {"breakaway_ratio": rng.uniform(0.2, 0.9)}
    if name == "bouc_wen":
        return {
            "mu_c": rng.uniform(0.1, 1.0), "yield_displacement": LENGTH / rng.uniform(0.5, 6.0),
            "exponent": rng.choice([1.0, 2.0, rng.uniform(1.0, 5.0)]), "gamma": rng.uniform(0.0, 0.95),
        }  # fmt: skip
    if name == "maxwell_slip":
        return {"elements": _elements(rng)}
    if name == "gms":
        return _curve(rng) | {
            "elements": _elements(rng),
            "attraction_rate": 10.0 ** rng.uniform(0.0, 2.5),
        }
    if name == "rate_and_state":
        return {
            "reference_friction": rng.uniform(0.3, 0.8), "reference_speed": 10.0 ** rng.uniform(-6, -3),
            "a": rng.uniform(0.005, 0.02), "b": rng.uniform(0.0, 0.03),
            "critical_slip": LENGTH / rng.uniform(0.5, 10.0),
            "evolution": str(rng.choice(["ageing", "slip"])), "state0": 10.0 ** rng.uniform(-1, 1),
        }  # fmt: skip
    assert name == "table"
    return {"shape": _table(rng)} | ({"shape_backward": _table(rng)} if rng.random() < 0.5 else {})


def strokes(rng, count=4, one_speed=False):
    """Random strokes: (direction, speed [m/s], length [m], rest before it [s])."""
    V = 10.0 ** rng.uniform(-4, -2.5, count)
    return [
        (
            int(rng.choice([-1, 1])), float(V[0] if one_speed else V[i]),
            float(LENGTH * rng.uniform(0.2, 1.0)), float(rng.choice([0.0, rng.uniform(0.0, 5.0)])),
        )
        for i in range(count)
    ]  # fmt: skip
