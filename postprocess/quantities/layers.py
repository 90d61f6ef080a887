"""Quantities at the interfaces of layered half-planes."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.contact import AT_INTERFACES
from galinx.solvers.parameters import Range

from .quantity import (
    ALONG,
    CONTACT,
    FEM,
    INTERFACE,
    OVER_A,
    QUANTITIES,
    SIE,
    STATE,
    X_OVER_A,
    Quantity,
    entry,
)
from .stresses import estimate

INTERFACE_DEPTH = Quantity(
    "interfaces/depth_over_a", "1", "depths of the interfaces over the half-width", (INTERFACE,),
    asked_by=AT_INTERFACES, range=Range(above=0.0), scale=OVER_A,
)  # fmt: skip
#: With free ends every state has its own half-width.
INTERFACE_DEPTH_IN_M = Quantity(
    "interfaces/depth", "m", "depths of the interfaces, where contacts have free ends", (INTERFACE,),
    asked_by=AT_INTERFACES, range=Range(above=0.0), scale=CONTACT,
)  # fmt: skip
#: Depths of interfaces by their unit.
DEPTHS = {row.unit: row for row in (INTERFACE_DEPTH, INTERFACE_DEPTH_IN_M)}
ALONG_X = Quantity(
    "interfaces/X_over_a", "1", "positions along interfaces over the half-width", (ALONG,),
    asked_by=AT_INTERFACES, scale=X_OVER_A,
)  # fmt: skip

_PARTS = {
    "sigma_YY": "normal traction at",
    "sigma_XY": "shear traction at",
    "sigma_XX_above": "in-plane stress above",
    "sigma_XX_below": "in-plane stress below",
}


def _extreme(
    method: str, i: int, name: str, what: str, which_end: tuple[str, str, int]
) -> tuple[Quantity, Quantity]:
    """Quantities of the largest or the smallest value along each interface, and of its place."""

    end, word, number = which_end

    def read(s: Any, part: int) -> Any:
        return s.extremes_at_interfaces[number, part, i]

    path, over = f"interfaces/{method}/{name}_{end}", (STATE, INTERFACE)
    about = f"{word} {what} each interface"
    return (
        Quantity(path, "N/(2a)", about, over, lambda s, _: read(s, 0), method, asked_by=AT_INTERFACES),
        Quantity(
            f"{path}_X_over_a", "1", f"place of the {about}, over the half-width", over,
            lambda s, _: read(s, 1), method, asked_by=AT_INTERFACES, scale=X_OVER_A,
        ),
    )  # fmt: skip


#: σ_YY, σ_XY, σ_XX above and below, by method.
INTERFACES = {
    method: tuple(
        Quantity(
            f"interfaces/{method}/{name}", "N/(2a)", f"{what} each interface", (STATE, INTERFACE, ALONG),
            entry(lambda s: s.interfaces, i), method, asked_by=AT_INTERFACES,
        )
        for i, (name, what) in enumerate(_PARTS.items())
    )
    for method in (SIE, FEM)
}  # fmt: skip
#: Extremes of the stresses at interfaces, by method.
INTERFACE_EXTREMES = {
    method: tuple(
        row
        for i, part in enumerate(_PARTS.items())
        for end in (("max", "largest", 0), ("min", "smallest", 1))
        for row in _extreme(method, i, *part, end)
    )
    for method in (SIE, FEM)
}


def largest_shear(data: Mapping[str, Any], method: str) -> tuple[NDArray, NDArray]:
    """Largest |σ_XY| along interfaces over N/(2a), and its place over a, (states, interfaces) each."""
    high, high_X, low, low_X = (data[row.path] for row in INTERFACE_EXTREMES[method][4:8])
    lower = np.abs(low) > np.abs(high) * (1.0 + 1e-6)  # of two that are as large always the same one
    return np.maximum(np.abs(high), np.abs(low)), np.where(lower, low_X, high_X)


_ALONG = "stresses at interfaces over the largest along each, layered half-plane"
#: Estimates of stresses at interfaces, by method.
ESTIMATE_AT_INTERFACES = estimate(
    AT_INTERFACES, "interfaces",
    **dict.fromkeys((SIE, FEM), _ALONG),
)  # fmt: skip

QUANTITIES.add_all(globals())
