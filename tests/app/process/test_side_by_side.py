"""Work of one process done by several: in order, and whole whatever becomes of a copy."""

import os
import signal
import subprocess
import sys
from functools import partial

import pytest
from support import HOME

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


def test_a_copy_ends_where_its_process_was_killed():
    """It would wait for ever to send more than a pipe holds, and keep the streams open."""
    script = (
        "import os, signal, time; from galinx.app import process\n"
        "os.sched_getaffinity, here = lambda _: {0, 1}, os.getpid()\n"
        "def piece():\n"
        "    if os.getpid() == here: time.sleep(1.0); os.kill(here, signal.SIGKILL)\n"
        "    return bytes(10**6)\n"
        "process.side_by_side([piece] * 16)"
    )
    done = subprocess.run([sys.executable, "-c", script], cwd=HOME, stdout=subprocess.PIPE, timeout=30)
    assert done.returncode == -signal.SIGKILL


def _done(functions):
    return process.side_by_side([partial(function, n) for n, function in enumerate(functions)])
