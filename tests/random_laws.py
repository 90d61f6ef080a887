"""Random parameters of every law, and random motions."""

import numpy as np

from galinx.solvers.friction import LAWS
from galinx.solvers.parameters import parameters as parameters_of

#: Laws whose states and work have formulas.
EXACT = tuple(sorted(LAWS))
#: Laws that know no time and no speed.
RATE_INDEPENDENT = ("coulomb", "dahl", "bouc_wen", "maxwell_slip", "table")

#: Length of a stroke that brings every law from one friction to another [m].
LENGTH = 1e-4

#: Decades of parameters as they usually are, and over all of their range.
USUAL = {
    "mu_c": (-1.0, 0.0), "mu_s": (-0.7, 0.3), "stribeck_velocity": (-4.0, -2.0),
    "stribeck_exponent": (-0.3, 0.3), "sigma0_over_load": (3.3, 4.7), "sigma1_over_load": (-1.0, 1.7),
    "sigma2_over_load": (-1.0, 1.3), "breakaway_ratio": (-0.7, -0.05), "delta": (0.0, 0.5),
    "yield_displacement": (-4.8, -3.7), "exponent": (0.0, 0.7), "gamma": (-2.0, -0.02),
    "attraction_rate": (0.0, 2.5), "reference_friction": (-0.5, -0.1), "reference_speed": (-6.0, -3.0),
    "a": (-2.3, -1.7), "b": (-3.0, -1.5), "critical_slip": (-5.0, -3.7), "state0": (-1.0, 1.0),
}  # fmt: skip
WIDE = USUAL | {
    "mu_c": (-3.0, 1.0), "mu_s": (-3.0, 1.0), "stribeck_velocity": (-6.0, 2.0),
    "stribeck_exponent": (-1.0, 1.0), "sigma0_over_load": (2.0, 9.0), "sigma1_over_load": (-2.0, 3.0),
    "sigma2_over_load": (-2.0, 2.0), "breakaway_ratio": (-3.0, -0.0005), "delta": (0.0, 1.0),
    "yield_displacement": (-9.0, -2.0), "exponent": (0.0, 1.7), "gamma": (-3.0, -0.0005),
    "attraction_rate": (-3.0, 2.0), "reference_friction": (-2.0, 0.0), "reference_speed": (-9.0, 0.0),
    "a": (-1.5, 0.0), "b": (-3.0, -0.5), "critical_slip": (-9.0, -2.0), "state0": (-6.0, 6.0),
}  # fmt: skip
#: Parameters that are often a number at which a law has another formula.
SPECIAL = {"delta": (1.0,), "exponent": (1.0, 2.0)}


def power(rng, low, high):
    """A number of so many decades."""
    return float(10.0 ** rng.uniform(low, high))


def _elements(rng, wide):
    stiffness, limit = ((2.0, 9.0), (-4.0, 1.0)) if wide else ((2.5, 4.5), (-1.7, -0.7))
    return tuple((power(rng, *stiffness), power(rng, *limit)) for _ in range(int(rng.integers(1, 6))))


def _table(rng, wide):
    slips = np.append(0.0, np.cumsum(rng.uniform(0.05, 0.4, int(rng.integers(2, 7))))) * LENGTH
    return tuple(zip(slips.tolist(), rng.uniform(-0.5, 1.0, len(slips)).tolist()))


OTHERS = {
    "elements": _elements,
    "shape": _table,
    "shape_backward": lambda rng, wide: _table(rng, wide) if rng.random() < 0.5 else (),
    "evolution": lambda rng, wide: str(rng.choice(["ageing", "slip"])),
}


def parameters(name, rng, wide=False):
    """Random parameters of a law, by the keys of scenes."""
    given = {}
    for key in parameters_of(LAWS[name]):
        if key in OTHERS:
            given |= {key: other} if (other := OTHERS[key](rng, wide)) else {}
        else:
            number = power(rng, *(WIDE if wide else USUAL)[key])
            given[key] = float(rng.choice([number, *SPECIAL.get(key, ())]))
    return given


def slip_of(given):
    """Slip within which the friction of a law with these parameters changes [m]."""
    elements = [μ / k for k, μ in given.get("elements", ())]
    stiffness = given.get("sigma0_over_load")
    return max(
        [given["mu_c"] / stiffness] if stiffness else elements,
        default=given.get("yield_displacement", given.get("critical_slip", LENGTH)),
    )


def strokes(rng, count=4):
    """Random strokes: (direction, speed [m/s], length [m], rest before it [s])."""
    V = 10.0 ** rng.uniform(-4, -2.5, count)
    return [
        (
            int(rng.choice([-1, 1])), float(V[i]),
            float(LENGTH * rng.uniform(0.2, 1.0)), float(rng.choice([0.0, rng.uniform(0.0, 5.0)])),
        )
        for i in range(count)
    ]  # fmt: skip
