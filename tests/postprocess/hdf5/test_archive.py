import os

import h5py
import numpy as np
import pytest

from galinx import files
from galinx.postprocess.errors import UnreadableArchive, UnwritableArchive
from galinx.postprocess.hdf5 import archive
from galinx.postprocess.target import Target

DATA = {
    "scene/text": "title = 'σ'\n",
    "states/motion": np.array(["FM1", "BM1"]),
    "states/f": np.array([0.1, np.nan]),
    "run/skipped": [],
    "run/fem/cells": np.array([3]),
}

ATTRIBUTES = {"version": "1", "verdict": "PASS", "title": "t"}


def write(path, data, attributes=ATTRIBUTES):
    with archive.Writer(path) as writer:
        for name, value in data.items():
            writer.put(name, value)
        writer.finish(attributes)


def test_round_trip(tmp_path):
    path = tmp_path / "a.h5"
    write(path, DATA)
    data, attributes = archive.read(path)
    for name, value in DATA.items():
        np.testing.assert_array_equal(data[name], value)
    assert attributes["complete"] and attributes["program"] == "galinx"
    assert attributes["schema_version"] == archive.SCHEMA_VERSION and "created" in attributes
    assert os.listdir(tmp_path) == ["a.h5"]


def test_every_dataset_has_unit_and_name(tmp_path):
    path = tmp_path / "a.h5"
    write(path, DATA)
    with h5py.File(path) as file:
        for name in DATA:
            assert file[name].attrs["units"] and file[name].attrs["long_name"]


def test_an_earlier_archive_survives_a_failing_write(tmp_path, monkeypatch):
    path = tmp_path / "a.h5"
    write(path, DATA)
    before = path.read_bytes()

    def fail(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(files, "synchronise", fail)
    with pytest.raises(UnwritableArchive, match="No space left"):
        write(Target(path, overwrite=True), DATA | {"states/f": np.zeros(2)})
    assert path.read_bytes() == before and os.listdir(tmp_path) == ["a.h5"]


def test_content_that_reads_back_differently_is_found(tmp_path):
    with archive.Writer(tmp_path / "a.h5") as writer:
        writer.put("states/f", np.array([0.1, 0.2]))
        writer._file["states/f"][1] = 0.3
        with pytest.raises(UnwritableArchive, match="states/f"):
            writer.finish(ATTRIBUTES)
    assert not os.listdir(tmp_path)


def test_rows_come_in_any_order(tmp_path):
    path = tmp_path / "a.h5"
    rows = np.arange(12.0).reshape(4, 3)
    with archive.Writer(path) as writer:
        writer.reserve("surface/fem/sigma_XX", rows.shape)
        writer.write("surface/fem/sigma_XX", slice(2, 4), rows[2:])
        writer.write("surface/fem/sigma_XX", slice(0, 2), rows[:2])
        writer.finish(ATTRIBUTES)
    np.testing.assert_array_equal(archive.read(path)[0]["surface/fem/sigma_XX"], rows)
    assert "surface/fem/sigma_XX" not in archive.read(path, stresses=False)[0]


def test_an_archive_that_is_not_finished_leaves_nothing(tmp_path):
    with pytest.raises(ZeroDivisionError), archive.Writer(tmp_path / "a.h5") as writer:
        writer.put("states/f", np.zeros(2))
        raise ZeroDivisionError
    assert not os.listdir(tmp_path)


def test_a_flipped_bit_is_found(tmp_path):
    path = tmp_path / "a.h5"
    write(path, DATA | {"states/f": np.full(2, 0.123456789)})
    content = bytearray(path.read_bytes())
    content[content.index(np.float64(0.123456789).tobytes())] ^= 1
    path.write_bytes(content)
    with pytest.raises(UnreadableArchive, match="damaged"):
        archive.read(path)


@pytest.mark.parametrize("damage", ["truncated", "text", "foreign", "newer", "missing"])
def test_files_that_are_no_archives(tmp_path, damage):
    path = tmp_path / "a.h5"
    if damage == "text":
        path.write_text("hello")
    elif damage == "foreign":
        h5py.File(path, "w").close()
    elif damage != "missing":
        write(path, DATA)
    if damage == "truncated":
        path.write_bytes(path.read_bytes()[:-200])
    if damage == "newer":
        with h5py.File(path, "a") as file:
            file.attrs["schema_version"] = 99
    message = {"newer": "install a newer", "foreign": "not an archive", "missing": "not a file"}
    with pytest.raises(UnreadableArchive, match=message.get(damage, "damaged")):
        archive.read(path)


def test_a_path_outside_the_table_of_fields_is_refused(tmp_path):
    with pytest.raises(KeyError):
        write(tmp_path / "a.h5", {"states/unknown": np.zeros(1)})
