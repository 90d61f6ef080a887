"""Contact pressure, by whatever method, a weight at both ends times a smooth factor; and its contacts.

What all pressures have in common is their value, their intensities and the search for the largest.
Methods differ in how they find the factor.

What differs between contacts without a mesh is the pressure alone. Lengths are over the half-width of
each contact, from its middle, stresses over N/(2a) of that half-width.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .edges import weights_hilbert
from .extremes import FINER, between, largest

#: Both ends of a contact, over its half-width.
ENDS = np.array([-1.0, 1.0])
#: Positions nearer than this to a place of infinite pressure are taken at this distance, over a.
NEXT_TO_TIP = 1e-6


class Pressure:
    """Contact pressure σ_YY = (1 - r)^α (1 + r)^β p(r) over N/(2a), |r| <= 1.

    Of one state or of several, whose exponents and coefficients then are columns that broadcast against
    positions. Pressures over uniform half-planes also give Cauchy's integral below the surface, see
    :class:`galinx.solvers.solids.half_plane.Potential`; those of integral equations their integrals.

    Attributes:
        α, β: exponents at the right and the left end.
        kinks: places inside at which the pressure is not smooth.
        tips: places inside at which it is infinite.
        breaks: ends of pieces in which it is linear; none for other pressures.
        resultant: ∫ σ_YY d(X/a) over N/(2a); -2 under a punch.
        near: |r| up to which p can be evaluated.
    """

    α: Any
    β: Any
    kinks: Sequence[float] | NDArray = ()
    tips: Sequence[float] = ()
    breaks: Sequence[float] | NDArray = ()
    resultant: float = -2.0
    near: float = 1.0

    def series(self, r: NDArray) -> NDArray[np.float64]:
        """Smooth factor p over N/(2a) at |r| <= 1."""
        raise NotImplementedError

    def σ_YY(self, r: ArrayLike) -> NDArray[np.float64]:
        """Contact stress over N/(2a) at r; 0 beside the contact, NaN at an end where it is infinite."""
        r = np.asarray(r, dtype=float)
        at = np.clip(r, -1.0, 1.0)
        with np.errstate(invalid="ignore", divide="ignore"):
            stress = (1.0 - at) ** self.α * (1.0 + at) ** self.β * self.series(at)
        stress = np.where(np.abs(r) <= 1.0, stress, 0.0)
        at_end = np.any(np.abs(r) == 1.0)
        return np.where(np.isinf(stress), np.nan, stress) if at_end else stress

    @property
    def K_I(self) -> NDArray[np.float64]:
        """Intensities at the left and the right end as in Eqs 56-57, 0 at a free end, (..., 2).

        Beside a free end the other end has twice the smooth factor, as the weight there is that of a flat
        punch times the distance from the free end, 2.
        """
        exponents = np.concatenate([np.atleast_1d(self.β), np.atleast_1d(self.α)], axis=-1)
        K = -0.5 * self.series(ENDS) * 2.0 ** (self.α + self.β + 1.0)
        return np.where((exponents < 0.0) & ~self.free, K, 0.0)

    @property
    def free(self) -> NDArray[np.bool_]:
        """True where the left and the right end are free, (..., 2)."""
        return np.concatenate([np.atleast_1d(self.β), np.atleast_1d(self.α)], axis=-1) > 0.0

    @property
    def bends(self) -> Sequence[float] | NDArray:
        """Kinks at which the pressure is finite."""
        return () if len(self.tips) else self.kinks

    @property
    def finite(self) -> bool:
        """True if the pressure vanishes at both ends and has no tip, in all states."""
        return bool(np.all(self.free)) and not len(self.tips)

    def states(self) -> Iterator["Pressure"]:
        """Pressures of all states, each alone."""
        yield self

    def largest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Largest pressure over N/(2a) and its place, NaN where it is infinite, (states,) each."""
        value, place = np.array([pressure._largest() for pressure in self.states()]).T
        return value, place

    def _largest(self) -> tuple[float, float]:
        """Largest pressure of a single state, and its place; it is not smooth at its kinks."""
        if not self.finite:
            return np.nan, np.nan
        turns = np.array([-1.0, *np.sort(self.kinks), 1.0])
        at_kinks = zip((-self.σ_YY(turns[1:-1])).tolist(), turns[1:-1].tolist())
        pieces = [*between(turns, FINER)]
        return max(largest(lambda r: -self.σ_YY(r), pieces, ends=False), *at_kinks, (-np.inf, np.nan))

    def hilbert(self, r: NDArray) -> NDArray[np.float64]:
        """(1/π) ⨍ σ_YY(t)/(t - r) dt on the whole surface; NaN at an end where it is infinite."""
        transform, close = self.rest(r, self.near), np.abs(r) <= self.near
        with np.errstate(divide="ignore", invalid="ignore"):
            transform[..., close] += self.series(r[close]) * weights_hilbert(self.α, self.β, r[close])
        return transform

    def transforms(self, g: Any, r: NDArray) -> tuple[Any, NDArray, Any]:
        """σ_XY/σ_YY at r, H[σ_YY], and H[σ_XY] beyond the product of both; ``g`` is a state's ratio."""
        return g, self.hilbert(r), 0.0

    @property
    def opposed(self) -> "Pressure":
        """The pressure with friction of the other sign, as it acts on an elastic punch."""
        return self

    def ratios(self, g: NDArray, t: NDArray) -> tuple[NDArray, Any]:
        """σ_XY/σ_YY at t: a number of each state, (states,), times a function of t; g: the states'."""
        return g, 1.0

    def strain(self, g: NDArray, kernel: Any, r: NDArray) -> NDArray[np.float64]:
        """Strain by kernels of σ_XY and of σ_YY, the first ones, (states, len(r))."""
        by_kernel = self.integral(kernel, r, kernel.length)
        return np.asarray(by_kernel[:, 1] + g[:, None] * by_kernel[:, 0])

    def inside(self, response: Any, g: Any, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY below the surface of a uniform half-plane, (3, states, points)."""
        return np.asarray(response.inside(self, g, X, Y))

    def read(self, group: Any, what: Any, values: Callable[[Any], NDArray]) -> NDArray[np.float64]:
        """Values that are linear in the pressure, (..., rows, n).

        Args:
            group: states of this pressure.
            what: a name of the values, by which they are kept.
            values: gives them for states that were solved, (..., rows, n).
        """
        return values(group)

    def at(self, z: NDArray) -> NDArray[np.complex128]:
        """Cauchy's integral Φ(z), see :class:`galinx.solvers.solids.half_plane.Potential`."""
        raise NotImplementedError

    def rest(self, r: NDArray, near: float) -> NDArray[np.float64]:
        """(1/π) ∫ σ/(t - r) dt, less p(r) times that of the weight where |r| <= near, (len(r),)."""
        raise NotImplementedError

    def integral(
        self, kernel: Callable[[NDArray], NDArray], r: NDArray, length: float
    ) -> NDArray[np.float64]:
        """∫ kernel(r - t) σ(t) dt with kernels that vary over a length, (len(r), functions)."""
        raise NotImplementedError

    def points(self, finest: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """t and weights times σ_YY for integrals with functions that vary over ``finest``, (n,) each."""
        raise NotImplementedError


class Functions:
    """Functions f_k whose sums are pressures without their weight."""

    def values(self, r: NDArray, count: int) -> NDArray[np.float64]:
        """Values of ``count`` functions at r, (*r.shape, count)."""
        raise NotImplementedError

    def sum(self, c: NDArray, r: NDArray) -> NDArray[np.float64]:
        """Σ c_k f_k at r, in the shape of r; of each state where c is (states, functions)."""
        return np.tensordot(c, self.values(r, c.shape[-1]), (-1, -1))

    def cauchy(self, c: NDArray, y: NDArray) -> NDArray[Any]:
        """Cauchy's integral over the weight, see :mod:`galinx.solvers.contact.panels`, (points,)."""
        raise NotImplementedError("stresses inside below a profile come from finite elements only")

    def near(self, count: int) -> float:
        """|r| up to which sums of so many functions can be evaluated."""
        return 1.0

    def continued(self, c: NDArray, free: tuple[bool, bool]) -> NDArray[np.float64]:
        """Coefficients of a pressure that falls to zero at free ends, where it is resolved less well."""
        return c

    def unresolved(self, c: NDArray) -> NDArray[np.float64]:
        """Relative error that coefficients show by themselves, (states,): 0, as levels measure it."""
        return np.zeros(len(c))


@dataclass(frozen=True)
class Expansion(Pressure):
    """Pressure as a sum of functions under its weight, p = Σ c_k f_k, of one state or of several.

    Attributes:
        α, β: exponents at the right and the left end, numbers or (states, 1).
        c: coefficients over N/(2a), (functions,) or (states, functions).
        functions: functions f_k, which know their integrals.
        ends: True where the left and the right end are free; None where the exponents say so.
        tips: see :class:`Pressure`.
    """

    α: Any
    β: Any
    c: NDArray[np.float64]
    functions: Any
    ends: tuple[bool, bool] | None = None
    tips: Sequence[float] = ()

    @property
    def free(self) -> NDArray[np.bool_]:
        return super().free if self.ends is None else np.array(self.ends)

    def sum(self, amplitudes: NDArray) -> "Expansion":
        """Sum of the states with amplitudes, (states,)."""
        return replace(self, c=amplitudes @ self.c)

    @property
    def near(self) -> float:  # type: ignore[override]
        return float(self.functions.near(self.c.shape[-1]))

    def series(self, r: NDArray) -> NDArray[np.float64]:
        return np.asarray(self.functions.sum(self.c, r))

    def states(self) -> Iterator[Pressure]:
        c = np.atleast_2d(self.c)
        α, β = (np.broadcast_to(np.ravel(exponent), len(c)).tolist() for exponent in (self.α, self.β))
        return (replace(self, α=α[i], β=β[i], c=row) for i, row in enumerate(c))

    def rest(self, r: NDArray, near: float) -> NDArray[np.float64]:
        return np.reshape(self.functions.rest(self.c, r.ravel(), near), (*self.c.shape[:-1], *r.shape))

    def integral(
        self, kernel: Callable[[NDArray], NDArray], r: NDArray, length: float
    ) -> NDArray[np.float64]:
        return np.asarray(self.functions.integral(self.c, kernel, r, length))

    def points(self, finest: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        t, forces = self.functions.points(self.c, finest)
        return t, forces

    def at(self, z: NDArray) -> NDArray[np.complex128]:
        flat = np.ravel(z).astype(complex)
        y, right = np.log((1.0 + flat) / (1.0 - flat)), log_beside(1.0 - flat)
        # The weight is continuous across the surface beside the contact, as fields near a plane need it.
        y = y.real - 1j * (-y.imag % (2.0 * np.pi))
        weight = np.exp(self.α * right + self.β * (y + right))
        return (weight * self.functions.cauchy(self.c, y) / np.pi).reshape(np.shape(z))

    def ending(self, free: tuple[bool, bool]) -> "Expansion":
        """Pressure that falls to zero at free ends, left and right."""
        return replace(self, c=self.functions.continued(self.c, free), ends=free)

    @property
    def unresolved(self) -> NDArray[np.float64]:
        """Relative error measured on the last of the functions, (states,)."""
        return np.asarray(self.functions.unresolved(self.c))


@dataclass(frozen=True)
class Group:
    """States at one speed whose pressure is of one kind, and their stresses.

    Attributes:
        response: half-plane at that speed, :class:`galinx.solvers.solids.half_plane.HalfPlane`.
        rows: numbers of these states, (rows,).
        g: σ_XY/σ_YY, (rows,).
        pressure: pressure of all these states or of the only one.
        half_width, centre: half-width and centre of the contact [m], (rows,).
    """

    response: Any
    rows: NDArray[np.int64]
    g: NDArray[np.float64]
    pressure: Any
    half_width: NDArray[np.float64]
    centre: NDArray[np.float64]

    @property
    def K_I(self) -> NDArray[np.float64]:
        """Intensities at the left and the right end, (rows, 2)."""
        return np.broadcast_to(self.pressure.K_I, (len(self.rows), 2))

    @property
    def free(self) -> NDArray[np.bool_]:
        """True where the left and the right end are free, (rows, 2)."""
        return np.broadcast_to(self.pressure.free, (len(self.rows), 2))

    @property
    def α(self) -> NDArray[np.float64]:
        """Exponent of the pressure at the right end, (rows,)."""
        return np.broadcast_to(np.ravel(self.pressure.α), self.rows.shape)

    @property
    def β(self) -> NDArray[np.float64]:
        """Exponent of the pressure at the left end, (rows,)."""
        return np.broadcast_to(np.ravel(self.pressure.β), self.rows.shape)

    def contact_stress(self, r: NDArray) -> NDArray[np.float64]:
        """σ_YY over N/(2a) at r in (-1, 1), also next to infinite values, (rows, points)."""
        stress = self.pressure.σ_YY(r)
        return np.broadcast_to(stress, (len(self.rows), stress.shape[-1]))

    def surface(self, r: NDArray) -> NDArray[np.float64]:
        """σ_XX and σ_YY, 0 beside the contact, at r off the ends, (points,) or (rows, points).

        The result is (2, rows, points).
        """
        r = off_tips(r, self.pressure.tips)
        σ_YY = np.where(np.abs(r) < 1.0, self.pressure.σ_YY(r), 0.0)
        ratio, H, C = self.pressure.transforms(self.g[:, None], r)
        σ_XX = self.response.in_plane(ratio, σ_YY, H, self.response.m * C + self.strain(r))
        # Where friction varies along the contact its number stands for it, and states may share it.
        shape = len(self.rows), σ_XX.shape[-1]
        return np.array([np.broadcast_to(σ, shape) for σ in (σ_XX, σ_YY)])

    def strain(self, r: NDArray) -> Any:
        """Strain μ u,X over N/(2a) that layers add on the surface at r, (rows, points)."""
        return 0.0

    def ratio(self, r: NDArray) -> NDArray[np.float64]:
        """σ_XY/σ_YY at r, (rows, points) or (rows, 1)."""
        g, ratios = self.pressure.ratios(self.g, r)
        return np.asarray(g[:, None] * ratios)

    def inside(self, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points (1, n) or (rows, n) below the surface: (3, rows, n)."""
        σ = self.pressure.inside(self.response, self.g[:, None], X, Y)
        return np.broadcast_to(σ, (3, len(self.rows), σ.shape[-1]))

    def stresses(self, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points (1, n) or (rows, n), on the surface, too: (3, rows, n)."""
        on = Y == 0.0
        σ = self.inside(X, np.where(on, -1.0, Y)).copy()
        columns = on.any(axis=0)
        if columns.any():
            σ_XX, σ_YY = self.surface(X[:, columns])
            on_surface = [σ_XX, σ_YY, self.ratio(X[:, columns]) * σ_YY]
            σ[..., columns] = np.where(on[:, columns], on_surface, σ[..., columns])
        return σ


def log_beside(z: NDArray) -> NDArray[Any]:
    """Logarithm of 1 - z or 1/(1 + z), continuous across the surface beside the contact."""
    return np.log(-1j * z) + 0.5j * np.pi if np.iscomplexobj(z) else np.log(z)


def off_tips(r: NDArray, tips: Sequence[float]) -> NDArray[np.float64]:
    """Positions r over the half-width, moved off tips, where the pressure is infinite."""
    for tip in tips:
        side = np.where(r < tip, -1.0, 1.0)
        r = np.where(np.abs(r - tip) < NEXT_TO_TIP, tip + side * NEXT_TO_TIP, r)
    return r


@dataclass(frozen=True)
class Contacts:
    """Contacts at one speed with several frictions.

    Attributes:
        groups: all states by the kind of their pressure.
    """

    groups: tuple[Group, ...]

    def of(self, name: str) -> NDArray[np.float64]:
        """Attribute of every state by its name, as ``α``, ``free``, ``half_width``, ``K_I``."""
        return self.joined(lambda group: getattr(group, name))

    def joined(self, values: Callable[[Any], NDArray], axis: int = 0) -> NDArray[np.float64]:
        """Values of all states from those of every group, along an axis of states."""
        if len(self.groups) == 1:
            return values(self.groups[0])
        each = np.concatenate([values(group) for group in self.groups], axis=axis)
        return each.take(self.order, axis)

    @cached_property
    def order(self) -> NDArray[np.int64]:
        """Number of each state among those of all groups, one group after the other, (states,)."""
        return np.argsort(np.concatenate([group.rows for group in self.groups]))

    @property
    def in_punch(self) -> "Contacts":
        """Contacts with these pressures on the half-plane of an elastic punch, mirrored at Y = 0.

        There σ_XY has the other sign, and so has the friction.
        """
        return Contacts(
            tuple(
                Group(of.response.punch, of.rows, -of.g, of.pressure.opposed, of.half_width, of.centre)
                for of in self.groups
            )
        )

    def on_surface(self, r: NDArray) -> NDArray[np.float64]:
        """σ_XX and σ_YY, 0 beside the contact, on the surface off the ends, (2, states, points)."""
        return self.joined(lambda group: group.surface(r), 1)

    def stresses(self, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY over N/(2a), (3, states, n), at points with Y <= 0, on the surface, too.

        Points are (n,), or of each state (states, n).
        """
        X, Y = np.broadcast_arrays(np.atleast_2d(X), np.atleast_2d(Y))
        return self.joined(
            lambda group: group.stresses(*(x[group.rows] if len(x) > 1 else x for x in (X, Y))), 1
        )

    def largest(self) -> NDArray[np.float64]:
        """Largest contact pressure over N/(2a), and its place; NaN if infinite: (2, states)."""
        return self.joined(
            lambda group: np.broadcast_to(group.pressure.largest(), (2, len(group.rows))), 1
        )


def between_ends(response: Any, g: NDArray, pressures: Sequence[Pressure], half_width: Any) -> Contacts:
    """Contacts from -a to a of given pressures.

    Args:
        response: of the half-plane at a speed.
        g: σ_XY/σ_YY, (states,).
        pressures: one for all states, or one for each.
        half_width: a [m].
    """
    groups = []
    for rows, pressure in zip(np.array_split(np.arange(len(g)), len(pressures)), pressures):
        zero = np.zeros(len(rows))
        groups.append(Group(response, rows, g[rows], pressure, zero + half_width, zero))
    return Contacts(tuple(groups))
