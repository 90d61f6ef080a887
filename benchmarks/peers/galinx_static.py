"""The static flat punch with friction in galinx, mesh to moments, nothing cached but compiled forms.

Prints one JSON line a configuration, as ngsolve_static.py does.
"""

import json
import logging
import time
from statistics import median

import numpy as np
from mpi4py import MPI
from static_punch import KAPPA, G, exact_moments

from galinx.meshes import MESHES
from galinx.meshes.cells import check_cells
from galinx.meshes.gmsh_model import through_gmsh
from galinx.meshes.rings import TAGS, Refinement
from galinx.postprocess.pressure import contact_recovery
from galinx.solvers.fem.distributed import distribute
from galinx.solvers.fem.punch import SlidingPunch
from galinx.solvers.fem.space import Space
from galinx.solvers.solids.isotropic import MovingFrame

#: Degree, levels, ratio, columns, outer ξ; one sector.
CONFIGURATIONS = [
    (4, 3, 0.15, 4, 10.0),
    (5, 3, 0.15, 4, 12.0),
    (6, 4, 0.15, 5, 14.0),
    (7, 4, 0.15, 5, 16.0),
    (7, 5, 0.2, 6, 17.0),
    (9, 5, 0.2, 6, 19.0),
    (9, 6, 0.25, 7, 21.0),
    (11, 6, 0.2, 6, 23.0),
]


def solve(degree: int, levels: int, ratio: float, columns: int, outer: float) -> tuple[int, np.ndarray]:
    """Unknowns, and the moments ∫ σ_YY T_k dr over N/2."""
    width = (outer - np.pi / 2.0) / columns
    kind = MESHES["confocal"]
    cells = kind.build(Refinement(levels, ratio, 1, (width,) * columns))
    check_cells(cells)
    space = Space(*distribute(through_gmsh(cells), MPI.COMM_SELF), TAGS, kind.chart, degree)
    punch = SlidingPunch(space, MovingFrame(KAPPA, 0.0))
    recovery = contact_recovery(space.contact.s, degree, space.chart, np.zeros(0))
    moments = punch.states(G).normal[0] @ recovery.moments[:, :6]
    punch.destroy()
    return space.size, moments


def main() -> None:
    logging.disable(logging.WARNING)
    wanted = exact_moments()
    for configuration in CONFIGURATIONS:
        times = []
        for _ in range(6):
            started = time.process_time()
            unknowns, moments = solve(*configuration)
            times.append(time.process_time() - started)
        error = float(np.abs(moments - wanted).max() / 2.0)
        figures = {"tool": "galinx", "configuration": configuration}
        figures |= {"unknowns": unknowns, "cpu_seconds": median(times[1:]), "error": error}
        print(json.dumps(figures), flush=True)


if __name__ == "__main__":
    main()
