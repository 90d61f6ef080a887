"""Friction from which on short waves along a sliding interface grow: its flutter threshold.

A solid slides on something rigid and flat, under Coulomb friction: v = 0 and σ_XY = g σ_YY on an infinite
surface. Waves e^(ik(X - ct)) along it obey the steady equations of the solid at the speed c, whatever the
sliding speed is, so that with (u,X, v,X) = 𝐘 (σ_XY, σ_YY)

    Y₂₂(c) + g Y₂₁(c) = 0,   which with L = 𝐘⁻¹ is   L₁₁(c) = g L₂₁(c).

They grow if Im c > 0, and at any length: the shorter, the faster (Renardy, J. Elasticity 27 (1992) 281;
Martins, Guimarães and Faria, J. Vib. Acoust. 117 (1995) 445). L₁₁/L₂₁ is analytic in the upper half of
the c plane. Growing waves have the real values that it takes there, on curves along which it is
monotonic, and these curves end on the real axis; the least of each sign is a value at such an end. Ends
are the speeds at which L₁₁/L₂₁ is real alone, and, where all waves leave the surface and it is real all
along, its extremes.
"""

from collections.abc import Callable, Iterator
from itertools import pairwise
from math import inf

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.transient.admittance import Admittance

#: Speeds that are looked at between two at which roots meet; between two of those, and how often again.
_SEEN, _CLOSER, _TIMES = 400, 64, 8
#: Imaginary part over the size from which on a ratio is not real.
_REAL = 1e-8
#: Share of the way to a stretch's end over which a slope is taken, and the least of the stretch.
_STEP, _LEAST = 1e-5, 1e-13


def thresholds(surface: Admittance) -> tuple[float, float]:
    """Least g > 0, and least -g > 0, from which on waves grow; infinite where none do.

    Args:
        surface: of the solid that slides.
    """
    ends = np.concatenate([[0.0], surface.meeting])
    values: list[float] = []
    mirrored = surface.c16 == 0.0 == surface.c26  # L₁₁/L₂₁ changes sign with c
    for way in (1.0, -1.0)[: 1 if mirrored else 2]:
        for low, high in pairwise(ends):
            values += _values(surface, lambda x: x, way * low, way * high)
    # Beyond the last, by 1/c: from one infinity to the other.
    values += _values(surface, lambda x: 1.0 / x, -1.0 / ends[-1], 1.0 / ends[-1])
    if mirrored:
        values += [-g for g in values]
    positive, negative = ([way * g for g in values if way * g > 0.0] for way in (1.0, -1.0))
    return min(positive, default=inf), min(negative, default=inf)


def _values(
    surface: Admittance, speed: Callable[[NDArray], NDArray], start: float, end: float
) -> Iterator[float]:
    """L₁₁/L₂₁ at the ends of curves on a stretch of the real axis."""

    def pair(x: NDArray) -> NDArray[np.complex128]:
        """L₁₁ and L₂₁ over their size, (2, ...)."""
        L = surface.waves(speed(x)).L[:, :, 0].T
        return np.asarray(L / np.linalg.norm(L, axis=0))

    def off(x: NDArray) -> NDArray[np.float64]:
        """How far from real their ratio is."""
        one, other = pair(x)
        return np.asarray((one * other.conj()).imag)

    def turn(x: NDArray) -> NDArray[np.float64]:
        """Slope of their ratio's angle, where it is real."""
        step = np.maximum(
            _STEP * np.minimum(np.abs(x - start), np.abs(end - x)), _LEAST * abs(end - start)
        )
        (one, other), (later, after) = pair(x - step), pair(x + step)
        return np.asarray((one.conj() * after - later * other.conj()).real / step)

    share = (1.0 - np.cos(np.pi * (np.arange(_SEEN) + 0.5) / _SEEN)) / 2.0
    x = start + share * (end - start)
    sign = off if np.abs(off(x)).max() > _REAL else turn
    at = sign(x)
    for i in np.flatnonzero((at[:-1] > 0.0) != (at[1:] > 0.0)):
        low, high = x[i], x[i + 1]
        for _ in range(_TIMES):
            closer = np.linspace(low, high, _CLOSER + 1)
            first = max(int(np.argmax((sign(closer) > 0.0) != (at[i] > 0.0))), 1)
            low, high = closer[first - 1], closer[first]
        one, other = pair(np.array([(low + high) / 2.0]))[:, 0].tolist()
        yield (one * other.conjugate()).real / abs(other) ** 2 if other else inf
