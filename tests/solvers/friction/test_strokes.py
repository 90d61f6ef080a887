from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest
import random_laws as random

from galinx.solvers.friction import LAWS, FrictionLaw
from galinx.solvers.friction.dahl import Dahl
from galinx.solvers.friction.motion import Partial, friction_along, last_cycle, legs, positions
from galinx.solvers.parameters import build_model, parameters

STROKES = ["forward", "backward", "forward"]


def test_friction_of_the_reference_states(references):
    history = zip(legs(STROKES), friction_along(Dahl(0.7, 25000.0), STROKES, 1e-4, [0.2, 0.8]))
    found = {(leg.name, X): f for leg, s in history for X, f in zip(positions(leg, [0.2, 0.8]), s.f)}
    for state in references["states"]:
        key = state["motion"], float(state["X/L"])
        assert found[key] == pytest.approx(float(state["f"]), rel=1e-13)


@pytest.mark.parametrize(
    "strokes, first",
    [
        (STROKES, 1),
        (["forward", "backward", Partial(0.4)], None),
        (["forward", Partial(0.2), Partial(0.7), Partial(0.2)], 2),
        (["forward"], None),
        (["backward", "backward", "backward"], None),
    ],
)
def test_the_last_closed_cycle_is_the_shortest_one_that_ends_the_motion(strokes, first):
    assert last_cycle(legs(strokes)) == first


@dataclass(frozen=True)
class Spring(FrictionLaw):
    """Two springs in a row with sliders, f = z₀ + z₁, that give as the speed rises: the rate alone."""

    about: ClassVar[str] = "two springs"

    def rest(self):
        return np.array([0.0, 0.1])

    def rate(self, z, s, V):
        return s * 1e4 / (1.0 + V) * (1.0 - s * z / np.array([0.3, 0.2]))

    def friction(self, z, s, V):
        return z.sum(axis=-1)


def test_a_law_that_knows_its_rate_alone_is_integrated_and_carries_its_state():
    X = np.array([0.0, 0.3, 1.0])
    for V in (0.0, 2.0):
        forward, backward = friction_along(Spring(), STROKES[:2], 1e-4, X, V)
        k = 1e4 / (1.0 + V) * 1e-4 / np.array([0.3, 0.2])
        wanted = [0.3, 0.2] + ([0.0, 0.1] - np.array([0.3, 0.2])) * np.exp(-np.outer(X, k))
        np.testing.assert_allclose(forward.z, wanted, rtol=1e-10)
        np.testing.assert_allclose(forward.f, wanted.sum(axis=1), rtol=1e-10)
        np.testing.assert_allclose(backward.z[0], wanted[-1], rtol=1e-10)
    with pytest.raises(ValueError, match="no limit of stable steps"):
        friction_along(Spring(), STROKES, 1e-4, X, integrator="rk4")


@pytest.mark.parametrize("name", random.EXACT)
@pytest.mark.parametrize("size", [1e308, 1e-308, 1e150])
def test_friction_is_finite_or_refused_whatever_the_parameters(name, size, recwarn):
    usual = random.parameters(name, np.random.default_rng(3))
    for key, known in parameters(LAWS[name]).items():
        if known.single and not known.options:
            try:
                law = build_model(LAWS[name], {**usual, key: size})
                for stroke in friction_along(law, STROKES, 1e-4, [0.0, 0.3, 1.0], 1e-3):
                    assert np.isfinite(stroke.f).all(), key
            except ValueError as error:
                assert "expected" in str(error)
    assert not recwarn.list
