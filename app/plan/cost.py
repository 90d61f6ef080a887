"""Cost of a run in memory and size of the archive, by laws fitted to measured runs.

See docs/benchmarks.md. How long a run takes depends on the machine: its progress bar says that.
"""

from math import log2
from pathlib import Path

#: Bytes of a number of the states that are computed together, and of a number in an archive.
_HELD, _ARCHIVED = 18, 8
#: Bytes of an archive without results, and of a dataset without numbers.
_EMPTY, _DATASET = 7e4, 1.5e3
#: Bytes of a program without finite elements, and of a state's friction.
_PROGRAM, _FRICTION = 130e6, 300.0
#: Bytes of the libraries, and numbers of element matrices that are computed at once.
_LIBRARIES, _AT_ONCE = 170e6, 2e6


def bytes_of_chunk(numbers: int) -> float:
    """Memory [B] of the numbers of the states that are computed together."""
    return _HELD * numbers


def bytes_archived(numbers: int, datasets: int) -> float:
    """Size [B] of an archive of that many numbers and of datasets beside those of every archive."""
    return _EMPTY + _DATASET * datasets + _ARCHIVED * numbers


def bytes_of_states(states: int) -> float:
    """Memory [B] of the friction of all states, which is held at once."""
    return _FRICTION * states


def bytes_without_fem(states: int, chunk_numbers: int) -> float:
    """Largest resident set [B] of a run without finite elements."""
    return _PROGRAM + bytes_of_states(states) + bytes_of_chunk(chunk_numbers)


def bytes_of_levels(unknowns: float, direct: bool) -> float:
    """Memory [B] of matrices, a factor or multigrid, and fields, on all ranks together.

    Measured at degree 2 with that many unknowns on the finest level; a fourth less at degree 8.
    """
    return unknowns * (980.0 + 48.0 * log2(max(unknowns, 2)) if direct else 1400.0)


def free_memory() -> float:
    """Free memory [B] of this machine."""
    try:
        text = Path("/proc/meminfo").read_text(encoding="ascii")
    except OSError:  # not on Linux: ask for no more than any machine has
        return 2e9
    return 1024.0 * float(text.split("MemAvailable:")[1].split()[0])


def bytes_of(unknowns: float, degree: int, direct: bool, chunk_numbers: int) -> float:
    """Largest resident set [B] of a rank that has that many unknowns."""
    dense = 3 * 8 * max(_AT_ONCE, 16 * (2 * (degree + 1) ** 2) ** 2)
    return _LIBRARIES + bytes_of_levels(unknowns, direct) + dense + bytes_of_chunk(chunk_numbers)
