"""Estimates of what is left of errors that fall from level to level."""

import numpy as np
import pytest

from galinx.solvers.contact import estimate
from galinx.solvers.contact.estimate import SAFETY, Rate

ANY = Rate(0.0, 0.0)


def remaining(first, second, rate=ANY, sample=None, rounding=0.0):
    """What two differences of states leave, with those states or a sample's as typical ones."""
    first, second = (np.atleast_1d(np.asarray(one, dtype=float)) for one in (first, second))
    sample = tuple(map(np.atleast_1d, sample or (first, second)))
    return estimate.remaining(first, second, sample, rate, rounding)


@pytest.mark.parametrize("ρ", [0.3, 0.5, 0.6, 0.85])
def test_a_geometric_series_is_told_twice_as_large_as_it_is(ρ):
    """Ratios are not quite constant; estimates that are no larger than the error are none."""
    error = np.array([1.0, 0.2])
    first, second = ((1.0 - ρ) * error / ρ**n for n in (2, 1))
    np.testing.assert_allclose(remaining(first, second), 2.0 * error)
    # A first difference that happens to be small.
    assert (remaining(0.0 * first, second, sample=(first, second)) >= 2.0 * error).all()
    assert np.isfinite(remaining(first, second, sample=(0.0 * first, 0.0 * second))).all()


@pytest.mark.parametrize("second", [0.9, 1.0, 7.0])
def test_what_stalls_is_summed_to_nine_times_its_last_change(second):
    np.testing.assert_allclose(remaining(1.0, second), 2.0 * 9.0 * second)


def test_differences_of_the_size_of_rounding_are_not_summed_and_nothing_jumps_on_the_way():
    """Up to five times rounding a change is rounding, and from ten times on it is none."""
    left = np.array([remaining(1.0, 0.9, rounding=r)[0] for r in np.geomspace(1e-3, 1.0, 2001)])
    np.testing.assert_allclose(left[[0, -1]], SAFETY * 0.9 * np.array([9.0, 1.0]))
    assert (np.diff(left) <= 0.0).all()
    assert -np.diff(left).min() < 0.02 * left[0]
    for times, wanted in ((5.0, 1.0), (10.0, 4.0), (20.0, 4.0)):
        np.testing.assert_allclose(remaining(1.0, 0.8, rounding=0.8 / times), 2.0 * 0.8 * wanted)


def test_a_state_whose_first_difference_happens_to_vanish_is_not_taken_for_one_that_stalls():
    """Its ratio is that to a quarter of the sample's largest difference, 0.4, and not infinite."""
    sample = [1.0, 0.5], [0.1, 0.05]
    np.testing.assert_allclose(remaining(1e-9, 0.1, sample=sample), 2.0 * 0.1 * 0.4 / 0.6)
    # One that is as large as others and hardly fell stalls indeed.
    np.testing.assert_allclose(remaining(0.3, 0.24, sample=sample), 2.0 * 0.24 * 0.8 / 0.2)


def test_a_level_is_off_by_what_the_better_one_changed_and_what_is_left_of_that():
    """With errors that fall by the usual ratio, twice the error itself."""
    error = np.array([0.3, 0.1])
    np.testing.assert_allclose(estimate.before(0.84 * error, estimate.of_degrees(2)), 2.0 * error)
