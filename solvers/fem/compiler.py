"""How what dolfinx compiles of a form, its elements, is compiled and kept.

FFCx compiles into a folder of this run's own. When all is well the folder gets a digest and, by being
renamed, the place where every run looks for the form. So nobody meets what a killed run left, nobody has
to wait for what is there, and what was damaged since is known before it is loaded: that could end the
program or change its numbers.
"""

import fcntl
import hashlib
import os
import re
import secrets
import shutil
import socket
import sysconfig
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext, suppress
from pathlib import Path
from typing import IO, Any

import dolfinx
import ffcx
from mpi4py import MPI

from galinx import files
from galinx.solvers.errors import CompilerError

#: Seconds until it is said that another run is waited for, and until it no longer is.
_SAID, _PATIENCE = 10.0, 60.0
#: Seconds after which what is no finished form is a ruin.
_DAY = 86400.0
#: The file with the digest of all others in its folder.
_DIGEST = "digest"


@contextmanager
def compiling(
    comm: MPI.Comm, what: str, say: Callable[[str], None] = lambda _: None
) -> Iterator[dict[str, Any]]:
    """Options of dolfinx's form compiler, to be used inside this block by all ranks of ``comm``.

    Args:
        comm: the ranks; collective.
        what: everything that the compiled code depends on but compiler and processor.
        say: is told on rank 0 what the user should know.

    Raises:
        CompilerError: the form could not be compiled; the message says why.
    """
    try:
        with _folder(what, say) if comm.rank == 0 else nullcontext() as folder:
            yield {"cache_dir": comm.bcast(folder)}
            comm.barrier()  # the folder is renamed when all ranks have loaded what is in it
    except CompilerError:
        raise
    except Exception as error:
        raise CompilerError(f"compiling a form failed: {_why(error)}") from error


@contextmanager
def _folder(what: str, say: Callable[[str], None]) -> Iterator[str]:
    """Where a form is kept, or else where it is to be compiled; then it is kept."""
    kept = _cache() / _key(what)
    if not _is_whole(kept):
        with _turn(kept, say):
            if not _is_whole(kept):
                if os.path.lexists(kept):
                    say(f"the compiled form in {kept} is damaged; it is compiled again")
                own = kept.with_suffix(f".{secrets.token_hex(4)}")
                with _writing(own):
                    own.mkdir()
                try:
                    yield str(own)
                    _keep(own, kept)
                finally:
                    _remove(own)
                return
    yield str(kept)


def _key(what: str) -> str:
    """Of a form: a hash of everything that its code depends on."""
    python = [sysconfig.get_config_var(name) for name in ("SOABI", "CFLAGS")]
    told = repr([what, ffcx.__version__, dolfinx.__version__, *python])
    return hashlib.sha256(told.encode()).hexdigest()[:24]


def _is_whole(kept: Path) -> bool:
    """Is a form there, as it was compiled?"""
    try:
        return files.read(kept / _DIGEST, 100) == _digest(kept, kept.name)
    except OSError:
        return False


def _digest(folder: Path, name: str) -> bytes:
    """Of all that is in a folder, and of the name that it has or will have."""
    digest = hashlib.sha256(name.encode())
    for path in sorted(folder.iterdir()):
        if path.name != _DIGEST:
            content = hashlib.sha256(files.read(path)).hexdigest()
            digest.update(f"{path.name} {content} ".encode(errors="surrogateescape"))
    return digest.hexdigest().encode()


def _keep(own: Path, kept: Path) -> None:
    """Give a compiled form the place where it is looked for; a file system that refuses is no fault."""
    with suppress(OSError):
        for path in own.glob("*.[co]"):
            path.write_bytes(b"")  # FFCx asks whether there is a source, nobody reads it
        files.write(own / _DIGEST, _digest(own, kept.name))
        for path in own.iterdir():
            files.synchronise(path)
        if not _is_whole(kept):  # there may be another's by now
            _remove(kept)
            own.rename(kept)
            files.synchronise(kept.parent)


@contextmanager
def _turn(kept: Path, say: Callable[[str], None]) -> Iterator[None]:
    """For a block that compiles. Other runs that want the form wait, not for long: it only saves work."""
    with _writing(kept):
        kept.parent.mkdir(parents=True, exist_ok=True)
        handle = files.open_file(kept.with_suffix(".lock"), os.O_RDWR | os.O_CREAT)
    with open(handle, "r+", encoding="utf-8", errors="replace") as lock:
        started, said = time.monotonic(), False
        while not _taken(lock) and not _is_whole(kept):
            waited = time.monotonic() - started
            if waited > _PATIENCE:
                break
            if waited > _SAID and not said:
                said = True
                say(
                    f"{lock.read(100)} compiles the same form for {waited:.0f} s already, or is stopped; "
                    f"after {_PATIENCE:.0f} s it is no longer waited for"
                )
            time.sleep(0.1)
        _sweep(kept.parent)
        yield


def _taken(lock: IO[str]) -> bool:
    """Is the lock this process's? It then says so; where there are no locks everybody has them."""
    with suppress(OSError):
        try:
            fcntl.lockf(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except (BlockingIOError, PermissionError):
            return False
        lock.seek(0)
        lock.truncate()
        lock.write(f"process {os.getpid()} on {socket.gethostname()}")
        lock.flush()
    return True


def _sweep(cache: Path) -> None:
    """Remove what killed runs left, and earlier versions of the program."""
    for path in cache.iterdir():
        with suppress(OSError):
            old = time.time() - path.stat().st_mtime > _DAY
            if old and not re.fullmatch("[0-9a-f]{24}", path.name):
                _remove(path)


def _remove(path: Path) -> None:
    with suppress(OSError):
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink()


@contextmanager
def _writing(path: Path) -> Iterator[None]:
    """For a block that writes in the cache: says what to do where that is refused."""
    try:
        yield
    except OSError as error:
        raise CompilerError(
            f"the cache of compiled forms {path.parent} cannot be written ({error.strerror}); "
            "name another folder in the variable XDG_CACHE_HOME"
        ) from error


def _why(error: Exception) -> str:
    compiler = (sysconfig.get_config_var("CC") or "cc").split()[0]
    if shutil.which(compiler) is None:
        return f"there is no C compiler, expected {compiler}; install gcc and libc6-dev"
    return f"{error}"


def _cache() -> Path:
    """Where compiled forms are kept."""
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "galinx" / "forms"
