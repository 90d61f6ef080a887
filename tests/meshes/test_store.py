"""Meshes through Gmsh, and what is kept of them."""

import os
import random
import sys

import numpy as np
import pytest
from support import THOROUGH

from galinx.meshes import MESHES, Requirements, store


@pytest.fixture
def pattern(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return MESHES["graded"].build(MESHES["graded"].refinement(Requirements(1e-3)))


@pytest.fixture
def kept(pattern, tmp_path):
    """The file of the pattern's mesh."""
    store.obtain(pattern)
    (path,) = (tmp_path / "galinx" / "meshes").iterdir()
    return path


def same(one, other):
    assert np.array_equal(one.points, other.points) and np.array_equal(one.cells, other.cells)
    assert one.edges.keys() == other.edges.keys()
    assert all(np.array_equal(one.edges[tag], other.edges[tag]) for tag in one.edges)


def test_gmsh_gives_the_pattern_back_and_is_not_needed_twice(pattern, monkeypatch):
    same(store.obtain(pattern), pattern)
    monkeypatch.setitem(sys.modules, "gmsh", None)  # its import would raise
    same(store.obtain(pattern), pattern)


def test_a_damaged_file_is_replaced(pattern, kept):
    whole = kept.read_bytes()
    for damaged in (b"", whole[:200], b"x" * 500):
        kept.write_bytes(damaged)
        same(store.obtain(pattern), pattern)
        assert kept.stat().st_size == len(whole)


def test_what_is_no_file_is_no_mesh(pattern, kept):
    kept.unlink()
    os.mkfifo(kept)
    same(store.obtain(pattern), pattern)


def test_a_flipped_bit_is_no_other_mesh(pattern, kept, monkeypatch):
    monkeypatch.setattr(store, "through_gmsh", lambda mesh: mesh)  # proved above, and slow
    chance, whole = random.Random(4), kept.read_bytes()
    method = 8 * (whole.index(b"PK\x01\x02") + 10)  # of compression, which may be none that there is
    for n in range(5000 if THOROUGH else 200):
        data, bit = bytearray(whole), method + n if n < 16 else chance.randrange(8 * len(whole))
        data[bit // 8] ^= 1 << bit % 8
        kept.write_bytes(data)
        same(store.obtain(pattern), pattern)


def test_a_folder_that_cannot_be_written_is_no_fault(pattern, tmp_path):
    (tmp_path / "galinx").write_text("a file where the folder should be", encoding="utf-8")
    same(store.obtain(pattern), pattern)
