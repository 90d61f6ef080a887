"""Integrals (1/π) Re ∫₀^∞ f(k) e^(ikx) dk of functions that are smooth piece by piece.

On panels f is a sum of Legendre polynomials, whose integrals with e^(ikx) are spherical Bessel functions:
what decides about the panels is f alone, and any x costs the same.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.errors import SolveError
from galinx.solvers.panel import legendre_panel

#: Gauss points of a panel, their weights, from values to coefficients of Legendre polynomials.
_NODES = 16
_τ, _w, _TO_LEGENDRE = legendre_panel(_NODES)
#: Coefficients that tell how well a panel is resolved; most panels, and rounds of halving them; octaves
#: that are taken at once.
_LAST, _MOST, _ROUNDS, _AT_ONCE = 3, 4000, 60, 9
#: Positions whose integrals are taken at once, in numbers held.
_TOGETHER = 400_000


@dataclass(frozen=True)
class Transform:
    """Such integrals of several functions.

    Attributes:
        middle, half: of the panels, (panels,).
        coefficients: of Legendre polynomials, (panels, nodes, functions).
        error: of the integrals, by what the last coefficients and the last panel are.
        size: integral of the largest |f|.
    """

    middle: NDArray[np.float64]
    half: NDArray[np.float64]
    coefficients: NDArray[np.complex128]
    error: float
    size: float

    def __call__(self, x: NDArray) -> NDArray[np.float64]:
        """The integrals at positions, (..., functions)."""
        flat = np.ravel(np.asarray(x, dtype=float))
        found = np.empty((len(flat), self.coefficients.shape[-1]))
        many = max(_TOGETHER // (len(self.half) * _NODES), 1)
        turned = self.coefficients * (2.0 * 1j ** np.arange(_NODES))[:, None]
        for first in range(0, len(flat), many):
            some = flat[first : first + many]
            bessel = spherical_bessel(_NODES, np.outer(some, self.half))
            phase = self.half * np.exp(1j * np.outer(some, self.middle))
            weights = bessel * phase[..., None]
            found[first : first + many] = np.tensordot(weights, turned, 2).real / np.pi
        return found.reshape(*np.shape(x), -1)


def spherical_bessel(count: int, z: NDArray) -> NDArray[np.float64]:
    """j₀ … j_(count - 1) of real z, (..., count).

    Upwards where |z| is larger than the order, downwards from where they vanish elsewhere.
    """
    size = np.abs(z)
    found = np.empty((*z.shape, count))
    far = size > count
    safe = np.where(far, z, 1.0)
    found[..., 0] = np.sin(safe) / safe
    found[..., 1] = (found[..., 0] - np.cos(safe)) / safe
    for n in range(1, count - 1):
        found[..., n + 1] = (2 * n + 1) / safe * found[..., n] - found[..., n - 1]
    near = z[~far]
    tiny = np.abs(near) < 1e-8
    safe = np.where(tiny, 1.0, near)
    start = 2 * count + 14
    after, value = np.zeros_like(safe), np.full_like(safe, 1e-290)
    falling = np.empty((len(safe), count))
    for n in range(start, 0, -1):
        after, value = value, (2 * n + 1) / safe * value - after
        big = np.abs(value) > 1e200
        if big.any():
            scale = np.where(big, 1e-200, 1.0)
            after, value = after * scale, value * scale
            falling[:, n:] *= scale[:, None]
        if n - 1 < count:
            falling[:, n - 1] = value
    j0, j1 = np.sinc(safe / np.pi), np.sin(safe) / safe**2 - np.cos(safe) / safe
    by_first = np.abs(j0) >= np.abs(j1)
    with np.errstate(invalid="ignore", divide="ignore"):
        scale = np.where(by_first, j0 / falling[:, 0], j1 / falling[:, 1])
    falling *= scale[:, None]
    falling[tiny] = np.eye(1, count)[0]
    falling[tiny, 1] = near[tiny] / 3.0
    found[~far] = falling
    return found


def transform(
    f: Callable[[NDArray], NDArray], first: float, tolerance: float, scale: float = 0.0
) -> Transform:
    """Panels on which f is resolved.

    Args:
        f: of wavenumbers (n,), gives (n, functions).
        first: end of the first panel; the others double, until f is small.
        tolerance: of the integrals over that of |f|, or over ``scale`` where that is larger.

    Raises:
        SolveError: f does not become small, or is not smooth.
    """
    edges = first * 2.0 ** np.arange(_AT_ONCE)
    waiting = list(pairwise([0.0, *edges]))
    done: list[tuple[float, float, NDArray, float]] = []
    for _ in range(_ROUNDS):
        halves, middles = (np.array([(b + sign * a) / 2.0 for a, b in waiting]) for sign in (-1.0, 1.0))
        values = f((middles[:, None] + halves[:, None] * _τ).ravel())
        if not np.isfinite(values).all():
            raise SolveError("the stiffness of the surface is not finite at some wavenumber")
        c = _TO_LEGENDRE @ values.reshape(len(waiting), _NODES, -1)
        tails = 2.0 * halves * np.abs(c[:, -_LAST:]).max(axis=(1, 2))
        done += zip(middles.tolist(), halves.tolist(), c, tails.tolist())
        wholes = [2.0 * half * np.abs(one).max() for _, half, one, _ in done]
        size = max(float(sum(wholes)), scale)
        rough = [tail > tolerance * size / 10.0 for *_, tail in done]
        last = edges[-1]
        end = sum(w for w, (middle, *_) in zip(wholes, done) if middle > last / 2.0)
        waiting = [
            side
            for (middle, half, *_), again in zip(done, rough)
            if again
            for side in ((middle - half, middle), (middle, middle + half))
        ]
        done = [one for one, again in zip(done, rough) if not again]
        if not waiting and end > tolerance * size / 10.0:
            edges = last * 2.0 ** np.arange(_AT_ONCE)
            waiting = list(pairwise(edges))
        if not waiting:
            middle, half, coefficients, tail = zip(*done)
            error = sum(tail) + end
            return Transform(np.array(middle), np.array(half), np.array(coefficients), error, size)
        if len(done) + len(waiting) > _MOST:
            break
    raise SolveError("the stiffness of the surface is no smooth function of the wavenumber")
