"""Does a scene make sense? Keys that contradict each other, and values that look unusual."""

from collections.abc import Iterator

import numpy as np

from galinx.app.scene.excerpt import listed
from galinx.app.scene.scene import Scene
from galinx.solvers.parameters import parameters, values

#: Usual lengths of a stroke [m].
_STROKE = (1e-10, 1.0)
#: Mean pressure over the shear modulus above which strains are far from small.
_PRESSED = 0.1


def contradictions(scene: Scene) -> list[str]:
    """Faults that no key has alone, one sentence each."""
    faults = []
    asked, solve = set(scene.output.quantities), scene.solve
    if scene.motion.c is not None and scene.motion.speed is not None:
        faults.append("motion: c and speed exclude each other; keep one")
    if scene.motion.c is None and scene.motion.speed is None:
        faults.append("motion: expected c (over the shear wave speed) or speed (m/s)")
    if asked - {"friction"} and not solve.methods:
        faults.append(
            "solve.methods is empty, but output.quantities asks for "
            f"{', '.join(sorted(asked - {'friction'}))}; name closed_form, fem or both"
        )
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
    fixed = solve.degree is not None
    if not fixed and solve.cuts != 1:
        faults.append(f"solve.cuts: found {solve.cuts} without solve.degree, which it needs")
    if fixed and solve.mode == "traction":
        faults.append('solve.degree needs solve.mode = "contact"')
    if solve.pressure != "closed_form" and solve.mode != "traction":
        faults.append('solve.pressure needs solve.mode = "traction"')
    return faults


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
    return [*found, *_too_much(scene)]


def _too_much(scene: Scene) -> Iterator[str]:
    """A load that no solid bears: that half-width and load fit one another, no key can tell alone."""
    mean = scene.body.stress
    if mean > _PRESSED * scene.solid.μ:
        yield (
            f"punch: the mean pressure N/(2a) = {mean:.3g} Pa is {mean / scene.solid.μ:.2g} times the "
            f"shear modulus, usual is less than {_PRESSED:g}; are load and half-width as meant?"
        )


def _usual(scene: Scene) -> Iterator[tuple[str, list[float], str, tuple[float, float]]]:
    """Numbers of a scene with their path, unit and where they usually lie."""
    yield "friction.pre_sliding", [scene.friction.pre_sliding], "m", _STROKE
    one = {"solid": scene.solid, "punch": scene.punch.profile}
    given = [
        *((name, parameters(model), values(model)) for name, model in one.items()),
        ("friction", parameters(scene.friction.law), scene.friction.parameters),
    ]
    for section, known, found in given:
        for key, parameter in known.items():
            if parameter.usual:
                numbers = np.atleast_1d(found[key]).tolist()
                yield f"{section}.{key}", numbers, parameter.unit, parameter.usual
