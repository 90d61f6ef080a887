"""Responses ahead of and behind a line load that moves over a uniform solid or over layers.

The load changes in time; responses are Laplace's transforms. Seen from a frame that moves at c, fields
e^(ikX + st) obey the formulas of steady motion with the complex speed C = c + is/k (lengths over a,
speeds over c_s, times over a/c_s, stresses over μ)::

    ik û = 𝐘(C) σ̂ where k < 0,    the conjugate of 𝐘(C*) instead where k > 0

With the slowness ζ = k/(is) as seen from the frame, C = c + 1/ζ does not know s. The transform back to
X > 0

    v̂ = i/(2π) ∫₀ [𝐘(C) - conj 𝐘(C*)] e^(-sζX) dζ/ζ

is taken along ways on which the integrand decays: the second part straight from 0; the first part on the
upper side of the real axis up to the least speed of waves inside, and from there straight on as well,
with the residue of the wave along the surface. On these ways lie no other singularities, whatever the
solid.

Layers add echoes. For wavenumbers k < 0 fields e^(ik(X - Ct)), C = c + is/k, have in each layer two waves
that decay downwards, u,Y = G₁ u,X with Im p > 0, and two that decay upwards, G₂. With E₁ = e^(-ikG₁H),
E₂ = e^(ikG₂H) and tractions Z u,X on the layer's lower face, tractions on its upper face are (L₁ + δ) u,X
with

    r = (L₂ - Z)⁻¹ (Z - L₁),   W = E₂ r E₁,   δ = (L₂ - L₁) W (1 + W)⁻¹:

exponentials that decay, and no other. Δ𝐘 = (L₁ + δ)⁻¹ - L₁⁻¹ falls like e^(-2|k|H Im p), and like
e^(-2sH/c_d) where plane waves go down and up. As Re s > 0 it is analytic along the real axis of k, so
that its transform back to X goes along it.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import ceil, cos, log, pi
from typing import Any

import numpy as np
from numpy.polynomial.legendre import leggauss, legvander
from numpy.typing import NDArray

from ..approximation import legendre_panel
from ..layers.layered import LayeredHalfPlane, LayersAtSpeed
from ..layers.stiffness import Medium, Uniform
from ..solids.admittance import Admittance
from ..solids.half_plane import HalfPlane

#: Number of Gauss's points of a panel along a way, these and their weights, and panels' width in the
#: logarithm of the distance from its end.
_POINTS, (_NODES, _WEIGHTS), _WIDTH = 12, leggauss(12), 0.8
#: Decay after which an integrand is negligible; panels of a way, of which few are used, as long as that.
_GONE, _FARTHEST = 32.0, 80
#: Directions of the ways below the real axis, and how far from the fastest decay one is taken.
_DIRECTIONS = np.arange(0.6, 1.7, 0.3)
#: Panels between two speeds at which 𝐘 is not analytic: at first, halvings at most, and accuracy.
_PANELS, _HALVINGS, _ACCURACY = 3, 14, 1e-10
#: Radians of the exponential in a panel at most.
_TURN = 7.0
#: Places of a panel, -1 to 1, at which its polynomial is compared with the function.
_BETWEEN = np.linspace(-0.9, 0.9, 4)
#: Distances are treated together where one is so many times another at most.
_RATIO = 4.0
#: Distances times s up to which responses are series, over :attr:`Kernel._radius`, terms of these, and
#: points of a circle, of what share of that radius, on which Laurent's series is found.
_NEAR, _TERMS, _ON_CIRCLE, _OF_RADIUS = 3.0, 28, 128, 0.7
#: Exponents whose exponentials are computed at once.
_TOGETHER = 4096
#: Width of panels of a single point.
_NO_WIDTH = 1e-300

#: Arrays (panels, points) of distances, which rise; panels of one array have the same points.
Distances = Sequence[NDArray]


@dataclass(frozen=True)
class Kernel:
    """Response at a distance x > 0 ahead of a line load in a frame that moves at c.

    Behind it the response is that ahead, in the mirror image of the solid and a frame that moves at -c,
    with the signs of σ_XY's and u changed.

    Args:
        surface: of the solid.
        c: speed over c_s, of either sign.
        rayleigh: of the wave along the surface over c_s.
    """

    surface: Admittance
    c: float
    rayleigh: float

    def __call__(self, x: Distances, s: complex, slopes: bool = False) -> NDArray[np.complex128]:
        """v̂ of line loads σ_YY and σ_XY, and û of them, (4, n).

        Args:
            x: distances > 0.
            s: over c_s/a, Re s >= 0.
            slopes: of these along X instead.
        """
        if s.imag < 0.0:  # in time it is real
            return np.conj(self(x, np.conj(s), slopes))
        parts = []
        for panels in x:
            near = abs(s) * panels[:, -1] < _NEAR * self._radius
            values = np.empty((4, *panels.shape), dtype=complex)
            values[:, near] = self._near(panels[near], s, slopes)
            values[:, ~near] = self._far(panels[~near], s, slopes)
            parts.append(values.reshape(4, -1))
        return np.concatenate(parts, axis=1)

    def _far(self, x: NDArray, s: complex, slopes: bool) -> NDArray[np.complex128]:
        """Displacements, or their slopes, by integrals along the ways, (4, panels, points)."""
        values = np.empty((4, *x.shape), dtype=complex)
        group = np.floor(np.log(x[:, -1] / x.max(initial=0.0)) / log(_RATIO) + 1e-9)
        for number in np.unique(group):
            values[:, group == number] = self._of(x[group == number], s, slopes)
        ζ, residue = self._pole
        wave = (-s * ζ if slopes else 1.0) * np.exp(-s * ζ * x)
        return values + residue[:, None, None] * wave

    @property
    def _radius(self) -> float:
        """Distance over c_s from c to the nearer velocity, ±, of the wave along the surface."""
        return self.rayleigh - abs(self.c)

    def _near(self, x: NDArray, s: complex, slopes: bool) -> NDArray[np.complex128]:
        """Displacements, or their slopes, by the series, (4, panels, points)."""
        a, b = self._series
        w, n = s * x / self._radius, np.arange(_TERMS)
        powers, logs = w[..., None] ** n, np.log(w)
        if not slopes:
            return np.moveaxis(powers @ a + logs[..., None] * (powers @ b), -1, 0)
        regular, singular = (powers[..., :-1] @ (n[1:, None] * of[1:]) for of in (a, b))
        of_w = regular + logs[..., None] * singular + (powers @ b) / w[..., None]
        return np.moveaxis(s / self._radius * of_w, -1, 0)

    @cached_property
    def _series(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Coefficients a and b of v̂ = Σ (a + b ln w) wⁿ in w = s x/radius, real, (terms, 4) each.

        b follows from Laurent's series of the integrand beyond all singularities; a from values.
        """
        n, angles = np.arange(_TERMS), 2.0 * pi * np.arange(_ON_CIRCLE) / _ON_CIRCLE
        ζ = np.exp(-1j * angles) / (_OF_RADIUS * self._radius)
        jumps = ζ * (self._rows(ζ) - self._rows(ζ, below=True))
        laurent = np.fft.fft(jumps).T[:_TERMS] / _ON_CIRCLE / _OF_RADIUS ** n[:, None]
        factorials = np.cumprod(np.maximum(n, 1.0))[:, None]
        b = (-1j / (2.0 * pi) * (-1.0) ** n[:, None] * laurent / factorials).real
        turned = np.exp(0.5j * pi * np.linspace(0.0, 1.0, _TERMS // 2))
        w = _NEAR * np.outer([0.3, 0.65, 1.0], turned).ravel()
        values = np.concatenate([self._far(np.array([[self._radius]]), of, False) for of in w], axis=1)
        powers = w[:, None] ** n
        singular = (powers @ b) * np.log(w)[:, None]
        scale = float(_NEAR) ** n
        rest, scaled = values[..., 0].T - singular, powers / scale
        equations, right = (np.concatenate([of.real, of.imag]) for of in (scaled, rest))
        a, *_ = np.linalg.lstsq(equations, right, rcond=1e-15)
        return a / scale[:, None], b

    def _of(self, x: NDArray, s: complex, slopes: bool) -> NDArray[np.complex128]:
        """Displacements without the wave along the surface, or their slopes, (4, panels, points)."""
        ψ = float(np.angle(s))
        down = int(np.abs(_DIRECTIONS - ψ).argmin())
        last = _GONE / (abs(s) * cos(ψ - _DIRECTIONS[down]) * float(x.min()))
        ζ, values = self._above(_TURN / (abs(s) * float(x.max())))
        felt = ζ * (s.real * float(x.min())) < _GONE
        ways = [
            (ζ[felt], values[:, felt]),
            *self._ways(down, max(0, ceil(log(last / self._first) / _WIDTH))),
        ]
        displacements = np.zeros((4, *x.shape), dtype=complex)
        for ζ, values in ways:
            displacements += _sums(values * (-s * ζ) if slopes else values, -s * ζ, x)
        return displacements

    @cached_property
    def _edges(self) -> NDArray[np.float64]:
        """Slownesses, as seen from the frame, at which 𝐘 is not analytic, growing from 0."""
        return np.concatenate([[0.0], 1.0 / (self.surface.meeting[::-1] - self.c)])

    @cached_property
    def _pole(self) -> tuple[float, NDArray[np.complex128]]:
        """Slowness of the wave along the surface, and its displacements by line loads, (4,)."""
        ζ = 1.0 / (self.rayleigh - self.c)
        return ζ, -ζ * self.surface.residue(self.rayleigh)[::-1, ::-1].ravel()

    @property
    def _first(self) -> float:
        """Length of the first panel of a way, a tenth of the distance of the nearest singularity."""
        ends = self._edges
        return 0.1 * min(self._pole[0] - ends[-1], *np.diff(ends))

    def _rows(self, ζ: NDArray, below: bool = False) -> NDArray[np.complex128]:
        """Components of 𝐘/ζ: v of σ_YY and σ_XY, then u of them, (4, n); ``below``: conj 𝐘(C*)/ζ."""
        C = self.c + 1.0 / ζ
        Y = np.conj(self.surface(np.conj(C))) if below else self.surface(C)
        return np.asarray(Y[:, ::-1, ::-1].reshape(-1, 4).T / ζ)

    def _ways(self, down: int, panels: int) -> list[tuple[NDArray, NDArray]]:
        """Points and weighted values of both ways in a direction, over so many panels and the first."""
        if down not in self._all_ways:
            v, weights = _distances(self._first, _FARTHEST)
            along = np.exp(-1j * _DIRECTIONS[down])
            factor = 1j / (2.0 * pi) * along * weights
            up, straight = self._edges[-1] + along * v, along * v
            self._all_ways[down] = [
                (up, factor * self._rows(up)), (straight, -factor * self._rows(straight, below=True))
            ]  # fmt: skip
        count = _POINTS * (panels + 1)
        return [(ζ[:count], values[:, :count]) for ζ, values in self._all_ways[down]]

    @cached_property
    def _all_ways(self) -> dict[int, list[tuple[NDArray, NDArray]]]:
        """Points and weighted values of both ways by direction."""
        return {}

    def _above(self, longest: float) -> tuple[NDArray, NDArray]:
        """Points and weighted values above the real axis, on panels halved until none is longer."""
        which, start, length, _ = self._panels
        ends, _ = self._between(which, np.array([start, start + length]))
        halvings = np.ceil(np.log2(np.maximum(np.diff(ends, axis=0)[0] / longest, 1.0))).astype(int)
        parts = [
            (ζ[halvings == n].ravel(), values[:, halvings == n].reshape(4, -1))
            for n in np.unique(halvings).tolist()
            for ζ, values in [self._halved(n)]
        ]
        ζ, values = (np.concatenate(part, axis=-1) for part in zip(*parts))
        return ζ, values

    @cached_property
    def _all_halved(self) -> dict[int, tuple[NDArray, NDArray]]:
        """Points and weighted values of halved panels by the number of halvings."""
        return {}

    def _halved(self, n: int) -> tuple[NDArray, NDArray]:
        """Points (panels, k) and weighted values (4, panels, k), with each panel halved n times."""
        if n not in self._all_halved:
            finer = ((2.0 * np.arange(2**n)[:, None] + 1.0 + _NODES) / 2**n - 1.0).ravel()
            which, start, length, values = self._panels
            ζ, _ = self._between(which[:, None], start[:, None] + length[:, None] * (1.0 + finer) / 2.0)
            weighted = values @ (interpolation(_POINTS, finer) * np.tile(_WEIGHTS, 2**n)[:, None]).T
            weighted = weighted * (1j / (2.0 * pi) * length / 2.0 ** (n + 1))[:, None, None]
            self._all_halved[n] = ζ, weighted.swapaxes(0, 1)
        return self._all_halved[n]

    def _between(self, which: NDArray, φ: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Slownesses at φ, 0 to 1 between two edges, and their slopes by φ; roots are smooth in φ."""
        low, high = self._edges[which], self._edges[which + 1]
        return low + (high - low) * np.sin(pi / 2.0 * φ) ** 2, (high - low) * pi / 2.0 * np.sin(pi * φ)

    @cached_property
    def _panels(self) -> tuple[NDArray[np.int64], NDArray, NDArray, NDArray[np.complex128]]:
        """Panels so short that 𝐘 is a polynomial in each.

        Returns:
            Number of the edge before each panel, start and length in φ, (panels,) each, and values times
            slopes at Gauss's points, (panels, 4, points).
        """
        pending = [
            (n, k / _PANELS, 1.0 / _PANELS) for n in range(len(self._edges) - 1) for k in range(_PANELS)
        ]
        accepted = []
        for halvings in range(_HALVINGS + 1):
            again = []
            for n, start, length in pending:
                at = np.append(_NODES, _BETWEEN)
                ζ, slope = self._between(np.array(n), start + length * (1.0 + at) / 2.0)
                values = self._rows(ζ) * slope
                at_gauss, between = values[:, :_POINTS], values[:, _POINTS:]
                off = np.abs(at_gauss @ _TO_BETWEEN.T - between).max()
                if off > _ACCURACY * np.abs(values).max() and halvings < _HALVINGS:
                    again += [(n, start, length / 2.0), (n, start + length / 2.0, length / 2.0)]
                else:
                    accepted.append((n, start, length, at_gauss))
            pending = again
        which, starts, lengths, values = (np.array(column) for column in zip(*accepted))
        return which, starts, lengths, values


def interpolation(points: int, at: NDArray) -> NDArray[np.float64]:
    """Matrix from values at Gauss's points to values at other places from -1 to 1, (places, points)."""
    _, _, to_legendre = legendre_panel(points)
    return np.asarray(legvander(at, points - 1) @ to_legendre)


#: Matrix from values at a panel's points to those between.
_TO_BETWEEN = interpolation(_POINTS, _BETWEEN)


def _sums(values: NDArray, a: NDArray, x: NDArray) -> NDArray[np.complex128]:
    """Sums of exponentials Σ values exp(a x), values (4, a), at distances in panels: (4, panels, points).

    In panels of the same width they are a product of matrices: of the values times the exponentials at
    the points of one panel, and of the exponentials at the panels' starts.
    """
    if len(a) > _TOGETHER:
        first, rest = slice(_TOGETHER), slice(_TOGETHER, None)
        return _sums(values[:, first], a[first], x) + _sums(values[:, rest], a[rest], x)
    sums = np.empty((4, *x.shape), dtype=complex)
    widths = np.round(np.log(np.ptp(x, axis=1) + _NO_WIDTH), 9)
    _, width, counts = np.unique(widths, return_inverse=True, return_counts=True)
    alone = counts[width] == 1
    sums[:, alone] = (values @ np.exp(np.multiply.outer(a, x[alone].ravel()))).reshape(4, -1, x.shape[1])
    for number in np.flatnonzero(counts > 1):
        panels = np.flatnonzero(width == number)
        within = np.exp(np.multiply.outer(x[panels[0]] - x[panels[0], 0], a))
        starts = np.exp(np.multiply.outer(a, x[panels, 0]))
        of_panels = (values[:, None] * within).reshape(4 * x.shape[1], len(a)) @ starts
        sums[:, panels] = of_panels.reshape(4, x.shape[1], -1).swapaxes(1, 2)
    return sums


def _distances(first: float, panels: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points and weights along a way: its end is a square root, far away powers and a decay."""
    near, weights = first * ((1.0 + _NODES) / 2.0) ** 2, first * (1.0 + _NODES) / 2.0 * _WEIGHTS
    starts = log(first) + _WIDTH * np.arange(panels)[:, None]
    v = np.exp(starts + _WIDTH * (1.0 + _NODES) / 2.0)
    return np.append(near, v.ravel()), np.append(weights, (v * _WIDTH / 2.0 * _WEIGHTS).ravel())


#: Decay after which echoes are negligible, wavenumbers at which it is computed; panels of these at least.
_ECHOES_GONE, _WAVENUMBERS, _FEWEST = 34.0, np.geomspace(1e-3, 1e5, 161), 8


@dataclass(frozen=True)
class UniformLayers:
    """Uniform layers on a substrate at complex speeds.

    Attributes:
        solids: admittance of each solid from the top down, its c₆₆ over that of the solid at the surface,
            and the wave speed of the solid at the surface over its own.
        H: thicknesses over a of all but the substrate.
    """

    solids: tuple[tuple[Admittance, float, float], ...]
    H: tuple[float, ...]

    @classmethod
    def of(cls, half_plane: LayeredHalfPlane) -> "UniformLayers":
        """Layers of a half-plane.

        Raises:
            ValueError: a layer is graded.
        """
        solid = half_plane.solid
        if any(layer.bottom for layer in solid.layers):
            raise ValueError("a layer is graded: expected uniform ones")
        solids = tuple(
            (Admittance.of(own.response(0.0)), own.μ / solid.μ, solid.c_s / own.c_s)
            for own in solid.solids
        )
        return cls(solids, tuple(layer.thickness / half_plane.a for layer in solid.layers))

    @property
    def mirrored(self) -> "UniformLayers":
        """The mirror image in X = 0."""
        return UniformLayers(tuple((own.mirrored, M, s) for own, M, s in self.solids), self.H)

    @property
    def fastest(self) -> float:
        """Largest speed of a wave inside, over the wave speed of the solid at the surface."""
        return max(own.fastest / slower for own, _, slower in self.solids)

    def change(self, k: NDArray, C: NDArray) -> NDArray[np.complex128]:
        """Δ𝐘 at wavenumbers times a, k < 0, and speeds C, Im C < 0, (n,) each: (n, 2, 2)."""
        # The stiffness of layers is that at k > 0, whose fields are the conjugates.
        media = [
            Medium(own.waves(slower * C.conj()), modulus, own.waves(slower * C).conjugate)
            for own, modulus, slower in self.solids
        ]
        layers = [Uniform(medium, H) for medium, H in zip(media, self.H)]
        return LayersAtSpeed(layers, media[-1]).admittance(-k).conj()

    def decay(self, k: NDArray, C: NDArray) -> NDArray[np.float64]:
        """Logarithm by which waves at least decay on the way down and up through the uppermost layer."""
        (top, _, slower), falls = self.solids[0], np.full(len(k), np.inf)
        for roots in (top.waves(slower * C).roots, top.waves(slower * C.conj()).roots):
            half = np.sqrt(roots.sum**2 / 4.0 - roots.product)
            slow = np.minimum((roots.sum / 2.0 + half).imag, (roots.sum / 2.0 - half).imag)
            falls = np.minimum(falls, -2.0 * self.H[0] * k * slow)
        return falls


@dataclass(frozen=True)
class Echoes:
    """Part of the layers in the response ahead of a line load in a frame that moves at c.

    Args:
        sheets: the layers.
        c: speed over c_s, of either sign.
    """

    sheets: UniformLayers
    c: float

    def __call__(self, x: Distances, s: complex, slopes: bool = False) -> NDArray[np.complex128]:
        """v̂ of line loads σ_YY and σ_XY, and û of them, (4, n).

        Args:
            x: distances.
            s: over c_s/a, Re s > 0.
            slopes: of these along X instead.
        """
        # Displacements by k > 0 are the conjugates of those by -k at the conjugate of s.
        return np.asarray(self._half(x, s, slopes) + self._half(x, np.conj(s), slopes).conj())

    def _half(self, x: Distances, s: complex, slopes: bool) -> NDArray[np.complex128]:
        """Displacements by all k < 0, or their slopes, (4, n)."""
        displacements = np.zeros((4, sum(panels.size for panels in x)), dtype=complex)
        if (last := self._last(s)) == 0.0:
            return displacements
        count = max(_FEWEST, ceil(last * max(float(panels.max()) for panels in x) / _TURN))
        starts, length, most = np.arange(count) * (last / count), last / count, 0.0
        for halvings in range(_HALVINGS + 1):
            κ = starts[:, None] + length * (1.0 + np.append(_NODES, _BETWEEN)) / 2.0
            values = self._values(-κ.ravel(), s).reshape(4, *κ.shape)
            at_gauss, between = values[..., :_POINTS], values[..., _POINTS:]
            most = max(most, float(np.abs(values).max()))
            off = np.abs(at_gauss @ _TO_BETWEEN.T - between).max(axis=(0, 2))
            fine = (off <= _ACCURACY * most) | (halvings == _HALVINGS)
            k = -κ[fine, :_POINTS].ravel()
            factor = np.tile(length / 2.0 * _WEIGHTS, int(fine.sum())) * ((1j * k) if slopes else 1.0)
            weighted = at_gauss[:, fine].reshape(4, -1) * factor
            sums = [_sums(weighted, 1j * k, panels).reshape(4, -1) for panels in x]
            displacements += np.concatenate(sums, axis=1)
            starts, length = np.repeat(starts[~fine], 2), length / 2.0
            starts[1::2] += length
            if not len(starts):
                break
        return np.asarray(displacements / (2.0 * pi), dtype=np.complex128)

    def _values(self, k: NDArray, s: complex) -> NDArray[np.complex128]:
        """Displacements by tractions at wavenumbers k less those of the uniform solid, (4, n)."""
        change = self.sheets.change(k, self.c + 1j * s / k)
        return np.asarray(change[:, ::-1, ::-1].reshape(-1, 4).T / (1j * k))

    def _last(self, s: complex) -> float:
        """Wavenumber beyond which the echoes are negligible; 0 if they always are."""
        k = -_WAVENUMBERS
        not_decayed = np.flatnonzero(self.sheets.decay(k, self.c + 1j * s / k) < _ECHOES_GONE)
        return float(_WAVENUMBERS[min(not_decayed[-1] + 1, len(k) - 1)]) if len(not_decayed) else 0.0


#: Response on one side of a line load: v̂ of σ_YY and of σ_XY, then û of them, at distances, or slopes.
Side = Callable[[Distances, complex, bool], NDArray[np.complex128]]


def fastest(half_plane: HalfPlane) -> float:
    """Largest speed of a wave inside over c_s."""
    of: Any = UniformLayers if len(half_plane.depths) else Admittance
    return float(of.of(half_plane).fastest)


def both_sides(half_plane: HalfPlane, rayleigh: float, way: int) -> tuple[Side, Side]:
    """Responses on the sides towards +X and -X of a line load that moves over a solid.

    Args:
        half_plane: of the solid at the load's speed.
        rayleigh: of the wave along the surface of a uniform solid over c_s; not used over layers.
        way: ±1, in which the load moves along X.

    Raises:
        ValueError: a layer is graded.
    """
    surface, V, layers = Admittance.of(half_plane), way * half_plane.c, list[UniformLayers]()
    if len(half_plane.depths):
        layered: Any = half_plane
        rayleigh, layers = layered.solid.surface.limit(), [UniformLayers.of(layered)]
    ahead: list[Side] = [Kernel(surface, V, rayleigh), *(Echoes(sheets, V) for sheets in layers)]
    behind: list[Side] = [Kernel(surface.mirrored, -V, rayleigh)]
    behind += [Echoes(sheets.mirrored, -V) for sheets in layers]

    def mirrored(x: Distances, s: complex, slopes: bool) -> NDArray[np.complex128]:
        values = sum(part(x, s, slopes) for part in behind)
        return np.asarray(_MIRRORED * (-values if slopes else values))

    return lambda x, s, slopes: np.asarray(sum(part(x, s, slopes) for part in ahead)), mirrored


#: Signs in the mirror image: of v̂ of σ_YY and of σ_XY, then of û of them.
_MIRRORED = np.array([1.0, -1.0, -1.0, 1.0])[:, None]
