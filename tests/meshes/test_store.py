import sys

import numpy as np
import pytest

from galinx.meshes import MESHES, Wanted, store
from galinx.meshes.rings import QuadMesh


@pytest.fixture
def pattern(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return MESHES["graded"].build(MESHES["graded"].refinement(Wanted(1e-3)))


def same(one, other):
    assert np.array_equal(one.points, other.points) and np.array_equal(one.cells, other.cells)
    assert one.edges.keys() == other.edges.keys()
    assert all(np.array_equal(one.edges[tag], other.edges[tag]) for tag in one.edges)


def test_gmsh_gives_the_pattern_back_and_is_not_asked_twice(pattern, monkeypatch):
    assert not store.is_kept(pattern)
    same(store.obtain(pattern), pattern)
    assert store.is_kept(pattern)
    monkeypatch.setitem(sys.modules, "galinx.meshes.gmsh_model", None)  # its import would raise
    same(store.obtain(pattern), pattern)


def test_another_pattern_is_another_mesh(pattern):
    store.obtain(pattern)
    assert not store.is_kept(QuadMesh(pattern.points * (1.0 + 1e-15), pattern.cells, pattern.edges))


@pytest.mark.parametrize("damage", [lambda data: b"", lambda data: data[:200], lambda data: b"x" * 500])
def test_a_damaged_file_is_replaced(pattern, tmp_path, damage):
    store.obtain(pattern)
    (path,) = (tmp_path / "galinx" / "meshes").iterdir()
    path.write_bytes(damage(path.read_bytes()))
    same(store.obtain(pattern), pattern)
    assert store._load(path) is not None


def test_a_folder_that_cannot_be_written_is_no_fault(pattern, tmp_path):
    (tmp_path / "galinx").write_text("a file where the folder should be", encoding="utf-8")
    same(store.obtain(pattern), pattern)
