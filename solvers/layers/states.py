"""Punches on layers with any number of frictions at one speed.

The kernels know no friction, and what is read off a pressure, its weight aside, is an analytic function
of g = σ_XY/σ_YY: beyond a few frictions the equation is solved at Chebyshev's points in g, and what is
between them is interpolated.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.layers.contact import FIRST, Equation, Found, found
from galinx.solvers.layers.kernel import Kernel
from galinx.solvers.layers.stack import Stack

#: Chebyshev's points in g at first and at most; the last coefficients tell what is left.
_FEW, _MANY, _LAST = 9, 65, 2


@dataclass(frozen=True)
class Speed:
    """What all frictions at a speed share.

    Attributes:
        response: of the surface's solid.
        stack: layers with their substrate, lengths over a.
        slope: μ v,X under the punch over N/(2a) at given r.
        tolerance: relative.
    """

    response: Any
    stack: Stack
    slope: Callable[[NDArray], NDArray]
    tolerance: float

    @cached_property
    def kernel(self) -> Kernel:
        return Kernel(self.stack, self.tolerance / 1e3)

    def solved(self, g: NDArray) -> tuple["Frictions", NDArray[np.float64]]:
        """Pressures at frictions from which those at all of ``g`` follow, and the error that leaves.

        Args:
            g: wanted, sorted, (states,).
        """
        if len(g) <= _FEW:
            return self._together(g, self._each(g)), np.zeros(1)
        count = _FEW
        middle, half = (g[-1] + g[0]) / 2.0, (g[-1] - g[0]) / 2.0
        while True:
            nodes = middle + half * np.cos(np.pi * np.arange(count) / (count - 1))
            here = self._together(nodes, self._each(nodes))
            left = here.unresolved
            if left <= self.tolerance / 10.0 or count >= _MANY or count >= len(g):
                return here, np.array([left])
            count = 2 * count - 1

    def _together(self, g: NDArray, each: list[Any]) -> "Frictions":
        return Frictions(g, each)

    def _each(self, g: NDArray) -> list[Found]:
        answers: list[Found] = []
        first = FIRST
        for value in g.tolist():
            equation = Equation(self.response, self.kernel, value, self.slope)
            answers.append(found(equation, self.tolerance, first))
        return answers

    @property
    def rounding(self) -> float:
        """What the kernel's own error does to the pressure, relative."""
        return 2.0 * np.pi * self.kernel.error / abs(self.response.n)


@dataclass(frozen=True)
class Frictions:
    """Pressures at some frictions, from which those at others are interpolated.

    Attributes:
        g: σ_XY/σ_YY, (nodes,).
        each: the pressures.
    """

    g: NDArray[np.float64]
    each: list[Found]

    @property
    def near(self) -> float:
        """|r| up to which all pressures are known without their weights."""
        return min(one.near for found in self.each for one in (found.pressure, found.before))

    def read(self, what: Callable[[Any], NDArray]) -> NDArray[np.float64]:
        """What is read off every pressure, (nodes, ...)."""
        return np.array([what(one.pressure) for one in self.each])

    def both(self, what: Callable[[Any], NDArray]) -> NDArray[np.float64]:
        """The same, and with fewer unknowns, (2, nodes, ...)."""
        return np.array([self.read(what), [what(one.before) for one in self.each]])

    @cached_property
    def unresolved(self) -> float:
        """Of the pressures as a function of g, by their last Chebyshev coefficients, relative."""
        values = self.smooth
        x = np.cos(np.pi * np.arange(len(self.g)) / (len(self.g) - 1))
        c = np.linalg.solve(np.polynomial.chebyshev.chebvander(x, len(x) - 1), values)
        return float(np.abs(c[-_LAST:]).max() / np.abs(values).max())

    @property
    def smooth(self) -> NDArray[np.float64]:
        """What is looked at of every pressure, (nodes, n)."""
        r = np.array([-1.0, -0.6, 0.0, 0.6, 1.0])
        return self.read(lambda pressure: pressure.series(r))

    def at(self, g: NDArray) -> NDArray[np.float64]:
        """What turns values of every pressure into those at other frictions, (states, nodes)."""
        difference = g[:, None] - self.g
        same = difference == 0.0
        if same.any(axis=1).all():
            return same / same.sum(axis=1, keepdims=True)
        weights = (-1.0) ** np.arange(len(self.g))
        weights[[0, -1]] /= 2.0
        terms = weights / np.where(same, 1.0, difference)
        terms = np.where(same.any(axis=1, keepdims=True), same, terms)
        return np.asarray(terms / terms.sum(axis=1, keepdims=True))

    @property
    def change(self) -> float:
        """Largest change with the number of polynomials."""
        return max(one.change for one in self.each)
