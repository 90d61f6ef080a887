"""Starts from rest, shared out over two ranks."""

import numpy as np
from mpi4py import MPI

import galinx
from galinx.app import ranks
from galinx.app.plan.plan import make_plan
from galinx.app.run.flow import Memory, compute
from galinx.app.run.over_time import solve_motions
from galinx.clock import Clock

QUICK = {"motion.c": [0.2, 0.5], "time.end": 0.5, "time.load_ramp": 0.5, "solve.tolerance": 1e-2}


def test_ranks_share_out_starts(monkeypatch):
    """The second start is what it is alone, and all of both reaches rank 0."""
    scene, found = galinx.template("start_from_rest", QUICK), Memory()
    compute(scene, found)
    told = {path: values for path, values in found.items() if path.startswith("time/")}
    assert bool(told) == (MPI.COMM_WORLD.rank == 0)
    monkeypatch.setattr(ranks, "_rank_and_size", lambda: (0, 1))
    second = make_plan(galinx.template("start_from_rest", QUICK | {"motion.c": 0.5}))
    alone = solve_motions(second.starts, Clock())
    assert {"time/sie/v0", "time/fem/v0"} < alone.keys()
    for path, values in told.items():
        last = values[-len(alone[path]) :]
        np.testing.assert_allclose(last, alone[path], rtol=1e-9, atol=1e-12, err_msg=path)
