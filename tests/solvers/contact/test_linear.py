"""The exact solution of a pressure that is linear between knots, against integrals in 60 digits."""

from dataclasses import replace
from itertools import pairwise

import mpmath as mp
import numpy as np
import pytest
from isotropic_field import field
from loaded import LoadedHalfPlane

from galinx.solvers.contact.prescribed_pressure import LinearPressure
from galinx.solvers.solids.isotropic import MovingFrame

PRESSURES = {
    "triangle": [[-1, 0], [0.3, -2], [1, 0]],
    "spike": [[-1, -1], [0.301, -1], [0.302, -50], [0.303, -1], [1, -1]],
    "jumps": [[-1, -3], [-0.2, 0], [0.5, 0], [0.500001, -7], [1, -1]],
}
SPEEDS = [0.0, 4.786e-7, 1e-155, 0.6, 0.9]


def pressure_of(name):
    return LinearPressure(*np.array(PRESSURES[name], dtype=float).T)


class ExactFrame(MovingFrame):
    """The constants of the moving frame in mpmath's digits."""

    def __init__(self, κ, c):
        κ, c = mp.mpf(κ), mp.mpf(c)
        k = (κ - 1) / (κ + 1)
        vars(self).update(κ=κ, c=c, k=k, β_s=mp.sqrt(1 - c**2), β_d=mp.sqrt(1 - k * c**2))


def integral(name, kernel):
    """(1/π) ∫ σ kernel dt over all pieces, by Gauss's rule in as many digits as mpmath has now."""
    pairs = [(mp.mpf(float(x)), mp.mpf(σ)) for x, σ in PRESSURES[name]]

    def of_piece(start, end):
        (x0, s0), (x1, s1) = start, end
        return mp.quad(lambda t: (s0 + (s1 - s0) * (t - x0) / (x1 - x0)) * kernel(t), [x0, x1])

    return sum(of_piece(*ends) for ends in pairwise(pairs)) / mp.pi


def exact_inside(name, κ, c, g, X, Y):
    frame = ExactFrame(κ, c)
    z = mp.mpc(X, frame.β_s * mp.mpf(Y))
    δ = mp.mpc(0, Y) * (1 - frame.k) / (frame.β_d + frame.β_s)
    Φ = integral(name, lambda t: 1 / (t - z))
    # (1/(t - z - c²δ) - 1/(t - z))/c²
    d = integral(name, lambda t: δ / ((t - z) * (t - z - frame.c**2 * δ)))
    return [float(σ) for σ in field(frame, mp.mpf(g), -Φ.imag, Φ.real, -d.imag, d.real)]


@pytest.mark.parametrize("name, c", [*(("triangle", c) for c in SPEEDS), ("spike", 0.6), ("jumps", 0.9)])
def test_stresses_inside_are_those_of_the_integrals(name, c):
    solution = LoadedHalfPlane(MovingFrame(2.2, c), -0.66, pressure_of(name))
    with mp.workdps(40):
        for X, Y in [(0.3, -0.2), (0.31, -0.02), (-3.0, -0.5), (1.0, -0.1), (2e3, -1e4), (1e8, -3e7)]:
            found = solution.inside(X, Y)
            wanted = exact_inside(name, 2.2, c, -0.66, X, Y)
            np.testing.assert_allclose(found, wanted, rtol=0.0, atol=1e-13 * np.abs(wanted).max())


@pytest.mark.parametrize("name", PRESSURES)
def test_the_hilbert_transform_beside_the_contact_is_the_integral(name):
    X = np.array([-1e8, -40.0, -1.2, 1.01, 1.8, 3e3, 1e8])
    with mp.workdps(40):
        wanted = [float(integral(name, lambda t, x=x: 1 / (t - mp.mpf(x)))) for x in X.tolist()]
    np.testing.assert_allclose(pressure_of(name).hilbert(X), wanted, rtol=1e-13)


@pytest.mark.parametrize("name", PRESSURES)
def test_under_the_pressure_the_field_meets_the_surface(name):
    """At knots, next to them and between them, where integrals are principal values."""
    pressure = pressure_of(name)
    knots = pressure.knots[1:-1]
    X = np.concatenate([knots, knots + 1e-12, knots - 1e-12, [-0.7, 0.1, 0.9]])
    below = pressure.at(X - 1e-18j)
    np.testing.assert_allclose(below.real, pressure.hilbert(X), atol=1e-9)
    np.testing.assert_allclose(-below.imag, pressure(X), atol=1e-9)
    uneven = pressure.hilbert(np.array([-0.7])) - pressure.hilbert(np.array([-0.7 + 1e-9]))
    assert np.abs(uneven) < 1e-6


@pytest.mark.parametrize("name", PRESSURES)
def test_kernels_that_are_infinite_at_a_place_are_integrated_there(name):
    """Logarithm and jump of graded layers: differences of positions far from 0 round to 0."""
    pressure = replace(pressure_of(name), rough=True)
    r = np.concatenate([pressure.knots, np.linspace(-1.1, 1.1, 301), [0.9999999]])

    def kernel(x):
        return np.column_stack([np.log(np.abs(x)), np.sign(x)])

    def primitives(x):
        """∫ and ∫ x of both functions from 0."""
        log = np.log(np.abs(x), where=x != 0.0, out=np.zeros_like(x))
        return (x * (log - 1.0), np.abs(x)), (x**2 * (log / 2.0 - 0.25), x * np.abs(x) / 2.0)

    wanted, steepest = 0.0, 0.0
    for (a, σ_a), (b, σ_b) in pairwise(PRESSURES[name]):
        slope = (σ_b - σ_a) / (b - a)
        steepest = max(steepest, abs(slope))
        ends = primitives(r - a), primitives(r - b)
        (of_1, of_x) = (np.stack(upper, -1) - np.stack(lower, -1) for upper, lower in zip(*ends))
        wanted += (σ_a + slope * (r - a))[:, None] * of_1 - slope * of_x
    # Primitives cancel in narrow pieces.
    atol = 1e-12 + 1e-15 * steepest
    np.testing.assert_allclose(pressure.integral(kernel, r, 0.3), wanted, rtol=0.0, atol=atol)
