import pytest
from mpi4py import MPI
from support import space_on

from galinx.meshes import MESHES, Requirements
from galinx.meshes.rings import TAGS, Refinement
from galinx.solvers.contact.fem_plan import unknowns
from galinx.solvers.errors import MeshError
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
