"""Mode ``contact`` at one speed: a rigid punch, the pressure unknown, the degree found by measuring."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.states import solid_of
from galinx.app.run.displacement import Displacement
from galinx.meshes.refine import DEGREES, truncation
from galinx.postprocess.estimate import differences, remaining
from galinx.postprocess.pressure import ContactRecovery, JacobiPressure, contact_recovery, from_moments
from galinx.solvers.fem.punch import ContactStates, SlidingPunch
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.solids.isotropic import MovingFrame

#: Change of the contact forces over the tolerance, and at most, for which no solution is refined. The
#: most keeps results on any number of ranks equal to 1e-9.
NEGLIGIBLE, NEGLIGIBLE_MOST = 1e-4, 1e-10

#: States, spread over all of a speed, whose measured error decides the degree.
PROBES = 9

if TYPE_CHECKING:
    from galinx.app.run.finite_elements import FiniteElementRun


@dataclass(frozen=True)
class Level:
    """A punch at one degree, and the maps that read its contact forces."""

    punch: SlidingPunch
    recovery: ContactRecovery

    def pressure(self, states: ContactStates, exact: FlatPunch) -> JacobiPressure:
        return from_moments(states.normal @ self.recovery.moments, exact.α, exact.β)


class PunchAtSpeed:
    """Rigid punch, pressure unknown, at one speed."""

    def __init__(self, run: "FiniteElementRun", c: float, degree: int) -> None:
        self.run, self.frame, self.degree = run, MovingFrame(run.κ, c), degree
        self.levels: list[Level] = []
        self.solves, self.factorisations, self.iterations = 0, 0, 0
        self.residual, self.condition = 0.0, 0.0
        self.change = np.zeros(DEGREES[1] + 1)

    def prepare(self, g: NDArray) -> None:
        """Raise the degree until the measured error of sample states is within tolerance.

        Args:
            g: the speed's values of σ_XY/σ_YY, sorted.
        """
        plan, fixed = self.run.plan, self.run.scene.solve.degree is not None
        for step in (2, 1, 0):
            if fixed:
                self._add_level(g, self.degree, plan.cuts >> step)
            else:
                self._add_level(g, self.degree - step)
        probes = g[np.unique(np.linspace(0, len(g) - 1, PROBES).astype(int))]
        tolerance = self.run.scene.solve.tolerance
        self._measure(probes)
        # Where the outer radius alone spoils the tolerance, the cells need not do better than it.
        enough = max(tolerance, 1.1 * self._cut(probes).max())
        while not fixed and self.degree < DEGREES[1] and self._estimates(probes).max() > enough:
            self.degree += 1
            self._add_level(g, self.degree)
            self._measure(probes)
        punch = self.levels[-1].punch
        self.displacement = Displacement(self.frame, punch.space, punch.fields, plan)

    def results(self, g: NDArray) -> dict[str, NDArray]:
        run, level = self.run, self.levels[-1]
        states, local = level.punch.states(g), FlatPunch(self.frame, g)
        pressure = level.pressure(states, local)
        exponents = level.recovery.exponents(states.normal)
        N, μ = run.scene.punch.load, solid_of(run.scene).μ
        data = {
            "states/fem/K_I_left": pressure.K_I[:, 0],
            "states/fem/K_I_right": pressure.K_I[:, 1],
            "states/fem/alpha": exponents[:, 0],
            "states/fem/beta": exponents[:, 1],
            "states/fem/normal_force": states.normal.sum(axis=1) * N / 2.0,
            "states/fem/tangential_force": states.tangential.sum(axis=1) * N / 2.0,
            "states/fem/v0": states.v0 * N / (2.0 * μ),
            "states/fem/estimate": self._estimates(g),
        }
        if run.plan.surface:
            data["surface/fem/sigma_YY_raw"] = states.normal @ level.recovery.raw
            data |= self.displacement.on_surface(states.weights, pressure.σ_YY(run.plan.grid))
        return data | self.displacement.inside(states.weights)

    def record(self) -> dict[str, Any]:
        for level in self.levels:
            self._count(level.punch)
        space = self.levels[-1].punch.space
        return {
            "cells": space.cells,
            "unknowns": space.size,
            "degree": space.degree,
            "factorisations": self.factorisations,
            "back_substitutions": self.solves,
            "iterations": self.iterations,
            "largest_residual": self.residual,
            "largest_condition": self.condition,
            "change_by_degree": self.change.tolist() if self.change.any() else [],
        }

    def destroy(self) -> None:
        for level in self.levels:
            level.punch.destroy()

    def _add_level(self, g: NDArray, degree: int, cuts: int = 1) -> None:
        for level in self.levels[-1:]:
            level.punch.release()  # makes room for the next factor
        space = self.run.space(degree, cuts)
        negligible = min(NEGLIGIBLE * self.run.scene.solve.tolerance, NEGLIGIBLE_MOST)
        punch = SlidingPunch(space, self.frame.κ, self.frame.c, self.run.plan.solver, negligible)
        recovery = contact_recovery(space.contact.s, degree, space.chart, self.run.plan.grid)
        # The basis is complete before traces are taken, and the same whatever states are still to do.
        for first in range(0, len(g), self.run.plan.chunk):
            punch.states(g[first : first + self.run.plan.chunk])
        self.levels.append(Level(punch, recovery))
        if len(self.levels) > 3:
            old = self.levels.pop(0).punch
            self._count(old)
            old.destroy()

    def _count(self, punch: SlidingPunch) -> None:
        self.factorisations += 1
        self.solves += punch.factor.solves
        self.iterations = max(self.iterations, punch.factor.iterations)
        self.residual = max(self.residual, punch.factor.largest_residual)
        self.condition = max(self.condition, punch.factor.condition)

    def _measure(self, g: NDArray) -> None:
        """Find how the error goes on beyond the last degree, and what rounding does to it."""
        self._sample = self._differences(g)
        if self.run.scene.solve.degree is None:
            for degree, found in zip((self.degree - 1, self.degree), self._sample):
                self.change[degree] = found.max()
        self._rounding = self._asymmetry(g)

    def _differences(self, g: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        coarse, middle, fine = (self._quantities(level, g) for level in self.levels)
        return differences(coarse, middle), differences(middle, fine)

    def _estimates(self, g: NDArray) -> NDArray[np.float64]:
        """Estimated relative error of K_I and of the pressure's moments, (states,)."""
        left = remaining(*self._differences(g), self._sample)
        return left + self._cut(g) + self._rounding

    def _cut(self, g: NDArray) -> NDArray[np.float64]:
        """Estimated relative error from the finite outer radius, (states,)."""
        solve, at_rest = self.run.scene.solve, MovingFrame(self.frame.κ, 0.0)
        return truncation(solve.mesh, solve.tolerance, self.frame.r / at_rest.r) * np.abs(g)

    def _quantities(self, level: Level, g: NDArray) -> NDArray[np.float64]:
        """What the error is measured on, each about 1: (states, quantities)."""
        states = level.punch.states(g)
        K_I = level.pressure(states, FlatPunch(self.frame, g)).K_I
        moments = states.normal @ level.recovery.moments[:, 1:6]
        return np.column_stack([K_I * np.pi, moments / 2.0])

    def _asymmetry(self, g: NDArray) -> float:
        """Largest relative difference of K_I left at g and right at -g, which only rounding makes."""
        level = self.levels[-1]
        K_I, mirrored = (
            level.pressure(level.punch.states(sign * g), FlatPunch(self.frame, sign * g)).K_I
            for sign in (1.0, -1.0)
        )
        return float(np.abs(K_I - mirrored[:, ::-1]).max() * np.pi)
