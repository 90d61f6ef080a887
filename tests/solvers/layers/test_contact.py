"""Punches of every profile on layered and graded half-planes by the singular integral equation."""

from dataclasses import replace
from functools import cache
from itertools import pairwise
from types import SimpleNamespace

import mpmath as mp
import numpy as np
import pytest
from layers_cases import COAT, SUBSTRATE, constants, converged_pressure, equation
from layers_reference import admittance
from support import THOROUGH

from galinx.solvers.approximation import polynomial_through
from galinx.solvers.contact.closed_form import contacts
from galinx.solvers.contact.edges import weights_hilbert
from galinx.solvers.contact.ends import Punch
from galinx.solvers.contact.equation import (
    Jacobi,
    LayersUnderPunch,
    SolvedContact,
    half_width_at_rest,
    under_punch,
)
from galinx.solvers.contact.exact import LayeredSolution, Nodes, groups_of
from galinx.solvers.contact.pressure import Expansion
from galinx.solvers.contact.solution import Places, Task, make_contact
from galinx.solvers.errors import SolveError
from galinx.solvers.layers.layered import Layer, Layered
from galinx.solvers.profiles import PROFILES
from galinx.solvers.profiles.punches import Flat, Power
from galinx.solvers.solids.isotropic import Isotropic

#: V², and α, K_I left, K_I right, σ_YY(0) over N/a, found in 30 and 50 digits with 24 to 36 nodes of a
#: collocation with the admittance of the reference.
EXAMPLE = {
    0.2: (-0.46191902660637, 0.46957498690109, 0.44068899120707, -0.17306141207014),
    1e-6: (-0.46377887035456, 0.44527894507991, 0.42102580318078, -0.19463531965638),
}
COATED = Layered((Layer(1.0, COAT),), SUBSTRATE)
ENDS, MIDDLE = np.array([-1.0, 1.0]), np.zeros(1)


def read(pressure):
    return np.array([pressure.α, *(-0.5 * pressure.series(ENDS)), *(0.5 * pressure.series(MIDDLE))])


@pytest.mark.parametrize("V2", EXAMPLE)
def test_the_example_to_all_digits(V2):
    """By Jacobi's polynomials, and by panels, which have nothing of these in them."""
    of_example = equation(COATED, V2, -0.4)
    assert np.abs(read(converged_pressure(of_example, 1e-11).pressure) - EXAMPLE[V2]).max() <= 2e-12
    assert np.abs(read(of_example.pressure(0.7)) - EXAMPLE[V2]).max() <= 1e-10


def test_frictions_between_are_interpolated_within_the_tolerance():
    response = COATED.response(0.3)
    speed = LayersUnderPunch(response, response.stack(1.0), 1e-8, Punch(Flat(1.0), 1.0, 1.0))
    g = np.linspace(-1.0, 1.0, 301)
    solved, left = speed.solved(g)
    assert len(solved) < 40 and left <= 1e-8
    weights = polynomial_through(np.array([contact.g for contact in solved])).shares(g)
    ends = weights @ [contact.pressure.series(ENDS) for contact in solved]
    for i in (3, 150):
        exact = converged_pressure(equation(COATED, (0.3 * COAT.c_s) ** 2, float(g[i])), 1e-11)
        assert np.abs(ends[i] / exact.pressure.series(ENDS) - 1.0).max() <= 1e-8


@pytest.mark.parametrize("terms, limit", [(20, 1e-10), (60, 1e-10), (150, 1e-10), (300, 1e-9)])
def test_what_is_left_of_the_hilbert_transform_keeps_its_digits_beside_the_punch(terms, limit):
    """Many polynomials grow fast beyond the edges: how far they are taken there depends on how many.

    SciPy's rule of 600 points keeps nine digits.
    """
    c = np.exp(-0.4 * np.arange(terms)) + 1e-15
    pressure = Expansion(-0.45, -0.55, c, Jacobi(-0.45, -0.55))
    X = np.array([-1.3, -1.1, -1.05, -1.001, 1.0002, 1.02, 1.1, 1.4])
    known = np.abs(X) <= pressure.near
    whole = pressure.rest(X, pressure.near)
    weights = weights_hilbert(-0.45, -0.55, X)
    whole[known] += pressure.series(X[known]) * weights[known]
    fine = pressure.points(1e-3)
    exact = (fine[1] / (fine[0] - X[:, None])).sum(axis=1) / np.pi
    assert known.any()
    assert np.abs(whole - exact).max() <= limit * np.abs(exact).max()


SAME = Layered((Layer(1.0, SUBSTRATE), Layer(0.3, SUBSTRATE)), SUBSTRATE)
LOAD = 0.02  # N/μ [m]

flat, parabolic, wedge, power, rounded, table = (
    PROFILES[name] for name in ("flat", "parabolic", "wedge", "power", "rounded_flat", "table")
)
PUNCHES = {
    "wedge": wedge(0.01),
    "cusp": power(1.3, 0.01),
    "cube": power(3.0, 0.1),
    "2.5": power(2.5, 0.1),
    "parabola": parabolic(1.0),
    "rounded": rounded(0.5, 2.0),
    "table": table(tuple((x, 0.01 * (x**2 + 0.05 * x**3 + abs(x))) for x in range(-3, 4))),
    "touching": flat(1.0, 0.05),
    "lifted": flat(1.0, -1.0),
    "edges": flat(1.0),
}  # fmt: skip


def found(solid, profile, g, share=0.5, tolerance=1e-8, load=LOAD):
    """The contact, its response, and the length that its lengths are over."""
    response = solid.response(share * solid.limit())
    unit = float(contacts(solid.response(0.0), np.zeros(1), profile, load).of("half_width")[0])
    punch = Punch(profile, unit, load)
    speed = LayersUnderPunch(response, response.stack(unit), tolerance, punch)
    return speed.contact(g), response, unit


def pressure(contact, r):
    """σ_YY over N/(2h)."""
    p = contact.pressure
    return (1.0 - r) ** p.α * (1.0 + r) ** p.β * p.series(r)


@pytest.mark.parametrize("name", PUNCHES)
@pytest.mark.parametrize("g", [0.0, -0.7] if THOROUGH else [-0.7])
def test_on_layers_of_one_solid_it_is_that_of_the_half_plane(name, g):
    profile = PUNCHES[name]
    for share in (0.0, 0.8) if THOROUGH else (0.8,):
        one, _, unit = found(SAME, profile, g, share)
        exact = contacts(SUBSTRATE.response(share * SUBSTRATE.limit()), np.array([g]), profile, LOAD)
        h, m, K = (exact.of(what)[0] for what in ("half_width", "centre", "K_I"))
        assert one.half_width * unit == pytest.approx(h, rel=1e-12)
        assert one.centre * unit == pytest.approx(m, abs=1e-12 * h)
        r = np.linspace(-0.999, 0.999, 41) + 1e-4
        σ = exact.on_surface(r)[1][0]
        assert np.abs(pressure(one, r) - σ).max() <= 1e-10 * np.abs(σ).max()
        ends = -0.5 * one.pressure.series(np.array([-1.0, 1.0]))
        assert np.where(one.pressure.free, 0.0, ends) == pytest.approx(np.asarray(K).ravel(), abs=1e-10)


@cache
def changes(solid, V2):
    """kH, the reference's change of the admittance by a layer on a substrate, and that of its solid."""
    (layer,) = solid.layers
    with mp.workdps(25):
        top, below = ((constants(one), mp.mpf(one.ρ)) for one in (layer.solid, solid.substrate))
        alone = admittance([], top, V2, mp.mpf(1))
        x, w = np.polynomial.legendre.leggauss(8)
        ends = np.concatenate([[0.0], 2.0 ** np.arange(-6.0, 5.0)])
        half = np.diff(ends)[:, None] / 2.0
        kH = ((ends[1:] + ends[:-1])[:, None] / 2.0 + half * x).ravel()
        Δ = [admittance([(mp.mpf(1), *top)], below, V2, mp.mpf(k)) - alone for k in kH.tolist()]
        off = np.array([np.array(one.tolist(), dtype=complex) for one in Δ])
        return kH, (half * w).ravel()[:, None, None] * off, np.array(alone.tolist(), dtype=complex)


class ReferenceEquation:
    """What a pressure over a coated half-plane has to obey, by transforms of the reference."""

    def __init__(self, solid, V2, g, h, profile, m):
        kH, Δ, top = changes(solid, V2)
        self.k = kH * h / solid.layers[0].thickness
        self.of_k = (Δ[:, 1, 1] + g * Δ[:, 1, 0]) * h / solid.layers[0].thickness / np.pi
        self.n, self.Q = top[1, 1].imag + g * top[1, 0].imag, -top[1, 0].real * g
        self.slope = lambda r: np.asarray(profile.slope(m + h * r))

    def kernel(self, x):
        return np.real(np.exp(1j * np.multiply.outer(x, self.k)) @ self.of_k)

    def off(self, σ, r, kinks):
        """What is left of the equation at r, and the size of its terms."""
        near = 0.5 * min(abs(r - one) for one in [-1.0, 1.0, *kinks])
        t, w = _rule(sorted([-1.0, *kinks, r - near, r + near, 1.0]))
        beside = np.abs(t - r) > near
        x, y = np.polynomial.legendre.leggauss(40)
        u, v = near * (x + 1.0) / 2.0, near * y / 2.0
        both = np.stack([σ(r + u), σ(r - u)])
        cauchy = w[beside] @ (σ(t[beside]) / (t[beside] - r)) + v @ ((both[0] - both[1]) / u)
        bent = w[beside] @ (σ(t[beside]) * self.kernel(r - t[beside]))
        bent += v @ (both[0] * self.kernel(-u) + both[1] * self.kernel(u))
        # A flat punch has no slope.
        size = np.abs(self.slope(t)).max() or self.n * np.abs(σ(np.array([r]))[0])
        left = self.n / np.pi * cauchy - self.Q * σ(np.array([r]))[0] + bent
        return float(left - self.slope(np.array([r]))[0]), float(size)


def _rule(places):
    """Gauss's rule between places, on panels that get shorter towards each."""
    x, w = np.polynomial.legendre.leggauss(20)
    steps = np.append(0.0, 0.3 ** np.arange(24, -1, -1.0)) / 2.0
    unit = np.concatenate([steps, 1.0 - steps[-2::-1]])
    ends = np.concatenate([low + (high - low) * unit for low, high in pairwise(places)])
    half, middle = np.diff(ends) / 2.0, (ends[1:] + ends[:-1]) / 2.0
    t, weights = (middle[:, None] + half[:, None] * x).ravel(), (half[:, None] * w).ravel()
    inside = (half[:, None] > 0.0) & (np.abs(t.reshape(-1, 20)) < 1.0)
    return t[inside.ravel()], weights[inside.ravel()]


@pytest.mark.parametrize("name", list(PUNCHES) if THOROUGH else ["wedge", "lifted", "edges"])
@pytest.mark.parametrize("g", [0.9, -0.6] if THOROUGH else [-0.6])
def test_the_equation_of_the_reference_holds(name, g):
    """With its load, and no intensity at free ends: the punch, the layers and the kink all told."""
    profile = PUNCHES[name]
    one, response, unit = found(COATED, profile, g)
    h, m = one.half_width * unit, one.centre * unit
    stress = LOAD * COATED.μ / (2.0 * h)

    def σ(t):
        return stress * pressure(one, t)

    t, w = _rule(sorted([-1.0, *_kinks(profile, m, h), 1.0]))
    # Nearer to a tip than 1e-6 the pressure is told as at that distance; towards an edge this rule ends.
    told = 1e-5 if one.pressure.tips or not all(one.pressure.free) else 1e-7
    assert h * (w @ σ(t)) == pytest.approx(-LOAD * COATED.μ, rel=told)
    assert one.pressure.points(0.3)[1].sum() == pytest.approx(-2.0, rel=1e-8)
    for side, free in zip((-1.0, 1.0), one.pressure.free):
        near, nearer = np.abs(σ(side * (1.0 - np.array([1e-6, 1e-8]))))
        assert nearer < 0.3 * near if free else nearer > 3.0 * near
    equation = ReferenceEquation(COATED, (response.c * COATED.c_s) ** 2, g, h, profile, m)
    for r in (-0.83, -0.31, 0.17, 0.69):
        off, size = equation.off(σ, r, _kinks(profile, m, h))
        assert abs(off) <= told * size


def _kinks(profile, m, h):
    at = [(x - m) / h for x in getattr(profile, "kinks", ())]
    return [x for x in at if abs(x) < 1.0]


@pytest.mark.skipif(not THOROUGH, reason="half a minute")
def test_over_a_graded_top_rules_know_of_kinks():
    """Whatever they are fine enough for, what they add up to is the load."""
    graded = Layered((Layer(1.0, COAT, bottom=SUBSTRATE),), SUBSTRATE)
    one, _, _ = found(graded, wedge(0.01), -0.6, tolerance=1e-6)
    for finest in (3.0, 0.1):
        assert one.pressure.points(finest)[1].sum() == pytest.approx(-2.0, rel=1e-8)


@pytest.mark.parametrize(
    "profile", [wedge(0.01), table(tuple((x, 0.01 * abs(x) ** 1.5) for x in range(-4, 5)))]
)
def test_next_to_the_surface_rules_have_the_pressure_between_its_panels(profile):
    """Between the points of a panel it is interpolated, beside kinks and tips as exactly as elsewhere."""
    one, _, _ = found(COATED, profile, -0.6, tolerance=1e-6)
    pressure = one.pressure
    fine = replace(pressure.on_panels.functions, finest=2.0**-4, settled=0.5)
    t, forces = (values[-len(fine.t) :] for values in pressure.points(2.0**-4))
    exact = fine.weights * (1.0 - t) * (1.0 + t) * pressure.alone.series(t)
    np.testing.assert_array_equal(t, fine.t)
    assert len(t) > len(pressure.on_panels.functions.t)
    np.testing.assert_allclose(forces, exact, rtol=0.0, atol=1e-11 * np.abs(exact).max())


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_contact_wider_than_what_is_known_of_the_punch_is_refused(side):
    profile = table(
        tuple(sorted((side * x, 0.01 * (x**2 + abs(x))) for x in (-0.01, 0.0, 1.0, 2.0, 3.0)))
    )
    response = COATED.response(0.0)
    speed = LayersUnderPunch(response, response.stack(1.0), 1e-4, Punch(profile, 1.0, LOAD))
    with pytest.raises(SolveError, match="known from"):
        speed.contact(0.0)


@pytest.mark.parametrize("tolerance", [1e-4, *(1e-6,) * THOROUGH])
def test_free_ends_over_a_graded_top_settle_with_few_unknowns(tolerance):
    """Next to them the pressure varies over the length of the grading; |X|⁴ has no kink to resolve."""
    soft, hard = Isotropic(32e9, 0.3, 4000.0), Isotropic(155e9, 0.25, 5000.0)
    solid = Layered((Layer(3e-4, soft, hard),), Isotropic(1e11, 0.3, 4000.0))
    body = make_contact(solid, Power(4.0, 1e6), 2.4e4)
    response = body.response(0.3 * solid.limit())
    contact = under_punch(body, response, tolerance).contact(-0.7)
    assert contact.change <= 0.25 * tolerance
    assert contact.pressure.functions.finest > 0.3 and contact.pressure.kinks == ()


def test_what_frictions_share_is_in_the_estimate_of_every_quantity():
    body = make_contact(COATED, PUNCHES["edges"], LOAD * COATED.μ)
    response, g, places = body.response(0.3), np.array([-0.4]), np.array([-1.5, 0.2])
    layers = under_punch(body, response, 1e-6)
    contact = layers.contact(-0.4)
    points = np.array([[0.0, -0.5], [0.3, -0.5]])
    where = Places(places, points, interfaces=COATED.depths, along=places)
    task = Task(0, body, response, where, (slice(0, 1),), (body.load,))
    alone, shared = (
        LayeredSolution(task, layers, [contact], [], error, g).estimates for error in (0.0, 0.125)
    )
    assert len(alone) == 4
    for word in alone:
        assert 0.0 < alone[word][0] < 1e-5, word
        assert shared[word] == pytest.approx(alone[word] + 0.125), word


@pytest.mark.parametrize("free", [True, False])
def test_a_change_next_to_free_ends_counts_ten_times(free):
    """In-plane stresses follow it there: at a hundredth of the half-width √(1 - r²) is 0.141."""
    weight = 0.5 if free else -0.5
    one, other = (
        SolvedContact(0.0, Expansion(weight, weight, np.array([size]), Jacobi(weight, weight)))
        for size in (-1.0, -1.0 - 1e-6)
    )
    assert one.moved(other) == pytest.approx(1.41e-6 if free else 1e-6, rel=2e-3)


@pytest.mark.parametrize("away, counts", [(0.01, False), (0.03, True)])
def test_a_change_at_a_tip_of_the_punch_does_not_count(away, counts):
    """Pressure is infinite there, and no number of unknowns follows it."""
    place = np.cos(np.pi * 4.5 / 25.0)  # one of those that are compared

    def contact(bump):
        def series(r):
            return -1.0 - bump * np.exp(-(((r - place) / 1e-3) ** 2))

        ends = {"α": -0.5, "β": -0.5, "free": np.array([False, False])}
        return SolvedContact(0.0, SimpleNamespace(series=series, tips=(place + away,), **ends))

    assert (contact(1e-3).moved(contact(0.0)) > 1e-4) == counts


def test_lengths_of_a_contact_between_frictions_are_those_of_one_solved_there():
    body = make_contact(COATED, PUNCHES["parabola"], LOAD * COATED.μ)
    layers = under_punch(body, body.response(0.3), 1e-6)
    solved, _ = layers.solved(np.linspace(0.0, 0.9, 41))
    nodes = Nodes([groups_of(layers, of, np.array([of.g]), np.zeros(1, dtype=int))[0] for of in solved])
    between = nodes.between(np.array([0.0, 0.47, 0.9]))
    exact = layers.contact(0.47)
    h, m = between.of("half_width"), between.of("centre")
    lengths = np.array([exact.half_width, exact.centre]) * layers.punch.unit
    assert (h[1], m[1]) == pytest.approx(lengths, rel=1e-6)
    assert np.ptp(h) > 1e-3 * h[0]


def test_a_length_to_measure_by_needs_no_pressure_that_is_resolved(monkeypatch):
    """Over a thin film: no tolerance would help where this is refused."""
    contact = make_contact(Layered((Layer(1e-2, COAT),), SUBSTRATE), PROFILES["parabolic"](50.0), 1.0)
    exact = contact.half_width
    half_width_at_rest.cache_clear()
    monkeypatch.setattr("galinx.solvers.contact.equation._TERMS", [54, 81])
    monkeypatch.setattr("galinx.solvers.contact.equation._AT_REST", 1e-12)
    assert replace(contact).half_width == pytest.approx(exact, rel=1e-2)
    half_width_at_rest.cache_clear()


@pytest.mark.parametrize("thickness, ratio", [(4e-4, 0.9), (2e-3, 1.024)])
def test_a_loose_tolerance_sees_what_a_thin_film_does_at_an_edge(thickness, ratio):
    """Few polynomials, one number like the next, had the K_I of an edge 6 % off at 1e-2."""
    film = replace(SUBSTRATE, E=ratio * SUBSTRATE.E)
    body = make_contact(Layered((Layer(thickness, film),), SUBSTRATE), Flat(1.0), 1.0)
    loose, tight = (under_punch(body, body.response(0.0), at).contact(-0.5) for at in (1e-2, 1e-3))
    ends = [contact.pressure.series(ENDS) for contact in (loose, tight)]
    np.testing.assert_allclose(*ends, rtol=5e-3)
    assert np.abs(ends[0] / ends[1] - 1.0).max() <= 4.0 * loose.change


def test_a_film_that_no_number_of_unknowns_sees_is_refused():
    body = make_contact(Layered((Layer(1e-7, COAT),), SUBSTRATE), Flat(1.0), 1.0)
    with pytest.raises(SolveError, match=r"so thin .* leave it out"):
        under_punch(body, body.response(0.0), 0.1).contact(-0.5)
