"""Functions on an interval by polynomials on panels, fine towards 0, to be looked up many times."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from galinx.solvers.errors import SolveError

#: Nodes of a panel, Chebyshev's, and from values there to coefficients.
_NODES = 16
_x = np.cos(np.pi * (np.arange(_NODES) + 0.5) / _NODES)
_TO_CHEBYSHEV = np.linalg.inv(chebyshev.chebvander(_x, _NODES - 1))
#: Coefficients that tell how well a panel is resolved; most panels.
_LAST, _MOST = 3, 6000


@dataclass(frozen=True)
class Table:
    """Functions by position.

    Attributes:
        ends: of the panels, rising, (panels + 1,).
        coefficients: of Chebyshev polynomials, (panels, nodes, functions).
        error: absolute, by the last coefficients.
    """

    ends: NDArray[np.float64]
    coefficients: NDArray[np.float64]
    error: float

    def __call__(self, x: NDArray) -> NDArray[np.float64]:
        """Values, (..., functions)."""
        x = np.asarray(x, dtype=float)
        flat = x.ravel()
        panel = np.clip(np.searchsorted(self.ends, flat) - 1, 0, len(self.ends) - 2)
        left, right = self.ends[panel], self.ends[panel + 1]
        T = chebyshev.chebvander((2.0 * flat - left - right) / (right - left), _NODES - 1)
        found = np.empty((len(flat), self.coefficients.shape[-1]))
        # Panel by panel: to gather coefficients for every position would take longer than to use them.
        order = np.argsort(panel, kind="stable")
        met, first = np.unique(panel[order], return_index=True)
        for i, some in zip(met.tolist(), np.split(order, first[1:])):
            found[some] = T[some] @ self.coefficients[i]
        return found.reshape(*x.shape, found.shape[-1])


def tabulated(f: Callable[[NDArray], NDArray], finest: float, reach: float, tolerance: float) -> Table:
    """A table of f over [-reach, reach].

    Args:
        f: of positions (n,), gives (n, functions); it may be rough at 0.
        finest: size of the panels next to 0; the others double.
        reach: where the table ends.
        tolerance: absolute.

    Raises:
        SolveError: f is not smooth.
    """
    count = max(int(np.ceil(np.log2(reach / finest))), 0)
    right = np.append(0.0, reach * 0.5 ** np.arange(count, -1, -1.0))
    ends = np.concatenate([-right[:0:-1], right])
    waiting = np.column_stack([ends[:-1], ends[1:]])
    done: list[tuple[float, float, NDArray, float]] = []
    while len(waiting):
        middle, half = waiting.mean(axis=1), np.diff(waiting, axis=1)[:, 0] / 2.0
        values = f((middle[:, None] + half[:, None] * _x).ravel()).reshape(len(waiting), _NODES, -1)
        c = _TO_CHEBYSHEV @ values
        tail = np.abs(c[:, -_LAST:]).max(axis=(1, 2))
        good = (tail <= tolerance) | (half <= finest / 1024.0)
        done += zip(*waiting[good].T.tolist(), c[good], tail[good].tolist())
        middle, rough = middle[~good, None], waiting[~good]
        waiting = np.concatenate([np.hstack([rough[:, :1], middle]), np.hstack([middle, rough[:, 1:]])])
        if len(done) + len(waiting) > _MOST:
            raise SolveError("the kernel of the layers varies too much to be tabulated")
    done.sort(key=lambda one: one[0])
    left, _, coefficients, tails = zip(*done)
    return Table(np.append(left, reach), np.array(coefficients), max(tails))
