"""Protocols of elastic solids at rest and at speed, and the fields that several kinds of solid share."""

from collections.abc import Sequence
from typing import Any, ClassVar, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from galinx.registry import Registry

from ..parameters import choice, parameter


class Potential(Protocol):
    """Φ(z) = (1/π) ∫ σ_YY(t)/(t - z) dt below the surface, Im z < 0, of a pressure under the punch.

    On the surface -Im Φ is the pressure and Re Φ its Hilbert transform.
    """

    def at(self, z: NDArray) -> NDArray[np.complex128]:
        """Φ(z)."""

    def change(self, z: NDArray, step: NDArray, share: complex) -> NDArray[np.complex128]:
        """(Φ(z + share·step) - Φ(z))/share without cancellation; its limit where ``share`` is 0.

        The step is short, over the distances of both places from the contact:
        :func:`galinx.solvers.solids.potentials.value_and_change` takes others.
        """


class Response(Protocol):
    """A half-plane of a solid seen from a load that moves over it, lengths over a, stresses over N/(2a).

    Its surface answers tractions with (H is the Hilbert transform over the contact)::

        μ v,X = n H[σ_YY] + n₁₂ H[σ_XY] - q σ_XY
        μ u,X = q σ_YY + n₁₂ H[σ_YY] + m H[σ_XY]

    Attributes:
        c: speed over the solid's wave speed, dimensionless.
        n, m, n12, q: of the surface, dimensionless.
        margin: 1 at rest, 0 at the highest speed that finite elements can solve, negative beyond;
            displacements grow as it falls.
        contraction: p of the plane X + pY, Im p > 0, midway between those in which the fields are
            analytic; 1j at rest in an isotropic solid.
        spread: hyperbolic distance of the two p, 0 where they meet.
        mirrored: True if the solid is its own mirror image in X = 0.
    """

    @property
    def c(self) -> float: ...
    @property
    def n(self) -> float: ...
    @property
    def m(self) -> float: ...
    @property
    def n12(self) -> float: ...
    @property
    def q(self) -> float: ...
    @property
    def margin(self) -> float: ...
    @property
    def contraction(self) -> complex: ...
    @property
    def spread(self) -> float: ...
    @property
    def mirrored(self) -> bool: ...

    def σ_XX(self, u_X: NDArray, σ_YY: NDArray, σ_XY: NDArray) -> NDArray[np.float64]:
        """In-plane stress σ_XX from the strain μ u,X and the other stresses, of one shape."""

    def stresses(self, G: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY, (3, ...), of displacement gradients μ ∂u_i/∂X_j (..., 2, 2)."""

    def inside(self, Φ: Potential, g: Any, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY, (3, ...), below a pressure.

        Args:
            Φ: its potential.
            g: σ_XY/σ_YY on the surface.
            X, Y: positions, Y < 0.
        """


@runtime_checkable
class Far(Protocol):
    """A response with displacements far from the contact."""

    def far(self, X: NDArray, Y: NDArray, terms: int) -> NDArray[np.float64]:
        """Displacements μ u far away, (terms, 2, 2, n), of the first moments of σ_YY and of σ_XY.

        Args:
            X, Y: positions over a, (n,).
            terms: number of moments, the resultants first.
        """


@runtime_checkable
class ByCells(Protocol):
    """A response whose constants in the weak form change with depth: solids one below another."""

    def constants(self, names: Sequence[str]) -> list[NDArray[np.float64]]:
        """The weak form's constants in each solid from the top down, (n, names) each.

        They are given at :func:`galinx.solvers.approximation.chebyshev_points` of the share of the
        change from the solid's upper face to its lower one; at a single point where the solid is uniform.

        Args:
            names: names of the constants in the form.
        """

    def solids(self, Y: NDArray, side: int = 1) -> NDArray[np.int64]:
        """Numbers of the solids at heights over a, of the shape of ``Y``.

        Args:
            Y: heights.
            side: at an interface 1 for the solid above it, -1 for the solid below.
        """

    def share(self, solid: int, Y: NDArray) -> NDArray[np.float64]:
        """Share of a graded solid's change at heights over a in it, 0 to 1, of the shape of ``Y``."""

    def stresses_at(self, solid: NDArray, Y: NDArray, G: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY of displacement gradients in solids at heights.

        Args:
            solid, Y: numbers of the solids, and heights over a, (n,).
            G: μ ∂u_i/∂X_j, (..., n, 2, 2).

        Returns:
            Array (3, ..., n).
        """


class Solid(Protocol):
    """An elastic solid: a dataclass whose fields are :func:`galinx.solvers.parameters.parameter`.

    Attributes:
        about: kind of solid.
        form: name of the weak form that finite elements solve, see :mod:`galinx.solvers.fem.forms`; its
            constants are attributes of the response.
        nearly_incompressible: displacements alone would lose digits; the form has an unknown pressure.
        plane: ``"strain"`` or ``"stress"``.
        μ: modulus that stresses are divided by [Pa].
        ρ: density [kg/m³].
        c_s: wave speed that c refers to [m/s].
    """

    about: ClassVar[str]

    @property
    def form(self) -> str: ...
    @property
    def nearly_incompressible(self) -> bool: ...
    @property
    def plane(self) -> str: ...
    @property
    def μ(self) -> float: ...
    @property
    def ρ(self) -> float: ...
    @property
    def c_s(self) -> float: ...

    @property
    def knows_σ_ZZ(self) -> bool:
        """True if the constants are enough for :meth:`σ_ZZ`, which is NaN otherwise."""

    @property
    def flutter(self) -> tuple[float, float]:
        """Least σ_XY/σ_YY > 0, and least -σ_XY/σ_YY > 0, from which on short waves along a surface that
        slides on something rigid grow; infinite for none, see
        :func:`galinx.solvers.transient.admittance.thresholds`."""

    def limit(self) -> float:
        """Highest speed over ``c_s``: that of a wave along the surface."""

    def response(self, c: float) -> Response:
        """The half-plane at a speed over ``c_s``.

        Raises:
            ValueError: waves in the solid are not faster.
        """

    def σ_ZZ(self, σ_XX: NDArray, σ_YY: NDArray, σ_XY: NDArray) -> NDArray[np.float64]:
        """Normal stress out of the plane, of one shape and unit with the others."""

    def words(self) -> str:
        """The solid in a sentence's middle, with units."""


#: Solids by the name that scenes use; every solid adds itself.
SOLIDS: Registry[type[Solid]] = Registry("kind of solid", kind=Solid)


#: Where stiffnesses usually lie [Pa].
USUAL_STIFFNESS = (1e3, 2e12)


def modulus(key: str, about: str, symbol: str = "") -> Any:
    """Field of a positive stiffness [Pa]."""
    return parameter(key, about, "Pa", symbol=symbol, above=0.0, usual=USUAL_STIFFNESS)


def density() -> Any:
    """Field of the density ρ [kg/m³]."""
    return parameter("rho", "density", "kg/m^3", symbol=r"\rho", above=0.0, usual=(1.0, 3e4))


def angle(axis: str) -> Any:
    """Field of the angle from X to an axis of the solid [°]."""
    note = "counterclockwise, Y upwards"
    return parameter("angle", f"angle from X to {axis}", "deg", symbol=r"\theta", default=0.0, note=note)


def in_plane() -> Any:
    """Field of the choice between plane strain and plane stress."""
    note = '`"stress"` is a thin sheet'
    return choice("plane", "plane strain or stress", ("strain", "stress"), note=note)
