"""Surface motion of an isotropic half-plane under tractions that change in time, by Laplace's transform.

Seen from a frame that moves at c, fields e^(ikX + st) obey the formulas of steady motion with the complex
speed C = c + is/k (lengths over a, speeds over c_s, times over a/c_s)::

    v̂ = [n(C)/|k|] σ̂_YY + [i q(C)/k] σ̂_XY

The transform back to X is taken along the two branch cuts of the symbols, which begin at
k_d = is/(c_d - c) and k_s = is/(1 - c) and are turned so that the integrand decays, with the residue of
the Rayleigh wave, and that of a wave which leaks into the solid where the cuts have it between them.
"""

from dataclasses import dataclass
from functools import cached_property
from math import log, sqrt
from typing import Any

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray

#: Gauss's points of a panel along a cut, and panels' width in the logarithm of the distance from its end.
_POINTS, _WIDTH = 12, 0.8
#: Decay after which nothing is left of an integrand, and how near to a cut's end it begins.
_GONE, _NEAR = 32.0, 1e-8
#: Directions of the cuts that are tried, over the least and the largest useful angle.
_DIRECTIONS = np.linspace(0.3, 1.3, 21)


@dataclass(frozen=True)
class Kernel:
    """Response at a distance x > 0 ahead of a line load in a frame that moves at c.

    Behind it the response is that ahead in a frame that moves at -c, with the sign of σ_XY's changed.

    Args:
        slow: (c_s/c_d)².
        c: speed over c_s, of either sign.
        rayleigh: Rayleigh speed over c_s.
    """

    slow: float
    c: float
    rayleigh: float

    def __call__(self, x: NDArray, s: complex) -> NDArray[np.complex128]:
        """v̂ of line loads σ_YY and σ_XY at distances x > 0, (n,), for Im s >= 0 < Re s: (2, n)."""
        ψ = float(np.angle(s))
        gap = 1.0 / sqrt(self.slow) if self.slow else np.inf
        k_d, k_s = 1j * s / (gap - self.c), 1j * s / (1.0 - self.c)
        along = self._direction(ψ, s, k_d, k_s)
        decay = float(along.imag)
        v, weights = _distances(abs(s), _GONE / (decay * float(x.min())))
        values = np.zeros((2, len(x)), dtype=complex)
        for start, of_shear in ((k_d, False), (k_s, True)):
            if of_shear or self.slow:
                jump = self._jump(start, along, v, s, of_shear) * (weights * along)
                values += jump @ np.exp(1j * (start + along * v)[:, None] * x) / (2.0 * np.pi)
        return values + self._rayleigh_wave(x, s) + self._leaking(x, s, k_d, k_s, along)

    def _direction(self, ψ: float, s: complex, k_d: complex, k_s: complex) -> complex:
        """Of the cuts: where a pole between them is near neither."""
        turns = (np.pi / 4.0 + ψ / 2.0) * _DIRECTIONS
        directions = np.exp(1j * (np.pi / 2.0 + ψ - turns))
        if self._leak is None:
            return complex(directions[np.searchsorted(_DIRECTIONS, 1.0)])
        clear = directions.imag  # of what decays slowly, too
        for pole in (self._leak, self.rayleigh):
            k = 1j * s / (pole - self.c)
            for start in (k_d, k_s):
                ahead = np.conj(directions) * (k - start)
                clear = np.minimum(clear, np.abs(np.angle(ahead)))
        return complex(directions[np.argmax(clear)])

    def _jump(
        self, start: complex, along: complex, v: NDArray, s: complex, of_shear: bool
    ) -> NDArray[np.complex128]:
        """What both symbols lose across a cut, right to left, at distances v from its end."""
        k = start + along * v
        C = self.c + 1j * s / k
        bs = self._root(k, s, along, 1.0, v if of_shear else None) / k
        bd = self._root(k, s, along, self.slow, None if of_shear else v) / k
        if of_shear and self.slow:
            bd = -bd  # continued from the right of the other cut
        n, q = self._symbols(C, bs, bd)
        P, e = -bs * bd, 2.0 - C * C
        R = 4.0 * P - e * e
        other_n, other_q = bd * C * C / R, (e - 2.0 * P) / R
        if of_shear:
            return np.array([n - other_n, 1j * (other_q - q)]) / k
        return np.array([n + other_n, 1j * (q - other_q)]) / k

    def _root(
        self, k: NDArray, s: complex, along: complex, slow: float, v: NDArray | None
    ) -> NDArray[np.complex128]:
        """√(k² - slow (kC)²) with cuts along ``along`` above and straight down below."""
        if slow == 0.0:
            return np.asarray(k, dtype=complex)
        fast = 1.0 / sqrt(slow)
        above, below = 1j * s / (fast - self.c), -1j * s / (fast + self.c)
        # √((k - above)/along·(-1)) has its cut where k - above is along.
        turned = np.sqrt(-(k - above) / along) if v is None else 1j * np.sqrt(v)
        factor = np.sqrt(-along * 1j) * turned
        return np.sqrt(1.0 - slow * self.c**2) * factor * np.sqrt(-1j * (k - below)) * self._sign(along)

    @staticmethod
    def _sign(along: complex) -> float:
        """So that the root is k far to the right."""
        k = 1.0
        found = np.sqrt(-along * 1j) * np.sqrt(-(k + 0j) / along) * np.sqrt(-1j * k)
        return float(np.sign(found.real))

    def _symbols(self, C: Any, bs: Any, bd: Any) -> tuple[Any, Any]:
        """n and q at complex speeds without cancellation near C = 0."""
        w = (1.0 + self.slow - self.slow * C * C) / (1.0 + bs * bd)
        r = 4.0 - C * C - 4.0 * w
        return bd / r, (2.0 * w - 1.0) / r

    @cached_property
    def _residues(self) -> tuple[float, float]:
        """Those of n and q in C at the Rayleigh speed."""
        c, slow = self.rayleigh, self.slow
        bs, bd = sqrt(1.0 - c * c), sqrt(1.0 - slow * c * c)
        dR = 4.0 * (-c * bd / bs - slow * c * bs / bd) + 4.0 * c * (2.0 - c * c)
        return bd * c * c / dR, (2.0 - c * c - 2.0 * bs * bd) / dR

    def _rayleigh_wave(self, x: NDArray, s: complex) -> NDArray[np.complex128]:
        apart = self.rayleigh - self.c
        wave = np.exp(-s * x / apart) / apart
        return np.array([1j * self._residues[0] * wave, self._residues[1] * wave])

    @cached_property
    def _leak(self) -> complex | None:
        """Speed of the wave that leaks into the solid, None where there is none of complex speed."""
        k = self.slow
        roots = np.roots([1.0, -8.0, 24.0 - 16.0 * k, -16.0 * (1.0 - k)])
        above = [root for root in roots if root.imag > 1e-12]
        return complex(np.sqrt(above[0])) if above else None

    def _leaking(
        self, x: NDArray, s: complex, k_d: complex, k_s: complex, along: complex
    ) -> NDArray[np.complex128] | float:
        if self._leak is None:
            return 0.0
        C, slow = self._leak, self.slow
        k = 1j * s / (C - self.c)
        sides = [(np.conj(along) * (k - start)).imag for start in (k_d, k_s)]
        if not sides[1] < 0.0 < sides[0]:
            return 0.0
        bs, bd = -np.sqrt(1.0 - C * C), np.sqrt(1.0 - slow * C * C)
        dR = 4.0 * (-C * bd / bs - slow * C * bs / bd) + 4.0 * C * (2.0 - C * C)
        wave = np.exp(1j * k * x) / (C - self.c)
        # Between the cuts n/|k| is -n/k on the sheet that shear has left.
        return np.array([
            1j * bd * C * C / dR * wave, (2.0 - C * C - 2.0 * bs * bd) / dR * wave,
        ])  # fmt: skip


def _distances(size: float, last: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points and weights along a cut: its end is a square root, far away powers and a decay."""
    first = _NEAR * size
    count = max(int(np.ceil(log(last / first) / _WIDTH)), 1)
    edges = np.linspace(log(first), log(last), count + 1)
    t, w = leggauss(_POINTS)
    half = np.diff(edges)[:, None] / 2.0
    y = (edges[:-1, None] + half * (1.0 + t)).ravel()
    v = np.exp(y)
    return v, (half * w).ravel() * v
