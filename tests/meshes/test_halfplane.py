import numpy as np
import pytest
from support import areas

from galinx.meshes import MESHES, Requirements
from galinx.meshes.kind import BOX_DEPTH, BOX_WIDTH, check_cells
from galinx.meshes.rings import (
    CONTACT,
    FAR,
    FREE,
    TAGS,
    QuadMesh,
    Refinement,
    with_kinks,
)
from galinx.solvers.contact.fem_plan import crowded_kinks, uncrowded_kinks
from galinx.solvers.fem.cells import Contracted

TOLERANCES = [1e-2, 1e-6, 1e-9]


def assert_whole(cells):
    """Every inner edge is shared by two cells, and the others are those of the boundary."""
    edges = np.sort(np.stack([cells.cells, np.roll(cells.cells, -1, 1)], -1).reshape(-1, 2), 1)
    _, count = np.unique(edges[:, 0] * len(cells.points) + edges[:, 1], return_counts=True)
    assert count.max() == 2
    assert (count == 1).sum() == sum(len(part) for part in cells.edges.values())


@pytest.mark.parametrize("mesh", MESHES)
@pytest.mark.parametrize("tolerance", TOLERANCES)
@pytest.mark.parametrize("nearest, exponent", [(None, -0.5), (None, -0.95), (1e-6, -0.6), (1e-12, -0.9)])
def test_cells_tile_the_body_without_degenerate_ones(mesh, tolerance, nearest, exponent):
    kind = MESHES[mesh]
    cells = kind.build(MESHES[mesh].refinement(Requirements(tolerance, nearest, 5.0, exponent)))
    check_cells(cells)
    area = areas(cells.points, cells.cells).sum()
    if mesh == "confocal":
        assert area == pytest.approx(np.pi * cells.points[:, 0].max(), rel=1e-13)
    elif mesh == "box":
        assert area == pytest.approx(BOX_WIDTH * BOX_DEPTH, rel=1e-12)
    assert_whole(cells)


def test_cells_towards_kinks_anywhere_are_not_degenerate():
    """Ends of rows that are sums of the same lengths may differ in their last digit."""
    rng = np.random.default_rng(0)
    for _ in range(300):
        places = np.sort(rng.uniform(-0.98, 0.98, rng.integers(1, 6)))
        if np.diff(places).min(initial=1.0) > 2e-3:
            levels, sectors, more = rng.integers([2, 1, 0], [9, 5, 5]).tolist()
            rings = Refinement(levels, float(rng.choice([0.2, 0.35, 0.5])), sectors, (1.96,))
            check_cells(with_kinks(rings, places, more))


@pytest.mark.parametrize("times", [2, 9, 18, 36])
@pytest.mark.parametrize("mesh", MESHES)
def test_cut_meshes_have_no_cracks(mesh, times):
    """No vertex is there twice but for its last digit."""
    cells = MESHES[mesh].build(MESHES[mesh].refinement(Requirements(1e-5)), times)
    check_cells(cells)
    assert_whole(cells)


@pytest.mark.parametrize("mesh", MESHES)
def test_boundary_parts_lie_where_they_should(mesh):
    kind = MESHES[mesh]
    cells = kind.build(MESHES[mesh].refinement(Requirements(1e-6)))
    X = {tag: kind.chart.to_physical(cells.points[np.unique(cells.edges[tag])]) for tag in TAGS.values()}
    for tag in (CONTACT, FREE):
        np.testing.assert_allclose(X[tag][:, 1], 0.0, atol=1e-12 * np.abs(X[tag]).max())
    assert np.abs(X[CONTACT][:, 0]).max() == pytest.approx(1.0, abs=1e-15)
    assert np.abs(X[FREE][:, 0]).min() == pytest.approx(1.0, abs=1e-15)
    if mesh == "box":
        assert (np.isclose(np.abs(X[FAR][:, 0]), 100.0) | np.isclose(X[FAR][:, 1], -100.0)).all()
    else:
        radius = kind.reach(Requirements(1e-6))
        axes = radius + np.array([0.25, -0.25]) / radius
        np.testing.assert_allclose(np.linalg.norm(X[FAR] / axes, axis=1), 1.0, rtol=1e-9)


def test_a_turned_cell_is_refused():
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    check_cells(QuadMesh(square, np.array([[0, 1, 2, 3]]), {}))
    with pytest.raises(ValueError, match="degenerate"):
        check_cells(QuadMesh(square, np.array([[0, 3, 2, 1]]), {}))


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


@pytest.mark.parametrize("seed", range(3))
def test_kinks_that_crowd_are_left_out_where_ends_are_tried(seed):
    """Those that stay have a mesh, and one that has a mesh stays."""
    rng = np.random.default_rng(seed)
    few = np.sort(rng.uniform(-0.9, 0.9, 3))
    many = np.sort(np.concatenate([few, few + 1e-4, [-0.995, 0.9999], rng.uniform(-1.0, 1.0, 20)]))
    assert crowded_kinks(many) and not crowded_kinks(uncrowded_kinks(many))
    np.testing.assert_array_equal(uncrowded_kinks(few), few)
