"""Stresses from the displacement fields of a speed, on the surface and inside."""

from collections.abc import Sequence
from typing import Any

from numpy.typing import NDArray

from galinx.app.plan.plan import INSIDE, Plan
from galinx.postprocess.stresses import flatness, stresses_inside, σ_XX_on_surface
from galinx.solvers.fem.interior import InteriorGradients
from galinx.solvers.fem.space import Space
from galinx.solvers.fem.surface import SurfaceSlopes
from galinx.solvers.solids.isotropic import MovingFrame


class Displacement:
    """What the plan wants to know of combinations of some fields; derivatives are taken once.

    Args:
        frame: constants of the moving frame.
        space: the finite element space.
        fields: displacements over N/(2μ).
        plan: says whether surface and inside are wanted, and where.
    """

    def __init__(self, frame: MovingFrame, space: Space, fields: Sequence[Any], plan: Plan) -> None:
        self._κ, self._grid = frame.κ, plan.grid
        self._slopes = SurfaceSlopes(space, fields, plan.grid) if plan.surface else None
        self._gradients = None
        if plan.interior:
            self._gradients = InteriorGradients(space, frame.κ, frame.c, fields, plan.points)

    def on_surface(self, weights: NDArray, σ_YY: NDArray) -> dict[str, NDArray]:
        """Surface datasets of states with these weights and contact stress over N/(2a)."""
        if self._slopes is None:
            return {}
        u_X, v_X = self._slopes.of(weights)
        return {
            "states/fem/slope_under_punch": flatness(self._grid, v_X),
            "surface/fem/sigma_YY": σ_YY,
            "surface/fem/sigma_XX": σ_XX_on_surface(self._κ, u_X, σ_YY),
        }

    def inside(self, weights: NDArray) -> dict[str, NDArray]:
        """Interior datasets of states with these weights."""
        if self._gradients is None:
            return {}
        stresses = stresses_inside(self._κ, self._gradients.of(weights))
        return {f"interior/fem/sigma_{ij}": values for ij, values in zip(INSIDE, stresses)}
