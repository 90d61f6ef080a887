"""Isotropic elastic solids, their wave speeds and the constants of the moving frame.

Symbols follow the study: κ is Kolosov's constant (Eq 1), c = V/c_s the speed over the shear wave
speed, β_s and β_d the contraction factors of shear and dilatational waves.
"""

from dataclasses import dataclass
from functools import cached_property
from math import inf, log, pi, sqrt
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from galinx.texts import with_prefix

from ..approximation import bisected
from ..parameters import parameter
from .admittance import Admittance
from .half_plane import Roots, UniformHalfPlane, Waves
from .solid import Solid, density, in_plane, modulus

#: κ - 1 below which finite elements make the pressure an unknown of its own: ν > 0.49 in plane strain.
INCOMPRESSIBLE = 0.04


@dataclass(frozen=True)
class Isotropic(Solid):
    """An isotropic elastic solid in plane strain or plane stress.

    Raises:
        ValueError: a constant is outside its range; the message names value and range.
    """

    about: ClassVar[str] = "isotropic"

    E: float = modulus("E", "Young's modulus")
    ν: float = parameter("nu", "Poisson's ratio", symbol=r"\nu", above=-1.0, at_most=0.5)
    ρ: float = density()
    plane: str = in_plane()

    @property
    def μ(self) -> float:
        """Shear modulus [Pa]."""
        return self.E / (2.0 * (1.0 + self.ν))

    @property
    def κ(self) -> float:
        """Kolosov's constant, dimensionless (Eq 1)."""
        if self.plane == "strain":
            return 3.0 - 4.0 * self.ν
        return (3.0 - self.ν) / (1.0 + self.ν)

    @property
    def nearly_incompressible(self) -> bool:
        """True near ν = 1/2 in plane strain."""
        return self.κ - 1.0 < INCOMPRESSIBLE

    @property
    def form(self) -> str:
        """The weak form that finite elements solve."""
        return "nearly incompressible" if self.nearly_incompressible else "isotropic"

    def limit(self) -> float:
        """Rayleigh speed over the shear wave speed."""
        return rayleigh_speed(self.κ)

    def flutter(self, c: float = 0.0) -> tuple[float, float]:
        """Least σ_XY/σ_YY of either sign from which on short waves grow: 1 for ν > 0, else infinite.

        By n and q the condition is β_d = ∓ i g (2w - 1), with w = (1 + k - k c²)/(1 + β_s β_d).
        Between c_s and c_d, g is real at c² = 2 alone, where it is 1; that is below c_d² = 1/k for ν > 0.
        """
        g = 1.0 if self.ν > 0.0 else inf
        return g, g

    def response(self, c: float, a: float = 1.0) -> "MovingFrame":
        """The half-plane at a speed over the shear wave speed; it has no length, whatever a is."""
        return MovingFrame(self.κ, c)

    def σ_ZZ(self, σ_XX: NDArray, σ_YY: NDArray, σ_XY: NDArray) -> NDArray[np.float64]:
        """Normal stress out of the plane: ν(σ_XX + σ_YY), or 0 in plane stress."""
        return (self.ν if self.plane == "strain" else 0.0) * (σ_XX + σ_YY)

    def words(self) -> str:
        return (
            f"E = {with_prefix(self.E, 'Pa')}, ν = {self.ν:g}, ρ = {self.ρ:g} kg/m³ in plane {self.plane}"
        )


@dataclass(frozen=True)
class MovingFrame(UniformHalfPlane):
    """Isotropic half-plane seen from a load that moves at c times the shear wave speed.

    The Rayleigh function R = 4 β_s β_d - (2 - c²)² is O(c²) at slow speed and would lose all
    digits there, so R/c² is used in a form without cancellation.

    Args:
        κ: Kolosov's constant, dimensionless, κ >= 1 (below 1 only for ν > 1/2).
        c: speed over shear wave speed, dimensionless, 0 <= c < 1.

    Raises:
        ValueError: κ or c is outside its range.
    """

    κ: float
    c: float

    #: Slope v,X by the Hilbert transform of σ_XY: none, for the solid is its own mirror image.
    n12 = 0.0
    mirrored = True

    def __post_init__(self) -> None:
        if not 0.0 <= self.c < 1.0:
            raise ValueError(f"c = {self.c!r}: expected 0 <= c < 1, the punch must be subsonic")
        if not 1.0 <= self.κ < float("inf"):
            raise ValueError(f"κ = {self.κ!r}: expected a finite number >= 1")

    @cached_property
    def k(self) -> float:
        """(c_s/c_d)² = (κ-1)/(κ+1)."""
        return (self.κ - 1.0) / (self.κ + 1.0)

    @cached_property
    def β_s(self) -> float:
        """√(1 - c²)."""
        return sqrt((1.0 - self.c) * (1.0 + self.c))

    @cached_property
    def β_d(self) -> float:
        """√(1 - k c²)."""
        return sqrt(1.0 - self.k * self.c**2)

    @cached_property
    def _w(self) -> float:
        """(1 + k - k c²)/(1 + β_s β_d), the common term of r and q."""
        return (1.0 + self.k - self.k * self.c**2) / (1.0 + self.β_s * self.β_d)

    @cached_property
    def r(self) -> float:
        """Rayleigh function over c²; 2(1 - k) at rest, 0 at the Rayleigh speed, negative beyond."""
        return 4.0 - self.c**2 - 4.0 * self._w

    @cached_property
    def n(self) -> float:
        """Slope v,X by the Hilbert transform of σ_YY; (κ+1)/4 at rest."""
        return self.β_d / self.r

    @cached_property
    def q(self) -> float:
        """Coupling of normal and tangential directions; (κ-1)/4 at rest."""
        return (2.0 * self._w - 1.0) / self.r

    @cached_property
    def m(self) -> float:
        """Strain u,X by the Hilbert transform of σ_XY; (κ+1)/4 at rest."""
        return self.β_s / self.r

    @property
    def margin(self) -> float:
        """Rayleigh function over its value at rest; 0 at the Rayleigh speed."""
        return self.r / MovingFrame(self.κ, 0.0).r

    @property
    def contraction(self) -> complex:
        """i√(β_s β_d), midway between iβ_s and iβ_d in the hyperbolic metric of the half-plane."""
        return 1j * sqrt(self.β_s * self.β_d)

    @property
    def spread(self) -> float:
        """log β_d/β_s, to all digits."""
        return log(self.β_d / self.β_s)

    def σ_XX(self, u_X: Any, σ_YY: Any, σ_XY: Any) -> Any:
        """In-plane stress on the surface: v,Y eliminated between Eqs 6 and 7."""
        κ = self.κ
        return 8.0 / (κ + 1.0) * u_X + (3.0 - κ) / (κ + 1.0) * σ_YY

    def stresses(self, G: NDArray) -> NDArray[np.float64]:
        """Hooke's law (Eqs 6-8), κ > 1: σ_XX, σ_YY, σ_XY over μ of displacement gradients (..., 2, 2)."""
        u_X, v_Y = G[..., 0, 0], G[..., 1, 1]
        λ_div = (3.0 - self.κ) / (self.κ - 1.0) * (u_X + v_Y)
        return np.array([2.0 * u_X + λ_div, 2.0 * v_Y + λ_div, G[..., 0, 1] + G[..., 1, 0]])

    @cached_property
    def G(self) -> NDArray[Any]:
        """Matrix of u,Y = G u,X of decaying fields, (2, 2); regular up to ν = 1/2 and at rest."""
        s, d, k, w = self.β_s, self.β_d, self.k, self._w
        across = (1.0 - k) / ((s + d) * w)
        return np.array([[1j * d / w, -s * across], [-d * across, 1j * s * k / w]])

    @cached_property
    def C(self) -> NDArray[np.float64]:
        """Stiffness over μ: σ_XX, σ_YY, σ_XY by ε_XX, ε_YY, 2ε_XY, (3, 3); infinite at ν = 1/2."""
        λ = (3.0 - self.κ) / (self.κ - 1.0) if self.k else inf
        return np.array([[2.0 + λ, λ, 0.0], [λ, 2.0 + λ, 0.0], [0.0, 0.0, 1.0]])

    @property
    def admittance(self) -> Admittance:
        """Admittance of the surface at all speeds."""
        (c11, c12, _), *_ = self.C.tolist()
        return IsotropicAdmittance(c11, c12, 0.0, c11, 0.0)

    @cached_property
    def Y(self) -> NDArray[Any]:
        """Admittance of the surface by n, q and m, which keep their digits near the Rayleigh speed."""
        return np.array([[-1j * self.m, self.q], [-self.q, -1j * self.n]])

    @cached_property
    def L(self) -> NDArray[Any]:
        """Stiffness of the surface, (σ_XY, σ_YY) = L u,X of decaying fields, (2, 2); regular as G."""
        s, d, w = self.β_s, self.β_d, self._w
        coupling = 1.0 - s * (1.0 - self.k) / ((s + d) * w)
        return np.array([[1j * d / w, coupling], [-coupling, 1j * s / w]])

    @cached_property
    def T_inverse(self) -> NDArray[np.float64]:
        """Inverse of the stiffness across, diag(1, λ + 2), (2, 2)."""
        return np.diag([1.0, self.k])

    @cached_property
    def roots(self) -> Roots:
        """Roots iβ_s and iβ_d by their sum and product."""
        return Roots(1j * (self.β_s + self.β_d), complex(-self.β_s * self.β_d))

    @property
    def ω(self) -> tuple[float, float, float, float]:
        """ω₁ … ω₄ of the study (Eqs 31, 33), with the signs of the relations above."""
        scale = 4.0 / (self.κ + 1.0)
        return scale * self.n / pi, scale * self.q, scale * self.m / pi, scale * self.q


class IsotropicAdmittance(Admittance):
    """Admittance of the surface of an isotropic solid, whose waves keep their digits up to ν = 1/2."""

    mirrored = property(lambda self: self)  # type: ignore[assignment]

    def waves(self, C: NDArray) -> Waves:
        """Two waves with Im p > 0 at speeds C, (n,), by the formulas of :class:`MovingFrame`."""
        C, k = np.asarray(C, dtype=complex), 1.0 / self.c11
        # At real speeds the waves are those of Im C -> -0.
        C2 = np.where(C.imag == 0.0, C - 1j * np.finfo(float).tiny, C) ** 2
        s, d = np.sqrt(1.0 - C2), np.sqrt(1.0 - k * C2)
        w = (1.0 + k - k * C2) / (1.0 + s * d)
        across = (1.0 - k) / ((s + d) * w)
        matrices = [[1j * d / w, -s * across], [-d * across, 1j * s * k / w]], [
            [1j * d / w, 1.0 - s * across], [s * across - 1.0, 1j * s / w],
        ]  # fmt: skip
        G, L = (np.moveaxis(np.array(of), 2, 0) for of in matrices)
        return Waves(Roots(1j * (s + d), -s * d), G, L)

    @cached_property
    def meeting(self) -> NDArray[np.float64]:
        """Wave speeds over that of shear waves; that of dilatational ones is left out at ν = 1/2."""
        return np.sqrt([1.0, self.c11][: 2 if np.isfinite(self.c11) else 1])


def rayleigh_speed(κ: float) -> float:
    """Rayleigh speed over shear wave speed, dimensionless, of a solid with Kolosov's constant κ.

    The zero in (0, 1) of R(c)/c², found to the last digits.
    """
    return bisected(lambda c: MovingFrame(κ, c).r > 0.0, 1.0 - 1e-15)
