"""A motion's residual falls as its steps do, and shows a wrong number at any time."""

from itertools import product

import numpy as np
import pytest

from galinx.solvers.solids.isotropic import Isotropic
from galinx.solvers.transient.history import smooth
from galinx.solvers.transient.march import Radau, Residual
from galinx.solvers.transient.punch import StartingPunch
from galinx.solvers.transient.transform import Transformed

SOLID, END, TERMS = Isotropic(1.0, 0.25, 1.0), 4.0, 16


def load(t):
    return smooth(t, 3.0)


def course(steps, g):
    punch = StartingPunch(SOLID.response(0.6), SOLID.limit(), END, steps, TERMS, checked=True)
    return punch.course(g, load)


@pytest.mark.parametrize("g", [-0.4, lambda t: -0.5 * np.sin(0.8 * t)], ids=["constant", "changing"])
def test_it_falls_with_the_steps(g):
    coarse, fine = (course(steps, g).residual for steps in (10, 20))
    assert fine < min(coarse / 6.0, 1e-3)


def test_a_wrong_number_is_shown():
    response, scheme = SOLID.response(0.6), Radau(END, 20)
    transformed = Transformed(response, SOLID.limit(), scheme.s, TERMS)
    basis, t = transformed.basis(-0.4), scheme.times[:, -1]
    (answers,) = transformed.answers(basis)
    solved = scheme.answered(answers[..., None], load(scheme.times)[..., None])
    residual = Residual(response, SOLID.limit(), t, TERMS)
    right = residual.of([basis], solved[:, :-1], solved[:, -1])
    # Of the pressure's polynomials, and the indentation.
    for when, number in product((3, 10, 19), (0, 1, 5, -1)):
        wrong = solved.copy()
        wrong[when, number] += 0.05 * np.abs(solved).max()
        assert residual.of([basis], wrong[:, :-1], wrong[:, -1]) > 5.0 * right
