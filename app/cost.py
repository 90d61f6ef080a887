"""What a run will cost, by laws fitted to measured runs; see docs/benchmarks.md.

Seconds of one core of some 3 GHz. They serve to tell a minute from an hour, not to compare machines.
"""

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


def seconds_of_speed(cells: int, degree: int) -> float:
    """Wall seconds of a speed: the three degrees that results and their error need."""
    return sum(seconds_of_level(cells, p) for p in range(degree - 2, degree + 1))


def bytes_of(cells: int, unknowns: int, degree: int, chunk_numbers: int) -> float:
    """Largest resident set of a rank."""
    dense = 3 * 8 * min(cells, _AT_ONCE) * (2 * (degree + 1) ** 2) ** 2
    return _LIBRARIES + _UNKNOWN * unknowns + dense + 3 * 8 * chunk_numbers
