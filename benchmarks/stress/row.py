"""One row of the matrix, and the scenes that rows are made of."""

from dataclasses import dataclass
from typing import Any

from numpy.typing import NDArray

from galinx.app.run.flow import Memory, compute
from galinx.app.scene.read import parse

_SCENE = """
solid = {{E = {E!r}, nu = {nu!r}, rho = 7860.0, plane = "{plane}"}}
punch = {{half_width = {half_width!r}, load = {load!r}}}
friction = {{mu_c = {mu_c!r}, sigma0_over_load = {stiffness!r}, pre_sliding = {pre_sliding!r}}}
motion = {{c = {c!r}, strokes = {strokes}, X_over_L = {X_over_L!r}}}
solve = {{methods = {methods}, tolerance = {tolerance!r}, mesh = "{mesh}"{fixed}}}
output = {{quantities = {quantities}, points = {points}}}
"""

_DEFAULTS: dict[str, Any] = {
    "E": 193e9, "nu": 0.25, "plane": "strain", "half_width": 1e-3, "load": 55.3e3, "mu_c": 0.7,
    "stiffness": 25000.0, "pre_sliding": 1e-4, "c": [0.6], "strokes": '["forward", "backward"]',
    "X_over_L": [0.8], "methods": '["closed_form", "fem"]', "tolerance": 1e-6, "mesh": "confocal",
    "fixed": "", "quantities": '["sif", "surface"]', "points": [],
}  # fmt: skip


@dataclass(frozen=True)
class Verdict:
    """A statement with its figures, and whether it holds."""

    text: str
    holds: bool


@dataclass(frozen=True)
class Row:
    """One extreme parameter.

    Attributes:
        name: as in file names.
        title: what is varied, and what is kept.
        x_label, x: the parameter, with its unit.
        y_label, lines: what was found by its label, dimensionless, each (len(x),).
        verdicts: what is claimed.
        log_x: a logarithmic axis for the parameter.
    """

    name: str
    title: str
    x_label: str
    x: NDArray
    y_label: str
    lines: dict[str, NDArray]
    verdicts: tuple[Verdict, ...]
    log_x: bool = True


def scene(**changes: Any) -> str:
    """Text of a scene; numbers are in SI.

    Raises:
        KeyError: a change is none of the scene's parameters.
    """
    if unknown := changes.keys() - _DEFAULTS.keys():
        raise KeyError(f"{unknown}")
    return _SCENE.format(**(_DEFAULTS | changes))


def solved(**changes: Any) -> Memory:
    """Datasets of a scene."""
    data = Memory()
    compute(parse(scene(**changes)), data)
    return data


def honest(true: NDArray, estimate: NDArray) -> Verdict:
    """Is the true error never more than the estimate?"""
    worst = float((true / estimate).max())
    return Verdict(f"true error at most {worst:.2f} of its estimate, allowed 1", worst <= 1.0)


def reached(true: NDArray, tolerance: float, where: str) -> Verdict:
    """Is the true error within the tolerance?"""
    worst = float(true.max())
    return Verdict(
        f"{where}: true error of K_I at most {worst:.1e}, allowed {tolerance:g}", worst <= tolerance
    )
