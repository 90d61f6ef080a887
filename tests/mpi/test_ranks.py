"""Shared over two ranks, what one rank computes alone."""

import numpy as np
import pytest
from mpi4py import MPI
from support import space_on

from galinx.meshes import MESHES, Requirements
from galinx.meshes.rings import Refinement
from galinx.solvers.fem import fields
from galinx.solvers.fem.cells import model_cells
from galinx.solvers.fem.dolfinx_space import DolfinxSpace
from galinx.solvers.fem.fields import InteriorGradients, KeptValues
from galinx.solvers.fem.punch import SlidingPunch
from galinx.solvers.fem.traction import LinearLoads, LoadedHalfPlane, Pieces
from galinx.solvers.rays import NEAR
from galinx.solvers.solids.isotropic import MovingFrame

REFINEMENT = Refinement(5, 0.35, 2, (3.0,) * 4)


@pytest.mark.parametrize(
    "mesh, form",
    [("confocal", "isotropic"), ("graded", "isotropic"), ("confocal", "nearly incompressible")],
)
def test_a_shared_mesh_gives_what_one_rank_gives(mesh, form):
    states, traces, gradients = [], [], []
    points = np.array([[0.3, -0.2], [-1.5, -0.7], [1.0, -0.01], [4.0, -40.0], [0.0, -1.0]])
    for comm in (MPI.COMM_SELF, MPI.COMM_WORLD):
        space = space_on(mesh, REFINEMENT, 5, comm, form)
        punch = SlidingPunch(space, MovingFrame(2.0, 0.6))
        states.append(punch.states(-0.66))
        trace = fields.gather(space, punch.fields[:3])
        traces.append(trace.derivative(np.array([-1.9, -0.7, 0.3, 1.2, 1.8])))
        values = KeptValues(space, MovingFrame(2.0, 0.6), punch.fields)
        inside = InteriorGradients(space, MovingFrame(2.0, 0.6), values, points)
        gradients.append(inside.of(states[-1].weights))
        punch.destroy()
    alone, shared = states
    np.testing.assert_allclose(shared.normal, alone.normal, rtol=1e-8, atol=1e-12)
    assert shared.v0[0] == pytest.approx(alone.v0[0], rel=1e-10)
    np.testing.assert_allclose(traces[1][..., 0], traces[0][..., 0], rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(gradients[1], gradients[0], rtol=1e-8, atol=1e-10)


def test_next_to_an_edge_corrected_loads_have_the_digits_that_the_motion_of_all_takes():
    """At 1e-6 a from the end of a load the last digit of a displacement is 1e-9 of the stress."""
    refinement, slopes = MESHES["graded"].refinement(Requirements(1e-3, 1e-7, 1e5)), []
    for comm in (MPI.COMM_SELF, MPI.COMM_WORLD):
        solver = LoadedHalfPlane(space_on("graded", refinement, 5, comm), MovingFrame(2.0, 0.6))
        solver.load(lambda left, right: -1.0 + 0.0 * left)
        solver.correct()
        assert solver.resultants == pytest.approx([-2.0, 0.0], rel=1e-12)
        at = fields.surface_slopes(solver.space, solver.fields, np.array([-1.0 - 1e-6, 1.0 - 1e-6]))
        slopes.append(np.stack(at.of(np.tile([1.0, -0.5], (1, 2)))))
        solver.destroy()
    # Ranks add up in any order, which makes two results, 4e-10 apart; without corrections it is 4e-9.
    np.testing.assert_allclose(slopes[1], slopes[0], rtol=5e-10)


@pytest.mark.parametrize("form", ["isotropic", "nearly incompressible"])
def test_shared_pieces_give_what_one_rank_gives(form):
    pieces = Pieces(np.array([-1.0, 0.2, 0.201, 1.0]), np.array([-1.0, -2.0, -7.0, 0.0]))
    points = np.array([[0.3, -0.2], [0.2, 0.0], [-1.0, -1e-9], [0.201, -1e-12], [4.0, -3.0]])
    found = []
    for comm in (MPI.COMM_SELF, MPI.COMM_WORLD):
        refinement = MESHES["confocal"].refinement(Requirements(1e-3, NEAR, 1e5))
        loads = LinearLoads(space_on("confocal", refinement, 5, comm, form), MovingFrame(2.0, 0.6))
        found.append(pieces.gradients(loads, points))
        assert pieces.resultant(loads) == pytest.approx(-1.8 - 0.0045 - 2.7965, rel=1e-12)
    np.testing.assert_allclose(found[1], found[0], rtol=0.0, atol=1e-11)


def test_a_rank_that_has_worked_alone_works_with_the_others():
    """What it has compiled by itself the others still have to compile, and they do that together."""
    element = "confocal", REFINEMENT, 7  # of a degree that no other test here has
    alone = [space_on(*element, MPI.COMM_SELF).size] if MPI.COMM_WORLD.rank == 0 else []
    size = space_on(*element, MPI.COMM_WORLD).size
    assert all(size == one for one in alone)


@pytest.mark.parametrize("form", ["isotropic", "nearly incompressible"])
def test_dolfinx_assembles_the_same_on_all_ranks_together(form):
    response, loads = MovingFrame(2.0, 0.6), []
    for comm in (MPI.COMM_SELF, MPI.COMM_WORLD):
        own = space_on("confocal", Refinement(4, 0.25, 1, (2.0,) * 3), 5, comm, form)
        parts = own.mesh, own.facet_tags, own.chart, 5, form, own.terms
        punch = SlidingPunch(DolfinxSpace(*parts), response)
        loads.append(punch.states([-0.6, 0.3]))
        punch.destroy()
    np.testing.assert_allclose(loads[1].normal, loads[0].normal, rtol=1e-9)
    np.testing.assert_allclose(loads[1].v0, loads[0].v0, rtol=1e-9)


@pytest.mark.parametrize("mesh", ["box", "graded"])
def test_a_cell_has_the_matrix_that_it_has_on_one_rank(mesh):
    """At 1e-11 a from an edge vertices have five digits of a cell's shape: the model matters."""
    refinement, models = MESHES[mesh].refinement(Requirements(1e-6, 1e-7, 1e5)), []
    for comm in (MPI.COMM_SELF, MPI.COMM_WORLD):
        space = space_on(mesh, refinement, 2, comm)
        corners, members = model_cells(space.vertices, MovingFrame(2.0, 0.6), (), comm.allgather)
        of_rank = [
            (space.vertices[i].tobytes(), of.tobytes())
            for of, cells in zip(corners, members)
            for i in cells
        ]
        models.append(dict(pair for part in comm.allgather(of_rank) for pair in part))
    assert len(set(models[0].values())) < len(models[0])
    assert models[1] == models[0]
