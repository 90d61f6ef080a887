"""The static flat punch with friction in NGSolve: hp-refinement at the edges, static condensation.

Two meshes: half-discs by NGSolve's generator, and a few cells by hand in elliptic coordinates, as galinx
has them. Prints one JSON line a configuration: unknowns, processor seconds (mesh, assembly, solve and
moments; median of five) and the largest error of the pressure's first six Chebyshev moments over N.
"""

import json
import sys
import time
from statistics import median

import netgen.meshing as nm
import ngsolve as ng
import numpy as np
from netgen.geom2d import SplineGeometry
from static_punch import KAPPA, G, exact_moments


def half_discs(degree: int, levels: int, factor: float, radius: float) -> tuple[ng.Mesh, ng.CF]:
    """Half-discs whose radii grow by 8, and x/a on the contact."""
    geometry = SplineGeometry()
    edge = [geometry.AppendPoint(s, 0.0, hpref=1) for s in (-1.0, 1.0)]
    geometry.Append(["line", *edge], leftdomain=0, rightdomain=1, bc="punch")
    inner = edge
    radii = np.geomspace(3.0, radius, int(np.ceil(np.log(radius / 3.0) / np.log(8.0))) + 1)
    for i, R in enumerate(radii):
        left, low_left, bottom, low_right, right = (
            geometry.AppendPoint(*p) for p in ((-R, 0.0), (-R, -R), (0.0, -R), (R, -R), (R, 0.0))
        )
        domain, outside = i + 1, 0 if i == len(radii) - 1 else i + 2
        geometry.Append(["line", left, inner[0]], leftdomain=0, rightdomain=domain, bc="free")
        geometry.Append(["line", inner[1], right], leftdomain=0, rightdomain=domain, bc="free")
        arc = "far" if outside == 0 else "inner"
        sides = {"leftdomain": domain, "rightdomain": outside}
        for quarter in ((left, low_left, bottom), (bottom, low_right, right)):
            geometry.Append(["spline3", *quarter], bc=arc, **sides)
        inner = [left, right]
    geometry.SetDomainMaxH(1, 1.0)
    mesh = ng.Mesh(geometry.GenerateMesh(maxh=radius, quad_dominated=False, grading=0.9))
    mesh.RefineHP(levels=levels, factor=factor)
    mesh.Curve(degree)
    return mesh, ng.x


def elliptic(
    degree: int, levels: int, factor: float, columns: int, outer: float
) -> tuple[ng.Mesh, ng.CF]:
    """Cells in ξ, η with x + iy = a cosh(ξ - iη), moved to their places, and x/a on the contact."""
    cells = nm.Mesh(dim=2)
    ξ = [0.0, *np.linspace(np.pi / 2.0, outer, columns + 1)]
    points = [[cells.Add(nm.MeshPoint(nm.Pnt(x, np.pi * j / 2.0, 0.0))) for j in range(3)] for x in ξ]
    for i, name in enumerate(("punch", "free", "far"), 1):
        cells.Add(nm.FaceDescriptor(bc=i, domin=1, surfnr=i))
        cells.SetBCName(i - 1, name)
    for i in range(columns + 1):
        (a, b, c), (d, e, f) = points[i : i + 2]
        # Two triangles at each punch edge: one cell for its right angle would cost four digits.
        fans = [[a, d, e], [a, e, b], [c, b, e], [c, e, f]]
        for corners in [[a, d, e, b], [b, e, f, c]] if i else fans:
            cells.Add(nm.Element2D(1, corners))
        cells.Add(nm.Element1D([a, d], index=2))
        cells.Add(nm.Element1D([f, c], index=2))
    for j in range(2):
        cells.Add(nm.Element1D([points[0][j + 1], points[0][j]], index=1))
        cells.Add(nm.Element1D([points[-1][j], points[-1][j + 1]], index=3))
    for j in (0, 2):
        cells.AddSingularity(points[0][j], 1.0)
    mesh = ng.Mesh(cells)
    mesh.RefineHP(levels=levels, factor=factor)
    e = ng.exp(ng.x)
    x, y = (e + 1.0 / e) / 2.0 * ng.cos(ng.y), (1.0 / e - e) / 2.0 * ng.sin(ng.y)
    moved = ng.GridFunction(ng.VectorH1(mesh, order=degree))
    moved.Set(ng.CF((x - ng.x, y - ng.y)))
    mesh.SetDeformation(moved)
    return mesh, ng.cos(ng.y)


#: Mesh, degree, hp levels and factor, then outer radius over a, or columns and outer ξ: the best found.
CONFIGURATIONS = [
    (half_discs, 6, 4, 0.1, 1e4),
    (half_discs, 7, 9, 0.2, 1e6),
    (half_discs, 9, 12, 0.2, 1e8),
    (elliptic, 5, 2, 0.1, 3, 12.0),
    (elliptic, 7, 2, 0.1, 4, 16.0),
    (elliptic, 8, 4, 0.2, 5, 18.0),
]


def solve(make, degree: int, *refinement) -> tuple[int, np.ndarray]:
    """Unknowns, and the moments ∫ σ_YY T_k dr over N/2."""
    mesh, position = make(degree, *refinement)
    X = ng.H1(mesh, order=degree, dirichlet="far")
    Y = ng.H1(mesh, order=degree, dirichlet="far|punch")
    V = X * Y
    (u, v), (p, q) = V.TnT()
    # σ_XY = g σ_YY does no work on test functions (w_X, w_Y) = (p, q - g p) where q = 0 under the punch.
    du, dv, dp, dq = ng.grad(u), ng.grad(v), ng.grad(p), ng.grad(q) - G * ng.grad(p)
    pressure = (3.0 - KAPPA) / (KAPPA - 1.0) * (du[0] + dv[1])
    shear = du[1] + dv[0]
    work = (2.0 * du[0] + pressure) * dp[0] + (2.0 * dv[1] + pressure) * dq[1] + shear * (dp[1] + dq[0])
    a = ng.BilinearForm(V, condense=True)
    a += work * ng.dx
    a.Assemble()
    punch = mesh.Boundaries("punch")
    field = ng.GridFunction(V)
    field.components[1].Set(-1.0, definedon=punch)
    forces = field.vec.CreateVector()
    forces.data = a.mat * field.vec
    field.vec.data -= a.mat.Inverse(V.FreeDofs(coupling=True), inverse="umfpack") * forces
    forces.data = a.mat * field.vec
    # The polynomial that has these nodal forces, in the coordinates that the mesh was made in.
    mesh.UnsetDeformation()
    v, q = Y.TnT()
    mass = ng.BilinearForm(v * q * ng.ds("punch")).Assemble()
    stress = ng.GridFunction(Y)
    stress.vec.data = mass.mat.Inverse(Y.GetDofs(punch), inverse="umfpack") * forces[V.Range(1)]
    T = [ng.CF(1.0), position]
    while len(T) < 6:
        T.append(2.0 * position * T[-1] - T[-2])
    moments = np.array(ng.Integrate(stress * ng.CF(tuple(T)), punch, order=2 * degree + 8))
    return V.ndof, -2.0 * moments / moments[0]


def main() -> None:
    wanted = exact_moments()
    ng.SetNumThreads(1)
    for make, *numbers in CONFIGURATIONS:
        times = []
        for _ in range(6):
            started = time.process_time()
            unknowns, moments = solve(make, *numbers)
            times.append(time.process_time() - started)
        error = float(np.abs(moments - wanted).max() / 2.0)
        figures = {"tool": f"NGSolve {ng.__version__}", "configuration": (make.__name__, *numbers)}
        figures |= {"unknowns": unknowns, "cpu_seconds": median(times[1:]), "error": error}
        print(json.dumps(figures), flush=True)


if __name__ == "__main__":
    sys.exit(main())
