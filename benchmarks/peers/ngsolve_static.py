"""The static flat punch with friction in NGSolve: hp-refinement at the edges, static condensation.

Prints one JSON line a configuration: unknowns, processor seconds (mesh, assembly, solve and moments;
median of five) and the largest error of the pressure's first six Chebyshev moments over N.
"""

import json
import sys
import time
from statistics import median

import ngsolve as ng
import numpy as np
from netgen.geom2d import SplineGeometry
from static_punch import KAPPA, G, exact_moments

#: Degree, hp levels, hp factor, outer radius over a: the best found for errors of 1e-3 … 1e-9.
CONFIGURATIONS = [
    (4, 5, 0.2, 1e3),
    (5, 6, 0.2, 1e4),
    (6, 7, 0.2, 1e5),
    (7, 9, 0.2, 1e6),
    (8, 10, 0.2, 1e7),
    (9, 12, 0.2, 1e8),
]


def half_plane(levels: int, factor: float, radius: float, degree: int) -> ng.Mesh:
    """Half-discs whose radii grow by 8, with hp-refinement towards the punch edges."""
    count = int(np.ceil(np.log(radius / 3.0) / np.log(8.0))) + 1
    radii = np.geomspace(3.0, radius, count)
    geometry = SplineGeometry()
    x = [-1.0, 1.0]
    edge = [geometry.AppendPoint(s, 0.0, hpref=1) for s in x]
    geometry.Append(["line", *edge], leftdomain=0, rightdomain=1, bc="contact")
    inner = edge
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
    return mesh


def solve(degree: int, levels: int, factor: float, radius: float) -> tuple[int, np.ndarray]:
    """Unknowns, and the moments ∫ σ_YY T_k dr over N/2."""
    mesh = half_plane(levels, factor, radius, degree)
    V = ng.VectorH1(mesh, order=degree, dirichlet="far", dirichlety="contact|far")
    u, w = V.TnT()

    def strain(d):
        return ng.Sym(ng.Grad(d))

    lame = (3.0 - KAPPA) / (KAPPA - 1.0)
    a = ng.BilinearForm(V, symmetric=False, condense=True)
    shear = ng.InnerProduct(strain(u), strain(w))
    a += (2.0 * shear + lame * ng.Trace(strain(u)) * ng.Trace(strain(w))) * ng.dx
    a.Assemble()
    half = V.ndof // 2
    on_contact = V.components[1].GetDofs(mesh.Boundaries("contact"))
    contact = np.array([i for i in range(half) if on_contact[i]])
    rows, columns, values = (np.asarray(part) for part in a.mat.COO())
    is_contact = np.zeros(V.ndof, dtype=bool)
    is_contact[half + contact] = True
    # Test functions with w_Y + g w_X = 0: row X takes in -g times row Y.
    extra = is_contact[rows]
    reactions = (rows[extra], columns[extra], values[extra])
    rows = np.concatenate([rows, rows[extra] - half])
    columns = np.concatenate([columns, columns[extra]])
    values = np.concatenate([values, -G * values[extra]])
    coo = (part.tolist() for part in (rows, columns, values))  # lists are read faster than arrays
    A = ng.la.SparseMatrixd.CreateFromCOO(*coo, V.ndof, V.ndof)
    field = ng.GridFunction(V)
    field.components[1].Set(-1.0, definedon=mesh.Boundaries("contact"))
    residual = field.vec.CreateVector()
    residual.data = -(A * field.vec)
    free = V.FreeDofs(coupling=True)
    field.vec.data += A.Inverse(free, inverse="umfpack") * residual
    result = field.vec.FV().NumPy()
    force = np.zeros(V.ndof)
    np.add.at(force, reactions[0], reactions[2] * result[reactions[1]])
    moments = []
    test = ng.GridFunction(V.components[1])
    for k in range(6):
        T = [ng.CF(1.0), ng.x]
        while len(T) <= k:
            T.append(2.0 * ng.x * T[-1] - T[-2])
        test.Set(T[k], definedon=mesh.Boundaries("contact"))
        moments.append(test.vec.FV().NumPy()[contact] @ force[half + contact])
    moments = np.array(moments)
    return V.ndof, -2.0 * moments / moments[0]


def main() -> None:
    wanted = exact_moments()
    ng.SetNumThreads(1)
    for configuration in CONFIGURATIONS:
        times = []
        for _ in range(6):
            started = time.process_time()
            unknowns, moments = solve(*configuration)
            times.append(time.process_time() - started)
        error = float(np.abs(moments - wanted).max() / 2.0)
        figures = {"tool": f"NGSolve {ng.__version__}", "configuration": configuration}
        figures |= {"unknowns": unknowns, "cpu_seconds": median(times[1:]), "error": error}
        print(json.dumps(figures), flush=True)


if __name__ == "__main__":
    sys.exit(main())
