"""What a process does first, before any library is imported that could fail."""

import fcntl
import io
import os
import resource
import secrets
import sys
import warnings
from contextlib import suppress
from typing import Any, NoReturn

from galinx.app import errors
from galinx.app.console.streams import Output
from galinx.app.process import link, stop

#: Bytes of address space that finite elements need with all libraries; with less some wait for ever.
_ADDRESS_SPACE = 10**9


def begin() -> None:
    """Make the process ready: signals, streams, warnings; or end it where it could do nothing."""
    _open_streams()
    stop.listen()
    link.join()
    _prepare_streams()
    if any(option.startswith("error") for option in sys.warnoptions):
        warnings.simplefilter("ignore")  # those of libraries are no errors of the user's
    _check_machine()


def refuse(message: str) -> NoReturn:
    """End with a failure that all ranks share."""
    stop.fail(errors.FAILURE, message)
    sys.exit(errors.FAILURE)


def _open_streams() -> None:
    """What is closed becomes the null device: the next file would get its number, and all output.

    So does an output that is open for reading only: where the error stream is closed, bash hands on its
    script under that number.
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
