"""Jacobi polynomials of the integral equation over layers."""

import numpy as np
import pytest
from scipy.special import eval_jacobi

from galinx.solvers.contact.equation import jacobi


@pytest.mark.parametrize(("α", "β"), [(-0.5, -0.5), (-0.71, -0.29), (0.4, 0.6), (-0.3, 0.3)])
def test_recurrence_is_the_series(α, β):
    r = np.array([-1.0, -0.9999, -0.3, 0.0, 0.77, 1.0, 1.08])
    exact = eval_jacobi(np.arange(60), α, β, r[:, None])
    assert (np.abs(jacobi(60, α, β, r) - exact) / np.maximum(np.abs(exact), 0.1)).max() <= 1e-11
    assert jacobi(1, α, β, r).shape == (7, 1)
