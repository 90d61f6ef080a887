import subprocess

from support import clean_environment, mpirun


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
