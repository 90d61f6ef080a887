"""Whole fields of one state: sampled, in SI, and in files that VTK reads."""

import attrs
import numpy as np
import pytest
from conftest import HOME
from galinx.meshes.halfplane import MESHES
from mpi4py import MPI
from numpy.polynomial.legendre import leggauss
from scipy.spatial import cKDTree

from galinx.app.errors import BadInput
from galinx.app.plan.states import enumerate_states
from galinx.app.results import paraview as fields
from galinx.app.results.paraview import ABOUT, StateField, state_field, write_field
from galinx.app.scene.scene import parse, read
from galinx.meshes.rings import TAGS, Refinement
from galinx.postprocess import stresses
from galinx.postprocess.errors import UnwritableArchive
from galinx.postprocess.hdf5 import vtkhdf
from galinx.solvers.fem.distributed import distribute
from galinx.solvers.fem.interior import InteriorGradients
from galinx.solvers.fem.punch import SlidingPunch
from galinx.solvers.fem.sampling import sample
from galinx.solvers.fem.space import Space
from galinx.solvers.sie import potentials
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.solids.isotropic import MovingFrame

κ, C, G, EXTENT = 2.0, 0.6, -0.66, 4.0


@pytest.fixture(scope="module", params=["confocal", "graded"])
def solved(request):
    """A punch and one of its states, on a mesh of the given kind."""
    kind = MESHES[request.param]
    cells = kind.build(Refinement(8, 0.35, 3, (1.0, 2.0, 3.0, 3.0, 3.0, 3.0)))
    space = Space(*distribute(cells, MPI.COMM_SELF), TAGS, kind.chart, 7)
    punch = SlidingPunch(space, κ, C)
    yield punch, punch.states(G)
    punch.destroy()


def sampled(solved, n=7, extent=EXTENT):
    punch, states = solved
    return sample(punch.space, κ, C, punch.fields, states.weights[0], extent, n)


def scene(*changes, name="tables4_5"):
    text = (HOME / "scenes" / f"{name}.toml").read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return parse(text)


def areas(points, quads):
    """Signed areas of polygons, (m,)."""
    X, Y = points[quads][..., 0], points[quads][..., 1]
    return 0.5 * (X * np.roll(Y, -1, axis=1) - np.roll(X, -1, axis=1) * Y).sum(axis=1)


def clipped(polygon, axis, bound, sign):
    """The part of a polygon with sign·x[axis] <= sign·bound."""
    result = []
    for p, q in zip(polygon, np.roll(polygon, -1, axis=0)):
        outside_p, outside_q = (sign * (z[axis] - bound) for z in (p, q))
        if outside_p <= 0.0:
            result.append(p)
        if outside_p * outside_q < 0.0:
            result.append(p + (q - p) * outside_p / (outside_p - outside_q))
    return np.reshape(result, (-1, 2))


def area_within(points, quads, extent):
    total = 0.0
    for polygon in points[quads]:
        for axis, bound, sign in ((0, extent, 1), (0, -extent, -1), (1, -extent, -1)):
            polygon = clipped(polygon, axis, bound, sign) if len(polygon) else polygon
        total += areas(polygon, np.arange(len(polygon))[None])[0] if len(polygon) else 0.0
    return total


def test_gradients_are_those_at_single_points(solved):
    punch, states = solved
    found = sampled(solved)
    # On the border between cells a point has one value a cell, and a single point their mean.
    alone = cKDTree(found.points).query(found.points, k=2)[0][:, 1] > 1e-9
    deep = alone & (found.points[:, 1] <= -0.01) & (np.abs(found.points).max(axis=1) < 0.8 * EXTENT)
    assert deep.sum() > 500
    inside = InteriorGradients(punch.space, κ, C, punch.fields, found.points[deep])
    expected = inside.of(states.weights)[0]
    error = np.abs(found.gradient[deep] - expected).max()
    assert error <= 1e-9 * np.abs(expected).max()


def test_quadrilaterals_tile_the_part_asked_for(solved):
    found = sampled(solved, n=5)
    area = areas(found.points, found.quads)
    assert area.min() >= 0.0  # counterclockwise
    assert area_within(found.points, found.quads, EXTENT) == pytest.approx(2.0 * EXTENT**2, rel=1e-9)
    corners = found.points[found.quads]
    assert np.all((corners.min(axis=1) < EXTENT) & (corners.max(axis=1) > -EXTENT))
    assert found.points[:, 1].max() <= 0.0
    np.testing.assert_array_equal(np.unique(found.quads), np.arange(len(found.points)))


def test_the_displacement_is_continuous_and_that_of_the_closed_form(solved):
    _, states = solved
    found = sampled(solved)
    X, Y = found.points.T
    near, at = cKDTree(found.points).query(found.points, k=2)
    same = near[:, 1] < 1e-12
    jump = np.abs(found.displacement[same] - found.displacement[at[same, 1]]).max()
    assert same.sum() > 500 and jump <= 1e-9 * np.abs(found.displacement).max()
    surface = Y > -1e-12
    under = surface & (np.abs(X) <= 1.0)
    np.testing.assert_allclose(found.displacement[under, 1], -states.v0[0], rtol=1e-9)
    # Beside the punch v is the integral of the exact slope.
    beside = np.flatnonzero(surface & (np.abs(X - 2.5) < 1.4))
    beside = beside[np.argsort(X[beside])]
    frame = MovingFrame(κ, C)
    t, w = leggauss(60)
    start, half = X[beside[0]], (X[beside] - X[beside[0]])[:, None] / 2.0
    slopes = frame.n * FlatPunch(frame, G).hilbert(start + half * (1.0 + t))
    rise = (slopes * w * half).sum(axis=1)
    v = found.displacement[beside, 1]
    assert len(beside) >= 10
    np.testing.assert_allclose(v - v[0], rise, atol=1e-3 * np.abs(rise).max())


def test_everything_is_finite_even_at_the_edges(solved):
    found = sampled(solved, n=2)
    at_edge = np.abs(np.abs(found.points[:, 0]) - 1.0) < 1e-14
    assert at_edge.sum() >= 2
    assert np.isfinite(found.gradient).all()
    # The stress at an edge is no larger than what the singularity has come to close by.
    close = np.hypot(np.abs(found.points[:, 0]) - 1.0, found.points[:, 1]) < 1e-6
    largest = np.abs(found.gradient[close & ~at_edge]).max()
    assert np.abs(found.gradient[at_edge]).max() <= 10.0 * largest


@pytest.mark.parametrize("mode", ["contact", "traction"])
def test_stresses_are_those_of_the_potentials(mode):
    given = scene(("[4.786e-7, 0.6]", "[0.0, 0.6]"), ('"confocal"', f'"confocal"\nmode = "{mode}"'))
    states = enumerate_states(given)
    number = int(np.flatnonzero(states.c == 0.6)[1])
    found = state_field(given, number)
    a, solid = given.punch.half_width, given.solid
    unit = given.punch.load / (2.0 * a)
    X, Y = found.points.T / a
    some = (Y <= -0.01) & (np.hypot(X, Y) <= 5.0)
    punch = FlatPunch(MovingFrame(3.0 - 4.0 * solid.nu, 0.6), states.g[number])
    exact = unit * potentials.stresses(punch, X[some], Y[some])
    fem = np.array([found.data[f"sigma_{ij}"][some] for ij in ("XX", "YY", "XY")])
    assert np.abs(fem - exact).max() <= 1e-4 * np.abs(exact).max()
    error = found.data["sigma_error"]
    np.testing.assert_allclose(error[some], np.abs(fem - exact).max(axis=0), atol=1e-9 * unit)
    assert np.array_equal(np.isnan(error), Y > -1e-13)
    np.testing.assert_allclose(found.data["sigma_ZZ"][some], solid.nu * (fem[0] + fem[1]), rtol=1e-12)
    # σ_YY at the surface is a pressure under the punch and vanishes beside it.
    for part, level in ((np.abs(X) < 0.9, -1.0), ((np.abs(X) > 1.1) & (np.abs(X) < 5.0), 0.0)):
        σ_YY = found.data["sigma_YY"][part & (Y > -1e-12)] / unit
        assert σ_YY.max() < -0.3 if level else np.abs(σ_YY).max() < 1e-2


def test_a_field_is_solved_once_and_for_any_scene(monkeypatch):
    from galinx.solvers.fem import punch as punches

    made = []

    class Counted(punches.SlidingPunch):
        def __init__(self, *arguments):
            made.append(arguments[0].degree)
            super().__init__(*arguments)

    monkeypatch.setattr(punches, "SlidingPunch", Counted)
    text = ('["friction", "sif", "surface"]', '["friction"]'), ('["closed_form", "fem"]', "[]")
    field = state_field(scene(*text), 3, extent=2.0, degree=6)
    assert made == [6]
    assert set(field.data) == set(ABOUT) - {"sigma_error"}
    # A speed that finite elements refuse does not stand in the way of the others.
    fast = scene(("[4.786e-7, 0.6]", "[0.1, 0.95]"), ('["closed_form", "fem"]', '["closed_form"]'))
    assert "sigma_error" in state_field(fast, 0, extent=2.0, degree=4).data
    with pytest.raises(BadInput, match="is not below the Rayleigh speed"):
        state_field(fast, len(enumerate_states(fast)) - 1)


def test_given_tractions_of_the_users_own_have_a_field():
    given = scene(
        ('mode = "traction"', 'mode = "traction"\npressure = [[-1, -1], [1, -1]]'), name="traction"
    )
    found = state_field(given, 0)
    X, Y = found.points.T / given.punch.half_width
    under = (Y > -1e-12) & (np.abs(X) < 0.9)
    pressure = -found.data["sigma_YY"][under] * 2.0 * given.punch.half_width / given.punch.load
    np.testing.assert_allclose(pressure, 1.0, atol=1e-3)
    assert "sigma_error" not in found.data


def test_what_has_no_field_is_bad_input():
    given = read(HOME / "scenes" / "tables4_5.toml")
    count = len(enumerate_states(given))
    for number in (-1, count):
        with pytest.raises(BadInput, match=f"state {number}: .*0 to {count - 1}.* has {count}"):
            state_field(given, number)
    with pytest.raises(BadInput, match=r"expected ν <= 0\.49"):
        state_field(scene(("[solid]", "[solid]\nnu = 0.495"), ("nu = 0.25", "")), 0)
    box = attrs.evolve(given, solve=attrs.evolve(given.solve, mesh="box"))
    for extent in (90.0, 0.0, np.nan):
        with pytest.raises(BadInput, match="at most 60 a with the box mesh"):
            state_field(box, 0, extent)
    with pytest.raises(BadInput, match="degree: found 40, expected 4 to 13"):
        state_field(given, 0, degree=40)


def test_the_indentation_is_that_of_a_run(tables_run):
    data, _ = tables_run
    given = read(HOME / "scenes" / "tables4_5.toml")
    for number in (0, len(data["states/c"]) - 1):
        speed = data["run/fem/c"].tolist().index(data["states/c"][number])
        found = state_field(given, number, 2.0, int(data["run/fem/degree"][speed]))
        X, Y = found.points.T / given.punch.half_width
        v = found.data["displacement"][(np.abs(X) <= 1.0) & (Y > -1e-13), 1]
        np.testing.assert_allclose(v, -data["states/fem/v0"][number], rtol=1e-9)


def test_lengths_and_stresses_scale_with_the_punch():
    given = read(HOME / "scenes" / "tables4_5.toml")
    larger = attrs.evolve(given, punch=attrs.evolve(given.punch, half_width=2e-3, load=3.0 * 55.3e3))
    small, large = (state_field(one, 0, 2.0, 5) for one in (given, larger))
    np.testing.assert_allclose(large.points, 2.0 * small.points, rtol=1e-14)
    np.testing.assert_allclose(large.data["von_mises"], 1.5 * small.data["von_mises"], rtol=1e-12)
    np.testing.assert_allclose(large.data["displacement"], 3.0 * small.data["displacement"], rtol=1e-12)


def test_stress_measures_follow_from_principal_stresses():
    random = np.random.default_rng(5)
    XX, YY, XY = random.normal(size=(3, 200))
    for plane in ("strain", "stress"):
        ZZ = stresses.σ_ZZ(0.3, plane, XX, YY)
        tensor = np.zeros((200, 3, 3))
        tensor[:, 0, 0], tensor[:, 1, 1], tensor[:, 2, 2] = XX, YY, ZZ
        tensor[:, 0, 1] = tensor[:, 1, 0] = XY
        deviator = np.linalg.eigvalsh(
            tensor - np.trace(tensor, axis1=1, axis2=2)[:, None, None] * np.eye(3) / 3
        )
        expected = np.sqrt(1.5 * (deviator**2).sum(axis=1))
        np.testing.assert_allclose(stresses.von_mises(XX, YY, XY, ZZ), expected, rtol=1e-12)
        # Hooke's law: no strain, or no stress, out of the plane.
        held = ZZ - 0.3 * (XX + YY) if plane == "strain" else ZZ
        np.testing.assert_allclose(held, 0.0, atol=1e-15)
        low, high = np.linalg.eigvalsh(tensor[:, :2, :2]).T
        np.testing.assert_allclose(stresses.maximum_shear(XX, YY, XY), (high - low) / 2.0, rtol=1e-12)


def test_vtk_reads_what_was_written(tmp_path):
    reading = pytest.importorskip("vtkmodules.vtkIOHDF")
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter

    given = read(HOME / "scenes" / "tables4_5.toml")
    a, path = given.punch.half_width, tmp_path / "state.hdf"
    write_field(given, 1, path, extent=3.0)
    written = state_field(given, 1, extent=3.0)
    reader = reading.vtkHDFReader()
    assert reader.CanReadFile(str(path))
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    assert grid.GetNumberOfPoints() == len(written.points)
    assert grid.GetNumberOfCells() == len(written.quads)
    assert {grid.GetCellType(i) for i in range(grid.GetNumberOfCells())} == {9}
    data = grid.GetPointData()
    assert {data.GetArrayName(i) for i in range(data.GetNumberOfArrays())} == set(ABOUT)
    for name, values in written.data.items():
        np.testing.assert_array_equal(vtk_to_numpy(data.GetArray(name)), values)
    points = vtk_to_numpy(grid.GetPoints().GetData())
    np.testing.assert_array_equal(points[:, :2], written.points)
    assert not points[:, 2].any()
    X0, X1, Y0, Y1, *_ = np.array(grid.GetBounds()) / a
    assert -5.0 < X0 <= -3.0 and 3.0 <= X1 < 5.0 and -5.0 < Y0 <= -3.0 and Y1 == 0.0
    size = vtkCellSizeFilter()
    size.SetInputData(grid)
    size.Update()
    found = vtk_to_numpy(size.GetOutput().GetCellData().GetArray("Area"))
    # Some VTKs take quadrilaterals of 1e-15 m² for points.
    np.testing.assert_allclose(found, areas(written.points, written.quads), atol=1e-14)
    assert area_within(written.points / a, written.quads, 3.0) == pytest.approx(18.0, rel=1e-9)


def test_files_carry_units_and_the_layout_that_vtk_knows(tmp_path):
    import h5py

    points, quads = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]), np.arange(4)[None]
    path = tmp_path / "square.hdf"
    path.write_bytes(b"an earlier file")
    square = StateField(points, quads, {"u": np.zeros((4, 3))})
    nothing = StateField(points[:0], quads[:0], {"u": np.zeros((0, 3))})
    vtkhdf.write(path, [nothing, square, nothing, square], {"u": ("m", "displacement")})
    with h5py.File(path) as file:
        root = file["VTKHDF"]
        assert root.attrs["Version"].dtype == np.int64 and root.attrs["Version"].tolist() == [1, 0]
        assert root.attrs["Type"] == b"UnstructuredGrid"
        assert h5py.check_string_dtype(root.attrs.get_id("Type").dtype) == ("ascii", 16)
        assert root["Types"].dtype == np.uint8 and root["Offsets"][:].tolist() == [0, 4, 8]
        assert root["Connectivity"][:].tolist() == [*range(8)] and len(root["Points"]) == 8
        assert root["PointData/u"].attrs["units"] == "m"
        assert root["PointData/u"].attrs["long_name"] == "displacement"
    assert [entry.name for entry in tmp_path.iterdir()] == ["square.hdf"]


def test_a_refused_file_is_said_and_leaves_nothing(tmp_path):
    square = [StateField(np.zeros((4, 2)), np.arange(4)[None], {})]
    with pytest.raises(UnwritableArchive, match="No such file or directory"):
        vtkhdf.write(tmp_path / "no" / "f.hdf", square, {})
    (tmp_path / "file").write_text("")
    with pytest.raises(UnwritableArchive, match="Not a directory"):
        vtkhdf.write(tmp_path / "file" / "f.hdf", square, {})
    (tmp_path / "folder.hdf").mkdir()
    with pytest.raises(UnwritableArchive, match="folder"):
        vtkhdf.write(tmp_path / "folder.hdf", square, {})
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["file", "folder.hdf"]


def test_every_quantity_is_described():
    given = read(HOME / "scenes" / "tables4_5.toml")
    assert set(state_field(given, 0, 2.0, 4).data) == set(fields.ABOUT)
