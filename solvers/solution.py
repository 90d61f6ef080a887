"""Solutions of every method: friction states at one speed; lengths over a, stresses over N/(2a)."""

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from .contact import under_punch
from .layers.in_cells import LayersInCells
from .layers.layered import Layered
from .profiles import Profile, exponent, half_width, has_free_end, jumps
from .sie.prescribed_pressure import LinearPressure
from .solids import Solid
from .solids.solid import Response


@dataclass(frozen=True)
class Places:
    """Places at which stresses are computed, over a.

    Attributes:
        X: positions on the surface, (n,).
        points: positions X, Y inside, (m, 2).
        around: positions X, Y at which stresses are compared with the yield strength, (k, 2).
        interfaces: depths of a layered solid's interfaces, (layers,).
        along: positions X along each of them, (l,).
    """

    X: NDArray[np.float64]
    points: NDArray[np.float64]
    around: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 2)))
    interfaces: NDArray[np.float64] = field(default_factory=lambda: np.empty(0))
    along: NDArray[np.float64] = field(default_factory=lambda: np.empty(0))

    @cached_property
    def under(self) -> NDArray[np.bool_]:
        """True at positions on the surface under the punch, (n,)."""
        return under_punch(self.X)


@dataclass(frozen=True)
class Body:
    """Punch and half-plane in SI; units of results are numbers, or arrays where the load is one.

    Attributes:
        solid: the half-plane.
        profile: the punch.
        load: N per depth [N/m], a number or one for each state, (states,).
        pressure: prescribed pressure; None where the punch determines it.
        yield_strength: of the solid, uniaxial [Pa]; None where it is not known.
    """

    solid: Solid
    profile: Profile
    load: Any
    pressure: LinearPressure | None = None
    yield_strength: float | None = None

    @cached_property
    def found(self) -> bool:
        """True if an end of the contact is free; every state has a half-width of its own then."""
        return has_free_end(self.profile)

    def response(self, c: float) -> Response:
        """Response of the half-plane at a speed over its wave speed.

        Raises:
            ValueError: a wave in it is not faster.
        """
        if isinstance(self.solid, Layered):
            return LayersInCells(self.solid, self.solid.response(c).c, self.half_width)
        return self.solid.response(c)

    def σ_ZZ(self, σ: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """Normal stress out of the plane of σ_XX, σ_YY, σ_XY (3, ..., n) at heights Y over a, (n,)."""
        if not isinstance(self.solid, Layered):
            return self.solid.σ_ZZ(*σ)
        values = np.empty(σ.shape[1:])
        for height in np.unique(Y).tolist():
            at = height == Y
            values[..., at] = self.solid.at(-height * self.half_width).σ_ZZ(*σ[..., at])
        return values

    @property
    def layered(self) -> bool:
        """True if the half-plane has layers."""
        return isinstance(self.solid, Layered)

    @cached_property
    def free(self) -> bool:
        """True if both ends of the contact are free, whatever the load is."""
        return not any(getattr(self.profile, "sharp", (True, True)))

    @cached_property
    def finite(self) -> bool:
        """True if all stresses are finite: both ends are free, and the profile has no tip."""
        return self.free and not jumps(self.profile)

    @cached_property
    def alike(self) -> bool:
        """True if contacts under all loads differ in size alone.

        That is so for a flat punch, a power of |X| on a uniform solid, and a prescribed pressure.
        """
        if self.pressure is not None or self.flat:
            return True
        # Layers have a length: their thickness over the contact's width changes with the load.
        return self.free and bool(exponent(self.profile)) and not self.layered

    def loaded(self, load: Any = None) -> "Body":
        """Punch and half-plane under another load [N/m], a number or (states,); unchanged for None."""
        return self if load is None else replace(self, load=load)

    def growth(self, load: Any) -> Any:
        """Half-widths at other loads over that at this load, of contacts that differ in size alone."""
        k = exponent(self.profile) if self.free else None
        return (load / self.load) ** (1.0 / k) if k else np.ones_like(load)

    @cached_property
    def half_width(self) -> Any:
        """Half-width a [m]; with free ends that of the contact at rest without friction."""
        if not self.found:
            return half_width(self.profile)
        if np.ndim(self.load) and self.alike:
            first = self.loaded(float(self.load[0]))
            return first.half_width * first.growth(self.load)
        if isinstance(self.solid, Layered):
            each = [self._at_rest(load) for load in np.ravel(self.load).tolist()]
            return np.array(each) if np.ndim(self.load) else each[0]
        from .sie.free_contact import contacts

        g = np.zeros(np.size(self.load))
        rest = contacts(self.solid.response(0.0), g, self.profile, self.compression).of("half_width")
        return rest if np.ndim(self.load) else float(rest[0])

    def _at_rest(self, load: float) -> float:
        """Half-width over layers under a load [m]."""
        from .layers.free_contact import half_width_at_rest

        profile: Any = self.profile
        assert isinstance(self.solid, Layered)
        return half_width_at_rest(self.solid, profile, load / self.solid.μ)

    @property
    def compression(self) -> Any:
        """N/μ [m]."""
        return self.load / self.solid.μ

    def height(self, X: NDArray) -> NDArray[np.float64]:
        """The profile's height over N/(2μ) at X over a."""
        return self.profile.height(self.half_width * X) / self.displacement

    def slope(self, X: NDArray) -> NDArray[np.float64]:
        """Slope μ v,X under the punch over N/(2a), at X over a."""
        a = self.half_width
        return self.profile.slope(a * X) * a / self.displacement

    @cached_property
    def flat(self) -> bool:
        """True if the punch is flat and not tilted: its slope vanishes at 101 positions."""
        if self.found:
            return False
        return not np.any(self.profile.slope(self.half_width * np.linspace(-1.0, 1.0, 101)))

    @property
    def force(self) -> Any:
        """Unit of nodal forces [N/m]: stresses over N/(2a), lengths over a."""
        return self.load / 2.0

    @property
    def displacement(self) -> Any:
        """Unit of displacements [m]."""
        return self.load / (2.0 * self.solid.μ)

    @property
    def strain(self) -> Any:
        """Unit of strains, dimensionless."""
        return self.stress / self.solid.μ

    @property
    def stress(self) -> Any:
        """Unit of stresses [Pa]; with free ends each state has its own instead."""
        return self.load / (2.0 * self.half_width)


@dataclass(frozen=True)
class Turns:
    """Limits of the stresses on the surface at free ends of a contact and at kinks of the punch.

    Near these places stresses go with a power of the distance, and samples miss the largest one.

    Attributes:
        X: the places over a, (states, k).
        σ: σ_XX, σ_YY, σ_XY there, (3, states, k).
        between: the in-plane stress between them, where samples of the surface are not near enough to
            them; None where they are.
    """

    X: NDArray[np.float64]
    σ: NDArray[np.float64]
    between: "Between | None" = None

    def of(self, rows: NDArray) -> "Turns":
        """Turns of some of the states, or of each several times."""
        between = self.between and Between(
            self.between.X, self.between.x, self.between.σ_XX[rows]
        )  # fmt: skip
        return Turns(self.X[rows], self.σ[:, rows], between)

    def joined(self, other: "Turns") -> "Turns":
        """Turns joined with others of the same states."""
        σ = np.concatenate([self.σ, other.σ], axis=2)
        return Turns(np.concatenate([self.X, other.X], axis=1), σ, self.between or other.between)


@dataclass(frozen=True)
class Between:
    """In-plane stress between neighbouring kinks, towards both of which it has a distance's logarithm.

    Attributes:
        X: positions over a, in intervals between kinks, (intervals, n).
        x: logarithm of the ratio of their distances from both kinks, in which stresses are smooth, (n,).
        σ_XX: there, (states, intervals, n).
    """

    X: NDArray[np.float64]
    x: NDArray[np.float64]
    σ_XX: NDArray[np.float64]


def together(each: list[Turns]) -> Turns | None:
    """Turns of one state each as those of all, as many places as the state with most; None of none."""
    if not each:
        return None
    most = max(one.X.shape[1] for one in each)
    X, σ = np.full((len(each), most), np.nan), np.full((3, len(each), most), np.nan)
    for i, one in enumerate(each):
        X[i, : one.X.shape[1]], σ[:, i, : one.X.shape[1]] = one.X[0], one.σ[:, 0]
    return Turns(X, σ)


@dataclass(frozen=True)
class Surface:
    """Stresses on the surface Y = 0.

    Attributes:
        places: positions.
        σ_YY: contact stress, NaN beside the punch, (states, n).
        σ_XX: in-plane stress, (states, n).
        raw: contact stress without an assumed exponent; finite elements alone have it.
        v_X: slopes μ v,X; finite elements alone have them.
        turns: limits of the stresses; None where they are infinite at both ends, and nowhere cusped.
    """

    places: Places
    σ_YY: NDArray[np.float64]
    σ_XX: NDArray[np.float64]
    raw: NDArray[np.float64] | None = None
    v_X: NDArray[np.float64] | None = None
    turns: Turns | None = None


class Solution(Protocol):
    """Friction states at one speed, from any method; an attribute is computed when it is first used.

    Attributes:
        g: σ_XY/σ_YY under the punch, (states,).
        local: the local analysis of the punch's edges: exponents α at X = a and β at X = -a, (states,).
        surface: stresses on the surface.
        inside: σ_XX, σ_YY, σ_XY at points inside, (3, states, m).
    """

    @property
    def g(self) -> NDArray[np.float64]: ...
    @property
    def local(self) -> Any: ...
    @property
    def surface(self) -> Surface: ...
    @property
    def inside(self) -> NDArray[np.float64]: ...
