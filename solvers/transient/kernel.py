"""Surface motion of a half-plane under tractions that change in time, by Laplace's transform.

Seen from a frame that moves at c, fields e^(ikX + st) obey the formulas of steady motion with the complex
speed C = c + is/k (lengths over a, speeds over c_s, times over a/c_s, stresses over μ)::

    ik û = 𝐘(C) σ̂ where k < 0,    the conjugate of 𝐘(C*) instead where k > 0

With the slowness ζ = k/(is) as seen from the frame, C = c + 1/ζ does not know s. The transform back to
X > 0

    v̂ = i/(2π) ∫₀ [𝐘(C) - conj 𝐘(C*)] e^(-sζX) dζ/ζ

is taken along ways on which the integrand decays: the second part straight from 0; the first part on the
upper side of the real axis up to the least speed of waves inside, and from there alike, with the residue
of the wave along the surface. On these ways lie no other singularities, whatever the solid.
"""

from dataclasses import dataclass
from functools import cached_property
from math import ceil, cos, log, log2, pi

import numpy as np
from numpy.polynomial.legendre import leggauss, legvander
from numpy.typing import NDArray

from galinx.solvers.transient.admittance import Admittance

#: Gauss's points of a panel along a way, and panels' width in the logarithm of the distance from its end.
_POINTS, _WIDTH = 12, 0.8
#: Decay after which nothing is left of an integrand.
_GONE = 32.0
#: Directions of the ways below the real axis, and how far from the fastest decay one is taken.
_DIRECTIONS = np.arange(0.6, 1.7, 0.3)
#: First panel along a way over the distance of the nearest singularity.
_FIRST = 0.1
#: Panels between two speeds at which 𝐘 is not analytic: at first, halvings at most, and accuracy.
_PANELS, _HALVINGS, _ACCURACY = 3, 12, 1e-10
#: Radians of the exponential that a panel bears.
_TURN = 5.0
#: Where a panel is looked at.
_BETWEEN = np.linspace(-0.9, 0.9, 4)
#: Width of panels of distances that have the same points.
_PANEL = 0.125
#: So many distances have panels in common.
_MANY = 64
#: Distances are treated together where one is so many times another at most.
_ALIKE = 4.0


@dataclass(frozen=True)
class Kernel:
    """Response at a distance x > 0 ahead of a line load in a frame that moves at c.

    Behind it the response is that ahead, in the mirror image of the solid and a frame that moves at -c,
    with the signs of σ_XY's and u changed.

    Args:
        surface: of the solid.
        c: speed over c_s, of either sign.
        rayleigh: of the wave along the surface over c_s.
    """

    surface: Admittance
    c: float
    rayleigh: float

    def __call__(self, x: NDArray, s: complex, slopes: bool = False) -> NDArray[np.complex128]:
        """v̂ of line loads σ_YY and σ_XY, and û of them, (4, n).

        Args:
            x: distances > 0, (n,).
            s: over c_s/a, Im s >= 0 <= Re s.
            slopes: of these along X instead.
        """
        values = np.zeros((4, len(x)), dtype=complex)
        group = np.floor(np.log(x / x.max()) / log(_ALIKE) + 1e-9)
        for one in np.unique(group):
            values[:, group == one] = self._of(x[group == one], s, slopes)
        ζ, residue = self._pole
        wave = (-s * ζ if slopes else 1.0) * np.exp(-s * ζ * x)
        return values + residue[:, None] * wave

    def _of(self, x: NDArray, s: complex, slopes: bool) -> NDArray[np.complex128]:
        """Without the wave along the surface."""
        ψ = float(np.angle(s))
        down = int(np.abs(_DIRECTIONS - ψ).argmin())
        last = _GONE / (abs(s) * cos(ψ - _DIRECTIONS[down]) * float(x.min()))
        turns = abs(s) * self._edges[-1] * float(x.max()) / _TURN
        ζ, values = self._above(max(0, ceil(log2(max(turns, 1.0) / _PANELS))))
        felt = ζ * (s.real * float(x.min())) < _GONE
        ways = [
            (ζ[felt], values[:, felt]),
            *self._ways(down, max(0, ceil(log(last / self._first) / _WIDTH))),
        ]
        found = np.zeros((4, len(x)), dtype=complex)
        for ζ, values in ways:
            found += (values * (-s * ζ) if slopes else values) @ _exponentials(-s * ζ, x).T
        return found

    @cached_property
    def _edges(self) -> NDArray[np.float64]:
        """0, and slownesses seen from the frame at which 𝐘 is not analytic, growing."""
        return np.concatenate([[0.0], 1.0 / (self.surface.meeting[::-1] - self.c)])

    @cached_property
    def _pole(self) -> tuple[float, NDArray[np.complex128]]:
        """Slowness of the wave along the surface, and what it carries, (4,)."""
        ζ = 1.0 / (self.rayleigh - self.c)
        return ζ, -ζ * self.surface.residue(self.rayleigh)[::-1, ::-1].ravel()

    @property
    def _first(self) -> float:
        """Length of the first panel of a way."""
        ends = self._edges
        return _FIRST * min(self._pole[0] - ends[-1], *np.diff(ends))

    def _rows(self, ζ: NDArray, below: bool = False) -> NDArray[np.complex128]:
        """Of 𝐘/ζ what σ_YY and σ_XY do along Y, and along X, (4, n); ``below``, of its conjugate."""
        C = self.c + 1.0 / ζ
        Y = np.conj(self.surface(np.conj(C))) if below else self.surface(C)
        return np.asarray(Y[:, ::-1, ::-1].reshape(-1, 4).T / ζ)

    def _ways(self, down: int, panels: int) -> list[tuple[NDArray, NDArray]]:
        """Points and weighted values of both ways in a direction, up to some panels."""
        count = _POINTS * (panels + 1)
        return [(ζ[:count], values[:, :count]) for ζ, values in self._downwards(down, panels)]

    def _downwards(self, down: int, panels: int) -> list[tuple[NDArray, NDArray]]:
        known = self._known.get(down)
        if known is None or len(known[0][0]) < _POINTS * (panels + 1):
            v, weights = _distances(self._first, panels + 8)
            along = np.exp(-1j * _DIRECTIONS[down])
            ends = (self._edges[-1], False, 1.0), (0.0, True, -1.0)
            known = []
            for start, below, sign in ends:
                ζ = start + along * v
                factor = sign * 1j / (2.0 * pi) * along * weights
                known.append((ζ, factor * self._rows(ζ, below)))
            self._known[down] = known
        return known

    @cached_property
    def _known(self) -> dict[int, list[tuple[NDArray, NDArray]]]:
        """Ways by direction, as far as they have been needed."""
        return {}

    @cached_property
    def _refined(self) -> dict[int, tuple[NDArray, NDArray]]:
        """The way above the real axis by the number of halvings."""
        return {}

    def _above(self, halvings: int) -> tuple[NDArray, NDArray]:
        """Points and weighted values above the real axis, with each panel halved some times."""
        if halvings not in self._refined:
            t, w = leggauss(_POINTS)
            cuts = np.arange(2**halvings)[:, None]
            finer = ((2.0 * cuts + 1.0 + t) / 2**halvings - 1.0).ravel()
            which, start, length, values = self._panels
            ζ, _ = self._between(which[:, None], start[:, None] + length[:, None] * (1.0 + finer) / 2.0)
            told = values @ (_interpolation(finer) * np.tile(w, 2**halvings)[:, None]).T
            told = told * (1j / (2.0 * pi) * length / 2.0 ** (halvings + 1))[:, None, None]
            self._refined[halvings] = ζ.ravel(), told.swapaxes(0, 1).reshape(4, -1)
        return self._refined[halvings]

    def _between(self, which: NDArray, φ: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Slownesses at shares of angles between two edges, where roots become smooth, and slopes."""
        low, high = self._edges[which], self._edges[which + 1]
        return low + (high - low) * np.sin(pi / 2.0 * φ) ** 2, (high - low) * pi / 2.0 * np.sin(pi * φ)

    @cached_property
    def _panels(self) -> tuple[NDArray[np.int64], NDArray, NDArray, NDArray[np.complex128]]:
        """Of panels so short that polynomials tell 𝐘: which edge is before each, start and length in φ,
        (panels,) each, and values times slopes at Gauss's points, (panels, 4, points)."""
        t, _ = leggauss(_POINTS)
        wanted = [
            (n, k / _PANELS, 1.0 / _PANELS) for n in range(len(self._edges) - 1) for k in range(_PANELS)
        ]
        found = []
        for halvings in range(_HALVINGS + 1):
            again = []
            for n, start, length in wanted:
                at = np.append(t, _BETWEEN)
                ζ, slope = self._between(np.array(n), start + length * (1.0 + at) / 2.0)
                values = self._rows(ζ) * slope
                known, rest = values[:, : len(t)], values[:, len(t) :]
                off = np.abs(known @ _interpolation(_BETWEEN).T - rest).max()
                if off > _ACCURACY * np.abs(values).max() and halvings < _HALVINGS:
                    again += [(n, start, length / 2.0), (n, start + length / 2.0, length / 2.0)]
                else:
                    found.append((n, start, length, known))
            wanted = again
        which, starts, lengths, values = (np.array(column) for column in zip(*found))
        return which, starts, lengths, values


def _interpolation(at: NDArray) -> NDArray[np.float64]:
    """What Gauss's points of a panel tell between them, (points there, Gauss's)."""
    t, _ = leggauss(_POINTS)
    return np.asarray(np.linalg.solve(legvander(t, _POINTS - 1).T, legvander(at, _POINTS - 1).T).T)


def _exponentials(a: NDArray, x: NDArray) -> NDArray[np.complex128]:
    """exp(a x), (x, a): of few places and steps from there, where x are points of even panels."""
    if len(x) < _MANY:
        return np.asarray(np.exp(np.multiply.outer(x, a)))
    steps = np.mod(x, _PANEL)
    _, first, step = np.unique(np.round(steps, 12), return_index=True, return_inverse=True)
    places, place = np.unique(np.round((x - steps) / _PANEL), return_inverse=True)
    whole, rest = (np.exp(np.multiply.outer(of, a)) for of in (places * _PANEL, steps[first]))
    found = whole[place]
    found *= rest[step]
    return np.asarray(found)


def _distances(first: float, panels: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points and weights along a way: its end is a square root, far away powers and a decay."""
    t, w = leggauss(_POINTS)
    near, weights = first * ((1.0 + t) / 2.0) ** 2, first * (1.0 + t) / 2.0 * w
    starts = log(first) + _WIDTH * np.arange(panels)[:, None]
    v = np.exp(starts + _WIDTH * (1.0 + t) / 2.0)
    return np.append(near, v.ravel()), np.append(weights, (v * _WIDTH / 2.0 * w).ravel())
