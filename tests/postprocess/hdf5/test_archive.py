import hashlib
import json
import os

import h5py
import numpy as np
import pytest
import support

from galinx import files
from galinx.postprocess.errors import UnwritableArchive
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


def test_what_is_put_in_is_there(tmp_path):
    path = tmp_path / "a.h5"
    write(path, DATA)
    with h5py.File(path) as file:
        for name, value in DATA.items():
            text = h5py.check_string_dtype(file[name].dtype)
            np.testing.assert_array_equal((file[name].asstr() if text else file[name])[()], value)
        assert file.attrs["complete"] and file.attrs["program"] == "galinx"
        assert json.loads(file.attrs["datasets"]) == list(DATA)
    assert os.listdir(tmp_path) == ["a.h5"]


def test_anyone_can_verify_the_seal(tmp_path):
    path = tmp_path / "a.h5"
    write(path, DATA)
    content = path.read_bytes()
    assert content[512:].startswith(b"\x89HDF")
    assert hashlib.sha256(content[512:]).hexdigest().encode() in content[:512]
    archive.verify(path)


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


def test_rows_come_in_any_order(tmp_path):
    path = tmp_path / "a.h5"
    rows = np.arange(12.0).reshape(4, 3)
    with archive.Writer(path) as writer:
        writer.reserve("surface/fem/sigma_XX", rows.shape)
        writer.write("surface/fem/sigma_XX", slice(2, 4), rows[2:])
        writer.write("surface/fem/sigma_XX", slice(0, 2), rows[:2])
        writer.finish(ATTRIBUTES)
    with h5py.File(path) as file:
        np.testing.assert_array_equal(file["surface/fem/sigma_XX"], rows)


def test_an_archive_that_is_not_finished_leaves_nothing(tmp_path):
    with pytest.raises(ZeroDivisionError), archive.Writer(tmp_path / "a.h5") as writer:
        writer.put("states/f", np.zeros(2))
        raise ZeroDivisionError
    assert not os.listdir(tmp_path)


def test_a_path_outside_the_table_of_fields_is_refused(tmp_path):
    with pytest.raises(KeyError):
        write(tmp_path / "a.h5", {"states/unknown": np.zeros(1)})


def test_rows_are_written_without_reading_what_is_there(tmp_path, monkeypatch):
    """A few rows at a time into a large dataset: HDF5 keeps the chunk that it is at."""
    count, read = [0], archive.PatientFile.readinto

    def counted(self, buffer):
        count[0] += memoryview(buffer).nbytes
        return read(self, buffer)

    monkeypatch.setattr(archive.PatientFile, "readinto", counted)
    values = np.arange(30_000.0)
    with archive.Writer(tmp_path / "a.h5") as writer:
        for name in ("states/f", "states/g"):
            writer.reserve(name, values.shape)
        for first in range(0, len(values), 100):
            rows = slice(first, first + 100)
            for name in ("states/f", "states/g"):
                writer.write(name, rows, values[rows])
        writer.finish(ATTRIBUTES)
    assert count[0] < 2 * 2 * values.nbytes
    with h5py.File(tmp_path / "a.h5") as file:
        np.testing.assert_array_equal(file["states/g"], values)


def test_an_archive_tells_what_slides_over_what(tmp_path):
    support.computed("fig5", {"solve.methods": ["closed_form"]}).save(tmp_path / "a.h5")
    _, told = archive.read(tmp_path / "a.h5")
    assert told["material"] == "T302" and told["schema_version"] == 4
    assert json.loads(told["solid"]) == {
        "kind": "isotropic", "E": 193e9, "nu": 0.25, "rho": 7860.0, "plane": "strain",
        "yield_strength": 205e6,
    }  # fmt: skip
    c_s = np.sqrt(193e9 / 2.5 / 7860.0)
    known = {
        "half_width": 1e-3,
        "load": 55.3e3,
        "c_s": c_s,
        "speed_limit": c_s * np.sqrt(2 - 2 / np.sqrt(3)),
    }
    assert {name: told[name] for name in known} == pytest.approx(known, rel=1e-14)
