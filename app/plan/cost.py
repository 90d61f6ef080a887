"""Cost of a run in time, memory and size of the archive, by laws fitted to measured runs.

See docs/benchmarks.md.

Seconds are those of one core of some 3 GHz. They tell a minute from an hour, and compare no machines.
"""

from math import log2
from pathlib import Path

#: Seconds until a scene with finite elements meets its mesh: imports and start-up; and of one without.
START = 1.2
START_WITHOUT_FEM = 0.4
#: Seconds of a state with finite elements: friction, closed form, recovery, archive.
STATE = 1e-4
#: Seconds without finite elements: a stroke along which a law is followed, a quantity at a speed, a
#: state, and each of its archived numbers.
_STROKE, _QUANTITY, _STATE, _NUMBER = 3e-5, 2.5e-5, 2.2e-6, 1.3e-7
#: Seconds of a stroke along which a law is integrated, and of a loop of some three strokes.
_INTEGRATED, _LOOP = 3e-2, 0.25
#: Seconds of a point inside: to find its cell, gradients of a state there, potentials of a state; with a
#: prescribed pressure gradients and potentials of each of its pieces.
_LOCATED, _GRADIENT, _POTENTIAL = 2.6e-6, 1.3e-6, 7.5e-7
_GRADIENTS_OF_PIECE, _POTENTIAL_OF_PIECE = 4e-6, 9e-7
#: Seconds of a contact over layers that has an equation of its own: of a tilted punch, of one with kinks;
#: of both over a layer that is graded from the surface on.
_TILTED, _KINKED, _TILTED_ON_GRADED, _KINKED_ON_GRADED = 0.15, 1.4, 8.0, 25.0
#: Bytes of a number of the states that are computed together, and of a number in an archive.
_HELD, _ARCHIVED = 18, 8
#: Bytes of an archive without results, and of a dataset without numbers.
_EMPTY, _DATASET = 7e4, 1.5e3
#: Bytes of a program without finite elements, and of a state's friction.
_PROGRAM, _FRICTION = 130e6, 300.0
#: Bytes of the libraries, and numbers of element matrices that are computed at once.
_LIBRARIES, _AT_ONCE = 170e6, 2e6
#: Solves of a level by conjugate gradients, each field solved and refined, and steps of each.
_SOLVES, _STEPS = 34, 25


def seconds_to_integrate(strokes: int, loops: int) -> float:
    """Seconds to integrate friction laws that have no formula, along strokes and for archived loops."""
    return _INTEGRATED * strokes + _LOOP * loops


def seconds_of_states(strokes: int, speeds: int, states: int, quantities: int, numbers: int) -> float:
    """Seconds without finite elements: friction along strokes, quantities by speed, numbers by state."""
    return _STROKE * strokes + _QUANTITY * speeds * quantities + states * (_STATE + _NUMBER * numbers)


def seconds_inside(points: int, speeds: int, states: int, pieces: int, fem: bool, exact: bool) -> float:
    """Seconds to compute stresses at points inside.

    Args:
        points: number of points.
        speeds, states: numbers of speeds and of states.
        pieces: number of pieces of a prescribed pressure, 0 for a punch.
        fem: True where finite elements compute them.
        exact: True where they are computed in closed form.
    """
    by_fem = speeds * _GRADIENTS_OF_PIECE * pieces if pieces else speeds * _LOCATED + states * _GRADIENT
    in_closed_form = states * (_POTENTIAL_OF_PIECE * pieces if pieces else _POTENTIAL)
    return points * (by_fem * fem + in_closed_form * exact)


def seconds_of_equations(states: int, kinked: bool, graded: bool) -> float:
    """Seconds of contacts over layers each of which has an integral equation of its own.

    Args:
        states: number of contacts.
        kinked: True for a punch with kinks, False for a tilted one.
        graded: True where the solid is graded from the surface on.
    """
    if graded:
        return states * (_KINKED_ON_GRADED if kinked else _TILTED_ON_GRADED)
    return states * (_KINKED if kinked else _TILTED)


def seconds_to_archive(numbers: int) -> float:
    """Seconds to check, write, read back and seal numbers of an archive."""
    return _NUMBER * numbers


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


def seconds_of_level(cells: int, degree: int, unknowns: int, direct: bool) -> float:
    """Seconds of one degree at one speed: element matrices, and either a factor or multigrid."""
    matrices = cells * (8.0e-8 * degree**3.9 + 6.6e-6 * degree**1.6)
    if direct:
        return matrices + 3.5e-7 * unknowns**1.25
    return matrices + unknowns * (2.4e-6 + _SOLVES * _STEPS * 1.6e-7)


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
