"""A layer whose constants change with depth: the Riccati equation of its stiffness, without cancellation.

With Y upwards the stiffness Z of what is below obeys

    Z' = k [Q - R T⁻¹Rᵀ - i R T⁻¹Z + i Z T⁻¹Rᵀ - Z T⁻¹Z].

Z₋ of a half-plane of the solid at that depth makes the bracket vanish, and with T⁻¹Z₋ - i T⁻¹Rᵀ = i Ḡ the
difference δ = Z - Z₋ and the displacement u that belongs to it obey

    δ' = k [δ N + Nᴴ δ - δ T⁻¹ δ] - Z₋',   u' = k [T⁻¹ δ - N] u,   N = -i Ḡ:

δ keeps all its digits where it is small, which is where k is large.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from galinx.solvers.errors import SolveError
from galinx.solvers.layers.medium import Medium
from galinx.solvers.layers.uniform import Uniform

#: Coefficients of the polynomials in which properties are expanded, at first and at most; what is small
#: enough at their end, and what of them is rounding.
_FEW, _MANY, _SMALL, _ROUNDING = 17, 513, 1e-12, 2e-15
#: Twice k Im p times the depth below which nothing is felt on top.
_FELT = 78.0
#: Depths at which it is looked at how fast fields fall.
_LOOKED_AT = 33
#: Slices by which it is seen whether a wave runs inside.
_SLICES = 16
#: Relative error of a step, and absolute error of δ over Z.
_STEP, _ABSOLUTE = 1e-10, 1e-14


@dataclass(frozen=True)
class Graded:
    """A layer, or a part of one, at a speed.

    Attributes:
        medium_of: its solid where the share s of the change from top to bottom is done, s in [0, 1].
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
    rtol: float = _STEP

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
        """What is above and below a depth."""
        below = replace(self, H=self.H - depth, offset=self.offset + depth, whole=self._whole)
        return replace(self, H=depth, whole=self._whole), below

    @cached_property
    def _series(self) -> NDArray[Any]:
        """Ḡ, T⁻¹, Z₋ as Chebyshev series in 2s - 1, (terms, 3, 2, 2).

        Raises:
            SolveError: they are not smooth.
        """
        count = _FEW
        while count <= _MANY:
            x = np.cos(np.pi * np.arange(count) / (count - 1))
            media = [self.medium_of((1.0 + value) / 2.0) for value in x.tolist()]
            values = np.array([[m.G.conj(), m.T_inverse, m.down] for m in media])
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
        """
        Raises:
            SolveError: its solid changes too much to be followed.
        """
        self._series  # noqa: B018 - cached

    @cached_property
    def _falls(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Depths d, and what k has to be multiplied by: fields fall like e^(-k ∫ Im p dd) at least."""
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
        angle = np.arccos(np.clip(2.0 * relative**self.power - 1.0, -1.0, 1.0))
        values = np.cos(np.outer(angle, np.arange(len(self._packed)))) @ self._packed
        rate = self.power * relative ** (self.power - 1.0) / self._whole
        G, T, slope = values.view(complex).reshape(-1, 3, 2, 2).swapaxes(0, 1)
        return -1j * G, T.real, -rate[:, None, None] * slope

    @cached_property
    def _packed(self) -> NDArray[np.float64]:
        """Ḡ, T⁻¹ and dZ₋/ds as one series of real numbers, (terms, 24)."""
        c = self._series.copy()
        c[:, 2] = 0.0
        c[:-1, 2] = 2.0 * chebyshev.chebder(self._series[:, 2])
        return np.ascontiguousarray(c.reshape(len(c), 12)).view(float)

    def _rate(self, k: NDArray, depth: NDArray, δ: NDArray) -> NDArray[Any]:
        """δ' over Y."""
        N, T, slope = self._properties(depth)
        moved = δ @ (N - T @ δ / 2.0)
        # δ is Hermitian, and so is δ T⁻¹ δ.
        return np.asarray(k[:, None, None] * (moved + moved.conj().swapaxes(1, 2)) - slope)

    def _swept(self, k: NDArray, below: NDArray, dense: bool) -> Any:
        """δ times 1 + k H from the lowest depth that is felt upwards, over τ from 0 to 1.

        Raises:
            SolveError: it is not finite: the speed is beyond that of a wave inside.
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
            found = solve_ivp(
                rate, (0.0, 1.0), start.astype(complex).ravel(), method="DOP853", rtol=self.rtol,
                atol=_ABSOLUTE * float(np.abs(self.top.down).max()), dense_output=dense,
            )  # fmt: skip
        if not found.success:
            raise SolveError(f"the stiffness of a graded layer was not found: {found.message}")
        return found

    def excess(self, k: NDArray, below: NDArray) -> NDArray[Any]:
        """δ: stiffness on top less that of a half-plane of the solid there, (n, 2, 2).

        Args:
            k: wavenumbers times a, (n,), positive.
            below: stiffness Z of what is below, (n, 2, 2).
        """
        found = self._swept(k, below, dense=False)
        return np.asarray(found.y[:, -1].reshape(-1, 2, 2) / (1.0 + k * self.H)[:, None, None])

    def carried(self, k: NDArray, below: NDArray) -> NDArray[Any]:
        """Displacement of the lower face by that of the upper one, (n, 2, 2); 0 where nothing is felt."""
        from scipy.integrate import solve_ivp

        dense, size = self._swept(k, below, dense=True).sol, (1.0 + k * self.H)[:, None, None]
        reach = self._reach(k)

        def rate(fallen: float, flat: NDArray) -> NDArray[Any]:
            N, T, _ = self._properties(reach * fallen)
            δ = dense(1.0 - fallen).reshape(-1, 2, 2) / size
            return np.asarray(((reach * k)[:, None, None] * (N - T @ δ) @ flat.reshape(-1, 2, 2)).ravel())

        start = np.tile(np.eye(2, dtype=complex), (len(k), 1, 1)).ravel()
        found = solve_ivp(rate, (0.0, 1.0), start, method="DOP853", rtol=self.rtol, atol=1e-14)
        if not found.success:
            raise SolveError(f"the field in a graded layer was not found: {found.message}")
        return np.where((reach >= self.H)[:, None, None], found.y[:, -1].reshape(-1, 2, 2), 0.0)

    def first_order(self) -> NDArray[Any]:
        """What k δ on top tends to for large k, (2, 2)."""
        N, _, slope = (part[0] for part in self._properties(np.zeros(1)))
        one = np.eye(2)
        # Nᴴ δ + δ N = Z₋' by rows.
        system = np.kron(N.conj().T, one) + np.kron(one, N.T)
        return np.asarray(np.linalg.solve(system, slope.ravel()).reshape(2, 2))

    def stands(self, k: NDArray, below: NDArray) -> NDArray[np.float64]:
        """Smallest of what holds faces inside where those above are held, by uniform slices, (n,)."""
        h, found = self.H / _SLICES, []
        for i in range(_SLICES - 1, -1, -1):
            slice_ = Uniform(self.medium_at((i + 0.5) * h), h)
            found.append(slice_.stands(k, below))
            below = slice_.top.down + slice_.excess(k, below)
        return np.min(np.where(np.isnan(found), -np.inf, found), axis=0)


def _hopeful(c: NDArray) -> bool:
    """Will coefficients that fall as these do be small before they are too many?"""
    half = len(c) // 2
    first, last = c[half // 2 : half].max(), c[-half // 2 :].max()
    rate = np.log(max(last, _ROUNDING) / max(first, _ROUNDING)) / (len(c) - half)
    return bool(last <= _SMALL or np.log(last) + rate * (_MANY - len(c)) <= np.log(_SMALL))
