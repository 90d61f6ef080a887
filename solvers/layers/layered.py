"""Layers on a substrate as one solid: what all solvers ask of a solid, and its layers besides."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.layers.graded import Graded
from galinx.solvers.layers.medium import Medium
from galinx.solvers.layers.speed import bisected, highest
from galinx.solvers.layers.stack import Stack
from galinx.solvers.layers.uniform import Uniform
from galinx.solvers.parameters import made, parameters, values
from galinx.solvers.solids.solid import Potential, Response, Solid

#: How constants change from the upper face of a layer to the lower one.
GRADINGS = ("linear", "exponential", "power")
#: Depths at which a graded layer's planes are looked at.
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
        exponent: of that power, at least 1.

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
            for key, (one, other) in self._changing.items():
                if np.any(np.multiply(one, other) <= 0.0):
                    raise ValueError(
                        f"grading: found {key} from {one} to {other}, expected two numbers of one sign "
                        'with "exponential", or "linear"'
                    )

    @property
    def _changing(self) -> dict[str, tuple[Any, Any]]:
        """Constants that differ at both faces."""
        one, other = values(self.solid), values(self.bottom)
        numbers = (key for key, known in parameters(self.solid).items() if not known.options)
        return {key: (one[key], other[key]) for key in numbers if one[key] != other[key]}

    @property
    def power(self) -> float:
        """Of the depth, by which the share of the change is done."""
        return self.exponent if self.grading == "power" else 1.0

    def at(self, share: float) -> Solid:
        """The solid where that share of the change is done."""
        if self.bottom is None or share == 0.0:
            return self.solid

        def mixed(one: Any, other: Any) -> Any:
            one, other = np.asarray(one, dtype=float), np.asarray(other, dtype=float)
            if self.grading == "exponential":
                now = one * (other / one) ** share
            else:
                now = one + (other - one) * share
            return float(now) if not now.ndim else tuple(now.tolist())

        changed = {key: mixed(*pair) for key, pair in self._changing.items()}
        return made(type(self.solid), values(self.solid) | changed)  # type: ignore[no-any-return]

    def words(self) -> str:
        """The layer in a sentence's middle, with units."""
        told = f"{self.thickness:.6g} m of {self.solid.words()}"
        if self.bottom is None:
            return told
        how = self.grading + f" {self.exponent:g}" * (self.grading == "power")
        return f"{told}, graded ({how}) to {self.bottom.words()}"


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
        """All of them, from the top down, graded ones at both faces."""
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
        """That of the solid at the surface: the shortest waves see no other."""
        return self.surface.flutter

    @property
    def slowest(self) -> float:
        """Least of the wave speeds by which solids' speeds are told [m/s]."""
        return min(solid.c_s for solid in self.solids)

    @property
    def knows_σ_ZZ(self) -> bool:
        return all(solid.knows_σ_ZZ for solid in self.solids)

    @cached_property
    def depths(self) -> NDArray[np.float64]:
        """Of the interfaces [m], (layers,)."""
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
        """Length over which each layer's modulus changes by itself [m], infinite where it does not."""
        found = []
        for layer in self.layers:
            one, other = sorted((layer.solid.μ, (layer.bottom or layer.solid).μ))
            found.append(layer.thickness / (other / one - 1.0) if other > one else float("inf"))
        return tuple(found)

    def beside(self, interface: int) -> tuple[Solid, Solid]:
        """The solids above and below an interface, from 0."""
        layer, rest = self.layers[interface], self.layers[interface + 1 :]
        return layer.bottom or layer.solid, rest[0].solid if rest else self.substrate

    @cached_property
    def _limit(self) -> float:
        graded = any(layer.bottom for layer in self.layers)

        def stack(c: float) -> Stack:
            return self.response(c).stack(1.0, 1e-8)

        # Waves much shorter than a layer, and much longer than all, run as in one solid.
        most = min(self.surface.limit(), self.substrate.limit() * self.substrate.c_s / self.c_s)
        return highest(stack, bisected(self._outruns, most), 1e-9 if graded else 1e-13)

    def _outruns(self, c: float) -> bool:
        """Are waves inside all solids faster?"""
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
        """Of the solid at the surface."""
        return self.surface.σ_ZZ(σ_XX, σ_YY, σ_XY)

    def words(self) -> str:
        told = "; ".join(layer.words() for layer in self.layers)
        return f"{told}; on {self.substrate.words()}"


@dataclass(frozen=True)
class LayeredResponse:
    """Layers seen from a load that moves; what has no layers in it is of the solid at the surface.

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
        """Are all solids their own mirror images?"""
        return all(
            solid.response(self.c * self.solid.c_s / solid.c_s).mirrored for solid in self.solid.solids
        )

    def medium(self, solid: Solid) -> Medium:
        """One of its solids at that speed."""
        return Medium(solid.response(self.c * self.solid.c_s / solid.c_s), solid.μ / self.solid.μ)

    @property
    def roots(self) -> list[tuple[complex, ...]]:
        """p of every solid from the top down, of graded ones at several depths, and of the substrate."""
        shares = [np.linspace(0.0, 1.0, _SAMPLES if one.bottom else 1) for one in self.solid.layers]
        solids = [
            *([one.at(share) for share in some.tolist()] for one, some in zip(self.solid.layers, shares)),
            [self.solid.substrate],
        ]
        return [
            tuple(p for solid in some for p in self.medium(solid).response.roots.each) for some in solids
        ]

    def stack(self, a: float, rtol: float = 0.0) -> Stack:
        """Its layers with lengths over a.

        Args:
            a: length [m].
            rtol: of the integration of graded layers, 0 for the usual one.
        """
        return Stack([self._layer(layer, a, rtol) for layer in self.solid.layers], self.medium(
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
        """Not known: see :mod:`galinx.solvers.layers.inside`."""
        raise NotImplementedError("stresses inside layers are no function of one potential")
