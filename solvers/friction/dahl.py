"""Dahl's dynamic friction law (Eqs 2-5, 44-51).

Along one stroke of direction s = ±1 the friction coefficient f = F/N obeys::

    df/dd = s λ sgn(y) |y|^δ,   y = 1 - s f/μ_C

with d >= 0 the slip [m] since the last reversal, λ = σ₀ l/N [1/m], μ_C Coulomb's coefficient and δ
the exponent of the law (both dimensionless).
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

#: Limit of |λ h δ/μ_C| on the negative real axis for the classical Runge-Kutta scheme.
RK4_STABILITY_LIMIT = 2.785293563405282


@dataclass(frozen=True)
class Dahl:
    """Parameters of the law: ``μ_C`` > 0, ``λ`` = σ₀ l/N > 0 [1/m], ``δ`` > 0 (dimensionless)."""

    μ_C: float
    λ: float
    δ: float = 1.0

    def __post_init__(self) -> None:
        for name in ("μ_C", "λ", "δ"):
            value = getattr(self, name)
            if not 0.0 < value < float("inf"):
                raise ValueError(f"{name} = {value!r}: expected a finite positive number")

    def rate(self, f: ArrayLike, s: int) -> NDArray[np.float64]:
        """Rate |df/dd|/λ at friction ``f`` in direction ``s``, dimensionless (k of Table 1)."""
        y = 1.0 - s * np.asarray(f, dtype=float) / self.μ_C
        return np.sign(y) * np.abs(y) ** self.δ


def exact(law: Dahl, f0: float, s: int, d: ArrayLike) -> NDArray[np.float64]:
    """Friction coefficient after slip ``d`` from the value ``f0``, by the law's exact solution.

    δ = 1: y = y₀ exp(-λ d/μ_C); otherwise |y|^(1-δ) = |y₀|^(1-δ) - (1-δ) λ d/μ_C, and for δ < 1 full
    slip, y = 0, is reached after a finite distance.

    Args:
        law: parameters.
        f0: value at the start of the stroke, dimensionless.
        s: direction, +1 forward or -1 backward.
        d: slip since the start of the stroke [m], any shape.

    Returns:
        f, dimensionless, of the shape of ``d``.
    """
    x = law.λ * np.asarray(d, dtype=float) / law.μ_C
    y0 = 1.0 - s * f0 / law.μ_C
    p = 1.0 - law.δ
    if y0 == 0.0:
        y = np.zeros_like(x)
    elif abs(p) * max(1.0, abs(np.log(abs(y0)))) < 1e-9:
        # Both formulas agree to the last digits here, and the power would divide by p ≈ 0.
        y = y0 * np.exp(-x)
    else:
        # |y| = |y₀| (1 - p x |y₀|^(-p))^(1/p), through log1p so that p → 0 keeps its digits.
        base = np.maximum(-p * x * abs(y0) ** -p, -1.0)
        with np.errstate(divide="ignore"):
            y = y0 * np.exp(np.log1p(base) / p)
    return s * law.μ_C * (1.0 - y)


@dataclass(frozen=True)
class RungeKuttaSteps:
    """The steps of one stroke: slip ``d`` [m], friction ``f`` and slopes ``k`` (4 per row)."""

    d: NDArray[np.float64]
    f: NDArray[np.float64]
    k: NDArray[np.float64]


def runge_kutta(law: Dahl, f0: float, s: int, length: float, steps: int) -> RungeKuttaSteps:
    """Integrate one stroke with the classical Runge-Kutta scheme, as the study does (Eqs 46-50).

    Eq 49 prints its second intermediate value wrongly; Table 1 follows the usual scheme, and so does
    this function.

    Args:
        law: parameters.
        f0: friction at the start, dimensionless.
        s: direction, +1 or -1.
        length: length of the stroke [m].
        steps: number of steps, the study uses 20.

    Returns:
        ``steps + 1`` rows; the last row's slopes belong to the step that would follow.

    Raises:
        ValueError: the step is beyond the scheme's stability limit or below one step was asked for.
    """
    if steps < 1:
        raise ValueError(f"steps = {steps!r}: expected at least 1")
    h = length / steps
    stiffness = law.λ * h * law.δ * max(1.0, abs(1.0 - s * f0 / law.μ_C)) ** (law.δ - 1.0) / law.μ_C
    if stiffness > RK4_STABILITY_LIMIT:
        raise ValueError(
            f"Runge-Kutta is unstable here: λ h/μ_C = {stiffness:.4g} (dimensionless) exceeds "
            f'{RK4_STABILITY_LIMIT:.3f}; use integrator = "exact", or more steps than {steps}'
        )
    f, k = np.empty(steps + 1), np.empty((steps + 1, 4))
    gain = s * law.λ * h
    value: Any = f0
    for i in range(steps + 1):
        k1 = law.rate(value, s)
        k2 = law.rate(value + gain * k1 / 2.0, s)
        k3 = law.rate(value + gain * k2 / 2.0, s)
        k4 = law.rate(value + gain * k3, s)
        f[i], k[i] = value, (k1, k2, k3, k4)
        value += gain * (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0
    return RungeKuttaSteps(np.linspace(0.0, length, steps + 1), f, k)
