"""A flat punch on a half-plane by Laplace's transform in time: pressure and indentation at each s."""

from functools import cached_property
from math import ceil

import numpy as np
from numpy.polynomial.legendre import leggauss, legvander
from numpy.typing import NDArray

from galinx.solvers.solids.solid import Response
from galinx.solvers.transient.basis import Basis, Weighted, shared
from galinx.solvers.transient.panels import divided
from galinx.solvers.transient.sides import Side, both_sides

#: Octaves of panels towards distances 0 and 2 of points under the punch (so many fewer there), and
#: Gauss's points of each.
_NEAR, _FAR, _POINTS = 24, 5, 8
#: Largest width of a panel.
_EVEN = 0.125
#: Points that tell the response within so much of distance 2, where panels are shorter for what tests and
#: pressures share.
_TOLD = 24
#: Points of the pressure as seen from beside the contact.
_FEW = 96
#: More polynomials than there are.
_ALL = 10**6


class Transformed:
    """Every punch at one speed, for some s.

    Args:
        response: of steady motion at that speed; tells the solid's stiffness and the exponents.
        rayleigh: speed of the wave along the surface over c_s.
        s: over c_s/a, Re s >= 0 but not 0, (n,).
        terms: polynomials of the pressure.
        panel: largest width of a panel of distances over a.
        way: ±1, in which the punch moves along X.
    """

    def __init__(
        self, response: Response, rayleigh: float, s: NDArray, terms: int, panel: float = _EVEN,
        way: int = 1,
    ) -> None:  # fmt: skip
        self._response, self.s, self._terms, self._panel = response, s, terms, min(panel, _EVEN)
        self._kernels = both_sides(response, rayleigh, way)
        self._slowest = 1.0 / (rayleigh - response.c)

    def basis(self, g: float) -> Basis:
        """Of the pressure where σ_XY = g σ_YY."""
        return Basis(self._response, g, self._terms)

    def answers(
        self, basis: Basis, terms: tuple[int, ...] = (_ALL,)
    ) -> tuple[NDArray[np.complex128], ...]:
        """What a load N̂ makes for every s, by all polynomials or by the first of them.

        Returns:
            Coefficients of σ_YY over N̂/(2a), then v̂₀ over N̂/(2μ), (n, count + 1), for each of ``terms``.
        """
        matrices, found = self.sinking(basis, basis.tests), []
        for count in (min(one, self._terms) for one in terms):
            whole = np.zeros((len(self.s), count + 1, count + 1), dtype=complex)
            whole[:, :-1, :-1] = matrices[:, :count, :count]
            whole[:, 0, -1] = basis.tests.integral
            whole[:, -1, 0] = basis.pressure.integral
            load = np.zeros((len(self.s), count + 1, 1))
            load[:, -1] = -2.0
            found.append(np.asarray(np.linalg.solve(whole, load)[..., 0], dtype=complex))
        return tuple(found)

    def sinking(self, basis: Basis, tests: Weighted) -> NDArray[np.complex128]:
        """Tested v̂ of each polynomial of the pressure for every s, (s, tests, terms)."""
        ahead, behind = self._values
        g = basis.g
        return self._summed(basis, tests, ahead[:, 0] + g * ahead[:, 1], behind[:, 0] - g * behind[:, 1])

    def dragging(self, basis: Basis, tests: Weighted) -> NDArray[np.complex128]:
        """Tested û of each polynomial of the pressure for every s, (s, tests, terms)."""
        ahead, behind = self._values
        g = basis.g
        return self._summed(basis, tests, ahead[:, 2] + g * ahead[:, 3], g * behind[:, 3] - behind[:, 2])

    def _summed(
        self, basis: Basis, tests: Weighted, ahead: NDArray, behind: NDArray
    ) -> NDArray[np.complex128]:
        """A response by the distance, (s, distances), with what tests and polynomials share there."""
        both = shared(self._x, tests, basis.pressure)
        flat = both.reshape(2, len(self._x), -1) * self._weights[:, None]
        return (ahead @ flat[0] + behind @ flat[1]).reshape(-1, tests.terms, self._terms)

    def strains(self, basis: Basis, beyond: float) -> NDArray[np.complex128]:
        """û,X of each polynomial of the pressure on the surface beyond both ends, (s, 2, terms).

        Args:
            basis: of the pressure.
            beyond: distance over a from the ends.
        """
        X, w = self._few.rule(_FEW)
        at, weights = basis.pressure.rule(_FEW)
        trials = weights[:, None] * basis.pressure.polynomials(at)
        pressure = w[:, None] * self._few.polynomials(X) @ (self._few.polynomials(at).T @ trials)
        g = basis.g
        ahead, behind = self._slopes(beyond)
        return np.stack(
            [(behind[:, 2] - g * behind[:, 3]) @ pressure, (ahead[:, 2] + g * ahead[:, 3]) @ pressure],
            axis=1,
        )  # fmt: skip

    def _slopes(self, beyond: float) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
        """Of responses at points beside the contact to line loads under it, ahead and behind."""
        if beyond not in self._beside:
            X, _ = self._few.rule(_FEW)
            self._beside[beyond] = tuple(
                np.array([at_any(kernel, 1.0 + beyond - sign * X, s, True) for s in self.s])
                for kernel, sign in zip(self._kernels, (1.0, -1.0))
            )
        ahead, behind = self._beside[beyond]
        return ahead, behind

    @cached_property
    def _few(self) -> Weighted:
        """Polynomials that hold what is seen from beside the contact."""
        return Weighted(-0.5, -0.5, _FEW)

    @cached_property
    def _beside(self) -> dict[float, tuple[NDArray[np.complex128], ...]]:
        """Slopes by distance, for all frictions."""
        return {}

    @cached_property
    def _grid(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        near = 2.0 ** -np.arange(_NEAR, -1, -1.0)
        even = np.linspace(_EVEN, 2.0, ceil((2.0 - _EVEN) / self._panel), endpoint=False)
        towards = [near[near < _EVEN], even, 2.0 - near[near < _EVEN][:_FAR:-1]]
        edges = divided(np.concatenate([[0.0], *towards, [2.0]]), self.s, self._slowest)
        t, w = leggauss(_POINTS)
        half = np.diff(edges)[:, None] / 2.0
        return (edges[:-1, None] + half * (1.0 + t)).ravel(), (half * w).ravel()

    @property
    def _x(self) -> NDArray[np.float64]:
        return self._grid[0]

    @property
    def _weights(self) -> NDArray[np.float64]:
        return self._grid[1]

    @cached_property
    def _values(self) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
        """Responses ahead and behind at all distances for every s, (s, 4, distances) each."""
        t, _ = leggauss(_TOLD)
        order, middle, half = _TOLD - 1, 2.0 - _EVEN / 2.0, _EVEN / 2.0
        short = self._x > 2.0 - 0.5 * _EVEN
        between = legvander((self._x[short] - middle) / half, order) @ np.linalg.inv(legvander(t, order))
        x, found = np.append(self._x[~short], middle + half * t), []
        for kernel in self._kernels:
            values = np.array([at_any(kernel, x, s) for s in self.s])
            whole = np.empty((len(self.s), 4, len(short)), dtype=complex)
            whole[..., ~short] = values[..., :-_TOLD]
            whole[..., short] = values[..., -_TOLD:] @ between.T
            found.append(whole)
        return found[0], found[1]


def at_any(kernel: Side, x: NDArray, s: complex, slopes: bool = False) -> NDArray[np.complex128]:
    """Where Im s < 0 the transform of what is real is the conjugate."""
    return kernel(x, s, slopes) if s.imag >= 0.0 else np.conj(kernel(x, np.conj(s), slopes))
