"""How fine a mesh has to be for a wanted accuracy; the rule was measured, see docs/verification.md."""

from math import ceil, exp, log, log10, pi, sqrt

from galinx.meshes.halfplane import BOX_DEPTH
from galinx.meshes.rings import Refinement

#: Ratio of ring sizes in the (ξ, η) plane by mesh. Straight cells in the physical plane need gentler
#: rings: a ratio t there is t² in distance.
_RATIO = {"confocal": 0.35, "graded": 0.5, "box": 0.5, "uniform": 0.5}
#: Largest width in ξ of a column outside the rings.
_COLUMN = {"confocal": 3.0, "graded": 1.0, "box": 0.7, "uniform": pi / 4.0}

#: Lowest and highest polynomial degree used.
DEGREES = (4, 12)


def refinement(mesh: str, tolerance: float, β_s: float) -> Refinement:
    """Refinement that reaches ``tolerance`` with :func:`degree`.

    Args:
        mesh: name of the mesh.
        tolerance: wanted relative accuracy of K_I and of the pressure's moments.
        β_s: √(1 - c²) at the highest speed; the field turns within an angle of that size.
    """
    # The energy in a ring falls with its size squared.
    innermost = (_of_cells(mesh, tolerance) / 3.0) ** 0.5
    levels = ceil(log(pi / 2.0 / innermost) / -log(_RATIO[mesh]))
    reach = outer_ξ(mesh, tolerance) - pi / 2.0
    # The column next to the rings is narrow: the field still turns there.
    first = min(_COLUMN[mesh], 1.0)
    count = ceil((reach - first) / _COLUMN[mesh])
    sectors = 2 if β_s > 0.5 else 3
    if mesh == "box":
        sectors = 2  # an even number puts a vertex into the block's corners
    columns = (first, *((reach - first) / count,) * count)
    if mesh == "uniform":  # squares all over the rectangle; the degree or cuts do the rest
        levels, columns = 0, (reach / (count + 1),) * (count + 1)
    return Refinement(levels, _RATIO[mesh], sectors, columns)


def degree(mesh: str, tolerance: float, rayleigh: float) -> int:
    """Polynomial degree that should reach ``tolerance``; the measured error may ask for more.

    Args:
        mesh: name of the mesh.
        tolerance: wanted relative accuracy.
        rayleigh: Rayleigh function over its value at rest, in (0, 1]; errors grow as it falls.
    """
    digits = -log10(_of_cells(mesh, tolerance))
    lost = -log10(rayleigh)
    wanted = ceil(3.4 - 0.4 * lost + (0.7 + 0.23 * lost) * digits)
    return min(max(wanted, DEGREES[0]), DEGREES[1])


def outer_ξ(mesh: str, tolerance: float) -> float:
    """Elliptic coordinate of the far boundary; its radius is a e^ξ/2."""
    if mesh == "box":
        return log(2.0 * BOX_DEPTH)
    # Truncation at radius R costs about a/R in K_I; a hundredth of the tolerance is left to it.
    return log(2.0 * 100.0 / tolerance)


def reach(mesh: str, tolerance: float) -> float:
    """Distance of the far boundary over a, the least where it is no circle."""
    return exp(outer_ξ(mesh, tolerance)) / 2.0


def truncation(mesh: str, tolerance: float, rayleigh: float = 1.0) -> float:
    """Estimated relative error of K_I from the finite outer radius R, times σ_XY/σ_YY.

    a/R at rest; it was seen to grow as the root of the Rayleigh function over its value at rest falls.
    """
    return 1.0 / (reach(mesh, tolerance) * sqrt(rayleigh))


def _of_cells(mesh: str, tolerance: float) -> float:
    """What the cells have to reach: beside the box's walls, which set its error, nothing more."""
    return min(tolerance, truncation(mesh, tolerance) / 1000.0) if mesh == "box" else tolerance
