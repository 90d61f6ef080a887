"""Layers on a substrate as one solid: all that solvers need of a solid, and its layers besides.

:class:`Layered` is the solid, :class:`LayeredResponse` the solid at a speed, and :class:`LayersAtSpeed`
the layers at that speed with lengths over a, with the stiffness of their surface.

Below the highest speed over layers the stiffness against every wave, on the surface and inside, is
positive; it falls with speed, so that the speed at which the smallest of all vanishes is found by
bracketing (:func:`highest`), and so is the speed of the slowest wave of each wavelength
(:func:`dispersion`).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..errors import SolveError
from ..parameters import build_model, parameters, values
from ..solids.solid import Potential, Response, Solid
from .stiffness import Graded, Medium, Uniform, inverse, least


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

    def below(self, k: NDArray) -> list[NDArray[Any]]:
        """Stiffness Z under every layer, from the top down, (n, 2, 2) each.

        Args:
            k: wavenumbers times a, (n,).
        """
        Z = np.broadcast_to(self.substrate.down, (len(k), 2, 2))
        stiffnesses = [Z]
        for layer in self.layers[:0:-1]:
            Z = layer.top.down + layer.excess(k, Z)
            stiffnesses.append(Z)
        return stiffnesses[::-1]

    def excess(self, k: NDArray) -> NDArray[Any]:
        """Stiffness of the surface less that of a half-plane of the solid there, (n, 2, 2)."""
        if not self.layers:
            return np.zeros((len(k), 2, 2), dtype=complex)
        return np.asarray(self.layers[0].excess(k, self.below(k)[0]))

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


#: Wavenumbers per octave at which stiffness is evaluated, and their range: kH of all layers, of the
#: thinnest layer.
_DENSITY, _LONGEST, _SHORTEST = 6, 1e-3, 30.0
#: Number of refinements next to the smallest stiffness, and wavenumbers in each.
_CLOSER, _THERE = 4, 9
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
            speed = (1.0 - accuracy) * _where_it_falls(stack, k, speed, accuracy)
        else:
            speed, step = speed * (1.0 - step), max(_STRIDE * step, _FIRST_STEP)
        if not 0.0 < step < 1.0:
            break
    raise SolveError("no speed was found at which the layers are stable; are their constants as meant?")


def _where_it_falls(
    stack: Callable[[float], LayersAtSpeed], k: float, high: float, accuracy: float
) -> float:
    """Speed at which one wave's stiffness vanishes, below one at which it is negative."""

    def min_stiffness(speed: float) -> float:
        try:
            return float(stack(speed).min_stiffness(np.array([k]))[0])
        except (ValueError, SolveError):
            return -np.inf

    low, f_low, f_high, side = 0.0, min_stiffness(0.0), min_stiffness(high), 0
    for _ in range(_STEPS):
        if high - low <= accuracy * high:
            break
        middle = (low + high) / 2.0
        if np.isfinite(f_high) and f_high < 0.0:  # Illinois
            guess = (low * f_high - high * f_low) / (f_high - f_low)
            middle = guess if low < guess < high else middle
        value = min_stiffness(middle)
        if value > 0.0:
            low, f_low = middle, value
            f_high = f_high / 2.0 if side == 1 else f_high
            side = 1
        else:
            high, f_high = middle, value
            f_low = f_low / 2.0 if side == -1 else f_low
            side = -1
    return low


#: Speeds over the highest at which each wave's stiffness is evaluated first, and steps from there.
_SPEEDS = np.concatenate([[0.0], 1.0 - np.geomspace(1.0, 1e-9, 40)[1:]])
_CLOSE = 60


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

    def min_stiffness(speed: float, k_waves: NDArray) -> NDArray[np.float64]:
        try:
            return stack(speed).min_stiffness(k_waves)
        except (ValueError, SolveError):
            return np.full(len(k_waves), -np.inf)

    slowest_inside = bisected(lambda c: bool(np.isfinite(min_stiffness(c, k[:1]))[0]), most)
    speeds = slowest_inside * _SPEEDS
    values = np.array([min_stiffness(speed, k) for speed in speeds.tolist()])
    slowest = np.full(len(k), np.nan)
    for i, column in enumerate(values.T):
        if (column <= 0.0).any():
            j = int(np.argmax(column <= 0.0))
            holds = partial(_is_stiff, min_stiffness, k[i : i + 1])
            slowest[i] = bisected(holds, speeds[j], speeds[j - 1], accuracy)
    return slowest


def _is_stiff(min_stiffness: Callable[[float, NDArray], NDArray], k: NDArray, speed: float) -> bool:
    return bool(min_stiffness(speed, k)[0] > 0.0)


def bisected(
    holds: Callable[[float], bool], high: float, low: float = 0.0, accuracy: float = 1e-13
) -> float:
    """Highest number up to which a condition holds."""
    if holds(high):
        return high
    for _ in range(_CLOSE):
        if high - low <= accuracy * high:
            break
        middle = (low + high) / 2.0
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low


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

    Raises:
        ValueError: constants cannot change so.
    """

    thickness: float
    solid: Solid
    bottom: Solid | None = None
    grading: str = "linear"
    exponent: float = 1.0

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
        words = f"{self.thickness:.6g} m of {self.solid.words()}"
        if self.bottom is None:
            return words
        how = self.grading + f" {self.exponent:g}" * (self.grading == "power")
        return f"{words}, graded ({how}) to {self.bottom.words()}"


@dataclass(frozen=True)
class Layered:
    """Layers from the top down, perfectly bonded to one another and to a substrate.

    Modulus, density and wave speed are those at the surface; so are the exponents of the pressure.

    Attributes:
        layers: at least one.
        substrate: the half-plane below.
    """

    about: ClassVar[str] = "layers on a substrate"
    form: ClassVar[str] = "anisotropic"

    layers: tuple[Layer, ...]
    substrate: Solid

    @property
    def surface(self) -> Solid:
        """The solid at the surface."""
        return self.layers[0].solid

    @property
    def nearly_incompressible(self) -> bool:
        return any(solid.nearly_incompressible for solid in self.solids)

    @property
    def solids(self) -> Sequence[Solid]:
        """All solids from the top down, graded ones at both faces."""
        ends = (end for layer in self.layers for end in (layer.solid, layer.bottom) if end is not None)
        return (*ends, self.substrate)

    @property
    def plane(self) -> str:
        return self.surface.plane

    @property
    def μ(self) -> float:
        return self.surface.μ

    @property
    def ρ(self) -> float:
        return self.surface.ρ

    @property
    def c_s(self) -> float:
        return self.surface.c_s

    @property
    def flutter(self) -> tuple[float, float]:
        """Flutter of the solid at the surface: the shortest waves reach no other."""
        return self.surface.flutter

    @property
    def slowest(self) -> float:
        """Least of the solids' wave speeds [m/s]."""
        return min(solid.c_s for solid in self.solids)

    @property
    def knows_σ_ZZ(self) -> bool:
        return all(solid.knows_σ_ZZ for solid in self.solids)

    @cached_property
    def depths(self) -> NDArray[np.float64]:
        """Depths of the interfaces [m], (layers,)."""
        return np.cumsum([layer.thickness for layer in self.layers])

    def at(self, depth: float) -> Solid:
        """The solid at a depth [m]; at an interface the one above it."""
        top = 0.0
        for layer in self.layers:
            if depth <= top + layer.thickness:
                return layer.at(((depth - top) / layer.thickness) ** layer.power)
            top += layer.thickness
        return self.substrate

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
        layer, rest = self.layers[interface], self.layers[interface + 1 :]
        return layer.bottom or layer.solid, rest[0].solid if rest else self.substrate

    @cached_property
    def _limit(self) -> float:
        graded = any(layer.bottom for layer in self.layers)

        def stack(c: float) -> LayersAtSpeed:
            return self.response(c).stack(1.0, 1e-8)

        # Waves much shorter than a layer, and much longer than all, run as in one solid.
        most = min(self.surface.limit(), self.substrate.limit() * self.substrate.c_s / self.c_s)
        return highest(stack, bisected(self._outruns, most), 1e-9 if graded else 1e-13)

    def _outruns(self, c: float) -> bool:
        """Return True if waves inside all solids are faster than c."""
        try:
            return bool(self.response(c).roots)
        except ValueError:
            return False

    def limit(self) -> float:
        """Highest speed over ``c_s`` at which no wave runs with the load, freely."""
        return self._limit

    def response(self, c: float) -> "LayeredResponse":
        """The half-plane at a speed over ``c_s`` of the surface's solid.

        Raises:
            ValueError: waves in one of the solids are not faster.
        """
        for solid in self.solids:
            solid.response(c * self.c_s / solid.c_s)
        return LayeredResponse(self, c)

    def σ_ZZ(self, σ_XX: NDArray, σ_YY: NDArray, σ_XY: NDArray) -> NDArray[np.float64]:
        """σ_ZZ of the solid at the surface, in the unit of the stresses."""
        return self.surface.σ_ZZ(σ_XX, σ_YY, σ_XY)

    def words(self) -> str:
        words = "; ".join(layer.words() for layer in self.layers)
        return f"{words}; on {self.substrate.words()}"


@dataclass(frozen=True)
class LayeredResponse:
    """Layers at a speed; quantities of a half-plane are those of the solid at the surface.

    See :class:`galinx.solvers.solids.solid.Response`.
    """

    solid: Layered
    c: float

    @cached_property
    def surface(self) -> Response:
        """The half-plane of the solid at the surface."""
        return self.solid.surface.response(self.c)

    @property
    def n(self) -> float:
        return self.surface.n

    @property
    def m(self) -> float:
        return self.surface.m

    @property
    def n12(self) -> float:
        return self.surface.n12

    @property
    def q(self) -> float:
        return self.surface.q

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
    def contraction(self) -> complex:
        return self.surface.contraction

    @property
    def spread(self) -> float:
        return self.surface.spread

    @property
    def mirrored(self) -> bool:
        """True where all solids are their own mirror images."""
        return all(
            solid.response(self.c * self.solid.c_s / solid.c_s).mirrored for solid in self.solid.solids
        )

    def medium(self, solid: Solid) -> Medium:
        """One of the solids at this speed."""
        return Medium(solid.response(self.c * self.solid.c_s / solid.c_s), solid.μ / self.solid.μ)

    @property
    def roots(self) -> list[tuple[complex, ...]]:
        """p of every solid from the top down, of graded ones at several depths, and of the substrate."""
        shares = [np.linspace(0.0, 1.0, _SAMPLES if layer.bottom else 1) for layer in self.solid.layers]
        solids = [
            *(
                [layer.at(share) for share in of_layer.tolist()]
                for layer, of_layer in zip(self.solid.layers, shares)
            ),
            [self.solid.substrate],
        ]
        return [
            tuple(p for solid in of_layer for p in self.medium(solid).response.roots.each)
            for of_layer in solids
        ]

    def stack(self, a: float, rtol: float = 0.0) -> LayersAtSpeed:
        """The layers with lengths over a.

        Args:
            a: length [m].
            rtol: of the integration of graded layers, 0 for the usual one.
        """
        return LayersAtSpeed([self._layer(layer, a, rtol) for layer in self.solid.layers], self.medium(
            self.solid.substrate
        ))  # fmt: skip

    def _layer(self, layer: Layer, a: float, rtol: float) -> Uniform | Graded:
        if layer.bottom is None:
            return Uniform(self.medium(layer.solid), layer.thickness / a)
        graded: dict[str, Any] = {"rtol": rtol} if rtol else {}
        of: Callable[[float], Medium] = lambda share: self.medium(layer.at(share))  # noqa: E731
        return Graded(of, layer.thickness / a, layer.power, **graded)

    def σ_XX(self, u_X: NDArray, σ_YY: NDArray, σ_XY: NDArray) -> NDArray[np.float64]:
        return self.surface.σ_XX(u_X, σ_YY, σ_XY)

    def stresses(self, G: NDArray) -> NDArray[np.float64]:
        return self.surface.stresses(G)

    def inside(self, Φ: Potential, g: Any, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """Not available: see :class:`galinx.solvers.layers.kernel.Level`."""
        raise NotImplementedError("stresses inside layers are no function of one potential")
