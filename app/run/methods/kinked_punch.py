"""Punches of any convex profile whose contact ends where the pressure says, by finite elements.

The slope of such a punch, or its derivative, jumps at places that depend on the state, and cells are
graded towards these: every friction has a mesh of its own. On it half-width h and middle m are improved
by Newton's method: P(m + h s) and its derivatives by m and h are held under the punch, and load and
vanishing intensities at both ends are linear in their amplitudes. A pass or two are enough where a
coarse solution is near.
"""

import dataclasses
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.task import Task
from galinx.app.run.methods.discretisation import Discretisation
from galinx.app.run.methods.ladder import WorkDone
from galinx.meshes.kind import DEGREES
from galinx.meshes.kinks import with_kinks
from galinx.postprocess.intensity import TERMS, end_intensity, places_at_end, towards_end
from galinx.postprocess.pressure import contact_recovery
from galinx.postprocess.quantities.quantity import INTENSITIES
from galinx.solvers.errors import SolveError
from galinx.solvers.fem.punch import SlidingPunch
from galinx.solvers.fem.space import Space
from galinx.solvers.profiles import kinks
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.sie.found import Exponents
from galinx.solvers.solution import Surface

#: Degree at which a contact is looked for, and how much higher than for a flat punch the last one is.
_COARSE, _MORE = 4, 2
#: Most passes at a degree; change of the shape's amplitude, as a logarithm, from which Newton's method
#: serves; most kinks in a contact, and how near to its end one may be.
_PASSES, _NEAR, _MOST, _NEXT_TO_END = 40, 0.5, 12, 0.98
#: First half-width that is tried [m], and largest factor from one to the next.
_FIRST, _FACTOR = 1e-3, 10.0
#: Height over N/(2μ) under a contact up to which nothing but rounding is carried.
_FLAT = 1e-9
#: Changes of centre and half-width that a pass at a low degree may leave.
_ROUGHLY = 1e-3


@contextmanager
def solver(work: Discretisation, task: Task, g: NDArray) -> Iterator["KinkedAtSpeed"]:
    """States are solved when they are asked for, each on meshes of its own."""
    yield KinkedAtSpeed(work, task)


@dataclass
class Contact:
    """A contact, as far as it is known.

    Attributes:
        centre, half_width: [m].
        change: last change of both over the half-width; infinite where it is not near.
        v0: indentation over N/(2μ).
        normal, tangential: resultants over N/2.
        unseen: change of both over the half-width that fewer terms at the ends make.
        σ_YY: over N/(2a) at the places on the surface, NaN beside the punch; of the last degree.
    """

    centre: float = 0.0
    half_width: float = _FIRST
    change: float = np.inf
    v0: float = 0.0
    normal: float = 0.0
    tangential: float = 0.0
    unseen: float = 0.0
    σ_YY: NDArray[np.float64] = dataclasses.field(default_factory=lambda: np.empty(0))


class KinkedAtSpeed:
    """Contacts at one speed.

    Args:
        work: gives spaces.
        task: the speed.
    """

    def __init__(self, work: Discretisation, task: Task) -> None:
        self.work, self.task = work, task
        self._refinement = work.plan.refinement
        self._degree = min(work.plan.degrees[task.number] + _MORE, DEGREES[1])
        self._done, self._space = WorkDone(), {"cells": 0, "unknowns": 0, "degree": self._degree}
        #: By σ_XY/σ_YY and load.
        self._known: dict[tuple[float, float], tuple[Contact, float]] = {}
        self._body = task.body

    def states(self, g: NDArray, load: Any = None) -> "KinkedPunches":
        found = []
        loads = np.broadcast_to(self.task.body.loaded(load).load, g.shape).tolist()
        for state in zip(g.tolist(), loads):
            if state not in self._known:
                self._known[state] = self._solved(*state)
            found.append(self._known[state])
        return KinkedPunches(self, g, [contact for contact, _ in found], np.array([e for _, e in found]))

    def record(self) -> dict[str, Any]:
        return self._space | vars(self._done)

    def _solved(self, g: float, load: float) -> tuple[Contact, float]:
        """The contact at a friction and a load, and the estimated error of its ends over its width."""
        self._body = self.task.body.loaded(load)
        nearest = min(
            self._known, key=lambda known: abs(known[0] - g) + abs(np.log(known[1] / load)), default=None
        )
        start = Contact() if nearest is None else self._known[nearest][0]
        contact = Contact(start.centre, start.half_width)
        wanted = 0.1 * self.work.plan.tolerance**0.5
        self._found(contact, g, _COARSE, _ROUGHLY)
        self._found(contact, g, self._degree - 1, wanted)
        before = contact.centre, contact.half_width
        self._found(contact, g, self._degree, wanted)
        moved = max(abs(contact.centre - before[0]), abs(contact.half_width - before[1]))
        return contact, moved / contact.half_width + contact.unseen + contact.change**2 + self._far(g)

    def _far(self, g: float) -> float:
        """Estimated relative error from the finite outer radius and the innermost cells."""
        plan, response = self.work.plan, self.task.response
        far = plan.kind.truncation(plan.wanted, response.margin)
        innermost = plan.kind.unseen(plan.wanted, self._degree, 1, response.margin)
        return innermost + far * (2.0 + 4.0 * abs(g))

    def _found(self, contact: Contact, g: float, degree: int, wanted: float) -> None:
        """Improve a contact at a degree until its ends change by less than is wanted.

        Raises:
            SolveError: they do not settle, or are too near to a kink.
        """
        narrow, wide = 0.0, np.inf
        for _ in range(_PASSES):
            amplitude, lean = self._pass(contact, g, degree)
            if contact.change <= wanted:
                return
            if np.isfinite(contact.change):
                continue
            # The load of this width is the amplitude's inverse: take a wider or a narrower one.
            h = contact.half_width
            narrow, wide = (h, wide) if amplitude > 1.0 else (narrow, h)
            factor = np.clip(np.sqrt(max(amplitude, 1e-9)), 1.0 / _FACTOR, _FACTOR)
            new = h * factor
            if not narrow < new < wide:
                new = np.sqrt(narrow * wide)
            contact.centre = (contact.centre / h + np.clip(lean, -0.3, 0.3)) * new
            contact.half_width = new
        raise SolveError(
            f"finite elements of degree {degree} did not find the ends of the contact of a "
            f"{self.task.body.profile.words()} at g = {g:g} (dimensionless) in {_PASSES} passes: the "
            f"last changed them by {contact.change:.3g} of the half-width {contact.half_width:.4g} m, "
            f"wanted {wanted:.3g}"
        )

    def _kinks(self, contact: Contact, coarse: bool) -> NDArray[np.float64]:
        """Places of the kinks over the half-width.

        Raises:
            SolveError: cells cannot be graded towards them.
        """
        at = (np.array(kinks(self.task.body.profile), dtype=float) - contact.centre) / contact.half_width
        inside = at[np.abs(at) < 1.0]
        if coarse:
            inside = inside[np.abs(inside) < _NEXT_TO_END][:_MOST]
        elif len(inside) > _MOST or np.abs(inside).max(initial=0.0) > _NEXT_TO_END:
            raise SolveError(
                f"the punch has {len(inside)} kinks under the contact, at {inside.round(4).tolist()} "
                f"(over the half-width); finite elements want at most {_MOST}, none within "
                f'{1.0 - _NEXT_TO_END:.2g} of an end; take methods = ["closed_form"]'
            )
        return inside

    def _pass(self, contact: Contact, g: float, degree: int) -> tuple[float, float]:
        """One mesh, one solution; the contact is improved if it is near.

        Returns:
            By what the profile's height would have to be multiplied for this half-width, and by how much
            the middle over the half-width would move then.
        """
        places = self._kinks(contact, coarse=degree == _COARSE)
        space = self.work.space_on(with_kinks(self._refinement, places), degree)
        r = space.chart.surface_position(space.contact.s)
        solver, tolerance = self.work.plan.solver, self.work.plan.tolerance
        negligible, shapes = min(1e-4 * tolerance, 1e-10), self._shapes(contact, r)
        if shapes[0].max() < _FLAT:  # in a flat part nothing is carried: wider
            contact.change = np.inf
            return np.inf, 0.0
        punch = SlidingPunch(space, self.task.response, solver, negligible, shapes)
        try:
            parts = punch.parts(np.array([g]))
            self._done.count(punch)
            self._space = {"cells": space.cells, "unknowns": space.size, "degree": degree}
        finally:
            punch.destroy()
        normal = np.stack([part.normal[0] for part in parts], axis=1)
        A = self._conditions(places, r, g, TERMS) @ normal
        load = np.array([-2.0, 0.0, 0.0])
        v0, amplitude, lean = np.linalg.solve(A[:, :3], load)
        if not amplitude > 0.0 or abs(np.log(amplitude)) > _NEAR:
            contact.change = np.inf
            return float(amplitude), float(lean / amplitude) if amplitude > 0.0 else 0.0
        v0, moved, grown = np.linalg.solve(A[:, [0, 2, 3]], load - A[:, 1])
        fewer = self._conditions(places, r, g, TERMS - 2) @ normal
        _, *other = np.linalg.solve(fewer[:, [0, 2, 3]], load - fewer[:, 1])
        contact.change = float(max(abs(moved), abs(grown)))
        contact.unseen = float(np.abs(np.array(other) - [moved, grown]).max())
        share = min(1.0, _NEAR / max(contact.change, 1e-300))
        contact.centre += contact.half_width * share * moved
        contact.half_width *= 1.0 + share * grown
        amplitudes = np.array([v0, 1.0, moved, grown])
        if degree == self._degree:
            contact.σ_YY = self._pressure(space, normal @ amplitudes, places, g)
        contact.v0, contact.normal = float(v0), float(normal.sum(axis=0) @ amplitudes)
        tangential = np.array([part.tangential[0].sum() for part in parts])
        contact.tangential = float(tangential @ amplitudes)
        return float(amplitude), float(lean)

    def _pressure(self, space: Space, forces: NDArray, places: NDArray, g: float) -> NDArray[np.float64]:
        """σ_YY at the places on the surface, NaN beside the punch.

        Off kinks and ends the pressure of the nodal forces is as good as their moments: cells are small
        and many there. At the ends it falls as the local analysis says.
        """
        X, local = self.task.places.X, FlatPunch(self.task.response, g)
        gaps = 1.0 + places.min(initial=1.0), 1.0 - places.max(initial=-1.0)
        at_ends = [places_at_end(gap) for gap in gaps]
        wanted = np.concatenate([X, at_ends[0] - 1.0, 1.0 - at_ends[1]])
        recovery = contact_recovery(space.contact.s, space.degree, space.chart, wanted)
        found, *ends = np.split(forces @ recovery.raw, [len(X), len(X) + len(at_ends[0])])
        for d, known, values, α in zip((1.0 + X, 1.0 - X), at_ends, ends, (local.β, local.α)):
            near = (d > 0.0) & (d < known[0])
            found[near] = towards_end(d[near], known, values, float(α) + 1.0)
        return found

    def _shapes(self, contact: Contact, r: NDArray) -> NDArray[np.float64]:
        """P and its derivatives by m and h, times h, over N/(2μ) at the contact's nodes, (3, nodes)."""
        body, h = self._body, contact.half_width
        X = contact.centre + h * r
        slope = h * body.profile.slope(X)
        return np.stack([body.profile.height(X), slope, r * slope]) / body.displacement

    def _conditions(self, places: NDArray, r: NDArray, g: float, terms: int) -> NDArray[np.float64]:
        """What nodal forces give: load, and what is left of both ends' intensities, (3, nodes)."""
        local = FlatPunch(self.task.response, g)
        last = places.max() if len(places) else -1.0
        first = places.min() if len(places) else 1.0
        right = end_intensity(r, last, float(local.α), terms)
        left = end_intensity(-r, -first, float(local.β), terms)
        return np.stack([np.ones_like(r), right, left])


@dataclass(frozen=True)
class KinkedPunches:
    """Punches with several frictions, each with its own half-width and middle.

    Attributes:
        at: their speed.
        g: σ_XY/σ_YY, (states,).
        contacts: what was found.
        errors: estimated, of the ends over the half-width, (states,).
    """

    at: KinkedAtSpeed
    g: NDArray[np.float64]
    contacts: list[Contact]
    errors: NDArray[np.float64]

    @cached_property
    def local(self) -> Exponents:
        """Exponents at the ends."""
        flat = FlatPunch(self.at.task.response, self.g)
        return Exponents(flat.α + 1.0, flat.β + 1.0)

    def _all(self, name: str) -> NDArray[np.float64]:
        return np.array([getattr(contact, name) for contact in self.contacts])

    @property
    def half_width(self) -> NDArray[np.float64]:
        """Of the contact [m], (states,)."""
        return self._all("half_width")

    @property
    def centre(self) -> NDArray[np.float64]:
        """Middle of the contact from the punch's axis [m], (states,)."""
        return self._all("centre")

    @property
    def K_I(self) -> NDArray[np.float64]:
        """At the left and the right end: none, by condition, (states, 2)."""
        return np.zeros((len(self.g), 2))

    @property
    def normal_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return self._all("normal")

    @property
    def tangential_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return self._all("tangential")

    @property
    def v0(self) -> NDArray[np.float64]:
        """Indentation of the punch's lowest point over N/(2μ), (states,)."""
        return self._all("v0")

    @cached_property
    def surface(self) -> Surface:
        """Contact stress alone."""
        σ_YY = np.array([contact.σ_YY for contact in self.contacts])
        return Surface(self.at.task.places, σ_YY, np.full_like(σ_YY, np.nan))

    @property
    def estimates(self) -> dict[str, NDArray[np.float64]]:
        """Relative errors, (states,), by the word of output.quantities that asks for what they are of."""
        return {INTENSITIES: self.errors}
