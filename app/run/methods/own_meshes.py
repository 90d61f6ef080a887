"""What punches share whose contacts have a mesh of their own for every state."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.task import OWN_MESHES_KEPT, Task
from galinx.app.run.methods.discretisation import Discretisation
from galinx.app.run.methods.ladder import WorkDone
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.sie.found import Exponents
from galinx.solvers.solution import Body, Surface, Turns

#: What is known of every surface.
_ON_SURFACE = ("σ_YY", "σ_XX", "v_X")


class OwnMeshesAtSpeed:
    """Contacts at one speed, each solved when it is asked for; the last few are kept.

    Args:
        work: gives spaces.
        task: the speed.
    """

    def __init__(self, work: Discretisation, task: Task) -> None:
        self.work, self.task = work, task
        self._record: dict[str, Any] = {"cells": 0, "unknowns": 0, "degree": 0}
        self._done = WorkDone()
        #: By σ_XY/σ_YY and load, those that were asked for last at last.
        self._known: dict[tuple[float, float], Any] = {}

    def record(self) -> dict[str, Any]:
        return self._record | vars(self._done)

    def destroy(self) -> None:
        """Free what states hold."""
        for state in self._known.values():
            state.destroy()

    def _solve(self, g: float, load: float) -> Any:
        """A contact, with numbers of its work in ``record``, at σ_XY/σ_YY under a load [N/m]."""
        raise NotImplementedError

    def _state(self, g: float, load: float) -> Any:
        state = self._known.pop((g, load), None)
        if state is None:
            state = self._solve(g, load)
            for name, value in state.record.items():
                self._record[name] = max(self._record.get(name, value), value)
        self._known[g, load] = state
        while len(self._known) > OWN_MESHES_KEPT:
            self._known.pop(next(iter(self._known))).destroy()
        return state


@dataclass(frozen=True)
class OnOwnMeshes:
    """Punches with several frictions and loads, each with its own half-width and middle.

    Attributes:
        task: their speed.
        g: σ_XY/σ_YY, (states,).
        found: of each; of some loads the same where contacts are alike.
        body: what slides over what, under the load of each.
    """

    task: Task
    g: NDArray[np.float64]
    found: list[Any]
    body: Body

    @cached_property
    def local(self) -> Exponents:
        """Exponents at the ends."""
        flat = FlatPunch(self.task.response, self.g)
        return Exponents(flat.α + 1.0, flat.β + 1.0)

    @property
    def K_I(self) -> NDArray[np.float64]:
        """At the left and the right end: none, by condition, (states, 2)."""
        return np.zeros((len(self.g), 2))

    @property
    def normal_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return np.array([state.level.contact.normal.sum() for state in self.found])

    @property
    def tangential_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return np.array([state.level.contact.tangential.sum() for state in self.found])

    @cached_property
    def estimates(self) -> dict[str, NDArray[np.float64]]:
        """Relative errors, (states,), by the word of output.quantities that asks for what they are of."""
        words = self.found[0].estimates
        return {word: np.array([state.estimates[word] for state in self.found]) for word in words}

    @cached_property
    def surface(self) -> Surface:
        """Stresses on the surface."""
        each = [state.surface for state in self.found]
        σ_YY, σ_XX, v_X = (np.array([getattr(one, name)[0] for one in each]) for name in _ON_SURFACE)
        turns = together([one.turns for one in each if one.turns is not None])
        return Surface(self.task.places, σ_YY, σ_XX, None, v_X, turns)

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points inside, (3, states, m)."""
        return np.stack([state.inside for state in self.found], axis=1)


def together(each: list[Turns]) -> Turns | None:
    """Of one state each, as many places as the state with most has; None of none."""
    if not each:
        return None
    most = max(one.X.shape[1] for one in each)
    X, σ = np.full((len(each), most), np.nan), np.full((3, len(each), most), np.nan)
    for i, one in enumerate(each):
        X[i, : one.X.shape[1]], σ[:, i, : one.X.shape[1]] = one.X[0], one.σ[:, 0]
    return Turns(X, σ)
