"""Friction that varies along the contact: given over X/a, or that of bristles that enter it at rest.

In steady sliding bristles belong to the surface. They enter the contact at its leading end, and have
slipped their distance from that end: f over X/a is f of the law over its slip.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from ..approximation import legendre_panel
from .integrate import exactly
from .law import FrictionLaw

#: Gauss points of a panel, and from values there to coefficients of Legendre polynomials.
_NODES = 16
_τ, _w, _TO_LEGENDRE = legendre_panel(_NODES)
#: Last coefficients over the largest value at which a panel is not halved further, of functions known to
#: all digits and of those integrated; number of these; least half-length; most panels.
_DIGITS, _INTEGRATED, _LAST, _SHORTEST, _MOST = 1e-12, 1e-9, 2, 1e-9, 4000
#: Length of panels over their distance from the nearer end below which they surround a kink.
_BESIDE = 1e-3
#: Size of Bernstein's ellipse through a place from which Gauss's rule alone serves a panel.
_NEAR = 3.5


class Piecewise:
    """Function on [-1, 1] as Legendre polynomials on panels, halved until they resolve it.

    Args:
        function: values at positions, (n,): (n,).
        breaks: positions at which it is not smooth.
        digits: last coefficients over the largest value at which a panel is not halved further.

    Raises:
        ValueError: too many panels would be needed.

    Attributes:
        ends: of the panels, (panels + 1,).
        c: coefficients, (panels, nodes).
    """

    def __init__(
        self,
        function: Callable[[NDArray], NDArray],
        breaks: Sequence[float] = (),
        digits: float = _DIGITS,
    ) -> None:
        left = np.array([-1.0, *breaks])
        half, size, done = np.diff([*left, 1.0]) / 2.0, 0.0, []
        while len(left):
            if len(left) + len(done) > _MOST:
                raise ValueError("friction along the contact is too rough to be resolved")
            t = (left + half)[:, None] + half[:, None] * _τ
            values = np.asarray(function(t.ravel())).reshape(t.shape)
            c, size = values @ _TO_LEGENDRE.T, max(size, float(np.abs(values).max()))
            good = (np.abs(c[:, -_LAST:]).max(axis=1) <= digits * size) | (half < _SHORTEST)
            done += list(zip(left[good], c[good]))
            half = np.repeat(half[~good] / 2.0, 2)
            left = np.repeat(left[~good], 2)
            left[1::2] += 2.0 * half[1::2]
        done.sort(key=lambda panel: panel[0])
        self.ends = np.array([*(start for start, _ in done), 1.0])
        self.c = np.array([c for _, c in done])

    @property
    def kinks(self) -> tuple[float, ...]:
        """Places towards which panels shrink from both sides: there the function is not smooth."""
        middle, width = (self.ends[1:] + self.ends[:-1]) / 2.0, np.diff(self.ends)
        short = np.flatnonzero(width < _BESIDE * (1.0 - np.abs(middle)))
        runs = np.split(short, np.flatnonzero(np.diff(short) > 1) + 1)
        return tuple(float(middle[run[np.argmin(width[run])]]) for run in runs if len(run))

    def __call__(self, t: NDArray) -> NDArray[np.float64]:
        """Values at positions t, beside [-1, 1] those of its ends, in the shape of t."""
        t = np.clip(t, -1.0, 1.0)
        panel = np.clip(np.searchsorted(self.ends, t, side="right") - 1, 0, len(self.c) - 1)
        start, end = self.ends[panel], self.ends[panel + 1]
        P = legendre.legvander((2.0 * t - start - end) / (end - start), _NODES - 1)
        return np.einsum("...k,...k->...", P, self.c[panel])

    @property
    def mean(self) -> float:
        """Mean over [-1, 1]."""
        return float(np.diff(self.ends) @ self.c[:, 0] / 2.0)

    def cauchy(self, t: NDArray) -> NDArray[np.float64]:
        """⨍ f(s)/(s - t) ds at real positions t off the ends of panels, (n,)."""
        total, half = np.zeros(len(t)), np.diff(self.ends) / 2.0
        at_nodes = self.c @ legendre.legvander(_τ, _NODES - 1).T * _w
        for c, values, start, end, h in zip(self.c, at_nodes, self.ends, self.ends[1:], half):
            τ = (t - start) / h - 1.0
            near = np.abs(τ) + np.sqrt(np.maximum(τ**2 - 1.0, 0.0)) < _NEAR
            total[~near] += (values / (_τ - τ[~near, None])).sum(axis=1)
            τ, Q = τ[near], [0.5 * np.log(np.abs((t[near] - start) / (t[near] - end)))]
            Q.append(τ * Q[0] - 1.0)
            for k in range(1, _NODES - 1):
                Q.append(((2 * k + 1) * τ * Q[k] - k * Q[k - 1]) / (k + 1))
            total[near] -= 2.0 * (c @ np.array(Q))
        return total


@dataclass(frozen=True)
class Along:
    """σ_XY/σ_YY over the contact.

    Attributes:
        ratio: σ_XY/σ_YY at positions X/a in [-1, 1].
        breaks: positions X/a inside at which its slope jumps.
    """

    ratio: Piecewise
    breaks: tuple[float, ...] = ()

    @property
    def mean(self) -> float:
        """Mean of σ_XY/σ_YY over X."""
        return self.ratio.mean

    def __call__(self, X: NDArray) -> NDArray[np.float64]:
        """σ_XY/σ_YY at X/a, beside the contact that at its nearer end, in the shape of X."""
        return self.ratio(X)

    @property
    def extremes(self) -> tuple[float, float]:
        """Least and largest σ_XY/σ_YY among 1001 positions."""
        values = self(np.linspace(-1.0, 1.0, 1001))
        return float(values.min()), float(values.max())


def tabulated(rows: Sequence[tuple[float, float]], factor: float) -> Along:
    """Friction linear between rows (X/a, f), from X/a = -1 to 1; σ_XY/σ_YY is ``factor`` times f."""
    X, f = np.transpose(rows)
    breaks = tuple(X[1:-1].tolist())
    return Along(Piecewise(lambda at: factor * np.interp(at, X, f), breaks), breaks)


def mean_of(rows: Sequence[tuple[float, float]]) -> float:
    """Mean over the contact of f that is linear between rows (X/a, f)."""
    X, f = np.transpose(rows)
    return float(np.diff(X) @ (f[1:] + f[:-1]) / 4.0)


def advected(law: FrictionLaw, s: int, V: float, a: float, stress_ratio: float) -> Along:
    """Friction of bristles that enter the contact at rest, in steady sliding.

    The punch drags the surface along, so it moves to the side to which σ_XY acts on the surface: towards
    X > 0 where σ_XY/σ_YY < 0.

    Args:
        law: the law of friction.
        s: direction, 1 or -1.
        V: speed [m/s].
        a: half-width of the contact [m].
        stress_ratio: σ_XY/σ_YY over f.

    Raises:
        ValueError: the law could not be integrated.
    """
    leading, start = -s * np.sign(stress_ratio), law.settle(law.rest(), s, V)

    def ratio(X: NDArray) -> NDArray[np.float64]:
        z = exactly(law, start, s, V, 2.0 * a, a * (1.0 - leading * X))
        return np.asarray(stress_ratio * law.friction(z, s, V))

    digits = _INTEGRATED if law.exact(start, s, V, np.zeros(1)) is None else _DIGITS
    values = Piecewise(ratio, (), digits)
    return Along(values, values.kinks)
