"""Isotropic elastic solids, their wave speeds and the constants of the moving frame.

Symbols follow the study: κ is Kolosov's constant (Eq 1), c = V/c_s the speed over the shear wave
speed, β_s and β_d the contraction factors of shear and dilatational waves.
"""

from dataclasses import dataclass
from functools import cached_property
from math import pi, sqrt


@dataclass(frozen=True)
class Solid:
    """An isotropic elastic solid in plane strain or plane stress.

    Args:
        E: Young's modulus [Pa], positive.
        ν: Poisson's ratio, dimensionless, -1 < ν <= 1/2.
        ρ: density [kg/m³], positive.
        plane: ``"strain"`` or ``"stress"``.

    Raises:
        ValueError: a constant is outside its range; the message names value and range.
    """

    E: float
    ν: float
    ρ: float
    plane: str = "strain"

    def __post_init__(self) -> None:
        for name in ("E", "ρ"):
            value = getattr(self, name)
            if not 0.0 < value < float("inf"):
                raise ValueError(f"{name} = {value!r}: expected a finite positive number")
        if not -1.0 < self.ν <= 0.5:
            raise ValueError(f"ν = {self.ν!r}: expected -1 < ν <= 0.5")
        if self.plane not in ("strain", "stress"):
            raise ValueError(f"plane = {self.plane!r}: expected 'strain' or 'stress'")

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
    def c_s(self) -> float:
        """Shear wave speed [m/s]."""
        return sqrt(self.μ / self.ρ)


@dataclass(frozen=True)
class MovingFrame:
    """Constants of a half-plane seen from a load that moves at c times the shear wave speed.

    The surface answers tractions with (H is the Hilbert transform over the contact)::

        μ v,X = n H[σ_YY] - q σ_XY
        μ u,X = q σ_YY + m H[σ_XY]

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
    def e(self) -> float:
        """1 + β_s² = 2 - c²."""
        return 2.0 - self.c**2

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
    def ω(self) -> tuple[float, float, float, float]:
        """ω₁ … ω₄ of the study (Eqs 31, 33), with the signs of the relations above."""
        scale = 4.0 / (self.κ + 1.0)
        return scale * self.n / pi, scale * self.q, scale * self.m / pi, scale * self.q


def rayleigh_speed(κ: float) -> float:
    """Rayleigh speed over shear wave speed, dimensionless, of a solid with Kolosov's constant κ.

    The zero in (0, 1) of R(c)/c², found to the last digits.
    """
    from scipy.optimize import brentq  # slow to import, and seldom needed

    return brentq(lambda c: MovingFrame(κ, c).r, 0.1, 1.0 - 1e-15, xtol=1e-16, rtol=1e-15)
