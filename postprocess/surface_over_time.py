"""Rules of comparison of motions in time: works and energies, and stresses along the surface.

Works and energies have to balance, and both methods have to give equal works. Along the surface the
stresses of finite elements are compared with those of the integral equation, and with those of a coarser
motion for an estimate of their error.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.contact.edges import from_edge
from galinx.solvers.transient.punch import ON_SURFACE

from .compare import RULES, Rule
from .quantities import over_time as rows
from .quantities.over_time import LEFT, OF_FRICTION, OF_LOAD, RIGHT
from .quantities.quantity import FEM, SIE, Quantity

#: Names of rules.
WORKS, BALANCE = "works over time", "energy over time"

#: Terms of the balance: works and energy that come in, and energies that are held or radiated.
_DONE = OF_LOAD[FEM], OF_FRICTION[FEM], rows.CARRIED
_HELD = rows.STRAIN, rows.KINETIC, rows.RADIATED


def energy_imbalance(data: Mapping[str, Any]) -> NDArray[np.float64]:
    """Work less energy, over the largest work of a motion, (motions, times)."""
    done, held = (sum(data[row.path] for row in kind) for kind in (_DONE, _HELD))
    return np.asarray((done - held) / np.abs(done).max(axis=1, keepdims=True))


def _balance(data: Mapping[str, Any], _: Any) -> float:
    return float(np.abs(energy_imbalance(data)).max())


def _works(data: Mapping[str, Any], _: Any) -> float | None:
    return off_until_turn(data, (OF_LOAD, OF_FRICTION))


def off_until_turn(data: Mapping[str, Any], rows: tuple[dict[str, Quantity], ...]) -> float | None:
    """Largest difference of both methods' histories up to the first turn, over a motion's largest.

    Args:
        data: datasets by path.
        rows: quantities by method whose histories are compared, (motions, times) each.

    Returns:
        Dimensionless difference; None where the integral equation has no solution.
    """
    fem, sie = (np.array([data[row[method].path] for row in rows]) for method in (FEM, SIE))
    solved = np.isfinite(sie).all(axis=(0, 1))
    if not solved.any():
        return None
    off, size = (np.abs(of[..., solved]).max(axis=(0, 2)) for of in (fem - sie, sie))
    return float((off / size).max())


RULES.register(
    WORKS,
    Rule(
        "works of load and friction over time against the integral equation, over the largest",
        tuple(row[method] for row in (OF_LOAD, OF_FRICTION) for method in (FEM, SIE)), _works,
        tolerances=1.0,
    ),
)  # fmt: skip
RULES.register(
    BALANCE,
    Rule(
        "work without its energy over time, over the largest work",
        (*_DONE, *_HELD),
        _balance,
        tolerances=1.0,
    ),
)


#: Distance over a from the edges, where stresses are infinite; stresses further away are compared.
NEAR = 0.01
#: Stresses that are compared; the shear stress is proportional to the pressure.
COMPARED = rows.SURFACE_IN_PLANE, rows.SURFACE_PRESSURE


def largest_change(stresses: Any, expected: Any) -> float:
    """Largest difference of stresses along the surface, over a motion's largest, dimensionless.

    Args:
        stresses, expected: σ_XX and σ_YY by two methods, (motions, times, places) each.
    """
    far = from_edge(ON_SURFACE) > NEAR
    off, size = (
        np.abs(of[..., far]).max(axis=(-2, -1))
        for of in (np.subtract(stresses, expected), np.asarray(expected))
    )
    return float((off / size).max())


def estimated(before: Mapping[str, NDArray], now: Mapping[str, NDArray]) -> dict[str, NDArray]:
    """Estimated error of a motion's stresses from two successive solutions, by path.

    Args:
        before, now: datasets by path of the coarser and of the finer solution.

    Returns:
        A dataset by path, relative to the largest stress; empty where a solution has no stresses.
    """
    of_both = [
        [of[row[FEM].path] for row in COMPARED] for of in (before, now) if COMPARED[0][FEM].path in of
    ]
    return {rows.SURFACE_ESTIMATE.path: np.array(largest_change(*of_both))} if len(of_both) == 2 else {}


def stress_datasets(method: str, stresses: NDArray) -> dict[str, NDArray]:
    """Datasets by path of a method's σ_XX, σ_YY and σ_XY over N/(2a), (3, times, places)."""
    return dict(
        zip(
            (
                row[method].path
                for row in (rows.SURFACE_IN_PLANE, rows.SURFACE_PRESSURE, rows.SURFACE_SHEAR)
            ),
            stresses,
        )
    )


def place_datasets(t: NDArray) -> dict[str, NDArray]:
    """Datasets by path of the times t over a/c_s, (times,), and places of stresses along the surface."""
    return {rows.SURFACE_TIMES.path: t, rows.SURFACE_PLACES.path: ON_SURFACE}


def _both(data: Mapping[str, Any], _: Any) -> float | None:
    """Largest difference of both methods up to the first turn; None without output before it."""
    solved = np.isfinite(data[COMPARED[0][SIE].path]).all(axis=(0, 2))
    if not solved.any():
        return None
    return largest_change(
        *([data[row[method].path][:, solved] for row in COMPARED] for method in (FEM, SIE))
    )


def _estimate(data: Mapping[str, Any], _: Any) -> float:
    return float(data[rows.SURFACE_ESTIMATE.path].max())


def _beside(data: Mapping[str, Any], _: Any) -> float | None:
    """Largest difference of both methods' σ_XX beside the ends, over the largest at either end."""
    return off_until_turn(data, ENDS)


#: Names of rules: for the surface by both methods, for finite elements, and for places beside both ends.
ALONG, OF_FEM, AT_ENDS = "surface over time", "estimate on the surface over time", "ends over time"
#: σ_XX beside both ends; its difference is reported, not judged: waves ahead of a fast punch are short.
ENDS = LEFT, RIGHT

RULES.register(
    ALONG,
    Rule(
        "σ_XX and σ_YY along the surface over time against the integral equation, over the largest "
        "further than 0.01 a from the edges",
        tuple(row[method] for row in COMPARED for method in (FEM, SIE)), _both, tolerances=1.0,
    ),
)  # fmt: skip
RULES.register(
    OF_FEM,
    Rule(
        "estimated error of σ_XX and σ_YY along the surface over time, over the largest further than "
        "0.01 a from the edges", (rows.SURFACE_ESTIMATE,), _estimate, tolerances=1.0,
    ),
)  # fmt: skip
RULES.register(
    AT_ENDS,
    Rule(
        "σ_XX 0.05 a beside both ends over time against the integral equation, over the largest",
        tuple(row[method] for row in ENDS for method in (FEM, SIE)), _beside,
    ),
)  # fmt: skip
