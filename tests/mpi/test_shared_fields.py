"""Whole fields, sampled by two ranks together."""

from contextlib import closing

import h5py
import numpy as np
import pytest
from mpi4py import MPI
from support import gathered, space_on, state_field

from galinx import template
from galinx.app.results.fields import Solved, solve_states, write_fields
from galinx.meshes.rings import Refinement
from galinx.postprocess.target import Target
from galinx.solvers.fem.export import sample
from galinx.solvers.fem.punch import SlidingPunch
from galinx.solvers.solids.isotropic import MovingFrame


@pytest.mark.parametrize("mesh, extent", [("confocal", 5.0), ("graded", 5.0), ("confocal", 1e-3)])
def test_ranks_sample_together_what_one_samples(mesh, extent):
    found = []
    for comm in (MPI.COMM_SELF, MPI.COMM_WORLD):
        space = space_on(mesh, Refinement(5, 0.35, 2, (3.0,) * 4), 5, comm)
        punch = SlidingPunch(space, MovingFrame(2.0, 0.6))
        weights = punch.states(-0.66).weights[0]
        field = sample(space, MovingFrame(2.0, 0.6), punch.fields, weights, extent, 4)
        found.append(gathered(field, comm))
        punch.destroy()
    alone, shared = found
    assert (shared is None) == (MPI.COMM_WORLD.rank > 0)
    if shared is None:
        return
    assert shared.quads.shape == alone.quads.shape and shared.points.shape == alone.points.shape
    one, other = (
        by_place(field.points, field.quads, (field.displacement, field.gradient)) for field in found
    )
    for a, b in zip(one, other):
        np.testing.assert_allclose(b, a, rtol=1e-8, atol=1e-9 * np.abs(a).max())


def by_place(points, quads, data):
    """Middles and means of all quadrilaterals, whatever the order of cells and points was."""
    middle = points[quads].mean(axis=1)
    order = np.lexsort(np.round(middle / np.abs(points).max(), 12).T)
    return [np.nan_to_num(values[quads]).mean(axis=1)[order] for values in (points, *data)]


def test_rank_0_writes_what_all_ranks_have(tmp_path, monkeypatch):
    path, scene = tmp_path / "state.hdf", template("tables4_5")
    # One solution for both: what rounding does next to an edge differs from run to run on two ranks.
    with closing(solve_states(scene, [0], [5])) as states:
        found = next(states).sampled(2.0)
    monkeypatch.setattr(Solved, "sampled", lambda *_: found)
    write_fields(scene, [0], Target(path), extent=2.0, degrees=[5])
    whole = state_field(scene, 0, extent=2.0, degree=5)
    assert path.exists() == (MPI.COMM_WORLD.rank == 0) == (whole is not None)
    if whole is None:
        return
    with h5py.File(path) as file:
        root = file["VTKHDF"]
        first, corners = root["Offsets"][:-1], np.diff(root["Offsets"])
        assert set(corners) == {3, 4}
        each = first[:, None] + np.minimum(np.arange(4), corners[:, None] - 1)
        quads = root["Connectivity"][:][each]
        assert root["NumberOfPoints"][0] == len(root["Points"]) == len(whole.points)
        assert root["NumberOfCells"][0] == len(quads) == len(whole.quads)
        assert set(root["PointData"]) == set(whole.data)
        written = by_place(
            root["Points"][:, :2], quads, [root[f"PointData/{name}"][:] for name in whole.data]
        )
    for a, b in zip(by_place(whole.points, whole.quads, whole.data.values()), written):
        np.testing.assert_allclose(b, a, rtol=1e-12, atol=1e-12 * np.nanmax(np.abs(a)))
