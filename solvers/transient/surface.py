"""Strain along the surface, under a flat punch and beside it, by Laplace's transform in time.

What a line load does at a distance is at small ones what it does in steady motion, and a logarithm::

    û,X = q σ̂_YY + (n₁₂ + g m) H[σ̂_YY] + ∫ rest(X - ξ) σ̂_YY(ξ) dξ

The first two are known of the polynomials that the pressure is made of. The rest is tabulated for each s
once, whatever the friction, and is smooth in each panel of distances but the one at 0.
"""

from functools import cached_property
from math import pi

import numpy as np
from numpy.polynomial.legendre import leggauss, legvander
from numpy.typing import NDArray

from galinx.solvers.solids.solid import Response
from galinx.solvers.transient.basis import Basis, Weighted
from galinx.solvers.transient.panels import divided
from galinx.solvers.transient.sides import both_sides
from galinx.solvers.transient.transform import at_any

#: Octaves of panels towards the distance 0, largest width of a panel over a, and Gauss's points of each.
_NEAR, _EVEN, _POINTS = 24, 0.125, 10
#: Steps and half-length of the double exponential rule along the contact, or what is on one side.
_STEPS, _LENGTH = 161, 3.4
#: Points of the pressure as seen from beside the contact.
_FEW = 128


class AlongSurface:
    """Places on the surface, at one speed and for some s.

    Args:
        response: of steady motion at that speed.
        rayleigh: speed of the wave along the surface over c_s.
        s: over c_s/a, Re s > 0, (n,).
        X: places over a, not at the ends of the contact, (places,).
        way: ±1, in which the punch moves along X.
    """

    def __init__(self, response: Response, rayleigh: float, s: NDArray, X: NDArray, way: int = 1) -> None:
        self._response, self._s, self._X = response, s, X
        self._kernels = both_sides(response, rayleigh, way)
        self._slowest = 1.0 / (rayleigh - response.c)

    def strains(self, basis: Basis) -> NDArray[np.complex128]:
        """û,X over N̂/(2aμ) of each polynomial of the pressure where σ_XY = g σ_YY, (s, places, terms)."""
        answer, X, g, pressure = self._response, self._X, basis.g, basis.pressure
        slope, under = answer.n12 + g * answer.m, np.abs(X) < 1.0
        σ = np.zeros((len(X), pressure.terms))
        σ[under] = pressure(X[under])
        local = answer.q * σ + slope * _hilbert(X, pressure, σ)
        found = np.repeat(local[None].astype(np.complex128), len(self._s), axis=0)
        pole = slope / (pi * self._x)
        for table, sign in zip(self._tables, (1.0, -1.0)):
            rest = table[:, 0] + sign * (g * table[:, 1] + pole)
            found += (rest @ self._sums(sign, pressure).reshape(len(self._x), -1)).reshape(found.shape)
        return found

    def _sums(self, sign: float, pressure: Weighted) -> NDArray[np.float64]:
        """What of each tabulated distance comes from polynomials there, (distances, places, terms).

        Args:
            sign: 1 for places ahead of the loads, -1 for those behind.
            pressure: its polynomials.
        """
        α, β = (pressure.α, pressure.β) if sign > 0.0 else (pressure.β, pressure.α)
        found = np.zeros((len(self._x), len(self._X), pressure.terms))
        # As if ahead, in the mirror image: loads from -1 up to X or 1.
        for n, X in enumerate(sign * self._X):
            if X > -1.0:
                last, beyond = min(X, 1.0), max(X - 1.0, 0.0)
                near, far, w = _both_ends(last + 1.0)
                w = w * (1.0 - last + near) ** α * far**β
                loads = np.where(near < far, last - near, far - 1.0)
                found[:, n] = self._told(beyond + near).T @ (
                    w[:, None] * pressure.polynomials(sign * loads)
                )
        return found

    def _told(self, x: NDArray) -> NDArray[np.float64]:
        """Values at distances by those that are tabulated, (x, distances)."""
        edges = self._edges
        panel = np.clip(np.searchsorted(edges, x, side="right") - 1, 0, len(edges) - 2)
        t, _ = leggauss(_POINTS)
        local = 2.0 * (x - edges[panel]) / (edges[panel + 1] - edges[panel]) - 1.0
        by_point = np.linalg.solve(legvander(t, _POINTS - 1).T, legvander(local, _POINTS - 1).T).T
        found = np.zeros((len(x), len(edges) - 1, _POINTS))
        found[np.arange(len(x)), panel] = by_point
        return found.reshape(len(x), -1)

    @cached_property
    def _edges(self) -> NDArray[np.float64]:
        """Of panels of distances."""
        near = 2.0 ** -np.arange(_NEAR, 1, -1.0)
        last = 1.0 + float(np.abs(self._X).max())
        near = near[near < _EVEN]
        even = np.linspace(_EVEN, last, int(np.ceil((last - _EVEN) / _EVEN)) + 1)
        return divided(np.concatenate([[0.0], near, even]), self._s, self._slowest)

    @cached_property
    def _x(self) -> NDArray[np.float64]:
        t, _ = leggauss(_POINTS)
        half = np.diff(self._edges)[:, None] / 2.0
        return np.asarray((self._edges[:-1, None] + half * (1.0 + t)).ravel())

    @cached_property
    def _tables(self) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
        """û,X of σ_YY and σ_XY ahead and behind at all distances for every s, (s, 2, distances) each."""
        ahead, behind = (
            np.array([at_any(kernel, self._x, s, True)[2:] for s in self._s]) for kernel in self._kernels
        )
        return ahead, behind


def _hilbert(X: NDArray, pressure: Weighted, σ: NDArray) -> NDArray[np.float64]:
    """(1/π) ⨍ of the polynomials with their weight over t - X, (n, terms); ``σ`` are these at X."""
    found = np.empty_like(σ)
    under = np.abs(X) < 1.0
    t, w = pressure.rule(_FEW)
    P = w[:, None] * pressure.polynomials(t)
    found[~under] = (1.0 / (t - X[~under, None])) @ P
    # That of the weight is π cot(πα) times it; what is left is a polynomial.
    over = 1.0 / (t - X[under, None])
    rest = over @ P - (over @ w)[:, None] * pressure.polynomials(X[under])
    found[under] = rest + pi / np.tan(pi * pressure.α) * σ[under]
    return np.asarray(found / pi)


def _both_ends(length: float) -> tuple[NDArray, NDArray, NDArray]:
    """Double exponential rule: distances from the right and the left end, and weights, (steps,) each."""
    u = np.linspace(-_LENGTH, _LENGTH, _STEPS)
    grown = pi * np.sinh(u)
    right, left = 1.0 / (1.0 + np.exp(-grown)), 1.0 / (1.0 + np.exp(grown))
    weights = (u[1] - u[0]) * pi * np.cosh(u) * right * left
    return length * right, length * left, length * weights
