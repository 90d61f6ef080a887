"""Stresses along the surface over time: what is told of them, and how well."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.compare import RULES, Rule
from galinx.postprocess.energy_over_time import off_until_turn
from galinx.postprocess.quantities import surface_over_time as rows
from galinx.postprocess.quantities.quantity import FEM, SIE
from galinx.postprocess.quantities.work_over_time import LEFT, RIGHT
from galinx.solvers.contact import from_edge
from galinx.solvers.transient.punch import ON_SURFACE

#: Distance over a from the edges, where stresses are infinite, further than which they are compared.
NEAR = 0.01
#: What is compared; friction's stress is the pressure's by a factor.
TOLD = rows.IN_PLANE, rows.PRESSURE


def largest_change(found: Any, expected: Any) -> float:
    """How far stresses along the surface are apart, over the largest of each of a motion.

    Args:
        found, expected: of σ_XX and σ_YY, (motions, times, places) each.
    """
    far = from_edge(ON_SURFACE) > NEAR
    off, size = (
        np.abs(of[..., far]).max(axis=(-2, -1))
        for of in (np.subtract(found, expected), np.asarray(expected))
    )
    return float((off / size).max())


def estimated(before: Mapping[str, NDArray], now: Mapping[str, NDArray]) -> dict[str, NDArray]:
    """The estimated error of a motion that two solutions tell, none where they tell no stresses."""
    of_both = [[of[row[FEM].path] for row in TOLD] for of in (before, now) if TOLD[0][FEM].path in of]
    return {rows.ESTIMATE.path: np.array(largest_change(*of_both))} if len(of_both) == 2 else {}


def named(method: str, stresses: NDArray) -> dict[str, NDArray]:
    """Datasets of a method's σ_XX, σ_YY and σ_XY, (3, times, places)."""
    return dict(zip((row[method].path for row in (rows.IN_PLANE, rows.PRESSURE, rows.SHEAR)), stresses))


def where(t: NDArray) -> dict[str, NDArray]:
    """Datasets of the times and places at which they are told."""
    return {rows.TIMES.path: t, rows.PLACES.path: ON_SURFACE}


def _both(data: Mapping[str, Any], _: Any) -> float | None:
    """Up to the first turn; None where the surface is not looked at before it."""
    known = np.isfinite(data[TOLD[0][SIE].path]).all(axis=(0, 2))
    if not known.any():
        return None
    return largest_change(*([data[row[method].path][:, known] for row in TOLD] for method in (FEM, SIE)))


def _estimate(data: Mapping[str, Any], _: Any) -> float:
    return float(data[rows.ESTIMATE.path].max())


def _beside(data: Mapping[str, Any], _: Any) -> float | None:
    """Over the largest at either end."""
    return off_until_turn(data, ENDS)


#: Rules by name: of the surface by both methods, and by finite elements; of what is beside both ends.
ALONG, OF_FEM, AT_ENDS = "surface over time", "estimate on the surface over time", "ends over time"
#: σ_XX beside both ends, which is told and not judged: waves ahead of a fast punch are short.
ENDS = LEFT, RIGHT

RULES.register(
    ALONG,
    Rule(
        "σ_XX and σ_YY along the surface over time against the integral equation, over the largest "
        "further than 0.01 a from the edges",
        tuple(row[method] for row in TOLD for method in (FEM, SIE)), _both, tolerances=1.0,
    ),
)  # fmt: skip
RULES.register(
    OF_FEM,
    Rule(
        "estimated error of σ_XX and σ_YY along the surface over time, over the largest further than "
        "0.01 a from the edges", (rows.ESTIMATE,), _estimate, tolerances=1.0,
    ),
)  # fmt: skip
RULES.register(
    AT_ENDS,
    Rule(
        "σ_XX 0.05 a beside both ends over time against the integral equation, over the largest",
        tuple(row[method] for row in ENDS for method in (FEM, SIE)), _beside,
    ),
)  # fmt: skip
