"""Plan of the finite elements of a scene, from its keys: mode, mesh, degrees, solver, assembler."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from galinx.meshes import MESHES, Requirements
from galinx.postprocess.quantities.quantity import FEM
from galinx.solvers.contact import FREE_ENDS
from galinx.solvers.contact.edges import EdgeExponents
from galinx.solvers.contact.fem_plan import (
    DOLFINX,
    FITTED,
    NEAR_FREE_END,
    FemPlan,
    kind_of,
    largest_level,
    no_nearer,
    pressure_moments,
    required_of_free_ends,
    required_of_pieces,
    required_over_layers,
    requirements,
    size_of,
    swept,
    unknowns,
)
from galinx.solvers.contact.free_ends import SHAPES, slopes_of_shapes
from galinx.solvers.contact.solution import FREE, ONE_FREE, PRESCRIBED, SHARP, Places
from galinx.solvers.contact.uniform import contacts
from galinx.solvers.errors import SolveError
from galinx.solvers.profiles import exponent
from galinx.solvers.rays import NEAR
from galinx.solvers.solids.half_plane import HalfPlane

from .. import ranks
from ..errors import BadInput
from ..methods import fem_mode
from ..scene.scene import Scene
from . import cost

#: Most polynomials whose sum is the profile of a smooth punch under its contacts, and share of its slope
#: that is rounding.
_MOST_SHAPES, _ROUNDED = 48, 1e-13
#: Most unknowns of a speed that one rank solves faster than two ranks together.
SMALL = 200_000


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
    mixed, ends = scene.solid.nearly_incompressible, (float(g.min()), float(g.max()))
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
    drawn = kind.drawn(required)
    size = unknowns(drawn, largest) if drawn else size_of(refinement, largest)
    shared = shares_speeds(size, len(responses))
    solver = solve.solver
    if mixed or solver == "auto":
        needed = cost.bytes_of_levels(size, direct=True) * (ranks.size() if shared else 1)
        solver = "direct" if mixed or needed < 0.8 * cost.free_memory() else "multigrid"
    return FemPlan(
        mesh=name, kind=kind, refinement=refinement, cuts=solve.cuts, form=scene.solid.form,
        assembler=solve.assembler, solver=solver, degrees=degrees, fixed=solve.degree is not None,
        wanted=required, mode=mode, shared_speeds=shared, sharp=exponent, drawn=drawn,
        tests=pressure_moments(scene.solid, kind, required),
        sweep=swept(solve.sweep, responses, g) if mode in FITTED else None,
        shapes=_shapes(scene, responses, g) if mode == FREE_ENDS else 0,
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


def memory(fem: FemPlan) -> float:
    """Memory [B] of the linear systems on all ranks together."""
    systems = ranks.size() if fem.shared_speeds else 1
    return systems * cost.bytes_of_levels(fem.size, fem.solver == "direct")
