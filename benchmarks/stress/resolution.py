"""Extremes of the mesh, on the discretisation itself."""

from dataclasses import replace

import numpy as np
from mpi4py import MPI
from row import Row, Verdict

from galinx.meshes import MESHES
from galinx.meshes.rings import Refinement
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.contact.recovery import chebyshev, from_moments
from galinx.solvers.fem.punch import SlidingPunch
from galinx.solvers.fem.space import Space, distribute
from galinx.solvers.solids.isotropic import MovingFrame

_RATIO = 0.35
#: That the far boundary follows.
_MOMENTS = 8
#: Rounding may add this to an error, relative.
_ROUNDING = 1e-8


def _errors(levels: int, outer: float, degree: int, c: float = 0.6) -> np.ndarray:
    """Relative error of K_I at g = -0.66 and 0.66; ``outer`` is the far boundary's distance over a."""
    reach = np.arccosh(outer) - np.pi / 2.0
    count = int(np.ceil(reach / 3.0))
    kind = MESHES["confocal"]
    cells = kind.build(Refinement(levels, _RATIO, 2, (reach / count,) * count))
    space = Space(*distribute(cells, MPI.COMM_WORLD), kind.chart, degree, terms=_MOMENTS)
    punch, g = SlidingPunch(space, MovingFrame(2.0, c)), np.array([-0.66, 0.66])
    moments = chebyshev(space.chart.surface_position(space.contact.s))
    local = FlatPunch(MovingFrame(2.0, c), g)
    pressure = from_moments(punch.states(g).tested(moments), local.α, local.β)
    punch.destroy()
    return np.abs(pressure.K_I / local.K_I[:, None] - 1.0).max(axis=1)


def _row(
    name: str, title: str, x_label: str, x: np.ndarray, found: np.ndarray, *verdicts: Verdict
) -> Row:
    lines = {"K_I, g = -0.66": found[:, 0], "K_I, g = 0.66": found[:, 1]}
    return Row(name, title, x_label, x, "relative error of K_I (1)", lines, verdicts)


def _ends_at(found: np.ndarray, limit: float) -> Verdict:
    last = float(found[-1].max())
    return Verdict(f"the last is within {last:.1e}, allowed {limit:g}", last <= limit)


def _never_grows(found: np.ndarray) -> Verdict:
    worst = found.max(axis=1)
    grown = float((worst - np.minimum.accumulate(worst)).max())
    return Verdict(f"going further costs at most {grown:.1e}, allowed {_ROUNDING:g}", grown <= _ROUNDING)


def edges() -> Row:
    """Innermost cells from 1e-2 a to 1e-14 a wide."""
    width = 10.0 ** -np.arange(2.0, 15.0)  # on the surface, where a distance is half a square
    levels = np.ceil(np.log(np.sqrt(2.0 * width) / (np.pi / 2.0)) / np.log(_RATIO)).astype(int)
    found = np.array([_errors(max(n, 0), 1e9, 8) for n in levels])
    return _row("edges", "width of the innermost cells, degree 8, outer radius 1e9 a",
                "width over a (1)", width, found, _ends_at(found, 1e-7), _never_grows(found))  # fmt: skip


def radii() -> Row:
    """Outer radius from 5 a to 1e12 a."""
    outer = np.array([5.0, 10.0, 100.0, 1e3, 1e4, 1e6, 1e8, 1e10, 1e12])
    found = np.array([_errors(10, value, 9) for value in outer])
    verdicts = _ends_at(found, 1e-7), _never_grows(found)
    return _row("radius", "outer radius, degree 9", "outer radius over a (1)", outer, found, *verdicts)


def degrees() -> Row:
    """Polynomial degree from 1 to 10."""
    degree = np.arange(1, 11)
    found = np.array([_errors(10, 1e9, int(p)) for p in degree])
    digits = -np.polyfit(degree[2:], np.log10(found.max(axis=1)[2:]), 1)[0]
    rate = Verdict(f"{digits:.2f} digits a degree from degree 3 on, at least 0.8", digits >= 0.8)
    row = _row("degree", "polynomial degree, outer radius 1e9 a", "degree (1)", degree, found,
               _ends_at(found, 1e-8), rate)  # fmt: skip
    return replace(row, log_x=False)
