"""Mode ``traction`` at one speed: σ_YY put in, σ_XY = g σ_YY."""

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from galinx.app.run.displacement import Displacement
from galinx.solvers.fem.traction import LoadedHalfPlane
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.solids.isotropic import MovingFrame

if TYPE_CHECKING:
    from galinx.app.run.finite_elements import FiniteElementRun


class LoadAtSpeed:
    """σ_YY put in, σ_XY = g σ_YY, at one speed."""

    def __init__(self, run: "FiniteElementRun", c: float, degree: int) -> None:
        self.run, self.frame = run, MovingFrame(run.κ, c)
        # One degree above the rule: no measured error corrects it here.
        self.loaded = LoadedHalfPlane(run.space(degree + 1), self.frame.κ, self.frame.c)
        self.given = run.scene.solve.pressure
        self.column: dict[float, int] = {}

    def prepare(self, g: NDArray) -> None:
        """Solve for every load; a pressure of the user's own is one load for every g."""
        for value in g if self.given == "closed_form" else [0.0]:
            self.column[value] = len(self.loaded.fields)
            self.loaded.load(self._load(value))
        loaded = self.loaded
        self.displacement = Displacement(self.frame, loaded.space, loaded.fields, self.run.plan)

    def results(self, g: NDArray) -> dict[str, NDArray]:
        run, N = self.run, self.run.scene.punch.load
        columns = np.array([self.column[self._key(value)] for value in g])
        normal = np.array(self.loaded.resultants)[columns // 2] * N / 2.0
        data = {"states/fem/normal_force": normal, "states/fem/tangential_force": g * normal}
        weights = np.zeros((len(g), len(self.loaded.fields)))
        rows = np.arange(len(g))
        weights[rows, columns], weights[rows, columns + 1] = 1.0, g
        if run.plan.surface:
            inside = np.abs(run.plan.grid) < 1.0
            r = run.plan.grid[inside]
            σ_YY = np.full((len(g), len(run.plan.grid)), np.nan)
            σ_YY[:, inside] = [self._load(self._key(value))(1.0 + r, 1.0 - r) for value in g]
            data |= self.displacement.on_surface(weights, σ_YY)
        return data | self.displacement.inside(weights)

    def record(self) -> dict[str, float]:
        space, factor = self.loaded.space, self.loaded.factor
        return {
            "cells": space.cells,
            "unknowns": space.size,
            "degree": space.degree,
            "factorisations": 1,
            "back_substitutions": factor.solves,
            "iterations": factor.iterations,
            "largest_residual": factor.largest_residual,
            "largest_condition": factor.condition,
        }

    def destroy(self) -> None:
        self.loaded.destroy()

    def _key(self, g: float) -> float:
        return g if self.given == "closed_form" else 0.0

    def _load(self, g: float) -> Callable[[NDArray, NDArray], NDArray]:
        if self.given == "closed_form":
            return FlatPunch(self.frame, g).σ_YY_by_distance
        X, σ = np.array(self.given).T
        return lambda left, right: np.interp(np.where(left < right, left - 1.0, 1.0 - right), X, σ)
