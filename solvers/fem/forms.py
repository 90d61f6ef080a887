"""Weak forms of the moving-frame equations (Eqs 15-16) in UFL, the one room that knows it."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import ufl

from galinx.registry import Registry
from galinx.solvers.fem.chart import Chart


@dataclass(frozen=True)
class Form:
    """A weak form.

    Attributes:
        stiffness: the form from trial and test functions, what takes gradients, constants and degree.
        constants: what these are called in a solid's response.
        pressure: with an unknown pressure in each cell besides the displacement.
    """

    stiffness: Callable[..., Any]
    constants: tuple[str, ...]
    pressure: bool = False


def gradient(u: Any, chart: Chart, x: Any, p: Any) -> Any:
    """Gradient of u along the physical axes, up to the stretch of chart and plane: ∇u·Rᵀ·M.

    Args:
        u: the function.
        chart, x: the chart and its coordinates.
        p: real and imaginary part of the contraction, see :class:`galinx.solvers.fem.chart.Contracted`;
            its plane has Im p times the physical area.
    """
    cos, sin = chart.rotation(x, ufl)
    R, (lean, depth) = ufl.as_matrix([[cos, -sin], [sin, cos]]), p
    M = ufl.as_matrix([[1, lean], [0, depth]]) / ufl.sqrt(depth)
    return ufl.dot(ufl.dot(ufl.grad(u), ufl.transpose(R)), M)


def stress(G: Any, κ: Any) -> Any:
    """Stresses over μ from the displacement gradient G (Eqs 6-8)."""
    λ = (3 - κ) / (κ - 1)  # Lamé's first constant over μ
    ε = ufl.sym(G)
    return 2 * ε + λ * ufl.tr(ε) * ufl.Identity(2)


def moving_stiffness(u: Any, w: Any, grad: Any, constants: Any, degree: int) -> Any:
    """∫ σ(u):ε(w)/μ - c² u,X·w,X, symmetric, and positive below the Rayleigh speed; constants κ and c.

    On Y = 0 the inertia term leaves no boundary term. The integrand is not polynomial in a conformal
    chart; two degrees above the product of gradients integrate it as well as the space can tell.
    """
    κ, c = constants
    Gu, Gw = grad(u), grad(w)
    return _moving(ufl.inner(stress(Gu, κ), ufl.sym(Gw)), Gu, Gw, c, degree)


def anisotropic_stiffness(u: Any, w: Any, grad: Any, constants: Any, degree: int) -> Any:
    """The same of any solid; constants are its stiffness over c₆₆, six numbers, and c over √(c₆₆/ρ)."""
    c11, c12, c16, c22, c26, c66, c = constants
    Gu, Gw = grad(u), grad(w)
    C = ufl.as_matrix([[c11, c12, c16], [c12, c22, c26], [c16, c26, c66]])
    strain, other = (ufl.as_vector([G[0, 0], G[1, 1], G[0, 1] + G[1, 0]]) for G in (Gu, Gw))
    return _moving(ufl.dot(ufl.dot(C, strain), other), Gu, Gw, c, degree)


def _moving(energy: Any, Gu: Any, Gw: Any, c: Any, degree: int) -> Any:
    """The integral of an energy less the inertia of displacements with these gradients."""
    moving = energy - c**2 * ufl.inner(Gu[:, 0], Gw[:, 0])
    return moving * ufl.dx(metadata={"quadrature_degree": 2 * degree + 2})


def mixed_stiffness(
    trial: tuple[Any, Any], test: tuple[Any, Any], grad: Any, constants: Any, degree: int
) -> Any:
    """The same with an unknown p = -λ div u/μ (times the chart's stretch), for ν up to 1/2.

    ∫ 2 ε(u):ε(w) - c² u,X·w,X - p div w - q div u - (μ/λ) p q, symmetric and indefinite. Where the
    displacement alone carries λ, rounding grows with it.
    """
    (u, p), (w, q), (κ, c) = trial, test, constants
    Gu, Gw = grad(u), grad(w)
    compliance = (κ - 1) / (3 - κ)  # μ/λ
    energy = 2 * ufl.inner(ufl.sym(Gu), ufl.sym(Gw))
    energy -= p * ufl.tr(Gw) + q * ufl.tr(Gu) + compliance * p * q
    return _moving(energy, Gu, Gw, c, degree)


#: Forms by the name that a solid gives.
FORMS: Registry[Form] = Registry(
    "weak form",
    {
        "isotropic": Form(moving_stiffness, ("κ", "c")),
        "anisotropic": Form(anisotropic_stiffness, ("c11", "c12", "c16", "c22", "c26", "c66", "c")),
        "nearly incompressible": Form(mixed_stiffness, ("κ", "c"), pressure=True),
    },
)
