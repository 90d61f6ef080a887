"""A flat punch that is pressed on and slides from rest at constant speed: integral equation in time.

The equation is a convolution in time, which is solved in steps, so that Laplace's transform of the
response is all that is needed (:func:`march`). At the stages of step n, with the quadrature's weights W
of the response to σ_YY and g σ_YY ::

    Σ_m W_{n-m} [σ_m] = -v₀,      σ(t) = (1 - X)^α(t) (1 + X)^β(t) Σ a_j(t) P_j(X; t)

tested with fixed polynomials. Exponents are those of the friction of each moment. The displacement by
such a pressure is analytic in g: it is interpolated between a few frictions, Chebyshev's points of the
range, and the pressures before step n are kept as shares of the pressures of these.

The quadrature is Radau IIA of three stages, of order five (Lubich & Ostermann, Math. Comp. 60, 105,
1993): the convolution of a response K with f is, at the stages of step n, Σ_m W_{n-m} f_m, with weights
by Σ_k W_k ζ^k = K(Δ(ζ)/h) and the scheme's Δ(ζ) = (A + ζ/(1 - ζ) 1 bᵀ)⁻¹.

The residual of a motion in its integral equation is by steps and tests that it was not computed by: the
pressure's coefficients are interpolated to the stages of fewer steps, and the displacements that they
cause then are tested with more polynomials than the pressure has. Against the indentation these show what
steps, polynomials or a wrong number of the solution leave.

Strain along the surface, under the punch and beside it, is by Laplace's transform, too. At small
distances from a line load it is that of steady motion and a logarithm::

    û,X = q σ̂_YY + (n₁₂ + g m) H[σ̂_YY] + ∫ rest(X - ξ) σ̂_YY(ξ) dξ

The first two terms are exact for the polynomials that the pressure is made of. The rest is tabulated for
each s once, whatever the friction, and is smooth in each panel of distances but the one at 0.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..approximation import chebyshev_nodes, gauss_in_panels, polynomial_through
from ..contact.stresses import PLACES
from ..solids.half_plane import HalfPlane
from .history import History
from .line_load import both_sides, interpolation
from .transform import Basis, Transformed, Weighted, divided, double_exponential, turning_rate

#: Rounding of Laplace's transform, enlarged where steps are scaled back in time.
_ROUNDING = 1e-16
#: Length of the discrete transform over the number of steps: the longer, the less comes round.
_LONGER = 1.75
#: Stages.
STAGES = 3


class Radau:
    """Convolution quadrature over a number of equal steps.

    Args:
        end: last time.
        steps: their number.

    Attributes:
        s: arguments of Laplace's transform of a response, (values,).
        times: of all stages, (steps, stages); the last is the end of the step.
    """

    def __init__(self, end: float, steps: int) -> None:
        root = np.sqrt(6.0)
        A = np.array([
            [(88.0 - 7.0 * root) / 360.0, (296.0 - 169.0 * root) / 1800.0, (-2.0 + 3.0 * root) / 225.0],
            [(296.0 + 169.0 * root) / 1800.0, (88.0 + 7.0 * root) / 360.0, (-2.0 - 3.0 * root) / 225.0],
            [(16.0 - root) / 36.0, (16.0 + root) / 36.0, 1.0 / 9.0],
        ])  # fmt: skip
        self._steps, h = steps, end / steps
        self._length = ceil(_LONGER * steps)
        self.times = h * (np.arange(steps)[:, None] + A.sum(axis=1))
        # With this radius what comes round and the enlarged rounding are of one size.
        self._radius = _ROUNDING ** (1.0 / (steps + self._length))
        half = self._length // 2 + 1
        ζ = self._radius * np.exp(-2j * pi * np.arange(half) / self._length)
        Δ = np.linalg.inv(A + (ζ / (1.0 - ζ))[:, None, None] * np.outer(np.ones(STAGES), A[-1]))
        values, self._vectors = np.linalg.eig(Δ)
        self._inverse = np.linalg.inv(self._vectors)
        self.s = (values / h).ravel()

    def answered(self, response: NDArray, given: NDArray) -> NDArray[np.float64]:
        """Sum of a response's convolutions with many functions, after each step, (steps, n).

        Args:
            response: its transform at ``s``, (values, n, functions).
            given: functions at all stages, (steps, stages, functions).
        """
        scale = self._radius ** np.arange(self._steps)[:, None, None]
        scaled = np.fft.rfft(given * scale, self._length, axis=0)
        modes = self._inverse @ scaled
        answers = response.reshape(*modes.shape[:2], -1, modes.shape[2]) @ modes[..., None]
        last = np.einsum("fm,fmn->fn", self._vectors[:, -1], answers[..., 0])
        return np.asarray(np.fft.irfft(last, self._length, axis=0)[: self._steps] / scale[..., 0])

    def weights(self, response: NDArray) -> NDArray[np.float64]:
        """Weights W_0, W_1, … of a response, (steps, stages, stages, ...).

        Args:
            response: its transform at ``s``, (values, ...).
        """
        of_mode = response.reshape(-1, STAGES, *response.shape[1:])
        weights = np.empty((self._steps, STAGES, STAGES, *response.shape[1:]))
        scale = self._radius ** -np.arange(float(self._steps))
        for i in range(STAGES):
            for j in range(STAGES):
                both = self._vectors[:, i] * self._inverse[:, :, j]
                whole = np.fft.irfft(np.einsum("fm,fm...->f...", both, of_mode), self._length, axis=0)
                weights[:, i, j] = (whole[: self._steps].T * scale).T
        return weights


#: Accuracy over the largest pressure there, frictions at most, and frictions at which it is tested.
_ACCURACY, _MOST, _TESTED = 1e-10, 24, 7
#: Half-range of friction below which friction is constant: differences are rounding.
_SAME = 1e-13


class FrictionInterpolation:
    """Interpolation in friction: pressures of any g from ``least`` to ``most`` by those of a few.

    Args:
        response: of steady motion.
        least, most: g = σ_XY/σ_YY.
        terms: polynomials of the pressure.

    Attributes:
        bases: polynomials of the pressure at the few frictions.
        middle: polynomials at the middle of the range.
    """

    def __init__(self, response: HalfPlane, least: float, most: float, terms: int) -> None:
        self._response, self._terms = response, terms
        self._middle, self._half = (least + most) / 2.0, (most - least) / 2.0
        self.middle = Basis(response, self._middle, terms)
        low, high = self._middle - self._half, self._middle + self._half
        for count in (1,) if self._half < _SAME else range(2, _MOST + 1):
            self._at = polynomial_through(chebyshev_nodes(count, low, high))
            self.bases = [Basis(response, g, terms) for g in self._at.nodes.tolist()]
            if self._off() <= _ACCURACY:
                break

    def _off(self) -> float:
        values = np.array([basis.pressure(PLACES) for basis in self.bases])
        off = 0.0
        for share in np.cos(pi * np.arange(_TESTED) / (_TESTED - 1)):
            g = self._middle + self._half * share
            exact = Basis(self._response, g, self._terms).pressure(PLACES)
            interpolated = np.tensordot(self.shares(g), values, 1)
            off = max(off, float(np.abs(interpolated - exact).max() / np.abs(exact).max()))
        return off

    def shares(self, g: ArrayLike) -> NDArray[np.float64]:
        """Weights of the few frictions in the interpolation at frictions g, (...,): (..., few)."""
        within = np.clip(g, self._middle - self._half, self._middle + self._half)
        return self._at.shares(within.ravel()).reshape(*within.shape, -1)


#: Steps for which the effect of earlier steps is summed together.
_BLOCK = 16


def march(
    transformed: Transformed, scheme: Radau, between: FrictionInterpolation,
    g: History, load: History, steady: bool,
) -> tuple[NDArray[np.float64], ...]:  # fmt: skip
    """Pressure and indentation from t = 0 on, step after step.

    Args:
        transformed: responses at the scheme's s.
        scheme: of the steps.
        between: pressures of the frictions that occur.
        g: σ_XY/σ_YY at times.
        load: share of N at times.
        steady: True for steady motion before t = 0 at the load and friction of t = 0; False for rest.

    Returns:
        Coefficients in σ_YY of the polynomials of the few frictions before t = 0, (few·terms,), and what
        is added to them at all stages, (steps, stages, few·terms); coefficients of the pressure's own
        polynomials after each step, (steps, terms); and the indentation, (steps,).
    """
    tests, steps, terms = between.middle.tests, len(scheme.times), between.middle.tests.terms
    few, given = between.shares(g(scheme.times)), -2.0 * load(scheme.times)
    forces = [basis.pressure.integral for basis in between.bases]
    # Tested displacements by lag, stage and test, of the polynomials of each stage and friction.
    weights = np.empty((steps, STAGES, terms, STAGES, len(forces), terms))
    for n, basis in enumerate(between.bases):
        weights[..., n, :] = scheme.weights(transformed.tested(basis, tests)).swapaxes(2, 3)
    flat = weights.reshape(steps, STAGES * terms, -1)
    begun, added = np.zeros(len(forces) * terms), np.zeros((steps, STAGES, len(forces) * terms))
    if steady:
        start = between.shares(g(np.zeros(())))
        begun[::terms] = start * (-2.0 * float(load(np.zeros(()))) / (start @ forces))
    before = np.tile(-flat[0] @ np.tile(begun, STAGES), (steps, 1))
    a, v0, shape = np.empty((steps, terms)), np.empty(steps), (STAGES, terms + 1)
    for n, share in enumerate(few):
        first = n - n % _BLOCK
        if n == first:  # a weight serves many steps of the block
            for lag in range(1, last := min(first + _BLOCK, steps)):
                begin, end = max(0, first - lag), min(first, last - lag)
                if end > begin:
                    before[begin + lag : end + lag] += (
                        added[begin:end].reshape(end - begin, -1) @ flat[lag].T
                    )
        for m in range(first, n):
            before[n] += flat[n - m] @ added[m].ravel()
        whole, right = np.zeros((*shape, *shape)), np.empty(shape)
        whole[:, :-1, :, :-1] = np.einsum("itjfk,jf->itjk", weights[0], share)
        whole[range(STAGES), 0, range(STAGES), -1] = tests.integral
        whole[range(STAGES), -1, range(STAGES), 0] = share @ forces
        right[:, :-1], right[:, -1] = -before[n].reshape(STAGES, -1), given[n]
        x = np.linalg.solve(whole.reshape(right.size, right.size), right.ravel()).reshape(shape)
        added[n] = (share[:, :, None] * x[:, None, :-1]).reshape(STAGES, -1) - begun
        a[n], v0[n] = x[-1, :-1], x[-1, -1]
    return begun, added, a, v0


#: Steps over those of the solution, and polynomials of the tests besides as many as the pressure has.
_FEWER_STEPS, _MORE = 0.7, 8


#: Indentation over N/(2μ) and centre over a to which differences are relative at least.
LEAST = 1e-2


class Residual:
    """Residuals of motions at one speed.

    Args:
        response: of steady motion at that speed.
        rayleigh: speed of the wave along the surface over c_s.
        t: times over a/c_s of the solution, > 0, equal steps apart, (times,).
        terms: polynomials of the pressure.
        way: ±1, in which the punch moves along X.
    """

    def __init__(
        self, response: HalfPlane, rayleigh: float, t: NDArray, terms: int, way: int = 1
    ) -> None:
        self._response, self._t, self._terms = response, np.append(0.0, t), terms
        self._scheme = Radau(float(t[-1]), max(round(_FEWER_STEPS * len(t)), 1))
        self._transformed = Transformed(response, rayleigh, self._scheme.s, terms, way=way)

    def of(self, bases: Sequence[Basis], a: NDArray, v0: NDArray) -> float:
        """Largest tested displacement under the punch besides its indentation, over the largest of that.

        An indentation of less than ``LEAST`` over N/(2μ) counts as that.

        Args:
            bases: polynomials of the pressure.
            a: coefficients of their σ_YY, less those before t = 0, (times, bases·terms).
            v0: indentation since t = 0, (times,).
        """
        # The mean of their frictions changes sign in the mirror image, as they do.
        g = float(np.mean([basis.g for basis in bases]))
        tests = Basis(self._response, g, self._terms + _MORE).tests
        rows = np.concatenate([self._transformed.tested(basis, tests) for basis in bases], axis=2)
        v = self._scheme.answered(rows, self._interpolated(a, self._scheme.times))
        v[:, 0] += tests.integral * self._interpolated(v0, self._scheme.times[:, -1])
        largest = float(np.linalg.norm(v, axis=1).max())
        return largest / (tests.integral * max(float(np.abs(v0).max()), LEAST))

    def _interpolated(self, values: NDArray, t: NDArray) -> NDArray[np.float64]:
        """Values (times, ...), 0 at t = 0, at other times."""
        from scipy.interpolate import CubicSpline  # a slow import

        return np.asarray(CubicSpline(self._t, np.concatenate([0.0 * values[:1], values]))(t))


#: Octaves of panels towards the distance 0, largest width of a panel over a, and Gauss's points of each.
_NEAR, _EVEN, _POINTS = 24, 0.5, 14
#: Longest step of the double exponential rule along the contact, or its part on one side, and radians
#: by which waves turn from one of its points to the next, at most.
_STEP, _RADIANS = 0.028, 1.5
#: Points of the pressure in its effect beside the contact.
_FEW = 128


class AlongSurface:
    """Strain at places on the surface, at one speed and for given s.

    Args:
        response: of steady motion at that speed.
        rayleigh: speed of the wave along the surface over c_s.
        s: over c_s/a, Re s > 0, (n,).
        X: places over a, not at the ends of the contact, (places,).
        way: ±1, in which the punch moves along X.
    """

    def __init__(
        self, response: HalfPlane, rayleigh: float, s: NDArray, X: NDArray, way: int = 1
    ) -> None:
        self._response, self._X = response, X
        least, last = max(float(np.abs(X).min()) - 1.0, 0.0), 1.0 + float(np.abs(X).max())
        near = 2.0 ** -np.arange(_NEAR, 1, -1.0)
        even = np.linspace(_EVEN, last, int(np.ceil((last - _EVEN) / _EVEN)) + 1)
        edges = np.concatenate([[0.0], near[near < _EVEN], even])
        edges = edges[np.searchsorted(edges, least, side="right") - 1 :]
        # Edges of panels of distances over a, growing from 0, or from little less than the least.
        self._s, self._slowest = s, 1.0 / (rayleigh - response.c)
        self._edges = divided(edges, s, self._slowest)
        self._x, _ = gauss_in_panels(self._edges, _POINTS)
        panels = self._x.reshape(-1, _POINTS)
        # û,X of σ_YY and σ_XY ahead and behind at all distances for every s, (s, 2, distances) each.
        self._tables = [
            np.array([kernel((panels,), at, True)[2:] for at in s])
            for kernel in both_sides(response, rayleigh, way)
        ]

    def strains(self, basis: Basis) -> NDArray[np.complex128]:
        """û,X over N̂/(2aμ) of each polynomial of the pressure where σ_XY = g σ_YY, (s, places, terms)."""
        answer, X, g, pressure = self._response, self._X, basis.g, basis.pressure
        slope, under = answer.n12 + g * answer.m, np.abs(X) < 1.0
        σ = np.zeros((len(X), pressure.terms))
        σ[under] = pressure(X[under])
        local = answer.q * σ + slope * _hilbert(X, pressure, σ)
        strains = np.repeat(local[None].astype(np.complex128), len(self._tables[0]), axis=0)
        pole = slope / (pi * self._x)
        for table, sign in zip(self._tables, (1.0, -1.0)):
            rest = table[:, 0] + g * table[:, 1] + sign * pole
            sums = self._sums(sign, pressure).reshape(len(self._x), -1)
            strains += (rest @ sums).reshape(strains.shape)
        return strains

    def _sums(self, sign: float, pressure: Weighted) -> NDArray[np.float64]:
        """Weights of tabulated distances in the strain by polynomials, (distances, places, terms).

        Args:
            sign: 1 for places ahead of the loads, -1 for those behind.
            pressure: its polynomials.
        """
        α, β = (pressure.α, pressure.β) if sign > 0.0 else (pressure.β, pressure.α)
        sums = np.zeros((len(self._x), len(self._X), pressure.terms))
        # As if ahead, in the mirror image: loads from -1 up to X or 1.
        for n, X in enumerate(sign * self._X):
            if X > -1.0:
                last, beyond = min(X, 1.0), max(X - 1.0, 0.0)
                length, steepest = np.array([last + 1.0]), min(α, β)
                near, far, w = (of[0] for of in double_exponential(length, _STEP, steepest))
                # The weight of a point is its distance from the next one.
                radians = float((turning_rate(beyond + near, self._s, self._slowest) * w).max())
                if radians > _RADIANS:
                    step = _STEP * _RADIANS / radians
                    near, far, w = (of[0] for of in double_exponential(length, step, steepest))
                w = w * (1.0 - last + near) ** α * far**β
                loads = np.where(near < far, last - near, far - 1.0)
                sums[:, n] = self._interpolation(beyond + near).T @ (
                    w[:, None] * pressure.polynomials(sign * loads)
                )
        return sums

    def _interpolation(self, x: NDArray) -> NDArray[np.float64]:
        """Matrix from values at the tabulated distances to values at x, (x, distances)."""
        edges = self._edges
        panel = np.clip(np.searchsorted(edges, x, side="right") - 1, 0, len(edges) - 2)
        by_point = interpolation(
            _POINTS, 2.0 * (x - edges[panel]) / (edges[panel + 1] - edges[panel]) - 1.0
        )
        weights = np.zeros((len(x), len(edges) - 1, _POINTS))
        weights[np.arange(len(x)), panel] = by_point
        return weights.reshape(len(x), -1)


def _hilbert(X: NDArray, pressure: Weighted, σ: NDArray) -> NDArray[np.float64]:
    """Hilbert transform (1/π) ⨍ p(t)/(t - X) dt of the weighted polynomials p, (n, terms).

    Args:
        X: positions over a, (n,).
        pressure: the polynomials and their weight.
        σ: weighted polynomials at X, 0 beside the contact, (n, terms).
    """
    transform = np.empty_like(σ)
    under = np.abs(X) < 1.0
    t, w = pressure.rule(_FEW)
    P = w[:, None] * pressure.polynomials(t)
    transform[~under] = (1.0 / (t - X[~under, None])) @ P
    # The weight's own transform is π cot(πα) times it; the rest is a polynomial.
    over = 1.0 / (t - X[under, None])
    rest = over @ P - (over @ w)[:, None] * pressure.polynomials(X[under])
    transform[under] = rest + pi / np.tan(pi * pressure.α) * σ[under]
    return np.asarray(transform / pi)


#: Half-width and depth over a of the box round the punch whose energies are computed.
BOX = 3.0, 2.0
#: Distance over a beyond the ends of the contact at which σ_XX is computed: it is infinite at them.
BESIDE = 0.05
#: Distances over a from the ends of places beside the punch, and all places of stresses, X over a.
_BEYOND = np.geomspace(0.01, 1.0, 24)
ON_SURFACE = np.concatenate([-1.0 - _BEYOND[::-1], PLACES, 1.0 + _BEYOND])
_UNDER = np.abs(ON_SURFACE) < 1.0
_ENDS = np.array([-1.0 - BESIDE, 1.0 + BESIDE])


@dataclass(frozen=True)
class Course:
    """Motion of a flat punch over time; lengths over a, times over a/c_s, stresses over N/(2a).

    Attributes:
        t: times, (times,), > 0.
        v0: indentation of the surface under the punch over N/(2μ), 0 at rest.
        load: load over N.
        centre: centre of the pressure over a.
        K_left, K_right: normalised intensities of the pressure at X = -a and X = a, by the exponents of
            steady motion at the friction of each time, and over N.
        work_of_load: ∫ N dv₀ over N²/(4μ).
        work_of_friction: ∫∫ σ_XY u̇ dX dt, u̇ as seen from the punch, over N²/(4μ): work of friction on
            the solid besides that of carrying it past the punch.
        σ_YY: contact stress at ``PLACES``, (times, places).
        σ_XX_left, σ_XX_right: in-plane stress on the free surface at ``BESIDE`` beyond both ends.
        surface: σ_XX, σ_YY and σ_XY at ``ON_SURFACE``, (3, times, places), less the stresses before
            t = 0; None where they are not computed.
        residual: larger one of that of :class:`Residual` and of the load's, over its largest,
            dimensionless; NaN where it is not computed.
        error_of_K_I: estimated error of K_I over its largest, by three quarters of the polynomials; it
            means nothing where friction jumps.
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
    surface: NDArray[np.float64] | None = None
    residual: float = np.nan
    error_of_K_I: float = np.nan


class StartingPunch:
    """A flat punch that starts at one speed, with any friction and load.

    Args:
        response: of steady motion at that speed, with the solid's stiffness and the exponents.
        rayleigh: speed of the wave along the surface over c_s.
        end: last time over a/c_s.
        steps: of the quadrature.
        terms: polynomials of the pressure.
        surface: True to compute stresses at ``ON_SURFACE``.
        way: ±1, in which the punch moves along X.
        checked: True to compute residuals.
    """

    def __init__(
        self, response: HalfPlane, rayleigh: float, end: float, steps: int, terms: int = 24,
        surface: bool = False, way: int = 1, checked: bool = False,
    ) -> None:  # fmt: skip
        self._response, self._terms, self._surface = response, terms, surface
        self._scheme = Radau(end, steps)
        s, t = self._scheme.s, self._scheme.times[:, -1]
        self._transformed = Transformed(response, rayleigh, s, terms, way=way)
        places = np.append(_ENDS, ON_SURFACE) if surface else _ENDS
        self._along = AlongSurface(response, rayleigh, s, places, way)
        self._residual = Residual(response, rayleigh, t, terms, way) if checked else None

    def course(self, g: History | float, load: History, steady: bool = False) -> Course:
        """Motion where σ_XY = g(t) σ_YY, and N is present by the share ``load(t)``.

        Args:
            g: σ_XY/σ_YY at times over a/c_s, or a number where it is constant.
            load: share of N at times; from rest load(0) = 0.
            steady: True for steady motion before t = 0 at the load and friction of t = 0. Indentation,
                works and σ_XX are then differences from t = 0.
        """
        scheme, transformed = self._scheme, self._transformed
        ratio = g if callable(g) else lambda t: np.full(np.shape(t), g)
        t, ratios, first = scheme.times[:, -1], ratio(scheme.times), float(ratio(np.zeros(())))
        occurring = np.append(ratios, first)
        between = FrictionInterpolation(self._response, occurring.min(), occurring.max(), self._terms)
        begun, added, a, v0 = march(transformed, scheme, between, ratio, load, steady)
        held = between.middle.pressure
        rows = [
            np.hstack([transformed.tested(of, held, True), self._along.strains(of)])
            for of in between.bases
        ]
        u, u_X = np.split(scheme.answered(np.concatenate(rows, axis=2), added), [self._terms], axis=1)
        shared = np.hstack([basis.pressure.tested(held) for basis in between.bases])
        forces = ratios[:, -1:] * ((begun + added[:, -1]) @ shared.T)
        different = {ratio: Basis(self._response, ratio, self._terms) for ratio in set(ratios[:, -1])}
        bases = [different[ratio] for ratio in ratios[:, -1]]
        beside, along = u_X[:, :2], u_X[:, 2:]
        σ_XX = self._response.σ_XX(beside, np.zeros_like(beside), np.zeros_like(beside))
        due = load(t)
        by_load = _work(t, 2.0 * due[:, None], v0[:, None], 2.0 * load(np.zeros(1)))
        normal = np.array([coefficients @ basis.moments for coefficients, basis in zip(a, bases)])
        carried = -normal[:, 0] / 2.0
        ends = np.array([basis.ends for basis in bases])
        K = _at_ends(a, ends, self._terms)
        fewer = np.abs(K - _at_ends(a, ends, _FEWER * self._terms // 4)).max()
        error = float(fewer / (_FALLS * max(np.abs(K).max(), np.finfo(float).tiny)))
        pressed = np.array(
            [basis.pressure(PLACES) @ coefficients for coefficients, basis in zip(a, bases)]
        )
        surface, residual = None, np.nan
        if self._surface:
            before = begun @ np.vstack([basis.pressure(PLACES).T for basis in between.bases])
            σ_YY, σ_XY = np.zeros((2, *along.shape))
            σ_YY[:, _UNDER] = pressed - before
            σ_XY[:, _UNDER] = ratios[:, -1:] * pressed - first * before
            surface = np.array([self._response.σ_XX(along, σ_YY, σ_XY), σ_YY, σ_XY])
        if self._residual is not None:
            off = np.abs(carried - due).max() / max(np.abs(due).max(), np.finfo(float).tiny)
            residual = max(self._residual.of(between.bases, added[:, -1], v0), float(off))
        return Course(
            t, v0, carried, normal[:, 1] / normal[:, 0], *K, by_load,
            _work(t, forces, u, first * (shared @ begun)), pressed, σ_XX[:, 0], σ_XX[:, 1], surface,
            residual, error,
        )  # fmt: skip


#: Quarters of the polynomials from which K_I shows how far it has converged, and by how much its error
#: falls from these to all at least.
_FEWER, _FALLS = 3, 2.0


def _at_ends(a: NDArray, ends: NDArray, terms: int) -> NDArray[np.float64]:
    """K_I at X = -a and X = a over time from some of the polynomials, (2, times).

    Inertia adds r log r to the polynomials at a distance r from an end, so that their sum there converges
    with the square of their number. Half of them give the constant.

    Args:
        a: coefficients of the polynomials, (times, polynomials).
        ends: polynomials at both ends, (times, 2, polynomials).
        terms: their number.
    """
    whole, half = (np.einsum("nj,nej->en", a[:, :n], ends[..., :n]) for n in (terms, terms // 2))
    return np.asarray(-(whole + (whole - half) / 3.0) / 2.0)


def _work(t: NDArray, forces: NDArray, ways: NDArray, first: NDArray) -> NDArray[np.float64]:
    """Work ∫ Σ force d(way) up to each time, (times,).

    Args:
        t: times, (times,), > 0.
        forces, ways: at these times, (times, n); ways are 0 at t = 0.
        first: forces at t = 0, (n,).
    """
    from scipy.interpolate import CubicSpline  # a slow import

    times, still = np.append(0.0, t), np.zeros((1, forces.shape[1]))
    F, u = CubicSpline(times, np.vstack([first, forces])), CubicSpline(times, np.vstack([still, ways]))
    at, w = (values.reshape(-1, 4) for values in gauss_in_panels(times, 4))
    return np.asarray(np.cumsum(((F(at) * u(at, 1)).sum(axis=-1) * w).sum(axis=-1)))
