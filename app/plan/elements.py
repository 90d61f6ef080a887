"""Plan of the finite elements of a scene, and what they cannot compute.

:func:`plan_fem` gives mesh, degrees and solver, :func:`faults` outputs without an answer on the scene's
mesh, and :func:`memory` what matrices need.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from math import log2
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from galinx.meshes import MESHES, Requirements
from galinx.meshes.kind import DEGREES
from galinx.solvers.contact import FREE_ENDS, VARYING_FREE
from galinx.solvers.contact.closed_form import contacts
from galinx.solvers.contact.edges import EdgeExponents
from galinx.solvers.contact.ends import SHAPES, slopes_of_shapes
from galinx.solvers.contact.estimate import SLOWER, of_degrees
from galinx.solvers.contact.fem_plan import (
    FITTED,
    FemPlan,
    at_friction_kinks,
    graded_kinks,
    kind_of,
    no_nearer,
    required_of_free_ends,
    required_of_pieces,
    required_on_layers,
    requirements,
    swept,
)
from galinx.solvers.contact.solution import FLAT, FREE, ONE_FREE, PRESCRIBED, SHARP, Places
from galinx.solvers.errors import SolveError
from galinx.solvers.profiles import radius
from galinx.solvers.rays import NEAR
from galinx.solvers.solids.half_plane import HalfPlane

from .. import ranks
from ..methods import fem_mode
from ..scene.scene import Scene

#: Most knots of a prescribed pressure over layers, and their least distance over a.
_KNOTS, _APART = 12, 0.02
#: Narrowest piece of a prescribed pressure, over a, within which positions have enough digits.
_NARROWEST = 1e-9
#: Most unknowns of a speed that one rank solves faster than two ranks together.
SMALL = 200_000
#: Most polynomials whose sum is the profile of a smooth punch under its contacts, and share of its slope
#: that is rounding.
_MOST_SHAPES, _ROUNDED = 48, 1e-12
#: Name of the mesh that follows interfaces.
_LAYERED = "layered"
#: Twice the least degree of cells less the number of shapes.
_BESIDE = 4


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


def faults(scene: Scene, places: Places, alone: bool) -> Iterator[str]:
    """Faults of what finite elements cannot compute, one sentence each.

    Args:
        scene, places: the scene, and the points where stresses are output.
        alone: no other method solves the contact.
    """
    solve, mixed, words = scene.solve, scene.solid.nearly_incompressible, scene.solid.words
    if solve.mode == "traction" and not solve.own_pressure and FLAT in scene.body.lacks:
        yield (
            'solve.mode = "traction": found a punch that is not flat, whose pressure has no closed form; '
            'give solve.pressure, or take mode = "contact"'
        )
    if solve.own_pressure:
        yield from _faults_of_pressure(scene, scene.body.knots)
    points = np.concatenate([places.points, places.around])
    far, limit = float(np.abs(points).max(initial=0.0)), farthest_inside(scene)
    if far > limit:
        yield (
            f"output.points: found a coordinate of {far:g} a, expected at most {limit:g} a with the "
            f"{solve.mesh} mesh at the tolerance {solve.tolerance:g}"
        )
    if len(points) and mixed and alone:
        yield (
            f"output.{'points' if len(places.points) else 'quantities'}: found {words()}, expected "
            'ν <= 0.49 for stresses inside from finite elements; use methods = ["closed_form"]'
        )
    if mixed and solve.degree and solve.degree < 3:
        yield (
            f"solve.degree: found {solve.degree} with {words()}, expected at least 3: "
            "the pressure, an unknown of its own there, has two degrees less"
        )
    if mixed and solve.solver in ("boomeramg", "gamg"):
        yield (
            f"solve.solver: found {solve.solver} with {words()}, expected direct or auto: "
            "with an unknown pressure the matrix is indefinite"
        )


def _faults_of_pressure(scene: Scene, knots: Sequence[float]) -> Iterator[str]:
    """Faults of a prescribed pressure with knots X/a that cannot load the cells of a mesh."""
    width, mesh, kind = float(np.diff(knots).min()), scene.solve.mesh, MESHES[scene.solve.mesh]
    if scene.layers:
        if len(knots) > _KNOTS or width < _APART:
            yield (
                f"solve.pressure: found {len(knots)} positions X/a, {width:.3g} apart at the least, "
                f"expected at most {_KNOTS}, {_APART:g} apart, with finite elements over layers, whose "
                'cells are graded towards each; take methods = ["sie"]'
            )
        return
    if kind.walls or not kind.rings:
        yield (
            f'solve.mesh: found "{mesh}" with a prescribed pressure, expected "confocal" or '
            '"graded": the mesh is scaled to the width of every piece of it, graded towards both ends, '
            "and has no walls"
        )
    if kind.chart.name != "confocal" and scene.solid.nearly_incompressible:
        yield (
            f'solve.mesh: found "{mesh}" with a prescribed pressure and '
            f'{scene.solid.words()}, expected "confocal" or ν <= 0.49: cells of its meshes for pieces '
            "differ so much in size that with an unknown pressure rounding spoils the matrix"
        )
    if width < _NARROWEST:
        yield (
            f"solve.pressure: found positions X/a that differ by {width:.3g}, expected at least "
            f'{_NARROWEST:g} with finite elements; leave one out, or take methods = ["closed_form"]'
        )


def farthest_inside(scene: Scene) -> float:
    """Largest distance over a of fields inside from finite elements: well inside walls, if any."""
    walls = MESHES[scene.solve.mesh].walls
    return 0.6 * walls if walls else 1e6


def plan_fem(scene: Scene, responses: Sequence[HalfPlane], places: Places, g: NDArray) -> FemPlan:
    """Plan of the finite elements at the speeds of a scene; builds no mesh.

    Args:
        scene: the scene.
        responses: of its solid, one a speed.
        places: points where stresses are output.
        g: all values of σ_XY/σ_YY.
    """
    solve, kind, name = scene.solve, MESHES[scene.solve.mesh], scene.solve.mesh
    mode = fem_mode(scene)
    if scene.layers:
        depths = scene.solid.depths / scene.body.half_width
        kind, name = (
            kind_of(depths, responses, scene.body.knots or (-1.0, *graded_kinks(scene.body), 1.0)),
            _LAYERED,
        )
    ratios = scene.body.ratio(g, np.linspace(-1.0, 1.0, 201))  # for its extremes
    mixed, ends = scene.solid.nearly_incompressible, (float(ratios.min()), float(ratios.max()))
    exponent = min(
        -0.5 - abs(EdgeExponents(response, end).α + 0.5) for response in responses for end in ends
    )
    planes = [response.contraction for response in responses]
    required = requirements(solve.tolerance, places, exponent, responses, planes)
    if required_of_kind := _REQUIRED.get((scene.body.ends, bool(scene.layers))):
        required = required_of_kind(required, scene, mode)
    refinement = kind.refinement(required)
    shapes = _shapes(scene, responses, g) if mode in _OF_SHAPES else 0
    # Few cells lie across the contact: their degree has to follow the pressure under all shapes.
    least = max(4 + mixed, min((shapes + _BESIDE) // 2, DEGREES[1]))
    degrees = tuple(
        solve.degree or max(kind.degree(required, response.margin), least) for response in responses
    )
    kinks = graded_kinks(scene.body)
    plan = FemPlan(
        mesh=name, kind=kind, refinement=refinement, cuts=solve.cuts, form=scene.solid.form,
        assembler=solve.assembler, solver=solve.solver, degrees=degrees, fixed=solve.degree is not None,
        wanted=required, mode=mode, shared_speeds=False, sharp=exponent,
        graded=partial(at_friction_kinks, kinks=kinks) if kinks else None,
        rate=SLOWER if scene.layers else of_degrees(2),
        sweep=swept(solve.sweep, responses, g) if mode in FITTED else None,
        shapes=shapes,
    )  # fmt: skip
    shared, solver = shares_speeds(plan.size, len(responses)), solve.solver
    if mixed or solver == "auto":
        needed = memory(plan.size, direct=True) * (ranks.size() if shared else 1)
        solver = "direct" if mixed or needed < 0.8 * free_memory() else "multigrid"
    return replace(plan, solver=solver, shared_speeds=shared)


#: Modes in which punches are sums of polynomials.
_OF_SHAPES = (FREE_ENDS, VARYING_FREE)
#: Requirements on the mesh with those of the kind of contact, by its ends, without and with layers.
_REQUIRED: dict[tuple[str, bool], Callable[[Requirements, Scene, str], Requirements]] = {
    (SHARP, True): lambda required, *_: required_on_layers(required, True),
    (ONE_FREE, True): lambda required, *_: required_on_layers(required, True),
    (PRESCRIBED, False): lambda required, scene, *_: required_of_pieces(
        required, np.array(scene.body.knots)
    ),
    # Next to knots stresses are continued.
    (PRESCRIBED, True): lambda required, *_: no_nearer(required, NEAR),
    # Kinks have meshes of their own; at sharp corners the singularity sets the degree.
    (FREE, False): lambda required, scene, mode: replace(
        required_of_free_ends(required, scene.solid.nearly_incompressible), bends=mode in _OF_SHAPES
    ),
    (FREE, True): lambda required, *_: required_on_layers(required, False),
}


def _shapes(scene: Scene, responses: Sequence[HalfPlane], g: NDArray) -> int:
    """Number of polynomials whose sum is the profile of the punch under every contact.

    It depends on the widths of the contacts. The integral equation gives these at the slowest and the
    fastest speed, and at the least and the largest load and friction.
    """
    profile, most = scene.punch.profile, 0
    if scene.body.ends == ONE_FREE:
        return 1  # a tilted base
    if radius(profile):
        return 2
    ends = [max(responses, key=lambda r: r.margin), min(responses, key=lambda r: r.margin)]
    loads = np.repeat([min(scene.punch.loads), max(scene.punch.loads)], 3)
    frictions = np.tile([g.min(), 0.0, g.max()], 2)
    for response in ends:
        try:
            solved = contacts(response, frictions, profile, loads / scene.solid.μ, checked=False)
        except SolveError:
            return SHAPES  # finite elements report it where they solve the contact
        for m, h in zip(solved.of("centre").tolist(), solved.of("half_width").tolist()):
            size = np.abs(slopes_of_shapes(profile, m, h, 2 * _MOST_SHAPES))
            most = max(most, int(np.flatnonzero(size > _ROUNDED * size.max())[-1]) + 1)
    return int(np.clip(most, SHAPES, _MOST_SHAPES))


def shares_speeds(unknowns: int, speeds: int) -> bool:
    """True where ranks take whole speeds: small systems gain nothing from being cut in pieces."""
    return 1 < ranks.size() <= speeds and unknowns < SMALL


def warnings_of(fem: FemPlan) -> Iterator[str]:
    """Warnings where finite elements do not reach the tolerance, or do not fit into memory."""
    cut_off = fem.kind.truncation(fem.wanted)
    if cut_off > fem.tolerance:
        other = 'methods = ["sie"]' if fem.mesh == _LAYERED else 'mesh = "confocal" or "graded"'
        yield (
            f"the outer boundary of the {fem.mesh} mesh alone costs about {cut_off:.1g} (relative, with "
            f"friction), more than the tolerance {fem.tolerance:g}; take {other}"
        )
    systems = ranks.size() if fem.shared_speeds else 1
    if lack := lacking(systems * memory(fem.size, fem.solver == "direct")):
        yield f"the finite elements need {lack}: use fewer cuts, a larger tolerance, or more machines"
