"""Does a scene make sense? Keys that contradict each other, and values that look unusual."""

from collections.abc import Iterator

import numpy as np

from galinx.app.scene.excerpt import listed
from galinx.app.scene.scene import Scene
from galinx.postprocess.quantities.over_time import TIME
from galinx.postprocess.quantities.quantity import FRICTION_ALONE
from galinx.postprocess.quantities.slider import SLIDER
from galinx.postprocess.quantities.strata import AT_INTERFACES
from galinx.solvers.parameters import parameters, values

#: Words of output.quantities that need no contact.
FRICTIONS = frozenset({FRICTION_ALONE, SLIDER, TIME})
#: Usual lengths of a stroke [m].
_STROKE = (1e-10, 1.0)
#: Mean pressure over the shear modulus above which strains are far from small.
_PRESSED = 0.1
#: Half-width [m] of a contact below which a solid is no continuum: a few atoms.
_ATOMS = 1e-9


def contradictions(scene: Scene) -> list[str]:
    """Faults that no key has alone, one sentence each."""
    faults: list[str] = []
    asked, solve = set(scene.output.quantities), scene.solve
    faults += _of_motion(scene)
    if (contact := sorted(asked - FRICTIONS)) and not solve.methods:
        faults.append(
            f"solve.methods is empty, but output.quantities asks for {', '.join(contact)}; name "
            "closed_form, fem or both"
        )
    if (SLIDER in asked) != (scene.slider is not None):
        faults.append(
            'slider: the quantity "slider" and the section [slider] go together, with mass, stiffness, '
            "drive_speed and duration"
        )
    if (TIME in asked) != (scene.time is not None):
        faults.append('time: the quantity "time" and the section [time] go together, with end')
    if ("interior" in asked) != bool(scene.output.points or scene.output.map):
        faults.append(
            'output: the quantity "interior" and output.points or output.map go together, as in points = '
            "[[0.0, -0.5], [1.0, -0.5]] or map = { X = [-2, 2, 81], Y = [-2, -0.05, 40] } (over a: from, "
            "to, number)"
        )
    if "yield" in asked and scene.half_plane.yield_strength is None:
        faults.append(
            'output.quantities asks for "yield": expected solid.yield_strength, as in yield_strength = '
            '"205 MPa", or a material that has one'
        )
    if "yield" in asked and not scene.solid.knows_σ_ZZ:
        faults.append(
            'output.quantities asks for "yield": expected solid.stiffness_Z = [c13, c23, c36], '
            "without which σ_ZZ is not known in plane strain"
        )
    if AT_INTERFACES in asked and not scene.layers:
        faults.append(
            'output.quantities asks for "interfaces": expected [[layer]], whose lower faces these are'
        )
    fixed = solve.degree is not None
    if not fixed and solve.cuts != 1:
        faults.append(f"solve.cuts: found {solve.cuts} without solve.degree, which it needs")
    if fixed and solve.mode == "traction":
        faults.append('solve.degree needs solve.mode = "contact"')
    if solve.pressure != "closed_form" and solve.mode != "traction":
        faults.append('solve.pressure needs solve.mode = "traction"')
    return faults


def _of_motion(scene: Scene) -> Iterator[str]:
    motion, c_s = scene.motion, scene.solid.c_s
    if motion.c is not None and motion.speed is not None:
        yield "motion: c and speed exclude each other; keep one"
    elif motion.path is not None and (motion.c is not None or motion.speed is not None):
        yield "motion: path tells the speed, too; take c and speed away"
    elif motion.path is None and motion.c is None and motion.speed is None:
        yield "motion: expected c (over the shear wave speed) or speed (m/s)"
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
    """What looks unusual, one sentence a key: the unit may be another than meant."""
    found = []
    for path, numbers, unit, (low, high) in _usual(scene):
        odd = [f"{value:g}" for value in numbers if not low <= value <= high]
        known, usual = f" {unit}" * bool(unit), f"usual is {low:g} to {high:g}"
        if len(odd) == 1:
            found.append(f"{path} = {odd[0]}{known} is unusual, {usual}; is its unit as meant?")
        elif odd:
            found.append(f"{path} = {listed(odd)}{known} are unusual, {usual}; is their unit as meant?")
    return [*found, *_too_much(scene), *_too_small(scene)]


def _too_much(scene: Scene) -> Iterator[str]:
    """A load that no solid bears: that half-width and load fit one another, no key can tell alone."""
    loads = scene.punch.loads
    mean = scene.body.loaded(max(loads)).stress
    if mean > _PRESSED * scene.solid.μ:
        of_load = f" at N = {max(loads):g} N/m" * (len(loads) > 1)
        yield (
            f"punch: the mean pressure N/(2a) = {mean:.3g} Pa{of_load} is {mean / scene.solid.μ:.2g} "
            f"times the shear modulus, usual is less than {_PRESSED:g}; are load and half-width as meant?"
        )


def _too_small(scene: Scene) -> Iterator[str]:
    """A contact of a few atoms; given half-widths are told of by their key."""
    if not scene.body.free:
        return
    load = min(scene.punch.loads)
    a = scene.body.loaded(load).half_width
    if a < _ATOMS:
        yield (
            f"punch: under the load {load:g} N/m the half-width of the contact at rest is {a:.2g} m, "
            f"usual is at least {_ATOMS:g} m: that is no more than a few atoms, where a solid is no "
            "continuum; is the load as meant?"
        )


def _usual(scene: Scene) -> Iterator[tuple[str, list[float], str, tuple[float, float]]]:
    """Numbers of a scene with their path, unit and where they usually lie."""
    yield "friction.pre_sliding", [scene.friction.pre_sliding], "m", _STROKE
    one = {"solid": scene.solid, "punch": scene.punch.profile}
    given = [
        *((name, parameters(model), values(model)) for name, model in one.items()),
        ("friction", parameters(scene.friction.law), scene.friction.values),
    ]
    for section, known, found in given:
        for key, parameter in known.items():
            if parameter.usual:
                numbers = np.atleast_1d(found[key]).tolist()
                yield f"{section}.{key}", numbers, parameter.unit, parameter.usual
