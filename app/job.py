"""Start of a process, before any library is imported that could fail; and ``run.sh -n``, which starts
mpirun.

python3 -P -m galinx.app.job MPIRUN RANKS PYTHON ARGUMENTS OF galinx

The job says for all its ranks together how they ended. Every rank has this process's output and error
streams, and reports to it on a line of its own, see :mod:`galinx.app.process`, the status with which it
ends. Where rank 0 ends without one, the work was stopped. What mpirun itself prints counts only where no
rank has come to speak.
"""

import fcntl
import io
import json
import os
import resource
import secrets
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import warnings
from contextlib import suppress
from typing import Any, NoReturn

from . import errors, process
from .console import Output, plain

#: Bytes of address space that finite elements need with all libraries; with less some wait for ever.
_ADDRESS_SPACE = 10**9


def begin() -> None:
    """Make the process ready: signals, streams, warnings; or end it where it could do nothing."""
    _open_streams()
    process.listen()
    process.join()
    _prepare_streams()
    if any(option.startswith("error") for option in sys.warnoptions):
        warnings.simplefilter("ignore")  # those of libraries are no errors of the user's
    _check_machine()


def refuse(message: str) -> NoReturn:
    """End with a failure that all ranks share."""
    process.fail(errors.FAILURE, message)
    sys.exit(errors.FAILURE)


def _open_streams() -> None:
    """Open the null device for closed streams: the next file would get their number, and all output.

    An output that is open for reading only becomes the null device, too: where the error stream is
    closed, bash hands on its script under that number.
    """
    for number in range(3):
        try:
            flags = fcntl.fcntl(number, fcntl.F_GETFL)
        except OSError:
            # The lowest number that is free is this one.
            os.set_inheritable(os.open(os.devnull, os.O_RDWR), True)
            continue
        if number > 0 and flags & os.O_ACCMODE == os.O_RDONLY:
            null = os.open(os.devnull, os.O_RDWR)
            os.dup2(null, number)
            os.close(null)


def _prepare_streams() -> None:
    """Encodings that lack a character write another; a rank's streams are those of its job by now."""
    encoding = sys.stdout.encoding if sys.stdout else "utf-8"  # there is none where it was closed
    below = io.BufferedWriter(Output(1))
    sys.stdout = io.TextIOWrapper(below, encoding, errors="replace", line_buffering=os.isatty(1))
    stderr: Any = sys.stderr or os.fdopen(2, "w", encoding="utf-8", closefd=False)
    stderr.reconfigure(errors="replace")
    sys.stderr = stderr


def _check_machine() -> None:
    if sys.flags.optimize > 1:
        refuse(
            "Python leaves texts out that compilers of forms need; unset PYTHONOPTIMIZE, or set it to 1"
        )
    limit, _ = resource.getrlimit(resource.RLIMIT_AS)
    if limit != resource.RLIM_INFINITY and limit < _ADDRESS_SPACE:
        refuse(
            f"the address space is limited to {limit / 1e6:.0f} MB, expected at least "
            f"{_ADDRESS_SPACE / 1e6:.0f} MB; raise the limit (ulimit -v, in kB)"
        )
    try:
        os.environ["TMPDIR"] = tempfile.gettempdir()  # MPI ends the process where TMPDIR names none
    except OSError as error:
        refuse(f"{error.strerror}; set TMPDIR to a folder that can be written")
    if os.path.expanduser("~") == "~":
        refuse(
            f"no home folder is known: HOME is not set, and user {os.getuid()} has no entry in passwd; "
            "set HOME to a folder that can be written"
        )


#: Seconds that ranks have to end in order, and bytes that are shown of what mpirun says.
_PATIENCE, _LONGEST = 3.0, 10**6


class _Rank(threading.Thread):
    """A rank as its job sees it: it is given the job's streams, and listened to until it ends.

    Attributes:
        process: its number.
        reports: the last of each kind.
    """

    def __init__(self, line: socket.socket, process: int) -> None:
        super().__init__(daemon=True)
        self._line, self.process = line, process
        self.reports: dict[str, Any] = {}

    def run(self) -> None:
        with suppress(OSError):  # it may be killed at any moment
            socket.send_fds(self._line, [b"."], [1, 2])
        with suppress(OSError), self._line.makefile("rb") as reports:
            for report in reports:
                if report.endswith(b"\n"):
                    self.reports |= json.loads(report)


def run(command: list[str]) -> int:
    """Run mpirun to its end; return the status of the job, whose reason was printed.

    mpirun ends the other ranks where one fails, is killed or is interrupted. Nothing here is a file: a
    job that is killed leaves nothing behind.

    Args:
        command: mpirun and its arguments.
    """
    stopped: list[int] = []  # by signals that this process got
    name = f"galinx-{secrets.token_hex(16)}"
    server = socket.socket(socket.AF_UNIX)
    server.bind(process.address(name))
    server.listen(1024)
    ranks: list[_Rank] = []
    threading.Thread(target=_serve, args=(server, ranks), daemon=True).start()
    words = os.memfd_create("mpirun")
    child = subprocess.Popen(
        command, stdin=subprocess.DEVNULL, stdout=words, stderr=words,
        # Open MPI sends a signal a second late, and kills right after: here ranks are signalled first.
        env=os.environ | {process.VARIABLE: name, "OMPI_MCA_odls_base_sigkill_timeout": "0"},
        start_new_session=True,  # Ctrl-C is for this process to hand on
    )  # fmt: skip

    def hand_on(number: int, _: object) -> None:
        stopped.append(number)
        for rank in ranks:
            with suppress(ProcessLookupError):
                os.kill(rank.process, signal.SIGTERM)
        patience = threading.Timer(_PATIENCE * bool(ranks), child.terminate)
        patience.daemon = True
        patience.start()

    for number in process.SIGNALS:
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, hand_on)
    child.wait()
    for rank in ranks:
        rank.join()
    reports = [rank.reports for rank in ranks]
    root = next((report for report in reports if report.get("rank") == 0), {})
    if "status" not in root:
        process.erase_bar()
    for report in (root, *reports):
        if report.get("status", errors.GOOD) >= errors.BAD_INPUT:
            if report["words"]:  # a reader that went away wants none
                process.complain(plain(report["words"]))
            return report["status"]
    if "status" in root:
        return root["status"]
    if reports or stopped or child.returncode < 0:
        cause = "interrupted" if stopped else "a rank or mpirun was killed (did the machine lack memory?)"
        process.complain(f"{cause}; {root.get('left', process.NOTHING)}")
    else:
        sys.stderr.write(os.pread(words, _LONGEST, 0).decode(errors="replace"))
        process.complain("mpirun could not start the ranks; its own words are above")
    return errors.FAILURE


def _serve(server: socket.socket, ranks: list[_Rank]) -> None:
    """Take in ranks as they come; another user's process is none."""
    while True:
        line, _ = server.accept()
        peer = line.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, 12)
        number, user, _ = struct.unpack("iII", peer)
        if user != os.getuid():
            line.close()
        else:
            rank = _Rank(line, number)
            rank.start()
            ranks.append(rank)


def main() -> None:
    """Start a job as the command line says, and end with its status."""
    # Where one process is killed, those that it started do not outlive it.
    tied = [["setpriv", "--pdeathsig", end] * bool(shutil.which("setpriv")) for end in ("TERM", "KILL")]
    try:
        begin()
        mpirun, count, python, *arguments = sys.argv[1:]
        galinx = [*tied[1], python, "-P", "-m", "galinx", *arguments]
        status = run([*tied[0], mpirun, "-n", count, *galinx])
    except process.Interrupted:
        process.end_stopped(process.NOTHING)
    except OSError as error:
        refuse(f"cannot start mpirun: {error}")
    sys.exit(status)


if __name__ == "__main__":
    main()
