"""Layers on a substrate as one solid, and their half-plane seen from a load that moves over it.

:class:`Layered` is the solid, :class:`LayeredHalfPlane` its half-plane at a speed, and
:class:`LayersAtSpeed` the layers at that speed with the stiffness of their surface.

Below the highest speed over layers the stiffness against every wave, on the surface and inside, is
positive; it falls with speed, so that the speed at which the smallest of all vanishes is found by
bracketing (:func:`highest`), and so is the speed of the slowest wave of each wavelength
(:func:`dispersion`).

Far from a load, layers on a substrate move as under line loads, and by what the layers add to that. With
t the loads of a field e^(ikX), Z₋ of the substrate, and through layers that are thin beside 1/k

    t' = k² A u - ik B t,   u' = -ik Bᵀ u + T⁻¹ t,   A = Q - R T⁻¹ Rᵀ,   B = R T⁻¹   (Y upwards),

the substrate, whose surface lies at the depth D, carries t + k E t and moves there by

    u = Z₋⁻¹ t/k + Z₋⁻¹ E t + O(k),   E = -∫ (A Z₋⁻¹ - i B) dY,

a height inside the layers by ∫ (T⁻¹ - i Bᵀ Z₋⁻¹) dY t more. The first term is the line load's
logarithm, the others fall like 1/X; the remainder falls like its square.
"""

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache, cached_property, partial
from typing import Any, ClassVar

import numpy as np
from numpy.polynomial.chebyshev import chebvander
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray

from galinx.texts import with_prefix

from ..approximation import bisected, chebyshev_points, interpolation
from ..errors import SolveError
from ..parameters import build_model, parameters, values
from ..solids.half_plane import DATUM, LOADS, HalfPlane, Potential, UniformHalfPlane
from ..solids.solid import Composite, Solid
from .stiffness import STEP, Field, Graded, Medium, Uniform, inverse, least


@dataclass(frozen=True)
class LayersAtSpeed:
    """Layers from the top down at a speed, lengths over a, stiffnesses over that of the surface's solid.

    Attributes:
        layers: see :class:`galinx.solvers.layers.stiffness.Uniform` and ``Graded`` there.
        substrate: the half-plane below them.
    """

    layers: Sequence[Any]
    substrate: Medium

    @property
    def top(self) -> Medium:
        """The solid at the surface."""
        return self.layers[0].top if self.layers else self.substrate

    @cached_property
    def depths(self) -> NDArray[np.float64]:
        """Depths of the interfaces over a, (layers,)."""
        return np.cumsum([layer.H for layer in self.layers])

    def crossed(self, k: NDArray) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
        """Stiffness of the surface, (n, 2, 2); those under every layer, and displacements of its lower
        face by those of its upper one, (layers, n, 2, 2) each, from the top down.

        Args:
            k: wavenumbers times a, (n,).
        """
        values = np.empty((1 + 2 * len(self.layers), len(k), 2, 2), dtype=complex)
        for columns, rows, of_batch, _ in self._batches(k):
            values[:, columns] = of_batch[:, rows]
        return values[0], values[1::2], values[2::2]

    def _batches(self, k: NDArray) -> Iterator[tuple[NDArray, NDArray, NDArray, list[Field]]]:
        """Batches of wavenumbers that hold some of k: where k has them, and their rows in the batch; and
        of all of it what :meth:`crossed` gives, and the fields in each layer.

        They are kept: fields at all depths go through the same layers.
        """
        new = np.setdiff1d(k, np.concatenate([np.empty(0), *(kept for kept, *_ in self._kept)]))
        if len(new):
            self._keep()
            Z, crossing, fields = np.broadcast_to(self.substrate.down, (len(new), 2, 2)), [], []
            for layer in self.layers[::-1]:
                fields.append(layer.field(new, Z))
                crossing += [fields[-1](layer.H)[1], Z]
                Z = fields[-1](0.0)[0]
            self._kept.append((new, np.array([Z, *crossing[::-1]]), fields[::-1]))
        for kept, of_known, fields in self._kept:
            columns = np.isin(k, kept)
            if columns.any():
                yield columns, np.searchsorted(kept, k[columns]), of_known, fields

    @cached_property
    def _kept(self) -> list[tuple[NDArray[np.float64], NDArray[Any], list[Field]]]:
        """Rising wavenumbers of each batch, and what :meth:`_batches` has for all of these."""
        return []

    def _keep(self) -> None:
        """Keep batches of these layers, and forget those of others but the last ones."""
        if not any(stack is self for stack in _KEEPING):
            _KEEPING.append(self)
        if len(_KEEPING) > _MOST:
            vars(_KEEPING.popleft()).pop("_kept", None)

    def inside(self, k: NDArray, i: int, depth: float) -> tuple[NDArray[Any], NDArray[Any]]:
        """Stiffness at a depth of a layer, and displacements there by those of its upper face.

        Args:
            k: wavenumbers times a, (n,).
            i: number of the layer, from the top down.
            depth: over a, below its upper face.

        Returns:
            Both, (n, 2, 2) each.
        """
        values = np.empty((2, len(k), 2, 2), dtype=complex)
        for columns, rows, _, fields in self._batches(k):
            values[:, columns] = np.array(fields[i](depth))[:, rows]
        return values[0], values[1]

    def excess(self, k: NDArray) -> NDArray[Any]:
        """Stiffness of the surface less that of a half-plane of the solid there, (n, 2, 2)."""
        if not self.layers:
            return np.zeros((len(k), 2, 2), dtype=complex)
        Z = np.broadcast_to(self.substrate.down, (len(k), 2, 2))
        for layer in self.layers[:0:-1]:
            Z = layer.top.down + layer.excess(k, Z)
        return np.asarray(self.layers[0].excess(k, Z))

    def stiffness(self, k: NDArray) -> NDArray[Any]:
        """Z(k) of the surface, t = k Z u, Hermitian, (n, 2, 2)."""
        return self.top.down + self.excess(k)

    def admittance(self, k: NDArray) -> NDArray[Any]:
        """ΔŶ(k): u,X by tractions, less that of a half-plane of the surface's solid, (n, 2, 2).

        Ŷ = i Z⁻¹ and no difference of nearly equal numbers is taken.
        """
        δ = self.excess(k)
        Z = self.top.down
        return np.asarray(-1j * inverse(Z + δ) @ δ @ inverse(Z))

    def min_stiffness(self, k: NDArray) -> NDArray[np.float64]:
        """Smallest stiffness against a wave with each wavenumber, on the surface or inside, (n,).

        It falls with speed; where it is 0 that wave runs with the load, freely. Where something below
        already gives way to a wave, the layers above are not evaluated.
        """
        for layer in self.layers:
            layer.check()
        smallest, going = np.full(len(k), np.inf), np.arange(len(k))
        Z = np.broadcast_to(self.substrate.down, (len(k), 2, 2))
        for layer in self.layers[::-1]:
            in_layer = layer.min_stiffness(k[going], Z)
            smallest[going] = np.minimum(smallest[going], np.where(np.isnan(in_layer), -np.inf, in_layer))
            holds = smallest[going] > 0.0
            going = going[holds]
            if not len(going):
                return smallest
            Z = layer.top.down + layer.excess(k[going], Z[holds])
        surface = least(Z)
        smallest[going] = np.minimum(smallest[going], np.where(np.isnan(surface), -np.inf, surface))
        return smallest


#: Layers at a speed that keep their fields, and how many do: those in graded layers take 50 MB and more.
_KEEPING, _MOST = deque[LayersAtSpeed](), 2

#: Wavenumbers per octave at which stiffness is evaluated, and their range: kH of all layers, of the
#: thinnest layer.
_DENSITY, _LONGEST, _SHORTEST = 6, 1e-3, 30.0
#: Number of refinements next to the smallest stiffness, and wavenumbers in each.
_CLOSER, _THERE = 4, 9
#: Stiffness that stands for -∞, over that of the solid at the surface.
_BEYOND = -1.0
#: Most steps; growth of steps below waves inside, and the second of them.
_STEPS, _STRIDE, _FIRST_STEP = 90, 2.0, 1e-4


def weakest(stack: LayersAtSpeed) -> tuple[float, float]:
    """Smallest stiffness against any wave, and its wavenumber times a."""
    H = [layer.H for layer in stack.layers]
    k = wavenumbers(sum(H), min(H))
    for _ in range(_CLOSER):
        values = stack.min_stiffness(k)
        i = int(np.argmin(values))
        lowest, at = float(values[i]), float(k[i])
        if not lowest > 0.0 or i in (0, len(k) - 1):
            break
        if lowest > np.ptp(values[i - 1 : i + 2]):  # between these a smooth one stays positive
            break
        k = np.geomspace(k[i - 1], k[i + 1], _THERE)
    return lowest, at


def wavenumbers(whole: float, thinnest: float) -> NDArray[np.float64]:
    """Wavenumbers times a, from waves much longer than all layers to much shorter than the thinnest."""
    first, last = _LONGEST / whole, _SHORTEST / thinnest
    return np.geomspace(first, last, int(_DENSITY * np.log2(last / first)) + 1)


def highest(stack: Callable[[float], LayersAtSpeed], most: float, accuracy: float) -> float:
    """Highest speed at which the stiffness against every wave is positive.

    Where one is not, the speed falls to that at which the weakest wave's stiffness vanishes, and the
    weakest wave there is sought again.

    Args:
        stack: gives the layers at a speed; raises ValueError where some wave inside is not faster.
        most: a speed that is no lower.
        accuracy: relative.

    Raises:
        SolveError: there is no such speed.
    """
    speed, step = most, accuracy
    for _ in range(_STEPS):
        try:
            value, k = weakest(stack(speed))
        except (ValueError, SolveError):
            # Beyond waves inside, or too near to them to be followed.
            value, k = -np.inf, np.nan
        if value > 0.0:
            return speed
        if np.isfinite(value):
            speed = (1.0 - accuracy) * _zero(_stiffness_at(stack, np.array([k])), 0.0, speed, accuracy)
        else:
            speed, step = speed * (1.0 - step), max(_STRIDE * step, _FIRST_STEP)
        if not 0.0 < step < 1.0:
            break
    raise SolveError("no speed was found at which the layers are stable; are their constants as meant?")


def _stiffness_at(
    stack: Callable[[float], LayersAtSpeed], k: NDArray
) -> Callable[[float], NDArray[np.float64]]:
    """Smallest stiffness against waves (n,) by speed; -∞ where some wave inside is not faster."""

    def min_stiffness(speed: float) -> NDArray[np.float64]:
        try:
            return stack(speed).min_stiffness(k)
        except (ValueError, SolveError):
            return np.full(len(k), -np.inf)

    return min_stiffness


def _zero(f: Callable[[float], NDArray], low: float, high: float, accuracy: float) -> float:
    """Number, to an accuracy, at which a falling function, (1,), vanishes; it may be -∞ beyond.

    It is one of the ends where the function, which has errors of its own, has no zero between them.
    """
    from scipy.optimize import brentq  # a slow import

    value = cache(lambda x: max(float(f(x)[0]), _BEYOND))
    for end, beside in ((high, value(high) > 0.0), (low, value(low) <= 0.0)):
        if beside:
            return end
    return float(brentq(value, low, high, xtol=accuracy * high))


#: Speeds over the highest at which each wave's stiffness is evaluated first.
_SPEEDS = np.concatenate([[0.0], 1.0 - np.geomspace(1.0, 1e-9, 40)[1:]])
#: Relative accuracy of the speed of the slowest wave inside.
_INSIDE = 1e-13


def dispersion(
    stack: Callable[[float], LayersAtSpeed], most: float, k: NDArray, accuracy: float
) -> NDArray[np.float64]:
    """Speed of the slowest wave with each wavenumber, (n,); NaN where it is no slower than waves inside.

    Args:
        stack: gives the layers at a speed; raises ValueError where some wave inside is not faster.
        most: a speed at which some wave inside is not faster.
        k: wavenumbers times a, (n,).
        accuracy: relative.
    """
    stands = _stiffness_at(stack, k[:1])
    speeds = bisected(lambda c: bool(np.isfinite(stands(c)[0])), most, accuracy=_INSIDE) * _SPEEDS
    values = np.array([_stiffness_at(stack, k)(speed) for speed in speeds.tolist()])
    slowest = np.full(len(k), np.nan)
    for i, column in enumerate(values.T):
        if (column <= 0.0).any():
            j = int(np.argmax(column <= 0.0))
            of_wave = _stiffness_at(stack, k[i : i + 1])
            slowest[i] = _zero(of_wave, float(speeds[j - 1]), float(speeds[j]), accuracy)
    return slowest


#: Laws by which constants change from the upper face of a layer to the lower one.
GRADINGS = ("linear", "exponential", "power")
#: Number of depths at which the roots p of a graded layer are evaluated.
_SAMPLES = 5


@dataclass(frozen=True)
class Layer:
    """A layer, uniform or graded.

    Attributes:
        thickness: [m].
        solid: at its upper face.
        bottom: at its lower face, of the same kind; None where the layer is uniform.
        grading: ``"linear"``: constants change like the depth; ``"exponential"``: their logarithms do;
            ``"power"``: like a power of the depth.
        exponent: of ``"power"``, at least 1.
        yield_strength: uniaxial yield strength [Pa]; None where it is not given.

    Raises:
        ValueError: constants cannot change so.
    """

    thickness: float
    solid: Solid
    bottom: Solid | None = None
    grading: str = "linear"
    exponent: float = 1.0
    yield_strength: float | None = None

    def __post_init__(self) -> None:
        if self.bottom is None:
            return
        if type(self.bottom) is not type(self.solid) or self.bottom.plane != self.solid.plane:
            raise ValueError("expected the same kind of solid and the same plane at both faces")
        if self.grading == "exponential":
            for key, (top, bottom) in self._changing.items():
                if np.any(np.multiply(top, bottom) <= 0.0):
                    raise ValueError(
                        f"grading: found {key} from {top} to {bottom}, expected two numbers of one sign "
                        'with "exponential", or "linear"'
                    )

    @property
    def _changing(self) -> dict[str, tuple[Any, Any]]:
        """Constants that differ between the faces, with their values at the upper and the lower one."""
        top, bottom = values(self.solid), values(self.bottom)
        numbers = (key for key, parameter in parameters(self.solid).items() if not parameter.options)
        return {key: (top[key], bottom[key]) for key in numbers if top[key] != bottom[key]}

    @property
    def power(self) -> float:
        """Power of the relative depth that gives the share of the change from top to bottom."""
        return self.exponent if self.grading == "power" else 1.0

    def at(self, share: float) -> Solid:
        """The solid at a share of the change from the upper face (0) to the lower one (1)."""
        if self.bottom is None or share == 0.0:
            return self.solid

        def mixed(top: Any, bottom: Any) -> Any:
            top, bottom = np.asarray(top, dtype=float), np.asarray(bottom, dtype=float)
            if self.grading == "exponential":
                now = top * (bottom / top) ** share
            else:
                now = top + (bottom - top) * share
            return float(now) if not now.ndim else tuple(now.tolist())

        changed = {key: mixed(*pair) for key, pair in self._changing.items()}
        return build_model(type(self.solid), values(self.solid) | changed)  # type: ignore[no-any-return]

    def words(self) -> str:
        """Description of the layer with units, as part of a sentence."""
        words = f"{with_prefix(self.thickness, 'm')} of {self.solid.words()}"
        if self.bottom is None:
            return words
        how = self.grading + f" {self.exponent:g}" * (self.grading == "power")
        return f"{words}, graded ({how}) to {self.bottom.words()}"


@dataclass(frozen=True)
class Layered(Composite):
    """Layers from the top down, perfectly bonded to one another and to a substrate.

    Modulus, density and wave speed are those at the surface; so are the exponents of the pressure.

    Attributes:
        layers: at least one.
        substrate: the half-plane below.
    """

    about: ClassVar[str] = "layers on a substrate"
    form: ClassVar[str] = "anisotropic"

    layers: tuple[Layer, ...] = field()  # no default, though uniform solids have one: no layers
    substrate: Solid = field()

    @cached_property
    def parts(self) -> tuple[Layer, ...]:
        """The layers, and the substrate as one without end."""
        return (*self.layers, Layer(np.inf, self.substrate))

    @property
    def surface(self) -> Solid:
        """The solid at the surface."""
        return self.parts[0].solid

    @property
    def nearly_incompressible(self) -> bool:
        return any(solid.nearly_incompressible for solid in self.solids)

    @property
    def solids(self) -> Sequence[Solid]:
        return tuple(end for part in self.parts for end in (part.solid, part.bottom) if end is not None)

    def flutter(self, c: float = 0.0) -> tuple[float, float]:
        """Flutter thresholds of the solid at the surface: the shortest waves reach no other."""
        return self.surface.flutter(c)

    @property
    def knows_σ_ZZ(self) -> bool:
        return all(solid.knows_σ_ZZ for solid in self.solids)

    @cached_property
    def depths(self) -> NDArray[np.float64]:
        """Depths of the interfaces [m], (layers,)."""
        return np.cumsum([layer.thickness for layer in self.layers])

    def at(self, depth: float) -> Solid:
        """The solid at a depth [m]; at an interface the one above it."""
        i = int(np.searchsorted(self.depths, depth))
        layer, top = self.parts[i], float(np.append(0.0, self.depths)[i])
        return layer.at(((depth - top) / layer.thickness) ** layer.power)

    @property
    def bending(self) -> float:
        """Length in which layers that are stiffer than what is below them bend [m]; 0 for none.

        A plate of the thickness H and the modulus E on a half-plane of E₀ bends in H (E/(6 E₀))^⅓, where
        E - E₀ is what is more than the half-plane's own. The plate is as thick as all layers here, and as
        stiff as any over what is the softest below it.
        """
        stiffness = np.array([solid.μ / solid.response(0.0).n for solid in self.solids])
        softest = np.minimum.accumulate(stiffness[::-1])[::-1]
        return float(self.depths[-1] * (np.max(stiffness / softest - 1.0) / 6.0) ** (1.0 / 3.0))

    @property
    def changes(self) -> tuple[float, ...]:
        """Length in which each layer's modulus changes by its own amount [m], infinite where uniform."""
        lengths = []
        for layer in self.layers:
            softer, stiffer = sorted((layer.solid.μ, (layer.bottom or layer.solid).μ))
            lengths.append(
                layer.thickness / (stiffer / softer - 1.0) if stiffer > softer else float("inf")
            )
        return tuple(lengths)

    def beside(self, interface: int) -> tuple[Solid, Solid]:
        """The solids above and below an interface; interfaces are numbered from 0."""
        layer, below = self.parts[interface : interface + 2]
        return layer.bottom or layer.solid, below.solid

    @cached_property
    def _limit(self) -> float:
        graded = any(layer.bottom for layer in self.layers)

        def stack(c: float) -> LayersAtSpeed:
            return self.response(c).stack(1.0, 1e-8)

        # Waves much shorter than a layer, and much longer than all, run as in one solid.
        most = min(self.surface.limit(), self.substrate.limit() * self.substrate.c_s / self.c_s)
        most = bisected(self._outruns, most, accuracy=_INSIDE)
        return highest(stack, most, 1e-9 if graded else 1e-13)

    def _outruns(self, c: float) -> bool:
        """Return True if waves inside all solids are faster than c."""
        try:
            return bool(self.response(c).roots_of_solids)
        except ValueError:
            return False

    def limit(self) -> float:
        """Highest speed over ``c_s`` at which no wave runs with the load, freely."""
        return self._limit

    def response(self, c: float, a: float = 1.0) -> "LayeredHalfPlane":
        """The half-plane at a speed over ``c_s`` of the surface's solid.

        Args:
            c: speed, dimensionless.
            a: unit of length [m].

        Raises:
            ValueError: waves in one of the solids are not faster.
        """
        half_plane = LayeredHalfPlane(self, c, a)
        for solid in self.solids:
            half_plane.uniform(solid)
        return half_plane

    def σ_ZZ_at(self, depth: NDArray, σ: NDArray) -> NDArray[np.float64]:
        """σ_ZZ at depths [m], (n,), in the unit of the stresses σ_XX, σ_YY, σ_XY there, (3, ..., n)."""
        values = np.empty(σ.shape[1:])
        for each in np.unique(depth).tolist():
            there = each == depth
            values[..., there] = self.at(each).σ_ZZ(*σ[..., there])
        return values

    def words(self) -> str:
        words = "; ".join(layer.words() for layer in self.layers)
        return f"{words}; on {self.substrate.words()}"


#: Columns of tables of constants: stiffness row by row, the speed, and the density.
_COLUMNS = {name: i for i, name in enumerate(("c11", "c12", "c16", "c22", "c26", "c66", "c", "ρ"))}
#: Points at which a graded solid is tabulated at first and at most, and its error between them.
_FEW, _MANY, _LEFT = 9, 257, 1e-13
#: Gauss's rule over a layer's thickness.
_τ, _w = leggauss(24)
#: Relative distance of a depth from an interface beyond which it is not that of the interface.
_BESIDE = 1e-12


@dataclass(frozen=True)
class LayeredHalfPlane(HalfPlane):
    """Layers on a substrate at a speed; n, m, q, n12 and Hooke's law are of the solid at the surface.

    Attributes:
        solid: the layers and the substrate.
        c: speed over the wave speed of the solid at the surface.
        a: unit of length [m].
    """

    solid: Layered
    c: float
    a: float = 1.0

    #: Meshes along interfaces are drawn in the plane itself.
    contraction = 1j  # type: ignore[assignment]

    def uniform(self, solid: Solid) -> UniformHalfPlane:
        """Half-plane of one of the solids alone at this speed.

        Raises:
            ValueError: waves in it are not faster.
        """
        return solid.response(self.c * self.solid.c_s / solid.c_s).surface

    @cached_property
    def surface(self) -> UniformHalfPlane:
        return self.solid.surface.response(self.c).surface

    def inside(self, Φ: Potential, g: Any, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """Not available: see :class:`galinx.solvers.layers.kernel.Level`."""
        raise NotImplementedError("stresses inside layers are no function of one potential")

    @cached_property
    def depths(self) -> NDArray[np.float64]:
        """Depths of the interfaces over a, (layers,)."""
        return self.solid.depths / self.a

    @property
    def margin(self) -> float:
        """1 at rest, 0 at the limit."""
        return 1.0 - (self.c / self.solid.limit()) ** 2

    @property
    def left_below(self) -> float:
        """1 at rest, 0 at the speed of a wave along the substrate by itself."""
        below = self.solid.substrate
        return 1.0 - (self.c * self.solid.c_s / (below.limit() * below.c_s)) ** 2

    @property
    def mirrored(self) -> bool:
        """True where all solids are their own mirror images."""
        return all(self.uniform(solid).mirrored for solid in self.solid.solids)

    @property
    def roots_of_solids(self) -> list[tuple[complex, ...]]:
        """p of every solid from the top down, of graded ones at several depths, and of the substrate."""
        roots = []
        for part in self.solid.parts:
            shares = np.linspace(0.0, 1.0, _SAMPLES if part.bottom else 1).tolist()
            each = [self.uniform(part.at(share)).roots.each for share in shares]
            roots.append(tuple(p for pair in each for p in pair))
        return roots

    def medium(self, solid: Solid) -> Medium:
        """One of the solids at this speed."""
        return Medium(self.uniform(solid), solid.μ / self.solid.μ)

    def stack(self, a: float, rtol: float = STEP) -> LayersAtSpeed:
        """The layers with lengths over a.

        Args:
            a: length [m].
            rtol: of the integration of graded layers; a smaller one than the usual is that.
        """
        layers = [self._layer(layer, a, rtol) for layer in self.solid.layers]
        return LayersAtSpeed(layers, self.medium(self.solid.substrate))

    def _layer(self, layer: Layer, a: float, rtol: float) -> Uniform | Graded:
        if layer.bottom is None:
            return Uniform(self.medium(layer.solid), layer.thickness / a)
        of: Callable[[float], Medium] = lambda share: self.medium(layer.at(share))  # noqa: E731
        return Graded(of, layer.thickness / a, layer.power, rtol=max(rtol, STEP))

    def constants(self, names: Sequence[str]) -> list[NDArray[np.float64]]:
        return [np.stack([table[_COLUMNS[name]] for name in names], axis=-1) for table in self._tables]

    @cached_property
    def _tables(self) -> list[NDArray[np.float64]]:
        """Tables of each solid: ``_COLUMNS`` at Chebyshev's points of its share of change, (8, n)."""
        return [_tabulated(partial(self._column, part), part.bottom is None) for part in self.solid.parts]

    def _column(self, part: Layer, share: float) -> NDArray[np.float64]:
        """Stiffness over the surface's μ, the speed over its wave speed by density, and the density."""
        solid = part.at(share)
        C, ρ = solid.μ * solid.response(0.0).surface.C / self.solid.μ, solid.ρ / self.solid.ρ
        return np.append(C[np.triu_indices(3)], [self.c * ρ**0.5, ρ])

    @cached_property
    def _faces(self) -> NDArray[np.float64]:
        """Depths of the upper faces of all solids, over a."""
        return np.append(0.0, self.depths)

    def solids(self, Y: NDArray, side: int = 1) -> NDArray[np.int64]:
        return np.maximum(np.searchsorted(self._faces, -Y * (1.0 - side * _BESIDE)) - 1, 0)

    def share(self, solid: int, Y: NDArray) -> NDArray[np.float64]:
        layer, top = self.solid.parts[solid], self._faces[solid]
        done = np.clip((-Y - top) * self.a / layer.thickness, 0.0, 1.0)
        return np.asarray(done**layer.power)

    def stresses_at(self, Y: NDArray, G: NDArray, side: int = 1) -> NDArray[np.float64]:
        solid, C = self.solids(Y, side), np.empty((len(Y), 3, 3))
        row, column = np.triu_indices(3)
        for i in np.unique(solid).tolist():
            points = solid == i
            values = interpolation(self.share(i, Y[points]), self._tables[i].shape[1]) @ self._tables[i].T
            stiffnesses = np.empty((len(values), 3, 3))
            stiffnesses[:, row, column] = stiffnesses[:, column, row] = values[:, : len(row)]
            C[points] = stiffnesses
        strain = np.stack([G[..., 0, 0], G[..., 1, 1], G[..., 0, 1] + G[..., 1, 0]], axis=-1)
        return np.moveaxis(np.einsum("nij,...nj->...ni", C, strain, optimize=True), -1, 0)

    def far(self, X: NDArray, Y: NDArray, terms: int = 1, datum: float = DATUM) -> NDArray[np.float64]:
        """Displacements μ u far from line loads alone, whatever terms is, (1, 2, 2, n)."""
        substrate, D = self.medium(self.solid.substrate), float(self.depths[-1])
        below = np.minimum(Y + D, 0.0)
        (displacement,) = (
            substrate.response.far(X, below, datum=datum * max(1.0, self.far_length)) / substrate.modulus
        )
        G = substrate.response.G.conj()
        heights, which = np.unique(np.maximum(Y, -D), return_inverse=True)
        moved = [self._moved(height) for height in heights.tolist()]  # none on a rank without far nodes
        more = np.reshape(moved, (-1, 2, 2))[which]
        w = inverse(X[:, None, None] * np.eye(2) + below[:, None, None] * G)
        w = w @ (self._compliance @ self._loaded + more)
        for load, t in zip(displacement, LOADS):
            load += (1j * w @ t).real.T / np.pi
        return displacement[None]

    @cached_property
    def _compliance(self) -> NDArray[np.complex128]:
        return inverse(self.medium(self.solid.substrate).down)

    @property
    def far_length(self) -> float:
        """Length over a on which the terms that layers add to the line load's vary."""
        moved, compliance, loaded = (
            float(np.linalg.norm(matrix, 2))
            for matrix in (self._moved(0.0), self._compliance, self._loaded)
        )
        return max(float(self.depths[-1]), moved / compliance, loaded)

    @cached_property
    def _loaded(self) -> NDArray[np.complex128]:
        """Matrix E of the load on the substrate, (2, 2)."""
        A, B, _ = self._through(0.0)
        return np.asarray(1j * B - A @ self._compliance)

    def _moved(self, height: float) -> NDArray[np.complex128]:
        """∫ (T⁻¹ - i Bᵀ Z₋⁻¹) dY from the substrate up to a height over a, (2, 2)."""
        _, B, T_inverse = self._through(height)
        return np.asarray(T_inverse - 1j * B.T @ self._compliance)

    def _through(self, height: float) -> NDArray[np.float64]:
        """∫ A, ∫ B and ∫ T⁻¹ over the layers up to a height over a, (3, 2, 2)."""
        integrals = np.zeros((3, 2, 2))
        for i in range(len(self.solid.layers)):
            bottom, top = -self._faces[i + 1], min(-self._faces[i], height)
            if top <= bottom:
                continue
            Y = bottom + (top - bottom) * (_τ + 1.0) / 2.0
            of_share = interpolation(self.share(i, Y), self._tables[i].shape[1])
            c11, c12, c16, c22, c26, c66, c, _ = self._tables[i] @ of_share.T
            Q, R, T = (
                np.moveaxis(np.array(M), 2, 0)
                for M in ([[c11 - c**2, c16], [c16, c66 - c**2]], [[c16, c12], [c66, c26]],
                          [[c66, c26], [c26, c22]])
            )  # fmt: skip
            T_inverse = np.linalg.inv(T)
            B = R @ T_inverse
            parts = np.array([Q - B @ R.swapaxes(1, 2), B, T_inverse])
            integrals += (top - bottom) / 2.0 * np.einsum("q,nqij->nij", _w, parts)
        return integrals


def _tabulated(of: Callable[[float], NDArray], uniform: bool) -> NDArray[np.float64]:
    """Constants of a solid at Chebyshev's points of its share of change, (columns, points).

    Raises:
        SolveError: constants change too much.
    """
    count = 1 if uniform else _FEW
    while count <= _MANY:
        values = np.array([of(s) for s in chebyshev_points(count).tolist()])
        if uniform:
            return values.T
        c = np.linalg.solve(chebvander(2.0 * chebyshev_points(count) - 1.0, count - 1), values)
        if np.abs(c[-2:]).max() <= _LEFT * np.abs(values).max():
            return values.T
        count = 2 * count - 1
    raise SolveError("the solid of a graded layer changes too much to be followed by finite elements")
