import numpy as np

from galinx.solvers.fem.fields import SurfaceTrace


def test_between_facets_the_right_one_counts_whatever_rounding_does():
    s = np.array([[-1.0, 0.0], [1e-16, 2.0]])
    trace = SurfaceTrace(s, np.abs(s)[..., None, None] * np.ones((2, 1)))
    for at in (-1e-16, 0.0, 2e-16):
        np.testing.assert_allclose(trace.derivative([at]), 1.0)
    np.testing.assert_allclose(trace.derivative([-1e-6]), -1.0)
