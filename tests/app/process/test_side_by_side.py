"""Work of one process done by several: in order, and whole whatever becomes of a copy."""

import os
from functools import partial

import pytest

from galinx.app import process

HERE = os.getpid()


def _worker(n):
    return f"{n} {os.getpid()}".encode()


def _dies(n):
    if os.getpid() != HERE:
        os._exit(9)
    return _worker(n)


def _fails(n):
    raise ValueError(n)


@pytest.fixture(autouse=True)
def two_cores(monkeypatch):
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1})


@pytest.mark.parametrize("count, processes", [(0, 0), (1, 1), (15, 1), (16, 2), (31, 2)])
def test_results_are_in_the_order_of_the_work(count, processes):
    numbers, by = zip(*(one.split() for one in _done([_worker] * count))) if count else ((), ())
    assert [int(n) for n in numbers] == list(range(count))
    assert len(set(by)) == processes


def test_what_a_copy_leaves_is_done_here():
    numbers, by = zip(*(one.split() for one in _done([_worker, _dies] * 10)))
    assert [int(n) for n in numbers] == list(range(20)) and set(by) == {str(HERE).encode()}


def test_an_error_is_raised_here(capfd):
    with pytest.raises(ValueError, match="17"):
        _done([*[_worker] * 17, _fails, *[_worker] * 3])
    assert not any(capfd.readouterr())


def _done(functions):
    return process.side_by_side([partial(function, n) for n, function in enumerate(functions)])
