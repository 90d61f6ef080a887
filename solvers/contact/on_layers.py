"""Contacts over layers, by the singular integral equation.

**Frictions.** Any number of frictions at one speed share the kernels, which do not depend on friction. A
pressure without its weight is an analytic function of g = σ_XY/σ_YY: beyond a few frictions the equation
is solved at Chebyshev's points in g, and what is linear in the pressure is interpolated between them.

**Two free ends, any convex profile.** With T the operator of the equation in
:mod:`galinx.solvers.contact.equation`, its adjoint is, but for the sign, that of the same contact seen
from the other side. Let ρ₁ be the pressure of a flat punch there, and ρ₂
that under the slope 1 without a resultant. A pressure σ that vanishes at both ends under the slope f, T σ
= f, then has ∫ ρ f = -∫ (-T* ρ) σ, so that

    ∫ ρ₁ P'(m + h s) ds = 0,        N/μ = h ∫ ρ₂ P'(m + h s) ds.

These conditions on the slope alone (:func:`rule_of_ends`) give both ends, by
:mod:`galinx.solvers.contact.ends`. Both ρ are smooth functions over w = (1 - s)^a (1 + s)^b, whatever the
profile is; without layers ρ₁ is 1/w and ρ₂ is s/w but for factors.

**A tilted punch one edge of which lifts off.** The contact starts at the other edge, and the intensity at
its free end vanishes for one sum of two pressures, that of a flat punch and that under the slope 1.

**Slopes that jump, or whose derivative jumps** (:class:`Kinked`). What a kink does to the pressure is of
the surface's solid alone: with f the slope less the mean by which the pressure σ₀ of
:mod:`galinx.solvers.contact.panels` vanishes at both ends, what layers add is a pressure under that mean
and under the slope -∫ K(r - t) σ₀(t) dt by which σ₀ bends the layers, which no kink makes rough.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, cached_property, lru_cache, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..approximation import barycentric
from ..friction.along import Along, constant
from ..layers.kernel import REACH, Kernel, Level, Scaled
from ..layers.layered import Layered, LayersAtSpeed
from ..profiles import check_reach, cusp, has_free_end, jumps, kinks
from ..profiles.punches import Flat
from .closed_form import FreeEnds
from .contacts import Group, contacts, off_tips, panels_of
from .edges import EdgeExponents
from .ends import Punch, Rule, free_ends, half_width_of_load, logarithm_of_load
from .equation import UNIFORM, Equation, Resolution, SolvedContact, converged
from .panels import Panels
from .pressure import ENDS, Expansion, Pressure

#: Longest panel for a sum of so many polynomials, times their number, and at most.
_PANEL, _LONGEST = 16.0, 0.7


def rule_of_ends(equation: Equation, resolution: Resolution) -> Rule:
    """Quadrature of the conditions on both ends of contacts of one half-width.

    Args:
        equation: of such a contact; its slope is not used.
        resolution: number of polynomials, or longest panel.
    """
    adjoint = replace(equation, adjoint=True)
    ρ = adjoint.pressures(resolution, (np.zeros_like, np.ones_like), (-2.0, 0.0))

    def rule(kinks: tuple[float, ...]) -> tuple[NDArray, NDArray, NDArray]:
        panels = Panels(ρ.α, ρ.β, finest(resolution), kinks)
        lifting, carrying = panels.weights * ρ.series(panels.t)
        return panels.t, -lifting, carrying

    return rule


def vanishing(
    equation: Equation, resolution: Resolution, resultant: float = -2.0
) -> tuple[Expansion, float]:
    """Pressure of a contact between two free ends, at which it vanishes.

    An intensity left by the resolution is removed by a little of a flat punch and of the slope 1.

    Args:
        equation: of the contact, with its slope.
        resolution: number of polynomials, or longest panel.
        resultant: ∫ σ_YY dr.

    Returns:
        The pressure, and the correction: the larger of the change of its resultant over that of a punch,
        and the change of its slope over that by which one end alone would carry such a resultant.
    """
    slopes = (equation.slope, np.zeros_like, np.ones_like)
    parts = equation.pressures(resolution, slopes, (resultant, -2.0, 0.0))
    K = parts.series(ENDS).T
    little = np.linalg.solve(K[:, 1:], -K[:, 0])
    moved = np.abs(little) * np.abs(K[:, 1:]).max(axis=0) / np.abs(K[:, 1]).max()
    return parts.sum(np.append(1.0, little)).ending((True, True)), float(moved.max())


def finest(resolution: Resolution) -> float:
    """Longest panel that resolves a pressure of this resolution."""
    return min(resolution if isinstance(resolution, float) else _PANEL / resolution, _LONGEST)


@dataclass(frozen=True)
class Kinked(Pressure):
    """Pressure between free ends under a slope with kinks.

    Attributes:
        α, β: exponents of edges.
        alone: σ₀, the pressure on the surface's solid alone.
        on_panels: σ₀ over the weight of edges.
        more: the pressure that layers add.
        near, kinks, tips: see :class:`galinx.solvers.contact.pressure.Pressure`.
    """

    α: float
    β: float
    alone: FreeEnds
    on_panels: Expansion
    more: Expansion
    near: float
    kinks: tuple[float, ...]
    tips: tuple[float, ...]

    #: Both ends are free.
    free = np.array([True, True])  # type: ignore[assignment]

    def series(self, r: NDArray) -> NDArray[np.float64]:
        return _without_weight(self.alone, off_tips(r, self.tips)) + self.more.series(r)

    def rest(self, r: NDArray, near: float) -> NDArray[np.float64]:
        values, under = self.more.rest(r, near), np.abs(r) < 1.0
        # cot(πα) = Q/n turns σ₀ under the punch into f/n.
        values[under] += self.alone.slope(r[under]) / self.alone.n
        values[~under] += self.alone.hilbert(r[~under])
        return values

    def integral(self, kernel: Callable[[NDArray], NDArray], r: NDArray) -> NDArray[np.float64]:
        return self.more.integral(kernel, r) + self.on_panels.integral(kernel, r)

    def points(self, finest: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        panels: Panels = self.on_panels.functions
        fine = _on_panels(self.alone, replace(panels, finest=min(finest, panels.finest)))
        (t, σ), (t_alone, σ_alone) = self.more.points(finest), fine.points(np.inf)
        return np.append(t, t_alone), np.append(σ, σ_alone)


def _without_weight(alone: FreeEnds, r: NDArray) -> NDArray[np.float64]:
    """σ₀ over the weight of edges, whose exponents are 1 less, which is 0 from both ends on."""
    return (1.0 - r) * (1.0 + r) * alone.series(r)


def _on_panels(alone: FreeEnds, panels: Panels) -> Expansion:
    """σ₀ over the weight of edges by its values on panels."""
    return Expansion(panels.α, panels.β, _without_weight(alone, panels.t), panels)


def kinked(
    equation: Equation, resolution: Resolution, punch: Punch, m: float, h: float
) -> tuple[Pressure, float]:
    """Pressure of a contact with kinks, and its correction as of :func:`vanishing`.

    Args:
        equation: of the contact, with its slope.
        resolution: number of polynomials, or longest panel.
        punch: the punch.
        m, h: middle and half-width.
    """
    a, profile, places = 1.0 + equation.α, punch.profile, punch.kinks(m, h)
    panels = panels_of(profile, a, places)
    whole = equation.slope(panels.t)
    mean = float(panels.weights @ whole / panels.weights.sum())

    def slope(r: NDArray) -> NDArray[np.float64]:
        return equation.slope(r) - mean

    alone = FreeEnds(
        panels, whole - mean, slope, equation.n, equation.Q, places, cusp=cusp(profile),
    )  # fmt: skip
    carried = -np.sin(np.pi * a) / equation.n * float(panels.weights @ (panels.t * (whole - mean)))
    fine = Panels(equation.α, equation.β, finest(resolution), places, rough=equation.kernel.rough)
    on_panels = _on_panels(alone, fine)

    def of_layers(r: NDArray) -> NDArray[np.float64]:
        return mean - on_panels.integral(equation.K, r)[:, 0]

    more = replace(equation, slope=of_layers, kinks=places)
    tips = places if jumps(profile) else ()
    added, taken = vanishing(more, resolution, -2.0 - carried)
    return Kinked(added.α, added.β, alone, on_panels, added, added.near, places, tips), taken


#: Accuracy of a half-width at rest, over which others are given.
_AT_REST = 1e-5
#: Accuracy with which an edge counts as lifted off.
OF_ENDS = 1e-6
#: Reach of tabulated kernels over that which the largest contact so far needs.
_KERNEL_MARGIN = 1.5
#: Depths whose fields are kept.
_LEVELS = 256
#: Chebyshev's points in g at first and at most; the last coefficients estimate the error; places at which
#: pressures are compared for that.
_FEW, _MANY, _LAST, _COMPARED = 9, 65, 2, np.array([-1.0, -0.6, 0.0, 0.6, 1.0])


@dataclass(frozen=True)
class LayersUnderPunch:
    """Layers at a speed under a punch: kernels, and contacts with any friction, which share these.

    Attributes:
        response: of the surface's solid.
        stack: layers with their substrate, lengths over the punch's unit.
        tolerance: relative.
        punch: the punch, whose unit is the half-width where both its ends are sharp.
        every: solve each friction, however many there are.
        friction: σ_XY/σ_YY over the contact by the number g of a state and the half-width [m].
    """

    response: Any
    stack: LayersAtSpeed
    tolerance: float
    punch: Punch
    every: bool = False
    friction: Callable[[float, float], Along] = lambda g, h: constant(g)

    #: Largest error of stresses at each height over a at which they were evaluated.
    errors: dict[float, float] = field(default_factory=dict)

    @cached_property
    def level(self) -> Callable[[float, float], Level]:
        """Fields at a depth, up to a distance from their load; lengths over the unit."""
        return lru_cache(_LEVELS)(lambda depth, reach: Level(self.stack, depth, reach, self.tolerance))

    @cached_property
    def _kernels(self) -> list[Kernel]:
        return [Kernel(self.stack, self.tolerance / 1e3)]

    @property
    def kernel(self) -> Kernel:
        """The kernel with lengths over the shared unit."""
        return self._kernels[-1]

    def scaled(self, h: float) -> Scaled:
        """The kernel of a contact of the half-width h; a longer table is made where one is needed."""
        if (needed := REACH * h) > self.kernel.reach:
            self._kernels.append(replace(self.kernel, reach=_KERNEL_MARGIN * needed))
        return Scaled(self.kernel, h)

    @property
    def rounding(self) -> float:
        """Relative error of the pressure by that of the kernel."""
        return 2.0 * np.pi * self.kernel.error / abs(self.response.n)

    @property
    def tilted(self) -> bool:
        """True if the punch is flat, and an edge of it may lift off."""
        return has_free_end(self.punch.profile) and isinstance(self.punch.profile, Flat)

    def solved(self, g: NDArray) -> tuple[list[SolvedContact], float | None]:
        """Contacts from which those with all of ``g`` follow, and the error where they are interpolated.

        Args:
            g: σ_XY/σ_YY, sorted, (states,).
        """
        # Kinks move over the contact with friction, and edges lift off at one: nothing is smooth in it.
        rough = self.tilted or (has_free_end(self.punch.profile) and len(kinks(self.punch.profile)))
        if self.every or rough or len(g) <= _FEW:
            return self._each(g), None
        count = _FEW
        middle, half = (g[-1] + g[0]) / 2.0, (g[-1] - g[0]) / 2.0
        while True:
            each = self._each(middle + half * np.cos(np.pi * np.arange(count) / (count - 1)))
            error = _unresolved(each)
            if error <= self.tolerance / 10.0 or count >= _MANY or count >= len(g):
                return each, error
            count = 2 * count - 1

    def _each(self, g: NDArray) -> list[SolvedContact]:
        contacts: list[SolvedContact] = []
        for value in g.tolist():
            contacts.append(self.contact(value, contacts[-1].half_width if contacts else 1.0))
        return contacts

    def contact(self, g: float, h: float = 1.0, checked: bool = True) -> SolvedContact:
        """The contact with a friction.

        Args:
            g: σ_XY/σ_YY.
            h: half-width to begin with.
            checked: the contact may not be wider than what is known of the punch.

        Raises:
            SolveError: no contact carries the load, or it is not resolved.
        """

        def at_resolution(resolution: Resolution) -> SolvedContact:
            nonlocal h
            contact = self._at_resolution(g, h, resolution)
            h = contact.half_width
            return contact

        contact = converged(self._equation(g, 1.0), at_resolution, self.tolerance)
        m, h = contact.centre, contact.half_width
        if checked:
            check_reach(self.punch.profile, self.punch.unit * (m - h), self.punch.unit * (m + h))
        return contact

    def _equation(self, g: float, h: float, slope: Any = np.zeros_like) -> Equation:
        friction = self.friction(g, self.punch.unit * h)
        return Equation(self.response, self.scaled(h), friction, slope)

    def states(self, *attributes: Any) -> Group:
        """States of one pressure with the attributes of :class:`Group` after the response."""
        return OnLayers(self.response, *attributes, self)  # type: ignore[call-arg]

    def _at_resolution(self, g: float, h: float, resolution: Resolution) -> SolvedContact:
        """Contact at a resolution, from the half-width h on."""
        if self.tilted:
            return self._tilted(g, h, resolution)
        if not has_free_end(self.punch.profile):
            return SolvedContact(
                g, self._equation(g, 1.0, self.punch.slope(0.0, 1.0)).pressure(resolution)
            )

        @cache  # on a uniform solid all half-widths share it, unless friction has a length
        def rule(kernel: Any, friction: Along) -> Rule:
            return rule_of_ends(Equation(self.response, kernel, friction, np.zeros_like), resolution)

        def of_half_width(h: float) -> Rule:
            equation = self._equation(g, h)
            return rule(equation.kernel, equation.friction)

        m, h = free_ends(self.punch, of_half_width, h)
        equation = self._equation(g, h, self.punch.slope(m, h))
        places = self.punch.kinks(m, h)
        if places and not equation.friction.varies:
            pressure, taken = kinked(equation, resolution, self.punch, m, h)
        else:
            pressure, taken = vanishing(replace(equation, kinks=places), resolution)
            pressure = pressure.tipped(places if jumps(self.punch.profile) else ())
        return SolvedContact(g, pressure, h, m, taken)

    def _tilted(self, g: float, h: float, resolution: Resolution) -> SolvedContact:
        """Contact of a tilted flat punch, the higher edge of which may have lifted off."""
        punch = self.punch
        whole, rise = punch.profile.half_width / punch.unit, punch.profile.rise
        side = 1 if rise > 0.0 else 0
        each: dict[float, tuple[Expansion, float]] = {}

        def load(h: float) -> float:
            """Logarithm of the load under which the higher end of the contact has no intensity."""
            equation = self._equation(g, h)
            parts = equation.pressures(resolution, (np.zeros_like, np.ones_like), (-2.0, 0.0))
            flat, bent = parts.series(ENDS)[:, side]
            # The slope over N/(2h) that leaves no intensity is (2h/(N/μ)) θ.
            slope = float(-flat / bent)
            each[h] = parts, slope
            carried = 2.0 * h * punch.unit * rise / punch.compression
            return logarithm_of_load(carried / slope) if slope else np.inf

        if load(whole) <= 0.0:
            slope = 2.0 * whole * punch.unit / punch.compression * rise
            return SolvedContact(g, each[whole][0].sum(np.array([1.0, slope])), whole)
        h = half_width_of_load(load, min(h, whole), punch)
        parts, slope = each[h]
        m = float(np.sign(rise)) * (h - whole)
        pressure = parts.sum(np.array([1.0, slope])).ending((side == 0, side == 1))
        return SolvedContact(g, pressure, h, m)


class UniformUnderPunch(LayersUnderPunch):
    """A uniform solid under a punch, for the same equation; it has no stack."""

    kernel = UNIFORM  # type: ignore[assignment]
    rounding = 0.0  # type: ignore[assignment]

    def scaled(self, h: float) -> Any:
        return UNIFORM

    def states(self, *attributes: Any) -> Group:
        return Group(self.response, *attributes)


def under_punch(body: Any, response: Any, tolerance: float, every: bool = False) -> LayersUnderPunch:
    """A half-plane under the punch of a contact, with or without layers; lengths over its half-width."""
    unit = body.half_width
    kind: Any = LayersUnderPunch if body.layered else UniformUnderPunch
    stack = response.stack(unit) if body.layered else None
    punch = Punch(body.profile, unit, body.compression)
    at_speed: LayersUnderPunch = kind(response, stack, tolerance, punch, every, body.friction)
    return at_speed


def half_width_of(body: Any, response: Any, g: float) -> float:
    """Half-width [m] of a contact with the friction of a state, to a millionth."""
    at_speed = under_punch(body, response, OF_ENDS)
    return float(at_speed.punch.unit * at_speed.contact(g, checked=False).half_width)


@lru_cache(maxsize=256)
def half_width_at_rest(solid: Layered, profile: Any, compression: float) -> float:
    """Half-width [m] of a contact at rest without friction, to five digits, over which others are given.

    Args:
        solid: the layers.
        profile: of the punch.
        compression: N/μ [m].

    Raises:
        SolveError: no contact carries the load.
    """
    response = solid.response(0.0)
    # That on the surface's solid alone is near enough to measure lengths by.
    (unit,) = contacts(response, np.zeros(1), profile, compression).of("half_width").tolist()
    punch = Punch(profile, unit, compression)
    layers = LayersUnderPunch(response, response.stack(unit), _AT_REST, punch)
    return unit * layers.contact(0.0, checked=False).half_width


def _unresolved(each: Sequence[SolvedContact]) -> float:
    """Relative error of contacts interpolated in g, from their last Chebyshev coefficients."""
    pressures = np.array([contact.pressure.series(_COMPARED) for contact in each])
    lengths = np.array([[contact.half_width, contact.centre] for contact in each])
    values = np.column_stack([pressures / np.abs(pressures).max(), lengths / lengths[:, 0].max()])
    x = np.cos(np.pi * np.arange(len(each)) / (len(each) - 1))
    c = np.linalg.solve(np.polynomial.chebyshev.chebvander(x, len(x) - 1), values)
    return float(np.abs(c[-_LAST:]).max() / np.abs(values).max())


def weights_between(nodes: NDArray, g: NDArray) -> NDArray[np.float64]:
    """Weights that interpolate values at Chebyshev's points in g to others, (states, nodes)."""
    weights = (-1.0) ** np.arange(len(nodes))
    weights[[0, -1]] /= 2.0
    return barycentric(nodes, weights, g)


@dataclass(frozen=True)
class OnLayers(Group):
    """States over layers whose pressure is of one kind, and their stresses.

    Attributes:
        layers: the layers, with kernels.
    """

    layers: LayersUnderPunch

    def read(self, what: Any, values: "Callable[[OnLayers], NDArray]") -> NDArray[np.float64]:
        """Values that are linear in the pressure, (..., rows, n).

        Args:
            what: a name of the values, by which they are kept.
            values: gives them for states that were solved, (..., rows, n).
        """
        return values(self)

    @property
    def size(self) -> float:
        """Half-width of the contacts over the unit of the layers."""
        return float(self.half_width[0]) / self.layers.punch.unit

    def strain(self, r: NDArray) -> NDArray[np.float64]:
        def values(node: OnLayers) -> NDArray[np.float64]:
            return node.pressure.strain(node.g, self.layers.scaled(node.size), r)

        return self.read(("strain", r.tobytes()), values)

    def inside(self, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points (1, n), at an interface those above it: (3, rows, n)."""
        X, Y = X[0], Y[0]
        σ = np.empty((3, len(self.rows), len(X)))
        for height in np.unique(Y).tolist():
            there = height == Y
            at_height = partial(OnLayers._at_height, X=X[there], height=height)
            σ[..., there] = self.read(("inside", height, X[there].tobytes()), at_height)
        return σ

    def _at_height(self, X: NDArray, height: float) -> NDArray[np.float64]:
        h, errors = self.size, self.layers.errors
        level = self.layers.level(-height * h, h * (1.0 + float(np.abs(X).max())))
        error = h * level.error * max(1.0, level.media[0].modulus)
        errors[height] = max(errors.get(height, 0.0), error)
        return self._along(X, level, 1)[[2, 0, 1]]

    def at_interface(self, X: NDArray, level: Level) -> NDArray[np.float64]:
        """σ_YY, σ_XY, σ_XX above and below an interface at X (n,): (4, rows, n)."""
        name = "interface", level.depth, X.tobytes()
        return self.read(name, lambda node: node._along(X, level, 2))

    def _along(self, X: NDArray, level: Level, sides: int) -> NDArray[np.float64]:
        """σ_YY, σ_XY and σ_XX above a depth, or on both sides: (2 + sides, rows, n)."""
        t, forces = self.pressure.points(level.depth / self.size)
        g, ratios = self.pressure.ratios(self.g, t)
        u_X, σ_YY, σ_XY = level.read(t, forces, g, X, self.size, ratios)
        media = [(medium.modulus, medium.response) for medium in level.media[:sides]]
        return np.array([σ_YY, σ_XY, *(M * solid.σ_XX(u_X, σ_YY / M, σ_XY / M) for M, solid in media)])


class Nodes:
    """Contacts at Chebyshev's points in g, between which values are interpolated.

    Args:
        groups: contacts, one state each.
    """

    def __init__(self, groups: Sequence[OnLayers]) -> None:
        self.groups = groups
        self._read: dict[Any, NDArray] = {}

    def read(self, what: Any, values: Callable[[OnLayers], NDArray]) -> NDArray[np.float64]:
        """Values of all nodes, (..., nodes, n); the last ones are kept."""
        if what not in self._read:
            if len(self._read) >= _KEPT:
                self._read.clear()
            self._read[what] = np.concatenate([values(group) for group in self.groups], axis=-2)
        return self._read[what]


#: Values of all nodes that are kept.
_KEPT = 64


@dataclass(frozen=True)
class Interpolated(Pressure):
    """Pressures of states whose smooth factors are interpolated between those of nodes.

    Attributes:
        nodes: contacts at some frictions.
        weights: of the nodes in each state, (states, nodes).
        α, β: exponents at the right and the left end, (states, 1).
    """

    nodes: Nodes
    weights: NDArray[np.float64]
    α: Any
    β: Any

    @property
    def free(self) -> NDArray[np.bool_]:
        return np.asarray(self.nodes.groups[0].pressure.free)

    @property
    def near(self) -> float:  # type: ignore[override]
        return float(min(node.pressure.near for node in self.nodes.groups))

    def series(self, r: NDArray) -> NDArray[np.float64]:
        p = self.nodes.read(("p", r.tobytes()), lambda node: node.pressure.series(r)[None])
        return np.asarray(self.weights @ p)

    def rest(self, r: NDArray, near: float) -> NDArray[np.float64]:
        rest = self.nodes.read(("rest", r.tobytes()), lambda node: node.pressure.rest(r, near)[None])
        return np.asarray(self.weights @ rest)

    def states(self) -> Iterator[Pressure]:
        rows = zip(self.weights, self.α[:, 0].tolist(), self.β[:, 0].tolist())
        return (replace(self, weights=row, α=α, β=β) for row, α, β in rows)


@dataclass(frozen=True)
class Mixture(OnLayers):
    """States interpolated between nodes."""

    def read(self, what: Any, values: Callable[[OnLayers], NDArray]) -> NDArray[np.float64]:
        return np.asarray(self.pressure.weights @ self.pressure.nodes.read(what, values))


def mixture(nodes: Nodes, edges: EdgeExponents) -> Mixture:
    """States interpolated between nodes.

    Args:
        nodes: contacts at some frictions.
        edges: local analysis of the punch's edges at those of the states, (states,).
    """
    g_nodes, h, m = (
        np.concatenate([getattr(node, name) for node in nodes.groups])
        for name in ("g", "half_width", "centre")
    )
    g, layers = np.asarray(edges.g), nodes.groups[0].layers
    weights = weights_between(g_nodes, g)
    pressure = Interpolated(nodes, weights, edges.α[:, None], edges.β[:, None])
    # Exact where all nodes have one half-width.
    half_width = h[0] + weights @ (h - h[0])
    return Mixture(edges.response, np.arange(len(g)), g, pressure, half_width, weights @ m, layers)
