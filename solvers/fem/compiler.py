"""How forms are compiled: for this processor, and cached apart from other processors' code."""

import fcntl
import hashlib
import os
import shutil
import sysconfig
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from functools import lru_cache
from pathlib import Path
from typing import Any

from mpi4py import MPI

from galinx.solvers.errors import CompilerError

#: The kernels are long loops of multiply-adds; full vectorisation makes them three times faster.
_FLAGS = ["-O3", "-march=native"]


@contextmanager
def compiling(comm: MPI.Comm) -> Iterator[dict[str, Any]]:
    """Options of dolfinx's form compiler, to be used inside this block by all ranks of ``comm``.

    One process at a time compiles. Where FFCx meets a file that is not compiled, it waits for whoever
    compiles it, also if that was a killed run; whoever is alone here knows that such a file is a ruin.

    Raises:
        CompilerError: the form could not be compiled; the message says why.
    """
    folder = _folder()
    try:
        with _alone(folder) if comm.rank == 0 else nullcontext():
            yield {"cffi_extra_compile_args": _FLAGS, "cache_dir": str(folder)}
    except CompilerError:
        raise
    except Exception as error:
        raise CompilerError(f"compiling a form failed: {_why(error)}") from error


@contextmanager
def _alone(folder: Path) -> Iterator[None]:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        lock = (folder / "lock").open("a", encoding="utf-8")
    except OSError as error:
        raise CompilerError(
            f"the cache of compiled forms {folder} cannot be written ({error.strerror}); "
            "name another folder in the variable XDG_CACHE_HOME"
        ) from error
    with lock:
        fcntl.lockf(lock, fcntl.LOCK_EX)
        for source in folder.glob("*.c"):
            if not source.with_suffix(".c.cached").exists():
                source.unlink()
        yield


def _why(error: Exception) -> str:
    compiler = (sysconfig.get_config_var("CC") or "cc").split()[0]
    if shutil.which(compiler) is None:
        return f"there is no C compiler, expected {compiler}; install gcc and libc6-dev"
    return f"{error}"


def _folder() -> Path:
    """Where compiled forms are kept.

    Code for one processor may not run on another, and home folders are shared on clusters, so the
    folder is named after what this processor can do.
    """
    home = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(home) / "galinx" / f"forms-{_processor()}"


@lru_cache(maxsize=1)
def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="ascii", errors="replace").splitlines()
    except OSError:
        lines = []
    abilities = next((line for line in lines if line.startswith(("flags", "Features"))), "unknown")
    return hashlib.sha256(abilities.encode()).hexdigest()[:12]
