"""Stresses inside solids that are not isotropic, below every pressure, against sums of line loads."""

import numpy as np
import pytest
from line_loads_reference import FreeContact, Lines, Rule
from loaded import LoadedHalfPlane
from random_solids import anisotropic, cubic, orthotropic, stiffness
from support import THOROUGH

from galinx.solvers.contact.closed_form import contacts
from galinx.solvers.contact.prescribed_pressure import LinearPressure
from galinx.solvers.profiles.punches import Flat, Parabolic, Power, RoundedFlat, Table, Wedge


def parabola(rng):
    return Parabolic(10.0 ** rng.uniform(-1.0, 1.0))


def wedge(rng):
    return Wedge(10.0 ** rng.uniform(-2.0, 0.0))


def rounded(rng):
    return RoundedFlat(10.0 ** rng.uniform(-2.0, 0.0), 10.0 ** rng.uniform(-1.0, 1.0))


def power(rng):
    return Power(rng.uniform(1.1, 5.0), 10.0 ** rng.uniform(-1.0, 0.0))


def table(rng):
    """Points of a convex curve that no contact reaches beyond."""
    X = np.sort(np.concatenate([[-9.0, 9.0], rng.uniform(-2.0, 2.0, 5)]))
    return Table(tuple(zip(X.tolist(), (np.cosh(X / 2.0) + 0.3 * X**2).tolist())))


def tilt(rng):
    """Both edges in contact, or one."""
    return Flat(1.0, 10.0 ** rng.uniform(-3.0, 1.0) * rng.choice([-1.0, 1.0]))


FREE = wedge, rounded, power, table
ALL = parabola, tilt, *FREE, None


def solved(seed):
    """Stresses by the program at random points, and by the sums."""
    rng = np.random.default_rng(seed)
    solid, make = (orthotropic, cubic, anisotropic)[seed % 3](rng), ALL[seed // 3 % len(ALL)]
    c = solid.limit() * rng.choice([0.0, rng.uniform(0.0, 0.98), 0.98], p=[0.1, 0.8, 0.1])
    g, load, response = rng.uniform(-0.9, 0.9), 10.0 ** rng.uniform(-1.0, 0.3), solid.response(c)
    X, Y = rng.uniform(-4.0, 4.0, 8), -(10.0 ** rng.uniform(-2.5, 1.0, 8))
    lines = Lines(stiffness(response), c, g)
    if make is None:
        knots = np.concatenate([[-1.0], np.sort(rng.uniform(-1.0, 1.0, 4)), [1.0]])
        values = -rng.uniform(0.0, 3.0, 6) * rng.choice([0.0, 1.0], 6, p=[0.2, 0.8])
        values[2] -= 0.1  # not all are 0
        rule = Rule([*((t, 0.0) for t in knots), *lines.feet(X, Y)])
        found = LoadedHalfPlane(response, g, LinearPressure(knots, values)).inside(X, Y)
        return found, lines.stresses(rule, np.interp(rule.t, knots, values), X, Y)
    profile = make(rng)
    contact = contacts(response, np.array([g]), profile, load)
    found = contact.stresses(X, Y)[:, 0]
    a = np.arctan2(lines.n, lines.Q) / np.pi  # of the right end if free
    if make in FREE:
        start = float(contact.of("centre")[0]), float(contact.of("half_width")[0])
        free = FreeContact(lines, profile.slope, getattr(profile, "kinks", ()), load, start)
        assert [free.m, free.h] == pytest.approx(start, rel=1e-9, abs=1e-9 * free.h)
        rule = free.rule(lines.feet(X, Y))
        σ = free.σ_YY(rule)
    else:
        rule = Rule(lines.feet(X, Y))
        α, β = (float(contact.of(name)[0]) for name in "αβ")
        assert [α % 1.0, β % 1.0] == pytest.approx([a, 1.0 - a], rel=1e-9)
        σ = rule.right ** (a - (α < 0.0)) * rule.left ** (1.0 - a - (β < 0.0))
        if α < 0.0 and β < 0.0:  # its resultant as it stands, and a slope by the tilt
            sin = -np.sin(np.pi * a)
            B = -profile.rise * sin / lines.n * 2.0 * profile.half_width / load
            σ *= 2.0 * sin / np.pi + B * (rule.t + 2.0 * a - 1.0)
        else:
            σ *= -2.0 / (rule.w @ σ)
    assert rule.w @ σ == pytest.approx(-2.0, rel=1e-9)
    return found, lines.stresses(rule, σ, X, Y)


@pytest.mark.parametrize("seed", range(210 if THOROUGH else 21))
def test_stresses_inside_are_sums_of_line_loads(seed):
    found, wanted = solved(seed)
    np.testing.assert_allclose(found, wanted, rtol=0.0, atol=1e-11 * np.abs(wanted).max())
