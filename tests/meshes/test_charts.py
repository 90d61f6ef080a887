import numpy as np
import pytest

from galinx.meshes import MESHES
from galinx.meshes.charts import Confocal
from galinx.solvers.fem.cells import Contracted


@pytest.mark.parametrize("chart", [kind.chart for kind in MESHES.values()], ids=list(MESHES))
def test_charts_invert_themselves(chart):
    X = np.array([[-3.0, -0.5], [0.2, -1e-6], [0.999, -0.1], [50.0, -70.0], [0.3, 0.0], [-2.0, 0.0]])
    np.testing.assert_allclose(chart.to_physical(chart.from_physical(X)), X, rtol=1e-12, atol=1e-15)
    surface = np.array([-5.0, -1.001, -0.99, 0.0, 0.5, 1.5])
    for p in (1j, 0.4 + 0.7j):
        of_plane = Contracted(chart, p)
        found = of_plane.to_physical(of_plane.from_physical(X))
        np.testing.assert_allclose(found, X, rtol=1e-12, atol=1e-13)
    s = chart.surface_coordinate(surface)
    np.testing.assert_allclose(chart.surface_position(s), surface, rtol=1e-13)
    step = 1e-6
    slope = (chart.surface_position(s + step) - chart.surface_position(s - step)) / (2.0 * step)
    np.testing.assert_allclose(chart.surface_stretch(s), slope, rtol=1e-8)
    points = chart.from_physical(np.column_stack([surface, np.zeros_like(surface)]))
    np.testing.assert_allclose(chart.along_surface(points), s, atol=1e-13)


def test_confocal_rotation_is_that_of_the_map():
    chart, x, step = Confocal(), np.array([0.7, -1.1]), np.array([1e-6, 0.0])
    along_ξ = (chart.to_physical(x + step) - chart.to_physical(x - step)) / 2e-6
    cos, sin = chart.rotation(x)
    np.testing.assert_allclose([cos, sin], along_ξ / np.linalg.norm(along_ξ), rtol=1e-9)


@pytest.mark.parametrize("chart", [kind.chart for kind in MESHES.values()], ids=list(MESHES))
def test_distances_from_the_edges_are_those_of_positions(chart):
    left, right = chart.surface_coordinate(np.array([-1.0, 1.0]))
    s = left + (right - left) * np.array([1e-3, 0.1, 0.4, 0.6, 0.999])
    X = chart.surface_position(s)
    from_left, from_right, stretch = chart.under_punch(s - left, right - s)
    # Next to an edge X itself has lost nine of sixteen digits of the distance.
    np.testing.assert_allclose(from_left, 1.0 + X, rtol=1e-9)
    np.testing.assert_allclose(from_right, 1.0 - X, rtol=1e-9)
    np.testing.assert_allclose(stretch, chart.surface_stretch(s), rtol=1e-9)
