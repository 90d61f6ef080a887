"""Search for the ends of contacts: profiles that are hard for it, on a uniform half-plane."""

from dataclasses import dataclass

import numpy as np
import pytest

from galinx.solvers.contact.closed_form import rule_of_ends
from galinx.solvers.contact.ends import Punch, free_ends, half_width_of_load, logarithm_of_load
from galinx.solvers.errors import SolveError

#: N/μ [m], and n of the half-plane.
LOAD, n = 1e-7, 0.75


@dataclass(frozen=True)
class Shape:
    """A convex punch by its slope [dimensionless], kinks [m] and whether the slope jumps there."""

    slope: object
    kinks: tuple = ()
    jumps: bool = False

    def words(self):
        return "shape"


def ends(shape, h=1e-3, m=None, load=LOAD):
    punch = Punch(shape, 1.0, load)
    calls = []

    def rules(h):
        calls.append(h)
        return rule_of_ends(shape, 0.5, n)

    return *free_ends(punch, rules, h, m), calls


@pytest.mark.parametrize("h", [1e-9, 1e-3, 1e3])
@pytest.mark.parametrize("offset", [0.0, -0.4, 7.0])
def test_a_parabola_from_any_half_width_and_with_any_axis(h, offset):
    R = 0.3
    middle, half, _ = ends(Shape(lambda X: (X - offset) / R), h)
    # Positions far from the axis have fewer digits over the half-width.
    digits = 1e-13 * (1.0 + 10.0 * abs(offset) / half)
    assert half == pytest.approx(np.sqrt(2.0 * LOAD * R * n / np.pi), rel=digits)
    assert middle == pytest.approx(offset, abs=digits * half)


@pytest.mark.parametrize("slope", [lambda X: -X, np.zeros_like, lambda X: np.ones_like(X)])
def test_a_punch_that_no_contact_carries_says_so(slope):
    with pytest.raises(SolveError, match="shape carries the load"):
        ends(Shape(slope))


def test_a_load_that_is_infinite_on_one_side():
    """A flat part carries none, tension at the other side is no load either."""
    punch = Punch(Shape(np.zeros_like), 1.0, LOAD)
    h = half_width_of_load(lambda h: -np.inf if h < 2.0 else np.log(h / 3.0), 1e-6, punch)
    assert h == pytest.approx(3.0, rel=1e-13)
    h = half_width_of_load(lambda h: np.inf if h > 4.0 else np.log(h / 3.0), 1e6, punch)
    assert h == pytest.approx(3.0, rel=1e-13)
    h = half_width_of_load(lambda h: logarithm_of_load(max(h - 2.0, 0.0)), 1e-6, punch)
    assert h == pytest.approx(3.0, rel=1e-13)
    h = half_width_of_load(lambda h: logarithm_of_load(h / 3.0 if h < 4.0 else -1.0), 1e6, punch)
    assert h == pytest.approx(3.0, rel=1e-13)
