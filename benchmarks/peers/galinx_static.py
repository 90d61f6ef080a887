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
from galinx.meshes.kind import check_cells
from galinx.meshes.rings import Refinement
from galinx.solvers.contact.recovery import chebyshev
from galinx.solvers.fem.punch import SlidingPunch
from galinx.solvers.fem.space import Space, distribute
from galinx.solvers.solids.isotropic import MovingFrame

#: Degree, levels, ratio, widths of columns next to the rings, and how many moments of the forces at the
#: contact the far boundary follows, 0 where it is held; one sector. That wins where little is asked.
CONFIGURATIONS = [
    (4, 2, 0.15, (1.0, 3.7, 3.7), 0),
    (5, 2, 0.15, (1.0, 4.2, 4.2), 0),
    (6, 3, 0.15, (1.0, 5.7, 5.7), 0),
    (7, 3, 0.15, (1.0, 6.2, 6.2), 0),
    (8, 5, 0.2, (1.9,), 6),
    (9, 5, 0.2, (1.9,), 8),
    (10, 6, 0.2, (1.9,), 8),
    (11, 6, 0.2, (1.9,), 9),
]

#: Relative change of the contact forces that no moment shows, as the program has it.
NEGLIGIBLE = 1e-10


def solve(
    degree: int, levels: int, ratio: float, widths: tuple[float, ...], moments: int
) -> tuple[int, np.ndarray]:
    """Unknowns, and the moments ∫ σ_YY T_k dr over N/2."""
    kind = MESHES["confocal"]
    cells = kind.build(Refinement(levels, ratio, 1, widths))
    check_cells(cells)
    space = Space(*distribute(cells, MPI.COMM_SELF), kind.chart, degree, terms=moments)
    punch = SlidingPunch(space, MovingFrame(KAPPA, 0.0), negligible=NEGLIGIBLE)
    moments = chebyshev(space.chart.surface_position(space.contact.s))
    found = punch.states(G).normal[0] @ moments[:, :6]
    punch.destroy()
    return space.size, found


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
