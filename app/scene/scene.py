"""What a scene says, section by section; numbers are in SI."""

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.scene.values import Spread
from galinx.postprocess.quantities.quantity import FINITE, FOUND, OWN_PRESSURE, PUNCH
from galinx.solvers.friction import FrictionLaw
from galinx.solvers.parameters import made
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
    """[punch]: a profile, pressed on by ``load`` [N/m]."""

    profile: Profile
    load: float


@dataclass(frozen=True)
class Friction:
    """[friction]: laws, how they are integrated over strokes of ``pre_sliding`` [m], the sign of σ_XY.

    Attributes:
        law: the class of the laws.
        parameters: values of each of its parameters by key; their product is computed.
    """

    law: type[FrictionLaw]
    parameters: dict[str, tuple[Any, ...]]
    pre_sliding: float
    integrator: str
    sign: str

    @property
    def count(self) -> int:
        """Number of laws."""
        return prod(map(len, self.parameters.values()))

    def laws(self) -> Iterator[FrictionLaw]:
        """Every law; the last parameter changes fastest.

        Raises:
            ValueError: a law refuses its parameters.
        """
        for values in product(*self.parameters.values()):
            yield made(self.law, dict(zip(self.parameters, values)))

    def columns(self) -> dict[str, NDArray]:
        """Parameters of every law by key, each (count,)."""
        inner, found = self.count, {}
        for key, values in self.parameters.items():
            inner //= len(values)
            found[key] = np.tile(np.repeat(values, inner), self.count // (inner * len(values)))
        return found

    @property
    def stress_ratio(self) -> float:
        """σ_XY/σ_YY under the punch over f."""
        return -1.0 if self.sign == "physical" else 1.0


@dataclass(frozen=True)
class Motion:
    """[motion]: ``c`` over the wave speed or ``speed`` [m/s], the other None; strokes and positions."""

    c: tuple[float, ...] | None
    speed: tuple[float, ...] | None
    strokes: tuple[str, ...]
    X_over_L: tuple[float, ...]


@dataclass(frozen=True)
class Solve:
    """[solve]: methods and what they are given, see the keys."""

    methods: tuple[str, ...]
    tolerance: float
    mesh: str
    mode: str
    degree: int | None
    cuts: int
    solver: str
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
class Scene:
    """A checked scene; numbers are in SI.

    Attributes:
        title: free text.
        text: the TOML it came from, byte for byte as archived.
        half_plane, punch, friction, motion, solve, output: its sections.
    """

    title: str
    text: str
    half_plane: HalfPlane
    punch: Punch
    friction: Friction
    motion: Motion
    solve: Solve
    output: Output

    @property
    def solid(self) -> Solid:
        """The elastic solid."""
        return self.half_plane.solid

    @cached_property
    def body(self) -> Body:
        """What slides over what; a pressure of the user's own is not among it."""
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
