"""A checked scene, section by section, with numbers in SI.

Here are also the checks that need more than one key: :func:`contradictions` lists keys that exclude or
need each other, :func:`oddities` values that look unusual, because their unit may not be as meant.
"""

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.quantities import declared
from galinx.postprocess.quantities.over_time import TIME
from galinx.postprocess.quantities.quantity import FRICTION_ALONE
from galinx.postprocess.quantities.runs import SLIDER
from galinx.postprocess.units import engineering
from galinx.solvers.contact import AT_INTERFACES, BELOW, INTENSITIES, ON_SURFACE, YIELD
from galinx.solvers.contact.prescribed_pressure import LinearPressure
from galinx.solvers.contact.solution import FINITE, FREE, PUNCH, STRENGTH, Contact, make_contact
from galinx.solvers.friction.along import Along, advected, tabulated
from galinx.solvers.friction.motion import Leg, legs, legs_of_path, positions
from galinx.solvers.friction.slider import Slider
from galinx.solvers.layers.layered import Layer, Layered
from galinx.solvers.parameters import Parameter, parameters
from galinx.solvers.parameters import values as constants
from galinx.solvers.solids import Solid
from galinx.solvers.solids.pair import Pair

from ..errors import BadInput, listed
from .sections import (
    ADVECTED,
    ElasticPunch,
    Friction,
    GivenSolid,
    Motion,
    Output,
    Punch,
    Solve,
    Time,
    keys_set,
)


@dataclass(frozen=True)
class Scene:
    """A checked scene; numbers are in SI.

    Attributes:
        title: free text.
        text: its TOML, byte for byte as archived.
        half_plane, punch, friction, motion, solve, output: its sections.
        slider: a mass on a spring, None for none.
        layers: layers on the solid, from the top down.
        elastic_punch: solid of the punch, None for a rigid one.
        time: a motion in time, None for none.
        steady: True for steady sliding at each speed, of a law without memory and no strokes.
        swept: values of swept numbers by their keys, those of the first variant where it has some.
        variants: scenes of all combinations of swept numbers; the scene itself is as the first. None for
            a scene without swept numbers, and for a variant.
        free_ends: an end of the contact may be free in one of several variants, and so in each.
    """

    title: str
    text: str
    half_plane: GivenSolid
    punch: Punch
    friction: Friction
    motion: Motion
    solve: Solve
    output: Output
    slider: Slider | None = None
    layers: tuple[Layer, ...] = ()
    elastic_punch: ElasticPunch | None = None
    time: Time | None = None
    steady: bool = False
    swept: Mapping[str, float] = field(default_factory=dict)
    variants: tuple["Scene", ...] = ()
    free_ends: bool = False

    @property
    def variant(self) -> str:
        """Its swept numbers in words, "" without."""
        return in_words(self.swept)

    @property
    def each(self) -> tuple["Scene", ...]:
        """The variants, or the scene itself."""
        return self.variants or (self,)

    @cached_property
    def solid(self) -> Solid:
        """The elastic solid, with its layers, and with that of an elastic punch."""
        below = self.half_plane.solid
        plate: Solid = Layered(self.layers, below) if self.layers else below
        if punch := self.elastic_punch:
            return Pair(plate, punch.solid, punch.speed, punch.yield_strength)
        return plate

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
    def body(self) -> Contact:
        """Contact of the punch, or of the prescribed pressure, and the solid under the first load."""
        pressure = LinearPressure(*np.array(self.solve.pressure).T) if self.solve.own_pressure else None
        strength = self.half_plane.yield_strength
        along = None if _not_varying(self) else self.along
        return make_contact(
            self.solid, self.punch.profile, self.punch.load, pressure, strength, along, self.free_ends
        )

    @cached_property
    def along(self) -> dict[float, Along]:
        """σ_XY/σ_YY over X/a, by its mean, where it varies along the contact: by speed and law.

        Raises:
            ValueError: a law refuses its parameters.
        """
        friction = self.friction
        if friction.along is not None:
            law = next(friction.laws())
            means = {
                friction.stress_ratio * float(law.friction(law.rest(), s, 0.0)) + 0.0 for s in (1, -1)
            }
            scale = max(means)
            return {g: tabulated(friction.along, g / scale if scale else 1.0) for g in sorted(means)}
        if friction.state != ADVECTED:
            return {}
        a = make_contact(self.solid, self.punch.profile, self.punch.load).half_width
        V = self.motion.speed or tuple(c * self.solid.c_s for c in self.motion.c or ())
        each: dict[float, Along] = {}
        for speed in dict.fromkeys(V) if friction.law.depends_on_speed else V[:1]:
            for law in friction.laws():
                try:
                    along = advected(law, self.legs[0].s, speed, a, friction.stress_ratio)
                except ValueError as error:
                    raise BadInput(f'friction.state = "advected": {error}') from None
                g = along.mean
                while g in each:  # another law with the same mean
                    g = float(np.nextafter(g, np.inf))
                each[g] = along
        return each

    @property
    def modes(self) -> tuple[str, ...]:
        """Names of the modes, by which quantities and rules that apply are selected."""
        return ("", self.solve.mode, *self.body.modes)

    @property
    def between_free_ends(self) -> bool:
        """True for a punch without a sharp edge: beyond the Rayleigh speed nothing holds it up."""
        return PUNCH in self.body.modes and (FINITE in self.body.modes or bool(self.body.tips))

    @property
    def sha256(self) -> str:
        """Hash of the scene's text."""
        return hashlib.sha256(self.text.encode()).hexdigest()


def in_words(swept: Mapping[str, float]) -> str:
    """Values of swept numbers in words, as ``solid.E = 200 GPa``."""
    return ", ".join(f"{key} = {with_unit(key, value)}" for key, value in swept.items())


def with_unit(key: str, value: float) -> str:
    """Value of a swept number, in SI, with its unit."""
    unit = declared(f"states/{key}").unit
    return f"{value:g}" if unit == "1" else engineering(value, unit)


#: Names in output.quantities that need no contact.
FRICTIONS = frozenset({FRICTION_ALONE, SLIDER, TIME})
#: Mean pressure over the shear modulus above which strains are far from small.
_PRESSED = 0.1
#: Length between two points of a table over that of its neighbours from which a straight part is likely.
_LONG = 1.5
#: Slope of a punch above which its angle is far from small.
_STEEP = 0.2
#: Half-width [m] of a contact below which a solid is no continuum: a few atoms.
_ATOMS = 1e-9


def _rounded_off(profile: Any, X: NDArray) -> Iterator[str]:
    """Warning that a table is lowest between two points far apart: the punch may be flat there."""
    lengths, slopes = np.diff(X), profile.slope(X)
    for i in np.flatnonzero((slopes[:-1] < 0.0) & (slopes[1:] > 0.0)).tolist():
        if lengths[i] > _LONG * max(lengths[max(i - 1, 0) : i].sum(), lengths[i + 1 : i + 2].sum()):
            fall = float(profile.height(X[i : i + 2]).min())
            yield (
                f"punch.shape: no point between X = {X[i]:g} m and {X[i + 1]:g} m, where the curve "
                f"through the points falls {fall:.3g} m below them; if the punch is straight there, give "
                "a point between them on the line"
            )


def usual_quantities(scene: Scene) -> tuple[str, ...]:
    """Quantities that a scene does not name: its motions', or what the solid bears in steady sliding."""
    if motions := [TIME] * bool(scene.time) + [SLIDER] * bool(scene.slider):
        return (FRICTION_ALONE, *motions)
    body, quantities = scene.body, [FRICTION_ALONE, INTENSITIES, ON_SURFACE]
    quantities += [AT_INTERFACES] * bool(scene.layers)
    judged = scene.solid.knows_σ_ZZ and YIELD not in body.lacks
    finite = FINITE in body.modes
    quantities += [YIELD] * (judged and (finite or (STRENGTH not in body.lacks and body.flat)))
    return tuple(quantities)


def contradictions(scene: Scene) -> list[str]:
    """Faults of keys that exclude or need one another, one sentence each."""
    quantities, solve = set(scene.output.quantities), scene.solve
    contact, fixed = sorted(quantities - FRICTIONS), solve.degree is not None
    of_yield = YIELD in quantities
    faults = {
        f"solve.methods is empty, but output.quantities asks for {', '.join(contact)}; name "
        "closed_form, fem or sie": contact and not solve.methods,
        'slider: the quantity "slider" and the section [slider] go together, with mass, stiffness, '
        "drive_speed and duration": (SLIDER in quantities) != (scene.slider is not None),
        'time: the quantity "time" and the section [time] go together, with end': (
            (TIME in quantities) != (scene.time is not None)
        ),
        f'output.points and output.map need "{BELOW}" among output.quantities': (
            BELOW not in quantities and scene.output.has_places
        ),
        'output.quantities asks for "yield": expected solid.yield_strength, as in yield_strength = '
        '"205 MPa", or a material that has one: stresses at sharp edges have no largest value': (
            of_yield and STRENGTH in scene.body.lacks and FINITE not in scene.body.modes
        ),
        'output.quantities asks for "yield": expected solid.stiffness_Z = [c13, c23, c36], '
        "without which σ_ZZ is not known in plane strain": of_yield and not scene.solid.knows_σ_ZZ,
        'output.quantities asks for "interfaces": expected [[layer]], whose lower faces these are': (
            AT_INTERFACES in quantities and not scene.layers
        ),
        f"solve.cuts: found {solve.cuts} without solve.degree, which it needs": (
            not fixed and solve.cuts != 1
        ),
        'solve.degree needs solve.mode = "contact"': fixed and solve.mode == "traction",
        'solve.pressure needs solve.mode = "traction"': (
            solve.pressure is not None and solve.mode != "traction"
        ),
    }
    of_keys = (text for text, holds in faults.items() if holds)
    return [
        *_of_motion(scene), *of_keys, *_of_planes(scene), *_of_elastic_punch(scene),
        *_along_the_contact(scene),
    ]  # fmt: skip


def _along_the_contact(scene: Scene) -> Iterator[str]:
    """Faults of friction that varies along the contact, one sentence each."""
    if scene.friction.along is None and scene.friction.state != ADVECTED:
        return
    if fault := _not_varying(scene):
        yield (
            f"friction varies along the contact, but found {fault}; take that away, or give one friction"
        )
        return
    forward = scene.friction.stress_ratio * scene.legs[0].s
    for along in scene.along.values() if scene.friction.state == ADVECTED else ():
        least = float((forward * along(np.array([-1.0, 1.0]))).min())
        if least < 0.0:
            yield (
                f"friction.state: bristles enter the contact with f = {least:g}, which drives the slip; "
                "expected a law with f >= 0 at its start"
            )
            return


def _not_varying(scene: Scene) -> str:
    """Reason why friction cannot vary along the contact, "" where it can."""
    solve = scene.solve
    reasons = {
        "a motion in time": scene.time is not None,
        "a slider": scene.slider is not None,
        "bristles that a rolling punch carries along, too": (
            scene.friction.state == ADVECTED
            and scene.elastic_punch is not None
            and scene.elastic_punch.speed != 0.0
        ),
        f'solve.mode = "{solve.mode}"': solve.mode != "contact",
        f'solve.mesh = "{solve.mesh}"': solve.mesh != "confocal",
        f'solve.solver = "{solve.solver}"': solve.solver not in ("auto", "direct"),
        "strokes or positions on them with an advected state": (
            scene.friction.state == ADVECTED and not scene.steady
        ),
        "friction.integrator with an advected state, whose law has a formula": (
            scene.friction.state == ADVECTED and scene.friction.integrator != "exact"
        ),
    }
    return " and ".join(reason for reason, holds in reasons.items() if holds)


def _of_planes(scene: Scene) -> Iterator[str]:
    """Faults of solids that are not in the plane of [solid], one sentence each."""
    plane = scene.half_plane.solid.plane
    for name, (solid, _) in _solids(scene).items():
        if solid.plane != plane:
            yield f'{name}.plane: found "{solid.plane}", expected that of [solid], "{plane}"'


def _solids(scene: Scene) -> dict[str, tuple[Any, float | None]]:
    """Solids of a scene by their sections, each with its yield strength [Pa], None for none."""
    below, punch = scene.half_plane, scene.elastic_punch
    layers = {f"layer[{n}]": (of.solid, of.yield_strength) for n, of in enumerate(scene.layers)}
    own = {"punch.solid": (punch.solid, punch.yield_strength)} if punch else {}
    return {"solid": (below.solid, below.yield_strength)} | layers | own


def _of_elastic_punch(scene: Scene) -> Iterator[str]:
    """Faults of section [punch.solid], one sentence each."""
    if scene.elastic_punch is None:
        return
    if scene.solve.mode == "traction":
        yield 'solve.mode: found "traction" with an elastic punch, expected "contact"'
    if scene.time:
        yield (
            "punch.solid: found an elastic punch beside [time], expected a rigid one: two elastic bodies "
            "are solved in steady motion"
        )


#: Keys of [motion] for which a path stands.
_OF_STROKES = ("strokes", "X_over_L", "rest")


def _of_motion(scene: Scene) -> Iterator[str]:
    """Faults of section [motion], one sentence each."""
    motion, c_s = scene.motion, scene.solid.c_s
    if motion.c is not None and motion.speed is not None:
        yield "motion: c and speed exclude each other; keep one"
    elif motion.path is not None and (motion.c is not None or motion.speed is not None):
        yield "motion: path gives the speed, too; take c and speed away"
    elif motion.path is None and motion.c is None and motion.speed is None:
        yield "motion: expected c (over the shear wave speed) or speed (m/s)"
    others = keys_set(motion, _OF_STROKES)
    if motion.path is not None and others:
        yield f"motion: path gives strokes, positions and rests; take {' and '.join(others)} away"
    try:
        own = [leg.speed for leg in scene.legs if leg.speed is not None]
    except ValueError as error:
        yield f"motion.{'strokes' if motion.path is None else 'path'}: {error}"
        return
    if own and max(own) >= c_s:
        limit = f"the shear wave speed {c_s:.6g} m/s"
        yield f"motion: found a stroke at {max(own):g} m/s, expected less than {limit}"
    if not any(len(X) for X in scene.places):
        yield "motion.X_over_L: found no position that a stroke passes, expected at least one"


def oddities(scene: Scene) -> list[str]:
    """Warnings about unusual values, one sentence a key, and about keys without effect."""
    return [
        *_unusual_numbers(scene), *_unusual_contact(scene), *_without_strokes(scene), *_apart(scene.legs)
    ]  # fmt: skip


def _apart(legs: Sequence[Leg]) -> Iterator[str]:
    """Warning about the first stroke that does not begin where the one before ended."""
    for n, (before, leg) in enumerate(pairwise(legs), 1):
        if leg.start != before.end:
            yield (
                f"motion.strokes: stroke {n} ends at X/L = {before.end:g}, stroke {n + 1} begins at "
                f"{leg.start:g}; strokes that are written as {{ to = 0.5 }} go on from the last's end"
            )
            return


def _without_strokes(scene: Scene) -> Iterator[str]:
    """Warning about keys without effect where there are no strokes."""
    if not scene.steady:
        return
    if not scene.friction.law.has_memory and keys_set(scene.friction, ["state"]):
        yield "friction.state: without effect, because this law of friction has no memory"
    unused = [f"friction.{key}" for key in keys_set(scene.friction, ["pre_sliding"])]
    if unused := unused + [f"motion.{key}" for key in keys_set(scene.motion, ["rest"])]:
        yield (
            f"{listed(unused)}: without effect, because the punch makes no strokes; give motion.strokes "
            "for a motion to and fro"
        )


def _unusual_numbers(scene: Scene) -> Iterator[str]:
    """Warnings about numbers beyond their usual range."""
    pre_sliding = Parameter("pre_sliding", "", "m", usual=(1e-10, 1.0))
    strength = Parameter("yield_strength", "", "Pa", usual=(1e4, 1e11))
    thickness, profile = Parameter("thickness", "", "m", usual=(1e-9, 1.0)), scene.punch.profile
    for section, described, values in (
        ("friction", {pre_sliding.key: pre_sliding}, {pre_sliding.key: scene.friction.pre_sliding}),
        ("punch", parameters(profile), constants(profile)),
        *(
            (
                name,
                parameters(solid) | {strength.key: strength},
                constants(solid) | {strength.key: of_yield or 0.0},
            )
            for name, (solid, of_yield) in _solids(scene).items()
        ),
        *(
            (f"layer[{n}]", {thickness.key: thickness}, {thickness.key: layer.thickness})
            for n, layer in enumerate(scene.layers)
        ),
        ("friction", parameters(scene.friction.law), scene.friction.values),
    ):
        for key, parameter in described.items():
            yield from unusual(f"{section}.{key}", parameter, values[key])


def unusual(name: str, parameter: Parameter, values: Any) -> Iterator[str]:
    """Warning about values of a parameter beyond the usual ones, none where there are no such."""
    if not parameter.usual:
        return
    low, high = parameter.usual
    numbers = np.atleast_1d(values).tolist()
    # 0 has no unit.
    odd = [f"{value:g}" for value in numbers if value and not low <= abs(value) <= high]
    if odd:
        are, their = ("is", "its unit") if len(odd) == 1 else ("are", "their unit")
        yield (
            f"{name} = {listed(odd)}{f' {parameter.unit}' * bool(parameter.unit)} {are} "
            f"unusual, usual is {low:g} to {high:g}; is {their} as meant?"
        )


def _unusual_contact(scene: Scene) -> Iterator[str]:
    """Warnings about loads and shapes for which no linear theory of a continuum is meant."""
    loads, μ = scene.punch.loads, scene.solid.μ
    mean = float(scene.body.loaded(np.array([max(loads)])).stress[0])  # NaN without a contact
    if mean > _PRESSED * μ:
        of_load = f" at N = {max(loads):g} N/m" * (len(loads) > 1)
        yield (
            f"punch: the mean pressure N/(2a) = {mean:.3g} Pa{of_load} is {mean / μ:.2g} "
            f"times the shear modulus, usual is less than {_PRESSED:g}; are load and half-width as meant?"
        )
    # Of a flat punch the key of its half-width warns.
    a = scene.body.loaded(min(loads)).half_width if scene.body.ends == FREE else _ATOMS
    if a < _ATOMS:
        yield (
            f"punch: under the load {min(loads):g} N/m the half-width of the contact at rest is {a:.2g} "
            f"m, usual is at least {_ATOMS:g} m: that is no more than a few atoms, where a solid is no "
            "continuum; is the load as meant?"
        )
    # Slopes that are keys themselves have warnings of their own.
    if scene.body.ends == FREE and not {"slope", "shape"} & parameters(scene.punch.profile).keys():
        widest = scene.body.loaded(max(loads)).half_width
        slope = float(np.abs(scene.punch.profile.slope(np.array([-widest, widest]))).max())
        if slope > _STEEP:
            yield (
                f"punch: under the load {max(loads):g} N/m the contact at rest reaches to slopes of "
                f"{slope:.2g}, half-width {widest:.3g} m; linear theory takes slopes below {_STEEP:g}; "
                "are load, profile and modulus as meant?"
            )
    points = getattr(scene.punch.profile, "shape", ())
    steepest = max((abs((z1 - z0) / (x1 - x0)) for (x0, z0), (x1, z1) in pairwise(points)), default=0.0)
    if steepest > _STEEP:
        yield (
            f"punch.shape: slopes are up to {steepest:.3g}, usual is less than {_STEEP:g}; are the units "
            "of both columns as meant? Without one they are m"
        )
    if points:
        yield from _rounded_off(scene.punch.profile, np.array([x for x, _ in points]))
