"""Both assemblers on one mesh, degree by degree: time, entries of the matrix, and K_I.

./run.sh bench assemblers                    prints a Markdown table
"""

import argparse
import logging
from statistics import median
from time import process_time

import numpy as np
from mpi4py import MPI
from petsc4py import PETSc

from galinx.meshes import MESHES
from galinx.meshes.rings import Refinement
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.contact.recovery import chebyshev, from_moments
from galinx.solvers.fem.dolfinx_space import DolfinxSpace
from galinx.solvers.fem.punch import SlidingPunch
from galinx.solvers.fem.space import Space, distribute
from galinx.solvers.solids.isotropic import MovingFrame

#: The mesh of Tables 4 and 5 at a tolerance of 1e-6, a fast state of them, degrees, and times of each.
CELLS, G, RESPONSE = Refinement(6, 0.15, 2, (1.5,) * 2), -0.66, MovingFrame(2.0, 0.6)
DEGREES, RUNS = (2, 4, 6, 8, 10), 5


def measured(space: Space) -> tuple[float, int, np.ndarray]:
    """Processor seconds of a matrix, its entries, and K_I at both edges."""
    seconds = []
    for _ in range(RUNS + 1):  # the first compiles
        begun = process_time()
        A = space.assemble(RESPONSE)
        seconds.append(process_time() - begun)
        entries = int(A.getInfo(PETSc.Mat.InfoType.GLOBAL_SUM)["nz_used"])
        A.destroy()
    return median(seconds[1:]), entries, intensities(space)


def intensities(space: Space) -> np.ndarray:
    """K_I at X = -a and X = a."""
    punch, local = SlidingPunch(space, RESPONSE), FlatPunch(RESPONSE, np.array([G]))
    moments = chebyshev(space.chart.surface_position(space.contact.s))
    K_I = from_moments(punch.states(G).tested(moments), local.α, local.β).K_I[0]
    punch.destroy()
    return K_I


def main() -> None:
    argparse.ArgumentParser(description=__doc__).parse_args()
    logging.disable(logging.WARNING)
    kind = MESHES["confocal"]
    mesh = distribute(kind.build(CELLS), MPI.COMM_SELF)
    heads = "degree", "unknowns", "tensor (ms)", "dolfinx (ms)", "ratio", "entries, tensor", "dolfinx"
    print(f"| {' | '.join(heads)} | K_I, relative |")
    print("|---" * (len(heads) + 1) + "|")
    for degree in DEGREES:
        of_each = []
        for space in (Space, DolfinxSpace):
            made = space(*mesh, kind.chart, degree, terms=8)
            of_each.append(measured(made))
        (fast, few, own), (slow, many, ordinary) = of_each
        change = np.abs(ordinary / own - 1.0).max()
        print(
            f"| {degree} | {made.size} | {1e3 * fast:.1f} | {1e3 * slow:.1f} | {slow / fast:.1f} | {few} "
            f"| {many} | {change:.1e} |", flush=True,
        )  # fmt: skip


if __name__ == "__main__":
    main()
