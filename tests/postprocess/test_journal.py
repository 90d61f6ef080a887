"""Parts that an interrupted run keeps."""

import os
import random

import numpy as np
import pytest
from support import THOROUGH

from galinx.postprocess.errors import LeftOver
from galinx.postprocess.journal import Journal, Part

#: Bits that are flipped in parts; GALINX_THOROUGH=1 asks for as many as a release does.
FLIPS = 5000 if THOROUGH else 50


def part(start, stop):
    n = stop - start
    data = {
        "states/f": np.arange(start, stop) / 7.0,
        "turned": np.arange(6.0 * n).reshape(6, n).T,
        "none": np.ones((n, 0)),
        "whole": np.arange(n) > 1,
        "unknown": np.full((n, 2), np.nan),
    }
    return Part(slice(start, stop), data, {"balance": 1e-9 * stop}, {"speed": start})


#: What a killed run leaves; the last is only half full.
PARTS = (part(0, 3), part(3, 6), part(6, 7))


def interrupted(target, key="key"):
    """Leave what a killed run leaves: its parts and a half-written archive."""
    with pytest.raises(KeyboardInterrupt), Journal(target, key) as journal:
        for one in PARTS:
            journal.keep(one)
        (journal.folder / ".out.h5.1.partial").write_bytes(b"half")
        raise KeyboardInterrupt
    return journal.folder


def exactly(part):
    """A part as something that can be compared, NaN included."""
    arrays = [(name, x.dtype, x.shape, x.tobytes()) for name, x in part.data.items()]
    return part.rows, arrays, part.comparisons, part.record


def kept(target, key="key"):
    """Numbers of the parts that a run finds when it goes on, and how many are as good as not kept."""
    with Journal(target, key, resume=True) as journal:
        found = [[*map(exactly, PARTS)].index(exactly(part)) for part in journal.parts()]
        assert journal.states == sum(PARTS[n].rows.stop - PARTS[n].rows.start for n in found)
    return found, journal.damaged


def test_parts_of_another_scene_are_refused(tmp_path):
    target = tmp_path / "out.h5"
    interrupted(target)
    with pytest.raises(LeftOver, match="belongs to another scene"), Journal(target, "other", resume=True):
        pass
    with pytest.raises(LeftOver, match="left 7 finished states"), Journal(target, "key"):
        pass
    assert kept(target) == ([0, 1, 2], 0)
    with Journal(target, "key", resume=True) as journal:
        assert not list(journal.folder.glob(".*"))
        journal.complete()
    assert not list(tmp_path.iterdir())


def test_a_new_start_gives_parts_up(tmp_path):
    target = tmp_path / "out.h5"
    interrupted(target)
    with Journal(target, "key", overwrite=True) as journal:
        assert journal.states == 0 and not list(journal.parts())


def exchange(*paths):
    contents = [path.read_bytes() for path in paths]
    for path, content in zip(paths, reversed(contents)):
        path.write_bytes(content)


def become(path, make):
    path.unlink()
    make(path)


#: What happens to the first two of the parts, and what is left.
DAMAGES = {
    "cut": (lambda first, _: os.truncate(first, 100), [1, 2]),
    "empty": (lambda first, _: os.truncate(first, 0), [1, 2]),
    "a folder": (lambda first, _: become(first, os.mkdir), [1, 2]),
    "a FIFO": (lambda first, _: become(first, os.mkfifo), [1, 2]),
    "of another kind": (lambda first, _: np.savez(first.open("wb"), a=np.ones(3)), [1, 2]),
    "renamed": (lambda first, _: first.rename(first.with_name("0000000007-0000000010.part")), [1, 2]),
    "without a number": (lambda first, _: first.rename(first.with_name("a-b.part")), [1, 2]),
    "copied": (lambda first, second: second.write_bytes(first.read_bytes()), [0, 2]),
    "exchanged": (lambda first, second: exchange(first, second), [2]),
}  # fmt: skip


@pytest.mark.parametrize("damage", DAMAGES)
def test_what_is_not_as_it_was_kept_is_not_there(tmp_path, damage):
    target = tmp_path / "out.h5"
    first, second, _ = sorted(interrupted(target).glob("*.part"))
    make, left = DAMAGES[damage]
    make(first, second)
    assert kept(target) == (left, len(PARTS) - len(left))


def test_a_part_of_another_run_is_not_there(tmp_path):
    target = tmp_path / "out.h5"
    first, *_ = sorted(interrupted(target).glob("*.part"))
    theirs = interrupted(tmp_path / "other.h5", "other") / first.name
    theirs.rename(first)
    assert kept(target) == ([1, 2], 1)


def test_a_run_of_which_nothing_is_whole_begins_anew(tmp_path):
    target = tmp_path / "out.h5"
    for path in interrupted(target).glob("*.part"):
        os.truncate(path, 50)
    assert kept(target) == ([], 3)
    assert not list(tmp_path.iterdir())


def test_a_flipped_bit_changes_no_number(tmp_path):
    target, chance = tmp_path / "out.h5", random.Random(2)
    paths = sorted(interrupted(target).glob("*.part"))
    for _ in range(FLIPS):
        n = chance.randrange(len(paths))
        whole = paths[n].read_bytes()
        data, bit = bytearray(whole), chance.randrange(8 * len(whole))
        data[bit // 8] ^= 1 << bit % 8
        paths[n].write_bytes(data)
        # Some bits, as those of times, say nothing of the part: it is whole then.
        found, damaged = kept(target)
        assert found == [m for m in range(len(paths)) if m != n or not damaged] and damaged in (0, 1)
        paths[n].write_bytes(whole)
