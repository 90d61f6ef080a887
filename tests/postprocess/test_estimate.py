import numpy as np

from galinx.postprocess import estimate
from galinx.postprocess.estimate import Rate

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
