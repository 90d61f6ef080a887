"""Stresses inside layered half-planes and at interfaces."""

import mpmath as mp
import numpy as np
import pytest
from layers_cases import COAT, SUBSTRATE, constants, converged_pressure, equation
from layers_reference import system
from loaded import under

from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.layers.kernel import Level
from galinx.solvers.layers.layered import Layer, Layered

X = np.linspace(-3.0, 3.0, 25)


@pytest.mark.parametrize("depth", [0.02, 0.3, 0.5, 0.7, 2.0])
def test_layers_of_one_solid_have_the_field_of_the_half_plane(depth):
    solid = Layered((Layer(0.3, COAT), Layer(0.4, COAT)), COAT)
    one = equation(solid, 0.9, -0.4)
    pressure = converged_pressure(one, 1e-10).pressure
    exact = under(FlatPunch(COAT.response(0.9**0.5 / COAT.c_s), -0.4)).inside(X, -depth + 0.0 * X)
    level = Level(one.kernel.stack, depth, 4.0, 1e-9)
    u_X, σ_YY, σ_XY = level.read(*pressure.points(depth), -0.4, X)
    σ_XX = level.media[1].response.σ_XX(u_X, σ_YY, σ_XY)
    assert np.abs(np.array([σ_XX, σ_YY, σ_XY]) - exact).max() <= 1e-9 * np.abs(exact).max()


@pytest.mark.parametrize("graded", [False, True])
def test_field_is_that_of_the_reference(graded):
    """At some wavenumbers, at an interface and inside the substrate."""
    middle = Layer(0.4, SUBSTRATE, COAT) if graded else Layer(0.4, SUBSTRATE)
    solid = Layered((Layer(0.3, COAT), middle), COAT)
    c = 0.5 * solid.limit()
    stack, V2 = solid.response(c).stack(1.0), mp.mpf(c * solid.c_s) ** 2
    mp.mp.dps = 40
    for k in (0.5, 3.0):
        tops = (
            [layer_system(middle.at(s), V2, k) for s in (np.arange(200) + 0.5) / 200] if graded else None
        )
        exact = carried(solid, V2, mp.mpf(k), tops)
        for depth, rows in exact.items():
            level = Level(stack, depth, 4.0, 1e-9)
            got = level._of(np.array([k]))[0]
            off = np.abs(got - rows).max() / np.abs(rows).max()
            assert off <= (2e-5 if graded else 1e-12)


def layer_system(solid, V2, k):
    return system(constants(solid), mp.mpf(solid.ρ), V2, mp.mpf(k))


def carried(solid, V2, k, slices):
    """u,X, σ_YY, σ_XY by σ_XY and σ_YY on top, at the lower interface and 0.5 below it, (6,) each."""
    below = layer_system(solid.substrate, V2, k)
    values, vectors = mp.eig(below)
    chosen = [n for n in range(4) if mp.re(values[n]) > 0]
    field = mp.matrix([[vectors[row, n] for n in chosen] for row in range(4)])
    deep = mp.expm(below * -0.5) * field
    top = field
    middle = solid.layers[1]
    if slices is None:
        top = mp.expm(layer_system(middle.solid, V2, k) * middle.thickness) * top
    else:
        for one in reversed(slices):
            top = mp.expm(one * (middle.thickness / len(slices))) * top
    top = mp.expm(layer_system(solid.layers[0].solid, V2, k) * solid.layers[0].thickness) * top
    by_top = top[2:, :] ** -1
    μ, found = mp.mpf(solid.μ), {}
    for depth, one in ((0.7, field), (1.2, deep)):
        here = one * by_top
        rows = [mp.mpc(0, 1) * k * here[0, :] * μ, here[3, :], here[2, :]]
        found[depth] = np.array([complex(row[j]) for row in rows for j in range(2)])
    return found
