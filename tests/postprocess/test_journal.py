"""Parts that an interrupted run keeps."""

import os

import numpy as np
import pytest
from support import at_once, full_disk

from galinx.postprocess.errors import LeftOver, UnwritableArchive
from galinx.postprocess.journal import Journal, Part


def part(start, stop, value=1.0):
    return Part(slice(start, stop), {"states/f": np.full(stop - start, value)}, [], None)


def interrupted(target, key="key"):
    """Leave what a killed run leaves: two parts and a half-written archive."""
    with pytest.raises(KeyboardInterrupt), Journal(target, key) as journal:
        journal.keep(part(0, 3))
        journal.keep(part(3, 5))
        (journal.folder / ".out.h5.1.partial").write_bytes(b"half")
        raise KeyboardInterrupt
    return journal.folder


def test_parts_of_another_scene_are_refused(tmp_path):
    target = tmp_path / "out.h5"
    interrupted(target)
    with pytest.raises(LeftOver, match="belongs to another scene"), Journal(target, "other", resume=True):
        pass
    with pytest.raises(LeftOver, match="left 5 finished states"), Journal(target, "key"):
        pass
    with Journal(target, "key", resume=True) as journal:
        assert [(p.rows, p.data["states/f"].tolist()) for p in journal.parts()] == [
            (slice(0, 3), [1.0] * 3), (slice(3, 5), [1.0] * 2),
        ]  # fmt: skip
        assert not list(journal.folder.glob(".*"))
        journal.complete()
    assert not list(tmp_path.iterdir())


def test_a_new_start_gives_parts_up(tmp_path):
    target = tmp_path / "out.h5"
    interrupted(target)
    with Journal(target, "key", overwrite=True) as journal:
        assert journal.states == 0


def test_a_damaged_part_is_computed_again(tmp_path):
    target = tmp_path / "out.h5"
    folder = interrupted(target)
    first = sorted(folder.glob("*-*.npz"))[0]
    data = bytearray(first.read_bytes())
    data[data.index(np.ones(3).tobytes()) + 7] ^= 1
    first.write_bytes(data)
    with Journal(target, "key", resume=True) as journal:
        assert [p.rows for p in journal.parts()] == [slice(3, 5)]


def test_a_full_disk_leaves_nothing_where_nothing_is_kept(tmp_path):
    with full_disk(0), pytest.raises(UnwritableArchive, match="File too large"):
        Journal(tmp_path / "a.h5", "key").__enter__()
    assert not list(tmp_path.iterdir())


def test_a_lock_that_is_a_fifo_is_not_waited_for(tmp_path):
    (tmp_path / ".a.h5.work").mkdir()
    os.mkfifo(tmp_path / ".a.h5.work" / "lock")
    with at_once(), pytest.raises(UnwritableArchive, match="it is a FIFO"):
        Journal(tmp_path / "a.h5", "key").__enter__()
