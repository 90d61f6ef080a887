"""Spaces on meshes: parts, sizes, ranks without cells, values along the surface."""

from types import SimpleNamespace

import numpy as np
import pytest
from mpi4py import MPI
from support import finished, mpirun, small_punch, space_on

from galinx.meshes import MESHES, Requirements
from galinx.meshes.rings import TAGS, Refinement
from galinx.solvers.contact import stresses
from galinx.solvers.contact.fem_plan import requirements, unknowns
from galinx.solvers.errors import MeshError
from galinx.solvers.fem.fields import surface_slopes
from galinx.solvers.fem.space import Space, consistent_forces, distribute


def test_a_missing_boundary_part_is_named(monkeypatch):
    kind = MESHES["confocal"]
    mesh, tags = distribute(kind.build(Refinement(1, 0.3, 1, (1.0,))), MPI.COMM_WORLD)
    monkeypatch.setitem(TAGS, "far", 17)
    with pytest.raises(MeshError, match="far"):
        Space(mesh, tags, kind.chart, 2)


@pytest.mark.parametrize("mesh", MESHES)
def test_planned_sizes_are_those_of_the_run(mesh):
    pattern = MESHES[mesh].refinement(Requirements(1e-3))
    cells, space = MESHES[mesh].build(pattern), space_on(mesh, pattern, 3)
    assert (space.cells, space.size) == (len(cells.cells), unknowns(cells, 3))


def test_rounding_of_slopes_is_that_of_the_displacements():
    """Of displacements that are changed at random the slopes change by no more, nor much less."""
    punch, rng = small_punch(), np.random.default_rng(0)
    X = np.array([-3.0, -1.001, -0.9999, 0.0, 0.5, 0.999, 1.5])
    fields, ε = punch.fields[:2], 1e-8
    slopes = surface_slopes(punch.space, fields, X)
    changes = []
    for _ in range(10):
        other = [field.copy() for field in fields]
        for field in other:
            field.array *= 1.0 + ε * rng.uniform(-1.0, 1.0, len(field.array))
        changes.append(np.abs(surface_slopes(punch.space, other, X).basis[0] - slopes.basis[0]))
    shares = np.max(changes, axis=0) / (slopes.noise * ε / np.finfo(float).eps)
    assert shares.max() <= 1.0 and shares.min() >= 0.05


def test_more_ranks_than_cells():
    script = (
        "from mpi4py import MPI\n"
        "from galinx.solvers.fem.space import distribute\n"
        "from galinx.meshes import MESHES\n"
        "from galinx.meshes.rings import Refinement\n"
        "from galinx.solvers.fem.punch import SlidingPunch\n"
        "from galinx.solvers.fem.space import Space\n"
        "from galinx.solvers.solids.isotropic import MovingFrame\n"
        "import numpy as np\n"
        "from galinx.solvers.fem.fields import InteriorGradients, KeptValues\n"
        "kind, v0 = MESHES['confocal'], []\n"
        "for comm in (MPI.COMM_SELF, MPI.COMM_WORLD):\n"
        "    cells = None if comm.rank else kind.build(Refinement(0, 0.3, 1, ()))\n"
        "    mesh = distribute(cells, comm)\n"
        "    space, frame = Space(*mesh, kind.chart, 4), MovingFrame(2.0, 0.5)\n"
        "    punch = SlidingPunch(space, frame)\n"
        "    state = punch.states(0.5)\n"
        "    values = KeptValues(space, frame, punch.fields)\n"
        "    inside = InteriorGradients(space, frame, values, np.array([[0.1, -0.5]]))\n"
        "    v0.append((state.v0[0], *inside.of(state.weights).ravel()))\n"
        "    punch.destroy()\n"
        "assert space.cells == 2 < MPI.COMM_WORLD.size\n"
        "np.testing.assert_allclose(v0[1], v0[0], rtol=1e-9)\n"
    )
    done = finished(mpirun(3, "-m", "mpi4py", "-c", script))
    assert done.returncode == 0, done.stderr


def test_a_mesh_reaches_the_farthest_place_in_every_plane_of_the_solid():
    places = stresses.Places(np.array([0.5]), np.array([[-2.0, -1.0]]))
    alike = SimpleNamespace(spread=1.0, margin=1.0)
    for planes, farthest in (((), 5.0**0.5), ((1.0 + 1.0j,), 10.0**0.5), ((-1.0 + 1.0j,), 5.0**0.5)):
        assert requirements(1e-6, places, -0.5, [alike], planes).farthest == pytest.approx(farthest)


@pytest.mark.parametrize("mesh", ["graded", "confocal"])
def test_nodal_forces_of_a_load_that_jumps_inside_a_facet_are_its_resultant(mesh):
    """On a parabola, by the distances from both ends."""
    chart, knots = MESHES[mesh].chart, np.array([-0.3, 0.12])
    ends = chart.surface_coordinate(np.array([-1.0, 1.0]))
    s = np.linspace(*ends, 13)[[range(0, 5), range(4, 9), range(8, 13)]]

    def load(left, right):
        return -left * right - 5.0 * ((left > 0.7) & (right > 0.88))

    forces = consistent_forces(s, chart, ends, load, knots)
    assert forces.sum() == pytest.approx(-4.0 / 3.0 - 5.0 * 0.42, rel=1e-12)
