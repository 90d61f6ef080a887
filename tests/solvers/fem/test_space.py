"""Spaces on meshes: parts, sizes, ranks without cells, values along the surface."""

import subprocess

import numpy as np
import pytest
from mpi4py import MPI
from support import clean_environment, mpirun, space_on

from galinx.meshes import MESHES, Requirements
from galinx.meshes.rings import TAGS, Refinement
from galinx.solvers.contact.fem_plan import unknowns
from galinx.solvers.errors import MeshError
from galinx.solvers.fem.fields import SurfaceTrace
from galinx.solvers.fem.space import Space, distribute


def test_a_missing_boundary_part_is_named():
    kind = MESHES["confocal"]
    mesh, tags = distribute(kind.build(Refinement(1, 0.3, 1, (1.0,))), MPI.COMM_WORLD)
    with pytest.raises(MeshError, match="far"):
        Space(mesh, tags, TAGS | {"far": 17}, kind.chart, 2)


@pytest.mark.parametrize("mesh", MESHES)
def test_planned_sizes_are_those_of_the_run(mesh):
    pattern = MESHES[mesh].refinement(Requirements(1e-3))
    cells, space = MESHES[mesh].build(pattern), space_on(mesh, pattern, 3)
    assert (space.cells, space.size) == (len(cells.cells), unknowns(cells, 3))


def test_between_facets_the_right_one_counts_whatever_rounding_does():
    s = np.array([[-1.0, 0.0], [1e-16, 2.0]])
    trace = SurfaceTrace(s, np.abs(s)[..., None, None] * np.ones((2, 1)))
    for at in (-1e-16, 0.0, 2e-16):
        np.testing.assert_allclose(trace.derivative([at]), 1.0)
    np.testing.assert_allclose(trace.derivative([-1e-6]), -1.0)


def test_more_ranks_than_cells():
    script = (
        "from mpi4py import MPI\n"
        "from galinx.solvers.fem.space import distribute\n"
        "from galinx.meshes import MESHES\n"
        "from galinx.meshes.rings import TAGS, Refinement\n"
        "from galinx.solvers.fem.punch import SlidingPunch\n"
        "from galinx.solvers.fem.space import Space\n"
        "from galinx.solvers.solids.isotropic import MovingFrame\n"
        "import numpy as np\n"
        "from galinx.solvers.fem.fields import InteriorGradients, KeptValues\n"
        "kind, v0 = MESHES['confocal'], []\n"
        "for comm in (MPI.COMM_SELF, MPI.COMM_WORLD):\n"
        "    cells = None if comm.rank else kind.build(Refinement(0, 0.3, 1, (2.0,)))\n"
        "    mesh = distribute(cells, comm)\n"
        "    space, frame = Space(*mesh, TAGS, kind.chart, 4), MovingFrame(2.0, 0.5)\n"
        "    punch = SlidingPunch(space, frame)\n"
        "    state = punch.states(0.5)\n"
        "    values = KeptValues(space, frame, punch.fields)\n"
        "    inside = InteriorGradients(space, frame, values, np.array([[0.1, -0.5]]))\n"
        "    v0.append((state.v0[0], *inside.of(state.weights).ravel()))\n"
        "    punch.destroy()\n"
        "assert space.cells == 4 < MPI.COMM_WORLD.size\n"
        "np.testing.assert_allclose(v0[1], v0[0], rtol=1e-9)\n"
    )
    done = subprocess.run(
        mpirun(6, "-m", "mpi4py", "-c", script), env=clean_environment(),
        capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
