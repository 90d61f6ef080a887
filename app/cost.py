"""What a run will cost, by laws fitted to measured runs; see docs/benchmarks.md.

Seconds of one core of some 3 GHz. They serve to tell a minute from an hour, not to compare machines.
"""

from pathlib import Path

#: Seconds until a scene with finite elements meets its mesh: imports and start-up; and of one without.
START = 1.2
START_WITHOUT_FEM = 0.4
#: Seconds of a state: friction, closed form, recovery, archive.
STATE = 1e-4
#: Bytes of the libraries, of an unknown in three levels, and cells that are condensed at once.
_LIBRARIES, _UNKNOWN, _AT_ONCE = 170e6, 1300.0, 64


def seconds_of_level(cells: int, degree: int) -> float:
    """Wall seconds of one degree at one speed: element matrices, factorisation, Krylov space."""
    return cells * (2.0e-7 * degree**3.9 + 6.6e-6 * degree**1.6)


def bytes_of_factors(unknowns: int) -> float:
    """Memory of the factors of three levels on all ranks together."""
    return _UNKNOWN * unknowns


def free_memory() -> float:
    """Memory [B] of this machine that programs can have now."""
    try:
        text = Path("/proc/meminfo").read_text(encoding="ascii")
    except OSError:  # not on Linux: ask for no more than any machine has
        return 2e9
    return 1024.0 * float(text.split("MemAvailable:")[1].split()[0])


def bytes_of(cells: int, unknowns: int, degree: int, chunk_numbers: int) -> float:
    """Largest resident set of a rank."""
    dense = 3 * 8 * min(cells, _AT_ONCE) * (2 * (degree + 1) ** 2) ** 2
    return _LIBRARIES + _UNKNOWN * unknowns + dense + 3 * 8 * chunk_numbers
