"""What layers add to the surface motion of a half-plane under tractions that change in time.

For wavenumbers k < 0 fields e^(ik(X - Ct)), C = c + is/k, have in each layer two waves that decay
downwards, u,Y = G₁ u,X with Im p > 0, and two that decay upwards, G₂. With E₁ = e^(-ikG₁H),
E₂ = e^(ikG₂H) and tractions Z u,X of what is below, those on top are (L₁ + δ) u,X with

    r = (L₂ - Z)⁻¹ (Z - L₁),   W = E₂ r E₁,   δ = (L₂ - L₁) W (1 + W)⁻¹:

exponentials that decay, and no other. Δ𝐘 = (L₁ + δ)⁻¹ - L₁⁻¹ falls like e^(-2|k|H Im p), and like
e^(-2sH/c_d) where plane waves go down and up. As Re s > 0 it is analytic along the real axis of k, so
that its transform back to X goes along it.
"""

from dataclasses import dataclass, replace
from math import ceil, pi

import numpy as np
from numpy.polynomial.legendre import leggauss, legvander
from numpy.typing import NDArray

from galinx.solvers.layers.in_cells import LayersInCells
from galinx.solvers.layers.medium import inverse
from galinx.solvers.transient.admittance import Admittance, Waves

#: Decay after which nothing is left of an integrand; wavenumbers at which it is looked for.
_GONE, _LOOKED = 34.0, np.geomspace(1e-3, 1e5, 161)
#: Gauss's points of a panel of wavenumbers, its radians at most, halvings at most, and accuracy.
_POINTS, _TURN, _HALVINGS, _ACCURACY = 12, 5.0, 14, 1e-10
#: Panels at first at least, and where a panel is looked at.
_FEWEST, _BETWEEN = 8, np.linspace(-0.9, 0.9, 4)
#: Wavenumbers whose exponentials are made at once.
_TOGETHER = 512
_ONE = np.eye(2)


@dataclass(frozen=True)
class Sheet:
    """A solid among others.

    Attributes:
        surface: its own.
        modulus: its c₆₆ over that of the solid at the surface.
        slower: speeds over its own wave speed over those over that of the solid at the surface.
        H: thickness over a.
    """

    surface: Admittance
    modulus: float
    slower: float
    H: float

    def waves(self, C: NDArray) -> Waves:
        """Those with Im p > 0 at speeds of the solid at the surface, L over that one's c₆₆."""
        found = self.surface.waves(self.slower * C)
        return replace(found, L=self.modulus * found.L)


@dataclass(frozen=True)
class Sheets:
    """Layers on a substrate.

    Attributes:
        layers: uniform, from the top down.
        substrate: its thickness says nothing.
    """

    layers: tuple[Sheet, ...]
    substrate: Sheet

    @classmethod
    def of(cls, response: LayersInCells) -> "Sheets":
        """Those of a response.

        Raises:
            ValueError: a layer is graded.
        """
        solid, found = response.solid, []
        for layer in solid.layers:
            if layer.bottom is not None:
                raise ValueError("a layer is graded: expected uniform ones")
        thicknesses = [*(layer.thickness / response.a for layer in solid.layers), np.inf]
        for one, H in zip((*(layer.solid for layer in solid.layers), solid.substrate), thicknesses):
            surface = Admittance.of(one.response(0.0))
            found.append(Sheet(surface, one.μ / solid.μ, solid.c_s / one.c_s, H))
        return cls(tuple(found[:-1]), found[-1])

    @property
    def mirrored(self) -> "Sheets":
        """The mirror image in X = 0."""
        every = (*self.layers, self.substrate)
        found = [replace(sheet, surface=sheet.surface.mirrored) for sheet in every]
        return Sheets(tuple(found[:-1]), found[-1])

    @property
    def fastest(self) -> float:
        """Largest speed of a wave inside, over the wave speed of the solid at the surface."""
        return max(one.surface.fastest / one.slower for one in (*self.layers, self.substrate))

    def change(self, k: NDArray, C: NDArray) -> NDArray[np.complex128]:
        """Δ𝐘 at wavenumbers times a, k < 0, and speeds C, Im C < 0, (n,) each: (n, 2, 2)."""
        Z = self.substrate.waves(C).L
        δ = np.zeros_like(Z)
        for layer in self.layers[::-1]:
            down, up = layer.waves(C), layer.waves(C.conj()).conjugate
            κ = k * layer.H
            r = inverse(up.L - Z) @ (Z - down.L)
            W = up.exponential(κ) @ r @ down.exponential(-κ)
            δ = (up.L - down.L) @ W @ inverse(_ONE + W)
            Z = down.L + δ
        return np.asarray(-inverse(Z) @ δ @ inverse(down.L))

    def decay(self, k: NDArray, C: NDArray) -> NDArray[np.float64]:
        """Logarithm by which waves at least decay on the way down and up through the uppermost layer."""
        top, falls = self.layers[0], np.full(len(k), np.inf)
        for waves in (top.waves(C), top.waves(C.conj())):
            half = np.sqrt(waves.s**2 / 4.0 - waves.d)
            slow = np.minimum((waves.s / 2.0 + half).imag, (waves.s / 2.0 - half).imag)
            falls = np.minimum(falls, -2.0 * top.H * k * slow)
        return falls


@dataclass(frozen=True)
class Echoes:
    """What layers add to the response at distances ahead of a line load in a frame that moves at c.

    Args:
        sheets: the layers.
        c: speed over c_s, of either sign.
    """

    sheets: Sheets
    c: float

    def __call__(self, x: NDArray, s: complex, slopes: bool = False) -> NDArray[np.complex128]:
        """v̂ of line loads σ_YY and σ_XY, and û of them, (4, n).

        Args:
            x: distances, (n,).
            s: over c_s/a, Re s > 0.
            slopes: of these along X instead.
        """
        # Those of k > 0 are the conjugates of what -k makes at the conjugate of s.
        return np.asarray(self._half(x, s, slopes) + self._half(x, np.conj(s), slopes).conj())

    def _half(self, x: NDArray, s: complex, slopes: bool) -> NDArray[np.complex128]:
        """Of all k < 0."""
        if (last := self._last(s)) == 0.0:
            return np.zeros((4, len(x)), dtype=complex)
        t, w = leggauss(_POINTS)
        known = np.linalg.solve(legvander(t, _POINTS - 1).T, legvander(_BETWEEN, _POINTS - 1).T).T
        count = max(_FEWEST, ceil(last * float(x.max()) / _TURN))
        starts, length, most = np.arange(count) * (last / count), last / count, 0.0
        found = np.zeros((4, len(x)), dtype=complex)
        for halvings in range(_HALVINGS + 1):
            κ = starts[:, None] + length * (1.0 + np.append(t, _BETWEEN)) / 2.0
            values = self._values(-κ.ravel(), s).reshape(4, *κ.shape)
            told, rest = values[..., :_POINTS], values[..., _POINTS:]
            most = max(most, float(np.abs(values).max()))
            off = np.abs(told @ known.T - rest).max(axis=(0, 2))
            fine = (off <= _ACCURACY * most) | (halvings == _HALVINGS)
            k = -κ[fine, :_POINTS].ravel()
            factor = np.tile(length / 2.0 * w, int(fine.sum())) * ((1j * k) if slopes else 1.0)
            weighted = told[:, fine].reshape(4, -1) * factor
            for some in (slice(n, n + _TOGETHER) for n in range(0, len(k), _TOGETHER)):
                found += weighted[:, some] @ np.exp(1j * np.outer(k[some], x))
            starts, length = np.repeat(starts[~fine], 2), length / 2.0
            starts[1::2] += length
            if not len(starts):
                break
        return np.asarray(found / (2.0 * pi), dtype=np.complex128)

    def _values(self, k: NDArray, s: complex) -> NDArray[np.complex128]:
        """Displacements by tractions less those of the uniform solid, (4, n)."""
        change = self.sheets.change(k, self.c + 1j * s / k)
        return np.asarray(change[:, ::-1, ::-1].reshape(-1, 4).T / (1j * k))

    def _last(self, s: complex) -> float:
        """Wavenumber beyond which nothing is left, 0 where there is nothing at all."""
        k = -_LOOKED
        left = np.flatnonzero(self.sheets.decay(k, self.c + 1j * s / k) < _GONE)
        return float(_LOOKED[min(left[-1] + 1, len(k) - 1)]) if len(left) else 0.0
