"""Sections of a scene: every key with its type, unit, limits, default and meaning."""

from collections.abc import Callable
from typing import Any

import attrs
import numpy as np
from attrs import validators as is_

from galinx.app.scene.materials import LIBRARY
from galinx.app.scene.values import Map, Names, Number, Numbers, Points, Pressure, Range, Text, Whole

METHODS = ("closed_form", "fem")
QUANTITIES = ("friction", "sif", "surface", "interior")


def _each(*checks: Any) -> Any:
    return is_.and_(is_.min_len(1), is_.deep_iterable(is_.and_(*checks)))


def _key(convert: Callable, check: Any, doc: str, default: Any = attrs.NOTHING) -> Any:
    return attrs.field(default=default, validator=check, metadata={"doc": doc, "convert": convert})


_positive = is_.gt(0.0)


@attrs.frozen
class Solid:
    """[solid]"""

    E: float = _key(Number("Pa"), _positive, "Young's modulus")
    nu: float = _key(Number(), is_.and_(is_.gt(-1.0), is_.le(0.5)), "Poisson's ratio")
    rho: float = _key(Number("kg/m^3"), _positive, "density")
    plane: str = _key(Text(), is_.in_(("strain", "stress")), "plane strain or stress", "strain")
    material: str | None = _key(
        Text(), is_.optional(is_.in_(tuple(LIBRARY))), "name of a known solid, gives E, nu and rho", None
    )


@attrs.frozen
class Punch:
    """[punch]"""

    half_width: float = _key(Number("m"), _positive, "half-width a", 1e-3)
    load: float = _key(Number("N/m"), _positive, "normal load N per depth", 55.3e3)


@attrs.frozen
class Friction:
    """[friction]"""

    mu_c: tuple[float, ...] = _key(Numbers(), _each(_positive), "Coulomb's coefficient μ_C")
    sigma0_over_load: tuple[float, ...] = _key(Numbers("1/m"), _each(_positive), "σ₀ l/N")
    model: str = _key(Text(), is_.in_(("dahl",)), "friction law", "dahl")
    delta: tuple[float, ...] = _key(Numbers(), _each(_positive), "Dahl's exponent", (1.0,))
    pre_sliding: float = _key(Number("m"), _positive, "pre-sliding displacement L", 1e-4)
    integrator: str = _key(Text(), is_.in_(("exact", "rk4")), "integrator", "exact")
    sign: str = _key(Text(), is_.in_(("physical", "eq25")), "sign of σ_XY", "physical")


@attrs.frozen
class Motion:
    """[motion]"""

    c: tuple[float, ...] | None = _key(
        Numbers(), is_.optional(_each(is_.ge(0.0), is_.lt(1.0))), "speed over c_s", None
    )
    speed: tuple[float, ...] | None = _key(
        Numbers("m/s"), is_.optional(_each(is_.ge(0.0))), "speed V", None
    )
    strokes: tuple[str, ...] = _key(
        Names(),
        _each(is_.in_(("forward", "backward"))),
        "directions in order of time",
        ("forward", "backward", "forward"),
    )
    X_over_L: tuple[float, ...] = _key(
        Numbers(), _each(is_.ge(0.0), is_.le(1.0)), "positions on the stroke", (0.2, 0.8)
    )


@attrs.frozen
class Solve:
    """[solve]"""

    methods: tuple[str, ...] = _key(
        Names(), is_.deep_iterable(is_.in_(METHODS)), "what solves the contact", METHODS
    )
    tolerance: float = _key(
        Number(),
        is_.and_(is_.ge(1e-10), is_.le(0.1)),
        "wanted relative accuracy of K_I and pressure moments",
        1e-6,
    )
    mesh: str = _key(Text(), is_.in_(("confocal", "graded", "box", "uniform")), "mesh", "confocal")
    mode: str = _key(Text(), is_.in_(("contact", "traction")), "pressure unknown or put in", "contact")
    degree: int | None = _key(
        Whole(),
        is_.optional(is_.and_(is_.ge(1), is_.le(12))),
        "polynomial degree, if not found by tolerance",
        None,
    )
    cuts: int = _key(Whole(), is_.and_(is_.ge(1), is_.le(256)), "cuts of every cell's sides", 1)
    solver: str = _key(
        Text(), is_.in_(("auto", "direct", "boomeramg", "gamg")), "solver of linear systems", "auto"
    )
    pressure: Any = _key(Pressure(), None, "σ_YY of the traction mode", "closed_form")


@attrs.frozen
class Output:
    """[output]"""

    quantities: tuple[str, ...] = _key(
        Names(), _each(is_.in_(QUANTITIES)), "what is asked for", QUANTITIES[:3]
    )
    points: tuple[tuple[float, float], ...] = _key(Points(), None, "points inside, [X/a, Y/a]", ())
    map: tuple[Range, Range] | None = _key(Map(), None, "points inside on a grid, over a", None)

    @property
    def inside(self) -> tuple[tuple[float, float], ...]:
        """All points inside: first the map's, by rows of Y, then the single ones."""
        if self.map is None:
            return self.points
        X, Y = (np.linspace(axis.first, axis.last, axis.count) for axis in self.map)
        return (*((x, y) for y in Y.tolist() for x in X.tolist()), *self.points)


#: Sections of a scene, by name.
SECTIONS: dict[str, type] = {
    "solid": Solid,
    "punch": Punch,
    "friction": Friction,
    "motion": Motion,
    "solve": Solve,
    "output": Output,
}
