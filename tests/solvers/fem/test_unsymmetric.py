"""Factors of unsymmetric matrices."""

import numpy as np
from scipy.sparse import diags, identity, kron

from galinx.clock import Clock
from galinx.solvers.fem.linear import ArraySolver

N = 150


def matrix():
    """Of a wave that is carried along, on a square of points."""
    line = diags([-1.5, 2.1, -0.5], [-1, 0, 1], shape=(N, N))
    return (kron(line, identity(N)) + kron(identity(N), line)).tocsr()


def test_one_and_many_right_hand_sides():
    A, b = matrix(), np.random.default_rng(0).normal(size=(N * N, 3))
    factor = ArraySolver(A, Clock())
    found = factor.solve(b)
    np.testing.assert_allclose(A @ found, b, atol=1e-10)
    np.testing.assert_allclose(factor.solve(b[:, 1]), found[:, 1], rtol=1e-12, atol=1e-12)
    factor.destroy()
