"""Start of a process, before any library is imported that could fail; and ``run.sh -n``, which starts
mpirun.

python3 -P -m galinx.app.job MPIRUN RANKS PYTHON ARGUMENTS OF galinx

The job reports for all its ranks together how they ended. Every rank has this process's output and error
streams, and reports to it on a line of its own, see :mod:`galinx.app.process`, the status with which it
ends, or that it was interrupted. A rank that ends without a word was killed. What mpirun itself prints
counts only where no rank has come to speak.
"""

import fcntl
import io
import json
import os
import re
import resource
import secrets
import select
import shutil
import signal
import socket
import stat
import struct
import subprocess
import sys
import time
import warnings
from contextlib import suppress
from typing import IO, Any, NoReturn

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
    _find_temporary_folder()
    if os.path.expanduser("~") == "~":
        refuse(
            f"no home folder is known: HOME is not set, and user {os.getuid()} has no entry in passwd; "
            "set HOME to a folder that can be written"
        )


def _find_temporary_folder() -> None:
    """Let TMPDIR name a folder that files can be made in: MPI ends the process without one."""
    named = [os.environ[name] for name in ("TMPDIR", "TEMP", "TMP") if os.environ.get(name)]
    for folder in (*named, "/tmp", "/var/tmp", os.curdir):
        probe = os.path.join(folder, f".galinx-{os.getpid()}-{secrets.token_hex(4)}")
        with suppress(OSError):
            os.mkdir(probe)
            os.rmdir(probe)
            if named and folder != named[0]:
                os.environ["TMPDIR"] = os.path.abspath(folder)
            return
    refuse(
        f"no folder for temporary files: none can be made in {', '.join((*named, '/tmp', '/var/tmp'))} "
        "or the current folder; set TMPDIR to one that can be written"
    )


#: Seconds between the interruption of ranks and their being killed: MPIs give them as much.
_PATIENCE = 5.0
#: Arguments that name what is open already: ranks have nothing of it.
_OPEN = re.compile(r"/dev/(stdin)|/(?:dev|proc/self)/fd/(\d+)")
#: Bytes that are read of what may have no end: more than any scene has.
_LARGEST = 10**8


class _Rank:
    """A rank as its job sees it: its line, its process, and its reports."""

    def __init__(self, line: socket.socket) -> None:
        self.line, self._rest = line, b""
        self.reports: dict[str, Any] = {}
        self._process, _ = _peer(line)
        with suppress(OSError):
            socket.send_fds(line, [b"."], [1, 2])

    def listen(self) -> bool:
        """Receive the rank's reports; False when it has ended."""
        try:
            data = self.line.recv(65536)
        except OSError:
            data = b""
        *lines, self._rest = (self._rest + data).split(b"\n")
        for text in lines:
            self.reports |= json.loads(text)
        return bool(data)

    def kill(self, number: int) -> None:
        """Send a signal; only while the line is open, later the process may be another."""
        with suppress(ProcessLookupError):
            os.kill(self._process, number)

    @property
    def has_failed(self) -> bool:
        """True where the rank reports that it ends with a failure."""
        return self.reports.get("status", errors.GOOD) >= errors.BAD_INPUT

    @property
    def is_root(self) -> bool:
        return self.reports.get("rank") == 0


class Job:
    """mpirun with its ranks, from start to end.

    Nothing of it is a file: a job that is killed leaves nothing behind.

    Args:
        command: mpirun and its arguments.
    """

    def __init__(self, command: list[str]) -> None:
        name = f"galinx-{secrets.token_hex(16)}"
        self._server = socket.socket(socket.AF_UNIX)
        self._server.bind(process.address(name))
        self._server.listen(1024)
        self._said = os.memfd_create("mpirun")
        self._ranks: list[_Rank] = []
        self._open: list[_Rank] = []
        #: Why the job ends before its work is done.
        self._cause = ""
        self._deadline: float | None = None
        self._signals = _signals()
        self._mpirun = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=self._said, stderr=self._said,
            env=os.environ | {process.VARIABLE: name},
            start_new_session=True,  # Ctrl-C is for this process to hand on
        )  # fmt: skip

    def run(self) -> int:
        """Wait until all ranks have ended; return the status of the job, whose reason was printed."""
        while self._mpirun.poll() is None:
            self._wait()
        self._deadline = self._deadline or time.monotonic() + _PATIENCE
        while self._open:  # ranks whose mpirun was killed
            self._wait()
        return self._judged()

    def _wait(self) -> None:
        lines = {rank.line: rank for rank in self._open}
        patience = None if self._deadline is None else max(0.0, self._deadline - time.monotonic())
        sources: list[Any] = [self._signals, self._server, *lines]
        ready, _, _ = select.select(sources, [], [], patience)
        if not ready:
            self._kill()
        if self._signals in ready and set(self._signals.read(4096)) & set(process.SIGNALS):
            self._stop("interrupted")
        if self._server in ready:
            self._join(self._server.accept()[0])
        for line in lines.keys() & set(ready):
            self._hear(lines[line])

    def _join(self, line: socket.socket) -> None:
        if _peer(line)[1] == os.getuid():
            self._open.append(_Rank(line))
            self._ranks.append(self._open[-1])
        else:
            line.close()

    def _hear(self, rank: _Rank) -> None:
        alive = rank.listen()
        if rank.has_failed:
            self._end()  # others would wait for it
        elif "interrupted" in rank.reports:
            self._stop("interrupted")
        elif not alive and "status" not in rank.reports:
            name = rank.reports.get("rank", "?")
            self._stop(f"rank {name} or its mpirun was killed (did the machine lack memory?)")
        if not alive:
            self._open.remove(rank)
            if self._cause and rank.is_root:
                self._end()

    def _stop(self, cause: str) -> None:
        """Let rank 0 end in order, and with it all."""
        if not self._cause:
            self._cause = cause
            self._deadline = time.monotonic() + _PATIENCE
            root = [rank for rank in self._open if rank.is_root]
            if root:
                root[0].kill(signal.SIGTERM)
            else:
                self._end()

    def _end(self) -> None:
        """Let mpirun end its ranks."""
        self._deadline = self._deadline or time.monotonic() + _PATIENCE
        if self._mpirun.poll() is None:
            self._mpirun.terminate()

    def _kill(self) -> None:
        self._deadline = None
        for rank in self._open:
            rank.kill(signal.SIGKILL)
        self._mpirun.kill()

    def _judged(self) -> int:
        root = next((rank for rank in self._ranks if rank.is_root), None)
        report = root.reports if root else {}
        failed = [rank.reports for rank in self._ranks if rank.has_failed]
        if "status" not in report:
            process.erase_bar()
        if failed:
            first = report if report in failed else failed[0]
            if first["words"]:  # a reader that went away wants none
                process.complain(plain(first["words"]))
            return first["status"]
        if "status" in report:
            return report["status"]
        if self._ranks or self._cause or self._mpirun.returncode < 0:
            process.complain(
                f"{self._cause or 'mpirun was killed'}; {report.get('left', process.NOTHING)}"
            )
        else:
            sys.stderr.write(os.pread(self._said, _LARGEST, 0).decode(errors="replace"))
            process.complain("mpirun could not start the ranks; its own words are above")
        return errors.FAILURE


def _peer(line: socket.socket) -> tuple[int, int]:
    """Process and user at the other end, as the kernel knows them."""
    process, user, _ = struct.unpack("iII", line.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, 12))
    return process, user


def _signals() -> IO[bytes]:
    """A stream of the numbers of signals as they come, children's ends among them."""
    reader, writer = os.pipe2(os.O_NONBLOCK | os.O_CLOEXEC)
    signal.set_wakeup_fd(writer, warn_on_full_buffer=False)
    for number in (*process.SIGNALS, signal.SIGCHLD):
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, lambda *_: None)
    return open(reader, "rb", buffering=0)


def _shared(argument: str) -> str:
    """Argument under a name by which every rank can read what is open already."""
    match = _OPEN.fullmatch(argument)
    number = int(match[2] or 0) if match else 1
    if number not in (1, 2):
        with suppress(OSError), open(number, "rb", closefd=False) as source:
            if not stat.S_ISREG(os.fstat(number).st_mode):  # which can be read once only
                number = os.memfd_create(argument)
                with open(number, "wb", closefd=False) as copy:
                    copy.write(source.read(_LARGEST))
            return f"/proc/{os.getpid()}/fd/{number}"
    return argument


def main() -> None:
    """Start a job as the command line says, and end with its status."""
    # A job that is killed leaves no mpirun behind.
    tied = ["setpriv", "--pdeathsig", "TERM"] if shutil.which("setpriv") else []
    try:
        begin()
        mpirun, count, python, *arguments = sys.argv[1:]
        galinx = [python, "-P", "-m", "galinx", *map(_shared, arguments)]
        status = Job([*tied, mpirun, "-n", count, *galinx]).run()
    except process.Interrupted:
        process.end_stopped(process.NOTHING)
    except OSError as error:
        refuse(f"cannot start mpirun: {error}")
    sys.exit(status)


if __name__ == "__main__":
    main()
