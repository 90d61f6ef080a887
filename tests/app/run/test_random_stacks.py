"""Random stacks under flat punches and cylinders: finite elements against the integral equation."""

from dataclasses import replace
from time import process_time

import numpy as np
import pytest
from agreement import check
from layers_cases import random_stack
from support import THOROUGH
from test_layers_fem import scene_of

import galinx
from galinx.solvers.contact.edges import under_punch
from galinx.solvers.contact.ends import Punch
from galinx.solvers.contact.equation import Equation
from galinx.solvers.contact.on_layers import LayersUnderPunch, rule_of_ends
from galinx.solvers.profiles.punches import Parabolic

#: Share of the largest stress under the punch below which its own size is not asked for.
VANISHING = 0.1


def flat(seed, graded, quantities, tolerance):
    """A random stack under a flat punch; one that would have to pull is none the less solved."""
    solid, c = random_stack(seed, graded)
    f = np.random.default_rng(1000 + seed).uniform(-1.0, 1.0)
    return scene_of(solid, c, f, quantities, tolerance)


def cylinder(seed, graded, quantities, tolerance):
    """A random stack under a cylinder whose contact has the half-width 1 m at rest without friction."""
    solid, c = random_stack(seed, graded)
    f = np.random.default_rng(2000 + seed).uniform(-1.0, 1.0)
    base = scene_of(solid, c, f, quantities, tolerance)
    load, response = 1e-3, solid.response(0.0)
    punch = Punch(Parabolic(1.0), 1.0, load / solid.μ)
    kernel = LayersUnderPunch(response, response.stack(1.0), 1e-4, punch).kernel
    equation = Equation(response, kernel, 0.0, np.zeros_like)
    s, lifting, carrying = rule_of_ends(equation, 0.5 if kernel.rough else 60)(())
    m = -(lifting @ s) / lifting.sum()
    profile = Parabolic(float(carrying @ punch.slope(m, 1.0)(s)) / 2.0)
    return replace(base, punch=replace(base.punch, profile=profile, loads=(load,)))


CASES = [(flat, 6, False, 1e-6), (cylinder, 4, False, 1e-3)]
if THOROUGH:
    CASES = [(kind, n, graded, 1e-6)
             for kind in (flat, cylinder) for n in range(15) for graded in (False, True)]  # fmt: skip


@pytest.mark.parametrize(
    "kind, seed, graded, tolerance", CASES, ids=lambda value: getattr(value, "__name__", str(value))
)
def test_all_is_within_the_tolerance_and_the_estimate(kind, seed, graded, tolerance):
    """GALINX_THOROUGH=1 prints the table of docs/verification.md, by pytest -s -k flat."""
    start = process_time()
    quantities = ("sif", "surface", "interfaces") if THOROUGH else ("sif",)
    data = galinx.compute(kind(seed, graded, quantities, tolerance)).data
    row = [f"seed {seed}, {'graded' if graded else 'uniform'}: {process_time() - start:.0f} s"]
    if "surface/fem/sigma_YY" in data and kind is flat:  # which fixes the moments
        under = under_punch(data["surface/X_over_a"])
        fem, sie = (data[f"surface/{by}/sigma_YY"][:, under] for by in ("fem", "sie"))
        off = float((np.abs(fem - sie) / np.maximum(np.abs(sie), VANISHING)).max())
        row.append(f"pressure {off:.1e}")
        assert off <= tolerance
    for what, off in check(data, tolerance).items():
        estimate = data[f"states/fem/estimate{what}"][0]
        row.append(f"{what.strip('_') or 'K_I'} {off.max():.1e} of {estimate:.1e}")
    print(", ".join(row))
