"""Linear solvers on big meshes: iterations, seconds and memory against unknowns, by speed and degree.

./run.sh bench big [UNKNOWNS]                prints a Markdown table, up to so many unknowns
"""

import argparse
import resource
import time

import numpy as np
from mpi4py import MPI

from galinx.clock import Clock
from galinx.meshes import MESHES, Requirements
from galinx.solvers.fem.boundary import held_forces
from galinx.solvers.fem.linear import LinearSolver, available
from galinx.solvers.fem.space import Space, distribute
from galinx.solvers.solids.isotropic import MovingFrame

#: Kolosov's constant of ν = 0.25 in plane strain.
KAPPA = 2.0
#: Meshes, degrees and cuts, small to large.
CASES = [
    ("uniform", 2, (12, 24, 48, 72)),
    ("uniform", 4, (6, 12, 24)),
    ("confocal", 2, (12, 24, 48, 64)),
    ("confocal", 4, (6, 12, 24, 32)),
    ("graded", 2, (12, 24, 44)),
    ("graded", 4, (6, 12)),
]
HEAD = """\
| mesh | degree | unknowns | c | solver | steps | set-up (s) | solve (s) | peak so far (MB) |
|---|---|---|---|---|---|---|---|---|"""


def measure(space: Space, c: float, kind: str) -> tuple[int, float, float]:
    """Steps of conjugate gradients (0: a factor), seconds of set-up and of a solve."""
    response = MovingFrame(KAPPA, c)
    A = space.assemble(response)
    v = -np.ones((len(space.contact.dofs(1)), 1))  # the frictionless punch
    b = held_forces(A, space, space.contact.dofs(1), v)
    A = space.held(A, response, ("contact", "far"))
    start = time.perf_counter()
    method = "direct" if kind == "mumps" else kind
    solver = LinearSolver(A, Clock(), method, places=space.places(response))
    ready = time.perf_counter()
    solver.solve(b)
    done = time.perf_counter()
    solver.destroy()
    return solver.iterations, ready - start, done - ready


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("unknowns", nargs="?", type=float, default=3.5e6, help="of the largest mesh")
    comm, most = MPI.COMM_WORLD, parser.parse_args().unknowns
    if comm.rank == 0:
        print(HEAD)
    for name, degree, all_cuts in CASES:
        for cuts in all_cuts:
            kind = MESHES[name]
            cells = None if comm.rank else kind.build(kind.refinement(Requirements(1e-6)), cuts)
            space = Space(*distribute(cells, comm), kind.chart, degree)
            if space.size > most:
                continue
            for c in (0.0, 0.9):
                for solver in ("mumps", *available()):
                    steps, ready, solved = measure(space, c, solver)
                    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
                    if comm.rank == 0:
                        print(
                            f"| {name} | {degree} | {space.size} | {c:g} | {solver} | {steps or '–'} | "
                            f"{ready:.2f} | {solved:.2f} | {memory:.0f} |",
                            flush=True,
                        )


if __name__ == "__main__":
    main()
