"""The kernel by which a layered half-plane differs from one of its surface's solid.

    K(x) = (1/π) Re ∫₀^∞ ΔŶ(k) e^(ikx) dk,

four functions that no friction changes. ΔŶ falls exponentially under uniform layers. Where the solid at
the surface is graded it falls like A/k: that part, with (1 - e^(-bk))/k for 1/k, is

    (1/π) [Re A log(1 + b²/x²)/2 - Im A arctan(b/x)].
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.layers.fourier import Transform, transform
from galinx.solvers.layers.medium import inverse
from galinx.solvers.layers.stack import Stack
from galinx.solvers.layers.table import Table, tabulated

#: Positions over a that are asked for at most: differences of places on the surface.
REACH = 6.5
#: First panel of wavenumbers over the inverse of the total thickness.
_FIRST = 0.2
#: Relative accuracy beyond which rounding is met.
ROUNDING = 2e-13


def wavenumbers(stack: Stack) -> float:
    """End of the first panel of wavenumbers."""
    return _FIRST / float(stack.depths[-1])


@dataclass(frozen=True)
class Kernel:
    """Kernels of a stack: u,X by σ_XY, u,X by σ_YY, v,X by σ_XY, v,X by σ_YY, times μ.

    Attributes:
        stack: layers with their substrate at a speed.
        tolerance: relative.
        reach: positions over a up to which the kernel is tabulated.
    """

    stack: Stack
    tolerance: float
    reach: float = REACH

    @cached_property
    def order(self) -> NDArray[Any]:
        """A: what k ΔŶ tends to for large k, (4,); 0 under a uniform layer."""
        if not self.stack.layers:
            return np.zeros(4, dtype=complex)
        Y = inverse(self.stack.top.down)
        return np.asarray((-1j * Y @ self.stack.layers[0].first_order() @ Y).ravel())

    @property
    def rough(self) -> bool:
        """Has it a logarithm and a jump at 0?"""
        return bool(np.any(self.order))

    @cached_property
    def _b(self) -> float:
        return float(self.stack.layers[0].H)

    def _regular(self, k: NDArray) -> NDArray[Any]:
        found = self.stack.admittance(k).reshape(-1, 4)
        if self.rough:
            found = found + self.order * (np.expm1(-k * self._b) / k)[:, None]
        return found

    @cached_property
    def transform(self) -> Transform:
        """The regular part's."""
        wanted = max(self.tolerance, 100.0 * ROUNDING if self.rough else ROUNDING)
        scale = float(np.abs(inverse(self.stack.top.down)).max())
        return transform(self._regular, wavenumbers(self.stack), wanted, scale)

    @cached_property
    def table(self) -> Table:
        """The regular part's, by position."""
        allowed = max(self.tolerance, ROUNDING) * self.transform.size / np.pi
        finest = min(float(self.stack.layers[0].H), 1.0) / 4.0
        if self.rough:
            finest *= 1e-6
        return tabulated(self.transform, finest, self.reach, allowed)

    @property
    def error(self) -> float:
        """Absolute, of the kernel."""
        return self.transform.error / np.pi + self.table.error

    def __call__(self, x: NDArray) -> NDArray[np.float64]:
        """The kernels at positions over a, none of them 0 where it is rough, (..., 4)."""
        found = self.table(x)
        if self.rough:
            ratio = self._b / np.asarray(x, dtype=float)[..., None]
            log = 0.5 * np.log1p(ratio**2)
            found = found + (self.order.real * log - self.order.imag * np.arctan(ratio)) / np.pi
        return found


@dataclass(frozen=True)
class Scaled:
    """The same with lengths over another one: contacts of all sizes see one kernel.

    Attributes:
        kernel: with lengths over a.
        size: the other length over a.
    """

    kernel: Kernel
    size: float

    @property
    def rough(self) -> bool:
        """Has it a logarithm and a jump at 0?"""
        return self.kernel.rough

    def __call__(self, x: NDArray) -> NDArray[np.float64]:
        """The kernels, (..., 4)."""
        return self.size * self.kernel(self.size * np.asarray(x, dtype=float))
