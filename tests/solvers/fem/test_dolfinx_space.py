"""dolfinx's own assembly of every registered form beside the element matrices by tensor products."""

import numpy as np
import pytest
import ufl
from support import THOROUGH, computed, space_on

from galinx.app.errors import BadInput
from galinx.meshes.rings import Refinement
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.contact.edges import EdgeTraction
from galinx.solvers.fem.dolfinx_space import DolfinxSpace
from galinx.solvers.fem.forms import FORMS, Form
from galinx.solvers.fem.punch import SlidingPunch
from galinx.solvers.fem.traction import LoadedHalfPlane
from galinx.solvers.solids.isotropic import Isotropic, MovingFrame
from galinx.solvers.solids.plane import Orthotropic

DEGREE = 3
#: Responses by the weak form that their solids ask for.
RESPONSES = {
    "isotropic": MovingFrame(2.2, 0.6),
    "anisotropic": Orthotropic(14e9, 1e9, 1e9, 0.3, 0.3, 0.4, 7e8, 1.5e3, np.radians(30.0)).response(0.3),
    "nearly incompressible": Isotropic(1e9, 0.499, 1e3).response(0.4),
}


def both(mesh, refinement, degree, form):
    """A space of either kind on one mesh."""
    tensor = space_on(mesh, refinement, degree, form=form)
    parts = tensor.mesh, tensor.facet_tags, tensor.chart, degree, form, tensor.terms
    return tensor, DolfinxSpace(*parts)


def condensed(K, kept):
    """The Schur complement of the unknowns ``kept``, in their order."""
    gone = np.setdiff1d(np.arange(len(K)), kept)
    inner = np.linalg.solve(K[np.ix_(gone, gone)], K[np.ix_(gone, kept)])
    return K[np.ix_(kept, kept)] - K[np.ix_(kept, gone)] @ inner


def assert_the_same_matrix(tensor, dolfinx, response):
    found, wanted = dolfinx.assemble(response)[:, :], tensor.assemble(response)[:, :]
    outer = np.flatnonzero(tensor.numbers >= 0)
    rows, others = (
        np.column_stack([space.numbers[outer], space.numbers[outer] + 1]).ravel()
        for space in (tensor, dolfinx)
    )
    assert tensor.mixed or len(wanted) == len(rows)
    found, wanted = condensed(found, others), condensed(wanted, rows)
    np.testing.assert_allclose(found, wanted, atol=1e-12 * np.abs(wanted).max(), rtol=0.0)


@pytest.mark.parametrize("mesh, form", [("graded", "isotropic"), *(("confocal", form) for form in FORMS)])
def test_the_matrix_is_that_of_tensor_products(mesh, form):
    spaces = both(mesh, Refinement(2, 0.3, 1, (1.0,) * 3), DEGREE, form)
    assert_the_same_matrix(*spaces, RESPONSES[form])


def test_a_form_of_ones_own_works_as_it_stands():
    def stiffer_with_spin(Gu, Gw, constants):
        """Isotropic energy, and one of the rotation, as no solid of the program has it."""
        λ, c = constants
        spin = (Gu[1, 0] - Gu[0, 1]) * (Gw[1, 0] - Gw[0, 1])
        energy = λ * ufl.tr(Gu) * ufl.tr(Gw) + 2 * ufl.inner(ufl.sym(Gu), ufl.sym(Gw))
        return energy + 0.3 * spin - c**2 * ufl.inner(Gu[:, 0], Gw[:, 0])

    class Response(MovingFrame):
        λ = 1.7

    FORMS.register("stiffer with spin", Form(stiffer_with_spin, ("λ", "c")))
    try:
        spaces = both("confocal", Refinement(2, 0.3, 1, (1.0,) * 3), DEGREE, "stiffer with spin")
        assert_the_same_matrix(*spaces, Response(2.2, 0.5))
    finally:
        del FORMS["stiffer with spin"]


@pytest.mark.parametrize("form", list(FORMS))
def test_contact_forces_and_what_is_held_agree(form):
    tensor, dolfinx = both("confocal", Refinement(4, 0.25, 1, (2.0,) * 3), 5, form)
    states = []
    for space in (tensor, dolfinx):
        punch = SlidingPunch(space, RESPONSES[form])
        states.append(punch.states([-0.6, 0.3]))
        punch.destroy()
    np.testing.assert_allclose(states[1].normal, states[0].normal, rtol=1e-9)
    np.testing.assert_allclose(states[1].tangential, states[0].tangential, rtol=1e-9)
    np.testing.assert_allclose(states[1].v0, states[0].v0, rtol=1e-9)


def test_a_traction_over_ds_is_what_a_graded_rule_makes_of_it():
    """The load of each node; next to an edge Gauss's points of a facet meet a power of the distance."""
    response = RESPONSES["isotropic"]
    traction = FlatPunch(response, -0.5).traction
    tensor, dolfinx = both("confocal", Refinement(4, 0.25, 1, (2.0,) * 3), 5, "isotropic")
    sums = []
    for space in (tensor, dolfinx):
        _, s, forces = space.nodal_forces(traction)
        of_nodes = np.zeros(len(space.contact.s))
        np.add.at(of_nodes, np.searchsorted(space.contact.s, s - 1e-12), forces)
        sums.append(of_nodes)
    np.testing.assert_allclose(sums[1], sums[0], atol=2e-7)
    np.testing.assert_allclose(sums[1].sum(), -2.0, rtol=1e-7)
    with pytest.raises(TypeError, match="flat punch"):
        dolfinx.nodal_forces(lambda left, right: left)
    loaded = LoadedHalfPlane(dolfinx, response)
    loaded.load(EdgeTraction(-1.0, 0.0, 0.0))
    np.testing.assert_allclose(loaded.resultants, -2.0, rtol=1e-12)
    loaded.destroy()


SMALL = {"motion.c": 0.6, "solve.tolerance": 1e-3}


def test_a_scene_has_the_same_intensities_and_stresses_by_both_assemblers():
    ordinary, own = (
        computed("tables4_5", SMALL | {"solve.assembler": name}) for name in ("dolfinx", "tensor")
    )
    assert ordinary.verdict == own.verdict == "PASS"
    for path in ("states/fem/K_I_left", "states/fem/K_I_right", "surface/fem/sigma_XX"):
        size = np.nanmax(np.abs(own.data[path]))
        np.testing.assert_allclose(ordinary.data[path], own.data[path], atol=1e-9 * size, rtol=0.0)


TO_SUBSTRATE = {"layer[0].to": {"E": "2.5 GPa", "nu": 0.25, "rho": "1000 kg/m^3"}}


@pytest.mark.parametrize(
    "layer", [{}, *[TO_SUBSTRATE] * THOROUGH], ids=["uniform", *["graded"] * THOROUGH]
)
def test_layers_have_the_same_intensities_by_both_assemblers(layer):
    changes = {"solve.methods": ["fem"], "solve.tolerance": 1e-2, "output.quantities": ["sif"]} | layer
    ordinary, own = (
        computed("coating", changes | {"solve.assembler": name}).data["states/fem/K_I_left"]
        for name in ("dolfinx", "tensor")
    )
    np.testing.assert_allclose(ordinary, own, rtol=1e-9)


@pytest.mark.parametrize(
    "scene, changes", [("start_from_rest", {}), ("traction", {"solve.pressure": [[-1, -1], [1, -1]]})]
)
def test_what_has_matrices_of_its_own_is_refused(scene, changes):
    methods = {"solve.methods": ["fem"], "solve.assembler": "dolfinx"}
    with pytest.raises(BadInput, match=r'solve.assembler.*"dolfinx"'):
        computed(scene, methods | changes)
