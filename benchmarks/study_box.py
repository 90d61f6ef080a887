"""One friction state at rest: galinx's default, and the study's block with as many quadratic elements
as its own model has. Prints a JSON line of each; times are without start-up.
"""

import json
import logging
import resource
import time
from collections.abc import Callable

import numpy as np
from mpi4py import MPI

import galinx
from galinx.meshes import MESHES, Requirements
from galinx.meshes.kind import check_cells
from galinx.meshes.rings import QuadMesh, Refinement
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.contact.recovery import chebyshev, from_moments
from galinx.solvers.fem.punch import SlidingPunch
from galinx.solvers.fem.space import Space, distribute
from galinx.solvers.solids.isotropic import MovingFrame

#: Elements of the study's model.
ELEMENTS = 145_106
#: σ_XY/σ_YY of the largest friction in Tables 4 and 5.
G = -0.66
#: The scene of that state and what else it gets; settings are the default ones.
SCENE = "tables4_5"
CHANGES = {
    "motion.c": 0.0, "motion.strokes": ["forward"], "motion.X_over_L": 0.8,
    "output.quantities": ["sif"],
}  # fmt: skip


def block() -> QuadMesh:
    """The box pattern with its rings and columns cut until it has the wanted number of cells."""
    coarse = MESHES["box"].refinement(Requirements(1e-2))
    rings = 4 * coarse.sectors * coarse.levels
    k = round((ELEMENTS / (rings + 2 * coarse.sectors * len(coarse.columns))) ** 0.5)
    sectors, levels = k * coarse.sectors, k * coarse.levels
    fans = 2 * sectors
    columns = round((ELEMENTS - 4 * sectors * levels - fans) / (2 * sectors))
    widths = (sum(coarse.columns) / columns,) * columns
    return MESHES["box"].build(Refinement(levels, coarse.ratio ** (1.0 / k), sectors, widths))


def study() -> tuple[float, int, int]:
    """Error of K_I, cells and unknowns of the study's size."""
    pattern, chart = block(), MESHES["box"].chart
    check_cells(pattern)
    space = Space(*distribute(pattern, MPI.COMM_SELF), chart, 2)
    response = MovingFrame(2.0, 0.0)
    punch = SlidingPunch(space, response)
    moments = chebyshev(chart.surface_position(space.contact.s))
    local = FlatPunch(response, np.array([G]))
    pressure = from_moments(punch.states(G).normal @ moments, local.α, local.β)
    punch.destroy()
    return float(np.abs(pressure.K_I / local.K_I - 1.0).max()), space.cells, space.size


def default() -> tuple[float, int, int]:
    """The same of galinx's default, its measured error and the closed form included."""
    data = galinx.compute(galinx.template(SCENE, CHANGES)).data
    cells, unknowns = (int(data[f"run/fem/{name}"][0]) for name in ("cells", "unknowns"))
    return float(data["states/fem/true_error"][0]), cells, unknowns


def measured(name: str, work: Callable[[], tuple[float, int, int]]) -> dict[str, object]:
    """Figures of a second run: forms are compiled, libraries loaded."""
    work()
    wall, cpu = time.perf_counter(), time.process_time()
    error, cells, unknowns = work()
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    figures = {"name": name, "cells": cells, "unknowns": unknowns, "wall": wall, "cpu": cpu}
    return figures | {"memory": memory, "K_I": error}


def main() -> None:
    logging.disable(logging.WARNING)
    print(json.dumps(measured("default, one state at rest, start apart", default)), flush=True)
    print(json.dumps(measured("study's element count, the same", study)), flush=True)


if __name__ == "__main__":
    main()
