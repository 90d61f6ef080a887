"""Where a contact with two free ends ends, for any convex profile.

With w of :mod:`galinx.solvers.sie.panels`, s over the half-width h from the middle m of the contact:

    ∫ P'(m + h s)/w ds = 0,        N/μ = h (sin πa/N̂) ∫ s P'(m + h s)/w ds.

Newton's method finds m/h and log h; a step that makes it worse is halved.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.errors import SolveError
from galinx.solvers.profiles import jumps, kinks
from galinx.solvers.sie.panels import Panels, ends_of_panels

#: Most steps, most halvings of one, and what of a residual is rounding.
_STEPS, _HALVINGS, _ROUNDING = 60, 40, 1e-14
#: Step for the derivatives; largest change of m/h and of log h in a step.
_ε, _LARGEST = 1e-6, (0.5, 1.5)
#: Doublings of the half-width within which a load is looked for, and of the centre over it.
_DOUBLINGS, _FARTHER = 60, 12
#: Logarithm of the load carried over that wanted from which Newton's method serves.
_ROUGHLY = 3.0


@dataclass(frozen=True)
class Balance:
    """Both conditions of a contact with free ends.

    Attributes:
        profile: of the punch.
        a: exponent of the pressure at the right end.
        size: N N̂/(μ sin πa) [m].
    """

    profile: Any
    a: float
    size: float

    def panels(self, centre: float, half_width: float) -> Panels:
        """Quadrature over a contact, lengths in m."""
        at = (np.array(kinks(self.profile), dtype=float) - centre) / half_width
        # A power is no smooth function on either side of its kink; jumps and parabolas are.
        k = getattr(self.profile, "exponent", 1.0)
        return Panels(self.a, ends_of_panels(at, rough=not jumps(self.profile) and k != round(k)))

    def slope(self, panels: Panels, centre: float, half_width: float) -> NDArray[np.float64]:
        """P' at the panels' points."""
        return np.asarray(self.profile.slope(centre + half_width * panels.t), dtype=float)

    def residual(self, lean: float, size: float) -> NDArray[np.float64]:
        """Both conditions at m/h and log h, 0 where they are met, (2,); infinite without any load."""
        h = float(np.exp(size))
        panels = self.panels(lean * h, h)
        slope = self.slope(panels, lean * h, h)
        whole = panels.weights @ np.abs(slope)
        lifted, carried = panels.weights @ slope, h * (panels.weights @ (panels.t * slope))
        if not (whole > 0.0 and carried > 0.0):
            return np.array([np.inf, np.inf])
        return np.array([lifted / whole, np.log(carried / self.size)])


def free_ends(balance: Balance, start: tuple[float, float] | None = None) -> tuple[float, float]:
    """Centre and half-width [m] of the contact.

    Args:
        balance: what has to hold.
        start: centre and half-width near by.

    Raises:
        SolveError: it was not found; the message says what was tried.
    """
    point = np.array([start[0] / start[1], np.log(start[1])]) if start else _first(balance)
    value, told = balance.residual(*point), []
    for _ in range(_STEPS):
        size = float(np.abs(value).max())
        told.append(size)
        if size <= _ROUNDING:
            break
        step = _newton(balance.residual, point, value)
        for halving in range(_HALVINGS):
            moved = point + 0.5**halving * step
            found = balance.residual(*moved)
            if np.abs(found).max() < size:
                break
        else:
            break  # nothing better is near: rounding, or no contact
        point, value = moved, found
    if not told[-1] <= 1e3 * _ROUNDING:
        raise SolveError(
            f"the ends of the contact of a {balance.profile.words()} were not found: after {len(told)} "
            f"steps the conditions are off by {told[-1]:.3g}, wanted {_ROUNDING:g}; centre over "
            f"half-width {point[0]:.6g}, half-width {np.exp(point[1]):.6g} m; the residuals were "
            + ", ".join(f"{size:.2g}" for size in told[-6:])
        )
    h = float(np.exp(point[1]))
    return float(point[0]) * h, h


def _newton(residual: Callable[..., NDArray], point: NDArray, value: NDArray) -> NDArray[np.float64]:
    """Newton's step, within limits; derivatives by differences."""
    steps = np.diag([_ε, _ε])
    J = np.column_stack([(residual(*(point + d)) - residual(*(point - d))) / (2.0 * _ε) for d in steps])
    if not np.all(np.isfinite(J)) or np.linalg.matrix_rank(J) < 2:
        return np.array([-np.sign(value[0]) * 0.1, 0.1])
    step = np.linalg.solve(J, -value)
    return step / max(1.0, *(np.abs(step) / _LARGEST))


def _first(balance: Balance) -> NDArray[np.float64]:
    """A contact that carries about the load: m/h and log h."""
    size = float(np.log(1e-3))
    narrow, wide = -np.inf, np.inf
    for _ in range(_DOUBLINGS):
        lean = _lean(balance, size)
        carried = balance.residual(lean, size)[1]
        # Infinite: in a flat part, which carries nothing unless the contact is wider.
        if not np.isfinite(carried) or carried < 0.0:
            narrow = size
        else:
            wide = size
        found = np.isfinite(narrow) and np.isfinite(wide)
        if found and np.isfinite(carried) and abs(carried) < _ROUGHLY:
            return np.array([lean, size])
        if found:
            size = (narrow + wide) / 2.0
        else:
            size += np.log(2.0) if np.isfinite(narrow) else -np.log(2.0)
    raise SolveError(
        f"no contact of a {balance.profile.words()} carries the load: half-widths up to "
        f"{np.exp(size):.3g} m were tried; the profile has to be convex"
    )


def _lean(balance: Balance, size: float) -> float:
    """m/h at which the ends do not pull, roughly; by halving."""
    h, far = float(np.exp(size)), 1.0

    def pulled(lean: float) -> float:
        panels = balance.panels(lean * h, h)
        return float(panels.weights @ balance.slope(panels, lean * h, h))

    for _ in range(_FARTHER):
        if pulled(-far) <= 0.0 <= pulled(far):
            break
        far *= 2.0
    # Where a flat part holds all of the contact nothing pulls: the middle of these places is taken.
    edges = []
    for beyond in (np.less, np.less_equal):
        low, high = -far, far
        for _ in range(12 + int(np.log2(far))):
            middle = (low + high) / 2.0
            low, high = (middle, high) if beyond(pulled(middle), 0.0) else (low, middle)
        edges.append((low + high) / 2.0)
    return float(np.mean(edges))
