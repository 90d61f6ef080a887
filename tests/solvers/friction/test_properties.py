"""What laws promise on random motions: independence of the rate, dissipation, mirror images, slopes."""

from dataclasses import replace

import numpy as np
import pytest
import random_laws as random
from support import THOROUGH

from galinx.solvers.friction import LAWS
from galinx.solvers.friction.integrate import exactly, work
from galinx.solvers.friction.motion import Partial, legs, works
from galinx.solvers.parameters import build_model

SETS = range(20 if THOROUGH else 2)
ALL = random.EXACT


def drawn(name, seed):
    """A law, and the numbers that follow."""
    rng = np.random.default_rng([seed, *name.encode(), 7])
    return build_model(LAWS[name], random.parameters(name, rng)), rng


def moved(law, z, way, V=1e-3):
    """The state after some signed displacements [m]."""
    for x in way:
        if x:
            z = exactly(law, z, int(np.sign(x)), V, abs(x), np.array([abs(x)]))[-1]
    return z


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("seed", SETS)
def test_laws_say_whether_they_depend_on_the_speed(name, seed):
    law, rng = drawn(name, seed)
    way = [20.0 * random.LENGTH, *(rng.uniform(-1.0, 1.0, 5) * random.LENGTH), 20.0 * random.LENGTH]
    f = [law.friction(moved(law, law.rest(), way, V), 1, V) for V in (1e-4, 2e-2)]
    assert law.depends_on_speed == (name not in random.RATE_INDEPENDENT) == (abs(f[0] - f[1]) > 1e-4)
    assert law.depends_on_speed or f[0] == f[1]


@pytest.mark.parametrize("name", [name for name in ALL if name != "table"])
@pytest.mark.parametrize("seed", SETS)
def test_work_in_a_closed_loop_is_never_negative(name, seed):
    """Of loops that the state closes, too: what is stored is given back."""
    law, rng = drawn(name, seed)
    V, length = 1e-3, float(rng.uniform(0.1, 2.0) * random.LENGTH)
    z, done = law.rest(), []
    for n in range(60):
        s = 1 if n % 2 == 0 else -1
        if n >= 56:
            done.append(float(work(law, z, s, V, length)))
        z = exactly(law, z, s, V, length, np.array([length]))[-1]
    assert done[0] + done[1] >= -1e-15 * length
    assert done[0] + done[1] == pytest.approx(done[2] + done[3], rel=1e-2, abs=1e-3 * length)


@pytest.mark.parametrize("name", [name for name in ALL if name != "table"])
def test_the_work_of_the_shortest_strokes_has_as_many_digits_as_their_friction(name):
    """About the rest, where what rounding leaves of the work of full slip would be more than the work."""
    law, _ = drawn(name, 0)
    undamped = {"σ1": 0.0, "σ2": 0.0}
    law = replace(law, **undamped) if undamped.keys() <= vars(law).keys() else law
    z, V, (places, weights) = law.rest(), 1e-3, np.polynomial.legendre.leggauss(12)
    for s, length in ((1, 1e-8 * random.LENGTH), (-1, 2e-8 * random.LENGTH), (1, 1e-8 * random.LENGTH)):
        f = s * law.friction(exactly(law, z, s, V, length, length * (0.5 + 0.5 * places)), s, V)
        summed, rounding = 0.5 * length * (weights @ f), 1e-12 * length * np.abs(f).max()
        assert work(law, z, s, V, length) == pytest.approx(summed, rel=0, abs=rounding)
        z = exactly(law, z, s, V, length, np.array([length]))[-1]


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("seed", SETS)
def test_a_mirrored_motion_has_mirrored_friction(name, seed):
    law, rng = drawn(name, seed)
    if name == "table":
        law = LAWS["table"](law.shape)
    z = [law.rest(), law.rest()]
    for s, V, length, _ in random.strokes(rng, 3):
        slip, f, done = np.linspace(0.0, length, 4), [], []
        for i, sign in enumerate((s, -s)):
            done.append(float(work(law, z[i], sign, V, length)))
            states = exactly(law, z[i], sign, V, length, slip)
            f.append(law.friction(states, sign, V))
            z[i] = states[-1]
        np.testing.assert_allclose(f[0], -f[1], rtol=0.0, atol=1e-14)
        assert done[0] == pytest.approx(done[1], rel=1e-12, abs=1e-18)


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("seed", SETS)
def test_slopes_are_differences_of_the_friction(name, seed):
    law, rng = drawn(name, seed)
    z, V = moved(law, law.rest(), [random.LENGTH, -0.37 * random.LENGTH]), 1e-3
    length = float(rng.uniform(0.2, 1.0) * random.LENGTH)
    h = 1e-6 * length
    after = exactly(law, z, 1, V, length, np.array([0.0, h]))
    slope = law.slope(z if name == "table" else after[0], 1, V)
    if slope is not None:
        differences = np.diff(law.friction(after, 1, V))[0] / h
        assert float(slope) == pytest.approx(differences, rel=1e-4, abs=1e-3)


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("seed", SETS)
def test_no_sample_of_a_stroke_has_more_friction_than_its_largest(name, seed):
    """On strokes 1 000 times as long as what friction changes over: most is at their start."""
    law, rng = drawn(name, seed)
    length, V = 1e3 * random.LENGTH, 10.0 ** rng.uniform(-5.0, -1.0)
    strokes = legs([Partial(1.0), Partial(0.3), Partial(0.9)])
    z, samples = law.rest(), np.append(0.0, np.geomspace(1e-9, 1.0, 4001))
    _, breakaways, _ = works(law, strokes, length, V, exactly)
    for leg, breakaway in zip(strokes, breakaways[0]):
        states = exactly(law, z, leg.s, V, length, samples * leg.length * length)
        largest = (leg.s * law.friction(states, leg.s, V)).max()
        assert breakaway >= largest - 1e-8 * abs(largest)
        z = states[-1]


@pytest.mark.parametrize("name", [name for name in ALL if name != "table"])
@pytest.mark.parametrize("seed", SETS)
def test_rates_are_those_of_the_states(name, seed):
    """In slip by differences, and in time that times the speed; directions of slip do not change."""
    law, rng = drawn(name, seed)
    V, h = 1e-3, 1e-6 * random.LENGTH
    back = moved(law, law.rest(), [random.LENGTH, -rng.uniform(0.0, 0.4) * random.LENGTH])
    for z in (back, moved(law, back, [random.LENGTH])):  # before the elements slip, and after it
        first, then = exactly(law, z, 1, V, h, np.array([0.0, h]))
        settled = law.settle(first, 1, V)
        changing = slice(len(z) // (2 if name == "gms" else 1))
        rate = law.rate(settled, 1, V)
        np.testing.assert_allclose(rate[changing], ((then - first) / h)[changing], rtol=1e-4, atol=1e-2)
        np.testing.assert_allclose(law.flow(settled, 1, V), V * rate, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("name", [name for name in ALL if LAWS[name].broadcasts])
def test_many_laws_at_once_are_each_of_them(name):
    rng = np.random.default_rng(11)
    one = [random.parameters(name, rng) for _ in range(5)]
    together = {key: np.array([given[key] for given in one])[:, None] for key in one[0]}
    laws, many = [build_model(LAWS[name], given) for given in one], build_model(LAWS[name], together)
    single, z = [law.rest() for law in laws], np.broadcast_to(many.rest(), (5, 1, 1))
    for s, V, length, rest in random.strokes(rng):
        slip = np.linspace(0.0, length, 4)
        z = many.pause(z, rest)
        done = work(many, z, s, V, length)
        slopes = many.slope(z, s, V)
        z = many.exact(z, s, V, slip)
        f = many.friction(z, s, V)
        for i, law in enumerate(laws):
            single[i] = law.pause(single[i], rest)
            alone = float(work(law, single[i], s, V, length))
            assert float(done[i]) == pytest.approx(alone, rel=1e-13)
            if slopes is not None:
                assert float(slopes[i, 0]) == pytest.approx(law.slope(single[i], s, V), rel=1e-13)
            states = law.exact(single[i], s, V, slip)
            np.testing.assert_array_equal(z[i], states)
            np.testing.assert_array_equal(f[i], law.friction(states, s, V))
            single[i] = states[-1]
        z = z[:, -1:]
