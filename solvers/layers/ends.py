"""Where a contact with two free ends over layers ends, for any convex profile.

With T the operator of the equation in :mod:`galinx.solvers.layers.contact`, its adjoint is, but for the
sign, that of the same contact seen from the other side: -q for q, and -K(-x) for K(x). Let ρ₁ be the
pressure of a flat punch there, and ρ₂ that under the slope 1 without a resultant. A pressure σ that
vanishes at both ends under the slope f, T σ = f, then has ∫ ρ f = -∫ (-T* ρ) σ, so that

    ∫ ρ₁ P'(m + h s) ds = 0,        N/μ = h ∫ ρ₂ P'(m + h s) ds.

Both ρ are smooth functions over w = (1 - s)^a (1 + s)^b, whatever the profile is; without layers ρ₁ is
1/w and ρ₂ is s/w but for factors, and these are the conditions of :mod:`galinx.solvers.sie.ends`.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from galinx.solvers.errors import SolveError
from galinx.solvers.layers.contact import Equation, Resolution
from galinx.solvers.layers.panelled import Panels
from galinx.solvers.layers.pressure import Pressure
from galinx.solvers.profiles import kinks

#: Steps in which a half-width is found, the largest of its logarithm, and what is rounding of it.
_STEPS, _LARGEST, _ROUNDING = 80, 1.5, 1e-13
#: By how much the load's logarithm grows with that of the half-width: before it is known, and how little
#: and how much a secant may say.
_GROWTH, _GROWTHS = 2.0, (0.3, 40.0)
#: Doublings of the middle over the half-width within which it is looked for, and what is rounding of it.
_FARTHER, _OF_MIDDLE = 12, 1e-15
#: Longest panel for a sum of so many polynomials, times their number, and at most.
_PANEL, _LONGEST = 16.0, 0.7


@dataclass(frozen=True)
class Punch:
    """A punch with both ends of its contact free, and its load; lengths over one that all share.

    Attributes:
        profile: of the punch, in m.
        unit: the length [m].
        compression: N/μ [m].
    """

    profile: Any
    unit: float
    compression: float

    def slope(self, m: float, h: float) -> Callable[[NDArray], NDArray]:
        """μ v,X over N/(2h) at places over the half-width h from the middle m."""

        def slope(r: NDArray) -> NDArray[np.float64]:
            found = np.asarray(self.profile.slope(self.unit * (m + h * r)), dtype=float)
            return 2.0 * h * self.unit / self.compression * found

        return slope

    def kinks(self, m: float, h: float) -> tuple[float, ...]:
        """Places inside the contact at which the slope or its derivative jumps."""
        at = (np.array(kinks(self.profile), dtype=float) / self.unit - m) / h
        return tuple(at[np.abs(at) < 1.0].tolist())


@dataclass(frozen=True)
class _Turned:
    """A response, or kernels, as the adjoint has them."""

    of: Any

    @property
    def n(self) -> float:
        return float(self.of.n)

    @property
    def n12(self) -> float:
        return float(self.of.n12)

    @property
    def q(self) -> float:
        return -float(self.of.q)

    @property
    def rough(self) -> bool:
        return bool(self.of.rough)

    def __call__(self, x: NDArray) -> NDArray[np.float64]:
        return -np.asarray(self.of(-np.asarray(x, dtype=float)))


@dataclass(frozen=True)
class Conditions:
    """Both conditions of contacts of one half-width.

    Attributes:
        punch: the punch.
        h: half-width.
        lifting, carrying: ρ₁ and ρ₂.
        finest: longest panel that resolves them.
    """

    punch: Punch
    h: float
    lifting: Pressure
    carrying: Pressure
    finest: float

    def _over(self, ρ: Pressure, m: float) -> float:
        """∫ ρ f ds with f the slope over N/(2h)."""
        panels = Panels(ρ.α, ρ.β, self.finest, self.punch.kinks(m, self.h))
        f = self.punch.slope(m, self.h)(panels.t)
        return float(panels.weights @ (ρ.series(panels.t) * f))

    def middle(self) -> float:
        """m at which no end pulls.

        Raises:
            SolveError: there is none.
        """

        def pulled(lean: float) -> float:
            return -self._over(self.lifting, lean * self.h)

        far = 1.0
        for _ in range(_FARTHER):
            if pulled(-far) <= 0.0 <= pulled(far):
                return self.h * float(brentq(pulled, -far, far, xtol=_OF_MIDDLE, rtol=1e-15))
            far *= 2.0
        raise SolveError(
            f"no middle of a contact of the half-width {self.h * self.punch.unit:g} m of a "
            f"{self.punch.profile.words()} was found over the layers; take a speed farther from the limit"
        )

    def off(self, m: float) -> float:
        """Logarithm of the load that such a contact takes over the wanted one.

        Minus infinity where a flat part takes none, infinity where it would take tension.
        """
        share = self._over(self.carrying, m) / 2.0
        if share == 0.0:
            return -np.inf
        return float(np.log(share)) if share > 0.0 else np.inf


def conditions(equation: Equation, resolution: Resolution, punch: Punch, h: float) -> Conditions:
    """Those of contacts of the half-width h.

    Args:
        equation: of such a contact; its slope is not asked.
        resolution: how finely it is solved.
        punch: the punch.
        h: half-width.
    """
    turned = Equation(_Turned(equation.response), _Turned(equation.kernel), equation.g, np.zeros_like)  # type: ignore[arg-type]
    parts = turned.parts(resolution, (np.zeros_like, np.ones_like), (-2.0, 0.0))
    lifting, carrying = (parts.pressure(amplitudes) for amplitudes in np.eye(2))
    return Conditions(punch, h, lifting, carrying, finest(resolution))


def vanishing(
    equation: Equation, resolution: Resolution, resultant: float = -2.0
) -> tuple[Pressure, float]:
    """The pressure of a contact whose ends are those that leave no intensity.

    What the resolution leaves of one is taken away by a little of a flat punch and of the slope 1.

    Args:
        equation: of the contact, with its slope.
        resolution: how finely it is solved.
        resultant: ∫ σ_YY dr.

    Returns:
        The pressure, and by how much its resultant over that of a punch, or its slope over that by which
        such a resultant would be carried at one end alone, was changed for that.
    """
    slopes = (equation.slope, np.zeros_like, np.ones_like)
    parts = equation.parts(resolution, slopes, (resultant, -2.0, 0.0))
    K = parts.ends
    little = np.linalg.solve(K[:, 1:], -K[:, 0])
    moved = np.abs(little) * np.abs(K[:, 1:]).max(axis=0) / np.abs(K[:, 1]).max()
    return parts.pressure(np.append(1.0, little)), float(moved.max())


def finest(resolution: Resolution) -> float:
    """Longest panel for what was solved so finely."""
    return min(resolution if isinstance(resolution, float) else _PANEL / resolution, _LONGEST)


def balanced(at: Callable[[float], tuple[float, Any]], x: float) -> tuple[float, Any]:
    """Where a growing function vanishes, by secants between what is too little and too much.

    Args:
        at: of the logarithm of a half-width gives that of the load over the wanted one, and more.
        x: to begin with.

    Returns:
        The logarithm of the half-width, and what else was given there.

    Raises:
        SolveError: it does not vanish.
    """
    growth, before, low, high = _GROWTH, None, -np.inf, np.inf
    for _ in range(_STEPS):
        off, more = at(x)
        low, high = (max(low, x), high) if off < 0.0 else (low, min(high, x))
        if before is not None and np.isfinite(off) and x != before[0]:
            secant = (off - before[1]) / (x - before[0])
            growth = secant if _GROWTHS[0] < secant < _GROWTHS[1] else growth
        step = -off / growth if np.isfinite(off) else -np.sign(off) * _LARGEST
        step = float(np.clip(step, -_LARGEST, _LARGEST))
        if abs(step) <= _ROUNDING or (
            before is not None and abs(off) <= 1e-12 and abs(off) >= abs(before[1])
        ):
            return x, more
        if not low < x + step < high and np.isfinite(high - low):
            step = (low + high) / 2.0 - x
        if np.isfinite(off):
            before = x, off
        x += step
    raise SolveError(
        f"no contact over the layers was found that carries the load: in {_STEPS} steps its half-width "
        f"came to {np.exp(x):.6g} of that at rest, and is not settled; take a speed farther from the "
        "limit"
    )
