import numpy as np

from galinx.postprocess.hdf5 import vtkhdf
from galinx.postprocess.hdf5.vtkhdf import Piece


def test_files_carry_units_and_the_layout_that_vtk_knows(tmp_path):
    import h5py

    points, quads = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]), np.arange(4)[None]
    path = tmp_path / "square.hdf"
    square = Piece(points, quads, {"u": np.zeros((4, 3))})
    nothing = Piece(points[:0], quads[:0], {"u": np.zeros((0, 3))})
    triangle = Piece(points[:3], np.array([[0, 1, 2, 2]]), {"u": np.zeros((3, 3))})
    told = {"title": "µ", "state": 3}
    grid = vtkhdf.Step(0.0, [nothing, square, nothing, triangle, square], told)
    vtkhdf.write(path, [grid], {"u": ("m", "displacement")}, coloured="u")
    with h5py.File(path) as file:
        root = file["VTKHDF"]
        assert root.attrs["Version"].dtype == np.int64 and root.attrs["Version"].tolist() == [1, 0]
        assert root.attrs["Type"] == b"UnstructuredGrid"
        assert h5py.check_string_dtype(root.attrs.get_id("Type").dtype) == ("ascii", 16)
        assert root["Types"].dtype == np.uint8 and root["Types"][:].tolist() == [9, 5, 9]
        assert root["Offsets"][:].tolist() == [0, 4, 7, 11]
        assert root["Connectivity"][:].tolist() == [*range(11)] and len(root["Points"]) == 11
        assert "Steps" not in root and root["PointData/u"].attrs["Attribute"] == b"Scalars"
        assert root["FieldData/state"][:].tolist() == [3]
        # VTK reads no text that calls itself UTF-8.
        assert h5py.check_string_dtype(root["FieldData/title"].dtype) == ("ascii", None)
        assert root["FieldData/title"][0] == "µ".encode()
        assert root["PointData/u"].attrs["units"] == "m"
        assert root["PointData/u"].attrs["long_name"] == "displacement"
    assert [entry.name for entry in tmp_path.iterdir()] == ["square.hdf"]
