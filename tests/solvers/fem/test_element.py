"""Element matrices by tensor products against dolfinx's own assembly of the weak forms."""

import numpy as np
import pytest
import ufl
from dolfinx import fem
from dolfinx.fem import petsc
from support import space_on

from galinx.meshes.rings import Refinement
from galinx.solvers.fem.forms import FORMS
from galinx.solvers.solids.isotropic import Isotropic, MovingFrame
from galinx.solvers.solids.plane import Orthotropic

DEGREE = 3
FIBRES = Orthotropic(14e9, 1e9, 1e9, 0.3, 0.3, 0.4, 0.7e9, 1.5e3, np.radians(30.0)).response(0.3)
CASES = [
    ("isotropic", MovingFrame(2.2, 0.6)),
    ("anisotropic", FIBRES),
    ("nearly incompressible", Isotropic(1e9, 0.499, 1e3).response(0.4)),
]


def pressures(mesh):
    """Discontinuous pressures, two degrees below the displacement."""
    try:
        from basix.ufl import element
    except ImportError:
        return fem.FunctionSpace(mesh, ("DQ", DEGREE - 2))
    return fem.functionspace(mesh, element("Lagrange", "quadrilateral", DEGREE - 2, discontinuous=True))


def assembled(form):
    matrix = petsc.assemble_matrix(fem.form(form))
    matrix.assemble()
    return matrix[:, :]


def gradient(u, space, p):
    """Along the physical axes, times the stretch of the chart and the root of the plane's."""
    rotation = ufl.Identity(2)
    if space.chart.name == "confocal":
        ξ, η = ufl.SpatialCoordinate(space.mesh)
        A, B = ufl.sinh(ξ) * ufl.cos(η), ufl.cosh(ξ) * ufl.sin(η)
        rotation = ufl.as_matrix([[A, -B], [B, A]]) / ufl.sqrt(A**2 + B**2)
    plane = ufl.as_matrix([[1.0, p.real], [0.0, p.imag]])
    return ufl.grad(u) * ufl.transpose(rotation) * plane / np.sqrt(p.imag)


def constants(response):
    """The plane's stiffness over c₆₆ without inertia."""
    if isinstance(response, MovingFrame):
        λ = (3.0 - response.κ) / (response.κ - 1.0)
        return λ + 2.0, λ, 0.0, λ + 2.0, 0.0, 1.0
    return [getattr(response, name) for name in ("c11", "c12", "c16", "c22", "c26", "c66")]


def dense(space, response):
    """The moving-frame form on a space, all unknowns but the pressures, which are eliminated."""
    u, w = ufl.TrialFunction(space.V), ufl.TestFunction(space.V)
    p = response.contraction if space.chart.contracts else 1j
    Gu, Gw = gradient(u, space, p), gradient(w, space, p)
    dx = ufl.dx(metadata={"quadrature_degree": 2 * DEGREE + 2})
    inertia = response.c**2 * ufl.inner(Gu[:, 0], Gw[:, 0])
    if not space.mixed:
        c11, c12, c16, c22, c26, c66 = constants(response)
        γ = Gu[0, 1] + Gu[1, 0]
        σ_XX = c11 * Gu[0, 0] + c12 * Gu[1, 1] + c16 * γ
        σ_YY = c12 * Gu[0, 0] + c22 * Gu[1, 1] + c26 * γ
        σ_XY = c16 * Gu[0, 0] + c26 * Gu[1, 1] + c66 * γ
        energy = σ_XX * Gw[0, 0] + σ_YY * Gw[1, 1] + σ_XY * (Gw[0, 1] + Gw[1, 0])
        return assembled((energy - inertia) * dx)
    P = pressures(space.mesh)
    q, κ = ufl.TestFunction(P), response.κ
    twice = ufl.inner(Gu + ufl.transpose(Gu), (Gw + ufl.transpose(Gw)) / 2.0)
    K = assembled((twice - inertia) * dx)
    B = assembled(-q * ufl.tr(Gu) * dx)
    C = assembled(-(κ - 1.0) / (3.0 - κ) * ufl.TrialFunction(P) * q * dx)
    return K - B.T @ np.linalg.solve(C, B)


def without(K, gone):
    """The Schur complement of some unknowns, and the unknowns that are left."""
    left = np.setdiff1d(np.arange(len(K)), gone)
    return K[np.ix_(left, left)] - K[np.ix_(left, gone)] @ np.linalg.solve(
        K[np.ix_(gone, gone)], K[np.ix_(gone, left)]
    ), left


@pytest.mark.parametrize("mesh", ["confocal", "graded"])
@pytest.mark.parametrize("form, response", CASES, ids=[name for name, _ in CASES])
def test_condensed_matrices_are_those_of_the_weak_form(mesh, form, response):
    space = space_on(mesh, Refinement(2, 0.3, 1, (1.0,) * 3), DEGREE, form=form)
    found = space.assemble(response)[:, :]
    nodes = 2 * np.count_nonzero(space.numbers >= 0)
    if space.mixed:
        found, _ = without(found, np.arange(nodes, len(found)))
    inner = np.flatnonzero(space.numbers < 0)
    wanted, left = without(dense(space, response), np.concatenate([2 * inner, 2 * inner + 1]))
    order = np.empty(nodes, dtype=int)
    order[space.numbers[left // 2] + left % 2] = np.arange(nodes)
    wanted = wanted[np.ix_(order, order)]
    np.testing.assert_allclose(found, wanted, atol=2e-12 * np.abs(wanted).max(), rtol=0.0)


def test_values_inside_cells_follow_from_those_on_their_boundaries():
    """A linear field is a solution at rest."""
    space, response = space_on("graded", Refinement(2, 0.3, 1, (1.0, 1.0)), 4), MovingFrame(2.2, 0.0)
    x = space.coordinates
    u = np.stack([0.3 * x[:, 0] - 0.2 * x[:, 1], 0.7 * x[:, 1] + 0.1 * x[:, 0] + 2.0], axis=-1)
    at = u[space._cell_nodes]
    found = space.extended(at[:, space.kernel.outer, :, None], response, np.arange(len(at)))
    np.testing.assert_allclose(found[..., 0], at, atol=1e-12 * np.abs(u).max())


κ, C = 2.2, 0.6
K, COUPLING = (κ + 1.0) / (κ - 1.0), 2.0 / (κ - 1.0)


@pytest.mark.parametrize(
    "name, constants",
    [("isotropic", [κ, C]), ("anisotropic", [K, K - 2.0, 0.0, K, 0.0, 1.0, C])],
    ids=["isotropic", "anisotropic"],
)
def test_the_weak_form_has_the_coefficients_of_eqs_15_and_16(name, constants):
    """Integration by parts makes u,XX, u,YY, v,XX, v,YY and both mixed derivatives of its energy."""
    (H,) = FORMS[name].densities(np.array([constants]))  # of u,X u,Y v,X v,Y
    np.testing.assert_allclose(np.diag(H), [K - C**2, 1.0, 1.0 - C**2, K], rtol=1e-14)
    assert H[0, 3] + H[1, 2] == pytest.approx(COUPLING, rel=1e-14)  # v,XY in Eq 15, u,XY in Eq 16
    np.testing.assert_allclose(H[[0, 0, 3, 3], [1, 2, 1, 2]], 0.0, atol=1e-15)
    np.testing.assert_array_equal(H, H.T)
