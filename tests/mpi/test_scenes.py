"""Scenes with their meshes decomposed over the ranks, against whole speeds on one rank each."""

from time import sleep

import numpy as np
import pytest
from mpi4py import MPI
from support import THOROUGH, scene_of

from galinx import template
from galinx.app.plan import elements
from galinx.app.plan.plan import make_plan
from galinx.app.run.flow import Memory, compute
from galinx.app.scene.library import templates
from galinx.solvers.fem.ladder import ROUNDING

#: What ranks agree on they agree on at every tolerance, but for the block, whose boundary leaves more
#: than the rough one, and friction along the contact, whose estimates low degrees leave a percent apart.
#: Largest stresses below a cylinder are compared in scenes of one body.
ROUGH = {"solve.tolerance": 1e-2}
MAP = {"output.map": {"X": [-2.0, 2.0, 9], "Y": [-2.0, -0.1, 5]}}
OWN = {
    "box": {}, "along": {"solve.tolerance": 1e-3}, "inside": ROUGH | MAP,
    "cylinder_on_steel": ROUGH | MAP | {
        "output.quantities": ["friction", "sif", "surface", "interior", "yield"],
    },
    "elastic_punch": ROUGH | {"output.quantities": ["friction", "sif", "surface"]},
}  # fmt: skip


def of_two_speeds(name):
    """A scene at the first and the last of its speeds: the mesh of each is decomposed alike.

    By finite elements alone, and of several strokes the first one.
    """
    scene, changes = template(name), OWN.get(name, ROUGH)
    if "fem" in scene.solve.methods:
        changes = changes | {"solve.methods": ["fem"]}
    if len(speeds := scene.motion.c or ()) > 2:
        changes = changes | {"motion.c": [speeds[0], speeds[-1]]}
    if len(scene.motion.strokes) > 1 and make_plan(scene).fem:
        changes = changes | {"motion.strokes": ["forward"]}
    return template(name, changes)


SCENES = {name: of_two_speeds(name) for name in templates()}
#: Largest differences: relative of what a scene is run for, absolute of errors and fitted exponents, and
#: of stresses over the median of their size, since they are derivatives. What rounding does to stresses
#: is in their estimates ``ROUNDING`` times.
RESULTS, SMALL, STRESSES = 1e-9, 1e-8, 1e-7
#: Beginnings of the names of results; all with a unit of their own are among them.
OF_UNITS = ("K_I", "normal", "tangential", "v0", "first_yield_load")
#: Places of the largest stresses over a: near them a stress differs by the square of the distance.
PLACES = 1e-6

#: A hard coating that is graded, by finite elements alone, with stresses at its interface.
SCENES["graded coating"] = scene_of("coating", {
    "layer[0].to": {"E": "3 GPa"}, "solve.methods": ["fem"], "output.quantities": ["sif", "interfaces"],
} | ROUGH)  # fmt: skip

#: A wedge, and friction that develops along its contact, whose search ends loosely at rough tolerances.
SCENES["wedge"] = scene_of("along", {
    "friction.sigma0_over_load": 2500.0, "solve.methods": ["fem"],
    "punch": {"profile": "wedge", "slope": 0.005, "load": "500 N/mm"},
    "solve.tolerance": 1e-4, "output.quantities": ["sif"],
})  # fmt: skip

#: So many speeds that few are solved, and the others fitted.
SCENES["many speeds"] = scene_of("tables4_5", {
    "motion.c": np.linspace(0.0, 0.8, 16).tolist(), "solve.tolerance": 1e-2,
    "solve.methods": ["fem"], "output.quantities": ["sif"],
})  # fmt: skip


def kinds():
    """Names of scenes by finite elements; of those that differ in numbers alone one with most outputs."""
    found = {}
    for name, scene in sorted(SCENES.items(), key=lambda one: -len(one[1].output.quantities)):
        if fem := make_plan(scene).fem:
            bodies = type(scene.solid), bool(scene.layers), bool(scene.elastic_punch)
            kind = name if THOROUGH else (fem.mode, bool(fem.sweep), scene.solve.mesh, *bodies)
            words, of_kind = {*scene.output.quantities}, found.setdefault(kind, {})
            if not any(words <= others for others in of_kind.values()):
                of_kind[name] = words
    return [name for of_kind in found.values() for name in of_kind]


@pytest.mark.skipif(MPI.COMM_WORLD.size == 1, reason="needs two ranks")
@pytest.mark.parametrize("name", kinds())
def test_a_decomposed_mesh_gives_what_one_rank_gives(name, monkeypatch):
    found = []
    for alone in (True, False):
        monkeypatch.setattr(elements, "shares_speeds", lambda *_, alone=alone: alone)
        found.append(Memory())
        compute(SCENES[name], found[-1])
        done = MPI.COMM_WORLD.Ibarrier()
        while not done.Test():  # a rank that waits in MPI itself takes a core
            sleep(0.01)
    one, two = found
    compared = [key for key in one if "/fem/" in key and not key.startswith("run/")]
    assert bool(compared) == (MPI.COMM_WORLD.rank == 0)
    for key in compared:
        kind, quantity = key.split("/fem/")
        if kind == "states" and quantity.startswith(OF_UNITS):
            unit = np.abs(one[key]).max()
            np.testing.assert_allclose(two[key], one[key], atol=RESULTS * unit, rtol=0.0, err_msg=key)
        elif kind == "states" and quantity.startswith(("estimate_sigma", "estimate_in")):
            atol = ROUNDING * STRESSES
            np.testing.assert_allclose(two[key], one[key], atol=atol, rtol=0.0, err_msg=key)
        elif kind == "states" and quantity.endswith("_over_a"):
            np.testing.assert_allclose(two[key], one[key], atol=PLACES, rtol=0.0, err_msg=key)
        elif kind == "states":
            atol = SMALL * max(np.nanmax(np.abs(one[key]), initial=0.0), 1.0)  # largest stresses are more
            np.testing.assert_allclose(two[key], one[key], atol=atol, rtol=0.0, err_msg=key)
        else:
            unit = np.nanmedian(np.abs(one[key]))
            np.testing.assert_allclose(
                two[key], one[key], rtol=STRESSES, atol=STRESSES * unit, err_msg=key
            )
