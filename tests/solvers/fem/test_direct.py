"""Factors of symmetric and unsymmetric matrices."""

from pathlib import Path

import numpy as np
import pytest
from scipy.sparse import diags, identity, kron
from support import small_punch

from galinx.clock import Clock
from galinx.solvers.errors import SolveError
from galinx.solvers.fem import linear
from galinx.solvers.fem.linear import LinearSolver, on_this_rank


@pytest.mark.parametrize("entry", [0.0, float("nan")])
def test_a_singular_matrix_is_not_taken_for_a_solution(entry):
    from petsc4py import PETSc

    A = PETSc.Mat().createAIJ((4, 4), comm=PETSc.COMM_SELF)
    A.setUp()
    for i in range(4):
        A.setValue(i, i, 2.0 if i else entry)
    A.assemble()
    with pytest.raises(SolveError):
        LinearSolver(A, Clock()).solve(np.ones((4, 1)))


@pytest.mark.parametrize("entry", [1e-300, 5.0])
def test_several_solutions_at_once_are_those_of_one_after_the_other(entry):
    from petsc4py import PETSc

    rng = np.random.default_rng(0)
    dense = rng.standard_normal((30, 30))
    dense = dense @ dense.T + np.eye(30)
    dense[0], dense[:, 0], dense[0, 0] = 0.0, 0.0, entry
    A = PETSc.Mat().createAIJ((30, 30), nnz=30, comm=PETSc.COMM_SELF)
    A.setValues(range(30), range(30), dense)
    A.assemble()
    loads = rng.standard_normal((30, 4))
    factor = LinearSolver(A, Clock())
    if entry < 1.0:  # the second solution has no finite numbers
        loads[0, 0], loads[0, 2] = 0.0, 1e300
        with pytest.raises(SolveError, match=r"\|b - Ax\|/\|b\| = nan"):
            factor.solve(loads)
        return
    x = factor.solve(loads)
    assert factor.solves == 4 and factor.condition > 1.0 and 0.0 < factor.largest_residual < 1e-12
    assert factor.condition <= np.linalg.cond(dense, np.inf)
    np.testing.assert_allclose(x, np.linalg.solve(dense, loads), rtol=1e-11)
    for column, b in zip(x.T, loads.T):
        np.testing.assert_allclose(column, factor.solve(b[:, None])[:, 0], rtol=1e-12)


@pytest.mark.parametrize("share, refused", [(1e-3, True), (1e-6, False)])
@pytest.mark.parametrize("count", [1, 3])
def test_a_solution_that_leaves_a_thousandth_of_its_load_is_refused(share, refused, count):
    """A factor of another matrix solves its system only nearly: that is measured on the system."""
    from petsc4py import PETSc

    A = PETSc.Mat().createAIJ((8, 8), nnz=8, comm=PETSc.COMM_SELF)
    A.setValues(range(8), range(8), np.diag(np.arange(1.0, 9.0)))
    A.assemble()
    loads = np.arange(8.0)[:, None] - np.arange(count)
    factor = LinearSolver(A, Clock())
    factor.solve(loads[:, :1])
    factor.A = A.copy()
    factor.A.scale(1.0 + share)
    if refused:
        with pytest.raises(SolveError, match=r"\|b - Ax\|/\|b\| = 0.001, expected at most"):
            factor.solve(loads)
    else:
        factor.solve(loads)
        assert factor.largest_residual == pytest.approx(share)


def test_a_workspace_that_was_too_small_is_enlarged_once(monkeypatch):
    expected = small_punch().states(0.5).normal
    monkeypatch.setattr(linear, "WORKSPACE", (-80, 400))
    np.testing.assert_allclose(small_punch().states(0.5).normal, expected, rtol=1e-9)
    monkeypatch.setattr(linear, "WORKSPACE", (-80, -80))
    with pytest.raises(SolveError, match=r"status -9.*it needs [0-9]+ MB a rank"):
        small_punch()


def test_factors_are_freed():
    def resident():
        return int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1]) * 4096

    sizes = []
    for _ in range(20):
        small_punch().destroy()
        sizes.append(resident())
    # Unfreed, each would leave two megabytes.
    assert sizes[-1] - sizes[9] < 5e6


N = 150


def unsymmetric():
    """Of a wave that is carried along, on a square of points."""
    line = diags([-1.5, 2.1, -0.5], [-1, 0, 1], shape=(N, N))
    return (kron(line, identity(N)) + kron(identity(N), line)).tocsr()


def test_an_unsymmetric_matrix_has_one_and_many_right_hand_sides():
    A, b = unsymmetric(), np.random.default_rng(0).normal(size=(N * N, 3))
    factor = LinearSolver(on_this_rank(A), Clock(), "unsymmetric")
    found = factor.solve(b)
    np.testing.assert_allclose(A @ found, b, atol=1e-10)
    np.testing.assert_allclose(factor.solve(b[:, [1]]), found[:, [1]], rtol=1e-12, atol=1e-12)
    factor.destroy()
