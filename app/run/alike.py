"""States that are alike but for their load: solved once, told under every load.

A half-plane has no length. So stresses over N/(2a) know no load under a flat punch, nor under one whose
height is a power of |X|, where the half-width alone follows the load.
"""

from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.sie.found import Exponents
from galinx.solvers.solution import Body, Surface


def under_loads(states: Callable[..., Any], body: Body, g: NDArray, load: NDArray | None) -> Any:
    """A solver's solution of states under several loads.

    Args:
        states: of the solver: solves for values of σ_XY/σ_YY and, if given, loads.
        body: the task's, whose load is the first.
        g: σ_XY/σ_YY, (states,).
        load: of each state [N/m], (states,); None where all have that of the body.
    """
    if load is None:
        return states(g)
    if not body.alike:
        return states(g, load)
    different, of = np.unique(g, return_inverse=True)
    return Alike(states(different), of, body.growth(load), lambda: states(g, load))


class Alike:
    """A solution of states that are like those of another; what is not known of these is solved for each.

    Args:
        once: solution of states of different frictions under one load.
        of: which of these each state is like, (states,).
        growth: half-width of each state over that one's, (states,).
        each: gives the solution of every state by itself, for what follows the load otherwise.
    """

    def __init__(
        self, once: Any, of: NDArray, growth: NDArray[np.float64], each: Callable[[], Any]
    ) -> None:
        self._once, self._of, self._growth, self._solved = once, of, growth, each

    @cached_property
    def _each(self) -> Any:
        return self._solved()

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):  # copies ask for what is not there yet
            raise AttributeError(name)
        return getattr(self._each, name)

    @property
    def g(self) -> NDArray[np.float64]:
        """σ_XY/σ_YY, (states,)."""
        return self._once.g[self._of]

    @property
    def local(self) -> Exponents:
        """Exponents at the ends."""
        return Exponents(self._once.local.α[self._of], self._once.local.β[self._of])

    @property
    def K_I(self) -> NDArray[np.float64]:
        """At the left and the right end, (states, 2)."""
        return self._once.K_I[self._of]

    @property
    def exponents(self) -> NDArray[np.float64]:
        """Fitted ones, (states, 2)."""
        return self._once.exponents[self._of]

    @property
    def half_width(self) -> NDArray[np.float64]:
        """Of the contact [m], (states,)."""
        return self._once.half_width[self._of] * self._growth

    @property
    def centre(self) -> NDArray[np.float64]:
        """Middle of the contact from the punch's axis [m], (states,)."""
        return self._once.centre[self._of] * self._growth

    @property
    def largest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Largest pressure over N/(2a), and its place over a, (states,)."""
        value, place = self._once.largest
        return value[self._of], place[self._of]

    @property
    def normal_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return self._once.normal_force[self._of]

    @property
    def tangential_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return self._once.tangential_force[self._of]

    @property
    def residual(self) -> NDArray[np.float64]:
        """What the pressure leaves of the integral equation, relative, (states,)."""
        return self._once.residual[self._of]

    @property
    def residual_inside(self) -> NDArray[np.float64]:
        """How far stresses inside are from line loads and equilibrium, relative, (states,)."""
        return self._once.residual_inside[self._of]

    @property
    def v0(self) -> NDArray[np.float64]:
        """Indentation over N/(2μ), (states,)."""
        return self._once.v0[self._of]

    @property
    def fitted(self) -> NDArray[np.float64]:
        """1 where other speeds told of the state, 0 where it was solved, (states,)."""
        return self._once.fitted[self._of]

    @property
    def estimates(self) -> dict[str, NDArray[np.float64]]:
        """Relative errors, (states,), by the word of output.quantities that asks for what they are of."""
        return {word: values[self._of] for word, values in self._once.estimates.items()}

    @cached_property
    def surface(self) -> Surface:
        """Stresses on the surface."""
        found = self._once.surface
        raw, v_X = (
            None if values is None else values[self._of] for values in (found.raw, found.v_X)
        )  # fmt: skip
        turns = found.turns and found.turns.of(self._of)
        return Surface(found.places, found.σ_YY[self._of], found.σ_XX[self._of], raw, v_X, turns)

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points inside, (3, states, m)."""
        return self._once.inside[:, self._of]
