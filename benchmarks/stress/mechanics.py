"""Extremes of speed, solid, friction and units, through scenes."""

import numpy as np
from mpi4py import MPI
from row import Row, Verdict, honest, reached, scene, solved

from galinx.app.errors import BadInput
from galinx.app.plan.plan import make_plan
from galinx.app.scene.read import parse
from galinx.meshes import MESHES
from galinx.postprocess.quantities import states as of
from galinx.postprocess.quantities import stresses as at
from galinx.postprocess.quantities.quantity import CLOSED_FORM, FEM
from galinx.postprocess.quantities.runs import RECORD
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.contact.edges import from_edge
from galinx.solvers.fem.fields import surface_slopes
from galinx.solvers.fem.punch import SlidingPunch
from galinx.solvers.fem.space import Space, distribute
from galinx.solvers.solids.isotropic import Isotropic, MovingFrame, rayleigh_speed

TOLERANCE = 1e-6


def speeds() -> Row:
    """From rest to 0.999 of the Rayleigh speed."""
    κ = Isotropic(193e9, 0.25, 7860.0).κ
    c_R = rayleigh_speed(κ)
    shares = [0.1, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99, 0.995, 0.998, 0.999]
    c = [0.0, 1e-12, 4.786e-7, 1e-3, *(share * c_R for share in shares)]
    data = solved(c=c)
    true, estimate = (data[row.path].reshape(len(c), -1) for row in (of.TRUE_ERROR, of.ESTIMATE[FEM]))
    σ_XX = _in_plane_error(data).reshape(len(c), -1).max(axis=1)
    v_X = np.array([_slope_error(κ, x, int(p)) for x, p in zip(c, data[RECORD["degree"].path])])
    verdicts = [
        honest(true, estimate),
        reached(true, TOLERANCE, "up to 0.999 c_R"),
        Verdict(f"σ_XX on the surface within {σ_XX.max():.1e}, allowed 1e-4", σ_XX.max() <= 1e-4),
        Verdict(f"v,X beside the punch within {v_X.max():.1e}, allowed 1e-4", v_X.max() <= 1e-4),
        _beyond_rayleigh(c_R),
    ]
    lines = {
        "K_I": true.max(axis=1),
        "its estimate": estimate.max(axis=1),
        "σ_XX": σ_XX,
        "v,X beside": v_X,
    }
    lines |= {"residual": data[RECORD["largest_residual"].path]}
    x = 1.0 - np.array(c) / c_R
    return Row("speed", "speed, ν = 0.25 in plane strain", "1 - c/c_R (1)", x, "relative error (1)",
               lines, tuple(verdicts))  # fmt: skip


def _in_plane_error(data: dict[str, np.ndarray]) -> np.ndarray:
    """Error of σ_XX off the edges over its largest value there, (states,)."""
    off = from_edge(data[at.SURFACE_X.path]) >= 1e-2
    fem, exact = (data[at.IN_PLANE[method].path][:, off] for method in (FEM, CLOSED_FORM))
    return np.abs(fem - exact).max(axis=1) / np.abs(exact).max(axis=1)


def _slope_error(κ: float, c: float, degree: int, g: float = -0.5) -> float:
    """Error of v,X for 1.1 <= |X/a| <= 5 over its largest value there; v,X knows the Rayleigh speed."""
    fem, kind = make_plan(parse(scene(c=[c]))).fem, MESHES["confocal"]
    assert fem
    space = Space(*distribute(fem.pattern, MPI.COMM_WORLD), kind.chart, degree, terms=fem.terms)
    punch = SlidingPunch(space, MovingFrame(κ, c))
    weights = punch.states(g).weights
    X = np.concatenate([-np.linspace(1.1, 5.0, 40), np.linspace(1.1, 5.0, 40)])
    found = surface_slopes(space, punch.fields, X).of(weights)[1][0]
    punch.destroy()
    frame = MovingFrame(κ, c)
    exact = frame.n * FlatPunch(frame, g).hilbert(X)  # no stress acts there
    return float(np.abs(found - exact).max() / np.abs(exact).max())


def _beyond_rayleigh(c_R: float) -> Verdict:
    """Between the Rayleigh and the shear wave speed: closed form with a warning, no finite elements."""
    fast = (c_R * (1.0 + 1e-9), 0.95, 0.999)
    closed = all(
        "the closed form is formal" in " ".join(
            make_plan(parse(scene(c=[c], methods='["closed_form"]'))).warnings
        )
        for c in fast
    )  # fmt: skip
    refused = []
    for c in fast:
        try:
            make_plan(parse(scene(c=[c])))
            refused.append(False)
        except BadInput as error:
            refused.append(f"c_R = {c_R:.6g}" in str(error))
    return Verdict(
        "from c_R on: closed form with a warning, finite elements refused", closed and all(refused)
    )


def solids() -> Row:
    """Poisson's ratio from -0.9 to 1/2, in both planes."""
    ν = np.array([-0.9, -0.5, 0.0, 0.25, 0.4, 0.45, 0.49, 0.499, 0.4999, 0.49999, 0.5])
    lines: dict[str, np.ndarray] = {}
    true, estimate = [], []
    for plane in ("strain", "stress"):
        runs = [solved(nu=float(value), plane=plane, c=_slow_and_fast(value, plane)) for value in ν]
        errors = np.array([run[of.TRUE_ERROR.path] for run in runs])
        estimates = np.array([run[of.ESTIMATE[FEM].path] for run in runs])
        lines |= {f"K_I, plane {plane}": errors.max(axis=1), f"estimate, {plane}": estimates.max(axis=1)}
        lines[f"σ_XX, {plane}"] = np.array([_in_plane_error(run).max() for run in runs])
        true.append(errors)
        estimate.append(estimates)
    σ_XX = max(lines[f"σ_XX, {plane}"].max() for plane in ("strain", "stress"))
    verdicts = [honest(np.array(true), np.array(estimate)), reached(np.array(true), TOLERANCE, "every ν")]
    verdicts.append(Verdict(f"σ_XX on the surface within {σ_XX:.1e}, allowed 1e-4", σ_XX <= 1e-4))
    return Row("poisson", "Poisson's ratio, c = 0 and 0.9 c_R", "ν (1)", ν, "relative error (1)", lines,
               tuple(verdicts), log_x=False)  # fmt: skip


def _slow_and_fast(ν: float, plane: str) -> list[float]:
    """Rest, and 0.9 of the Rayleigh speed, which changes with ν."""
    return [0.0, 0.9 * rayleigh_speed(Isotropic(193e9, ν, 7860.0, plane).κ)]


def frictions() -> Row:
    """Friction from nothing to five times the pressure, both signs."""
    # So stiff a law has reached μ_C at the end of the stroke: f = ±μ_C.
    f = [1e-12, 1e-6, 1e-3, 0.1, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0]
    data = solved(mu_c=f, stiffness=1e9, X_over_L=[0.0, 1.0], c=[0.0, 0.6, 0.9])
    g, true = np.abs(data[of.RATIO.path]), data[of.TRUE_ERROR.path]
    estimate = data[of.ESTIMATE[FEM].path]
    some = [np.isclose(g, value, rtol=1e-9, atol=0.0) for value in f]
    lines = {
        "K_I": np.array([true[at].max() for at in some]),
        "its estimate": np.array([estimate[at].max() for at in some]),
    }
    exponents = data[of.ALPHA.path]
    verdicts = [
        honest(true, estimate),
        reached(true[g <= 1.0], TOLERANCE, "|g| <= 1"),
        reached(true, 1e-3, f"|g| <= 5, exponents {exponents.min():.3f} ... {exponents.max():.3f}"),
    ]
    return Row("friction", "friction, c = 0, 0.6 and 0.9", "|g| = |σ_XY/σ_YY| (1)", np.array(f),
               "relative error (1)", lines, tuple(verdicts))  # fmt: skip


def units() -> Row:
    """The same problem in other units: no dimensionless digit may change.

    Units are powers of two, which multiply numbers without rounding.
    """
    rows = (of.FRICTION, of.K_I_BOTH, of.K_I_LEFT[FEM], of.K_I_RIGHT[FEM], at.PRESSURE[FEM],
            at.IN_PLANE[FEM])  # fmt: skip
    reference = solved(c=[0.0, 0.6])
    labels, differences = [], []
    for length in (2.0**-30, 1.0, 2.0**30):
        for modulus in (2.0**-40, 1.0, 2.0**40):
            run = solved(
                c=[0.0, 0.6], half_width=1e-3 * length, pre_sliding=1e-4 * length,
                stiffness=25000.0 / length, E=193e9 * modulus, load=55.3e3 * modulus * length,
            )  # fmt: skip
            pairs = [(run[row.path], reference[row.path]) for row in rows]
            differences.append(max(np.nanmax(np.abs(a - b)) / np.nanmax(np.abs(b)) for a, b in pairs))
            labels.append((length, modulus))
    worst = max(differences)
    verdict = Verdict(f"lengths and moduli scaled by 2^±30 and 2^±40: digits change by {worst:.1e}, "
                      "allowed 1e-15", worst <= 1e-15)  # fmt: skip
    floor = np.maximum(differences, 1e-17)
    return Row("units", "lengths by 2^-30, 1, 2^30, moduli by 2^-40, 1, 2^40", "case (1)",
               np.arange(len(labels)) + 1.0, "change, at least 1e-17 (1)", {"largest": floor}, (verdict,),
               log_x=False)  # fmt: skip
