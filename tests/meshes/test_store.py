import random
import sys

import numpy as np
import pytest
from support import THOROUGH

from galinx import sealed
from galinx.meshes import MESHES, Requirements, store
from galinx.meshes.rings import QuadMesh

#: Bits that are flipped in a mesh; GALINX_THOROUGH=1 asks for as many as a release does.
FLIPS = 5000 if THOROUGH else 50


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


def made_again(pattern):
    """Was the kept mesh of a pattern found damaged, and is the right one there now?"""
    said = []
    same(store.obtain(pattern, said.append), pattern)
    assert store.is_kept(pattern) and len(said) < 2
    return "is damaged; it is made again" in "".join(said)


def test_gmsh_gives_the_pattern_back_and_is_not_asked_twice(pattern, monkeypatch):
    assert not store.is_kept(pattern)
    assert not made_again(pattern)
    monkeypatch.setitem(sys.modules, "gmsh", None)  # its import would raise
    assert not made_again(pattern)


DAMAGES = {
    "empty": lambda whole: b"",
    "cut": lambda whole: whole[:200],
    "foreign": lambda whole: b"x" * 500,
    "of nothing": lambda whole: b"".join(sealed.packed(None, {})),
    "of another kind": lambda whole: b"".join(sealed.packed({"key": "a"}, {})),
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_file_is_replaced(pattern, kept, damage):
    kept.write_bytes(DAMAGES[damage](kept.read_bytes()))
    assert not store.is_kept(pattern)
    assert made_again(pattern) and not made_again(pattern)


def test_the_mesh_of_another_pattern_is_no_mesh(pattern, kept):
    wide = QuadMesh(2.0 * pattern.points, pattern.cells, pattern.edges)
    store.obtain(wide)
    (other,) = set(kept.parent.iterdir()) - {kept}
    other.replace(kept)
    assert made_again(pattern) and not made_again(wide)


def test_a_flipped_bit_is_no_other_mesh(pattern, kept, monkeypatch):
    monkeypatch.setattr(store, "through_gmsh", lambda mesh: mesh)  # proved above, and slow
    chance, whole = random.Random(4), kept.read_bytes()
    for _ in range(FLIPS):
        data, bit = bytearray(whole), chance.randrange(8 * len(whole))
        data[bit // 8] ^= 1 << bit % 8
        kept.write_bytes(data)
        assert made_again(pattern) and not made_again(pattern)
