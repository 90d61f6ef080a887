"""Where a scene asks for what has no answer, or for one that will cost accuracy."""

import json
from bisect import bisect_left
from collections.abc import Collection, Iterator
from math import inf

import numpy as np
from numpy.typing import NDArray

from galinx.app.errors import BadInput
from galinx.app.plan import cost
from galinx.app.plan.fem import FemPlan
from galinx.app.scene.excerpt import listed
from galinx.app.scene.scene import Scene
from galinx.app.scene.sense import FRICTIONS
from galinx.meshes import MESHES
from galinx.postprocess.quantities import strata as layers
from galinx.postprocess.quantities import stresses
from galinx.postprocess.quantities.quantity import FRICTION_ALONE, INTENSITIES
from galinx.solvers.solution import Body, Places

#: Share of the distance of walls up to which points inside are asked for; and distance over a up to which
#: meshes without walls reach.
_INNER, _OUTERMOST = 0.6, 1e6

#: Knots of a pressure over layers at most, and how near to one another, over a.
_KNOTS, _APART = 12, 0.02

#: Narrowest piece of a pressure, over a, within which positions have digits enough.
_NARROWEST = 1e-9


def check_size(body: Body, methods: Collection[str]) -> None:
    """Are stresses, strains and displacements numbers that a computer can hold?

    Raises:
        BadInput: one is not.
    """
    least, most = np.finfo(float).tiny, np.finfo(float).max
    told = {"Pa": body.stress, "of the modulus": body.strain, "m": body.displacement} if methods else {}
    if wrong := [f"{value:g} {unit}" for unit, value in told.items() if not least <= value <= most]:
        raise BadInput(
            f"punch: load {body.load:g} N/m on the half-width {body.half_width:g} m makes "
            f"{listed(wrong)}, expected numbers from {least:.0e} to {most:.0e}"
        )


def check_speeds(scene: Scene, speeds: tuple[float, ...], fem: bool) -> list[str]:
    """Warnings about speeds.

    Raises:
        BadInput: finite elements are asked for where their form is indefinite, or any solution where a
            wave in the solid is not faster.
    """
    # Beyond its limit a solid stays: of a million speeds some twenty are looked at.
    ordered = sorted(speeds)
    first = bisect_left(ordered, True, key=lambda c: _margin(scene, c) <= 0.0)
    almost = bisect_left(ordered[:first], True, key=lambda c: _margin(scene, c / 0.99) <= 0.0)
    formal = bisect_left(ordered, True, lo=first, key=lambda c: _margin(scene, c) == -inf)
    near, beyond, none = (
        [f"{c:g}" for c in some] for some in (ordered[almost:first], ordered[first:], ordered[formal:])
    )
    c_R = scene.solid.limit() if beyond or near else 0.0
    name = "speed limit of the layers" if scene.layers else "Rayleigh speed"
    limit = f"the {name} c_R = {c_R:.6g} (over c_s), {c_R * scene.solid.c_s:.6g} m/s"
    if beyond and scene.layers:
        raise BadInput(
            f"motion: c = {listed(beyond)} is not below {limit}: a wave along the layers is not faster "
            "than the punch; take lower speeds"
        )
    if fem and beyond:
        raise BadInput(
            f"motion: c = {listed(beyond)} is not below {limit}: the finite element form is indefinite "
            'there and does not converge; take lower speeds, or methods = ["closed_form"]'
        )
    if none:
        raise BadInput(
            f"motion: c = {listed(none)} is not below {limit}, and some wave inside the solid is not "
            "faster: nothing decays with depth there; take lower speeds"
        )
    warnings = []
    if beyond:
        warnings.append(f"c = {listed(beyond)} is not below {limit}: the closed form is formal there")
    if near:
        warnings.append(
            f"c = {listed(near)} is within 1 % of {limit}: displacements grow without bound and errors "
            "with them"
        )
    return warnings


def _margin(scene: Scene, c: float) -> float:
    """Of the response at a speed; minus infinity where a wave in the solid is not faster."""
    try:
        return scene.solid.response(c).margin
    except ValueError:
        return -inf


def check_states(states: int) -> None:
    """Is there room for the friction of all states?

    Raises:
        BadInput: there is none.
    """
    needed, free = cost.bytes_of_states(states), cost.free_memory()
    if needed > free:
        raise BadInput(
            f"the scene's lists multiply to {states:.3g} states, whose friction needs about "
            f"{needed / 1e9:.2g} GB, of which this machine has {free / 1e9:.2g} GB free: shorten them, "
            "or make several scenes"
        )


def check_mode(scene: Scene, body: Body) -> None:
    """Is there a pressure that could be put in?

    Raises:
        BadInput: there is none.
    """
    if scene.solve.mode == "traction" and not scene.solve.own_pressure and not body.flat:
        raise BadInput(
            'solve.mode = "traction": found a punch that is not flat, whose pressure has no closed form; '
            'give solve.pressure, or take mode = "contact"'
        )


def check_found(scene: Scene, body: Body, methods: Collection[str]) -> None:
    """Can anything find the ends of the contact?

    Raises:
        BadInput: nothing can, or a pressure is given that would need them.
    """
    if not body.found:
        return
    about = f"found a {body.profile.words()}, whose contact ends where the pressure says"
    if scene.solve.mode == "traction":
        raise BadInput(f'solve.mode = "traction": {about}; take mode = "contact", or a flat punch')
    if scene.solve.methods and not methods and set(scene.output.quantities) - {FRICTION_ALONE}:
        raise BadInput(
            f"solve.methods: {about}; finite elements find the ends of all but parabolic and tilted flat "
            'punches on meshes of their own: take mesh = "confocal" without degree, or add "closed_form"'
        )


def check_layers(scene: Scene, body: Body, methods: Collection[str]) -> None:
    """Is what is asked of layers known?

    Raises:
        BadInput: something is not; the message has all of it.
    """
    if not body.layered:
        return
    known = {*FRICTIONS, INTENSITIES, stresses.ON_SURFACE, stresses.BELOW, layers.AT_INTERFACES}
    faults = [f'output.quantities has "{word}"' for word in scene.output.quantities if word not in known]
    if scene.solve.mode == "traction" and not scene.solve.own_pressure:
        faults.append(
            'solve.mode is "traction" with the pressure of a closed form, which layers do not have'
        )
    if "fem" in scene.solve.methods:
        faults += _of_meshes(scene)
    if scene.solve.methods and not methods and set(scene.output.quantities) - FRICTIONS and not faults:
        about = f" with a {body.profile.words()}" * body.found
        faults.append(f"solve.methods is {json.dumps(scene.solve.methods)}{about}")
    if faults:
        raise BadInput(
            f"layer: found layers, and {'; '.join(faults)}. Known of layered solids are all "
            'punches by methods = ["sie"], those with two sharp edges, parabolas and other smooth ones '
            'by ["fem"] too, with the quantities friction, sif, surface, interior and interfaces'
        )


def _of_meshes(scene: Scene) -> Iterator[str]:
    """Keys that say how a half-plane's mesh is, of which layers have their own."""
    keys = {"mesh": (scene.solve.mesh, "confocal"), "degree": (scene.solve.degree, None)}
    for key, (value, default) in keys.items():
        if value != default:
            yield f"solve.{key} is {json.dumps(value)}, but layers have meshes and degrees of their own"


def check_pressure(scene: Scene, body: Body) -> None:
    """Can finite elements put in a pressure of the user's own?

    Raises:
        BadInput: they cannot.
    """
    if body.pressure is None:
        return
    if body.layered:
        _check_knots(body.pressure.knots)
        return
    kind = MESHES[scene.solve.mesh]
    if kind.walls or not kind.rings:
        raise BadInput(
            f'solve.mesh: found "{scene.solve.mesh}" with a pressure of your own, expected "confocal" or '
            '"graded": the mesh is scaled to the width of every piece of it, graded towards both ends, '
            "and has no walls"
        )
    if kind.chart.name != "confocal" and scene.solid.nearly_incompressible:
        raise BadInput(
            f'solve.mesh: found "{scene.solve.mesh}" with a pressure of your own and '
            f'{scene.solid.words()}, expected "confocal" or ν <= 0.49: cells of its meshes for pieces '
            "differ so much in size that with an unknown pressure rounding spoils the matrix"
        )
    width = float(np.diff(body.pressure.knots).min())
    if width < _NARROWEST:
        raise BadInput(
            f"solve.pressure: found positions X/a that differ by {width:.3g}, expected at least "
            f'{_NARROWEST:g} with finite elements; leave one out, or take methods = ["closed_form"]'
        )


def _check_knots(knots: NDArray) -> None:
    """Can cells along interfaces be graded towards all of them?"""
    width = float(np.diff(knots).min())
    if len(knots) > _KNOTS or width < _APART:
        raise BadInput(
            f"solve.pressure: found {len(knots)} positions X/a, {width:.3g} apart at the least, expected "
            f"at most {_KNOTS}, {_APART:g} apart, with finite elements over layers, whose cells are "
            'graded towards each; take methods = ["sie"]'
        )


def check_places(scene: Scene, places: Places) -> None:
    """Can finite elements tell the stresses inside there?

    Raises:
        BadInput: they cannot.
    """
    asked = np.concatenate([places.points, places.around])
    if not len(asked):
        return
    key = "output.points" if len(places.points) else "output.quantities"
    far = float(np.abs(asked).max())
    limit = inner(scene)
    if far > limit:
        raise BadInput(
            f"output.points: found a coordinate of {far:g} a, expected at most {limit:g} a with the "
            f"{scene.solve.mesh} mesh at the tolerance {scene.solve.tolerance:g}"
        )
    if scene.solid.nearly_incompressible:
        raise BadInput(
            f"{key}: found {scene.solid.words()}, expected ν <= 0.49 for stresses inside from "
            'finite elements; use methods = ["closed_form"]'
        )


def inner(scene: Scene) -> float:
    """Distance over a up to which finite elements tell fields inside: well inside walls, if there are."""
    walls = MESHES[scene.solve.mesh].walls
    return _INNER * walls if walls else _OUTERMOST


def warnings_of_size(numbers: int) -> Iterator[str]:
    """What does not fit into memory, of the numbers of the states that are treated together."""
    needed, free = cost.bytes_of_chunk(numbers), cost.free_memory()
    if needed > free:
        yield (
            f"the stresses of a single state need about {needed / 1e9:.2g} GB, of which this machine has "
            f"{free / 1e9:.2g} GB free: ask for fewer points"
        )


def warnings_of(fem: FemPlan) -> Iterator[str]:
    """What finite elements will not reach, or not fit into."""
    cut_off = fem.kind.truncation(fem.wanted)
    if cut_off > fem.tolerance:
        yield (
            f"the outer boundary of the {fem.mesh} mesh alone costs about {cut_off:.1g} (relative, with "
            f'friction), more than the tolerance {fem.tolerance:g}; use mesh = "confocal" or "graded"'
        )
    needed, free = fem.memory, cost.free_memory()
    if needed > free:
        yield (
            f"the finite elements need about {needed / 1e9:.2g} GB, of which this machine has "
            f"{free / 1e9:.2g} GB free: use fewer cuts, a larger tolerance, or more machines"
        )
