"""Friction that varies along the contact: given over X/a, or that of bristles that enter it at rest.

In steady sliding bristles belong to the surface. They enter the contact at its leading end, and have
slipped their distance from that end: f over X/a is f of the law over its slip.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.polynomial.chebyshev import chebvander
from numpy.typing import NDArray

from .integrate import closely, work
from .law import FrictionLaw

#: Points of a panel, its ends among them: no kink lies beside all; and a matrix that takes values there
#: to Chebyshev's coefficients.
_τ = -np.cos(np.pi * np.arange(16) / 15.0)
_TO_CHEBYSHEV = np.linalg.inv(chebvander(_τ, 15))
#: Last coefficients over the largest value up to which a panel resolves friction that is known exactly,
#: and that is integrated.
_EXACT, _INTEGRATED = 1e-12, 1e-7
#: Most rounding of a position X/a and of what is computed from it.
_ROUNDING = 8.0 * np.finfo(float).eps
#: Half-length of panels over their distance from the nearer end from which on those that resolve nothing
#: surround a kink, or a jump of a higher derivative, and at which they are no longer halved; most panels
#: of one length.
_BESIDE, _BESIDE_WEAK, _SHORTEST, _MOST = 1e-3, 1e-2, 1e-8, 400
#: Places at which the largest is sought, beside kinks.
_SAMPLES = 401
#: End of the first panel: panels end at no round number, where kinks are that they would not meet.
_FIRST = 0.0618033988


@dataclass(frozen=True)
class Along:
    """σ_XY/σ_YY over the contact.

    Attributes:
        mean: mean over X.
        ratio: σ_XY/σ_YY at positions X/a in [-1, 1], (n,): (n,).
        kinks: positions inside at which it is not smooth.
        weak_kinks: further ones, at which a higher derivative jumps; meshes follow them where they can.
        over: gives it for another half-width [m]; None where it does not depend on that.
        varies: False for one number all along the contact.
    """

    mean: float
    ratio: Callable[[NDArray], NDArray]
    kinks: tuple[float, ...] = ()
    weak_kinks: tuple[float, ...] = ()
    over: Callable[[float], "Along"] | None = None
    varies: bool = True

    def __call__(self, X: NDArray) -> NDArray[np.float64]:
        """σ_XY/σ_YY at X/a, beside the contact that at its nearer end, in the shape of X."""
        X = np.clip(X, -1.0, 1.0)
        return np.asarray(self.ratio(X.ravel())).reshape(X.shape)

    @property
    def jumps(self) -> tuple[float, ...]:
        """Positions inside at which it, or a derivative, jumps, rising."""
        return tuple(sorted({*self.kinks, *self.weak_kinks}))

    @property
    def largest(self) -> float:
        """σ_XY/σ_YY of the largest size."""
        g = self(np.unique([*np.linspace(-1.0, 1.0, _SAMPLES), *self.jumps]))
        return float(g[np.abs(g).argmax()])

    @property
    def has_length(self) -> bool:
        """True if it depends on the half-width of the contact."""
        return self.over is not None

    @property
    def opposed(self) -> "Along":
        """Friction of the other sign."""
        return replace(self, mean=-self.mean, ratio=lambda X: -self.ratio(X), over=None)

    def at(self, a: float) -> "Along":
        """σ_XY/σ_YY over a contact of another half-width a [m]."""
        return self.over(a) if self.over else self


def constant(g: float) -> Along:
    """Friction σ_XY/σ_YY = g all along the contact."""
    return Along(g, lambda X: np.full(X.shape, g), varies=False)


def tabulated(rows: Sequence[tuple[float, float]], factor: float) -> Along:
    """Friction linear between rows (X/a, f), from X/a = -1 to 1; σ_XY/σ_YY is ``factor`` times f."""
    X, f = np.transpose(rows)
    mean = float(np.diff(X) @ (f[1:] + f[:-1]) / 4.0)
    return Along(factor * mean, lambda at: factor * np.interp(at, X, f), tuple(X[1:-1].tolist()))


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
        z = closely(law, start, s, V, 2.0 * a, a * (1.0 - leading * X))
        return np.asarray(stress_ratio * law.friction(z, s, V))

    mean = s * stress_ratio * float(work(law, start, s, V, 2.0 * a)) / (2.0 * a)
    has_exact = law.exact(start, s, V, np.zeros(1)) is not None
    over = lru_cache(lambda a: advected(law, s, V, a, stress_ratio))
    digits = _EXACT if has_exact else _INTEGRATED
    kinks, all_kinks = (_kinks(ratio, digits, beside) for beside in (_BESIDE, _BESIDE_WEAK))
    return Along(mean, ratio, kinks, tuple(sorted({*all_kinks} - {*kinks})), over)


def _kinks(function: Callable[[NDArray], NDArray], digits: float, short: float) -> tuple[float, ...]:
    """Positions in (-1, 1) at which panels do not resolve a function before they are ``short``.

    Raises:
        ValueError: the function is not smooth in between.
    """
    left, half = np.array([-1.0, _FIRST]), np.array([1.0 + _FIRST, 1.0 - _FIRST]) / 2.0
    size, rough = 0.0, list[tuple[float, float]]()
    while len(left):
        t = (left + half)[:, None] + half[:, None] * _τ
        values = function(t.ravel()).reshape(t.shape)
        size = max(size, float(np.abs(values).max()))
        # Positions are rounded, all the more over their distance from an end.
        rounding = _ROUNDING * np.ptp(values, axis=1) / half
        unresolved = np.abs(values @ _TO_CHEBYSHEV[-2:].T).max(axis=1) > digits * size + rounding
        room, middle = half / (1.0 - np.abs(left + half)), left + half
        beside = unresolved & (room < short)
        rough += zip(half[beside].tolist(), middle[beside].tolist())
        halved = unresolved & (room > _SHORTEST)
        if halved.sum() > _MOST:
            raise ValueError(
                "friction changes along the contact too fast to be resolved; expected friction that "
                "develops over more slip, or by a rounder law"
            )
        left = (left[halved, None] + half[halved, None] * [0.0, 1.0]).ravel()
        half = np.repeat(half[halved] / 2.0, 2)
    kinks: list[float] = []
    for half_length, place in sorted(rough):  # the shortest panel about a kink comes first
        if all(abs(place - kink) > 2.0 * half_length for kink in kinks):
            kinks.append(place)
    return tuple(sorted(kinks))
