"""Sections of a scene: every key with its kind, default and meaning."""

from itertools import pairwise
from typing import Any

from galinx.app.methods import ASSEMBLERS, METHODS, MODES
from galinx.app.scene.keys import Key, ModelSection, Section
from galinx.app.scene.layers import LayerSections
from galinx.app.scene.materials import LIBRARY
from galinx.app.scene.numbers import Numbers
from galinx.app.scene.scene import Friction, HalfPlane, Motion, Output, Punch, Solve, Time
from galinx.app.scene.tables import Rows, Strokes
from galinx.app.scene.values import (
    Choice,
    Choices,
    Map,
    Number,
    OrAuto,
    Points,
    Pressure,
    Whole,
)
from galinx.meshes import MESHES
from galinx.postprocess.quantities import WORDS
from galinx.solvers.friction import LAWS, FrictionLaw
from galinx.solvers.friction.integrate import INTEGRATORS
from galinx.solvers.friction.slider import Slider
from galinx.solvers.parameters import Range, made
from galinx.solvers.profiles import PROFILES, Profile
from galinx.solvers.solids import SOLIDS, Solid

_POSITIVE = Range(above=0.0)
#: Times of a motion at which stresses along the surface are told, at most.
MOST_OUTPUTS = 400


def _solid(
    kind: type[Solid], values: dict[str, Any], material: str | None, yield_strength: float | None
) -> HalfPlane:
    return HalfPlane(made(kind, values), material, yield_strength)


def _punch(kind: type[Profile], values: dict[str, Any], load: tuple[float, ...]) -> Punch:
    return Punch(made(kind, values), tuple(dict.fromkeys(load)))


def _friction(
    law: type[FrictionLaw], values: dict[str, Any], sigma0: Any = None, **rest: Any
) -> Friction:
    """``sigma0`` is among the values already: the reader has divided it by the load."""
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
        Choice(LIBRARY), "name of a known solid, gives `kind`, constants and, of metals, yield_strength",
        None,
        "what is written beside it replaces the material's",
    ),
    "yield_strength": Key(
        Number("Pa", _POSITIVE), "uniaxial yield strength", None, 'for the quantity `"yield"`',
    ),
}  # fmt: skip

_PUNCH_KEYS = {
    "load": Key(
        Numbers("N/m", _POSITIVE), "normal load N per depth", (55.3e3,),
        "dimensionless results do not depend on it where the contact is that of a flat punch",
    ),
}  # fmt: skip

_FRICTION_KEYS = {
    "sigma0": Key(
        Numbers("N/m^2", _POSITIVE), "stiffness σ₀ per depth, instead of σ₀ l/N", None,
        "divided by punch.load it is `sigma0_over_load`. The study's σ₀ = 1.5922 N/µm and N = 55.3 N, "
        'both read per mm of depth, are `"1.5922 N/µm/mm"` and `"55.3 N/mm"`: 28 792 1/m for any depth',
        stands_for="sigma0_over_load",
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
        "a stroke `{to = 0.8}` goes on from where the one before ended; it may have a `speed` of its "
        "own, `rest` is the time at rest before it",
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
        Choices(METHODS, at_least=0), "what solves the contact", ("closed_form", "sie", "fem"),
        "an empty list where only friction is asked for",
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
        Choice(MODES), "pressure unknown or put in", "contact",
        '`"traction"`: pressure put in, see [Theory](theory.md)',
    ),
    "degree": Key(
        Whole(Range(at_least=1, at_most=12)), "polynomial degree, if not found by tolerance", None,
        without="found by tolerance",
    ),
    "cuts": Key(Whole(Range(at_least=1, at_most=256)), "cuts of every cell's sides", 1),
    "sweep": Key(
        Choice(("auto", "every")), "which of many speeds finite elements solve", "auto",
        '`"auto"`: from 16 speeds on as many as a fit through them needs to tell the others, see '
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
        Pressure(), "σ_YY of the traction mode", "closed_form",
        "for the mode traction; linear between the pairs, of any resultant",
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
        OrAuto(Number("", Range(at_least=1e-3, at_most=1.0))), "step of the finite elements over a/c_s",
        "auto", '`"auto"`: by solve.tolerance and load_ramp',
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
        Choice(("rest", "steady")), "what there is at t = 0", "rest",
        '`"steady"`: the steady motion of friction and load at t = 0',
    ),
    "friction": Key(
        Choice(("constant", "law")), "friction over time", "constant",
        '`"law"`: by the law along motion.strokes, one after the other; `"constant"`: that of each state',
    ),
    "every": Key(
        Number("", _POSITIVE), "time over a/c_s from one to the next at which the surface is looked at",
        None, "stresses along it then, and over time the energy near the punch and beyond",
        without="none",
    ),
}  # fmt: skip

_OUTPUT_KEYS = {
    "quantities": Key(
        Choices(WORDS), "what is asked for", ("friction", "sif", "surface"),
        "`sif`: K_I and exponents; `surface`: stresses on Y = 0; `interior`: inside; "
        "`yield`: where and at which load the solid yields; `slider`: stick-slip of [slider]; "
        "`interfaces`: where layers meet; `time`: from rest to steady motion, of [time]",
    ),
    "points": Key(
        Points(), "points inside, [X/a, Y/a]", (), 'needs the quantity `"interior"`; Y/a < 0'
    ),
    "map": Key(
        Map(), "points inside on a grid, over a", None, 'needs the quantity `"interior"`; Y/a < 0'
    ),
}  # fmt: skip

#: Sections of a scene, by name.
SECTIONS: dict[str, Any] = {
    "solid": ModelSection(
        "kind", "isotropic", SOLIDS, _solid, _SOLID_KEYS, or_else=", or solid.material"
    ),
    "layer": LayerSections(),
    "punch": ModelSection(
        "profile", "flat", PROFILES, _punch, _PUNCH_KEYS, defaults={"half_width": 1e-3}
    ),
    "friction": ModelSection("model", "dahl", LAWS, _friction, _FRICTION_KEYS, several=True),
    "motion": Section(Motion, _MOTION_KEYS),
    "slider": Section(_slider, _SLIDER_KEYS),
    "time": Section(_time, _TIME_KEYS),
    "solve": Section(Solve, _SOLVE_KEYS),
    "output": Section(Output, _OUTPUT_KEYS),
}
