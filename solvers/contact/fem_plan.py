"""Plan of the finite elements of a scene: mesh, degrees, solver; it needs no mesh and no dolfinx.

Over layers, meshes follow the interfaces. In a scene of many speeds finite elements solve a few of them,
and a fit through these gives the others, see :class:`Sweep`.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from galinx.meshes import MeshKind, Requirements
from galinx.meshes.layered import OnLayers
from galinx.meshes.rings import QuadMesh, Refinement, rings_at_kinks, with_kinks

from ..rays import NEAR
from ..solids.half_plane import HalfPlane
from . import FREE_ENDS
from .estimate import Rate, of_degrees
from .solution import Places

#: Assemblers of the matrices: element matrices by tensor products, or dolfinx's own.
TENSOR, DOLFINX = "tensor", "dolfinx"
ASSEMBLERS = (TENSOR, DOLFINX)

#: Most states whose own meshes are held at once.
OWN_MESHES_KEPT = 32

#: Spread of the planes of a surface's fields up to which cells are drawn together for both fields.
_APART = 0.8
#: Least distance of the speed from that of a wave along the substrate: below it no far boundary is far
#: enough.
_LEAST_LEFT = 1e-6
#: Distance over a from a free end within which stresses are continued from farther away, and where an
#: unknown pressure, with a jump from cell to cell, oscillates in the innermost cells.
NEAR_FREE_END, _NEAR_INCOMPRESSIBLE = 1e-2, 1e-5


def no_nearer(required: Requirements, distance: float) -> Requirements:
    """Requirements on a mesh for stresses no nearer to an end than a distance over a."""
    if required.nearest is None:
        return required
    return replace(required, nearest=max(required.nearest, distance))


def required_on_layers(required: Requirements, sharp: bool) -> Requirements:
    """Requirements on a mesh over layers, for a contact with a sharp edge or with free ends."""
    if sharp:  # splines follow the pressure only where cells resolve it
        return replace(required, nearest=min(required.nearest or NEAR, NEAR))
    # Stresses are finite at the ends, but the fields whose sum has no intensity have one each.
    return no_nearer(required, NEAR_FREE_END)


def kind_of(depths: NDArray, responses: Sequence[Any], places: Sequence[float] = (-1.0, 1.0)) -> OnLayers:
    """The kind of mesh of a layered solid, for all speeds.

    Args:
        depths: of the interfaces over a.
        responses: of the half-plane, one a speed.
        places: positions X/a towards which cells are graded.
    """
    roots = [[p.imag for p in response.surface.roots.each] for response in responses]
    # Those of every solid at the lowest and at the highest speed, where they are farthest apart.
    by_speed = sorted(responses, key=lambda response: response.c)
    of_solids = by_speed[0].roots_of_solids, by_speed[-1].roots_of_solids
    # Fields that live far apart have no middle.
    apart = max(response.spread for response in responses) > _APART
    return OnLayers(
        depths=tuple(depths.tolist()),
        wide=1.0 if apart else float(np.exp(np.mean(np.log(roots)))),
        far_length=max(response.far_length for response in responses),
        left=max(min(response.left_below for response in responses), _LEAST_LEFT),
        roots=tuple(slow + fast for slow, fast in zip(*of_solids)),
        changes=tuple(length / responses[0].a for length in responses[0].solid.changes),
        places=tuple(places),
    )


#: Least number of speeds at which a fit costs less than solving all of them: it takes about a dozen
#: solutions, four of these with all that measures an error.
LEAST = 16
#: Speeds at which the discretisation's error is measured, how many are solved besides as a rule, and
#: the most that are solved.
LADDERS, BESIDES, MOST = 4, 7, 24
#: Most values of σ_XY/σ_YY at which punches are sampled one by one.
_FEW = 8
#: Change of an inverse contraction over that of c² below which it separates speeds no better.
_FLAT = 1e-3


@dataclass(frozen=True)
class Sweep:
    """Speeds of which finite elements solve a few, and a fit gives the others.

    Attributes:
        z: the speeds in the variable of the fit, in the order of the plan, (speeds,).
        g: all values of σ_XY/σ_YY where they are few, else the smallest and the largest.
        few: True where ``g`` has all values.
    """

    z: NDArray[np.float64]
    g: NDArray[np.float64]
    few: bool


def swept(choice: str, responses: Sequence[HalfPlane], g: NDArray) -> Sweep | None:
    """The sweep over the speeds of a scene, None where each speed is to be solved.

    Args:
        choice: ``"auto"`` or ``"every"``, the scene's solve.sweep.
        responses: of the half-plane, one a speed.
        g: all values of σ_XY/σ_YY.
    """
    if choice == "every" or len({response.c for response in responses}) < LEAST:
        return None
    values = np.unique(g)
    few = len(values) <= _FEW
    return Sweep(variable(responses), values if few else values[[0, -1]], few)


def variable(responses: Sequence[HalfPlane]) -> NDArray[np.float64]:
    """Speeds in the variable in which results are smoothest, (speeds,); like them it is analytic in c².

    The planes in which fields are analytic, and the mesh where it follows them, contract with a root of
    the distance to the slowest wave in the solid. So results are smooth in the contraction up to that
    speed, and not in c². The inverse contraction spreads speeds near the limit; where it does not
    separate them, the variable is c².

    Along layers waves of all lengths run, each with a speed of its own from the limit on: the limit is no
    pole but the end of a branch cut, which the logarithm of the distance from it sends to infinity.
    """
    if len(responses[0].depths):
        return np.array([-np.log(response.margin) for response in responses])
    square = np.array([response.c**2 for response in responses])
    inverse = np.array([1.0 / response.contraction.imag for response in responses])
    order = np.argsort(square, kind="stable")
    steps, changes = np.diff(square[order]), np.diff(inverse[order])
    # Between speeds that hardly differ the change may be rounding.
    apart = steps > 1e-6 * max(square.max(), np.finfo(float).tiny)
    tells = apart.any() and np.ptp(square) > 1e-4 and np.all(changes[apart] > _FLAT * steps[apart])
    return inverse if tells else square


#: Distance over a from a punch edge that no mesh resolves: rounding of positions.
_NEAREST = 1e-12
#: Mode in which every state has a mesh of its own, graded towards kinks of the punch.
OWN_MESHES = "own meshes"
#: Mode of a flat punch over layers, whose pressure is a spline.
SHARP_ON_LAYERS = "flat punch over layers"
#: Mode in which meshes over layers follow a contact with free ends.
FREE_ON_LAYERS = "meshes that follow the contact"
#: Mode of a prescribed pressure over layers.
PRESCRIBED_ON_LAYERS = "loads over layers"
#: Modes in which a fit through a few speeds may give the others.
FITTED = ("contact", SHARP_ON_LAYERS, FREE_ENDS)
#: Number of cuts from which half as many, at one degree more, are no worse.
_MANY = 8


#: Most kinks in a contact; over its half-width, their largest distance from its middle, and their least
#: distance from each other: cells between kinks that are nearer have no shape.
_MOST, _NEXT_TO_END, _NEXT_TO_KINK = 12, 0.998, 1e-3


def crowded_kinks(places: Sequence[float] | NDArray) -> str:
    """Why no mesh is graded towards kinks at positions over the half-width, sorted; "" where one is."""
    at = np.asarray(places, dtype=float)
    apart, farthest = np.diff(at).min(initial=1.0), np.abs(at).max(initial=0.0)
    if len(at) <= _MOST and farthest <= _NEXT_TO_END and apart >= _NEXT_TO_KINK:
        return ""
    return (
        f"{len(at)} kinks under the contact, at {at.round(4).tolist()} (over the half-width); finite "
        f"elements want at most {_MOST}, none within {1.0 - _NEXT_TO_END:.2g} of an end or "
        f"{_NEXT_TO_KINK:g} of another"
    )


def uncrowded_kinks(places: NDArray) -> NDArray[np.float64]:
    """Kinks towards which a mesh can be graded, of rising positions over the half-width, (n,)."""
    inner = places[np.abs(places) <= _NEXT_TO_END]
    return np.asarray(inner[np.diff(inner, prepend=-np.inf) >= _NEXT_TO_KINK][:_MOST])


def joined_kinks(kinks: Sequence[float] | NDArray, weak: Sequence[float]) -> NDArray[np.float64]:
    """Rising positions of kinks, and of those weak ones towards which a mesh can be graded besides.

    Args:
        kinks: positions over the half-width.
        weak: rising positions at which a higher derivative jumps.
    """
    at = np.asarray(weak, dtype=float)
    apart = np.abs(at[:, None] - np.asarray(kinks)).min(axis=1, initial=np.inf)
    further = uncrowded_kinks(at[apart >= _NEXT_TO_KINK])
    return np.union1d(kinks, further[: max(_MOST - len(kinks), 0)])


def graded_kinks(body: Any) -> tuple[float, ...]:
    """Rising positions over the half-width of kinks of friction towards which meshes are graded."""
    weak = sorted({*body.jumps_of_friction} - {*body.friction_kinks})
    return tuple(joined_kinks(body.friction_kinks, weak).tolist())


#: Size of the innermost cells at a kink of friction over the tolerance, and at most: the pressure is
#: d log d next to it, times the change of the slope of f. Smaller cells lose digits of derivatives.
_OF_FRICTION, _LARGEST = 500.0, 0.1


def at_friction_kinks(plan: "FemPlan", kinks: Sequence[float] | NDArray) -> QuadMesh:
    """The mesh of a punch without kinks, graded towards those of friction at positions over a."""
    size = min(_OF_FRICTION * plan.tolerance, _LARGEST)
    return with_kinks(plan.refinement, np.array(kinks), rings_at_kinks(plan.refinement, size))


@dataclass(frozen=True)
class FemPlan:
    """Plan of the finite elements of a scene.

    Attributes:
        mesh, kind: name and kind of the mesh.
        refinement: of the one mesh that all speeds share, before it is cut.
        cuts: of every cell's sides.
        form: name of the weak form.
        assembler: ``TENSOR`` or ``DOLFINX``.
        solver: ``"direct"``, ``"boomeramg"``, ``"gamg"``, or ``"multigrid"`` for the better of these two.
        degrees: polynomial degree to begin with, by speed; the measured error may ask for more.
        fixed: True where the scene fixes the degree.
        wanted: requirements on the mesh.
        mode: ``"contact"``, ``"traction"``, ``SHARP_ON_LAYERS``, ``VARYING``, ``OWN_PRESSURE``,
            ``FREE_ENDS``, ``OWN_MESHES``, ``FREE_ON_LAYERS`` or ``PRESCRIBED_ON_LAYERS``.
        shared_speeds: True where speeds are shared out over the ranks, each rank with a mesh of its own;
            False where all ranks share one mesh.
        sharp: exponent of the strongest pressure next to a sharp edge.
        graded: draws the mesh of a plan where cells are graded towards kinks; None elsewhere.
        rate: rate at which intensities converge with the degree.
        sweep: speeds of a fit; None where each speed is solved.
        shapes: number of polynomials whose sum is the punch under every contact, for free ends.
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
    wanted: Requirements
    mode: str
    shared_speeds: bool
    sharp: float = -0.5
    graded: Callable[["FemPlan"], QuadMesh] | None = None
    rate: Rate = of_degrees(2)
    sweep: Sweep | None = None
    shapes: int = 0

    @property
    def tolerance(self) -> float:
        """Wanted relative accuracy."""
        return self.wanted.tolerance

    @property
    def terms(self) -> int:
        """Number of moments of the contact forces that the far boundary follows; 0 where it is held."""
        return self.kind.terms(self.wanted)

    @cached_property
    def drawn(self) -> QuadMesh | None:
        """The mesh where it follows interfaces or kinks, None elsewhere."""
        return self.kind.drawn(self.wanted) or (self.graded(self) if self.graded else None)

    @cached_property
    def pattern(self) -> QuadMesh:
        """The mesh before it is cut."""
        return self.drawn or self.kind.build(self.refinement)

    @property
    def size(self) -> int:
        """Unknowns of the largest system."""
        largest = max(p * k for p, k in levels(max(self.degrees), self.cuts, self.fixed))
        return unknowns(self.pattern, largest)


def requirements(
    tolerance: float, places: Places, exponent: float, responses: Sequence[HalfPlane],
    planes: Sequence[complex] = (),
) -> Requirements:  # fmt: skip
    """Requirements on a mesh, by the points where stresses are output.

    Args:
        tolerance: relative accuracy.
        places: points where stresses are output.
        exponent: of the strongest singularity of the pressure.
        responses: of the solid, one a speed.
        planes: p of the planes X + pY in which the mesh is drawn.
    """
    spread = max(response.spread for response in responses)
    margin = min(response.margin for response in responses)
    on_surface = np.column_stack([places.X, 0.0 * places.X])
    X, Y = np.concatenate([on_surface, places.points, places.around]).T
    if not len(X):
        return Requirements(tolerance, exponent=exponent, spread=spread, margin=margin)
    nearest = np.hypot(np.abs(X) - 1.0, Y).min()
    farthest = max(float(np.abs(X + p * Y).max()) for p in {1j, *planes})
    around, inside = bool(len(places.around)), bool(len(places.points))
    return Requirements(
        tolerance, max(float(nearest), _NEAREST), farthest, exponent, around, inside, spread,
        margin=margin,
    )  # fmt: skip


def required_of_free_ends(required: Requirements, incompressible: bool) -> Requirements:
    """Requirements for free ends, where stresses are finite: larger cells do, with less rounding.

    Stresses go with the power a of the distance, 1/2 without friction: cells of a size e miss e^a.

    Args:
        required: requirements for sharp ends.
        incompressible: True where the solid is nearly so.
    """
    if required.nearest is None:
        return required
    a, near = 1.0 + required.exponent, _NEAR_INCOMPRESSIBLE if incompressible else NEAR_FREE_END
    return replace(no_nearer(required, near ** (0.5 / a)), exponent=a)


def required_of_pieces(required: Requirements, knots: NDArray) -> Requirements:
    """Requirements for every piece of a prescribed pressure, over the narrowest one's half-width."""
    farthest = (1.0 + required.farthest) / (np.diff(knots).min() / 2.0)
    return Requirements(
        required.tolerance, NEAR, farthest, spread=required.spread, margin=required.margin
    )


def levels(degree: int, cuts: int, fixed: bool) -> list[tuple[int, int]]:
    """Degrees and cuts to solve with: the last gives the results, the others measure its error."""
    if fixed:
        return [(degree + 1, cuts // 2 if cuts >= _MANY else cuts), (degree, cuts)]
    return [(degree - 2, cuts), (degree - 1, cuts), (degree, cuts)]


def unknowns(mesh: QuadMesh, p: int) -> int:
    """Unknowns at degree p, two a node: p - 1 nodes an edge (Euler's formula), (p - 1)² a cell.

    Cells cut into k x k at the degree p have as many as those of the mesh at the degree k p.
    """
    cells, vertices = len(mesh.cells), len(mesh.points)
    edges = cells + vertices - 1
    return 2 * (vertices + edges * (p - 1) + cells * (p - 1) ** 2)


class Planned(Protocol):
    """Plan of a scene, as far as finite elements need it.

    Attributes:
        fem: plan of the finite elements.
        tasks: speeds to solve, each a :class:`galinx.solvers.contact.solution.Task`.
    """

    @property
    def fem(self) -> FemPlan | None: ...
    @property
    def tasks(self) -> Any: ...

    def asks(self, word: str, method: str = "") -> bool:
        """True where a quantity of this name in output.quantities is computed, by a method or by any."""


class Messages(Protocol):
    """Messages to the user while work goes on."""

    def say(self, text: str) -> None:
        """Say what is done now."""


#: Tolerance over the scene's of the finer cells, tried where no degree reaches the scene's tolerance.
_FINER = 0.03


def on_finer_cells(plan: FemPlan) -> FemPlan:
    """Plan with cells for a tighter tolerance, and twice as many of them in angle and in distance."""
    target = replace(plan.wanted, tolerance=_FINER * plan.tolerance)
    rings = plan.kind.refinement(target)
    columns = tuple(width / 2.0 for width in rings.columns for _ in range(2))
    refinement = replace(
        rings, levels=2 * rings.levels, ratio=rings.ratio**0.5, sectors=2 * rings.sectors, columns=columns
    )
    return replace(plan, wanted=target, refinement=refinement)
