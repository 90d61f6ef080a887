"""Plan of a scene's work, derived from the outputs that the scene names.

:func:`make_plan` chooses methods and quantities, refuses scenes whose outputs have no answer, and warns
where an answer costs accuracy. :func:`lines` are the plan's steps in words, with their sizes, and
:func:`expense` the memory that grows with them.
"""

import json
from bisect import bisect_left
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from galinx.meshes import MESHES
from galinx.postprocess.compare import RULES
from galinx.postprocess.quantities import QUANTITIES, Quantity, layers, stresses
from galinx.postprocess.quantities.quantity import (
    ALONE,
    ALONG,
    FEM,
    INSIDE,
    INTERFACE,
    LAYER,
    LOCAL,
    POINT,
    SIE,
    SWEPT,
)
from galinx.postprocess.quantities.runs import SLIDER
from galinx.postprocess.quantities.states import RATIO
from galinx.solvers.contact import AT_INTERFACES, INTENSITIES, YIELD
from galinx.solvers.contact.fem_plan import (
    BESIDES,
    DOLFINX,
    FREE_ON_LAYERS,
    LADDERS,
    OWN_MESHES,
    OWN_MESHES_KEPT,
    FemPlan,
    unknowns,
)
from galinx.solvers.contact.solution import FINITE, GIVEN_ENDS, SOLVED, Contact, Places, Task
from galinx.solvers.contact.stresses import distances
from galinx.solvers.errors import SolveError
from galinx.solvers.profiles import check_slope
from galinx.texts import bytes_in_words, counted

from .. import ranks
from ..errors import BadInput, listed
from ..methods import METHODS, OWN_METHODS
from ..scene.scene import FRICTIONS, Scene, oddities
from ..scene.sections import keys_set
from . import elements
from .over_time import Starts, starts
from .states import Order, States, enumerate_states, order, overtaken

#: Most floating-point numbers that the states of a chunk hold at once, and bytes of each while they are
#: computed.
CHUNK_NUMBERS, _HELD = 1_200_000, 18
#: Bytes of a state's friction.
FRICTION = 300.0
#: Least and largest floating-point number.
_LEAST, _MOST = np.finfo(float).tiny, np.finfo(float).max
#: Width of a contact at rest without friction over that to which the punch is known, from which on no
#: friction or speed makes it fit.
_WIDER = 1.25
#: Most sliders of a scene.
_SLIDERS = 200


@dataclass(frozen=True)
class Plan:
    """Plan of the work of a scene without swept numbers, or of a variant of one with some.

    Attributes:
        scene: the scene, or the variant.
        done: called with the number of laws whose friction is computed, and with that of all laws.
        followed: friction of all its states, None where nothing of the plan depends on it.
        places: points where stresses are output.
        methods: names of the methods that solve the contact, none for friction alone.
        quantities: evaluated from their solutions, in the order of the table.
        order: of its states.
        fem: plan of the finite elements, None without.
        starts: motions in time, None for none.
        skipped: messages about work that is not done, with the reason.
        warnings: messages to the user before the work starts.
        first: row of its first state in the archive.
        speed: number of its first speed in the archive's record.
    """

    scene: Scene
    done: Callable[[int, int], None]
    followed: States | None
    places: Places
    methods: tuple[str, ...]
    quantities: tuple[Quantity, ...]
    order: Order
    fem: FemPlan | None
    starts: Starts | None
    skipped: tuple[str, ...]
    warnings: tuple[str, ...]
    first: int = 0
    speed: int = 0

    @property
    def body(self) -> Contact:
        """Contact of punch and solid, under the first of the loads."""
        return self.scene.body

    @property
    def tolerance(self) -> float:
        """Relative accuracy to reach."""
        return self.scene.solve.tolerance

    @property
    def states(self) -> int:
        """Number of states."""
        return len(self.order)

    @property
    def tasks(self) -> Iterator[Task]:
        """One a speed, each made when it is its turn: there may be a million."""
        for i, (c, runs) in enumerate(zip(self.order.speeds, self.order.runs(self.first))):
            yield Task(i, self.body, self.body.response(c), self.places, runs, self.order.loads)

    @cached_property
    def friction(self) -> States:
        """Friction of all its states."""
        return self.followed or enumerate_states(self.scene, self.done)

    @property
    def rows(self) -> slice:
        """Rows of its states in the archive."""
        return slice(self.first, self.first + self.states)

    @property
    def shared(self) -> bool:
        """True where several ranks work on the same solution."""
        return self.fem is not None or self.starts is not None

    def asks(self, word: str, method: str = "") -> bool:
        """True where a quantity of this name in output.quantities is computed, by a method or by any."""
        return any(
            quantity.asked_by == word and method in ("", quantity.method) for quantity in self.quantities
        )

    @property
    def positions(self) -> dict[str, NDArray]:
        """Datasets of the positions of archived stresses, by path."""
        datasets = {}
        if self.asks(stresses.ON_SURFACE):
            datasets[stresses.SURFACE_X.path] = self.places.X
        if self.asks(stresses.BELOW):
            X, Y = self.places.points.T
            datasets |= {stresses.INSIDE_X.path: X, stresses.INSIDE_Y.path: Y}
            if grid := self.scene.output.map:
                datasets[stresses.MAP.path] = np.array([count for *_, count in reversed(grid)])
        if self.asks(layers.AT_INTERFACES):
            unit, depths = self.body.depths
            datasets[layers.DEPTHS[unit].path] = depths
            datasets[layers.ALONG_X.path] = self.places.along
        return datasets

    @cached_property
    def rules(self) -> frozenset[str]:
        """Names of the rules by which computed quantities are compared: those that have all they need.

        A prescribed pressure is compared with its own exact solution: it need not carry the load.
        """
        computed = {row.path for row in self.quantities} | {RATIO.path, *self.positions}
        own = SOLVED in self.body.lacks
        in_time = self.starts.rules if self.starts else frozenset()
        return in_time | {
            name for name, rule in RULES.items()
            if {row.path for row in rule.needs} <= computed and (rule.own_pressure or not own)
        }  # fmt: skip

    def shape(self, quantity: Quantity) -> tuple[int, ...]:
        """Shape of a quantity of one state."""
        sizes = {
            POINT: len(self.places.X), INSIDE: len(self.places.points),
            INTERFACE: len(self.places.interfaces), ALONG: len(self.places.along),
            LAYER: len(self.places.interfaces) + 1,
        }  # fmt: skip
        return tuple(sizes[dimension] for dimension in quantity.over[1:])

    @cached_property
    def chunk(self) -> int:
        """Number of states that are computed at once, which bounds their memory."""
        own_meshes = self.fem is not None and self.fem.mode in (FREE_ON_LAYERS, OWN_MESHES)
        most = OWN_MESHES_KEPT if own_meshes else 1000
        return int(np.clip(CHUNK_NUMBERS // max(self.numbers, 1), 1, most))

    @property
    def numbers(self) -> int:
        """Number of floating-point numbers of a state that methods give or evaluate."""
        around = 3 * len(self.places.around)
        return around + sum(int(np.prod(self.shape(quantity))) for quantity in self.quantities)


def _faults(
    scene: Scene, methods: Collection[str], places: Places, refusals: dict[str, str]
) -> Iterator[str]:
    """Faults of outputs without an answer by the scene's methods, one sentence each.

    Args:
        scene: the scene.
        methods: that solve the contact.
        places: points where stresses are output.
        refusals: of the methods that the scene names for outputs that need contact mechanics, with the
            reasons why they do not solve it, "" for those that do.
    """
    states, solve, body = order(scene), scene.solve, scene.body
    sliders = scene.friction.count * len(states.loads)
    if SLIDER in scene.output.quantities and sliders > _SLIDERS:
        yield (
            f"the scene's lists multiply to {sliders} friction laws and loads, expected at most "
            f"{_SLIDERS} with a slider each: shorten them, or make several scenes"
        )
    for load in sorted({body.load, min(states.loads), max(states.loads)}) if methods else ():
        at_load = body.loaded(load)
        try:
            half_width = float(at_load.half_width)
        except SolveError as error:
            if load == body.load:  # results are in units of this contact; methods report others
                yield f"punch.load: found {load:g} N/m: {error}"
            continue
        first, last = getattr(body.profile, "reach", (-np.inf, np.inf))
        if load == min(states.loads) and 2.0 * half_width > _WIDER * (last - first):
            wide = f"the contact would be {2.0 * half_width:g} m wide at rest"
            yield (
                f"punch.load: found {load:g} N/m: {wide}, but the punch is known over {last - first:g} m "
                "only; give more of its shape, or a smaller load"
            )
        if load == body.load:
            try:
                check_slope(body.profile, half_width)
            except ValueError as error:
                yield f"punch: {error}"
        magnitudes = {"Pa": at_load.stress, "of the modulus": at_load.strain, "m": at_load.displacement}
        if wrong := [f"{x:g} {unit}" for unit, x in magnitudes.items() if not _LEAST <= x <= _MOST]:
            yield (
                f"punch: load {load:g} N/m on the half-width {at_load.half_width:g} m makes "
                f"{listed(wrong)}, expected numbers from {_LEAST:.0e} to {_MOST:.0e}"
            )
    if scene.layers:
        yield from _faults_of_layers(scene)
        if SIE in methods and (shallow := float(-places.points[:, 1].max(initial=-1.0))) < _SHALLOWEST:
            yield (
                f"output.points: found a point {shallow:g} a below the surface of layers, expected at "
                f"least {_SHALLOWEST:g} a with sie, whose quadrature is as fine; on the surface itself "
                'output.quantities = ["surface"] has stresses'
            )
    if GIVEN_ENDS in body.lacks:
        about = f"found a {body.profile.words()}, {body.lacks[GIVEN_ENDS]}"
        if solve.mode == "traction":
            yield f'solve.mode = "traction": {about}; take mode = "contact", or a flat punch'
    if refusals and not methods:
        reasons = "; ".join(f"{name}: {why}" for name, why in refusals.items())
        yield f"solve.methods: none of them solves this contact: {reasons}"
    if FEM in solve.methods and solve.assembler == DOLFINX and solve.own_pressure:
        yield (
            'solve.assembler: found "dolfinx" with a solve.pressure of your own, expected "tensor": '
            "its pieces are put together from the deformation of condensed cells"
        )
    if FEM in solve.methods and scene.time is not None:
        # Those of steady motion may have a mesh.
        keys = ("assembler",) if FEM in methods else ("mesh", "degree", "solver", "assembler")
        values = keys_set(solve, keys).items()
        if wrong := [f"solve.{key} = {json.dumps(of)}" for key, of in values if of != "direct"]:
            yield (
                f"time: found {' and '.join(wrong)}, but motions in time have meshes, degrees and "
                "matrices of their own; take that away"
            )
    if methods and FEM not in methods and MESHES[solve.mesh].walls:
        why = f", and {refusals[FEM]}" if refusals.get(FEM) else ""
        yield (
            f'solve.mesh: found "{solve.mesh}", whose walls finite elements alone have, and they do not '
            f"solve this contact{why}; take the mesh away{'' if why else ', or add fem to solve.methods'}"
        )
    if FEM in methods and solve.mode == "traction" and solve.solver not in ("auto", "direct"):
        yield (
            f'solve.solver: found "{solve.solver}" with mode = "traction", where one factorisation '
            'solves all; expected "direct"'
        )
    if FEM in methods:
        yield from elements.faults(scene, places, alone={*methods} == {FEM})


#: Keys of [solve] that finite elements alone follow.
_OF_ELEMENTS = ("mesh", "degree", "cuts", "sweep", "solver", "assembler")


#: Least depth over a of points inside layers by the integral equation: memory goes as its inverse.
_SHALLOWEST = 1e-4


def _faults_of_layers(scene: Scene) -> Iterator[str]:
    """Fault of outputs that are not computed over layers, with all reasons."""
    solve, body = scene.solve, scene.body
    computed = {*FRICTIONS, INTENSITIES, stresses.ON_SURFACE, stresses.BELOW, layers.AT_INTERFACES, YIELD}
    reasons = [
        f'output.quantities has "{word}"' for word in scene.output.quantities if word not in computed
    ]
    if YIELD in scene.output.quantities and YIELD in body.lacks:
        reasons.append(f'output.quantities has "yield", and {body.lacks[YIELD]}')
    if solve.mode == "traction" and not solve.own_pressure:
        reasons.append(
            'solve.mode is "traction" with the pressure of a closed form, which layers do not have'
        )
    reasons += [
        f"solve.{key} is {json.dumps(value)}, but layers have meshes and degrees of their own"
        for key, value in keys_set(solve, ("mesh", "degree") if FEM in solve.methods else ()).items()
    ]
    if reasons:
        yield (
            f"layer: found layers, and {'; '.join(reasons)}. Over layers sie and fem solve all punches, "
            "with the quantities friction, sif, surface, interior, interfaces and yield"
        )


def _overtaken(scene: Scene, speeds: Sequence[float]) -> Iterator[str]:
    """Warning where a punch rolls so fast that it slips backward."""
    punch, friction = scene.elastic_punch, scene.friction
    turned, none = friction.stress_ratio > 0.0, not np.any(friction.values.get("mu_c", 1.0))
    if punch is None or turned or none:
        return
    if overtaken(scene, least := min(speeds)):
        least *= scene.solid.c_s
        yield (
            f"punch.solid.speed = {punch.speed:g} m/s is above the speed over the plate, {least:g} m/s: "
            'slip is backward, and friction is that of forward slip; friction.sign = "eq25" turns it'
        )


def _near_limit(scene: Scene, speeds: tuple[float, ...], fem: bool) -> list[str]:
    """Warnings about speeds over c_s near or above the Rayleigh speed.

    Args:
        scene: the scene.
        speeds: over c_s.
        fem: True where finite elements solve the contact.

    Raises:
        BadInput: the form of finite elements is indefinite at a speed, or a wave inside the solid is not
            faster than the punch.
    """
    c_R = scene.solid.limit()
    near = listed([f"{c:g}" for c in sorted(speeds) if 0.99 * c_R <= c < c_R])
    above = [c for c in sorted(speeds) if c >= c_R]
    beyond = listed([f"{c:g}" for c in above])
    name = "speed limit of the layers" if scene.layers else "Rayleigh speed"
    limit = f"the {name} c_R = {c_R:.6g} (over c_s), {c_R * scene.solid.c_s:.6g} m/s"
    reason = ""
    if scene.elastic_punch:
        reason = "a wave along the plate's surface is not faster than the contact; take lower speeds"
    elif scene.layers:
        reason = "a wave along the layers is not faster than the punch; take lower speeds"
    elif scene.between_free_ends:
        if fem or len(above) == len(speeds):  # by formulas others of a sweep have their answers
            reason = "between free ends nothing holds the punch up there; take lower speeds"
    elif fem:
        reason = (
            "the finite element form is indefinite there and does not converge; take lower speeds, or "
            'methods = ["closed_form"]'
        )
    if beyond and reason:
        raise BadInput(f"motion: c = {beyond} is not below {limit}: {reason}")

    def formless(c: float) -> bool:
        """True where a wave in the solid is not faster."""
        with suppress(ValueError):
            return not scene.solid.response(c)
        return True

    # Of a million speeds some twenty are evaluated.
    if none := [f"{c:g}" for c in above[bisect_left(above, True, key=formless) :]]:
        raise BadInput(
            f"motion: c = {listed(none)} is not below {limit}, and some wave inside the solid is not "
            "faster: nothing decays with depth there; take lower speeds"
        )
    warnings = []
    if beyond:
        warnings.append(f"c = {beyond} is not below {limit}: the closed form is formal there")
    if near:
        warnings.append(
            f"c = {near} is within 1 % of {limit}: displacements grow without bound and errors with them"
        )
    return warnings


def lines(plan: Plan) -> list[str]:
    """The plan in words, one step a line."""
    scene = plan.scene
    law, integrator = scene.friction.law.about, scene.friction.integrator
    result = [f"friction: {counted(plan.states, 'state')}, {law}, integrator {integrator}"]
    if scene.slider:
        count = scene.friction.count * len(scene.punch.loads)
        result.append(f"slider: {counted(count, 'motion')} of {scene.slider.duration:g} s")
    if plan.starts:
        result += plan.starts.words()
    for name in plan.methods:
        if name != FEM:
            result.append(f"{METHODS[name].about}: {counted(plan.states, 'state')}")
    if plan.fem:
        result += _fem_lines(plan, plan.fem)
    if plan.asks(stresses.ON_SURFACE):
        result.append(f"stresses on the surface: {plan.states} x {len(plan.places.X)} points")
    if plan.asks(stresses.BELOW):
        result.append(f"stresses inside: {plan.states} x {len(plan.places.points)} points")
    return result


def _fem_lines(plan: Plan, fem: FemPlan) -> list[str]:
    loads = plan.order.loads  # contacts that are similar under all of them are solved once
    solved = plan.states // (len(loads) if plan.body.alike else 1)
    if fem.mode == OWN_MESHES:
        return [
            f"finite elements: {counted(solved, 'state')}, each on a confocal mesh of its own, graded "
            f"towards the kinks of the punch, degree {max(fem.degrees)} or what the measured error "
            "requires; free ends are computed once for each speed"
        ]
    if fem.mode == FREE_ON_LAYERS:
        return [
            f"finite elements: {counted(solved, 'state')}, each on meshes along the interfaces that "
            f"follow its contact until this carries the load, degree {max(fem.degrees)} or what the "
            "measured error requires"
        ]
    pattern = fem.pattern
    cells = len(pattern.cells) * fem.cuts**2
    result = [f"mesh: {fem.mesh}, {cells} quadrilaterals, shared by all speeds"]
    pressure = " and those of a pressure" * plan.scene.solid.nearly_incompressible
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
            f"solved as a fit needs to give the others, {LADDERS + BESIDES} or so, or each where none is "
            f"good enough; at each of these {solver} serves all states, at {LADDERS} {others} its error"
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
    """Estimated memory of plans of all variants of a scene, and the numbers that they archive, in words.

    Memory is that of matrices and stresses, with finite elements of a rank; programs and libraries take
    as much as they take on the machine.
    """
    first = plans[0]
    numbers = sum(plan.states for plan in plans) * (first.numbers + len(first.quantities))
    if not numbers:
        return "little memory beside the programs, small results"
    archived = bytes_in_words(8.0 * (numbers + sum(map(len, first.positions.values()))), 2)
    needed = bytes_in_words(max(map(_bytes, plans)), 2)
    return f"about {needed}{' a rank' * bool(first.fem)} beside the programs, results of {archived}"


def by_reason(skipped: Iterable[str]) -> list[str]:
    """Messages about work that is not done, one for each reason."""
    reasons: dict[str, dict[str, None]] = {}
    for what, _, reason in (text.partition(": ") for text in skipped):
        name = what.rpartition("/")[2] if "/" in what else what
        reasons.setdefault(reason, {})[name] = None
    return [f"{', '.join(names)}: {reason}" for reason, names in reasons.items()]


def _bytes(plan: Plan) -> float:
    """Estimated memory [B] of a plan's matrices and stresses, with finite elements of a rank."""
    held, fem = _HELD * plan.chunk * plan.numbers, plan.fem
    if not fem:
        return held + FRICTION * plan.states
    most = fem.size / (1 if fem.shared_speeds else ranks.size())
    return held + elements.memory(most, fem.solver == "direct")


#: Descriptions of names in output.quantities, for a plan in words.
_PLACES = {
    stresses.ON_SURFACE: "stresses on the surface",
    stresses.BELOW: "stresses inside",
    YIELD: "yield",
}


def make_plan(
    scene: Scene,
    done: Callable[[int, int], None] = lambda laws, of: None,
    at: tuple[np.ndarray, np.ndarray] | None = None,
    first: tuple[int, int] = (0, 0),
) -> Plan:
    """Plan of a scene's work; none of it is done yet but friction, where the plan depends on that.

    Args:
        scene: the scene, the first variant of one with swept numbers.
        done: called with the number of laws whose friction is computed, and with that of all laws.
        at: positions X/a on the surface and along interfaces; None for those that suit the scene.
        first: numbers of its first state and of its first speed in the archive.

    Raises:
        BadInput: an output of the scene has no answer by the scene's methods.
    """
    order_, body = order(scene), scene.body
    contact = bool(set(scene.output.quantities) - FRICTIONS)  # an output needs contact mechanics
    refusals = {name: kind.refusal(scene, body, None) for name, kind in METHODS.items()}
    named = dict.fromkeys(scene.solve.methods) if contact else {}
    methods = tuple(name for name in named if not refusals[name])
    around = body.yield_places if YIELD in scene.output.quantities else np.empty((0, 2))
    points = np.reshape(scene.output.inside, (-1, 2))
    depths = body.solid.depths / body.half_width if scene.layers else np.empty(0)
    X, along = at or positions([scene])
    places = Places(X, points, around, depths, along)
    for fault in _faults(scene, methods, places, {name: refusals[name] for name in named}):
        raise BadInput(fault)
    warnings = [*oddities(scene), *_near_limit(scene, order_.speeds, FEM in methods)]
    warnings += _overtaken(scene, order_.speeds)
    # Whoever names all methods wants those that solve it; and in a uniform solid the closed form is the
    # integral equation's solution.
    others = {n: why for n, why in refusals.items() if scene.layers or not METHODS[n].of_layers}
    left_out = [name for name in named if others.get(name)]
    if methods and not {*OWN_METHODS} <= {*named}:
        warnings += [f"solve.methods: {name} does not solve this: {others[name]}" for name in left_out]
    if (
        methods
        and FEM not in methods
        and not scene.time
        and (unused := keys_set(scene.solve, _OF_ELEMENTS))
    ):
        keys = listed([f"solve.{key}" for key in unused])
        warnings.append(f"{keys}: without effect, because no finite elements solve this contact")
    friction, fem = enumerate_states(scene, done) if FEM in methods or scene.time else None, None
    if friction and FEM in methods:
        responses = [body.response(c) for c in order_.speeds]
        fem = elements.plan_fem(scene, responses, _output_places(scene, places), friction.g)
        warnings += elements.warnings_of(fem)
    motions = starts(scene, friction) if friction else None
    if motions and motions.until_turn:
        warnings.append(
            f"time: the integral equation computes motions {motions.until_turn}; what two methods agree "
            "to holds up to there, and later numbers are those of finite elements alone"
        )
    if motions and FEM in motions.methods and motions.shortest_of_friction < 1.0 < motions.end:
        rate = 1.0 / motions.shortest_of_friction
        warnings.append(
            f"time: friction changes by {rate:.2g} within 1 a/c_s where it is fastest, "
            "finite elements are made for 1 and may miss the tolerance; a lower speed or softer law helps"
        )
    modes = (*scene.modes, *(SWEPT,) * bool(fem and fem.sweep), *(ALONE,) * (len(methods) == 1))
    quantities, refused = _quantities(scene, methods, modes)
    given = {quantity.asked_by for quantity in quantities}
    warnings += [
        f"output.quantities: {of} cannot be computed: {why}"
        for word, of in _PLACES.items()
        if word not in given and (why := next((w for row, w in refused if row.asked_by == word), ""))
    ]
    skipped = [
        f"{METHODS[name].about}: {why or f'{name} is not in solve.methods'}"
        for name, why in others.items()
        if contact and name not in methods
    ]
    skipped += _skipped(scene, contact, given)
    skipped += [f"{quantity.path}: {why}" for quantity, why in refused]
    plan = Plan(
        scene=scene, done=done, followed=friction, places=places, methods=methods,
        quantities=quantities, order=order_, fem=fem, starts=motions,
        skipped=tuple(skipped), warnings=tuple(warnings), first=first[0], speed=first[1],
    )  # fmt: skip
    if lack := elements.lacking(_HELD * plan.chunk * plan.numbers):
        warnings.append(f"the stresses of a single state need {lack}: ask for fewer points")
    return replace(plan, warnings=tuple(warnings))


def _output_places(scene: Scene, places: Places) -> Places:
    """Places at which finite elements output stresses, those along interfaces among the points inside."""
    surface, below = (word in scene.output.quantities for word in (stresses.ON_SURFACE, stresses.BELOW))
    X, points = places.X[: len(places.X) * surface], places.points[: len(places.points) * below]
    if {layers.AT_INTERFACES, YIELD} & {*scene.output.quantities} and len(places.along):
        X_along, depth = np.meshgrid(places.along, places.interfaces)
        points = np.concatenate([points, np.column_stack([X_along.ravel(), -depth.ravel()])])
    return Places(X, points, places.around)


def _quantities(
    scene: Scene, methods: tuple[str, ...], modes: tuple[str, ...]
) -> tuple[tuple[Quantity, ...], list[tuple[Quantity, str]]]:
    """Quantities that are evaluated, and those that a method cannot give, with the reason.

    Raises:
        BadInput: a quantity of the user's names no method, and would never be computed.
    """
    known = ", ".join([LOCAL, *METHODS])
    for path, quantity in QUANTITIES.items():
        if quantity.solved and quantity.method not in (LOCAL, *METHODS):
            found = f"found method = {quantity.method!r}"
            raise BadInput(f"the quantity {path!r}: {found}, expected one of {known}")
    computed: dict[str, Quantity] = {}
    refused: list[tuple[Quantity, str]] = []
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
        if not applies:
            continue
        kind, body = METHODS.get(quantity.method), scene.body
        if lack := kind.refusal(scene, body, quantity) if kind else _lack(quantity, body):
            refused.append((quantity, lack))
        else:
            computed[path] = quantity
    return tuple(computed.values()), refused


def _lack(quantity: Quantity, body: Contact) -> str:
    """Reason why a contact has no quantity that needs no method, "" where it has one."""
    reasons = body.lacks if quantity.requires else {}
    return next((reasons[word] for word in quantity.requires if word in reasons), "")


def _skipped(scene: Scene, contact: bool, words: Collection[str]) -> Iterator[str]:
    """Messages about outputs that are not computed, with the reason.

    Args:
        scene: the scene.
        contact: True where an output needs contact mechanics.
        words: names in output.quantities of the quantities that are computed.
    """
    if not contact and scene.time:
        yield "contact mechanics of steady motion: only friction and time are asked for"
    elif not contact:
        yield "contact mechanics: only friction is asked for"
    else:
        yield from (
            f"{of}: not in output.quantities"
            for word, of in _PLACES.items()
            if word not in {*words, *scene.output.quantities}
        )
    if YIELD in words and FINITE not in scene.body.modes:
        yield (
            "largest von Mises and shear stress, load at first yield: stresses are infinite at the sharp "
            "edges of a punch, and any load makes these yield"
        )


#: Reach of positions over the length in which layers bend, and along interfaces over their depth or the
#: half-width; and at most, over the half-width. Where friction is low the largest tension is far away:
#: the tension that friction makes falls like 1/X, the compression under the load faster.
_BENT, _ALONG, _REACH = 100.0, 200.0, 2000.0


def surface_grid(farthest: float = stresses.FARTHEST, kinks: Sequence[float] = ()) -> np.ndarray:
    """Positions X/a of archived surface stresses, clustered at ±1, without ±1 itself, and at kinks."""
    near = np.geomspace(1e-6, 0.1, 31)
    inside = np.concatenate([1.0 - near, np.linspace(0.0, 0.88, 23)])
    outside = 1.0 + np.concatenate([near, np.geomspace(0.1, stresses.FARTHEST - 1.0, 25)[1:]])
    right = np.concatenate([inside, outside, _beyond(farthest)])
    beside = np.add.outer(kinks, np.concatenate([-near[15:], near[15:]])).ravel()
    return np.unique(np.concatenate([-right, right, beside[np.abs(beside) < 0.9]]))


def _beyond(farthest: float) -> np.ndarray:
    """Positions from ``FARTHEST``, which is left out, to the farthest, 16 an octave."""
    count = int(np.ceil(16 * np.log2(farthest / stresses.FARTHEST))) + 1
    return np.geomspace(stresses.FARTHEST, farthest, count)[1:]


def positions(scenes: Sequence[Scene]) -> tuple[np.ndarray, np.ndarray]:
    """Positions X/a on the surface and along interfaces that suit all states of some scenes.

    Below edges those along interfaces are as fine as these are near. Layers that are stiffer than what is
    below them bend far beyond the contact, and are stretched there.
    """
    kinks = {kink for scene in scenes for kink in scene.body.friction_kinks}
    if not scenes[0].layers:
        return surface_grid(kinks=sorted(kinks)), np.empty(0)
    each = np.array([_depths(scene) for scene in scenes])
    bent = [_BENT * scene.solid.bending / scene.solid.depths[-1] for scene in scenes]
    reach = min(max(stresses.FARTHEST, *(bent * each[:, 1, -1])), _REACH)
    near = np.concatenate([distances(*ends) for ends in zip(each[:, 0].min(0), each[:, 1].max(0))])
    near = np.concatenate([-near, near])
    across = np.linspace(-stresses.FARTHEST, stresses.FARTHEST, 161)
    far = _beyond(min(max(reach, _ALONG, _ALONG * each.max()), _REACH))
    X = np.concatenate([across, near - 1.0, near + 1.0, -far, far])
    return surface_grid(reach, sorted(kinks)), np.unique(np.round(X, 9))


def _depths(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Least and largest depths of interfaces over the half-widths of a scene's contacts, (layers,)."""
    widths = [scene.body.half_width]
    if {AT_INTERFACES, stresses.ON_SURFACE} & {*scene.output.quantities}:
        widths = scene.body.bounds_on_half_widths(scene.punch.loads, order(scene).speeds)
    return scene.solid.depths / max(widths), scene.solid.depths / min(widths)
