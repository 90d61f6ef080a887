"""Weak forms of the moving-frame equations (Eqs 15-16) in UFL, the one room that knows it.

Each is ∫ energy(u, w), bilinear in the gradients G along X and Y of a displacement u and a test function
w, with constants of the solid and its speed. :func:`weak_form` makes dolfinx's form of it, over ``dx``;
:func:`traction_form` is what a traction adds, over ``ds``.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import ufl
from numpy.typing import NDArray

from galinx.registry import Registry

#: Gradients with one entry 1, component by component, the others 0.
_UNITS = np.eye(4).reshape(4, 2, 2).tolist()


@dataclass(frozen=True)
class Form:
    """A weak form.

    Attributes:
        energy: the integrand of two gradients, or of two pairs of gradient and pressure, and of
            constants; bilinear and symmetric.
        constants: names of these in a solid's response.
        mixed: True where each cell has an unknown pressure besides the displacement.
    """

    energy: Callable[..., Any]
    constants: tuple[str, ...]
    mixed: bool = False

    def densities(self, constants: NDArray) -> NDArray[np.float64]:
        """The integrand at unit gradients, u,X u,Y v,X v,Y, and at unit pressure, by constants.

        Args:
            constants: in the form's order, (m, constants).

        Returns:
            Array (m, 4, 4) or (m, 5, 5).
        """
        rows, which = np.unique(constants, axis=0, return_inverse=True)
        return np.array([_density(self, tuple(row)) for row in rows.tolist()])[which]


@lru_cache(maxsize=1024)
def _density(form: Form, constants: tuple[float, ...]) -> NDArray[np.float64]:
    units: list[Any] = [ufl.as_matrix(unit) for unit in _UNITS]
    if form.mixed:
        zero = ufl.as_matrix([[0.0, 0.0], [0.0, 0.0]])
        units = [(G, 0.0) for G in units] + [(zero, 1.0)]
    H = np.zeros((len(units), len(units)))
    for i, u in enumerate(units):
        for j, w in enumerate(units[: i + 1]):
            H[i, j] = H[j, i] = ufl.as_ufl(form.energy(u, w, constants))(())
    return H


def stress(G: Any, κ: Any) -> Any:
    """Stresses over μ from the displacement gradient G (Eqs 6-8)."""
    λ = (3 - κ) / (κ - 1)  # Lamé's first constant over μ
    ε = ufl.sym(G)
    return 2 * ε + λ * ufl.tr(ε) * ufl.Identity(2)


def moving(Gu: Any, Gw: Any, constants: Any) -> Any:
    """σ(u):ε(w)/μ - c² u,X·w,X, positive below the Rayleigh speed; constants κ and c.

    On Y = 0 the inertia term leaves no boundary term.
    """
    κ, c = constants
    return ufl.inner(stress(Gu, κ), ufl.sym(Gw)) - _inertia(Gu, Gw, c)


def anisotropic(Gu: Any, Gw: Any, constants: Any) -> Any:
    """σ(u):ε(w)/c₆₆ - c² u,X·w,X of any solid: six stiffnesses over c₆₆, and c over √(c₆₆/ρ)."""
    c11, c12, c16, c22, c26, c66, c = constants
    C = ufl.as_matrix([[c11, c12, c16], [c12, c22, c26], [c16, c26, c66]])
    strain, other = (ufl.as_vector([G[0, 0], G[1, 1], G[0, 1] + G[1, 0]]) for G in (Gu, Gw))
    return ufl.dot(ufl.dot(C, strain), other) - _inertia(Gu, Gw, c)


def mixed(trial: tuple[Any, Any], test: tuple[Any, Any], constants: Any) -> Any:
    """Energy with an unknown p = -λ div u/μ (times the chart's stretch), for ν up to 1/2.

    2 ε(u):ε(w) - c² u,X·w,X - p div w - q div u - (μ/λ) p q, symmetric and indefinite. Where the
    displacement alone carries λ, rounding grows with it.
    """
    (Gu, p), (Gw, q), (κ, c) = trial, test, constants
    compliance = (κ - 1) / (3 - κ)  # μ/λ
    energy = 2 * ufl.inner(ufl.sym(Gu), ufl.sym(Gw)) - _inertia(Gu, Gw, c)
    return energy - p * ufl.tr(Gw) - q * ufl.tr(Gu) - compliance * p * q


def gradient(u: Any, x: Any, chart: Any, plane: tuple[Any, Any]) -> Any:
    """∇u along X and Y on a mesh that is drawn in a conformal chart of the plane X + pY.

    Times the chart's stretch and over the root of the plane's, which make ∫ … dX dY an integral over the
    chart: a conformal chart turns gradients, and leaves no other trace.

    Args:
        u: displacement.
        x: coordinates of the mesh.
        chart: see :class:`galinx.meshes.charts.Chart`.
        plane: Re p and Im p.
    """
    cos, sin = chart.rotation(x, ufl)
    turned = ufl.as_matrix([[cos, sin], [-sin, cos]])
    contracted = ufl.as_matrix([[1.0, plane[0]], [0.0, plane[1]]])
    return ufl.grad(u) * turned * contracted / ufl.sqrt(plane[1])


def weak_form(
    form: Form, spaces: Sequence[Any], chart: Any, plane: tuple[Any, Any], constants: Sequence[Any],
    size: Any, degree: int,
) -> list[list[Any]]:  # fmt: skip
    """∫ energy(u, w) dx as bilinear forms of dolfinx, by the spaces of test and trial functions.

    Args:
        form: the weak form with its energy.
        spaces: of the displacement, and of the pressure where the form has one.
        chart: in which the mesh is drawn.
        plane: Re p and Im p of the plane X + pY that is drawn.
        constants: of the form, in its order: numbers or functions of dolfinx.
        size: of cells, by which pressures are divided; not used without pressures.
        degree: of quadrature.
    """
    dx = ufl.dx(metadata={"quadrature_degree": degree})
    x = ufl.SpatialCoordinate(spaces[0].mesh)
    trials, tests = ([of(space) for space in spaces] for of in (ufl.TrialFunction, ufl.TestFunction))
    if not form.mixed:
        Gu, Gw = (gradient(of[0], x, chart, plane) for of in (trials, tests))
        return [[form.energy(Gu, Gw, constants) * dx]]

    def parts(functions: Sequence[Any]) -> list[tuple[Any, Any]]:
        u, p = functions
        still = ufl.as_matrix([[0.0, 0.0], [0.0, 0.0]])
        return [(gradient(u, x, chart, plane), 0.0), (still, p / size)]

    return [[form.energy(u, w, constants) * dx for u in parts(trials)] for w in parts(tests)]


def traction_form(
    space: Any, traction: Callable[[Any, Any], Any], chart: Any, facets: Any, tag: int, degree: int
) -> Any:
    """∫ σ w_Y dX over the contact, a linear form of dolfinx; σ_XY = g σ_YY has g times the same along X.

    Args:
        space: of the displacement.
        traction: σ by the distances over a from the left and the right punch edge.
        chart: in which the mesh is drawn.
        facets, tag: tags of facets, and that of the contact.
        degree: of quadrature.
    """
    ds = ufl.Measure("ds", subdomain_data=facets, metadata={"quadrature_degree": degree})
    w, x = ufl.TestFunction(space), ufl.SpatialCoordinate(space.mesh)
    from_left, from_right, stretch = chart.under_punch(*chart.from_edges(x), ufl)
    return traction(from_left, from_right) * w[1] * stretch * ds(tag)


def _inertia(Gu: Any, Gw: Any, c: Any) -> Any:
    return c**2 * ufl.inner(Gu[:, 0], Gw[:, 0])


#: Forms by the name that a solid gives.
FORMS: Registry[Form] = Registry(
    "weak form",
    {
        "isotropic": Form(moving, ("κ", "c")),
        "anisotropic": Form(anisotropic, ("c11", "c12", "c16", "c22", "c26", "c66", "c")),
        "nearly incompressible": Form(mixed, ("κ", "c"), mixed=True),
    },
    Form,
)
