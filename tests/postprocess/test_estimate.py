import numpy as np

from galinx.postprocess import estimate


def test_the_estimate_sums_a_geometric_series():
    limit = np.array([[1.0, 2.0], [3.0, 4.0]])
    error = np.array([[0.3, -0.2], [0.0, 0.1]])
    coarse, middle, fine = (limit + error * 0.5**n for n in range(3))
    first, second = estimate.differences(coarse, middle), estimate.differences(middle, fine)
    np.testing.assert_allclose(first, [0.15, 0.05])
    sample = first, second
    left = estimate.remaining(first, second, sample)
    np.testing.assert_allclose(left, estimate.SAFETY * np.array([0.075, 0.025]))
    assert (estimate.remaining(0.0 * first, second, sample) >= left).all()  # a lucky first difference
    slow = estimate.remaining(first, 0.9 * first, sample)
    np.testing.assert_allclose(slow, estimate.SAFETY * 0.9 * first * 9.0)
    assert np.isfinite(estimate.remaining(first, second, (0.0 * first, 0.0 * second))).all()
