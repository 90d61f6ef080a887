"""How forms are compiled: for this processor, and cached apart from other processors' code."""

import hashlib
import os
from functools import lru_cache
from pathlib import Path
from typing import Any

#: The kernels are long loops of multiply-adds; full vectorisation makes them three times faster.
_FLAGS = ["-O3", "-march=native"]


@lru_cache(maxsize=1)
def jit_options() -> dict[str, Any]:
    """Options of dolfinx's form compiler.

    Code for one processor may not run on another, and home folders are shared on clusters, so the
    cache is named after what this processor can do.
    """
    home = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return {
        "cffi_extra_compile_args": _FLAGS,
        "cache_dir": str(Path(home) / "galinx" / f"forms-{_processor()}"),
    }


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="ascii", errors="replace").splitlines()
    except OSError:
        lines = []
    abilities = next((line for line in lines if line.startswith(("flags", "Features"))), "unknown")
    return hashlib.sha256(abilities.encode()).hexdigest()[:12]
