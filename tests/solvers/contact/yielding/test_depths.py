"""Depths at which the largest stress inside a layer is searched for."""

from types import SimpleNamespace

import numpy as np
import pytest

from galinx.solvers.contact.yielding import StrengthOfLayers

DEPTHS = np.array([0.3, 1.3])


@pytest.mark.parametrize("layer, face, sign", [(1, 0.3, 1.0), (1, 1.3, -1.0), (2, 1.3, 1.0)])
def test_a_peak_between_a_face_and_the_next_sample_is_seen(monkeypatch, layer, face, sign):
    """Stresses that rise from 1 at a face to 1.05 at 0.02 a, and fall to 0.94 at the next sample."""

    def stress(self, state, X, depth):
        below = sign * (depth - face)
        return 0.9 + 0.1 * (1.0 + below / 0.01) * np.exp(-below / 0.03) - 0.001 * X**2

    monkeypatch.setattr(StrengthOfLayers, "_stress", stress)
    contact = SimpleNamespace(solid=SimpleNamespace(depths=2.0 * DEPTHS))
    strength = StrengthOfLayers(SimpleNamespace(half_width=np.array([2.0])), contact)
    value, X, Y = strength._searched(0, layer, 1.0)
    assert value == pytest.approx(0.9 + 0.3 * np.exp(-2.0 / 3.0), rel=1e-6)
    np.testing.assert_allclose([X, Y], [0.0, -face - 0.02 * sign], atol=1e-3)
