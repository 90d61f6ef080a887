"""A job of several ranks: who is one of them, and what is left of it."""

import signal
import subprocess
import sys

from support import SCENE, clean_environment, command

from galinx.app import errors

#: Starts a job whose mpirun is the command given.
JOB = "import sys; from galinx.app import job; sys.exit(job.run(sys.argv[1:]))"
#: A rank that reports what it is given.
RANK = """
import json, os, socket, sys
line = socket.socket(socket.AF_UNIX)
line.connect("\\0" + os.environ["GALINX_JOB"])
try:
    line.recv(1)
    report = {"rank": 0, "status": int(sys.argv[1]), "words": sys.argv[2] * 10**6}
    line.sendall(json.dumps(report).encode() + b"\\n")
except OSError:
    pass
"""


STOPPED = "error: a rank or mpirun was killed (did the machine lack memory?); nothing was written\n"


def job(*mpirun):
    """Status of a job, and what it says."""
    done = subprocess.run(
        [sys.executable, "-c", JOB, *mpirun], env=clean_environment(), capture_output=True, text=True,
        timeout=60,
    )  # fmt: skip
    return done.returncode, done.stderr


def test_an_mpirun_that_starts_no_rank_is_said():
    assert job("sh", "-c", "kill -KILL $$") == (errors.FAILURE, STOPPED)
    status, said = job("sh", "-c", "echo no slots; exit 1")
    assert status == errors.FAILURE and said.startswith("no slots\nerror: mpirun could not start")


def test_another_user_is_no_rank(stranger):
    status, said = job(*stranger, sys.executable, "-c", RANK, "0", "")
    assert status == errors.FAILURE and "mpirun could not start the ranks" in said


def test_a_job_that_is_killed_leaves_nothing_behind(tmp_path):
    mpirun = tmp_path / "mpirun"
    mpirun.write_text("#!/bin/sh\nkill -KILL $PPID\n", encoding="utf-8")
    mpirun.chmod(0o700)
    done = subprocess.run(
        [sys.executable, "-m", "galinx.app.job", mpirun, "2", sys.executable, "plan", SCENE], timeout=60,
        env=clean_environment() | {"TMPDIR": str(tmp_path)},
    )  # fmt: skip
    assert done.returncode == -signal.SIGKILL and [*tmp_path.iterdir()] == [mpirun]


#: Rank 1 is killed when rank 0 is about to read a message from its memory.
KILLED = """
import os, signal
from contextlib import suppress
from pathlib import Path
import numpy as np
from mpi4py import MPI

comm, data, status = MPI.COMM_WORLD, np.zeros(10**6), MPI.Status()
signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGTERM])
if comm.rank:
    comm.Isend(data, 0, os.getpid())
    os.kill(os.getpid(), signal.SIGKILL)
comm.Probe(1, status=status)
with suppress(OSError):  # until it is dead, or gone
    while ") Z " not in Path(f"/proc/{status.tag}/stat").read_text():
        pass
comm.Irecv(data, 1)
signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGTERM])
"""


def test_what_mpi_says_of_a_killed_rank_is_not_shown(tmp_path):
    (tmp_path / "killed.py").write_text(KILLED, encoding="utf-8")
    done = command("-n", 2, "-x", tmp_path / "killed.py", "plan", SCENE)
    assert (done.returncode, done.stderr) == (errors.FAILURE, STOPPED)
