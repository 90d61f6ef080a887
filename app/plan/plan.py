"""Which work a scene needs, derived from the outputs it asks for."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from galinx.app import ranks
from galinx.app.errors import BadInput
from galinx.app.plan import cost
from galinx.app.plan.states import solid_of, speeds
from galinx.app.scene.scene import Scene
from galinx.meshes import store
from galinx.meshes.halfplane import MESHES
from galinx.meshes.refine import degree, reach, refinement, truncation
from galinx.meshes.rings import QuadMesh, Refinement
from galinx.solvers.solids.isotropic import MovingFrame, rayleigh_speed

#: Components of the stress tensor that are archived inside.
INSIDE = ("XX", "YY", "XY")

#: What is recorded of the finite element work at a speed.
RECORD = (
    "c", "cells", "unknowns", "degree", "factorisations", "back_substitutions", "iterations",
    "largest_residual", "largest_condition",
)  # fmt: skip

#: κ - 1 below which the pressure becomes an unknown of its own: ν > 0.49 in plane strain.
MIXED = 0.04

#: Floating-point numbers that the states of a chunk may have at once.
CHUNK_NUMBERS = 2_000_000

#: Unknowns up to which a rank solves a speed alone faster than two ranks together.
SMALL = 200_000


@dataclass(frozen=True)
class SpeedPlan:
    """Finite element work at one speed.

    Attributes:
        c: speed over shear wave speed.
        degree: polynomial degree to begin with; the measured error may ask for more.
    """

    c: float
    degree: int


@dataclass(frozen=True)
class Plan:
    """Steps of a scene.

    Attributes:
        states: number of states.
        closed_form, fem, surface, interior: whether these are needed.
        grid: positions X/a of surface stresses, (n,).
        points: positions X/a, Y/a of stresses inside, (n, 2).
        mixed: finite elements with an unknown pressure, for nearly and fully incompressible solids.
        refinement: of the one mesh all speeds share, before it is cut; None without finite elements.
        cuts: of every cell's sides.
        solver: ``"direct"``, ``"boomeramg"``, ``"gamg"``, or ``"multigrid"`` for the better of these two.
        speeds: finite element work by speed.
        shared_speeds: speeds are shared out over the ranks, each rank with a mesh of its own; else
            all ranks share one mesh.
        skipped: what is not done, and why.
        warnings: what the user should know before starting.
    """

    states: int
    closed_form: bool
    fem: bool
    surface: bool
    interior: bool
    grid: NDArray[np.float64]
    points: NDArray[np.float64]
    mixed: bool
    refinement: Refinement | None
    cuts: int
    solver: str
    speeds: tuple[SpeedPlan, ...]
    shared_speeds: bool
    skipped: tuple[str, ...]
    warnings: tuple[str, ...]

    @property
    def chunk(self) -> int:
        """States treated at once: what they hold in memory is bounded."""
        numbers = 5 * len(self.grid) * self.surface + 10 * len(self.points) * self.interior
        return int(np.clip(CHUNK_NUMBERS // max(numbers, 1), 1, 1000))


def make_plan(scene: Scene) -> Plan:
    """Plan the work; looks at the scene only, does none of it.

    Raises:
        BadInput: finite elements are asked for where they have no answer.
    """
    asked, friction = set(scene.output.quantities), scene.friction
    contact = bool(asked - {"friction"})
    fem = contact and "fem" in scene.solve.methods
    closed = contact and "closed_form" in scene.solve.methods and has_closed_form(scene)
    all_speeds = tuple(dict.fromkeys(speeds(scene)))
    count = (
        len(speeds(scene)) * len(friction.mu_c) * len(friction.sigma0_over_load)
        * len(friction.delta) * len(scene.motion.strokes) * len(set(scene.motion.X_over_L))
    )  # fmt: skip
    points = np.reshape(scene.output.inside, (-1, 2))
    warnings = [*scene.warnings, *_speed_limits(scene, all_speeds, fem)]
    if len(points):
        _check_points(scene, points, fem)
    speed_plans: tuple[SpeedPlan, ...] = ()
    mesh = None
    mixed = fem and solid_of(scene).κ - 1.0 < MIXED
    if fem:
        κ, tolerance, name = solid_of(scene).κ, scene.solve.tolerance, scene.solve.mesh
        mesh = refinement(name, tolerance, MovingFrame(κ, max(all_speeds)).β_s)
        rest = MovingFrame(κ, 0.0).r
        speed_plans = tuple(
            SpeedPlan(
                c,
                scene.solve.degree or max(degree(name, tolerance, MovingFrame(κ, c).r / rest), 4 + mixed),
            )
            for c in all_speeds
        )
        if truncation(name, tolerance) > tolerance:
            warnings.append(
                f"the outer boundary of the {name} mesh alone costs about "
                f"{truncation(name, tolerance):.1g} (relative, with friction), more than the "
                f'tolerance {tolerance:g}; use mesh = "confocal" or "graded"'
            )
    solver = _solver(scene, mesh, speed_plans, mixed)
    if mesh:
        needed, free = _memory(scene, mesh, speed_plans, solver == "direct"), cost.free_memory()
        if needed > free:
            warnings.append(
                f"the finite elements need about {needed / 1e9:.2g} GB, of which this machine has "
                f"{free / 1e9:.2g} GB free: use fewer cuts, a larger tolerance, or more machines"
            )
    return Plan(
        count, closed, fem, contact and "surface" in asked, contact and "interior" in asked,
        surface_grid(), points, mixed, mesh, scene.solve.cuts, solver, speed_plans,
        _share_speeds(scene, mesh, speed_plans),
        tuple(_skipped(scene, contact, closed, mesh)), tuple(warnings),
    )  # fmt: skip


def _check_points(scene: Scene, points: NDArray, fem: bool) -> None:
    far = np.abs(points).max()
    if fem and far > 0.6 * reach(scene.solve.mesh, scene.solve.tolerance):
        limit = 0.6 * reach(scene.solve.mesh, scene.solve.tolerance)
        raise BadInput(
            f"output.points: found a coordinate of {far:g} a, expected at most {limit:g} a with the "
            f"{scene.solve.mesh} mesh at the tolerance {scene.solve.tolerance:g}"
        )
    if fem and solid_of(scene).κ - 1.0 < MIXED:
        raise BadInput(
            f"output.points: found ν = {scene.solid.nu:g} in plane strain, expected ν <= 0.49 for "
            'stresses inside from finite elements; use methods = ["closed_form"]'
        )


def _solver(scene: Scene, mesh: Refinement | None, speeds: tuple[SpeedPlan, ...], mixed: bool) -> str:
    """What was asked for, or else a factor where memory has room for it: in the plane it is the fastest.

    Raises:
        BadInput: multigrid is asked for where the matrix is indefinite, or the degree too low.
    """
    wanted = scene.solve.solver
    if scene.solve.degree and mixed and scene.solve.degree < 3:
        raise BadInput(
            f"solve.degree: found {scene.solve.degree} with ν = {scene.solid.nu:g}, expected at least 3: "
            "the pressure, an unknown of its own there, has two degrees less"
        )
    if mixed:
        if wanted in ("boomeramg", "gamg"):
            raise BadInput(
                f"solve.solver: found {wanted} with ν = {scene.solid.nu:g}, expected direct or auto: "
                "with an unknown pressure the matrix is indefinite"
            )
        return "direct"
    if wanted != "auto":
        return wanted
    if mesh is None:
        return "direct"
    needed = _memory(scene, mesh, speeds, direct=True)
    return "direct" if needed < 0.8 * cost.free_memory() else "multigrid"


def _memory(scene: Scene, mesh: Refinement, speeds: tuple[SpeedPlan, ...], direct: bool) -> float:
    """Bytes of the linear systems on all ranks together."""
    size = unknowns_of(mesh, scene.solve.cuts * max(speed.degree for speed in speeds))
    return cost.bytes_of_levels(size, direct) * (
        ranks.size() if _share_speeds(scene, mesh, speeds) else 1
    )


def _share_speeds(scene: Scene, mesh: Refinement | None, speeds: tuple[SpeedPlan, ...]) -> bool:
    """Small problems gain nothing from being cut in pieces; whole speeds are shared out instead."""
    if mesh is None or ranks.size() == 1 or len(speeds) < ranks.size():
        return False
    return unknowns_of(mesh, scene.solve.cuts * max(speed.degree for speed in speeds)) < SMALL


def has_closed_form(scene: Scene) -> bool:
    """False where a pressure of the user's own is put in."""
    return scene.solve.mode == "contact" or scene.solve.pressure == "closed_form"


def _speed_limits(scene: Scene, all_speeds: tuple[float, ...], fem: bool) -> list[str]:
    κ = solid_of(scene).κ

    def from_rayleigh_on(c: float) -> bool:
        return c >= 1.0 or MovingFrame(κ, c).r <= 0.0

    beyond = [c for c in all_speeds if from_rayleigh_on(c)]
    near = [c for c in all_speeds if c not in beyond and from_rayleigh_on(c / 0.99)]
    c_R = rayleigh_speed(κ) if beyond or near else None
    if fem and beyond:
        raise BadInput(
            f"motion: c = {', '.join(f'{c:g}' for c in beyond)} is not below the Rayleigh speed "
            f"c_R = {c_R:.6g} (over c_s): the finite element form is indefinite there and does not "
            'converge; take lower speeds, or methods = ["closed_form"]'
        )
    warnings = []
    if beyond:
        warnings.append(
            f"c = {', '.join(f'{c:g}' for c in beyond)} is not below the Rayleigh speed "
            f"c_R = {c_R:.6g} (over c_s): the closed form is formal there"
        )
    if near:
        warnings.append(
            f"c = {', '.join(f'{c:g}' for c in near)} is within 1 % of the Rayleigh speed "
            f"c_R = {c_R:.6g} (over c_s): displacements grow without bound and errors with them"
        )
    return warnings


def _skipped(scene: Scene, contact: bool, closed: bool, mesh: Refinement | None) -> list[str]:
    skipped = []
    if not contact:
        return ["contact mechanics: only friction is asked for"]
    if not closed:
        why = "not in solve.methods" if has_closed_form(scene) else "the pressure is given"
        skipped.append(f"closed form: {why}")
    if mesh is None:
        skipped.append("mesh and finite elements: fem is not in solve.methods")
    elif scene.solve.cuts == 1 and store.is_kept(MESHES[scene.solve.mesh].build(mesh)):
        skipped.append("gmsh: an earlier run made the same mesh")
    for quantity, what in (("surface", "stresses on the surface"), ("interior", "stresses inside")):
        if quantity not in scene.output.quantities:
            skipped.append(f"{what}: not in output.quantities")
    return skipped


def unknowns_of(mesh: Refinement, p: int) -> int:
    """About the same without building the mesh.

    A cell of degree p cut k times has the nodes of one of degree k p.
    """
    return 2 * p**2 * 2 * mesh.sectors * (2 * mesh.levels + mesh.sectors + len(mesh.columns))


def unknowns(mesh: QuadMesh, p: int) -> int:
    """Unknowns at degree ``p``: two a vertex, p - 1 an edge, (p - 1)² a cell, by Euler's formula."""
    cells, vertices = len(mesh.cells), len(mesh.points)
    edges = cells + vertices - 1
    return 2 * (vertices + edges * (p - 1) + cells * (p - 1) ** 2)


def surface_grid() -> np.ndarray:
    """Positions X/a of archived surface stresses: to ±5, clustered at ±1, without ±1 itself."""
    near = np.geomspace(1e-6, 0.1, 31)
    inside = np.concatenate([1.0 - near, np.linspace(0.0, 0.88, 23)])
    outside = 1.0 + np.concatenate([near, np.geomspace(0.1, 4.0, 25)[1:]])
    right = np.concatenate([inside, outside])
    return np.unique(np.concatenate([-right, right]))
