import numpy as np
import pytest
from galinx.meshes.halfplane import BOX_DEPTH, BOX_WIDTH, MESHES, QuadMesh, check_cells
from galinx.meshes.refine import outer_ξ, refinement
from mpi4py import MPI

from galinx.app.plan.plan import unknowns
from galinx.meshes.charts import Confocal
from galinx.meshes.rings import CONTACT, FAR, FREE, TAGS
from galinx.solvers.fem.distributed import distribute
from galinx.solvers.fem.space import Space

TOLERANCES = [1e-2, 1e-6, 1e-9]


@pytest.mark.parametrize("mesh", MESHES)
@pytest.mark.parametrize("tolerance", TOLERANCES)
@pytest.mark.parametrize("β_s", [1.0, 0.4])
def test_cells_tile_the_body_without_degenerate_ones(mesh, tolerance, β_s):
    kind = MESHES[mesh]
    cells = kind.build(refinement(mesh, tolerance, β_s))
    check_cells(cells)
    x, y = np.moveaxis(cells.points[cells.cells], -1, 0)
    area = 0.5 * np.sum(x * np.roll(y, -1, 1) - y * np.roll(x, -1, 1))
    if mesh == "confocal":
        assert area == pytest.approx(np.pi * cells.points[:, 0].max(), rel=1e-13)
    elif mesh == "box":
        assert area == pytest.approx(BOX_WIDTH * BOX_DEPTH, rel=1e-12)
    # Euler: one component without a hole, so every inner edge is shared by two cells.
    edges = np.sort(np.stack([cells.cells, np.roll(cells.cells, -1, 1)], -1).reshape(-1, 2), 1)
    _, count = np.unique(edges, axis=0, return_counts=True)
    assert count.max() == 2
    assert (count == 1).sum() == sum(len(part) for part in cells.edges.values())


@pytest.mark.parametrize("times", [2, 9, 18, 36])
@pytest.mark.parametrize("mesh", MESHES)
def test_cut_meshes_have_no_cracks(mesh, times):
    """Every inner edge is shared by two cells: no vertex is there twice but for its last digit."""
    cells = MESHES[mesh].build(refinement(mesh, 1e-5, 1.0), times)
    check_cells(cells)
    edges = np.sort(np.stack([cells.cells, np.roll(cells.cells, -1, 1)], -1).reshape(-1, 2), 1)
    _, count = np.unique(edges[:, 0] * len(cells.points) + edges[:, 1], return_counts=True)
    assert count.max() == 2
    assert (count == 1).sum() == sum(len(part) for part in cells.edges.values())


@pytest.mark.parametrize("mesh", MESHES)
def test_boundary_parts_lie_where_they_should(mesh):
    kind = MESHES[mesh]
    cells = kind.build(refinement(mesh, 1e-6, 1.0))
    X = {tag: kind.chart.to_physical(cells.points[np.unique(cells.edges[tag])]) for tag in TAGS.values()}
    for tag in (CONTACT, FREE):
        np.testing.assert_allclose(X[tag][:, 1], 0.0, atol=1e-12 * np.abs(X[tag]).max())
    assert np.abs(X[CONTACT][:, 0]).max() == pytest.approx(1.0, abs=1e-15)
    assert np.abs(X[FREE][:, 0]).min() == pytest.approx(1.0, abs=1e-15)
    if mesh == "box":
        assert (np.isclose(np.abs(X[FAR][:, 0]), 100.0) | np.isclose(X[FAR][:, 1], -100.0)).all()
    else:
        radius = np.exp(outer_ξ(mesh, 1e-6)) / 2.0
        np.testing.assert_allclose(np.linalg.norm(X[FAR], axis=1), radius, rtol=1e-9)


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
    cos, sin = chart.rotation(x, np)
    np.testing.assert_allclose([cos, sin], along_ξ / np.linalg.norm(along_ξ), rtol=1e-9)


@pytest.mark.parametrize("mesh", MESHES)
def test_planned_sizes_are_those_of_the_run(mesh):
    cells = MESHES[mesh].build(refinement(mesh, 1e-3, 1.0))
    space = Space(*distribute(cells, MPI.COMM_WORLD), TAGS, MESHES[mesh].chart, 3)
    assert (space.cells, space.size) == (len(cells.cells), unknowns(cells, 3))
