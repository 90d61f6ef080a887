"""The singular integral equation of punches whose contact ends where the pressure says."""

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.run.methods.closed_form import Punches
from galinx.postprocess.yielding.strength import Strength
from galinx.solvers.sie.found import Contacts, Exponents, contacts
from galinx.solvers.sie.residual import of_contact, of_field
from galinx.solvers.solution import Surface, Turns

#: Distance over a from an end or a kink from which on stresses are looked at.
_NEAREST = 1e-7


class FoundPunches(Punches):
    """Punches with several frictions, each with its own half-width and middle."""

    @cached_property
    def _contacts(self) -> Contacts:
        body = self.task.body
        return contacts(self.task.response, self.g, body.profile, body.compression)

    @cached_property
    def local(self) -> Any:
        """Exponents at the ends."""
        return Exponents(self._contacts.of("α"), self._contacts.of("β"))

    @property
    def half_width(self) -> NDArray[np.float64]:
        """Of the contact [m], (states,)."""
        return self._contacts.of("half_width")

    @property
    def centre(self) -> NDArray[np.float64]:
        """Middle of the contact from the punch's axis [m], (states,)."""
        return self._contacts.of("centre")

    @property
    def K_I(self) -> NDArray[np.float64]:
        """At the left and the right end, 0 at one that is found, (states, 2)."""
        return self._contacts.of("K_I")

    @cached_property
    def largest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Largest pressure over N/(2a), and its place over a, NaN where it is infinite, (states,)."""
        return self._contacts.largest()

    @cached_property
    def residual(self) -> NDArray[np.float64]:
        found, body, load = np.empty(len(self.g)), self.task.body, self.task.body.load
        for rows, some, kinks in self._contacts.alike():
            loaded = body.loaded(load[rows] if np.ndim(load) else load)
            exponents = Exponents(some.of("α"), some.of("β"))
            lengths = some.of("centre"), some.of("half_width")
            found[rows] = of_contact(
                self.task.response, some.g, exponents, loaded, some.pressure, lengths, kinks
            )
        return found

    @cached_property
    def residual_inside(self) -> NDArray[np.float64]:
        found = np.empty(len(self.g))
        for rows, some, kinks in self._contacts.alike():
            found[rows] = of_field(
                self.task.response, some.g, (some.of("α"), some.of("β")), some.pressure, some.inside,
                self.task.places.points, kinks,
            )  # fmt: skip
        return found

    @cached_property
    def surface(self) -> Surface:
        places = self.task.places
        σ_YY = np.full((len(self.g), len(places.X)), np.nan)
        σ_YY[:, places.under] = self._contacts.σ_YY(places.X[places.under])
        return Surface(places, σ_YY, self._contacts.σ_XX(places.X), turns=self._turns)

    @cached_property
    def _turns(self) -> Turns | None:
        """Exact; at ends that are free, and under kinks, wherever stresses are finite."""
        found = self._contacts
        X = found.turns
        if not X.shape[1]:
            return None
        on_surface = found.stresses(np.nan_to_num(X), np.zeros_like(X))
        return Turns(X, np.where(np.isnan(X), np.nan, on_surface))

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        return self._by_batches(self._contacts.inside)

    @cached_property
    def strength(self) -> Strength:
        """Yield."""
        found, task = self._contacts, self.task

        def field(points: NDArray) -> NDArray[np.float64]:
            return found.stresses(points[..., 0], points[..., 1])

        return Strength(
            field, task.body, task.response, self.g, self.local, self.half_width, self._turns, _NEAREST
        )
