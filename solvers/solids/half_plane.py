"""Half-planes of elastic solids, seen from a load that moves over them, and the fields below pressures.

Fields that decay below the surface of a uniform solid have u,Y = G u,X and the tractions (σ_XY, σ_YY) =
L u,X. They are analytic in two complex planes X + pY; p, with Im p > 0, are eigenvalues of G, roots of
a quartic. Only their sum and product are computed, which stay smooth where the roots meet, as they do in
every isotropic solid at rest; and functions of the matrix G replace eigenvectors, so that nothing happens
there.

Below a pressure with the potential Φ, under friction g, strain is u,X = Re iΦ(X + Y G) 𝐘 (g, 1)ᵀ with
𝐘 = L⁻¹.

Displacements far from loads on the surface are those of line loads and of their moments. Tractions t(s)
at |s| <= a move a point z = X + Y G by

    u = Im[log(z) 𝐘 M₀ - Σ z⁻ⁿ 𝐘 Mₙ/n]/π,   Mₙ = ∫ sⁿ t ds,

where all |X + pY| > a.
"""

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.special import log1p


class Potential(Protocol):
    """Φ(z) = (1/π) ∫ σ_YY(t)/(t - z) dt below the surface, Im z < 0, of a pressure under the punch.

    On the surface -Im Φ is the pressure and Re Φ its Hilbert transform. Beside the contact Φ goes on
    above the surface.
    """

    def at(self, z: NDArray) -> NDArray[np.complex128]:
        """Φ(z)."""


@dataclass(frozen=True)
class Roots:
    """Two roots p₁, p₂ with Im p > 0.

    Attributes:
        sum, product: of the two; arrays for roots at many speeds.
    """

    sum: Any
    product: Any

    @cached_property
    def each(self) -> tuple[complex, complex]:
        """Roots p₁ and p₂, with half the digits where they meet."""
        middle = self.sum / 2.0
        half = np.sqrt(middle**2 - self.product + 0j)
        return complex(middle + half), complex(middle - half)

    @cached_property
    def midpoint(self) -> complex:
        """Point midway between the roots in the hyperbolic metric of the upper half-plane."""
        p, other = self.each
        moved = (other - p.real) / p.imag  # where p is at i
        ζ = (moved - 1j) / (moved + 1j)
        ζ /= 1.0 + np.sqrt(1.0 - abs(ζ) ** 2)
        return complex(p.real + p.imag * 1j * (1.0 + ζ) / (1.0 - ζ))

    @cached_property
    def apart(self) -> float:
        """Hyperbolic distance of the roots; 0 where they meet."""
        p, other = self.each
        return float(2.0 * np.arcsinh(abs(p - other) / (2.0 * np.sqrt(p.imag * other.imag))))


@dataclass(frozen=True)
class Waves:
    """Two of a uniform solid's four waves at given speeds, real or complex.

    Attributes:
        roots: their p, sum and product (n,).
        G: matrix of u,Y = G u,X, (n, 2, 2).
        L: matrix of tractions L u,X over μ, (n, 2, 2).
    """

    roots: Roots
    G: NDArray[np.complex128]
    L: NDArray[np.complex128]

    @property
    def conjugate(self) -> "Waves":
        """Other two waves, at the conjugate speeds."""
        roots = Roots(np.conj(self.roots.sum), np.conj(self.roots.product))
        return Waves(roots, self.G.conj(), self.L.conj())


def exponential(fields: Any, κ: NDArray) -> NDArray[np.complex128]:
    """Matrix exponential e^(iκG), (n, 2, 2), of fields with roots and G, in which these may meet.

    Args:
        fields: a half-plane, or :class:`Waves`.
        κ: with the sign with which the exponential decays, (n,).
    """
    middle = fields.roots.sum / 2.0
    half = np.sqrt(middle**2 - fields.roots.product + 0j)
    first, second = (np.exp(1j * κ * (middle + sign * half)) for sign in (1.0, -1.0))
    x = κ * half
    near = np.abs(x) < 0.5
    by_series = np.exp(1j * κ * middle) * κ * np.sinc(np.where(near, x, 0.0) / np.pi)
    by_difference = (first - second) / (2j * np.where(near, 1.0, half))
    change = np.where(near, by_series, by_difference)
    beyond = fields.G - np.asarray(middle)[..., None, None] * np.eye(2)
    mean = (first + second)[:, None, None] / 2.0 * np.eye(2)
    return np.asarray(mean + 1j * change[:, None, None] * beyond)


#: Distance over a of the surface to which displacements are relative: that of the study's walls.
DATUM = 100.0
#: Unit loads: ∫σ_YY = 1 and ∫σ_XY = 1, as (σ_XY, σ_YY).
LOADS = np.array([[0.0, 1.0], [1.0, 0.0]])


class HalfPlane:
    """A half-plane of a solid seen from a load that moves over it, lengths over a, stresses over N/(2a).

    Its surface answers tractions with (H is the Hilbert transform over the contact)::

        μ v,X = n H[σ_YY] + n₁₂ H[σ_XY] - q σ_XY
        μ u,X = q σ_YY + n₁₂ H[σ_YY] + m H[σ_XY]

    Attributes:
        c: speed over the wave speed of the solid at the surface, dimensionless.
        depths: of interfaces between solids, over a, (layers,); none in a uniform half-plane.
        c66, ρ: shear modulus and density over those of the surface's solid.
    """

    c: float

    c66 = 1.0
    ρ = 1.0

    @property
    def depths(self) -> NDArray[np.float64]:
        return np.empty(0)

    @property
    @abstractmethod
    def surface(self) -> "UniformHalfPlane":
        """Half-plane of the solid at the surface alone."""

    @property
    @abstractmethod
    def margin(self) -> float:
        """1 at rest, 0 at the limit, negative beyond; displacements grow as it falls."""

    @property
    @abstractmethod
    def mirrored(self) -> bool:
        """True if the half-plane is its own mirror image in X = 0."""

    @cached_property
    def n(self) -> float:
        """Slope v,X by the Hilbert transform of σ_YY."""
        return float(-self.surface.Y[1, 1].imag)

    @cached_property
    def m(self) -> float:
        """Strain u,X by the Hilbert transform of σ_XY."""
        return float(-self.surface.Y[0, 0].imag)

    @cached_property
    def n12(self) -> float:
        """Slope v,X by the Hilbert transform of σ_XY, and strain by that of σ_YY."""
        return float(-(self.surface.Y[0, 1] + self.surface.Y[1, 0]).imag / 2.0)

    @cached_property
    def q(self) -> float:
        """Strain u,X by σ_YY, slope -v,X by σ_XY."""
        return float((self.surface.Y[0, 1] - self.surface.Y[1, 0]).real / 2.0)

    def strain(self, g: Any, σ_YY: Any, H: Any) -> Any:
        """Strain μ u,X on the surface by σ_YY with the Hilbert transform H, and by σ_XY = g σ_YY."""
        of = self.surface
        with np.errstate(invalid="ignore"):  # NaN without friction at tips, where H is infinite
            return of.q * σ_YY + (of.n12 + of.m * g) * H

    def in_plane(self, g: Any, σ_YY: Any, H: Any, more: Any = 0.0) -> Any:
        """In-plane stress on the surface over N/(2a), by σ_YY with the Hilbert transform H and g σ_YY.

        ``more`` is the strain μ u,X over N/(2a) that layers, or friction that varies, add.
        """
        return self.σ_XX(self.strain(g, σ_YY, H) + more, σ_YY, g * σ_YY)

    @property
    def contraction(self) -> complex:
        """p of the plane X + pY midway between those of the fields; 1j in an isotropic solid at rest."""
        return self.surface.roots.midpoint

    @property
    def spread(self) -> float:
        """Hyperbolic distance of the p of the solid at the surface, 0 where they meet."""
        return self.surface.spread

    def σ_XX(self, u_X: Any, σ_YY: Any, σ_XY: Any) -> Any:
        """In-plane stress σ_XX on the surface from the strain μ u,X and the tractions, of one shape."""
        return self.surface.σ_XX(u_X, σ_YY, σ_XY)

    def stresses(self, G: NDArray) -> NDArray[np.float64]:
        """Hooke's law at the surface: σ_XX, σ_YY, σ_XY, (3, ...), by μ ∂u_i/∂X_j (..., 2, 2)."""
        return self.surface.stresses(G)

    def stresses_at(self, Y: NDArray, G: NDArray, side: int = 1) -> NDArray[np.float64]:
        """Hooke's law at heights: σ_XX, σ_YY, σ_XY, (3, ..., n).

        Args:
            Y: heights over a, not above 0, (n,).
            G: gradients μ ∂u_i/∂X_j there, (..., n, 2, 2).
            side: at an interface 1 for the solid above it, -1 for the solid below.
        """
        return self.stresses(G)

    def inside(self, Φ: Potential, g: Any, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY, (3, ...), below a pressure.

        Args:
            Φ: potential of the pressure.
            g: σ_XY/σ_YY on the surface; broadcasts against positions.
            X, Y: positions over a, Y < 0.

        Raises:
            ValueError: a point has Y >= 0; the surface has formulas of its own.
            NotImplementedError: the half-plane has layers, in which one potential is not enough.
        """
        return self.surface.inside(Φ, g, X, Y)

    def far(self, X: NDArray, Y: NDArray, terms: int = 1, datum: float = DATUM) -> NDArray[np.float64]:
        """Displacements μ u far away, (terms, 2, 2, n), of the first moments of σ_YY and of σ_XY.

        Args:
            X, Y: positions over a with Y <= 0, (n,).
            terms: number of moments: 1 for line loads alone, 2 for their first moment besides, …; over
                layers always 1.
            datum: distance over a at which a line load does not move the surface, the mean of both sides.
        """
        return self.surface.far(X, Y, terms, datum)

    def constants(self, names: Sequence[str]) -> list[NDArray[np.float64]]:
        """Constants of the weak form in each solid from the top down, (points, names) each.

        They are given at :func:`galinx.solvers.approximation.chebyshev_points` of the share of the change
        from the solid's upper face to its lower one; at a single point where the solid is uniform.

        Args:
            names: names of the constants in the form.
        """
        of = self.surface
        stiffness = dict(zip(("c11", "c12", "c16", "c22", "c26"), of.C[np.triu_indices(3)]))
        values = [stiffness[name] if name in stiffness else getattr(of, name) for name in names]
        return [np.array([values], dtype=float)]

    def solids(self, Y: NDArray, side: int = 1) -> NDArray[np.int64]:
        """Numbers of the solids at heights over a, of the shape of ``Y``; ``side`` as in stresses_at."""
        return np.zeros(np.shape(Y), dtype=np.int64)

    def share(self, solid: int, Y: NDArray) -> NDArray[np.float64]:
        """Share of a graded solid's change at heights over a in it, 0 to 1, of the shape of ``Y``."""
        return np.zeros(np.shape(Y))


class UniformHalfPlane(HalfPlane):
    """Half-plane of one solid; what is abstract determines all else."""

    @property
    @abstractmethod
    def C(self) -> NDArray[np.float64]:
        """Stiffness over μ: σ_XX, σ_YY, σ_XY by ε_XX, ε_YY, 2ε_XY, (3, 3)."""

    @property
    @abstractmethod
    def G(self) -> NDArray[Any]:
        """Matrix of u,Y = G u,X of decaying fields, (2, 2)."""

    @property
    @abstractmethod
    def L(self) -> NDArray[Any]:
        """Stiffness of the surface, (σ_XY, σ_YY) = L u,X of decaying fields, (2, 2)."""

    @cached_property
    def T_inverse(self) -> NDArray[np.float64]:
        """Inverse of the stiffness of the tractions σ_XY, σ_YY against u,Y, (2, 2)."""
        return np.asarray(np.linalg.inv(self.C[[[2], [1]], [2, 1]]), dtype=float)

    @property
    @abstractmethod
    def roots(self) -> Roots:
        """Roots p of the planes X + pY in which the fields are analytic, Im p > 0."""

    @property
    def surface(self) -> "UniformHalfPlane":
        return self

    @property
    def mirror_image(self) -> "UniformHalfPlane":
        """Half-plane of the solid's mirror image, in X = 0 or in Y = 0."""
        return self

    @cached_property
    def Y(self) -> NDArray[Any]:
        """Admittance 𝐘 of the surface, u,X = 𝐘 (σ_XY, σ_YY) of decaying fields, (2, 2)."""
        return np.linalg.inv(self.L)

    @property
    def spread(self) -> float:
        return self.roots.apart

    @cached_property
    def _along(self) -> NDArray[np.float64]:
        """Coefficients of u,X, σ_YY and σ_XY in σ_XX, (3,): Hooke's law, u,Y and v,Y eliminated."""
        s11, s12, s16 = np.linalg.inv(self.C)[0]
        return np.array([1.0, -s12, -s16]) / s11

    def σ_XX(self, u_X: Any, σ_YY: Any, σ_XY: Any) -> Any:
        by_u_X, by_σ_YY, by_σ_XY = self._along
        return by_u_X * u_X + by_σ_YY * σ_YY + by_σ_XY * σ_XY

    def stresses(self, G: NDArray) -> NDArray[np.float64]:
        strains = [G[..., 0, 0], G[..., 1, 1], G[..., 0, 1] + G[..., 1, 0]]
        return np.einsum("ij,j...->i...", self.C, np.array(strains))

    def inside(self, Φ: Potential, g: Any, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY by the potential at the matrix X + Y G; tractions have 𝐘⁻¹ G 𝐘 for G."""
        X, Y = np.broadcast_arrays(np.asarray(X, dtype=float), np.asarray(Y, dtype=float))
        if np.any(Y >= 0.0):
            raise ValueError(f"Y/a = {Y.max()!r}: expected Y < 0; use the formulas of the surface there")
        shape, (X, Y) = X.shape, np.atleast_1d(X, Y)
        middle = self.roots.sum / 2.0
        square = Y**2 * complex(middle**2 - self.roots.product)
        # Φ of a matrix with two eigenvalues: the mean, and the divided difference times Y (G - middle).
        mean, difference = 1j * mean_and_difference(Φ, X + middle * Y, square)
        beyond = self.G - middle * np.eye(2)
        strain = self.Y[0], (beyond @ self.Y)[0]
        tractions = np.eye(2), self.L @ beyond @ self.Y

        def part(first: NDArray, second: NDArray) -> NDArray[np.float64]:
            return ((first[0] * g + first[1]) * mean + (second[0] * g + second[1]) * Y * difference).real

        u_X = part(*strain)
        σ_XY, σ_YY = (part(tractions[0][i], tractions[1][i]) for i in (0, 1))
        σ = np.array([self.σ_XX(u_X, σ_YY, σ_XY), σ_YY, σ_XY])
        return σ if shape else σ[..., 0]

    def far(self, X: NDArray, Y: NDArray, terms: int = 1, datum: float = DATUM) -> NDArray[np.float64]:
        p, other = self.roots.each
        z = X + p * np.minimum(Y, 0.0)
        z = np.where(Y < 0.0, z, X + np.where(X < 0.0, -1e-300j, 0.0))
        step = (other - p) * Y / z
        # The argument goes from 0 ahead of the load to -π behind it; half of that is a translation.
        log = np.log(z / datum) + 0.5j * np.pi
        change = np.where(step == 0.0, Y / z, log1p(step) / np.where(step == 0, 1, other - p))
        identity = np.eye(2)
        function = log[:, None, None] * identity + change[:, None, None] * (self.G - p * identity)
        inverse = np.linalg.inv(X[:, None, None] * identity + Y[:, None, None] * self.G)
        of_loads = np.linalg.solve(self.L, LOADS.T)
        functions, power = [function], identity
        for n in range(1, terms):
            power = power @ inverse
            functions.append(-power / n)
        return np.moveaxis(np.array(functions) @ of_loads, (0, 1, 2, 3), (0, 3, 2, 1)).imag / np.pi


#: Places about a point, and the matrix from values there to coefficients of the polynomial through them.
#: Their unit is a power of two, at most a share of the distance from the contact, so that they have no
#: rounding; that leaves 1e-13 of a derivative. Step over this distance above which potentials are
#: subtracted.
_ABOUT = np.array([1.0, 1.0 + 1j, 1j, -1.0 + 1j, -1.0, -1.0 - 1j, -1j, 1.0 - 1j])
_TO_POWERS = np.linalg.inv(np.vander(_ABOUT, increasing=True))
_UNIT, _STEP = 0.015, 0.01


def mean_and_difference(Φ: Potential, z: NDArray, square: NDArray) -> NDArray[np.complex128]:
    """Mean of Φ(z + δ) and Φ(z - δ), and their difference over 2δ, accurate for any δ, (2, ..., n).

    Both are even in δ, and need its square alone. Where δ is small they are those of the polynomial
    through values at places about z.

    Args:
        Φ: potential of a pressure.
        z: positions below the surface over a, (..., n).
        square: δ², (..., n).
    """
    distance = np.hypot(np.maximum(np.abs(z.real) - 1.0, 0.0), z.imag)
    close = np.abs(square) <= (_STEP / 2.0 * distance) ** 2
    result = np.empty(0, dtype=complex)
    for evaluate, there in ((_around, close), (_apart, ~close)):
        columns = there.any(axis=tuple(range(z.ndim - 1)))
        if not columns.any():
            continue
        part = evaluate(Φ, z[..., columns], square[..., columns], distance[..., columns])
        if not result.size:
            result = np.empty((*part.shape[:-1], z.shape[-1]), dtype=complex)
        result[..., columns] = np.where(there[..., columns], part, result[..., columns])
    return result


def _around(Φ: Potential, z: NDArray, square: NDArray, distance: NDArray) -> NDArray[np.complex128]:
    """Mean and difference by values at places about z."""
    unit = np.exp2(np.floor(np.log2(_UNIT * distance)))
    values = Φ.at((z[..., None] + unit[..., None] * _ABOUT).reshape(*z.shape[:-1], -1))
    c = values.reshape(*values.shape[:-1], -1, len(_ABOUT)) @ _TO_POWERS.T
    u = square / unit**2
    even, odd = (
        c[..., i] + u * (c[..., i + 2] + u * (c[..., i + 4] + u * c[..., i + 6])) for i in (0, 1)
    )
    return np.array([even, odd / unit])


def _apart(Φ: Potential, z: NDArray, square: NDArray, distance: NDArray) -> NDArray[np.complex128]:
    """Mean and difference by both values."""
    δ = np.sqrt(square)
    z, other = z + δ, z - δ
    at_z, at_other = Φ.at(z), Φ.at(other)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.array([(at_z + at_other) / 2.0, (at_z - at_other) / (z - other)])
