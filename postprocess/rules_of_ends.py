"""How far finite elements agree with other methods about contacts whose ends are found."""

from collections.abc import Callable
from typing import Any

import numpy as np

from galinx.postprocess.quantities import states as of
from galinx.postprocess.quantities import strata as on_layers
from galinx.postprocess.quantities import stresses as at
from galinx.postprocess.quantities.quantity import CLOSED_FORM, FEM, SIE
from galinx.postprocess.rule import Rule


def _ends(other: str) -> Callable[[dict[str, Any], Any], float]:
    def measure(data: dict[str, Any], _: Any) -> float:
        size = data[of.HALF_WIDTH[other].path]
        off = [data[row[FEM].path] - data[row[other].path] for row in (of.HALF_WIDTH, of.CENTRE)]
        return float((np.abs(off) / size).max())

    return measure


def _largest_pressure(other: str) -> Callable[[dict[str, Any], Any], float | None]:
    def measure(data: dict[str, Any], _: Any) -> float | None:
        fem, exact = (data[of.LARGEST[method].path] for method in (FEM, other))
        off = np.abs(fem / exact - 1.0)
        return float(np.nanmax(off)) if np.isfinite(off).any() else None  # NaN: it is infinite

    return measure


def extremes_of(other: str) -> Callable[[dict[str, Any], Any], float]:
    """The measure of highest and lowest in-plane stresses, against another method."""

    def measure(data: dict[str, Any], _: Any) -> float:
        rows = (at.HIGHEST, at.LOWEST) if other == CLOSED_FORM else (on_layers.HIGHEST, on_layers.LOWEST)
        exact = np.array([data[row[other].path] for row in rows])
        fem = np.array([data[row[FEM].path] for row in (at.HIGHEST, at.LOWEST)])
        return float((np.abs(fem - exact) / np.abs(exact).max(axis=0)).max())

    return measure


def _rules(other: str, name: str, against: str) -> dict[str, Rule]:
    def of_both(*rows: dict[str, Any]) -> tuple[Any, ...]:
        return tuple(row[method] for row in rows for method in (other, FEM))

    return {
        f"ends{name}": Rule(
            f"ends of the contact{against}, over its half-width", of_both(of.HALF_WIDTH, of.CENTRE),
            _ends(other), tolerances=1.0,
        ),
        f"largest pressure{name}": Rule(
            f"largest contact pressure{against}, relative", of_both(of.LARGEST),
            _largest_pressure(other), tolerances=1.0,
        ),
    }  # fmt: skip


#: Rules by the name that quantities give.
OF_ENDS: dict[str, Rule] = {
    **_rules(CLOSED_FORM, "", ""),
    **_rules(SIE, " over layers", " against the integral equation"),
}
