"""Sections of a scene: every key with its kind, default and meaning, and what a section becomes.

A section is a dataclass whose fields are its keys, made by :func:`key`; the parameters of a registered
model stand among the keys of its section. A :class:`Section` checks a table of TOML and builds that
dataclass, and :class:`LayerSections` reads the tables [[layer]]. The same keys make the JSON schema of
scenes, by which editors complete and check TOML.
"""

import dataclasses
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain, pairwise, product
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.meshes import MESHES
from galinx.postprocess.quantities import WORDS
from galinx.postprocess.quantities.swept import MOST_LAYERS
from galinx.registry import Registry
from galinx.solvers.contact import BELOW
from galinx.solvers.contact.fem_plan import ASSEMBLERS
from galinx.solvers.friction import LAWS, FrictionLaw, check_law
from galinx.solvers.friction.along import tabulated
from galinx.solvers.friction.integrate import INTEGRATORS
from galinx.solvers.friction.motion import Partial
from galinx.solvers.friction.slider import Slider
from galinx.solvers.layers.layered import GRADINGS, Layer
from galinx.solvers.parameters import Parameter, Range, build_model, fields, parameters
from galinx.solvers.profiles import PROFILES, Profile, check_profile, has_free_end
from galinx.solvers.solids import SOLIDS, Isotropic, Solid

from ..console import program
from ..errors import excerpt, meant, nearest, short
from ..methods import METHODS, MODES, OWN_METHODS
from .library import LIBRARY
from .values import (
    ALONG,
    DEPTHS,
    POINTS,
    PRESSURE,
    STROKES,
    Choice,
    Constants,
    Kind,
    List,
    Map,
    Number,
    Numbers,
    Or,
    Rows,
    Variations,
    Whole,
    kind_of,
)

#: Stands for a default where a key has to be given.
REQUIRED: Any = dataclasses.MISSING
_METADATA = "galinx key"


@dataclass(frozen=True)
class Key:
    """A key of a section.

    Attributes:
        kind: kind of the value, which checks it.
        about: meaning of the key.
        default: value where the key is absent; a text is one of TOML.
        note: addition to ``about`` in the documentation.
        name: of the key in TOML where the field of the dataclass has another.
        without: text of the documentation in place of a default of None.
        stands_for: a model's parameter that follows from this key; models without it do not have the key.
        parameter: values of that parameter, from the key's.
        model: the model of a section that has this key and names none.
        beside: the only keys that may stand beside this one; None for any.
    """

    kind: Kind
    about: str
    default: Any = REQUIRED
    note: str = ""
    name: str = ""
    without: str = "none"
    stands_for: str = ""
    parameter: Callable[[Any], list[float]] = list
    model: str = ""
    beside: tuple[str, ...] | None = None


def key(
    kind: Kind, about: str, default: Any = REQUIRED, note: str = "", compare: bool = True, **options: Any
) -> Any:
    """Field of a section's dataclass that is a key, see :class:`Key`.

    Sections that differ in it alone are equal unless it is to ``compare``: it is another name.
    """
    entry = Key(kind, about, default, note, **options)
    return dataclasses.field(default=default, compare=compare, metadata={_METADATA: entry})


_POSITIVE, _NOT_NEGATIVE = Range(above=0.0), Range(at_least=0.0)


@dataclass(frozen=True, kw_only=True)
class GivenSolid:
    """[solid], and keys of other solids: an elastic solid, its material, and its yield strength [Pa]."""

    solid: Solid
    material: str | None = key(
        Choice(LIBRARY),
        "name of a solid of the library, gives kind, constants and, of metals, yield_strength", None,
        "what is written beside it replaces the material's",
    )  # fmt: skip
    yield_strength: float | None = key(
        Number("Pa", _POSITIVE), "uniaxial yield strength", None,
        'for the quantity `"yield"`; stresses alone need none',
    )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class ElasticPunch(GivenSolid):
    """[punch.solid]: the solid of an elastic punch, and its speed over the contact [m/s].

    Raises:
        ValueError: the speed is not below that of the wave along the solid's surface.
    """

    speed: float = key(
        Number("m/s", _NOT_NEGATIVE), "speed of the punch's solid over the contact", 0.0,
        "at rest in the frame of the contact it slides; with a speed of its own it rolls",
    )  # fmt: skip

    def __post_init__(self) -> None:
        limit = self.solid.limit() * self.solid.c_s
        if self.speed >= limit:
            raise ValueError(
                f"found speed = {self.speed:g} m/s, expected less than {limit:.6g} m/s, that of the wave "
                "along the surface of this solid"
            )


@dataclass(frozen=True, kw_only=True)
class LayerTable(GivenSolid):
    """[[layer]]: a layer, whose constants at its lower face, ``to``, are still as TOML gives them.

    Raises:
        ValueError: a key is missing, or stands without the one that it belongs to.
    """

    thickness: float | None = key(
        Number("m", _POSITIVE), "thickness", None, without="the last depth of `properties`"
    )
    to: dict[str, Any] | None = key(
        Constants(), "constants at the lower face", None,
        "the layer is graded; those at its upper face stand beside it", without="as at the upper face",
    )  # fmt: skip
    grading: str = key(
        Choice(GRADINGS), "how constants change with depth", "linear",
        '`"exponential"`: their logarithms are linear; `"power"`: (depth/thickness)^exponent',
    )  # fmt: skip
    exponent: float = key(Number("", Range(at_least=1.0, at_most=10.0)), 'of `grading = "power"`', 1.0)
    properties: Any = key(
        DEPTHS, "constants by depth, `[[depth, E, nu, rho], …]`", None,
        "from the upper face, depth 0, downwards, instead of `thickness`, constants and `to`; isotropic, "
        "linear between the rows",
    )  # fmt: skip

    def __post_init__(self) -> None:
        if self.thickness is None:
            raise ValueError('missing thickness, as in thickness = "2 µm"')
        if self.to is None and (self.grading != "linear" or self.exponent != 1.0):
            raise ValueError("grading and exponent need to = {…}, the constants at the lower face")
        if self.grading != "power" and self.exponent != 1.0:
            raise ValueError(
                f'found exponent with grading = "{self.grading}", expected grading = "power"'
            )


@dataclass(frozen=True, kw_only=True)
class Punch:
    """[punch]: a profile, pressed on by each of ``loads`` [N/m].

    Raises:
        ValueError: there is no load, and the contact is as wide as the load makes it; or the profile's
            functions give no numbers.
    """

    profile: Profile
    loads: tuple[float, ...] = key(
        Numbers("N/m", _POSITIVE), "normal force N per depth", None,
        "dimensionless results do not depend on it where the contact is that of a flat punch",
        name="load", without="needed; of a flat punch the study's 55.3 N/mm",
    )  # fmt: skip

    def __post_init__(self) -> None:
        check_profile(self.profile)
        if not self.loads and has_free_end(self.profile):
            raise ValueError('missing load, as in load = "100 N/mm": it sets the width of the contact')
        object.__setattr__(self, "loads", tuple(dict.fromkeys(self.loads or (55.3e3,))))

    @property
    def load(self) -> float:
        """The load [N/m], the first where there are several."""
        return self.loads[0]


#: Most laws that the tables of a friction section may list: each is held by itself.
_MOST_LISTED = 100_000

#: State of bristles: the same all along the contact, or advected with the surface from the leading end.
STATES_ALONG = UNIFORM_STATE, ADVECTED = "uniform", "advected"


@dataclass(frozen=True, kw_only=True)
class Friction:
    """[friction]: laws, how they are integrated over strokes of ``pre_sliding`` [m], the sign of σ_XY.

    Attributes:
        law: the class of the laws.
        parameters: values of each of its parameters by key; their product is computed.
        vary: [[friction.vary]], values of some of these parameters in place of those above; the laws
            are then the products of all tables, each law once.

    Raises:
        ValueError: there are too many laws in ``vary``, or functions of the law give no numbers.
    """

    law: type[FrictionLaw]
    parameters: dict[str, tuple[Any, ...]]
    vary: tuple[dict[str, tuple[Any, ...]], ...] = ()
    mu: tuple[float, ...] | None = key(
        Numbers("", _NOT_NEGATIVE), "coefficient of friction", None,
        "another name of `mu_c`; without `model` it is Coulomb's law, and 0 is no friction",
        stands_for="mu_c", model="coulomb", compare=False,
    )  # fmt: skip
    sigma0: tuple[float, ...] | None = key(
        Numbers("N/m^2", _POSITIVE), "stiffness σ₀ per depth, instead of σ₀ l/N", None,
        "divided by punch.load it is `sigma0_over_load`. The study's σ₀ = 1.5922 N/µm and N = 55.3 N, "
        'both read per mm of depth, are `"1.5922 N/µm/mm"` and `"55.3 N/mm"`: 28 792 1/m for any depth',
        stands_for="sigma0_over_load", compare=False,
    )  # fmt: skip
    along: tuple[tuple[float, float], ...] | None = key(
        ALONG, "f along the contact, pairs [X/a, f]", None,
        "linear between the pairs, from X/a = -1 to 1, instead of a law; see "
        "[Friction along the contact](howto_friction.md#friction-along-the-contact)",
        stands_for="mu_c", model="coulomb", beside=("pre_sliding", "sign"),
        parameter=lambda rows: [tabulated(rows, 1.0).mean],
    )  # fmt: skip
    state: str = key(
        Choice(STATES_ALONG), "state of the law along the contact", UNIFORM_STATE,
        '`"uniform"`: that of the stroke all along; `"advected"`: in steady sliding, from rest at the '
        "leading end on, f of the law over the distance from there",
    )  # fmt: skip
    pre_sliding: float = key(
        Number("m", _POSITIVE), "pre-sliding displacement L", 1e-4, "the length of a stroke"
    )
    integrator: str = key(
        Choice(INTEGRATORS), "integrator", "exact",
        '`"exact"`: to the last digits; `"rk4"`: Runge-Kutta with 20 steps a stroke, refused unless '
        "surely stable",
    )  # fmt: skip
    sign: str = key(
        Choice(("physical", "eq25")), "sign of σ_XY", "physical",
        '`"physical"`: σ_XY = -f σ_YY; `"eq25"`: σ_XY = f σ_YY, the mirror image',
    )  # fmt: skip

    def __post_init__(self) -> None:
        count = sum(prod(map(len, lists.values())) for lists in self._products)
        if self.vary and count > _MOST_LISTED:
            raise ValueError(f"vary: found {count} laws, expected at most {_MOST_LISTED} in all tables")
        check_law(next(self.laws()))

    @property
    def _products(self) -> list[dict[str, tuple[Any, ...]]]:
        """Values of each parameter by key, for every product that is computed."""
        return [self.parameters | table for table in self.vary] or [self.parameters]

    @property
    def values(self) -> dict[str, tuple[Any, ...]]:
        """All values that a parameter takes, by key."""
        return {
            key: tuple(dict.fromkeys(chain.from_iterable(lists[key] for lists in self._products)))
            for key in self.parameters
        }

    @property
    def count(self) -> int:
        """Number of laws."""
        return len([*self._every]) if self.vary else prod(map(len, self.parameters.values()))

    @property
    def _every(self) -> Iterable[tuple[Any, ...]]:
        """Parameters of every law, each law once; the last changes fastest."""
        every = (product(*lists.values()) for lists in self._products)
        return dict.fromkeys(chain.from_iterable(every)) if self.vary else next(every)

    def laws(self) -> Iterator[FrictionLaw]:
        """Every law by itself, in the order of :meth:`columns`.

        Raises:
            ValueError: a law refuses its parameters.
        """
        for values in self._every:
            yield build_model(self.law, dict(zip(self.parameters, values)))

    def columns(self) -> dict[str, NDArray]:
        """Parameters of every law by key, each (count,), but those that are tables, the same for all."""
        of_law = parameters(self.law)
        columns = zip(self.parameters, zip(*self._every))
        return {key: np.array(values) for key, values in columns if of_law[key].single}

    def together(self, columns: dict[str, NDArray], rows: slice) -> FrictionLaw:
        """A law whose parameters are arrays, which stands for many laws at once.

        Args:
            columns: parameters of every law, from :meth:`columns`.
            rows: the laws that it stands for.

        Raises:
            ValueError: a law refuses its parameters.
        """
        return build_model(self.law, {key: values[rows, None] for key, values in columns.items()})

    def under(self, loads: tuple[float, ...]) -> "Friction":
        """The section with σ₀ l/N of its laws where it has σ₀.

        Raises:
            ValueError: there are several loads.
        """
        if self.sigma0 is None:
            return self
        if len(loads) > 1:
            raise ValueError(
                f"friction.sigma0: found {len(loads)} loads, expected one punch.load to divide it by; "
                "sigma0_over_load is the same under all"
            )
        over_load = tuple(value / loads[0] for value in self.sigma0)
        return replace(self, parameters=self.parameters | {"sigma0_over_load": over_load})

    @property
    def stress_ratio(self) -> float:
        """σ_XY/σ_YY under the punch over f."""
        return -1.0 if self.sign == "physical" else 1.0


#: How a motion toward smaller X is given.
_WAY = 'a punch that moves backward has motion.strokes = ["backward"]'


@dataclass(frozen=True, kw_only=True)
class Motion:
    """[motion]: ``c`` over the wave speed or ``speed`` [m/s], strokes and positions; or a path."""

    c: tuple[float, ...] | None = key(
        Numbers("", Range(at_least=0.0, below=1.0, otherwise=_WAY)), "speed over c_s", None,
        "finite elements want it below the Rayleigh speed", without="one of `c` and `speed`",
    )  # fmt: skip
    speed: tuple[float, ...] | None = key(
        Numbers("m/s", Range(at_least=0.0, otherwise=_WAY)), "velocity V", None,
        "divided by the shear wave speed of the solid", without="one of `c` and `speed`",
    )  # fmt: skip
    strokes: tuple[str | Partial, ...] = key(
        STROKES, "strokes in order of time", ("forward", "backward", "forward"),
        "without `strokes` and `X_over_L` Coulomb's and Stribeck's laws have a single steady state "
        "forward; `{to = 0.8}` goes on from where the stroke before ended, after the time `rest`",
    )  # fmt: skip
    rest: float = key(
        Number("s", _NOT_NEGATIVE), "time at rest between strokes", 0.0, "some laws age there"
    )
    path: tuple[tuple[float, float], ...] | None = key(
        Rows(("s", "m"), 2), "motion point by point, time and position", None,
        "instead of `c` or `speed`, `strokes`, `X_over_L` and `rest`; positions from 0 to "
        "`friction.pre_sliding`, each piece at its own speed, with a state where it ends",
    )  # fmt: skip
    X_over_L: tuple[float, ...] = key(
        Numbers("", Range(at_least=0.0, at_most=1.0)), "positions on the stroke", (0.2, 0.8),
        "on the same axis in both directions",
    )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Solve:
    """[solve]: methods and their options; ``pressure`` is None for that of the closed form."""

    methods: tuple[str, ...] = key(
        List(Choice(METHODS), 'a list of names, as ["sie"]', at_least=0),
        "methods that solve the contact", OWN_METHODS,
        "an empty list for friction alone",
    )  # fmt: skip
    tolerance: float = key(
        Number("", Range(at_least=1e-10, at_most=0.1)),
        "wanted relative accuracy of K_I and pressure moments", 1e-6,
        "the polynomial degree rises until the measured error is below it; `1e-3` with `[time]`",
    )  # fmt: skip
    mesh: str = key(
        Choice(MESHES), "mesh", "confocal", '`"box"` is the block of the study, with walls at 100 a'
    )
    mode: str = key(
        Choice(MODES), "pressure unknown or prescribed", "contact",
        '`"traction"`: prescribed pressure, see [Theory](theory.md)',
    )  # fmt: skip
    degree: int | None = key(
        Whole(Range(at_least=1, at_most=12)), "polynomial degree, if not set by tolerance", None,
        without="set by tolerance",
    )  # fmt: skip
    cuts: int = key(Whole(Range(at_least=1, at_most=256)), "cuts of every cell's sides", 1)
    sweep: str = key(
        Choice(("auto", "every")), "which of many speeds finite elements solve", "auto",
        '`"auto"`: from 16 speeds on as many as a [fit](howto_sweep.md) needs; `"every"`: each',
    )  # fmt: skip
    solver: str = key(Choice(("auto", "direct", "boomeramg", "gamg")), "solver of linear systems", "auto")
    assembler: str = key(
        Choice(ASSEMBLERS), "assembler of matrices", "tensor",
        '`"tensor"`: by tensor products, condensed; `"dolfinx"`: by `fem.form`, slower at high degrees',
    )  # fmt: skip
    pressure: tuple[tuple[float, float], ...] | None = key(
        Or("closed_form", PRESSURE), "σ_YY of the traction mode", "closed_form",
        "rows are pairs [X/a, σ_YY/(N/2a)] from X/a = -1 to 1, linear between them, of any resultant",
    )  # fmt: skip

    @property
    def own_pressure(self) -> bool:
        """True where the scene prescribes a pressure of its own, not that of a closed form."""
        return self.mode == "traction" and self.pressure is not None


#: Tolerance of motions in time where a scene has none.
TOLERANCE_IN_TIME = 1e-3
#: Most times of a motion at which stresses along the surface are output.
MOST_OUTPUTS = 400


@dataclass(frozen=True, kw_only=True)
class Time:
    """[time]: a motion in time; times over a/c_s. ``step`` is None where the tolerance sets it.

    Raises:
        ValueError: times do not grow, the punch is lifted off, or outputs are too many.
    """

    end: float = key(
        Number("", Range(at_least=0.1, at_most=200.0)), "last time over a/c_s",
        note="what a flat punch does until then, of every state, or of every law",
    )  # fmt: skip
    step: float | None = key(
        Or("auto", Number("", Range(at_least=1e-3, at_most=1.0))),
        "longest step over a/c_s", "auto", '`"auto"`: by solve.tolerance and load_ramp',
    )  # fmt: skip
    load_ramp: float = key(
        Number("", Range(at_least=0.5, at_most=100.0)), "time in which the load comes on, over a/c_s",
        3.0,
        "N times 10s³ - 15s⁴ + 6s⁵, s = t/load_ramp",
    )  # fmt: skip
    load: tuple[tuple[float, float], ...] | None = key(
        Rows(("", ""), 1), "times over a/c_s and load over N there, instead of load_ramp", None,
        "from t = 0 on; between two points it changes like that, too",
    )  # fmt: skip
    start: str = key(
        Choice(("rest", "steady")), "state at t = 0", "rest",
        '`"steady"`: the steady motion of friction and load at t = 0',
    )  # fmt: skip
    friction: str = key(
        Choice(("constant", "law")), "friction over time", "constant",
        '`"law"`: by the law along motion.strokes, one after the other; `"constant"`: that of each state',
    )  # fmt: skip
    every: float | None = key(
        Number("", _POSITIVE), "time over a/c_s from one output of the surface to the next", None,
        "stresses along it then, or at a step near it unless equal steps meet it and the ends of "
        "strokes; and over time the energy near the punch and beyond",
    )  # fmt: skip

    def __post_init__(self) -> None:
        if self.load:
            times = [t for t, _ in self.load]
            if times[0] != 0.0 or any(later <= t for t, later in pairwise(times)):
                raise ValueError(f"load: found times {times}, expected 0 first, then ever later ones")
            if not self.steady and self.load[0][1] != 0.0:
                raise ValueError(
                    f"load: found {self.load[0][1]:g} of N at t = 0, expected 0 where it starts at rest"
                )
            if times == [0.0] and not self.steady:
                raise ValueError("load: found one time, expected a later one, with a load, at least")
            lifted = [f"{share:g}" for _, share in self.load[not self.steady :] if share <= 0.0]
            if lifted:
                raise ValueError(
                    f"load: found {lifted[0]} of N, expected more than 0: the punch stays down"
                )
        if self.steady and not self.load and self.load_ramp != Time.load_ramp:
            raise ValueError(
                f'load_ramp: found {self.load_ramp:g} with start = "steady", where the load is on from '
                "t = 0; take it away, or give load over time"
            )
        if self.every and not self.end / MOST_OUTPUTS <= self.every <= self.end:
            raise ValueError(
                f"every: found {self.every:g}, expected at least {self.end / MOST_OUTPUTS:g} and at most "
                f"end = {self.end:g}"
            )

    @property
    def steady(self) -> bool:
        """True where the motion begins in steady motion, not at rest."""
        return self.start == "steady"

    @property
    def by_law(self) -> bool:
        """True where friction changes by its law along the strokes, False where it is constant."""
        return self.friction == "law"


@dataclass(frozen=True, kw_only=True)
class Output:
    """[output]: names of groups of quantities, and points of stresses inside the solid, over a.

    The map has first and last position and number of positions, along X and along Y.
    """

    quantities: tuple[str, ...] = key(
        List(Choice(WORDS), 'a list of names, as ["yield"]'),
        "quantities to compute", ("friction", "sif", "surface"),
        "without strokes also `interfaces` and `yield`, where there are any, with `points` or `map` "
        "also `interior`, with [slider] or [time] `friction` and these; "
        "`sif`: K_I and exponents; `surface`: stresses on Y = 0; `interior`: inside; "
        "`yield`: where and at which load the solid yields; `slider`: stick-slip of [slider]; "
        "`interfaces`: where layers meet; `time`: from rest to steady motion, of [time]",
    )  # fmt: skip
    points: tuple[tuple[float, float], ...] = key(POINTS, "points inside, [X/a, Y/a]", (), "Y/a < 0")
    map: tuple[tuple[float, float, int], ...] | None = key(
        Map(), "points inside on a grid, over a", None,
        "for `interior` alone `{X = [-2.5, 2.5, 101], Y = [-2.5, -0.025, 100]}`; Y/a < 0",
    )  # fmt: skip

    def __post_init__(self) -> None:
        if BELOW in self.quantities and not self.has_places:
            object.__setattr__(self, "map", ((-2.5, 2.5, 101), (-2.5, -0.025, 100)))

    @property
    def has_places(self) -> bool:
        """True where points inside or a map are given."""
        return bool(self.points or self.map)

    @property
    def inside(self) -> NDArray[np.float64]:
        """All points inside the solid over a, (n, 2): the map's by rows of Y, then the single ones."""
        single = np.reshape(np.array(self.points, dtype=float), (-1, 2))
        if self.map is None:
            return single
        X, Y = np.meshgrid(*(np.linspace(*axis) for axis in self.map))
        return np.concatenate([np.column_stack([X.ravel(), Y.ravel()]), single])


def keys_set(section: Any, keys: Iterable[str]) -> dict[str, Any]:
    """Values by key, of some keys of a section, that are not the usual ones."""
    values = {key: getattr(section, key) for key in keys}
    return {key: value for key, value in values.items() if value != getattr(type(section), key)}


@dataclass(frozen=True)
class Section:
    """A section of a scene, and how its table is read.

    Attributes:
        made: dataclass whose fields are keys or parameters; with models, its first field is the model, or
            the class of several models and lists of their parameters by key.
        models: classes by name, None for a section without a model.
        chosen: key that names the model.
        default: name of the model where that key is absent.
        several: True where a parameter may be a list.
        defaults: of parameters, in scenes.
        or_else: alternative to a missing key, for messages.
        optional: True where a scene may do without the section, which then is None.
    """

    made: type
    models: Registry[Any] | None = None
    chosen: str = ""
    default: str = ""
    several: bool = False
    defaults: Mapping[str, Any] = dataclasses.field(default_factory=dict)
    or_else: str = ""
    optional: bool = False

    @cached_property
    def own(self) -> dict[str, tuple[str, Key]]:
        """The dataclass's fields that are keys, each with its key, by name in TOML."""
        entries = {
            field.name: field.metadata[_METADATA]
            for field in dataclasses.fields(self.made)
            if _METADATA in field.metadata
        }
        own = {entry.name or name: (name, entry) for name, entry in entries.items()}
        if not self.models:
            names = {name: field.name for name, field in fields(self.made).items()}
            own |= {n: (names[n], self._key(p, self.made)) for n, p in parameters(self.made).items()}
        return own

    @property
    def alternatives(self) -> dict[str, dict[str, Key]]:
        """Sets of keys that a section can have, by name of the model; a single set, named "", without."""
        return {name: self._of(name) for name in self.models or ("",)}

    @property
    def every(self) -> dict[str, Key]:
        """Keys that a section can have with any of its models."""
        return {name: key for keys in self.alternatives.values() for name, key in keys.items()}

    def model(self, given: Mapping[str, Any]) -> str:
        """Name of the model of a section with these values, "" without models."""
        named = given.get(self.chosen)
        if named is None:
            of_keys = (self.own[name][1].model for name in given if name in self.own)
            return next(filter(None, of_keys), self.default)
        return named if isinstance(named, str) and named in (self.models or ()) else self.default

    def keys(self, given: Mapping[str, Any]) -> dict[str, Key]:
        """Keys that a section with these values can have."""
        return self._of(self.model(given))

    def read(self, name: str, given: Any, faults: list[str]) -> Any:
        """The section's object, or None after its faults are added.

        Args:
            name: of the section.
            given: values by key, as TOML gives them.
            faults: list to which messages are added.
        """
        if self.optional and given == {}:
            return None
        if not isinstance(given, dict):
            faults.append(f"{name}: found {excerpt(given)}, expected a section [{name}]")
            return None
        keys = self.keys(given)
        if self.models and self.chosen in given:
            try:  # which other keys there are depends on it
                keys[self.chosen].kind(given[self.chosen])
            except ValueError as error:
                own = f"; one of your own is registered by a file, {program()} -x FILE.py …"
                faults.append(f"{name}.{self.chosen} ({keys[self.chosen].about}): {error}{own}")
                return None
        of_model = parameters(self.models[self.model(given)]) if self.models else {}
        if taken := sorted({self.chosen, "vary", *self.own} & of_model.keys()):
            faults.append(
                f"{name}: {self.chosen} {self.model(given)!r} has the parameter {taken[0]}, which is a "
                f"key of [{name}] whatever the {self.chosen}; give it another name"
            )
            return None
        models = [*(self.models or ())] * (self.chosen not in given)
        if misnamed := [key for key, value in given.items() if key not in keys and value in models]:
            # The keys of that model are no faults.
            kind = f'{self.chosen} = "{given[misnamed[0]]}"'
            faults.append(f"{name}.{misnamed[0]}: no such key; did you mean {kind}?")
            return None
        own_faults: list[str] = []
        for alone in (key for key in given if key in keys and keys[key].beside is not None):
            beside = {alone, *(keys[alone].beside or ())}
            if others := sorted(given.keys() - beside):
                own_faults.append(f"{name}: {alone} gives f itself; take {', '.join(others)} away")
                given = {key: value for key, value in given.items() if key in beside}
                keys = self.keys(given)
        for key in (key for key in given if key not in keys):
            others = [n for n, model in (self.models or {}).items() if key in parameters(model)]
            elsewhere = [f"[{section}]" for section, of in SECTIONS.items() if key in of.every]
            meaning = _meaning(key, keys)
            hint = nearest(key, [*keys])
            if others:
                have = "has it" if len(others) == 1 else "have it"
                hint = f' of {self.chosen} = "{self.model(given)}"; {", ".join(others)} {have}'
            elif meaning and not meant(key, keys):
                hint = f"; did you mean {' or '.join(f'{n} ({keys[n].about})' for n in meaning[:2])}?"
            elif len(elsewhere) == 1:
                hint = f"; it is one of {elsewhere[0]}"
            own_faults.append(f"{name}.{short(key)}: no such key{hint}")
        values: dict[str, Any] = {}
        for key, entry in sorted(keys.items(), key=lambda pair: not pair[1].stands_for):
            parameter = entry.stands_for
            if key not in given:
                if key in values:  # another key gives it
                    continue
                if entry.default is REQUIRED:
                    own_faults.append(f"{name}.{key}: missing; expected {entry.about}{self.or_else}")
                else:
                    text = isinstance(entry.default, str)
                    values[key] = entry.kind(entry.default) if text else entry.default
                continue
            if parameter and parameter in given:
                own_faults.append(f"{name}: {key} and {parameter} exclude each other; keep one")
            if parameter:  # where it cannot be read, the parameter is not missing besides
                values[parameter] = None
            try:
                values[key] = entry.kind(given[key])
                if parameter:
                    values[parameter] = keys[parameter].kind(entry.parameter(values[key]))
            except ValueError as error:
                own_faults.append(f"{name}.{key} ({entry.about}): {error}")
        if not own_faults:
            try:
                return self._build(self.model(given), values)
            except ValueError as error:  # values that a model refuses together
                own_faults.append(f"{name}: {error}")
        faults += own_faults
        return None

    def _build(self, name: str, values: dict[str, Any]) -> Any:
        given = {field: values[key] for key, (field, _) in self.own.items() if key in values}
        if not self.models:
            return self.made(**given)
        model = self.models[name]
        own = {key: values[key] for key in parameters(model)}
        if self.several:  # a table is the same for all laws
            of_laws = {key: own[key] if p.single else (own[key],) for key, p in parameters(model).items()}
            return self.made(law=model, parameters=of_laws, vary=values["vary"], **given)
        return self.made(**{dataclasses.fields(self.made)[0].name: build_model(model, own)}, **given)

    def _of(self, model: str) -> dict[str, Key]:
        """Keys of a section with a model of that name."""
        besides = {name: entry for name, (_, entry) in self.own.items()}
        if self.models is None:
            return besides
        kind = self.models[model]
        own = {key: self._key(parameter, kind) for key, parameter in parameters(kind).items()}
        chosen = Key(Choice(self.models), self.models.noun, self.default)
        besides = {key: entry for key, entry in besides.items() if entry.stands_for in ("", *own)}
        keys = {**own, self.chosen: chosen, **besides}
        if self.several:  # a parameter that is a table itself cannot vary
            single = {
                name: [parameter.key for parameter in parameters(kind).values() if parameter.single]
                for name, kind in self.models.items()
            }
            every = tuple(dict.fromkeys(chain(*single.values())))
            keys["vary"] = Key(
                Variations({key: own[key].kind for key in single[model]}, every),
                "parameters of the laws, table by table", (),
                "a product of each table instead of that of the lists above; each law is computed once",
            )  # fmt: skip
        return keys

    def _key(self, parameter: Parameter, model: Any) -> Key:
        """Key of a parameter of a model."""
        value = kind_of(parameter, self.several)
        default = self.defaults.get(parameter.key, fields(model)[parameter.key].default)
        if self.several and parameter.single:  # a tuple of what laws have
            if isinstance(value, Choice):
                value = List(value, "a text or a list of texts", alone=True)
            if default is not REQUIRED:
                default = (default,)
        return Key(value, parameter.about, default, parameter.note)


def _meaning(key: str, keys: Mapping[str, Key]) -> list[str]:
    """Keys whose meaning has most words of one that is not a key; long words as far as they go."""
    words = [word for word in key.lower().split("_") if len(word) > 2] or [key.lower()]
    patterns = [rf"\b{re.escape(word)}" + r"\b" * (len(word) < 4) for word in words]
    about = {name: entry.about.lower().replace("'", "") for name, entry in keys.items()}
    hits = {name: sum(bool(re.search(each, text)) for each in patterns) for name, text in about.items()}
    most = max(hits.values(), default=0)
    return [name for name, hit in hits.items() if hit == most > 0]


class LayerSections(Section):
    """Any number of tables [[layer]]."""

    def read(self, name: str, given: Any, faults: list[str]) -> tuple[Layer, ...]:
        """The layers from the top down; their faults are added to ``faults``."""
        if given == {}:
            return ()
        if not isinstance(given, list) or not all(isinstance(table, dict) for table in given):
            faults.append(
                f"{name}: found {excerpt(given)}, expected tables [[{name}]], from the top down"
            )
            return ()
        if len(given) > MOST_LAYERS:
            faults.append(f"{name}: found {len(given)} layers, expected at most {MOST_LAYERS}")
            return ()
        layers: list[Layer] = []
        for number, table in enumerate(given):
            layers += self._read(f"{name}[{number}]", table, faults)
        return tuple(layers)

    def _read(self, name: str, given: dict[str, Any], faults: list[str]) -> list[Layer]:
        if isinstance(given.get("properties"), list):
            return self._tabulated(name, given, faults)
        table, bottom = super().read(name, given, faults), None
        if table and table.to is not None:
            own = {key: v for key, v in given.items() if key not in self.own or key == "thickness"}
            lower = super().read(f"{name}.to", own | table.to, faults)
            table, bottom = lower and table, lower and lower.solid
        if not table:
            return []
        top, bottom = table.solid, None if bottom == table.solid else bottom  # None: it does not change
        try:
            return [
                Layer(table.thickness, top, bottom, table.grading, table.exponent, table.yield_strength)
            ]
        except ValueError as error:
            faults.append(f"{name}: {error}")
            return []

    def _tabulated(self, name: str, given: dict[str, Any], faults: list[str]) -> list[Layer]:
        if others := sorted(given.keys() - {"properties", "kind", "plane", "yield_strength"}):
            faults.append(f"{name}: properties gives {', '.join(others)}, too; take one of them away")
            return []
        if given.get("kind", "isotropic") != "isotropic":
            faults.append(
                f"{name}.kind: found {excerpt(given['kind'])}, expected isotropic with properties"
            )
            return []
        plane = {key: value for key, value in given.items() if key == "plane"}
        part, strength = "properties", given.get("yield_strength")
        try:
            rows = DEPTHS(given["properties"])
            solids = [
                build_model(Isotropic, dict(zip(("E", "nu", "rho"), row[1:])) | plane) for row in rows
            ]
            part = "yield_strength"
            strength = strength if strength is None else self.own[part][1].kind(strength)
        except ValueError as error:
            faults.append(f"{name}.{part}: {error}")
            return []
        return [
            Layer(lower[0] - upper[0], top, None if top == bottom else bottom, yield_strength=strength)
            for (upper, lower), (top, bottom) in zip(pairwise(rows), pairwise(solids))
        ]


#: Sections whose numbers may be swept.
SWEPT = ("solid", "layer", "punch", "punch.solid", "friction")

#: Sections of a scene, by name.
SECTIONS: dict[str, Section] = {
    "solid": Section(GivenSolid, SOLIDS, "kind", "isotropic", or_else=", or solid.material"),
    "layer": LayerSections(
        LayerTable, SOLIDS, "kind", "isotropic", or_else=", or material, or properties"
    ),
    "punch": Section(Punch, PROFILES, "profile", "flat", defaults={"half_width": 1e-3}),
    "punch.solid": Section(
        ElasticPunch, SOLIDS, "kind", "isotropic", or_else=", or punch.solid.material", optional=True
    ),
    "friction": Section(
        Friction, LAWS, "model", "dahl", or_else=", or friction.mu alone, of Coulomb's law", several=True
    ),
    "motion": Section(Motion),
    "slider": Section(Slider, optional=True, defaults={"damping": 0.0}),
    "time": Section(Time, optional=True),
    "solve": Section(Solve),
    "output": Section(Output),
}


def schema() -> dict[str, Any]:
    """JSON schema (draft 7) of a scene."""
    properties: dict[str, Any] = {"title": {"type": "string", "description": "free text"}}
    properties |= {name: _section(name, section) for name, section in SECTIONS.items()}
    properties["punch"]["properties"]["solid"] = properties.pop("punch.solid")
    layer = properties["layer"]  # constants of its own, a material, or rows by depth
    constants = ["thickness", *layer.pop("required", [])]
    enough = [{"required": keys} for keys in (["thickness", "material"], constants, ["properties"])]
    items = layer | {"anyOf": enough}
    properties["layer"] = {"type": "array", "items": items, "maxItems": MOST_LAYERS}
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "galinx scene",
        "type": "object",
        "properties": properties,
        "required": ["solid", "friction", "motion"],
        "additionalProperties": False,
    }


def _section(name: str, of: Section) -> dict[str, Any]:
    """JSON schema of a section with the keys of all its alternatives; required are those of every one."""
    alternatives = of.alternatives.values()
    needed = [
        key
        for key in of.every
        if all(key in keys and keys[key].default is REQUIRED for keys in alternatives)
    ]
    section = {
        "type": "object",
        "properties": {key: entry(described, name in SWEPT) for key, described in of.every.items()},
        "additionalProperties": False,
    }
    if name.endswith("solid"):  # a material gives the constants
        section["anyOf"] = [{"required": ["material"]}, {"required": needed}]
    elif needed:
        section["required"] = needed
    return section


def entry(key: Key, several: bool = False) -> dict[str, Any]:
    """JSON schema of a key's value, of several values where a single number may be swept."""
    if several and type(key.kind) is Number:
        key = dataclasses.replace(key, kind=Numbers(key.kind.unit, key.kind.bounds))
    unit = getattr(key.kind, "unit", None)
    about = key.about + ("" if unit is None else f" [{unit or 'dimensionless'}]")
    described = key.kind.schema() | {"description": about}
    if key.default is not REQUIRED and key.default is not None:
        described["default"] = list(key.default) if isinstance(key.default, tuple) else key.default
    return described
