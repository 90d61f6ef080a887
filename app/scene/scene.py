"""What a scene says, section by section; numbers are in SI."""

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, product
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.scene.values import Spread
from galinx.postprocess.quantities.quantity import FINITE, FOUND, OWN_PRESSURE, PUNCH
from galinx.solvers.friction import FrictionLaw
from galinx.solvers.friction.motion import Leg, Partial, legs, legs_of_path
from galinx.solvers.friction.slider import Slider
from galinx.solvers.friction.strokes import positions
from galinx.solvers.layers.layered import Layer, Layered
from galinx.solvers.parameters import made, parameters
from galinx.solvers.profiles import Profile
from galinx.solvers.solids import Solid
from galinx.solvers.solution import Body


@dataclass(frozen=True)
class HalfPlane:
    """[solid]: an elastic solid, and what else is known of it.

    Attributes:
        solid: the solid.
        material: name in the library, None where the scene gives all constants itself.
        yield_strength: uniaxial [Pa], None where it is not given.
    """

    solid: Solid
    material: str | None
    yield_strength: float | None


@dataclass(frozen=True)
class Punch:
    """[punch]: a profile, pressed on by each of ``loads`` [N/m]."""

    profile: Profile
    loads: tuple[float, ...]

    @property
    def load(self) -> float:
        """The load [N/m], the first where there are several."""
        return self.loads[0]


#: The most laws that tables of a friction section may list: each is held by itself.
_MOST_LISTED = 100_000


@dataclass(frozen=True)
class Friction:
    """[friction]: laws, how they are integrated over strokes of ``pre_sliding`` [m], the sign of σ_XY.

    Attributes:
        law: the class of the laws.
        parameters: values of each of its parameters by key; their product is computed.
        vary: [[friction.vary]], values of some of these parameters in place of those above; the laws
            are then the products of all tables, each law once.

    Raises:
        ValueError: there are too many laws in ``vary``.
    """

    law: type[FrictionLaw]
    parameters: dict[str, tuple[Any, ...]]
    pre_sliding: float
    integrator: str
    sign: str
    vary: tuple[dict[str, tuple[Any, ...]], ...] = ()

    def __post_init__(self) -> None:
        count = sum(prod(map(len, one.values())) for one in self._products)
        if self.vary and count > _MOST_LISTED:
            raise ValueError(f"vary: found {count} laws, expected at most {_MOST_LISTED} in all tables")

    @property
    def _products(self) -> list[dict[str, tuple[Any, ...]]]:
        """Values of each parameter by key, for every product that is computed."""
        return [self.parameters | one for one in self.vary] or [self.parameters]

    @cached_property
    def _listed(self) -> list[tuple[Any, ...]]:
        """Parameters of every law of the tables, each law once."""
        every = (product(*one.values()) for one in self._products)
        return list(dict.fromkeys(chain.from_iterable(every)))

    @property
    def values(self) -> dict[str, tuple[Any, ...]]:
        """All values that a parameter takes, by key."""
        return {
            key: tuple(dict.fromkeys(chain.from_iterable(one[key] for one in self._products)))
            for key in self.parameters
        }

    @property
    def count(self) -> int:
        """Number of laws."""
        return len(self._listed) if self.vary else prod(map(len, self.parameters.values()))

    def laws(self) -> Iterator[FrictionLaw]:
        """Every law by itself; the last parameter changes fastest.

        Raises:
            ValueError: a law refuses its parameters.
        """
        for values in self._listed if self.vary else product(*self.parameters.values()):
            yield made(self.law, dict(zip(self.parameters, values)))

    def columns(self) -> dict[str, NDArray]:
        """Parameters of every law by key, each (count,), without tables, which all laws share."""
        single = [key for key, known in parameters(self.law).items() if known.single]
        if self.vary:
            columns = dict(zip(self.parameters, zip(*self._listed)))
            return {key: np.array(columns[key]) for key in self.parameters if key in single}
        inner, columns_ = self.count, {}
        for key, values in self.parameters.items():
            inner //= len(values)
            if key in single:
                columns_[key] = np.tile(np.repeat(values, inner), self.count // (inner * len(values)))
        return columns_

    def together(self, columns: dict[str, NDArray], some: slice) -> FrictionLaw:
        """Some laws as one that stands for all of them.

        Args:
            columns: of this.
            some: which.

        Raises:
            ValueError: a law refuses its parameters.
        """
        return made(self.law, {key: values[some, None] for key, values in columns.items()})

    @property
    def stress_ratio(self) -> float:
        """σ_XY/σ_YY under the punch over f."""
        return -1.0 if self.sign == "physical" else 1.0


@dataclass(frozen=True)
class Motion:
    """[motion]: ``c`` over the wave speed or ``speed`` [m/s], the other None; strokes and positions.

    Attributes:
        strokes: by name or partial.
        X_over_L: positions on them.
        rest: time at rest between strokes [s].
        path: time [s] and position [m], point by point, instead of all of these; None for none.
    """

    c: tuple[float, ...] | None
    speed: tuple[float, ...] | None
    strokes: tuple[str | Partial, ...]
    X_over_L: tuple[float, ...]
    rest: float = 0.0
    path: tuple[tuple[float, float], ...] | None = None


@dataclass(frozen=True)
class Solve:
    """[solve]: methods and what they are given, see the keys."""

    methods: tuple[str, ...]
    tolerance: float
    mesh: str
    mode: str
    degree: int | None
    cuts: int
    sweep: str
    solver: str
    assembler: str
    pressure: Any

    @property
    def own_pressure(self) -> bool:
        """Is a pressure of the user's own put in?"""
        return self.mode == "traction" and self.pressure != "closed_form"

    @property
    def modes(self) -> tuple[str, ...]:
        """Words by which quantities and rules say that they are of this mode."""
        return ("", self.mode, OWN_PRESSURE) if self.own_pressure else ("", PUNCH, self.mode)


@dataclass(frozen=True)
class Output:
    """[output]: words for quantities, and where stresses inside are wanted, over a."""

    quantities: tuple[str, ...]
    points: tuple[tuple[float, float], ...] = ()
    map: tuple[Spread, Spread] | None = None

    @property
    def inside(self) -> NDArray[np.float64]:
        """All points inside, (n, 2): first the map's, by rows of Y, then the single ones."""
        single = np.reshape(np.array(self.points, dtype=float), (-1, 2))
        if self.map is None:
            return single
        X, Y = np.meshgrid(*(np.linspace(axis.first, axis.last, axis.count) for axis in self.map))
        return np.concatenate([np.column_stack([X.ravel(), Y.ravel()]), single])


@dataclass(frozen=True)
class Time:
    """[time]: what happens over time; times over a/c_s.

    Attributes:
        end: last time.
        step: of the finite elements, None where the tolerance sets it.
        load_ramp: time within which the load comes on.
        load: times and shares of N instead of that, from t = 0 on, or none.
        steady: does it begin in steady motion, not at rest?
        by_law: does friction change by its law along the strokes, or stay that of a state?
        every: time between those at which stresses along the surface are told, None for none.
    """

    end: float
    step: float | None
    load_ramp: float
    load: tuple[tuple[float, float], ...] = ()
    steady: bool = False
    by_law: bool = False
    every: float | None = None


@dataclass(frozen=True)
class Scene:
    """A checked scene; numbers are in SI.

    Attributes:
        title: free text.
        text: the TOML it came from, byte for byte as archived.
        half_plane, punch, friction, motion, solve, output: its sections.
        slider: a mass on a spring, None for none.
        layers: on the solid, from the top down.
        time: what happens over time, None for none.
    """

    title: str
    text: str
    half_plane: HalfPlane
    punch: Punch
    friction: Friction
    motion: Motion
    solve: Solve
    output: Output
    slider: Slider | None = None
    layers: tuple[Layer, ...] = ()
    time: Time | None = None

    @cached_property
    def solid(self) -> Solid:
        """The elastic solid, with its layers."""
        below = self.half_plane.solid
        return Layered(self.layers, below) if self.layers else below

    @cached_property
    def legs(self) -> tuple[Leg, ...]:
        """Strokes of the motion.

        Raises:
            ValueError: the motion has a fault.
        """
        if self.motion.path is not None:
            return legs_of_path(self.motion.path, self.friction.pre_sliding)
        return legs(self.motion.strokes, self.motion.rest)

    @cached_property
    def places(self) -> tuple[NDArray[np.float64], ...]:
        """Positions over L of the states on each stroke, in the order of travel."""
        if self.motion.path is not None:
            return tuple(np.array([leg.end]) for leg in self.legs)
        return tuple(positions(leg, self.motion.X_over_L) for leg in self.legs)

    @cached_property
    def body(self) -> Body:
        """What slides over what, under the first load; a pressure of the user's own is not among it."""
        return Body(self.solid, self.punch.profile, self.punch.load, None, self.half_plane.yield_strength)

    @property
    def modes(self) -> tuple[str, ...]:
        """Words by which quantities and rules say that they are of this mode."""
        own = self.solve.own_pressure
        return (*self.solve.modes, *(FOUND,) * self.body.found, *(FINITE,) * (own or self.body.finite))

    @property
    def sha256(self) -> str:
        """Hash of the scene's text."""
        return hashlib.sha256(self.text.encode()).hexdigest()
