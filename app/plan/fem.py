"""What finite elements of a scene need: mesh, degrees, solver, memory.

What finite elements over layers need: meshes along interfaces, and how pressures are read off them.

Which scenes have so many speeds that a few of them tell the others.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.meshes import MESHES, MeshKind, Wanted
from galinx.meshes.layered import OnLayers, on_layers
from galinx.meshes.rings import QuadMesh, Refinement
from galinx.postprocess.free_ends import SHAPES, slopes_of_shapes
from galinx.postprocess.pressure import Stretch
from galinx.postprocess.quantities.quantity import FEM, FOUND
from galinx.solvers.errors import SolveError
from galinx.solvers.layers.layered import Layered, LayeredResponse
from galinx.solvers.profiles import exponent, smooth
from galinx.solvers.rays import NEAR
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.sie.free_contact import contacts
from galinx.solvers.solids import Solid
from galinx.solvers.solids.solid import Response
from galinx.solvers.solution import Places

from .. import ranks
from ..errors import BadInput
from ..methods import DOLFINX
from ..scene.scene import Scene
from . import cost

#: How far apart a surface's fields may live so that cells are drawn together for both.
_APART = 0.8
#: Where less is left to the speed of a wave along the substrate no far boundary is far enough.
_LEAST_LEFT = 1e-6
#: Distance over a from a free end within which stresses are continued from farther away.
_NEAR_FREE_END = 1e-2
#: Moments more over solids that are graded from the surface on: few polynomials do not make up for what
#: functions of the ends add away from these.
_MORE_GRADED = 6
#: Loosest tolerance of meshes over them: on coarser ones these functions' moments are not sure.
_LOOSEST_GRADED = 1e-4


@dataclass(frozen=True)
class Tests:
    """By what a pressure over layers is read off nodal forces.

    Attributes:
        stretch: variable in which it is smooth.
        count: moments at the first degree; each degree more takes more, so that what they leave shows in
            the measured error.
    """

    stretch: Stretch
    count: int

    @property
    def a_degree(self) -> int:
        """Moments more for each degree more; those over graded solids depend on one another nearly."""
        return 1 if self.stretch.graded else 2


def tests_of(solid: Solid, kind: MeshKind, wanted: Wanted) -> Tests | None:
    """What a pressure over layers is read off by; None where there are none."""
    if not isinstance(kind, OnLayers) or not isinstance(solid, Layered):
        return None
    graded = graded_from_the_surface(solid)
    return Tests(Stretch(kind.length, graded), kind.moments(wanted) + _MORE_GRADED * graded)


def wanted_of_free_ends_on_layers(wanted: Wanted) -> Wanted:
    """What a mesh has to be good for where stresses at the ends are finite.

    The parts that are added up until no intensity is left have one each.
    """
    if wanted.nearest is None:
        return wanted
    return replace(wanted, nearest=max(wanted.nearest, _NEAR_FREE_END))


def graded_from_the_surface(solid: Layered) -> bool:
    """Do constants change in the uppermost layer?"""
    return solid.layers[0].bottom not in (None, solid.layers[0].solid)


def wanted_of_graded(wanted: Wanted, solid: Layered) -> Wanted:
    """What a mesh has to be good for over layers, by whether the uppermost one is graded."""
    if not graded_from_the_surface(solid):
        return wanted
    return replace(wanted, tolerance=min(wanted.tolerance, _LOOSEST_GRADED))


def wanted_of_loads(wanted: Wanted) -> Wanted:
    """What a mesh has to be good for under a pressure that is put in, stresses next to whose knots are
    continued from farther away."""
    if wanted.nearest is None:
        return wanted
    return replace(wanted, nearest=max(wanted.nearest, NEAR))


def kind_of(depths: NDArray, responses: Sequence[Any], places: Sequence[float] = (-1.0, 1.0)) -> OnLayers:
    """The kind of mesh of layered solids, at some speeds.

    Args:
        depths: of the interfaces over a.
        responses: of the half-plane, one a speed.
        places: over a towards which cells are graded.
    """
    roots = [[p.imag for p in response.surface.roots.each] for response in responses]
    # Fields that live far apart have no middle.
    apart = max(response.spread for response in responses) > _APART
    return on_layers(
        depths.tolist(),
        drawn_together=float(np.min(roots)),
        wide=1.0 if apart else float(np.exp(np.mean(np.log(roots)))),
        far_length=max(response.far_field.length for response in responses),
        left=max(min(response.left_below for response in responses), _LEAST_LEFT),
        roots=_roots(responses),
        changes=tuple(length / responses[0].a for length in responses[0].solid.changes),
        places=tuple(places),
    )


def _roots(responses: Sequence[Any]) -> tuple[tuple[complex, ...], ...]:
    """p of every solid at the lowest and the highest speed, where they are farthest apart."""
    by_speed = sorted(responses, key=lambda response: response.c)
    each = [response.roots for response in (by_speed[0], by_speed[-1])]
    return tuple(one + other for one, other in zip(*each))


#: Different speeds from which a fit through some of them is sooner there than all of them: it takes about
#: a dozen, four of these with all that measures an error.
LEAST = 16

#: Speeds at which the discretisation's error is measured, how many are solved besides as a rule, and
#: the most that are solved.
LADDERS, BESIDES, MOST = 4, 7, 24

#: Values of σ_XY/σ_YY up to which punches are sampled at these, and at no others.
_FEW = 8

#: Change of an inverse contraction over that of c² below which it tells speeds no better apart.
_FLAT = 1e-3


@dataclass(frozen=True)
class Sweep:
    """Speeds of which some are solved, the others fitted.

    Attributes:
        z: the speeds in the variable of the fit, in the order of the plan, (speeds,).
        g: all values of σ_XY/σ_YY where they are few, else the smallest and the largest.
        few: are they?
    """

    z: NDArray[np.float64]
    g: NDArray[np.float64]
    few: bool


def swept(wanted: str, responses: Sequence[Response], g: NDArray) -> Sweep | None:
    """The sweep of some speeds, None where each is to be solved.

    Args:
        wanted: ``"auto"`` or ``"every"``.
        responses: of the half-plane, one a speed.
        g: all values of σ_XY/σ_YY.
    """
    if wanted == "every" or len({response.c for response in responses}) < LEAST:
        return None
    values = np.unique(g)
    few = len(values) <= _FEW
    return Sweep(variable(responses), values if few else values[[0, -1]], few)


def variable(responses: Sequence[Response]) -> NDArray[np.float64]:
    """In which variable results are smoothest: they are analytic in c², and so is it.

    What the fields are analytic in, and the mesh where it follows them, contracts with a root of the
    distance to the slowest wave in the solid. So all is smooth in the contraction up to that speed, and
    in c² not. Its inverse spreads speeds near the limit; where it does not tell them apart c² has to do.

    Along layers waves of all lengths run, each with a speed of its own from the limit on: no pole is
    there, but the end of a branch, which the logarithm of the distance from it sends to infinity.
    """
    if isinstance(responses[0], LayeredResponse):
        return np.array([-np.log(response.margin) for response in responses])
    square = np.array([response.c**2 for response in responses])
    inverse = np.array([1.0 / response.contraction.imag for response in responses])
    order = np.argsort(square, kind="stable")
    steps, changes = np.diff(square[order]), np.diff(inverse[order])
    # Between speeds that hardly differ rounding may be all that is seen.
    seen = steps > 1e-6 * max(square.max(), np.finfo(float).tiny)
    tells = seen.any() and np.ptp(square) > 1e-4 and np.all(changes[seen] > _FLAT * steps[seen])
    return inverse if tells else square


#: Distance over a from a punch edge that no mesh resolves: rounding of positions.
_NEAREST = 1e-12

#: Distance over a from a free end within which cells need not be finer: stresses vary like its root.

#: What plans call the mode in which every state has a mesh of its own, graded towards kinks of the punch.
OWN_MESHES = "own meshes"
#: Polynomials at most whose sum a smooth punch is under its contacts, and share of its slope that is
#: rounding.
_MOST_SHAPES, _LEFT = 48, 1e-13

#: What plans call the mode in which meshes over layers follow the contact, whose ends are found.
FOLLOWED = "meshes that follow the contact"
#: And that in which a pressure is put in over layers.
LOADS = "loads over layers"
#: Modes in which some speeds may tell the others.
FITTED = ("contact", FOUND)

#: Cuts from which half of them, at one degree more, are no worse than all of them.
_MANY = 8

#: Unknowns up to which a rank solves a speed alone faster than two ranks together.
SMALL = 200_000


@dataclass(frozen=True)
class FemPlan:
    """Finite element work of a scene.

    Attributes:
        mesh, kind: name and kind of the mesh.
        refinement: of the one mesh all speeds share, before it is cut.
        cuts: of every cell's sides.
        form: name of the weak form.
        assembler: ``TENSOR`` or ``DOLFINX``.
        solver: ``"direct"``, ``"boomeramg"``, ``"gamg"``, or ``"multigrid"`` for the better of these two.
        degrees: polynomial degree to begin with, by speed; the measured error may ask for more.
        fixed: the scene fixes the degree.
        wanted: what the mesh has to be good for.
        mode: ``"contact"``, ``"traction"``, ``"own pressure"``, ``FOUND``, ``OWN_MESHES``,
            ``FOLLOWED`` or ``LOADS``.
        shared_speeds: speeds are shared out over the ranks, each rank with a mesh of its own; else
            all ranks share one mesh.
        sharp: exponent of the strongest pressure next to a sharp edge.
        drawn: the mesh where it follows interfaces.
        tests: by which the pressure is read off over layers.
        sweep: the speeds where some of them are to tell the others; None where each is solved.
        shapes: polynomials whose sum the punch is under every contact, where ends are found.
    """

    mesh: str
    kind: MeshKind
    refinement: Refinement
    cuts: int
    form: str
    assembler: str
    solver: str
    degrees: tuple[int, ...]
    fixed: bool
    wanted: Wanted
    mode: str
    shared_speeds: bool
    sharp: float = -0.5
    drawn: QuadMesh | None = None
    tests: Tests | None = None
    sweep: Sweep | None = None
    shapes: int = 0

    @property
    def tolerance(self) -> float:
        """Wanted relative accuracy."""
        return self.wanted.tolerance

    @property
    def terms(self) -> int:
        """Moments of the forces at the contact that the far boundary follows; 0 where it is held."""
        return self.kind.terms(self.wanted)

    @property
    def pattern(self) -> QuadMesh:
        """The mesh before it is cut."""
        return self.drawn or self.kind.build(self.refinement)

    @property
    def size(self) -> int:
        """Unknowns of the largest system, about the same without building the mesh."""
        largest = _largest(max(self.degrees), self.cuts, self.fixed)
        return unknowns(self.drawn, largest) if self.drawn else _size(self.refinement, largest)

    @property
    def memory(self) -> float:
        """Bytes of the linear systems on all ranks together."""
        systems = ranks.size() if self.shared_speeds else 1
        return systems * cost.bytes_of_levels(self.size, self.solver == "direct")


def plan_fem(scene: Scene, responses: Sequence[Response], places: Places, g: NDArray) -> FemPlan:
    """Plan the finite elements at some speeds; builds no mesh.

    Args:
        scene: the scene.
        responses: of its solid, one a speed.
        places: where stresses are asked for.
        g: all values of σ_XY/σ_YY.

    Raises:
        BadInput: a degree or solver is asked for that the weak form does not allow.
    """
    solve, kind, name = scene.solve, MESHES[scene.solve.mesh], scene.solve.mesh
    mode = _mode(scene)
    if isinstance(scene.solid, Layered):
        depths = scene.solid.depths / scene.body.half_width
        knots = np.array(solve.pressure)[:, 0].tolist() if solve.own_pressure else (-1.0, 1.0)
        kind, name = kind_of(depths, responses, knots), "layered"
    _check_degree_and_solver(scene)
    mixed, ends = scene.solid.nearly_incompressible, (float(g.min()), float(g.max()))
    exponent = min(-0.5 - abs(FlatPunch(response, end).α + 0.5) for response in responses for end in ends)
    spread = max(response.spread for response in responses)
    planes = [response.contraction for response in responses]
    wanted = _wanted(scene, mode, wanted_for(solve.tolerance, places, exponent, spread, planes))
    refinement = kind.refinement(wanted)
    degrees = tuple(
        solve.degree or max(kind.degree(wanted, response.margin), 4 + mixed) for response in responses
    )
    largest = _largest(max(degrees), solve.cuts, solve.degree is not None)
    drawn = kind.drawn(wanted) if isinstance(kind, OnLayers) else None
    size = unknowns(drawn, largest) if drawn else _size(refinement, largest)
    shared = shares_speeds(size, len(responses))
    solver = solve.solver
    if mixed or solver == "auto":
        needed = cost.bytes_of_levels(size, direct=True) * (ranks.size() if shared else 1)
        solver = "direct" if mixed or needed < 0.8 * cost.free_memory() else "multigrid"
    return FemPlan(
        mesh=name, kind=kind, refinement=refinement, cuts=solve.cuts, form=scene.solid.form,
        assembler=solve.assembler, solver=solver, degrees=degrees, fixed=solve.degree is not None,
        wanted=wanted, mode=mode, shared_speeds=shared, sharp=exponent, drawn=drawn,
        tests=tests_of(scene.solid, kind, wanted),
        sweep=swept(solve.sweep, responses, g) if mode in FITTED else None,
        shapes=_shapes(scene, responses, g) if mode == FOUND else 0,
    )  # fmt: skip


def _wanted(scene: Scene, mode: str, wanted: Wanted) -> Wanted:
    """What a mesh has to be good for, by what is pressed on."""
    solve = scene.solve
    if scene.layers:
        if scene.body.free:
            return wanted_of_free_ends_on_layers(wanted)
        if solve.own_pressure:
            return wanted_of_loads(wanted)
        return wanted_of_graded(wanted, scene.solid)  # type: ignore[arg-type]
    if scene.body.free:
        wanted = wanted_of_free_ends(wanted)
        # Kinks have meshes of their own; at sharp corners the singularity is what asks for the degree.
        wanted = replace(wanted, bends=mode == FOUND)
    if solve.own_pressure:
        wanted = wanted_of_pieces(wanted, np.array(solve.pressure)[:, 0])
    return wanted


def _shapes(scene: Scene, responses: Sequence[Response], g: NDArray) -> int:
    """Polynomials whose sum the punch is under every contact.

    How wide contacts are is what the mesh has to be good for: the integral equation tells that of the
    slowest and the fastest, of the least and the most load and friction.
    """
    profile, most = scene.punch.profile, 0
    if not scene.body.free or exponent(profile) == 2.0:
        return 2 if scene.body.free else 1  # a parabola, or a tilted base
    ends = [max(responses, key=lambda one: one.margin), min(responses, key=lambda one: one.margin)]
    loads = np.repeat([min(scene.punch.loads), max(scene.punch.loads)], 3)
    frictions = np.tile([g.min(), 0.0, g.max()], 2)
    for response in ends:
        try:
            known = contacts(response, frictions, profile, loads / scene.solid.μ)
        except SolveError:
            return SHAPES  # finite elements say so where they look for the contact
        for m, h in zip(known.of("centre").tolist(), known.of("half_width").tolist()):
            size = np.abs(slopes_of_shapes(profile, m, h, 2 * _MOST_SHAPES))
            most = max(most, int(np.flatnonzero(size > _LEFT * size.max())[-1]) + 1)
    return int(np.clip(most, SHAPES, _MOST_SHAPES))


def _mode(scene: Scene) -> str:
    if not scene.body.found:
        return LOADS if scene.layers and scene.solve.own_pressure else scene.solve.modes[-1]
    if scene.layers:
        return FOLLOWED
    return FOUND if smooth(scene.punch.profile) else OWN_MESHES


def wanted_for(
    tolerance: float, places: Places, exponent: float, spread: float, planes: Sequence[complex] = ()
) -> Wanted:
    """What a mesh drawn in some planes is to be good for, by the places where stresses are wanted."""
    on_surface = np.column_stack([places.X, 0.0 * places.X])
    X, Y = np.concatenate([on_surface, places.points, places.around]).T
    if not len(X):
        return Wanted(tolerance, exponent=exponent, spread=spread)
    nearest = np.hypot(np.abs(X) - 1.0, Y).min()
    farthest = max(float(np.abs(X + p * Y).max()) for p in {1j, *planes})
    around, inside = bool(len(places.around)), bool(len(places.points))
    return Wanted(tolerance, max(float(nearest), _NEAREST), farthest, exponent, around, inside, spread)


def wanted_of_free_ends(wanted: Wanted) -> Wanted:
    """The same where stresses at the ends are finite: larger cells do, in which rounding harms less."""
    if wanted.nearest is None:
        return wanted
    return replace(wanted, nearest=max(wanted.nearest, _NEAR_FREE_END), exponent=0.5)


def wanted_of_pieces(wanted: Wanted, knots: NDArray) -> Wanted:
    """The same of the mesh that serves every piece of a pressure, over the narrowest one's half-width."""
    farthest = (1.0 + wanted.farthest) / (np.diff(knots).min() / 2.0)
    return Wanted(wanted.tolerance, NEAR, farthest, spread=wanted.spread)


def shares_speeds(unknowns: int, speeds: int) -> bool:
    """Small systems gain nothing from being cut in pieces; whole speeds are shared out instead."""
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
    """Does dolfinx's assembler serve what the scene asks of finite elements?

    Raises:
        BadInput: it does not.
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


def levels(degree: int, cuts: int, fixed: bool) -> list[tuple[int, int]]:
    """Degrees and cuts to solve with, the one that is wanted at last; the others measure its error."""
    if fixed:
        return [(degree + 1, cuts // 2 if cuts >= _MANY else cuts), (degree, cuts)]
    return [(degree - 2, cuts), (degree - 1, cuts), (degree, cuts)]


def _largest(degree: int, cuts: int, fixed: bool) -> int:
    """Degree times cuts of the largest of these."""
    return max(p * k for p, k in levels(degree, cuts, fixed))


def _size(refinement: Refinement, p: int) -> int:
    """A cell of degree p cut k times has the nodes of one of degree k p."""
    cells = 2 * refinement.sectors * (
        2 * len(refinement.sizes) - 2 + refinement.sectors + len(refinement.columns)
    )  # fmt: skip
    return 2 * p**2 * cells


def unknowns(mesh: QuadMesh, p: int) -> int:
    """Unknowns at degree ``p``: two a vertex, p - 1 an edge, (p - 1)² a cell, by Euler's formula."""
    cells, vertices = len(mesh.cells), len(mesh.points)
    edges = cells + vertices - 1
    return 2 * (vertices + edges * (p - 1) + cells * (p - 1) ** 2)
