"""Extremes of Dahl's law: its exact solution against integration, and Runge-Kutta's stability."""

import numpy as np
from numpy.typing import NDArray
from row import Row, Verdict
from scipy.integrate import solve_ivp

from galinx.solvers.friction.dahl import Dahl
from galinx.solvers.friction.integrate import RK4_STABILITY_LIMIT, runge_kutta


def exact_law() -> Row:
    """The exact solution against an adaptive integrator of high order, δ from 0.05 to 5."""
    stiffness = 10.0 ** np.arange(-6.0, 7.0)
    exponents = (0.05, 0.3, 0.999999, 1.0, 1.5, 2.0, 5.0)
    lines = {
        f"δ = {δ:g}": np.array([_difference(Dahl(0.7, 0.7 * x, δ)) for x in stiffness]) for δ in exponents
    }
    worst = max(line.max() for line in lines.values())
    verdict = Verdict(f"exact law and integration differ by {worst:.1e}, allowed 1e-9", worst <= 1e-9)
    return Row("dahl", "Dahl's law from rest and after reversal, exact against integrated",
               "λ L/μ_C (1)", stiffness, "largest difference of f/μ_C (1)",
               {name: np.maximum(line, 1e-17) for name, line in lines.items()}, (verdict,))  # fmt: skip


def _difference(law: Dahl) -> float:
    """Over a stroke of unit length from rest and from -0.9 μ_C."""
    worst = 0.0
    for f0 in (0.0, -0.9 * law.μ_C):
        # In z = ln y nothing is stiff for δ = 1; y itself would vanish below the tolerance otherwise.
        x = law.λ / law.μ_C
        end = 1.0
        y0 = 1.0 - f0 / law.μ_C
        if law.δ < 1.0:  # full slip is reached at a finite distance; beyond it both are exactly there
            end = min(end, 0.999 * y0 ** (1.0 - law.δ) / ((1.0 - law.δ) * x))
        grid = np.concatenate([[0.0], np.geomspace(1e-9, 1.0, 60)]) * end
        solution = solve_ivp(
            lambda d, z, x=x: -x * np.exp((law.δ - 1.0) * z),
            (0.0, end), [np.log(y0)], method="DOP853", t_eval=grid, rtol=1e-12, atol=1e-13,
        )  # fmt: skip
        y = np.exp(solution.y[0])
        worst = max(worst, float(np.abs(1.0 - _exact(law, f0, grid) / law.μ_C - y).max()))
        beyond = _exact(law, f0, np.array([2.0 * end])) / law.μ_C
        worst = max(worst, float(max(beyond[0] - 1.0, 0.0)))  # never above μ_C
    return worst


def _exact(law: Dahl, f0: float, d: NDArray) -> NDArray:
    """f after slip d forward from f0."""
    return law.exact(np.array([f0]), 1, 0.0, d)[:, 0]


def runge_kutta_steps() -> Row:
    """Runge-Kutta's error against its step, inside its stability limit; beyond it is refused."""
    steps = np.array([2, 4, 8, 16, 32, 64, 128, 256, 512])
    law = Dahl(0.7, 25000.0, 1.0)
    length = (1.0 - 1e-9) * 2.0 * RK4_STABILITY_LIMIT * law.μ_C / law.λ
    errors = np.array([
        np.abs(runge_kutta(law, law.rest(), 1, 0.0, length, int(n))[0][:, 0]
               - _exact(law, 0.0, np.linspace(0.0, length, n + 1))).max() / law.μ_C
        for n in steps
    ])  # fmt: skip
    slope = np.polyfit(np.log(steps[4:]), -np.log(errors[4:]), 1)[0]
    refused = 0
    factors = (1.0001, 1.1, 2.0, 1e3, 1e6)
    for factor in factors:
        try:
            runge_kutta(law, law.rest(), 1, 0.0, factor * length, 2)
        except ValueError as error:
            refused += "unstable" in str(error)
    verdicts = (
        Verdict(f"order {slope:.2f}, expected 4", abs(slope - 4.0) < 0.1),
        Verdict(f"{refused} of {len(factors)} steps beyond the limit refused", refused == len(factors)),
        Verdict("at the limit f/μ_C stays within 1", bool(errors[0] <= 1.0)),
    )
    return Row("runge_kutta", f"Runge-Kutta, stable up to λ h/μ_C = {RK4_STABILITY_LIMIT:.3f}",
               "λ h/μ_C (1)", 2.0 * RK4_STABILITY_LIMIT / steps, "largest error of f/μ_C (1)",
               {"error": errors}, verdicts)  # fmt: skip
