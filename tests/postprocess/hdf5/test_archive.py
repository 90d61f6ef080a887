import hashlib
import os

import h5py
import numpy as np
import pytest

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
    with archive.Writer(Target(path)) as writer:
        for name, value in data.items():
            writer.put(name, value)
        writer.finish(attributes)


def test_anyone_can_verify_the_seal(tmp_path):
    path = tmp_path / "a.h5"
    write(path, DATA)
    content = path.read_bytes()
    assert content[512:].startswith(b"\x89HDF")
    assert hashlib.sha256(content[512:]).hexdigest().encode() in content[:512]
    archive.verify(path)


def test_rows_come_in_any_order(tmp_path):
    path = tmp_path / "a.h5"
    rows = np.arange(12.0).reshape(4, 3)
    with archive.Writer(Target(path)) as writer:
        writer.reserve("surface/fem/sigma_XX", rows.shape)
        writer.write("surface/fem/sigma_XX", slice(2, 4), rows[2:])
        writer.write("surface/fem/sigma_XX", slice(0, 2), rows[:2])
        writer.finish(ATTRIBUTES)
    with h5py.File(path) as file:
        np.testing.assert_array_equal(file["surface/fem/sigma_XX"], rows)


def test_an_archive_that_is_not_finished_leaves_nothing(tmp_path):
    with pytest.raises(ZeroDivisionError), archive.Writer(Target(tmp_path / "a.h5")) as writer:
        writer.put("states/f", np.zeros(2))
        raise ZeroDivisionError
    assert not os.listdir(tmp_path)
