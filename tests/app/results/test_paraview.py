"""Whole fields of one state, in SI, and in files that VTK reads."""

import numpy as np
import pytest
from loaded import under
from support import areas, state_field

from galinx import template
from galinx.app.errors import BadInput
from galinx.app.plan.states import enumerate_states
from galinx.app.results import fields
from galinx.app.results.fields import ABOUT, write_fields
from galinx.postprocess.target import Target
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.solids.isotropic import MovingFrame


@pytest.mark.parametrize("mode", ["contact", "traction"])
def test_stresses_are_those_of_the_potentials(mode):
    given = template("tables4_5", {"motion.c": [0.0, 0.6], "solve.mode": mode})
    states = enumerate_states(given)
    number = int(np.flatnonzero(states.columns["c"] == 0.6)[1])
    found = state_field(given, number)
    a, solid = given.punch.profile.half_width, given.solid
    unit = given.punch.load / (2.0 * a)
    X, Y = found.points.T / a
    some = (Y <= -0.01) & (np.hypot(X, Y) <= 5.0)
    punch = FlatPunch(MovingFrame(3.0 - 4.0 * solid.ν, 0.6), states.g[number])
    exact = unit * under(punch).inside(X[some], Y[some])
    fem = np.array([found.data[f"sigma_{ij}"][some] for ij in ("XX", "YY", "XY")])
    assert np.abs(fem - exact).max() <= 1e-4 * np.abs(exact).max()
    error = found.data["sigma_error"]
    np.testing.assert_allclose(error[some], np.abs(fem - exact).max(axis=0), atol=1e-9 * unit)
    assert np.array_equal(np.isnan(error), Y > -1e-13)
    np.testing.assert_allclose(found.data["sigma_ZZ"][some], solid.ν * (fem[0] + fem[1]), rtol=1e-12)
    under_it = (np.abs(X) < 0.9) & (Y > -1e-12)
    np.testing.assert_allclose(found.data["displacement"][under_it, 1], -1.3217e-6, rtol=1e-4)
    # σ_YY at the surface is a pressure under the punch and vanishes beside it.
    for part, level in ((np.abs(X) < 0.9, -1.0), ((np.abs(X) > 1.1) & (np.abs(X) < 5.0), 0.0)):
        σ_YY = found.data["sigma_YY"][part & (Y > -1e-12)] / unit
        assert σ_YY.max() < -0.3 if level else np.abs(σ_YY).max() < 1e-2
    pressure = found.data["contact_pressure"] / unit
    assert np.isnan(pressure[(Y < -1e-12) | (np.abs(np.abs(X) - 1.0) < 1e-15)]).all()
    assert not pressure[(Y > -1e-14) & (np.abs(X) > 1.0)].any()
    inner = (Y > -1e-14) & (np.abs(X) < 0.999)
    assert inner.sum() > 50
    np.testing.assert_allclose(pressure[inner], -punch.σ_YY(X[inner]), rtol=1e-5)


def test_what_has_no_field_is_bad_input(tmp_path):
    given = template("tables4_5")
    count = len(enumerate_states(given))
    for number in (-1, count):
        with pytest.raises(BadInput, match=f"state {number}: .*0 to {count - 1}.* has {count}"):
            state_field(given, number)
    with pytest.raises(BadInput, match=r"expected ν <= 0\.49"):
        state_field(template("tables4_5", {"solid.nu": 0.495}), 0)
    box = template("tables4_5", {"solve.mesh": "box"})
    for extent in (90.0, 0.0, np.nan):
        with pytest.raises(BadInput, match="at most 60 a with the box mesh"):
            write_fields(box, [0], Target(tmp_path / "none.hdf"), extent)
    with pytest.raises(BadInput, match="degree: found 40, expected 4 to 13"):
        state_field(given, 0, degree=40)


def test_vtk_reads_what_was_written(tmp_path):
    reading = pytest.importorskip("vtkmodules.vtkIOHDF")
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter

    given = template("tables4_5")
    a, path = given.punch.profile.half_width, tmp_path / "state.hdf"
    write_fields(given, [1], Target(path), extent=3.0)
    written = state_field(given, 1, extent=3.0)
    reader = reading.vtkHDFReader()
    assert reader.CanReadFile(str(path))
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    assert grid.GetNumberOfPoints() == len(written.points)
    assert grid.GetNumberOfCells() == len(written.quads)
    triangles = written.quads[:, 2] == written.quads[:, 3]
    kinds = [grid.GetCellType(i) for i in range(grid.GetNumberOfCells())]
    assert kinds == np.where(triangles, 5, 9).tolist() and 0 < triangles.sum() < 0.1 * len(triangles)
    data = grid.GetPointData()
    assert {data.GetArrayName(i) for i in range(data.GetNumberOfArrays())} == set(ABOUT)
    for name, values in written.data.items():
        np.testing.assert_array_equal(vtk_to_numpy(data.GetArray(name)), values)
    points = vtk_to_numpy(grid.GetPoints().GetData())
    np.testing.assert_array_equal(points[:, :2], written.points)
    assert not points[:, 2].any()
    np.testing.assert_allclose(np.array(grid.GetBounds()) / a, [-3, 3, -3, 0, 0, 0], atol=1e-12)
    field = grid.GetFieldData()
    told = {
        field.GetArrayName(i): field.GetAbstractArray(i).GetVariantValue(0).ToString()
        for i in range(field.GetNumberOfArrays())
    }
    assert told["title"] == "Tables 4 and 5" and told["motion"] == "FM1" and told["state"] == "1"
    assert float(told["load"]) == 55.3e3 and float(told["mean_pressure"]) == 55.3e3 / (2.0 * a)
    assert float(told["c"]) == 4.786e-7 and float(told["f"]) == pytest.approx(0.659796754)
    assert float(told["speed"]) == pytest.approx(4.786e-7 * given.solid.c_s, rel=1e-4)
    size = vtkCellSizeFilter()
    size.SetInputData(grid)
    size.Update()
    found = vtk_to_numpy(size.GetOutput().GetCellData().GetArray("Area"))
    # Some VTKs take quadrilaterals of 1e-15 m² for points.
    np.testing.assert_allclose(found, areas(written.points, written.quads), atol=1e-14)
    assert found.sum() == pytest.approx(18.0 * a**2, rel=1e-9)


def test_several_states_are_a_series(tmp_path, monkeypatch):
    """States at two speeds, whose cells differ; a newer VTK reads it, see tests/with_wheel.sh."""
    import h5py

    scene, path = template("tables4_5"), tmp_path / "series.vtkhdf"
    numbers = [3, 7]
    write_fields(scene, numbers, Target(path), extent=3.0, degrees=[5, 6])
    alone = [state_field(scene, number, 3.0, degree) for number, degree in zip(numbers, (5, 6))]
    with h5py.File(path) as file:
        root, steps = file["VTKHDF"], file["VTKHDF/Steps"]
        assert root.attrs["Version"].tolist() == [2, 0] and steps.attrs["NSteps"] == 2
        assert steps["Values"][:].tolist() == [3.0, 7.0]
        assert steps["PartOffsets"][:].tolist() == [0, 1]
        assert steps["NumberOfParts"][:].tolist() == [1, 1]
        assert root["FieldData/state"][:].tolist() == numbers
        assert root["FieldData/motion"][:].tolist() == [b"BM1", b"FM1"]
        assert steps["FieldDataOffsets/motion"][:].tolist() == [0, 1]
        assert root["PointData"][fields.COLOURED].attrs["Attribute"] == b"Scalars"
        for i, one in enumerate(alone):
            points, cells = root["NumberOfPoints"][i], root["NumberOfCells"][i]
            assert (points, cells) == (len(one.points), len(one.quads))
            first = steps["PointOffsets"][i]
            np.testing.assert_array_equal(root["Points"][first : first + points, :2], one.points)
            for name, values in one.data.items():
                begin = steps[f"PointDataOffsets/{name}"][i]
                written = root[f"PointData/{name}"][begin : begin + points]
                np.testing.assert_allclose(
                    written, values, rtol=1e-9, atol=1e-9 * np.nanmax(np.abs(values))
                )
            begin = steps["CellOffsets"][i, 0] + i  # as many cells, and one end more of each grid before
            ends = root["Offsets"][begin : begin + cells + 1]
            assert ends[0] == 0 and ends[-1] == root["NumberOfConnectivityIds"][i]
            begin = steps["ConnectivityIdOffsets"][i, 0]
            corners = root["Connectivity"][begin : begin + ends[-1]]
            assert corners.min() == 0 and corners.max() == points - 1
