import numpy as np
import pytest

from galinx.solvers.friction.dahl import Dahl
from galinx.solvers.friction.strokes import friction_along

STROKES = ["forward", "backward", "forward"]


def test_friction_of_the_reference_states(references):
    history = friction_along(Dahl(0.7, 25000.0), STROKES, 1e-4, [0.2, 0.8])
    found = {(s.name, X): f for s in history for X, f in zip(s.X_over_L, s.f)}
    for state in references["states"]:
        key = state["motion"], float(state["X/L"])
        assert found[key] == pytest.approx(float(state["f"]), rel=1e-13)


def test_backward_strokes_travel_from_L_to_0():
    forward, backward, _ = friction_along(Dahl(0.7, 25000.0), STROKES, 1e-4, [0.2, 0.8])
    assert list(forward.X_over_L) == [0.2, 0.8] and list(backward.X_over_L) == [0.8, 0.2]
    assert backward.f[0] > backward.f[1]


def test_both_integrators_agree_on_all_strokes():
    law, X = Dahl(0.7, 25000.0), [0.0, 0.2, 0.33, 0.8, 1.0]
    by_steps = friction_along(law, STROKES, 1e-4, X, "rk4")
    for found, wanted in zip(by_steps, friction_along(law, STROKES, 1e-4, X)):
        np.testing.assert_allclose(found.f, wanted.f, atol=2e-5)
