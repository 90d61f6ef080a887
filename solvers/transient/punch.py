"""A flat punch that is pressed on and slides from rest at constant speed: integral equation in time.

What depends on time is solved as a convolution: quadrature by Radau IIA of three stages (Lubich), of
order five, so that Laplace's transform of the response is all that is needed.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, pi

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from galinx.solvers.solids.solid import Response
from galinx.solvers.transient.surface import AlongSurface
from galinx.solvers.transient.transform import Transformed

#: Rounding that the scaling of steps back in time may enlarge.
_SCALED = 1e-15
#: Length of the quadrature over what is told of it: near its end rounding is enlarged most.
_LONGER = 1.5
#: Distance over a beyond the ends of the contact at which σ_XX is told: it is infinite at them.
BESIDE = 0.05
#: Places X over a under the punch at which the pressure is told, closer towards the ends.
PLACES = -np.cos(pi * (np.arange(81) + 0.5) / 81)
#: Distances over a from the ends at which stresses beside the punch are told, and all places X over a.
_BEYOND = np.geomspace(0.01, 1.0, 24)
ON_SURFACE = np.concatenate([-1.0 - _BEYOND[::-1], PLACES, 1.0 + _BEYOND])


def smooth(t: NDArray, length: float) -> NDArray[np.float64]:
    """Share of the load at times t: 10s³ - 15s⁴ + 6s⁵, s = t/length, up to 1."""
    s = np.clip(np.asarray(t, dtype=float) / length, 0.0, 1.0)
    return s**3 * (10.0 - 15.0 * s + 6.0 * s * s)


@dataclass(frozen=True)
class Course:
    """What happens over time; lengths over a, times over a/c_s, stresses over N/(2a).

    Attributes:
        t: times, (times,), > 0.
        v0: indentation of the surface under the punch over N/(2μ), from when all was at rest.
        load: over N.
        centre: of the pressure over a.
        K_left, K_right: normalised intensities of the pressure at X = -a and X = a, by the exponents of
            steady motion and over the final load, as those of the steady state.
        work_of_load: ∫ N dv₀ over N²/(4μ).
        work_of_friction: ∫∫ σ_XY u̇ dX dt, u̇ as seen from the punch, over N²/(4μ): what friction gives to
            the motion of the solid besides being carried past the punch.
        σ_YY: under the punch at ``PLACES``, (times, places).
        σ_XX_left, σ_XX_right: in-plane stress on the free surface at ``BESIDE`` beyond both ends.
    """

    t: NDArray[np.float64]
    v0: NDArray[np.float64]
    load: NDArray[np.float64]
    centre: NDArray[np.float64]
    K_left: NDArray[np.float64]
    K_right: NDArray[np.float64]
    work_of_load: NDArray[np.float64]
    work_of_friction: NDArray[np.float64]
    σ_YY: NDArray[np.float64]
    σ_XX_left: NDArray[np.float64]
    σ_XX_right: NDArray[np.float64]


class StartingPunch:
    """All starts from rest at one speed.

    Args:
        response: of steady motion at that speed; tells the solid's stiffness and the exponents.
        rayleigh: speed of the wave along the surface over c_s.
        end: last time over a/c_s.
        steps: of the quadrature.
        terms: polynomials of the pressure.
    """

    def __init__(
        self, response: Response, rayleigh: float, end: float, steps: int, terms: int = 24
    ) -> None:
        self._response, self._end, self._steps, self._terms = response, end, steps, terms
        longer = ceil(_LONGER * steps)
        self._scheme = Radau(end / steps * longer, longer)
        self._transformed = Transformed(response, rayleigh, self._scheme.s, terms)
        self._along = AlongSurface(response, rayleigh, self._scheme.s, ON_SURFACE)

    def course(self, g: float, load: Callable[[NDArray], NDArray]) -> Course:
        """What happens where σ_XY = g σ_YY under the punch and N grows by the share ``load(t)``."""
        basis = self._transformed.basis(g)
        (answers,) = self._transformed.answers(basis)
        along = self._transformed.along(basis, answers[:, :-1])
        strains = self._transformed.strains(basis, answers[:, :-1], BESIDE)
        found = self._scheme.convolved(np.hstack([answers, along, strains]), load)[: self._steps]
        a, v0 = found[:, : self._terms], found[:, self._terms]
        t = np.arange(1.0, self._steps + 1.0) * (self._end / self._steps)
        u, u_X = found[:, self._terms + 1 : -2], found[:, -2:]
        σ_XX = self._response.σ_XX(u_X, np.zeros_like(u_X), np.zeros_like(u_X))
        by_load = _work(t, 2.0 * load(t)[:, None], v0[:, None])
        normal = a @ basis.moments
        # Inertia adds r log r to what the polynomials tell at a distance r from an end, so that their
        # sum there converges with the square of their number; half of them say how.
        whole, half = (a[:, :n] @ basis.ends[:, :n].T for n in (self._terms, self._terms // 2))
        left, right = -(whole + (whole - half) / 3.0).T / 2.0
        return Course(
            t, v0, -normal[:, 0] / 2.0, normal[:, 1] / normal[:, 0], left, right, by_load,
            g * _work(t, a, u), a @ basis.pressures(PLACES).T, *σ_XX.T,
        )  # fmt: skip

    def along_surface(self, g: float, load: Callable[[NDArray], NDArray]) -> NDArray[np.float64]:
        """σ_XX, σ_YY and σ_XY over N/(2a) at ``ON_SURFACE`` of :meth:`course`, (3, times, places)."""
        basis = self._transformed.basis(g)
        (answers,) = self._transformed.answers(basis)
        a = answers[:, :-1]
        strains = self._along.strains(g, (basis.α, basis.β), basis.polynomials, a)
        found = self._scheme.convolved(np.hstack([a, strains]), load)[: self._steps]
        under = np.abs(ON_SURFACE) < 1.0
        σ_YY = np.zeros((self._steps, len(ON_SURFACE)))
        σ_YY[:, under] = found[:, : self._terms] @ basis.pressures(ON_SURFACE[under]).T
        u_X = found[:, self._terms :]
        return np.array([self._response.σ_XX(u_X, σ_YY, g * σ_YY), σ_YY, g * σ_YY])


def _work(t: NDArray, forces: NDArray, ways: NDArray) -> NDArray[np.float64]:
    """∫ Σ force d(way) up to each time from rest at t = 0, (times,); forces and ways are (times, n)."""
    times, still = np.append(0.0, t), np.zeros((1, forces.shape[1]))
    F, u = (CubicSpline(times, np.concatenate([still, one])) for one in (forces, ways))
    y, w = np.polynomial.legendre.leggauss(4)
    half = np.diff(times)[:, None] / 2.0
    at = times[:-1, None] + half * (1.0 + y)
    return np.asarray(np.cumsum(((F(at) * u(at, 1)).sum(axis=-1) * w * half).sum(axis=-1)))


class Radau:
    """Convolution quadrature by Radau IIA of three stages.

    Args:
        end: last time.
        steps: of equal length.

    Attributes:
        s: where Laplace's transform of a response is needed, (values,).
    """

    def __init__(self, end: float, steps: int) -> None:
        root = np.sqrt(6.0)
        A = np.array([
            [(88.0 - 7.0 * root) / 360.0, (296.0 - 169.0 * root) / 1800.0, (-2.0 + 3.0 * root) / 225.0],
            [(296.0 + 169.0 * root) / 1800.0, (88.0 + 7.0 * root) / 360.0, (-2.0 - 3.0 * root) / 225.0],
            [(16.0 - root) / 36.0, (16.0 + root) / 36.0, 1.0 / 9.0],
        ])  # fmt: skip
        self._steps, h = steps, end / steps
        nodes = A.sum(axis=1)
        self._times = h * (np.arange(steps)[:, None] + nodes)
        self._scale = _SCALED ** (np.arange(steps) / (2.0 * steps))
        half = steps // 2 + 1
        ζ = _SCALED ** (0.5 / steps) * np.exp(-2j * pi * np.arange(half) / steps)
        Δ = np.linalg.inv(A + (ζ / (1.0 - ζ))[:, None, None] * np.outer(np.ones(3), A[-1]))
        values, self._vectors = np.linalg.eig(Δ)
        self.s = (values / h).ravel()

    def convolved(self, response: NDArray, given: Callable[[NDArray], NDArray]) -> NDArray[np.float64]:
        """What a response makes of what is given over time, after each step.

        Args:
            response: its transform at ``s``, (values, n).
            given: function of time.
        """
        scaled = np.fft.rfft(given(self._times) * self._scale[:, None], axis=0)
        modes = np.linalg.solve(self._vectors, scaled[..., None])[..., 0]
        answered = modes[..., None] * response.reshape(*modes.shape, -1)
        last = np.einsum("fm,fmn->fn", self._vectors[:, -1], answered)
        return np.fft.irfft(last, self._steps, axis=0) / self._scale[:, None]
