"""Residuals of a solution in equations that it was not computed by, and the indentation by its pressure.

The residual of a pressure is that of the singular integral equation N̂ H[σ_YY] - Q σ_YY = μ v,X,
N̂ = n + g n₁₂, Q = g q. A field inside is compared with the sum of the line loads that its pressure is
made of, and its resultants at a depth with those of the surface. All integrals over the contact are one
rule in x = log((1 + t)/(1 - t)), in which powers of the distance from the ends are exponentials; the
pressure without such powers is smooth there but for kinks, towards which panels halve.

The indentation v₀ is from the pressure below the punch. Line loads move the surface, by
v,X = (n + g n₁₂) H[σ_YY] - g q σ_YY, so that at the left end of the contact

    μ v(-1) = -(n + g n₁₂)/π ∫ σ_YY(t) log((1 + t)/D) dt + (g q/2) ∫ σ_YY(t) dt,

with D the distance at which a line load does not move it, the mean of both sides. The punch has the
height P(-1) at that end, and v = P(-1) - v₀.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..layers.kernel import Kernel, Scaled
from ..solids.half_plane import DATUM, HalfPlane

#: Panels' ends off all kinks: beyond |x| = 12 all is powers of e^x; distance from an end at 300.
_OUTER = np.append(np.arange(12.0, 300.0, 8.0), 300.0)
_BEYOND_PANELS = 2.0 * np.exp(-_OUTER[-1])
_ENDS = np.concatenate([-_OUTER[::-1], np.linspace(-12.0, 12.0, 17)[1:-1], _OUTER])
#: Points and weights of a panel; the shortest panel.
_τ, _w = np.polynomial.legendre.leggauss(12)
_SHORTEST = 1e-9

#: Places under the punch at which the residual is evaluated, and their least distance from a kink.
_AT, _OFF_KINKS = np.cos(np.pi * (np.arange(16) + 0.5) / 16.0), 0.02
#: Distance from an end within which the pressure without its powers is taken as constant; most of that of
#: a kink, and least.
_NEXT_TO_END, _OF_KINK, _NEAREST = 1e-7, 1e-6, 1e-13

#: Points inside at which line loads are summed; points along a line at a depth, over its width by depth.
_INSIDE, _ALONG = 6, 64
#: Least depth over a of a point at which line loads are summed.
_DEEP = 1e-3

#: Relative error of the kernel of layers, ten times that of steps through graded ones.
_OF_KERNEL = 1e-9

#: σ_YY over N/(2a) at positions (n,) of all states: (states, n).
Stress = Callable[[NDArray], NDArray]


class Rule:
    """Quadrature over the contact: points in (-1, 1) and weights.

    Args:
        at: positions towards which panels halve.
        sizes: size in x of the smallest panel at each.

    Attributes:
        t, left, right: positions, and distances from both ends, (n,).
    """

    def __init__(self, at: ArrayLike = (), sizes: ArrayLike = _SHORTEST) -> None:
        at, sizes = np.broadcast_arrays(np.asarray(at, dtype=float), sizes)
        room = 1.0 - np.abs(at[np.abs(at) < 1.0]).max(initial=0.0)
        self._next_to_end = max(min(_NEXT_TO_END, _OF_KINK * room), _NEAREST)
        ends = [_ENDS]
        for t, size in zip(at[np.abs(at) < 1.0], sizes[np.abs(at) < 1.0]):
            steps = 0.5 ** np.arange(np.ceil(max(-np.log2(max(size, _SHORTEST)), 1.0)))
            x = 2.0 * np.arctanh(t)
            ends += [x + np.concatenate([-steps, [0.0], steps])]
        x = np.unique(np.concatenate(ends))
        middle, half = (x[1:] + x[:-1]) / 2.0, np.diff(x) / 2.0
        x = (middle[:, None] + half[:, None] * _τ).ravel()
        self.left, self.right = 2.0 / (1.0 + np.exp(-x)), 2.0 / (1.0 + np.exp(x))
        self.t = np.where(x < 0.0, self.left - 1.0, 1.0 - self.right)
        self._weights = (half[:, None] * _w).ravel() * self.left * self.right / 2.0

    def weights(self, α: NDArray, β: NDArray) -> NDArray[np.float64]:
        """Weights of ∫ (1 - t)^α (1 + t)^β F dt, (states, n); exponents (states,)."""
        weights = self._weights * self.right ** α[:, None] * self.left ** β[:, None]
        # Beyond the last panels F is that of the last point, and one distance that between the ends.
        for end, near, far in ((0, β, α), (-1, α, β)):
            weights[:, end] += 2.0**far * _BEYOND_PANELS ** (1.0 + near) / (1.0 + near)
        return weights

    def smooth(self, pressure: Stress, α: NDArray, β: NDArray) -> NDArray[np.float64]:
        """Smooth part of a pressure, σ_YY over (1 - t)^α (1 + t)^β at :attr:`t`, (states, n)."""
        r = np.clip(self.t, self._next_to_end - 1.0, 1.0 - self._next_to_end)
        return pressure(r) / ((1.0 - r) ** α[:, None] * (1.0 + r) ** β[:, None])


def of_pressure(
    response: HalfPlane,
    g: Any,
    exponents: tuple[NDArray, NDArray],
    slope: Stress,
    pressure: Stress,
    kinks: Sequence[float] | NDArray = (),
    breaks: Sequence[float] | NDArray = (),
    layers: Sequence[Scaled] = (),
) -> NDArray[np.float64]:
    """Residual of a pressure in the integral equation, over the largest N̂ times pressure, (states,).

    Args:
        response: of the half-plane.
        g: σ_XY/σ_YY, (states,), or its function of positions, (n,): (states, n).
        exponents: α at the right and β at the left end, (states,) each.
        slope: μ v,X under the punch over N/(2a).
        pressure: contact stress over N/(2a).
        kinks: places at which the pressure is not smooth.
        breaks: ends of pieces in which the pressure is a polynomial; none for other pressures.
        layers: kernel of the layers for each state, lengths over its half-width; none without layers.
    """
    (α, β), kinks = exponents, np.asarray(kinks, dtype=float)
    s = _AT[np.abs(_AT[:, None] - kinks).min(axis=1, initial=1.0) > _OFF_KINKS]
    # A kernel changes fastest at the places themselves; there it may have a logarithm.
    peaks = s if layers else np.empty(0)
    finest = min([_SHORTEST if kernel.rough else kernel.length for kernel in layers], default=1.0)
    each = (kinks, _SHORTEST), (peaks, finest), (breaks, 1.0)
    rule = Rule(
        np.concatenate([at for at, _ in each]),
        np.concatenate([np.full(len(at), size) for at, size in each]),
    )
    loads, σ = rule.weights(α, β) * rule.smooth(pressure, α, β), pressure(s)
    ratio = g(np.append(s, rule.t)) if callable(g) else g[:, None]
    ratio, there = np.split(np.broadcast_to(ratio, (len(σ), len(s) + len(rule.t))), [len(s)], axis=1)
    own, own_there = response.n + ratio * response.n12, response.n + there * response.n12
    # (1/π) ⨍ τ(t)/(t - s) dt of τ = N̂ σ: the part of τ(s) is a logarithm.
    divided, none = 1.0 / (rule.t[:, None] - s) / np.pi, np.zeros(1)
    of_constant = np.log((1.0 - s) / (1.0 + s)) / np.pi - (rule.weights(none, none) @ divided)
    H = (own_there * loads) @ divided + own * σ * of_constant
    defect = H - response.q * ratio * σ - slope(s)
    for i, kernel in enumerate(layers):
        if not i or kernel.size != layers[i - 1].size:
            by_kernel = kernel(s[:, None] - rule.t)
        defect[i] += (by_kernel[..., 3] + by_kernel[..., 2] * there[i]) @ loads[i]
    return np.asarray(np.abs(defect).max(axis=1) / np.abs(own * σ).max(axis=1))


def of_contact(
    response: HalfPlane,
    g: NDArray,
    local: Any,
    body: Any,
    pressure: Stress,
    lengths: tuple[NDArray, NDArray] | None = None,
    kinks: Sequence[float] | NDArray = (),
    breaks: Sequence[float] | NDArray = (),
) -> NDArray[np.float64]:
    """Residual :func:`of_pressure` for the contact of a punch, (states,).

    Args:
        response, pressure, kinks, breaks: as in :func:`of_pressure`.
        g: means of σ_XY/σ_YY, (states,).
        local: exponents α and β, (states,).
        body: punch and half-plane, under the load of each state.
        lengths: middle and half-width of each contact [m], (states,), with free ends.

    Of a half-plane with layers it is the residual in the equation with their kernel.
    """
    m, h = lengths or (np.zeros(len(g)), np.full(len(g), body.half_width))
    unit = np.broadcast_to(h / body.displacement, g.shape)

    def slope(s: NDArray) -> NDArray[np.float64]:
        X = m[:, None] + h[:, None] * s
        return np.asarray(body.profile.slope(X.ravel())).reshape(X.shape) * unit[:, None]

    layers: list[Scaled] = []
    if len(response.depths):  # one kernel, for the widest, serves all
        kernel = Kernel(response.stack(float(h.max())), _OF_KERNEL)  # type: ignore[attr-defined]
        layers = [Scaled(kernel, size) for size in (h / h.max()).tolist()]
    kinks = [*kinks, *body.jumps_of_friction]
    exponents = local.α, local.β
    return of_pressure(
        response, lambda r: body.ratio(g, r, h), exponents, slope, pressure, kinks, breaks, layers
    )


class _LineLoads:
    """Φ of line loads on the surface, see :class:`galinx.solvers.solids.half_plane.Potential`.

    Args:
        t: positions, (n,).
        loads: ∫σ_YY of each load, (states, n).
    """

    def __init__(self, t: NDArray, loads: NDArray) -> None:
        self._t, self._loads = t, loads / np.pi

    def at(self, z: NDArray) -> NDArray[np.complex128]:
        return np.asarray(np.einsum("sn,pn->sp", self._loads, 1.0 / (self._t - z[0, :, None])))


def of_field(
    response: Any,
    ratio: Stress,
    exponents: tuple[NDArray, NDArray],
    pressure: Stress,
    inside: Callable[[NDArray, NDArray], NDArray],
    points: NDArray,
    kinks: Sequence[float] | NDArray = (),
) -> NDArray[np.float64]:
    """Residual of stresses inside against line loads and equilibrium, over the largest, (states,).

    Args:
        response, exponents, pressure, kinks: as in :func:`of_pressure`.
        ratio: σ_XY/σ_YY at positions (n,): (states, n) or (states, 1).
        inside: σ_XX, σ_YY, σ_XY at X and Y (n,), (3, states, n).
        points: positions X, Y, (m, 2), at a few of which line loads are summed.
    """
    α, β = exponents
    deep = points[points[:, 1] <= -_DEEP]
    samples = deep[np.unique(np.linspace(0, len(deep) - 1, min(_INSIDE, len(deep))).astype(int))]
    X, Y = samples.T
    roots = response.surface.roots.each
    feet = [X + p * Y for p in roots]
    at = np.concatenate([kinks, *(z.real for z in feet)])
    sizes = np.concatenate([np.full(len(kinks), _SHORTEST), *(0.3 * np.abs(z.imag) for z in feet)])
    rule = Rule(at, sizes)
    loads = rule.weights(α, β) * rule.smooth(pressure, α, β)
    shear = ratio(rule.t) * loads
    off = np.zeros(len(loads))
    if len(samples):
        normal, tangential = (_LineLoads(rule.t, of) for of in (loads, shear))
        reference = response.inside(normal, 0.0, X[None], Y[None])
        reference += np.subtract(*(response.inside(tangential, g, X[None], Y[None]) for g in (1.0, 0.0)))
        size = np.abs(reference).max(axis=(0, 2))
        off = np.abs(inside(X, Y) - reference).max(axis=(0, 2)) / size
    # Along a line below the surface: X = L tan θ, in which what is analytic in 1/X is periodic.
    depth = 1.0 / min(p.imag for p in roots)
    L = depth * max(abs(p) for p in roots)
    count = int(np.ceil(_ALONG * max(L, 1.0)))
    θ = np.pi * ((np.arange(count) + 0.5) / count - 0.5)
    _, σ_YY, σ_XY = inside(L * np.tan(θ), np.full(count, -depth))
    weights, N, T = np.pi / count * L / np.cos(θ) ** 2, loads.sum(axis=1), shear.sum(axis=1)
    balance = np.maximum(np.abs(σ_YY @ weights - N), np.abs(σ_XY @ weights - T))
    return np.asarray(np.maximum(off, balance / np.abs(loads).sum(axis=1)))


#: Places of the tanh-sinh rule, and its half-length.
_COUNT, _FAR = 400, 2.9
#: Share of the load next to the ends that the rule may leave.
_BEYOND = 1e-3


def places() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Positions over a under the punch, dense at its ends, and weights of an integral: (n,) each."""
    t, step = np.linspace(-_FAR, _FAR, _COUNT, retstep=True)
    u = np.pi / 2.0 * np.sinh(t)
    return np.tanh(u), step * np.pi / 2.0 * np.cosh(t) / np.cosh(u) ** 2


def indentation(response: HalfPlane, g: NDArray, σ_YY: NDArray, height: Any) -> NDArray[np.float64]:
    """Indentation v₀ of the punch's lowest point over N/(2μ), (states,), to about 2e-5 of it.

    NaN where the pressure is so singular that the rule misses much of the load.

    Args:
        response: of a uniform half-plane at its speed.
        g: σ_XY/σ_YY at :func:`places`, (states, n) or (states, 1).
        σ_YY: over N/(2a) at :func:`places`, (states, n).
        height: height of the punch at the left end of the contact over N/(2μ), (states,).
    """
    X, weights = places()
    weighted = σ_YY * weights
    # The exact load is -2: the difference is the part next to the ends of a sharp punch.
    load = weighted.sum(axis=1)
    beyond = np.abs(load / -2.0 - 1.0) > _BEYOND
    own = (response.n + g * response.n12) * weighted @ np.log((1.0 + X) / DATUM)
    v = -2.0 * (-own / np.pi + (g * weighted).sum(axis=1) * response.q / 2.0) / load
    return np.where(beyond, np.nan, height - v)
