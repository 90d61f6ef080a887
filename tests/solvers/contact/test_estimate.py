import numpy as np

from galinx.solvers.contact import estimate
from galinx.solvers.contact.estimate import Rate

ANY = Rate(0.0, 0.0)


def test_the_estimate_sums_a_geometric_series():
    error = np.array([0.3, 0.1])
    first, second = (error * (0.5**n - 0.5 ** (n + 1)) for n in range(2))
    sample = first, second
    left = estimate.remaining(first, second, sample, ANY)
    np.testing.assert_allclose(left, estimate.SAFETY * np.array([0.075, 0.025]))
    # a lucky first difference
    assert (estimate.remaining(0.0 * first, second, sample, ANY) >= left).all()
    slow = estimate.remaining(first, 0.9 * first, sample, ANY)
    np.testing.assert_allclose(slow, estimate.SAFETY * 0.9 * first * 9.0)
    assert np.isfinite(estimate.remaining(first, second, (0.0 * first, 0.0 * second), ANY)).all()


def test_a_faster_fall_than_is_believed_counts_as_the_usual_one():
    first = np.array([1.0])
    for seen, counted in ((0.01, 0.2), (0.3, 0.2), (0.4, 0.4)):
        second = seen * first
        left = estimate.remaining(first, second, (first, second), Rate(0.2, 0.3))
        np.testing.assert_allclose(left, estimate.SAFETY * second * counted / (1.0 - counted))


def test_a_level_is_off_by_what_the_better_one_changed_and_what_is_left_of_that():
    """With errors that fall by the usual ratio, twice the error itself."""
    error = np.array([0.3, 0.1])
    found = estimate.before(error - 0.16 * error, estimate.of_degrees(2))
    np.testing.assert_allclose(found, estimate.SAFETY * error)


def test_differences_of_the_size_of_rounding_are_not_summed_and_nothing_jumps_on_the_way():
    first = np.array([1.0])
    rounding = np.geomspace(1e-3, 1.0, 2001)
    second = 0.9 * first
    left = np.array([estimate.remaining(first, second, (first, second), ANY, r)[0] for r in rounding])
    np.testing.assert_allclose(left[[0, -1]], estimate.SAFETY * 0.9 * np.array([9.0, 1.0]))
    assert (np.diff(left) <= 0.0).all()
    assert -np.diff(left).min() < 0.02 * left[0]


def test_a_geometric_series_is_told_twice_as_large_as_it_is():
    """Ratios are not quite constant; estimates that are no larger than the error are none."""
    for ρ in (0.3, 0.6, 0.85):
        error = np.array([1.0, 0.2])
        first, second = ((1.0 - ρ) * error / ρ**n for n in (2, 1))
        left = estimate.remaining(first, second, (first, second), ANY)
        np.testing.assert_allclose(left, 2.0 * error)
    np.testing.assert_allclose(estimate.before(0.84 * error, estimate.of_degrees(2)), 2.0 * error)


def test_a_state_whose_first_difference_happens_to_vanish_is_not_taken_for_one_that_stalls():
    """Its ratio is that to a quarter of the sample's largest difference, 0.4, and not infinite."""
    sample = np.array([1.0, 0.5]), np.array([0.1, 0.05])
    left = estimate.remaining(np.array([1e-9]), np.array([0.1]), sample, ANY)
    np.testing.assert_allclose(left, 2.0 * 0.1 * 0.4 / 0.6)
    # One that is as large as others and hardly fell stalls indeed.
    left = estimate.remaining(np.array([0.3]), np.array([0.24]), sample, ANY)
    np.testing.assert_allclose(left, 2.0 * 0.24 * 0.8 / 0.2)


def test_a_derivative_whose_last_change_nearly_vanishes_is_not_believed():
    """At places that are looked at one level may agree with the next by accident."""
    first, second = np.array([1.0]), np.array([1e-6])
    rate = estimate.of_degrees(1)
    left = estimate.remaining(first, second, (first, second), rate)
    np.testing.assert_allclose(left, 2.0 * 0.1)
    of_moments = estimate.remaining(first, second, (first, second), estimate.of_degrees(2))
    np.testing.assert_allclose(of_moments, 2.0 * 1e-6 * 0.16 / 0.84)


def test_what_stalls_is_summed_to_nine_times_its_last_change():
    first = np.array([1.0])
    for second in (0.9, 1.0, 7.0):
        left = estimate.remaining(first, second * first, (first, second * first), ANY)
        np.testing.assert_allclose(left, 2.0 * 9.0 * second)


def test_a_change_of_five_times_rounding_is_rounding_and_one_of_ten_is_none():
    first, second = np.array([1.0]), np.array([0.8])
    sample = first, second
    for times, wanted in ((5.0, 1.0), (10.0, 4.0), (20.0, 4.0)):
        left = estimate.remaining(first, second, sample, ANY, 0.8 / times)
        np.testing.assert_allclose(left, 2.0 * 0.8 * wanted)
