"""Largest von Mises stress in each layer of a half-plane and in the solid below, under a smooth contact.

A stress is largest on the surface, on either side of an interface, or inside a layer. Along the surface
and the interfaces stresses are known at many positions. Inside, a layer is sampled at a few depths; where
one of these has more than the faces beside it, the depth of the largest stress is searched for between
its neighbours. So both methods need stresses at few points, one state at a time.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .extremes import extreme
from .solution import Contact
from .stresses import Surface, von_mises
from .yielding import Peak
from .yielding import places as uniform_places

#: Function of the number of a state and of points over a inside the solid, (n, 2), that gives σ_XX, σ_YY,
#: σ_XY over N/(2a) there, (3, n).
Inside = Callable[[int, NDArray], NDArray]

#: Depths below the surface, or below the lowest interface, over a, at which the solid is sampled.
_DEPTHS = np.array([0.1, 0.2, 0.35, 0.5, 0.7, 1.0, 1.5, 2.5, 4.0])
#: Relative depths within a thick layer, and within a thin one, up to a thickness over a.
_WITHIN, _WITHIN_THIN, _THIN = np.array([0.2, 0.5, 0.8]), np.array([0.5]), 0.15
#: Positions X/a at each depth, and places around both ends of the contact over the depth.
_ALONG, _NEAR = np.linspace(-2.5, 2.5, 41), np.linspace(-3.0, 3.0, 13)
#: Positions between neighbours of the best one, and accuracy of the depth over the distance of depths.
_FINER, _ACCURACY = np.linspace(-1.0, 1.0, 9), 1e-4
#: Share of the largest stress on a layer's faces from which on a stress inside is searched for.
_NEARLY = 0.98
#: Least depth over a of places at which errors are estimated: nearer to ends one place would be all.
_SHALLOWEST = 0.05
#: Least depth over a, of the first depth of sampling, at which stresses are evaluated.
_LEAST = 0.3


def sampled_depths(interfaces: NDArray) -> list[NDArray[np.float64]]:
    """Depths over a inside each layer and the solid below at which stresses are sampled.

    Args:
        interfaces: depths of the interfaces over a, (layers,).
    """
    tops = np.concatenate([[0.0], interfaces])
    each = [
        _WITHIN_THIN * H if H <= _THIN else np.union1d(_DEPTHS[_DEPTHS < 0.9 * H], _WITHIN * H)
        for H in np.diff(tops).tolist()
    ]
    return [top + depths for top, depths in zip(tops.tolist(), [*each, _DEPTHS])]


def places(body: Contact) -> NDArray[np.float64]:
    """Places X, Y over a at which stresses of every state are sampled, of any solid, (n, 2)."""
    if not body.layered:
        return uniform_places(body)
    depths = np.concatenate(sampled_depths(body.solid.depths / body.half_width))
    X, Y = np.meshgrid(np.linspace(-1.5, 1.5, 7), -depths[depths >= _SHALLOWEST])
    return np.column_stack([X.ravel(), Y.ravel()])


@dataclass(frozen=True)
class StrengthOfLayers:
    """Largest von Mises stresses of states at one speed.

    Attributes:
        inside: stresses inside, by any method.
        surface: stresses on the surface.
        interfaces: σ_YY, σ_XY, σ_XX above and below along every interface, (4, states, layers, n).
        along: positions X/a along interfaces, (n,).
        g: σ_XY/σ_YY under the punch, (states,).
        local: exponents α at X = a and β at X = -a, (states,) each.
        body: punch and solid, under the load of each state.
        half_width: of each state's contact [m], (states,).
    """

    inside: Inside
    surface: Surface
    interfaces: NDArray[np.float64]
    along: NDArray[np.float64]
    g: NDArray[np.float64]
    local: object
    body: Contact
    half_width: NDArray[np.float64]

    @cached_property
    def peaks(self) -> Peak:
        """Largest von Mises stress over N/(2a) of every layer and the solid below, (states, parts)."""
        states, layers = len(self.g), len(self.body.solid.depths)
        best = np.full((3, states, layers + 1), -np.inf)
        _take(best[:, :, 0], *self._on_surface())
        for i in range(layers):
            for side in (0, 1):
                σ_YY, σ_XY, σ_XX = self.interfaces[[0, 1, 2 + side], :, i]
                solid = self.body.solid.beside(i)[side]  # type: ignore[attr-defined]
                stress = von_mises(σ_XX, σ_YY, σ_XY, solid.σ_ZZ(σ_XX, σ_YY, σ_XY))
                value, X = extreme(stress, self.along, 1.0)
                _take(best[:, :, i + side], value, X, -self.body.solid.depths[i] / self.half_width)
        for state in range(states):
            for layer in range(layers + 1):
                found = self._searched(state, layer, float(best[0, state, layer]))
                _take(best[:, state : state + 1, layer], *(np.array([x]) for x in found))
        return Peak(*best)

    @property
    def von_mises(self) -> Peak:
        """Largest von Mises stress over N/(2a) of all layers and the solid below, (states,)."""
        layer = self.peaks.value.argmax(axis=1)[:, None]
        of_layers = self.peaks.value, self.peaks.X, self.peaks.Y
        return Peak(*(np.take_along_axis(x, layer, 1)[:, 0] for x in of_layers))

    @property
    def over_strength(self) -> NDArray[np.float64]:
        """Largest stress of every layer over its strength, NaN if not given, (states, parts)."""
        strengths = np.array([np.nan if y is None else y for y in self.body.strengths])
        unit = self.body.load / (2.0 * self.half_width)
        return self.peaks.value * np.reshape(unit, (-1, 1)) / strengths

    def _on_surface(self) -> tuple[NDArray, NDArray, NDArray]:
        """Largest von Mises stress on the surface, X and Y over a, (states,) each."""
        from .stresses import turns_at_ends

        surface, solid = self.surface, self.body.solid.at(0.0)  # type: ignore[attr-defined]
        σ_YY = np.nan_to_num(surface.σ_YY)

        def stress(XX: NDArray, YY: NDArray, XY: NDArray) -> NDArray[np.float64]:
            return von_mises(XX, YY, XY, solid.σ_ZZ(XX, YY, XY))

        value, X = extreme(stress(surface.σ_XX, σ_YY, self.g[:, None] * σ_YY), surface.places.X, 1.0)
        turns = turns_at_ends(surface, self.local)
        if surface.turns:
            turns = turns.joined(surface.turns)
        at_turns = np.nan_to_num(stress(*turns.σ), nan=-np.inf)
        rows, i = np.arange(len(X)), at_turns.argmax(axis=1)
        higher = at_turns[rows, i] > value
        X = np.where(higher, turns.X[rows, i], X)
        return np.where(higher, at_turns[rows, i], value), X, 0.0 * X

    def _searched(self, state: int, layer: int, faces: float) -> tuple[float, float, float]:
        """Largest von Mises stress inside a layer, X and Y over a; -inf where its faces have more.

        Args:
            state, layer: their numbers.
            faces: largest stress on the layer's faces.
        """
        from scipy.optimize import minimize_scalar  # a slow import

        interfaces = self.body.solid.depths / self.half_width[state]
        depths = sampled_depths(interfaces)[layer]
        values = [self._at_depth(state, depth)[0] for depth in depths.tolist()]
        best = int(np.argmax(values))
        if values[best] < _NEARLY * faces:
            return -np.inf, 0.0, 0.0
        top = 0.0 if layer == 0 else float(interfaces[layer - 1])
        # Between the first depth and the face above stresses near the surface vary ever faster.
        above = top + _LEAST * (depths[0] - top)
        bottom = float(interfaces[layer]) if layer < len(interfaces) else float(depths[-1])
        lower = depths[best + 1] if best + 1 < len(depths) else bottom - 1e-6 * (bottom - depths[-1])
        upper = depths[best - 1] if best else above
        found = minimize_scalar(
            lambda depth: -self._at_depth(state, depth)[0], bounds=(upper, lower), method="bounded",
            options={"xatol": _ACCURACY * (lower - upper), "maxiter": 25},
        )  # fmt: skip
        depth = float(found.x) if -found.fun >= values[best] else float(depths[best])
        value, X = self._at_depth(state, depth)
        return value, X, -depth

    def _at_depth(self, state: int, depth: float) -> tuple[float, float]:
        """Largest von Mises stress at a depth over a, and its X over a."""
        near = min(depth, 0.5) * _NEAR
        X = np.unique(np.concatenate([_ALONG, near - 1.0, near + 1.0]))
        i = int(np.clip(self._stress(state, X, depth).argmax(), 1, len(X) - 2))
        width = max(X[i + 1] - X[i], X[i] - X[i - 1])
        value, place = extreme(self._stress(state, X := X[i] + width * _FINER, depth), X, 1.0)
        return float(value), float(place)

    def _stress(self, state: int, X: NDArray, depth: float) -> NDArray[np.float64]:
        """Von Mises stress over N/(2a) at positions over a, (n,), and a depth over a, (n,)."""
        σ = self.inside(state, np.column_stack([X, np.full_like(X, -depth)]))
        solid = self.body.solid.at(depth * self.half_width[state])  # type: ignore[attr-defined]
        σ_XX, σ_YY, σ_XY = σ
        return von_mises(σ_XX, σ_YY, σ_XY, solid.σ_ZZ(σ_XX, σ_YY, σ_XY))


def _take(best: NDArray, value: NDArray, X: NDArray, Y: NDArray) -> None:
    """Put larger values with their places into the best ones so far, (3, states)."""
    best[:] = np.where(value > best[0], np.array([value, X, np.broadcast_to(Y, X.shape)]), best)
