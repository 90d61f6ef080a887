"""Stiffness of layers, uniform and graded, seen from a load that moves.

**A uniform solid between two depths** (:class:`Medium`). For a field e^(ikX), k > 0, displacements
u = e^(ik Ḡ Y) a decay downwards and u = e^(ik G Y) b upwards, G of the solid's own half-plane, and their
tractions t = (σ_XY, σ_YY) are k Z₋ u and k Z₊ u with

    Z₋ = i conj(L),   Z₊ = i L,   L = Rᵀ + T G.

Below the speed of the solid's surface wave Z₋ is positive and Z₊ negative, both Hermitian.

At complex speeds, one for each k, fields that decay downwards are those of the conjugate speed instead.

**A uniform layer** (:class:`Uniform`) changes the stiffness of what is below it. With the factors E₊ and
E₋ of both fields over its thickness, Z_b the stiffness of what is below and

    r = (Z₊ - Z_b)⁻¹ (Z_b - Z₋),   W = E₊ r E₋,

the stiffness on top is Z₋ + δ, δ = (Z₊ - Z₋) W (1 + W)⁻¹: exponentials that decay, and no other.

**A layer whose constants change with depth** (:class:`Graded`) has a Riccati equation of its stiffness,
solved without cancellation. With Y upwards the stiffness Z of what is below obeys

    Z' = k [Q - R T⁻¹Rᵀ - i R T⁻¹Z + i Z T⁻¹Rᵀ - Z T⁻¹Z].

Z₋ of a half-plane of the solid at that depth makes the bracket vanish, and with T⁻¹Z₋ - i T⁻¹Rᵀ = i Ḡ the
difference δ = Z - Z₋ and the displacement u that belongs to it obey

    δ' = k [δ N + Nᴴ δ - δ T⁻¹ δ] - Z₋',   u' = k [T⁻¹ δ - N] u,   N = -i Ḡ:

δ keeps all its digits where it is small, which is where k is large.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from math import gamma
from typing import Any, ClassVar, TypeAlias

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from ..errors import SolveError
from ..solids.half_plane import Waves, exponential


def inverse(M: NDArray) -> NDArray[Any]:
    """Inverses of matrices (..., 2, 2), by Cramer's rule."""
    a, b, c, d = M[..., 0, 0], M[..., 0, 1], M[..., 1, 0], M[..., 1, 1]
    adjugate = np.stack([np.stack([d, -b], axis=-1), np.stack([-c, a], axis=-1)], axis=-2)
    return np.asarray(adjugate / (a * d - b * c)[..., None, None])


def least(Z: NDArray) -> NDArray[np.float64]:
    """Smaller eigenvalue of Hermitian matrices (..., 2, 2); NaN stays."""
    a, d = Z[..., 0, 0].real, Z[..., 1, 1].real
    across = np.abs(Z[..., 0, 1] + Z[..., 1, 0].conj()) / 2.0
    half = np.hypot((a - d) / 2.0, across)
    # The product over the larger one where both are positive: nothing cancels.
    larger = (a + d) / 2.0 + half
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(larger > 0.0, (a * d - across**2) / larger, (a + d) / 2.0 - half)


@dataclass(frozen=True)
class Medium:
    """A uniform solid at a speed, or at the complex speeds of many waves.

    Attributes:
        response: its half-plane at that speed; at complex speeds the fields that decay upwards for k > 0.
        modulus: unit of its stiffness over the modulus of the surface's solid.
        falling: fields that decay downwards; None at a real speed, where they are the conjugates.
    """

    response: Any
    modulus: float
    falling: Waves | None = None

    @cached_property
    def down(self) -> NDArray[Any]:
        """Stiffness Z₋ against fields that decay downwards, (2, 2), at many speeds (n, 2, 2)."""
        L = self.falling.L if self.falling else self.response.L.conj()
        return np.asarray(1j * self.modulus * L)

    @cached_property
    def up(self) -> NDArray[Any]:
        """Stiffness Z₊ against fields that decay upwards, (2, 2), at many speeds (n, 2, 2)."""
        return np.asarray(1j * self.modulus * self.response.L)

    @cached_property
    def T_inverse(self) -> NDArray[np.float64]:
        """Inverse of T, the stiffness of tractions against u,Y, (2, 2)."""
        return np.asarray(self.response.T_inverse / self.modulus)

    def exponentials(self, kh: NDArray) -> tuple[NDArray[Any], NDArray[Any]]:
        """Factors over a height h >= 0 of fields that decay upwards and downwards, (n, 2, 2) each.

        Args:
            kh: k times h, (n,).
        """
        up = exponential(self.response, kh)
        return up, exponential(self.falling, -kh) if self.falling else up.conj()


_ONE = np.eye(2)
#: Stiffness and displacements at a depth of a layer, (n, 2, 2) each.
Field: TypeAlias = Callable[[float], tuple[NDArray[Any], NDArray[Any]]]


@dataclass(frozen=True)
class Uniform:
    """A uniform layer at a speed.

    Attributes:
        medium: its solid.
        H: thickness over a.
        power: of the depth with which it changes; infinite, as it does not.
    """

    medium: Medium
    H: float

    power: ClassVar[float] = np.inf

    @property
    def top(self) -> Medium:
        """The solid at its upper face."""
        return self.medium

    @property
    def bottom(self) -> Medium:
        """The solid at its lower face."""
        return self.medium

    def check(self) -> None:
        """Do nothing: a uniform layer can always be resolved."""

    def _reflected(self, below: NDArray) -> NDArray:
        """Reflection r at the lower face, (n, 2, 2)."""
        return inverse(self.medium.up - below) @ (below - self.medium.down)

    def excess(self, k: NDArray, below: NDArray) -> NDArray:
        """δ: stiffness on top less that of a half-plane of the solid there, (n, 2, 2).

        Args:
            k: wavenumbers times a, (n,).
            below: stiffness Z of what is below, (n, 2, 2).
        """
        up, down = self.medium.exponentials(k * self.H)
        W = up @ self._reflected(below) @ down
        return np.asarray((self.medium.up - self.medium.down) @ W @ inverse(_ONE + W))

    def min_stiffness(self, k: NDArray, below: NDArray) -> NDArray[np.float64]:
        """Smaller eigenvalue of the stiffness at the lower face where the upper one is held, (n,).

        Not positive: some wave with this wavenumber runs inside, slower than the load.
        """
        up, down = self.medium.exponentials(k * self.H)
        back = down @ up
        with np.errstate(all="ignore"):
            own = -(self.medium.up - self.medium.down @ back) @ inverse(_ONE - back)
        # Between faces much nearer than the wavelength the stiffness is T over their distance at least;
        # that of an incompressible solid goes as its third power, and has no digits.
        kH = k * self.H
        held = 1.0 / (kH * np.linalg.eigvalsh(self.medium.T_inverse)[-1])
        return np.where(kH < _THIN, held, least(below + own))

    def carried(self, k: NDArray, below: NDArray) -> tuple[NDArray, NDArray]:
        """δ on top, and the displacement of the lower face by that of the upper one, (n, 2, 2) each.

        Args:
            k, below: see :meth:`excess`.
        """
        (up, down), r = self.medium.exponentials(k * self.H), self._reflected(below)
        W = up @ r @ down
        turned = inverse(_ONE + W)
        return (self.medium.up - self.medium.down) @ W @ turned, (_ONE + r) @ down @ turned

    def field(self, k: NDArray, below: NDArray) -> Field:
        """Stiffness at a depth over a, and the displacement there by that of the upper face.

        Args:
            k, below: see :meth:`excess`.
        """

        def at(depth: float) -> tuple[NDArray, NDArray]:
            upper, lower = self.cut(depth)
            Z = self.medium.down + lower.excess(k, below)
            return Z, upper.carried(k, Z)[1]

        return at

    def cut(self, depth: float) -> tuple["Uniform", "Uniform"]:
        """The parts of the layer above and below a depth over a."""
        return Uniform(self.medium, depth), Uniform(self.medium, self.H - depth)

    def first_order(self) -> NDArray[Any]:
        """Limit of kᵖ δ for large k and any p, (2, 2): zero, for δ falls exponentially."""
        return np.zeros((2, 2), dtype=complex)


#: Thickness over the wavelength/2π below which a layer that is held on top holds what is below.
_THIN = 1e-4
#: Coefficients of the polynomials in which properties are expanded, at first and at most; size of the
#: last ones that is small enough, and that which is rounding.
_FEW, _MANY, _SMALL, _ROUNDING = 17, 513, 1e-12, 2e-15
#: Twice k Im p times the depth below which nothing is felt on top.
_FELT = 78.0
#: Number of depths at which the decay of fields is evaluated.
_LOOKED_AT = 33
#: Number of slices by which waves inside are detected.
_SLICES = 16
#: Relative error of a step, and absolute error of δ over Z.
STEP, _ABSOLUTE = 1e-10, 1e-14


@dataclass(frozen=True)
class Graded:
    """A graded layer, or a part of one, at a speed.

    Attributes:
        medium_of: its solid at the share s of the change from top to bottom, s in [0, 1].
        H: thickness over a.
        power: s = (depth/whole)^power.
        offset, whole: depth of the upper face in a layer, and its thickness, of which this is a part;
            ``whole`` 0: all of it.
        rtol: of a step of the integration.
    """

    medium_of: Callable[[float], Medium]
    H: float
    power: float = 1.0
    offset: float = 0.0
    whole: float = 0.0
    rtol: float = STEP

    @property
    def _whole(self) -> float:
        return self.whole or self.H

    @cached_property
    def top(self) -> Medium:
        """The solid at its upper face."""
        return self.medium_at(0.0)

    @cached_property
    def bottom(self) -> Medium:
        """The solid at its lower face."""
        return self.medium_at(self.H)

    def medium_at(self, depth: float) -> Medium:
        """The solid at a depth below the upper face."""
        return self.medium_of(min((self.offset + depth) / self._whole, 1.0) ** self.power)

    def cut(self, depth: float) -> tuple["Graded", "Graded"]:
        """The parts of the layer above and below a depth over a."""
        below = replace(self, H=self.H - depth, offset=self.offset + depth, whole=self._whole)
        return replace(self, H=depth, whole=self._whole), below

    @cached_property
    def _series(self) -> NDArray[Any]:
        """Ḡ, T⁻¹, Z₋ as Chebyshev series in 2s - 1, (terms, 3, 2, 2).

        Raises:
            SolveError: constants are not smooth functions of depth.
        """
        count = _FEW
        while count <= _MANY:
            x = np.cos(np.pi * np.arange(count) / (count - 1))
            media = [self.medium_of((1.0 + value) / 2.0) for value in x.tolist()]
            values = np.array([[m.response.G.conj(), m.T_inverse, m.down] for m in media])
            c = np.linalg.solve(chebyshev.chebvander(x, count - 1), values.reshape(count, -1))
            size = np.abs(c).max(axis=0)
            size = np.maximum(size, size.reshape(3, 4).max(axis=1).repeat(4))
            if count > _FEW and not _hopeful(np.abs(c / size).max(axis=1)):
                break
            if np.all(np.abs(c[-3:]) <= _SMALL * size):
                keep = np.flatnonzero((np.abs(c) > _ROUNDING * size).any(axis=1))[-1] + 1
                return np.asarray(c[: max(keep, 2)].reshape(-1, 3, 2, 2))
            count = 2 * count - 1
        raise SolveError("the solid of a graded layer changes too much to be followed at this speed")

    def check(self) -> None:
        """Check that the layer can be resolved.

        Raises:
            SolveError: its solid changes too much with depth.
        """
        self._series  # noqa: B018 - cached

    @cached_property
    def _falls(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Depths d and ∫ Im p dd up to these, (n,) each: fields fall like e^(-k ∫ Im p dd) at least."""
        from scipy.integrate import cumulative_trapezoid  # a slow import

        depth = np.linspace(0.0, self.H, _LOOKED_AT)
        decay = [min(p.imag for p in self.medium_at(d).response.roots.each) for d in depth.tolist()]
        return depth, cumulative_trapezoid(decay, depth, initial=0.0)

    def _reach(self, k: NDArray) -> NDArray[np.float64]:
        """Depth over which the integration goes, (n,)."""
        depth, fallen = self._falls
        with np.errstate(divide="ignore"):
            return np.interp(_FELT / (2.0 * k), fallen, depth)

    def _properties(self, depth: NDArray) -> tuple[NDArray, NDArray, NDArray]:
        """N, T⁻¹ and dZ₋/dY at depths, (n, 2, 2) each."""
        relative = np.maximum((self.offset + depth) / self._whole, 0.0)
        share = relative if self.power == 1.0 else relative**self.power
        rate = np.full_like(relative, 1.0 / self._whole)
        if self.power != 1.0:
            rate *= self.power * relative ** (self.power - 1.0)
        N, T, slope = self._at_share(share)
        return N, T, rate[:, None, None] * slope

    def _at_share(self, share: NDArray) -> tuple[NDArray, NDArray, NDArray]:
        """N, T⁻¹ and -dZ₋/ds at shares s of the change, (n, 2, 2) each."""
        angle = np.arccos(np.minimum(2.0 * share - 1.0, 1.0))
        values = np.cos(angle[:, None] * self._orders) @ self._packed
        G, T, slope = values.view(complex).reshape(-1, 3, 2, 2).swapaxes(0, 1)
        return -1j * G, T.real, -slope

    @cached_property
    def _orders(self) -> NDArray[np.float64]:
        return np.arange(len(self._packed), dtype=float)

    @cached_property
    def _packed(self) -> NDArray[np.float64]:
        """Ḡ, T⁻¹ and dZ₋/ds as one series of real numbers, (terms, 24)."""
        c = self._series.copy()
        c[:, 2] = 0.0
        c[:-1, 2] = 2.0 * chebyshev.chebder(self._series[:, 2])
        return np.ascontiguousarray(c.reshape(len(c), 12)).view(float)

    def _rate(self, k: NDArray, depth: NDArray, δ: NDArray) -> NDArray[Any]:
        """Derivative of δ along Y, (n, 2, 2)."""
        N, T, slope = self._properties(depth)
        moved = δ @ (N - T @ δ / 2.0)
        # δ is Hermitian, and so is δ T⁻¹ δ.
        return np.asarray(k[:, None, None] * (moved + moved.conj().swapaxes(1, 2)) - slope)

    def _swept(self, k: NDArray, below: NDArray, dense: bool) -> Any:
        """Solution for δ times 1 + k H from the lowest depth that matters upwards, over τ from 0 to 1.

        Raises:
            SolveError: δ is not finite: the speed is beyond that of a wave inside.
        """
        from scipy.integrate import solve_ivp

        if np.any(k <= 0.0):
            raise ValueError(f"k a = {k.min()!r}: expected wavenumbers > 0")
        reach, size = self._reach(k), (1.0 + k * self.H)[:, None, None]
        whole = (reach >= self.H)[:, None, None]
        start = np.where(whole, size * (below - self.bottom.down), 0.0)

        def rate(τ: float, flat: NDArray) -> NDArray[Any]:
            δ = flat.reshape(-1, 2, 2) / size
            return np.asarray((reach[:, None, None] * size * self._rate(k, reach * (1.0 - τ), δ)).ravel())

        with np.errstate(all="ignore"):
            solution = solve_ivp(
                rate, (0.0, 1.0), start.astype(complex).ravel(), method="DOP853", rtol=self.rtol,
                atol=_ABSOLUTE * float(np.abs(self.top.down).max()), dense_output=dense,
            )  # fmt: skip
        if not solution.success:
            raise SolveError(f"the stiffness of a graded layer was not found: {solution.message}")
        return solution

    def excess(self, k: NDArray, below: NDArray) -> NDArray[Any]:
        """δ: stiffness on top less that of a half-plane of the solid there, (n, 2, 2).

        Args:
            k: wavenumbers times a, (n,), positive.
            below: stiffness Z of what is below, (n, 2, 2).
        """
        solution = self._swept(k, below, dense=False)
        return np.asarray(solution.y[:, -1].reshape(-1, 2, 2) / (1.0 + k * self.H)[:, None, None])

    def field(self, k: NDArray, below: NDArray) -> Field:
        """Stiffness at a depth over a, and the displacement there by that of the upper face.

        It is 0 where it has decayed.

        Args:
            k, below: see :meth:`excess`.
        """
        from scipy.integrate import solve_ivp

        reach, size = self._reach(k), (1.0 + k * self.H)[:, None, None]
        swept = self._swept(k, below, dense=True).sol

        def rate(fallen: float, flat: NDArray) -> NDArray[Any]:
            N, T, _ = self._properties(reach * fallen)
            δ = swept(1.0 - fallen).reshape(-1, 2, 2) / size
            return np.asarray(((reach * k)[:, None, None] * (N - T @ δ) @ flat.reshape(-1, 2, 2)).ravel())

        start = np.tile(np.eye(2, dtype=complex), (len(k), 1, 1)).ravel()
        solution = solve_ivp(
            rate, (0.0, 1.0), start, method="DOP853", rtol=self.rtol, atol=1e-14, dense_output=True
        )
        if not solution.success:
            raise SolveError(f"the field in a graded layer was not found: {solution.message}")

        def at(depth: float) -> tuple[NDArray, NDArray]:
            shares, which = np.unique(np.minimum(depth / reach, 1.0), return_inverse=True)
            δ, by_top = (
                of(places).T.reshape(-1, len(k), 2, 2)[which, np.arange(len(k))]
                for of, places in ((swept, 1.0 - shares), (solution.sol, shares))
            )
            felt = (reach >= depth)[:, None, None]
            return self.medium_at(depth).down + δ / size, np.where(felt, by_top, 0.0)

        return at

    def first_order(self) -> NDArray[Any]:
        """Limit of kᵖ δ on top for large k, p the power, (2, 2)."""
        from scipy.linalg import fractional_matrix_power  # a slow import

        N, _, slope = (part[0] for part in self._at_share(np.zeros(1)))
        I, p = np.eye(2), self.power
        # δ = -∫ exp(kNᴴd) Z₋'(d) exp(kNd) dd by rows, where Z₋' goes with the power p - 1 of the depth d.
        falling = -np.kron(N.conj().T, I) - np.kron(I, N.T)
        of_power = gamma(p + 1.0) / self._whole**p * fractional_matrix_power(falling, -p)
        return np.asarray(-(of_power @ slope.ravel()).reshape(2, 2))

    def min_stiffness(self, k: NDArray, below: NDArray) -> NDArray[np.float64]:
        """Smallest stiffness at faces inside where those above are held, by uniform slices, (n,)."""
        h, smallest = self.H / _SLICES, []
        for i in range(_SLICES - 1, -1, -1):
            slice_ = Uniform(self.medium_at((i + 0.5) * h), h)
            smallest.append(slice_.min_stiffness(k, below))
            below = slice_.top.down + slice_.excess(k, below)
        return np.min(np.where(np.isnan(smallest), -np.inf, smallest), axis=0)


def _hopeful(c: NDArray) -> bool:
    """Return True if coefficients that fall as ``c`` does will be small before there are too many."""
    half = len(c) // 2
    first, last = c[half // 2 : half].max(), c[-half // 2 :].max()
    rate = np.log(max(last, _ROUNDING) / max(first, _ROUNDING)) / (len(c) - half)
    return bool(last <= _SMALL or np.log(last) + rate * (_MANY - len(c)) <= np.log(_SMALL))
