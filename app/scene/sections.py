"""Sections of a scene: every key with its kind, default and meaning.

A :class:`Section` checks the keys of a table of the scene, the parameters of a registered model among
them, and builds the section's object from their values. :class:`LayerSections` reads the tables
[[layer]], from the top down. The same keys make the JSON schema of scenes, by which editors complete and
check TOML.
"""

import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import chain, pairwise
from typing import Any

from galinx.meshes import MESHES
from galinx.postprocess.quantities import WORDS
from galinx.registry import Registry
from galinx.solvers.contact.fem_plan import ASSEMBLERS
from galinx.solvers.friction import LAWS, FrictionLaw
from galinx.solvers.friction.integrate import INTEGRATORS
from galinx.solvers.friction.slider import Slider
from galinx.solvers.layers.layered import GRADINGS, Layer
from galinx.solvers.parameters import Parameter, Range, build_model, fields, parameters
from galinx.solvers.profiles import PROFILES, Profile
from galinx.solvers.solids import SOLIDS, Isotropic, Solid

from ..console import program
from ..errors import excerpt, nearest, short
from ..methods import METHODS, MODES, OWN_METHODS
from .library import LIBRARY
from .scene import (
    STATES_ALONG,
    UNIFORM_STATE,
    ElasticPunch,
    Friction,
    HalfPlane,
    Motion,
    Output,
    Punch,
    Solve,
    Time,
)
from .values import (
    ALONG,
    DEPTHS,
    POINTS,
    PRESSURE,
    Choice,
    Choices,
    Constants,
    Kind,
    Map,
    Number,
    NumberList,
    Numbers,
    OneOrMore,
    Or,
    Rows,
    Strokes,
    Variations,
    Whole,
    Wrapped,
)

#: Stands for a default where a key has to be given.
REQUIRED: Any = dataclasses.MISSING


@dataclass(frozen=True)
class Key:
    """A key of a section.

    Attributes:
        kind: kind of the value, which checks it.
        about: meaning of the key.
        default: value where the key is absent.
        note: addition to ``about`` in the documentation.
        without: text of the documentation in place of a default of None.
        stands_for: a model's parameter that follows from this key; models without it do not have the key.
    """

    kind: Kind
    about: str
    default: Any = REQUIRED
    note: str = ""
    without: str = "none"
    stands_for: str = ""


class Section:
    """A section of a scene; that of a registered model has the model's parameters among its keys.

    Args:
        build: makes the section from its values by key, after the model where there is one; where there
            may be several models, after their class and lists of their values by key.
        keys: keys by name, beside a model's parameters.
        models: classes by name, None for a section without a model.
        chosen: key that names the model.
        default: name of the model where that key is absent.
        several: True where a parameter may be a list.
        defaults: of parameters, in scenes.
        or_else: alternative to a missing key, for messages.
        optional: True where a scene may do without the section, which then is None.
    """

    #: Heading of the section in a scene.
    heading = "[{}]"

    def __init__(
        self,
        build: Callable[..., Any],
        keys: Mapping[str, Key],
        models: Registry[Any] | None = None,
        chosen: str = "",
        default: str = "",
        *,
        several: bool = False,
        defaults: Mapping[str, Any] | None = None,
        or_else: str = "",
        optional: bool = False,
    ) -> None:
        self.build, self._keys, self._models, self._chosen = build, dict(keys), models, chosen
        self._default, self._several, self._defaults = default, several, defaults or {}
        self.or_else, self._optional = or_else, optional

    @property
    def alternatives(self) -> dict[str, dict[str, Key]]:
        """Sets of keys that a section can have, by name of the model; a single set, named "", without."""
        return {name: self._of(name) for name in self._models or ("",)}

    def keys(self, given: Mapping[str, Any]) -> dict[str, Key]:
        """Keys that a section with these values can have."""
        name = given.get(self._chosen)
        registered = isinstance(name, str) and name in (self._models or ())
        return self._of(str(name) if registered else self._default)

    def read(self, name: str, given: Any, faults: list[str]) -> Any:
        """The section's object, or None after its faults are added.

        Args:
            name: of the section.
            given: values by key, as TOML gives them.
            faults: list to which messages are added.
        """
        if self._optional and given == {}:
            return None
        if not isinstance(given, dict):
            faults.append(f"{name}: found {excerpt(given)}, expected a section [{name}]")
            return None
        keys = self.keys(given)
        if self._models and self._chosen in given:
            try:  # which other keys there are depends on it
                keys[self._chosen].kind(given[self._chosen])
            except ValueError as error:
                own = f"; one of your own is registered by a file, {program()} -x FILE.py …"
                faults.append(f"{name}.{self._chosen} ({keys[self._chosen].about}): {error}{own}")
                return None
        own_faults = [
            f"{name}.{short(key)}: no such key{self._other_owner(key, given) or nearest(key, [*keys])}"
            for key in given
            if key not in keys
        ]
        values = {}
        for key, entry in keys.items():
            if key not in given:
                if entry.default is REQUIRED:
                    own_faults.append(f"{name}.{key}: missing; expected the {entry.about}{self.or_else}")
                else:
                    values[key] = entry.default
                continue
            try:
                values[key] = entry.kind(given[key])
            except ValueError as error:
                own_faults.append(f"{name}.{key} ({entry.about}): {error}")
        if not own_faults:
            try:
                return self._made(values)
            except ValueError as error:  # values that a model refuses together
                own_faults.append(f"{name}: {error}")
        faults += own_faults
        return None

    def _made(self, values: dict[str, Any]) -> Any:
        if self._models is None:
            return self.build(**values)
        model = self._models[values.pop(self._chosen)]
        own = {key: values.pop(key) for key in parameters(model)}
        if self._several:
            return self.build(model, own, **values)
        return self.build(build_model(model, own), **values)

    def _other_owner(self, key: str, given: Mapping[str, Any]) -> str:
        """End of a message on a key that only other models have, which names them; "" for any other."""
        models = self._models.items() if self._models else ()
        others = [name for name, model in models if key in parameters(model)]
        own = given.get(self._chosen, self._default)
        return f' of {self._chosen} = "{own}"; {", ".join(others)} has it' if others else ""

    def _of(self, model: str) -> dict[str, Key]:
        """Keys of a section with a model of that name."""
        if self._models is None:
            return self._keys
        kind = self._models[model]
        own = {key: self._key(parameter, kind) for key, parameter in parameters(kind).items()}
        chosen = Key(Choice(self._models), self._models.noun, self._default)
        besides = {key: entry for key, entry in self._keys.items() if entry.stands_for in ("", *own)}
        keys = {**own, self._chosen: chosen, **besides}
        if self._several:  # a parameter that is a table itself cannot vary
            single = {
                name: [parameter.key for parameter in parameters(kind).values() if parameter.single]
                for name, kind in self._models.items()
            }
            every = tuple(dict.fromkeys(chain(*single.values())))
            keys["vary"] = Key(
                Variations({key: own[key].kind for key in single[model]}, every),
                "parameters of the laws, table by table", (),
                "instead of the product of the lists above: the product of each table, with what it "
                "leaves out as the section has it; laws that are in several tables are computed once",
            )  # fmt: skip
        return keys

    def _key(self, parameter: Parameter, model: Any) -> Key:
        """Key of a parameter of a model."""
        value: Kind
        if parameter.options:
            value = Choice(parameter.options)
        elif parameter.columns:
            value = Rows(parameter.columns)
        elif parameter.count:
            value = NumberList(parameter.unit, parameter.count)
        else:
            value = (Numbers if self._several else Number)(parameter.unit, parameter.range)
        default = self._defaults.get(parameter.key, fields(model)[parameter.key].default)
        if self._several:  # each then is a tuple of what laws have
            if isinstance(value, Choice):
                value = OneOrMore(value)
            elif not parameter.single:
                value = Wrapped(value)
            if default is not REQUIRED:
                default = (default,)
        return Key(value, parameter.about, default, parameter.note)


#: Most layers of a scene.
MOST = 10
_POSITIVE = Range(above=0.0)


_YIELD_STRENGTH = Key(
    Number("Pa", _POSITIVE), "uniaxial yield strength", None,
    'for the quantity `"yield"`; stresses alone need none',
)  # fmt: skip

_KEYS = {
    "yield_strength": _YIELD_STRENGTH,
    "thickness": Key(Number("m", _POSITIVE), "thickness", None, without="the last depth of `properties`"),
    "material": Key(
        Choice(LIBRARY), "name of a solid of the library, gives `kind` and constants", None,
        "what is written beside it replaces the material's",
    ),
    "to": Key(
        Constants(), "constants at the lower face", None,
        "the layer is graded; those at its upper face stand beside it", without="as at the upper face",
    ),
    "grading": Key(
        Choice(GRADINGS), "how constants change with depth", "linear",
        '`"exponential"`: their logarithms are linear; `"power"`: (depth/thickness)^exponent',
    ),
    "exponent": Key(
        Number("", Range(at_least=1.0, at_most=10.0)), 'of `grading = "power"`', 1.0,
    ),
    "properties": Key(
        DEPTHS, "constants by depth, `[[depth, E, nu, rho], …]`", None,
        "from the upper face, depth 0, downwards, instead of `thickness`, constants and `to`; isotropic, "
        "linear between the rows",
    ),
}  # fmt: skip


class LayerSections(Section):
    """Any number of tables [[layer]]."""

    heading = "[[{}]]"

    def __init__(self) -> None:
        super().__init__(
            _layer, _KEYS, SOLIDS, "kind", "isotropic", or_else=", or material, or properties"
        )

    def read(self, name: str, given: Any, faults: list[str]) -> tuple[Layer, ...]:
        """The layers from the top down; their faults are added to ``faults``."""
        if given == {}:
            return ()
        if not isinstance(given, list) or not all(isinstance(table, dict) for table in given):
            faults.append(
                f"{name}: found {excerpt(given)}, expected tables [[{name}]], from the top down"
            )
            return ()
        if len(given) > MOST:
            faults.append(f"{name}: found {len(given)} layers, expected at most {MOST}")
            return ()
        layers: list[Layer] = []
        for number, table in enumerate(given, 1):
            layers += self._read(f"{name} {number}", table, faults)
        return tuple(layers)

    def _read(self, name: str, given: dict[str, Any], faults: list[str]) -> list[Layer]:
        if isinstance(given.get("properties"), list):
            return self._tabulated(name, given, faults)
        layer = super().read(name, given, faults)
        if layer and layer["bottom"] is not None:
            own = {key: value for key, value in given.items() if key not in _KEYS or key == "thickness"}
            bottom = super().read(f"{name}.to", own | layer["bottom"], faults)
            layer = bottom and layer | {"bottom": bottom["solid"]}
        try:
            return [Layer(**layer)] if layer else []
        except ValueError as error:
            faults.append(f"{name}: {error}")
            return []

    def _tabulated(self, name: str, given: dict[str, Any], faults: list[str]) -> list[Layer]:
        if others := sorted(given.keys() - {"properties", "kind", "plane"}):
            faults.append(f"{name}: properties gives {', '.join(others)}, too; take one of them away")
            return []
        if given.get("kind", "isotropic") != "isotropic":
            faults.append(
                f"{name}.kind: found {excerpt(given['kind'])}, expected isotropic with properties"
            )
            return []
        try:
            rows = _KEYS["properties"].kind(given["properties"])
            solids = [
                build_model(Isotropic, dict(zip(("E", "nu", "rho"), row[1:])) | _plane(given))
                for row in rows
            ]
        except ValueError as error:
            faults.append(f"{name}.properties: {error}")
            return []
        return [
            Layer(lower[0] - upper[0], top, None if top == bottom else bottom)
            for (upper, lower), (top, bottom) in zip(pairwise(rows), pairwise(solids))
        ]


def _plane(given: Mapping[str, Any]) -> dict[str, Any]:
    return {"plane": given["plane"]} if "plane" in given else {}


def _layer(
    solid: Solid, thickness: float | None, material: str | None,
    to: Any, grading: str, exponent: float, properties: Any, yield_strength: float | None,
) -> dict[str, Any]:  # fmt: skip
    """Values of a layer by attribute; its constants at the lower face are still as TOML gives them."""
    if thickness is None:
        raise ValueError('missing thickness, as in thickness = "2 µm"')
    if to is None and (grading != "linear" or exponent != 1.0):
        raise ValueError("grading and exponent need to = {…}, the constants at the lower face")
    if grading != "power" and exponent != 1.0:
        raise ValueError(f'found exponent with grading = "{grading}", expected grading = "power"')
    return {
        "thickness": thickness, "solid": solid, "bottom": to, "grading": grading,
        "exponent": exponent, "yield_strength": yield_strength,
    }  # fmt: skip


#: Most times of a motion at which stresses along the surface are output.
MOST_OUTPUTS = 400


def _elastic_punch(solid: Solid, material: str | None, speed: float) -> ElasticPunch:
    return ElasticPunch(solid, speed)


def _punch(profile: Profile, load: tuple[float, ...]) -> Punch:
    return Punch(profile, tuple(dict.fromkeys(load)))


def _friction(
    law: type[FrictionLaw], values: dict[str, Any], sigma0: Any = None, mu: Any = None, **rest: Any
) -> Friction:
    """Section [friction]; ``sigma0`` and ``mu`` are unused: the reader has made parameters of them."""
    return Friction(law, values, **rest)


def _slider(damping: float, **given: float | None) -> Slider | None:
    if all(value is None for value in given.values()):
        return None
    if missing := [key for key, value in given.items() if value is None]:
        raise ValueError(f"missing {', '.join(missing)}, which a slider needs")
    return Slider(damping=damping, **given)  # type: ignore[arg-type]


def _time(
    end: float | None, step: float | str, load_ramp: float,
    load: tuple[tuple[float, float], ...] | None, start: str, friction: str,
    every: float | None,
) -> Time | None:  # fmt: skip
    if end is None:
        return None
    steady = start == "steady"
    if load:
        times = [t for t, _ in load]
        if times[0] != 0.0 or any(later <= t for t, later in pairwise(times)):
            raise ValueError(f"load: found times {times}, expected 0 first, then ever later ones")
        if not steady and load[0][1] != 0.0:
            raise ValueError(
                f"load: found {load[0][1]:g} of N at t = 0, expected 0 where it starts at rest"
            )
        if faults := [f"{share:g}" for _, share in load[not steady :] if share <= 0.0]:
            raise ValueError(f"load: found {faults[0]} of N, expected more than 0: the punch stays down")
    if every and not end / MOST_OUTPUTS <= every <= end:
        raise ValueError(
            f"every: found {every:g}, expected at least {end / MOST_OUTPUTS:g} and at most end = {end:g}"
        )
    return Time(
        end, None if isinstance(step, str) else step, load_ramp, load or (), steady, friction == "law",
        every,
    )  # fmt: skip


_SOLID_KEYS = {
    "material": Key(
        Choice(LIBRARY),
        "name of a solid of the library, gives `kind`, constants and, of metals, yield_strength", None,
        "what is written beside it replaces the material's",
    ),
    "yield_strength": _YIELD_STRENGTH,
}  # fmt: skip

_PUNCH_SOLID_KEYS = {
    "material": _KEYS["material"],
    "speed": Key(
        Number("m/s", Range(at_least=0.0)), "speed of the punch's solid over the contact", 0.0,
        "at rest in the frame of the contact it slides; with a speed of its own it rolls",
    ),
}  # fmt: skip

_PUNCH_KEYS = {
    "load": Key(
        Numbers("N/m", _POSITIVE), "normal load N per depth", (55.3e3,),
        "dimensionless results do not depend on it where the contact is that of a flat punch",
    ),
}  # fmt: skip

_FRICTION_KEYS = {
    "mu": Key(
        Numbers("", Range(at_least=0.0)), "coefficient of friction", None,
        "another name of `mu_c`; without `model` it is Coulomb's law, and 0 is no friction",
        stands_for="mu_c",
    ),
    "sigma0": Key(
        Numbers("N/m^2", _POSITIVE), "stiffness σ₀ per depth, instead of σ₀ l/N", None,
        "divided by punch.load it is `sigma0_over_load`. The study's σ₀ = 1.5922 N/µm and N = 55.3 N, "
        'both read per mm of depth, are `"1.5922 N/µm/mm"` and `"55.3 N/mm"`: 28 792 1/m for any depth',
        stands_for="sigma0_over_load",
    ),
    "along": Key(
        ALONG, "f along the contact, pairs [X/a, f]", None,
        "linear between the pairs, from X/a = -1 to 1, instead of a law; see "
        "[Friction along the contact](howto_friction.md#friction-along-the-contact)",
        stands_for="mu_c",
    ),
    "state": Key(
        Choice(STATES_ALONG), "state of the law along the contact", UNIFORM_STATE,
        '`"uniform"`: that of the stroke all along; `"advected"`: in steady sliding, from rest at the '
        "leading end on, f of the law over the distance from there",
    ),
    "pre_sliding": Key(
        Number("m", _POSITIVE), "pre-sliding displacement L", 1e-4, "the length of a stroke",
    ),
    "integrator": Key(
        Choice(INTEGRATORS), "integrator", "exact",
        '`"exact"`: to the last digits; `"rk4"`: Runge-Kutta with 20 steps a stroke, refused where it is '
        "unstable",
    ),
    "sign": Key(
        Choice(("physical", "eq25")), "sign of σ_XY", "physical",
        '`"physical"`: σ_XY = -f σ_YY; `"eq25"`: σ_XY = f σ_YY, the mirror image',
    ),
}  # fmt: skip

_MOTION_KEYS = {
    "c": Key(
        Numbers("", Range(at_least=0.0, below=1.0)), "speed over c_s", None,
        "finite elements want it below the Rayleigh speed", without="one of `c` and `speed`",
    ),
    "speed": Key(
        Numbers("m/s", Range(at_least=0.0)), "speed V", None,
        "divided by the shear wave speed of the solid", without="one of `c` and `speed`",
    ),
    "strokes": Key(
        Strokes(), "strokes in order of time", ("forward", "backward", "forward"),
        "of a law without memory, Coulomb's or Stribeck's, there is a single steady state forward if "
        "neither `strokes` nor `X_over_L` is given; a stroke `{to = 0.8}` goes on from where the one "
        "before ended; it may have a `speed` of its own, `rest` is the time at rest before it",
    ),
    "rest": Key(
        Number("s", Range(at_least=0.0)), "time at rest between strokes", 0.0, "some laws age there",
    ),
    "path": Key(
        Rows(("s", "m"), 2), "motion point by point, time and position", None,
        "instead of `c` or `speed`, `strokes` and `X_over_L`; positions from 0 to "
        "`friction.pre_sliding`, each piece at its own speed, with a state where it ends",
        without="none",
    ),
    "X_over_L": Key(
        Numbers("", Range(at_least=0.0, at_most=1.0)), "positions on the stroke", (0.2, 0.8),
        "on the same axis in both directions",
    ),
}  # fmt: skip

_SOLVE_KEYS = {
    "methods": Key(
        Choices(METHODS, at_least=0), "methods that solve the contact", OWN_METHODS,
        "an empty list for friction alone",
    ),
    "tolerance": Key(
        Number("", Range(at_least=1e-10, at_most=0.1)),
        "wanted relative accuracy of K_I and pressure moments", 1e-6,
        "the polynomial degree rises until the measured error is below it",
    ),
    "mesh": Key(
        Choice(MESHES), "mesh", "confocal", '`"box"` is the block of the study, with walls at 100 a'
    ),
    "mode": Key(
        Choice(MODES), "pressure unknown or prescribed", "contact",
        '`"traction"`: prescribed pressure, see [Theory](theory.md)',
    ),
    "degree": Key(
        Whole(Range(at_least=1, at_most=12)), "polynomial degree, if not set by tolerance", None,
        without="set by tolerance",
    ),
    "cuts": Key(Whole(Range(at_least=1, at_most=256)), "cuts of every cell's sides", 1),
    "sweep": Key(
        Choice(("auto", "every")), "which of many speeds finite elements solve", "auto",
        '`"auto"`: from 16 speeds on as many as a fit through them needs to give the others, see '
        '[Sweeps](howto_sweep.md); `"every"`: each',
    ),
    "solver": Key(
        Choice(("auto", "direct", "boomeramg", "gamg")), "solver of linear systems", "auto"
    ),
    "assembler": Key(
        Choice(ASSEMBLERS), "assembler of matrices", "tensor",
        '`"tensor"`: element matrices by tensor products, condensed; `"dolfinx"`: the same weak form by '
        "`fem.form`, `assemble_matrix` and `dirichletbc`, several times slower at high degrees",
    ),
    "pressure": Key(
        Or("closed_form", PRESSURE), "σ_YY of the traction mode", "closed_form",
        "for the mode traction; rows are pairs [X/a, σ_YY/(N/2a)] from X/a = -1 to 1, linear between "
        "them, of any resultant",
    ),
}  # fmt: skip

_SLIDER_KEYS = {
    "mass": Key(Number("kg/m", _POSITIVE), "mass of the slider, per depth", None),
    "stiffness": Key(Number("N/m^2", _POSITIVE), "stiffness of the spring, per depth", None),
    "damping": Key(
        Number("N*s/m^2", Range(at_least=0.0)), "dashpot beside the spring, per depth", 0.0
    ),
    "drive_speed": Key(
        Number("m/s", _POSITIVE), "speed at which the spring's other end is pulled", None
    ),
    "duration": Key(Number("s", _POSITIVE), "duration of the motion", None),
}  # fmt: skip

_TIME_KEYS = {
    "end": Key(
        Number("", Range(at_least=0.1, at_most=200.0)), "last time over a/c_s", None,
        "what a flat punch does until then, of every state, or of every law",
    ),
    "step": Key(
        Or("auto", Number("", Range(at_least=1e-3, at_most=1.0))),
        "step of the finite elements over a/c_s", "auto", '`"auto"`: by solve.tolerance and load_ramp',
    ),
    "load_ramp": Key(
        Number("", Range(at_least=0.5, at_most=100.0)), "time in which the load comes on, over a/c_s",
        3.0,
        "N times 10s³ - 15s⁴ + 6s⁵, s = t/load_ramp",
    ),
    "load": Key(
        Rows(("", ""), 1), "times over a/c_s and load over N there, instead of load_ramp", None,
        "from t = 0 on; between two points it changes like that, too",
    ),
    "start": Key(
        Choice(("rest", "steady")), "state at t = 0", "rest",
        '`"steady"`: the steady motion of friction and load at t = 0',
    ),
    "friction": Key(
        Choice(("constant", "law")), "friction over time", "constant",
        '`"law"`: by the law along motion.strokes, one after the other; `"constant"`: that of each state',
    ),
    "every": Key(
        Number("", _POSITIVE), "time over a/c_s from one output of the surface to the next",
        None, "stresses along it then, and over time the energy near the punch and beyond",
        without="none",
    ),
}  # fmt: skip

_OUTPUT_KEYS = {
    "quantities": Key(
        Choices(WORDS), "quantities to compute", ("friction", "sif", "surface"),
        "of a scene without strokes also `interfaces` and `yield`, where there are any; "
        "`sif`: K_I and exponents; `surface`: stresses on Y = 0; `interior`: inside; "
        "`yield`: where and at which load the solid yields; `slider`: stick-slip of [slider]; "
        "`interfaces`: where layers meet; `time`: from rest to steady motion, of [time]",
    ),
    "points": Key(
        POINTS, "points inside, [X/a, Y/a]", (), 'needs the quantity `"interior"`; Y/a < 0'
    ),
    "map": Key(
        Map(), "points inside on a grid, over a", None, 'needs the quantity `"interior"`; Y/a < 0'
    ),
}  # fmt: skip

#: Sections whose numbers may be swept.
SWEPT = ("solid", "layer", "punch", "punch.solid", "friction")

#: Sections of a scene, by name.
SECTIONS: dict[str, Section] = {
    "solid": Section(HalfPlane, _SOLID_KEYS, SOLIDS, "kind", "isotropic", or_else=", or solid.material"),
    "layer": LayerSections(),
    "punch": Section(_punch, _PUNCH_KEYS, PROFILES, "profile", "flat", defaults={"half_width": 1e-3}),
    "punch.solid": Section(
        _elastic_punch,
        _PUNCH_SOLID_KEYS,
        SOLIDS,
        "kind",
        "isotropic",
        or_else=", or punch.solid.material",
        optional=True,
    ),
    "friction": Section(_friction, _FRICTION_KEYS, LAWS, "model", "dahl", several=True),
    "motion": Section(Motion, _MOTION_KEYS),
    "slider": Section(_slider, _SLIDER_KEYS),
    "time": Section(_time, _TIME_KEYS),
    "solve": Section(Solve, _SOLVE_KEYS),
    "output": Section(Output, _OUTPUT_KEYS),
}


def schema() -> dict[str, Any]:
    """JSON schema (draft 7) of a scene."""
    properties: dict[str, Any] = {"title": {"type": "string", "description": "free text"}}
    properties |= {name: _section(name, section.alternatives) for name, section in SECTIONS.items()}
    properties["punch"]["properties"]["solid"] = properties.pop("punch.solid")
    properties["layer"] = {"type": "array", "items": _layer_schema(properties["layer"]), "maxItems": MOST}
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "galinx scene",
        "type": "object",
        "properties": properties,
        "required": ["solid", "friction", "motion"],
        "additionalProperties": False,
    }


def _section(name: str, alternatives: dict[str, dict[str, Key]]) -> dict[str, Any]:
    """JSON schema of a section with the keys of all its alternatives; required are those of every one."""
    every = {name: key for keys in alternatives.values() for name, key in keys.items()}
    needed = [
        name
        for name in every
        if all(name in keys and keys[name].default is REQUIRED for keys in alternatives.values())
    ]
    section = {
        "type": "object",
        "properties": {key: entry(described, name in SWEPT) for key, described in every.items()},
        "additionalProperties": False,
    }
    if name.endswith("solid"):  # a material gives the constants
        section["anyOf"] = [{"required": ["material"]}, {"required": needed}]
    elif needed:
        section["required"] = needed
    return section


def _layer_schema(table: dict[str, Any]) -> dict[str, Any]:
    """JSON schema of a layer: constants of its own, a material, or rows by depth."""
    needed = table.pop("required", [])
    enough = [["thickness", "material"], ["thickness", *needed], ["properties"]]
    return table | {"anyOf": [{"required": keys} for keys in enough]}


def entry(key: Key, several: bool = False) -> dict[str, Any]:
    """JSON schema of a key's value, of several values where a single number may be swept."""
    if several and type(key.kind) is Number:
        key = dataclasses.replace(key, kind=Numbers(key.kind.unit, key.kind.bounds))
    unit = getattr(key.kind, "unit", None)
    about = key.about + ("" if unit is None else f" [{unit or 'dimensionless'}]")
    described = key.kind.schema() | {"description": about}
    if key.default is not REQUIRED and key.default not in (None, ((),)):  # a table left out is none
        described["default"] = list(key.default) if isinstance(key.default, tuple) else key.default
    return described
