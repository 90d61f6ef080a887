"""Plan of a scene's work, derived from the outputs that the scene names.

:func:`make_plan` chooses methods and quantities. Checks refuse scenes whose outputs have no answer, and
warn where an answer costs accuracy. :func:`lines` are the plan's steps in words, with their sizes, and
:func:`expense` its memory and archive.
"""

import json
from bisect import bisect_left
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import replace
from math import inf, log2
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from galinx.meshes import MESHES, Requirements, store
from galinx.postprocess.quantities import QUANTITIES, Quantity, layers, stresses
from galinx.postprocess.quantities.quantity import (
    ALONE,
    FEM,
    LOCAL,
    SWEPT,
)
from galinx.postprocess.quantities.runs import SLIDER
from galinx.solvers.contact import FREE_ENDS, INTENSITIES, YIELD
from galinx.solvers.contact.contacts import contacts
from galinx.solvers.contact.edges import EdgeExponents
from galinx.solvers.contact.fem_plan import (
    BESIDES,
    DOLFINX,
    FITTED,
    FREE_ON_LAYERS,
    LADDERS,
    NEAR_FREE_END,
    OWN_MESHES,
    FemPlan,
    kind_of,
    largest_level,
    levels,
    no_nearer,
    pressure_moments,
    required_of_free_ends,
    required_of_pieces,
    required_over_layers,
    requirements,
    size_of,
    swept,
    unknowns,
    with_friction_kinks,
)
from galinx.solvers.contact.free_ends import SHAPES, slopes_of_shapes
from galinx.solvers.contact.solution import (
    FINITE,
    FLAT,
    FREE,
    GIVEN_ENDS,
    ONE_FREE,
    PRESCRIBED,
    SHARP,
    Contact,
    Places,
)
from galinx.solvers.contact.yielding_of_layers import places as yield_places
from galinx.solvers.errors import SolveError
from galinx.solvers.profiles import exponent
from galinx.solvers.rays import NEAR
from galinx.solvers.solids.half_plane import HalfPlane
from galinx.texts import bytes_in_words, counted

from .. import ranks
from ..errors import BadInput, listed
from ..methods import METHODS, OWN_METHODS, fem_mode
from ..scene.scene import FRICTIONS, Scene, oddities
from .over_time import starts
from .states import enumerate_states, order
from .task import CHUNK_NUMBERS, Plan, Tasks

#: Largest distance of points inside over that of walls, and over a for meshes without walls.
_INNER, _OUTERMOST = 0.6, 1e6

#: Most knots of a prescribed pressure over layers, and their least distance over a.
_KNOTS, _APART = 12, 0.02

#: Most sliders of a scene.
_SLIDERS = 200

#: Narrowest piece of a prescribed pressure, over a, within which positions have enough digits.
_NARROWEST = 1e-9


#: Bytes of a number of the states that are computed together, and of a number in an archive.
_HELD, _ARCHIVED = 18, 8
#: Bytes of an archive without results, and of a dataset without numbers.
_EMPTY, _DATASET = 7e4, 1.5e3
#: Bytes of a program without finite elements, of a state's friction, of the libraries of finite elements.
_PROGRAM, _FRICTION, _LIBRARIES = 130e6, 300.0, 170e6
#: Numbers of element matrices that are computed at once.
_AT_ONCE = 2e6


def free_memory() -> float:
    """Free memory [B] of this machine."""
    try:
        text = Path("/proc/meminfo").read_text(encoding="ascii")
    except OSError:  # not on Linux: ask for no more than any machine has
        return 2e9
    return 1024.0 * float(text.split("MemAvailable:")[1].split()[0])


def memory(unknowns: float, direct: bool) -> float:
    """Memory [B] of matrices, a factor or multigrid, and fields, on all ranks together.

    Measured at degree 2 with that many unknowns on the finest level; a fourth less at degree 8.
    """
    return unknowns * (980.0 + 48.0 * log2(max(unknowns, 2)) if direct else 1400.0)


def lacking(needed: float) -> str:
    """Memory [B] that is needed and free, for a message; "" where enough is free."""
    if needed <= (free := free_memory()):
        return ""
    return f"about {needed / 1e9:.2g} GB, of which this machine has {free / 1e9:.2g} GB free"


def check_size(body: Contact, methods: Collection[str]) -> None:
    """Check that floating-point numbers can hold stresses, strains and displacements.

    Raises:
        BadInput: one of them is too small or too large.
    """
    least, most = np.finfo(float).tiny, np.finfo(float).max
    magnitudes = (
        {"Pa": body.stress, "of the modulus": body.strain, "m": body.displacement} if methods else {}
    )
    if wrong := [f"{value:g} {unit}" for unit, value in magnitudes.items() if not least <= value <= most]:
        raise BadInput(
            f"punch: load {body.load:g} N/m on the half-width {body.half_width:g} m makes "
            f"{listed(wrong)}, expected numbers from {least:.0e} to {most:.0e}"
        )


def check_speeds(scene: Scene, speeds: tuple[float, ...], fem: bool) -> list[str]:
    """Warnings about speeds near or above the Rayleigh speed.

    Args:
        scene: the scene.
        speeds: over c_s.
        fem: True where finite elements solve the contact.

    Raises:
        BadInput: the form of finite elements is indefinite at a speed, or a wave inside the solid is not
            faster than the punch.
    """
    # All speeds above a limit are beyond it: of a million speeds some twenty are evaluated.
    ordered = sorted(speeds)
    first = bisect_left(ordered, True, key=lambda c: _margin(scene, c) <= 0.0)
    almost = bisect_left(ordered[:first], True, key=lambda c: _margin(scene, c / 0.99) <= 0.0)
    formal = bisect_left(ordered, True, lo=first, key=lambda c: _margin(scene, c) == -inf)
    near, beyond, none = (
        [f"{c:g}" for c in part] for part in (ordered[almost:first], ordered[first:], ordered[formal:])
    )
    c_R = scene.solid.limit() if beyond or near else 0.0
    name = "speed limit of the layers" if scene.layers else "Rayleigh speed"
    limit = f"the {name} c_R = {c_R:.6g} (over c_s), {c_R * scene.solid.c_s:.6g} m/s"
    if beyond and scene.elastic_punch:
        raise BadInput(
            f"motion: c = {listed(beyond)} is not below {limit}: a wave along the plate's surface is not "
            "faster than the contact; take lower speeds"
        )
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
    """Margin of the response at a speed over c_s; -∞ where a wave in the solid is not faster."""
    try:
        return scene.solid.response(c).margin
    except ValueError:
        return -inf


def check_states(states: int) -> None:
    """Check that memory holds the friction of all states.

    Raises:
        BadInput: it does not.
    """
    if lack := lacking(_FRICTION * states):
        raise BadInput(
            f"the scene's lists multiply to {states:.3g} states, whose friction needs {lack}: shorten "
            "them, or make several scenes"
        )


def check_sliders(scene: Scene) -> None:
    """Check the number of sliders of a scene.

    Raises:
        BadInput: a scene has more sliders than are followed.
    """
    count = scene.friction.count * len(scene.punch.loads)
    if SLIDER in scene.output.quantities and count > _SLIDERS:
        raise BadInput(
            f"the scene's lists multiply to {count} friction laws and loads, expected at most {_SLIDERS} "
            "with a slider each: shorten them, or make several scenes"
        )


def check_mode(scene: Scene, body: Contact) -> None:
    """Check that the mode "traction" has a pressure to prescribe.

    Raises:
        BadInput: the scene gives none, and the punch has none in closed form.
    """
    if scene.solve.mode == "traction" and not scene.solve.own_pressure and FLAT in body.lacks:
        raise BadInput(
            'solve.mode = "traction": found a punch that is not flat, whose pressure has no closed form; '
            'give solve.pressure, or take mode = "contact"'
        )


def check_free_ends(scene: Scene, body: Contact, methods: Collection[str]) -> None:
    """Check that a method computes the free ends of the contact.

    Raises:
        BadInput: none does, or the scene prescribes a pressure, which would need the ends.
    """
    if GIVEN_ENDS not in body.lacks:
        return
    about = f"found a {body.profile.words()}, {body.lacks[GIVEN_ENDS]}"
    if scene.solve.mode == "traction":
        raise BadInput(f'solve.mode = "traction": {about}; take mode = "contact", or a flat punch')
    if scene.solve.methods and not methods and set(scene.output.quantities) - FRICTIONS:
        raise BadInput(
            f"solve.methods: {about}; finite elements find the ends of all but parabolic and tilted flat "
            'punches on meshes of their own: take mesh = "confocal" without degree, or add "closed_form"'
        )


def check_layers(scene: Scene, body: Contact, methods: Collection[str]) -> None:
    """Check that the scene's outputs and methods can be computed over layers.

    Raises:
        BadInput: they cannot; the message lists all reasons.
    """
    if not scene.layers:
        return
    computed = {*FRICTIONS, INTENSITIES, stresses.ON_SURFACE, stresses.BELOW, layers.AT_INTERFACES, YIELD}
    faults = [
        f'output.quantities has "{word}"' for word in scene.output.quantities if word not in computed
    ]
    if YIELD in scene.output.quantities and YIELD in body.lacks:
        faults.append(f'output.quantities has "yield", and {body.lacks[YIELD]}')
    if scene.solve.mode == "traction" and not scene.solve.own_pressure:
        faults.append(
            'solve.mode is "traction" with the pressure of a closed form, which layers do not have'
        )
    if "fem" in scene.solve.methods:
        faults += _of_meshes(scene)
    if scene.solve.methods and not methods and set(scene.output.quantities) - FRICTIONS and not faults:
        about = f" with a {body.profile.words()}" * (GIVEN_ENDS in body.lacks)
        faults.append(f"solve.methods is {json.dumps(scene.solve.methods)}{about}")
    if faults:
        raise BadInput(
            f"layer: found layers, and {'; '.join(faults)}. Over layers methods = "
            '["sie"] solves all punches, ["fem"] those with two sharp edges, parabolas and other smooth '
            "ones, with the quantities friction, sif, surface, interior, interfaces and yield"
        )


def _of_meshes(scene: Scene) -> Iterator[str]:
    """Faults of keys that set the mesh or degree of a half-plane: layers have their own."""
    keys = {"mesh": (scene.solve.mesh, "confocal"), "degree": (scene.solve.degree, None)}
    for key, (value, default) in keys.items():
        if value != default:
            yield f"solve.{key} is {json.dumps(value)}, but layers have meshes and degrees of their own"


def check_pressure(scene: Scene, knots: Sequence[float]) -> None:
    """Check that finite elements can be loaded by a prescribed pressure with knots X/a.

    Raises:
        BadInput: they cannot.
    """
    if scene.layers:
        _check_knots(knots)
        return
    kind = MESHES[scene.solve.mesh]
    if kind.walls or not kind.rings:
        raise BadInput(
            f'solve.mesh: found "{scene.solve.mesh}" with a prescribed pressure, expected "confocal" or '
            '"graded": the mesh is scaled to the width of every piece of it, graded towards both ends, '
            "and has no walls"
        )
    if kind.chart.name != "confocal" and scene.solid.nearly_incompressible:
        raise BadInput(
            f'solve.mesh: found "{scene.solve.mesh}" with a prescribed pressure and '
            f'{scene.solid.words()}, expected "confocal" or ν <= 0.49: cells of its meshes for pieces '
            "differ so much in size that with an unknown pressure rounding spoils the matrix"
        )
    width = float(np.diff(knots).min())
    if width < _NARROWEST:
        raise BadInput(
            f"solve.pressure: found positions X/a that differ by {width:.3g}, expected at least "
            f'{_NARROWEST:g} with finite elements; leave one out, or take methods = ["closed_form"]'
        )


def _check_knots(knots: Sequence[float]) -> None:
    """Check that cells along interfaces can be graded towards all knots X/a of a pressure."""
    width = float(np.diff(knots).min())
    if len(knots) > _KNOTS or width < _APART:
        raise BadInput(
            f"solve.pressure: found {len(knots)} positions X/a, {width:.3g} apart at the least, expected "
            f"at most {_KNOTS}, {_APART:g} apart, with finite elements over layers, whose cells are "
            'graded towards each; take methods = ["sie"]'
        )


def check_places(scene: Scene, places: Places) -> None:
    """Check that finite elements can compute stresses at all points inside.

    Raises:
        BadInput: they cannot.
    """
    points = np.concatenate([places.points, places.around])
    if not len(points):
        return
    key = "output.points" if len(places.points) else "output.quantities"
    far = float(np.abs(points).max())
    limit = farthest_inside(scene)
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


def farthest_inside(scene: Scene) -> float:
    """Largest distance over a of fields inside from finite elements: well inside walls, if any."""
    walls = MESHES[scene.solve.mesh].walls
    return _INNER * walls if walls else _OUTERMOST


#: Most polynomials whose sum is the profile of a smooth punch under its contacts, and share of its slope
#: that is rounding.
_MOST_SHAPES, _ROUNDED = 48, 1e-13
#: Most unknowns of a speed that one rank solves faster than two ranks together.
SMALL = 200_000


#: Positions along the contact at which friction is sampled for its extremes.
_ACROSS = 201


def plan_fem(scene: Scene, responses: Sequence[HalfPlane], places: Places, g: NDArray) -> FemPlan:
    """Plan of the finite elements at the speeds of a scene; builds no mesh.

    Args:
        scene: the scene.
        responses: of its solid, one a speed.
        places: points where stresses are output.
        g: all values of σ_XY/σ_YY.

    Raises:
        BadInput: the weak form does not allow the scene's degree or solver.
    """
    solve, kind, name = scene.solve, MESHES[scene.solve.mesh], scene.solve.mesh
    mode = fem_mode(scene)
    if scene.layers:
        depths = scene.solid.depths / scene.body.half_width
        kind, name = kind_of(depths, responses, scene.body.knots or (-1.0, 1.0)), "layered"
    _check_degree_and_solver(scene)
    ratios = scene.body.ratio(g, np.linspace(-1.0, 1.0, _ACROSS))
    mixed, ends = scene.solid.nearly_incompressible, (float(ratios.min()), float(ratios.max()))
    exponent = min(
        -0.5 - abs(EdgeExponents(response, end).α + 0.5) for response in responses for end in ends
    )
    spread = max(response.spread for response in responses)
    planes = [response.contraction for response in responses]
    required = requirements(solve.tolerance, places, exponent, spread, planes)
    if required_of_kind := _REQUIRED.get((scene.body.ends, bool(scene.layers))):
        required = required_of_kind(required, scene, mode)
    refinement = kind.refinement(required)
    degrees = tuple(
        solve.degree or max(kind.degree(required, response.margin), 4 + mixed) for response in responses
    )
    largest = largest_level(max(degrees), solve.cuts, solve.degree is not None)
    drawn, kinks = kind.drawn(required), scene.body.friction_kinks
    if kinks:
        drawn = with_friction_kinks(refinement, kinks, solve.tolerance)
    size = unknowns(drawn, largest) if drawn else size_of(refinement, largest)
    shared = shares_speeds(size, len(responses))
    solver = solve.solver
    if mixed or solver == "auto":
        needed = memory(size, direct=True) * (ranks.size() if shared else 1)
        solver = "direct" if mixed or needed < 0.8 * free_memory() else "multigrid"
    return FemPlan(
        mesh=name, kind=kind, refinement=refinement, cuts=solve.cuts, form=scene.solid.form,
        assembler=solve.assembler, solver=solver, degrees=degrees, fixed=solve.degree is not None,
        wanted=required, mode=mode, shared_speeds=shared, sharp=exponent, drawn=drawn,
        tests=pressure_moments(scene.solid, kind, required),
        sweep=swept(solve.sweep, responses, g) if mode in FITTED else None,
        kinks=kinks, shapes=_shapes(scene, responses, g) if mode == FREE_ENDS else 0,
    )  # fmt: skip


#: Requirements on the mesh with those of the kind of contact, by its ends, without and with layers.
_REQUIRED: dict[tuple[str, bool], Callable[[Requirements, Scene, str], Requirements]] = {
    (SHARP, True): lambda required, scene, _: required_over_layers(required, scene.solid),
    (PRESCRIBED, False): lambda required, scene, _: required_of_pieces(
        required, np.array(scene.body.knots)
    ),
    # Next to knots stresses are continued.
    (PRESCRIBED, True): lambda required, *_: no_nearer(required, NEAR),
    # Kinks have meshes of their own; at sharp corners the singularity sets the degree.
    (FREE, False): lambda required, _, mode: replace(
        required_of_free_ends(required), bends=mode == FREE_ENDS
    ),
    (FREE, True): lambda required, *_: no_nearer(required, NEAR_FREE_END),
}


def _shapes(scene: Scene, responses: Sequence[HalfPlane], g: NDArray) -> int:
    """Number of polynomials whose sum is the profile of the punch under every contact.

    It depends on the widths of the contacts. The integral equation gives these at the slowest and the
    fastest speed, and at the least and the largest load and friction.
    """
    profile, most = scene.punch.profile, 0
    if scene.body.ends == ONE_FREE:
        return 1  # a tilted base
    if exponent(profile) == 2.0:
        return 2
    ends = [max(responses, key=lambda r: r.margin), min(responses, key=lambda r: r.margin)]
    loads = np.repeat([min(scene.punch.loads), max(scene.punch.loads)], 3)
    frictions = np.tile([g.min(), 0.0, g.max()], 2)
    for response in ends:
        try:
            solved = contacts(response, frictions, profile, loads / scene.solid.μ)
        except SolveError:
            return SHAPES  # finite elements report it where they solve the contact
        for m, h in zip(solved.of("centre").tolist(), solved.of("half_width").tolist()):
            size = np.abs(slopes_of_shapes(profile, m, h, 2 * _MOST_SHAPES))
            most = max(most, int(np.flatnonzero(size > _ROUNDED * size.max())[-1]) + 1)
    return int(np.clip(most, SHAPES, _MOST_SHAPES))


def shares_speeds(unknowns: int, speeds: int) -> bool:
    """True where ranks take whole speeds: small systems gain nothing from being cut in pieces."""
    return 1 < ranks.size() <= speeds and unknowns < SMALL


def _check_degree_and_solver(scene: Scene) -> None:
    solve, mixed = scene.solve, scene.solid.nearly_incompressible
    if mixed and solve.degree and solve.degree < 3:
        raise BadInput(
            f"solve.degree: found {solve.degree} with {scene.solid.words()}, expected at least 3: "
            "the pressure, an unknown of its own there, has two degrees less"
        )
    if mixed and solve.solver in ("boomeramg", "gamg"):
        raise BadInput(
            f"solve.solver: found {solve.solver} with {scene.solid.words()}, expected direct or auto: "
            "with an unknown pressure the matrix is indefinite"
        )


def check_assembler(scene: Scene) -> None:
    """Check that dolfinx's assembler serves the scene, where it is chosen.

    Raises:
        BadInput: the scene has a prescribed pressure or a motion in time.
    """
    if scene.solve.assembler != DOLFINX or FEM not in scene.solve.methods:
        return
    if scene.solve.own_pressure:
        raise BadInput(
            'solve.assembler: found "dolfinx" with a solve.pressure of your own, expected "tensor": its '
            "pieces are put together from the deformation of condensed cells"
        )
    if scene.time is not None:
        raise BadInput(
            'solve.assembler: found "dolfinx" with [time], expected "tensor": motions in time have '
            "matrices of their own"
        )


def warnings_of(fem: FemPlan) -> Iterator[str]:
    """Warnings where finite elements do not reach the tolerance, or do not fit into memory."""
    cut_off = fem.kind.truncation(fem.wanted)
    if cut_off > fem.tolerance:
        yield (
            f"the outer boundary of the {fem.mesh} mesh alone costs about {cut_off:.1g} (relative, with "
            f'friction), more than the tolerance {fem.tolerance:g}; use mesh = "confocal" or "graded"'
        )
    systems = ranks.size() if fem.shared_speeds else 1
    if lack := lacking(systems * memory(fem.size, fem.solver == "direct")):
        yield f"the finite elements need {lack}: use fewer cuts, a larger tolerance, or more machines"


def lines(scene: Scene, plan: Plan) -> list[str]:
    """The plan in words, one step a line."""
    law, integrator = scene.friction.law.about, scene.friction.integrator
    result = [f"friction: {counted(plan.states, 'state')}, {law}, integrator {integrator}"]
    if scene.slider:
        count = scene.friction.count * len(scene.punch.loads)
        result.append(f"slider: {counted(count, 'motion')} of {scene.slider.duration:g} s")
    if plan.starts:
        result += plan.starts.words(scene.solid)  # type: ignore[arg-type]
    for name in plan.methods:
        if name != FEM:
            result.append(f"{METHODS[name].about}: {counted(plan.states, 'state')}")
    if plan.fem:
        result += _fem_lines(scene, plan, plan.fem)
    if plan.asks(stresses.ON_SURFACE):
        result.append(f"stresses on the surface: {plan.states} x {len(plan.places.X)} points")
    if plan.asks(stresses.BELOW):
        result.append(f"stresses inside: {plan.states} x {len(plan.places.points)} points")
    return result


def _fem_lines(scene: Scene, plan: Plan, fem: FemPlan) -> list[str]:
    if fem.mode == OWN_MESHES:
        return [
            f"finite elements: {plan.different} states, each on a confocal mesh of its own, graded "
            f"towards the kinks of the punch, degree {max(fem.degrees)} or what the measured error "
            "requires; free ends are computed once for each speed"
        ]
    if fem.mode == FREE_ON_LAYERS:
        return [
            f"finite elements: {plan.different} states, each on meshes along the interfaces that follow "
            f"its contact until this carries the load, degree {max(fem.degrees)} or what the measured "
            "error requires"
        ]
    pattern = fem.pattern
    cells = len(pattern.cells) * fem.cuts**2
    result = [f"mesh: {fem.mesh}, {cells} quadrilaterals, shared by all speeds"]
    pressure = " and those of a pressure" * scene.solid.nearly_incompressible
    others = "one of a higher degree measures" if fem.fixed else "two of lower degree measure"
    by = ", assembled by dolfinx" * (fem.assembler == DOLFINX)
    solver = "one factorisation" if fem.solver == "direct" else f"conjugate gradients with {fem.solver}"
    speeds: dict[int, list[str]] = {}
    for task, degree in zip(plan.tasks, fem.degrees):
        speeds.setdefault(degree, []).append(f"{task.response.c:g}")
    if fem.sweep:
        c, degree = [task.response.c for task in plan.tasks], max(fem.degrees)
        result.append(
            f"finite elements at {len(set(c))} speeds, c = {min(c):g} to {max(c):g} (over c_s): degree "
            f"{degree}, {unknowns(pattern, fem.cuts * degree)} unknowns{pressure}{by}; so many are "
            f"solved as a fit needs to give the others, {LADDERS + BESIDES} or so; at each of these "
            f"{solver} serves all states, at {LADDERS} {others} its error"
        )
        speeds = {}
    result += [
        f"finite elements at c = {listed(c)} (over c_s): degree {degree}, "
        f"{unknowns(pattern, fem.cuts * degree)} unknowns{pressure}{by}; at each speed {solver} serves "
        f"all states, {others} its error"
        for degree, c in speeds.items()
    ]
    if ranks.size() > 1:
        how = "each takes whole speeds" if fem.shared_speeds else "together on one mesh"
        result.append(f"ranks: {ranks.size()}, {how}")
    return result


def expense(*plans: Plan) -> str:
    """Estimated memory of plans of all variants of a scene, and the size of their archive."""
    first = plans[0]
    datasets, positions = len(first.quantities), sum(map(len, first.positions.values()))
    numbers = sum(plan.states for plan in plans) * (first.numbers + datasets) + positions
    archive = _EMPTY + _DATASET * datasets + _ARCHIVED * numbers
    needed = bytes_in_words(max(map(_bytes, plans)), 2)
    return f"about {needed}{' a rank' * bool(first.fem)} and an archive of {bytes_in_words(archive, 2)}"


def _bytes(plan: Plan) -> float:
    """Estimated memory [B] of a plan, with finite elements of a rank."""
    together, fem = plan.chunk * plan.numbers, plan.fem
    if not fem:
        return _PROGRAM + _FRICTION * plan.states + _HELD * together
    degree = max(fem.degrees)
    finest = max(p * k for p, k in levels(degree, fem.cuts, fem.fixed))
    most = unknowns(fem.pattern, finest) / (1 if fem.shared_speeds else ranks.size())
    dense = 3 * 8 * max(_AT_ONCE, 16 * (2 * (degree + 1) ** 2) ** 2)
    of_levels = memory(most, fem.solver == "direct")
    return _LIBRARIES + of_levels + dense + _HELD * max(CHUNK_NUMBERS, together)


#: Descriptions of names in output.quantities, for a plan in words.
_PLACES = {
    stresses.ON_SURFACE: "stresses on the surface",
    stresses.BELOW: "stresses inside",
    YIELD: "yield",
}


def make_plan(
    scene: Scene,
    done: Callable[[int, int], None] = lambda laws, of: None,
    along: np.ndarray | None = None,
) -> Plan:
    """Plan of a scene's work; none of it is done yet but friction, where the plan depends on that.

    Args:
        scene: the scene, the first variant of one with swept numbers.
        done: called with the number of laws whose friction is computed, and with that of all laws.
        along: positions X/a along interfaces, (places,); None for those that suit the scene.

    Raises:
        BadInput: an output of the scene has no answer by the scene's methods.
    """
    states = order(scene)
    check_states(len(states))
    check_sliders(scene)
    body = scene.body
    methods = _methods(scene, body)
    for load in {min(states.loads), max(states.loads)}:
        check_size(body.loaded(load), methods)
    check_layers(scene, body, methods)
    check_free_ends(scene, body, methods)
    check_assembler(scene)
    around = yield_places(body) if YIELD in scene.output.quantities else np.empty((0, 2))
    points = np.reshape(scene.output.inside, (-1, 2))
    depths, positions = interface_grid(body)
    places = Places(surface_grid(), points, around, depths, positions if along is None else along)
    warnings = [*oddities(scene), *check_speeds(scene, states.speeds, "fem" in methods)]
    warnings += _left_out(scene, body, methods)
    friction = enumerate_states(scene, done) if "fem" in methods or scene.time else None
    fem = None
    if "fem" in methods:
        assert friction
        check_mode(scene, body)
        if scene.solve.own_pressure:
            check_pressure(scene, body.knots)
        check_places(scene, places)
        responses = [body.response(c) for c in states.speeds]
        fem = plan_fem(scene, responses, _output_places(scene, places), friction.g)
        warnings += warnings_of(fem)
    modes = (*scene.modes, *(SWEPT,) * bool(fem and fem.sweep), *(ALONE,) * (len(methods) == 1))
    quantities, refused = _quantities(scene, body, methods, modes)
    skipped = (*_skipped(scene, body, methods, fem, quantities), *refused)
    plan = Plan(
        body=body, places=places, methods=methods, quantities=quantities,
        tasks=Tasks(body, places, states), tolerance=scene.solve.tolerance,
        fem=fem, skipped=skipped, warnings=tuple(warnings),
        starts=starts(scene, friction) if friction else None, friction=friction,
    )  # fmt: skip
    if lack := lacking(_HELD * plan.chunk * plan.numbers):
        warnings.append(f"the stresses of a single state need {lack}: ask for fewer points")
    return replace(plan, warnings=tuple(warnings))


def _contact(scene: Scene) -> bool:
    """True where an output needs contact mechanics."""
    return bool(set(scene.output.quantities) - FRICTIONS)


def _output_places(scene: Scene, places: Places) -> Places:
    """Places at which finite elements output stresses, those along interfaces among the points inside."""
    surface, below = (word in scene.output.quantities for word in (stresses.ON_SURFACE, stresses.BELOW))
    X, points = places.X[: len(places.X) * surface], places.points[: len(places.points) * below]
    if {layers.AT_INTERFACES, YIELD} & {*scene.output.quantities} and len(places.along):
        X_along, depth = np.meshgrid(places.along, places.interfaces)
        points = np.concatenate([points, np.column_stack([X_along.ravel(), -depth.ravel()])])
    return Places(X, points, places.around)


def _methods(scene: Scene, body: Contact) -> tuple[str, ...]:
    """Methods that solve the contact; none where no output needs it."""
    if not _contact(scene):
        return ()
    names = dict.fromkeys(scene.solve.methods)
    return tuple(name for name in names if not METHODS[name].refusal(scene, body, None))


def _left_out(scene: Scene, body: Contact, methods: tuple[str, ...]) -> Iterator[str]:
    """Warnings about methods that the scene names, unless all, and that do not solve it."""
    if set(OWN_METHODS) <= set(scene.solve.methods):
        return
    for name in dict.fromkeys(scene.solve.methods if methods else ()):
        kind = METHODS[name]
        if name not in methods and (scene.layers or not kind.of_layers):
            yield f"solve.methods: {name} does not solve this: {kind.refusal(scene, body, None)}"


def _quantities(
    scene: Scene, body: Contact, methods: tuple[str, ...], modes: tuple[str, ...]
) -> tuple[tuple[Quantity, ...], list[str]]:
    """Quantities that are evaluated, and messages about those that a method cannot give."""
    computed: dict[str, Quantity] = {}
    refused = []
    # Quantities that are computed from others come after them, wherever they stand in the table.
    for path, quantity in sorted(QUANTITIES.items(), key=lambda row: row[1].of_data is not None):
        applies = (
            bool(methods)
            and quantity.solved
            and quantity.method in (*methods, LOCAL)
            and quantity.mode in modes
            and quantity.asked_by in ("", *scene.output.quantities)
            and all(need in computed for need in quantity.needs)
        )
        kind = METHODS.get(quantity.method)
        if applies and kind and (why := kind.refusal(scene, body, quantity)):
            refused.append(f"{path}: {why}")
        elif applies:
            computed[path] = quantity
    return tuple(computed.values()), refused


def _skipped(
    scene: Scene,
    body: Contact,
    methods: tuple[str, ...],
    fem: FemPlan | None,
    quantities: Iterable[Quantity],
) -> list[str]:
    """Messages about work that is not done, with the reason."""
    if not _contact(scene):
        if scene.time:
            return ["contact mechanics of steady motion: only friction and time are asked for"]
        return ["contact mechanics: only friction is asked for"]
    skipped = [
        f"{kind.about}: {kind.refusal(scene, body, None) or f'{name} is not in solve.methods'}"
        for name, kind in METHODS.items()
        if name not in methods and (scene.layers or not kind.of_layers)
    ]
    if fem and fem.cuts == 1 and store.is_kept(fem.pattern):
        skipped.append("gmsh: an earlier run made the same mesh")
    words = {quantity.asked_by for quantity in quantities}
    for word, what in _PLACES.items():
        if word not in words:
            skipped.append(f"{what}: not in output.quantities")
    if YIELD in words and FINITE not in body.modes:
        skipped.append(
            "largest von Mises and shear stress, load at first yield: stresses are infinite at the sharp "
            "edges of a punch, and any load makes these yield"
        )
    return skipped


def surface_grid() -> np.ndarray:
    """Positions X/a of archived surface stresses: to ±5, clustered at ±1, without ±1 itself."""
    near = np.geomspace(1e-6, 0.1, 31)
    inside = np.concatenate([1.0 - near, np.linspace(0.0, 0.88, 23)])
    outside = 1.0 + np.concatenate([near, np.geomspace(0.1, 4.0, 25)[1:]])
    right = np.concatenate([inside, outside])
    return np.unique(np.concatenate([-right, right]))


#: Least distance over a up to which stresses along interfaces are output; beyond it they only fall.
_FARTHEST = 40.0


def interface_grid(body: Contact, several: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Depths of interfaces over a, (interfaces,), and positions X/a along them, (places,).

    Positions are as fine below the edges as these are near, and reach so far that a largest stress behind
    the punch is among them.

    Args:
        body: punch and solid.
        several: depths over a, sorted, of all interfaces that the positions suit; None for the body's.
    """
    if not body.solid.layers:
        return np.empty(0), np.empty(0)
    depths = body.solid.depths / body.half_width if several is None else several
    near = np.outer(np.minimum(depths, 1.0), np.linspace(-4.0, 4.0, 65)).ravel()
    far = np.geomspace(5.0, max(_FARTHEST, 5.0 * depths[-1]), 49)
    X = np.concatenate([np.linspace(-5.0, 5.0, 161), near - 1.0, near + 1.0, -far, far])
    return depths, np.unique(np.round(X, 9))
