"""Kernels of motion in time against their definition; symbols by eigenvectors and in many digits."""

import mpmath as mp
import numpy as np
import pytest
from layers_reference import admittance, plane_strain
from random_solids import isotropic_as, random_solid, stiffness
from stroh import admittances

from galinx.solvers.layers.layered import Layer, Layered
from galinx.solvers.solids.admittance import Admittance
from galinx.solvers.solids.isotropic import Isotropic, IsotropicAdmittance
from galinx.solvers.transient.line_load import _NEAR, Echoes, Kernel, UniformLayers


def panels(edges):
    t, w = np.polynomial.legendre.leggauss(20)
    half = np.diff(edges)[:, None] / 2.0
    return (edges[:-1, None] + half * (1.0 + t)).ravel(), (half * w).ravel()


def symbols(C, k, stiff):
    """v̂ and û of unit σ_YY and σ_XY where the field is e^(ikX), by eigenvectors, (4, n)."""
    # e^(ikpY) decays downwards where Im p has the sign of -Re k.
    Y = admittances(stiff, C**2, -np.sign(k.real)) / (1j * k)[:, None, None]
    return Y[:, ::-1, ::-1].reshape(-1, 4).T


def of_any_solid(stiff, c, x, s):
    """(1/2π) ∫ symbols e^(ikx) dk as above; where all waves' wavenumbers are near the axis it is long."""
    last = 25.0 * abs(s)
    k, w = panels(np.linspace(-last, last, 161))
    total = symbols(c + 1j * s / k, k + 0j, stiff) @ (w * np.exp(1j * k * x))
    v, w = panels(np.geomspace(1e-3, 40.0 / x, 21) - 1e-3)
    for sign in (1.0, -1.0):
        k = sign * last + 1j * v
        total += symbols(c + 1j * s / k, k, stiff) @ (1j * sign * w * np.exp(1j * k * x))
    return total / (2.0 * np.pi)


KNOWN = [Isotropic(1.0, 0.1, 1.0), Isotropic(1.0, 0.45, 1.0)]


@pytest.mark.parametrize("seed", range(6))
def test_kernels_of_any_solid_are_the_transform_of_their_symbols(seed):
    rng, solid = np.random.default_rng(seed), [*map(random_solid, range(4)), *KNOWN][seed]
    limit = solid.limit()
    c, s = rng.uniform(-0.8, 0.8) * limit, complex(2.0, rng.uniform(0.0, 3.0))
    surface = Admittance.of(solid.response(0.0))
    found = Kernel(surface, c, limit)(np.array([[[0.4]]]), s)[:, 0]
    as_any = isotropic_as("anisotropic", solid) if seed > 3 else solid
    expected = of_any_solid(stiffness(as_any.response(0.0)), c, 0.4, s)
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-7 * np.abs(expected).max())


@pytest.mark.parametrize("c", [-0.97, -0.4, 0.0, 0.7, 0.97])
@pytest.mark.parametrize("seed", range(6))
def test_near_a_load_the_series_is_the_integral(seed, c):
    """Up to the distance at which one takes over, for any phase of s, displacements and their slopes."""
    rng, solid = np.random.default_rng(seed), [*map(random_solid, range(4)), *KNOWN][seed]
    limit = solid.limit()
    kernel = Kernel(Admittance.of(solid.response(0.0)), c * limit, limit)
    for x, ψ in zip(10.0 ** rng.uniform(-6.0, np.log10(_NEAR), 6), rng.uniform(0.0, 0.5 * np.pi, 6)):
        s, x = np.exp(1j * ψ), np.array([[x * (1.0 - abs(c)) * limit]])
        for slopes in (False, True):
            exact = kernel._far(x, s, slopes)
            found = kernel._near(x, s, slopes)
            np.testing.assert_allclose(found, exact, rtol=0.0, atol=1e-11 * np.abs(exact).max())


@pytest.mark.parametrize("slopes", [False, True])
def test_panels_together_have_the_responses_of_each_distance_alone(slopes):
    """Of one width and of several, near and far, in one array and in two."""
    t, s = np.polynomial.legendre.leggauss(6)[0], 1.5 + 20.0j
    edges = np.concatenate([2.0 ** -np.arange(9.0, 3.0, -1.0), np.linspace(0.125, 1.5, 12)])
    many = edges[:-1, None] + 0.5 * np.diff(edges)[:, None] * (1.0 + t)
    arrays, surface = (many, np.array([[1.7, 1.9]])), Admittance.of(STACK.response(0.0))
    for response in (Kernel(surface, 0.3, STACK.surface.limit()), Echoes(SHEETS, 0.3)):
        alone = [response((np.array([[x]]),), s, slopes) for of in arrays for x in of.ravel()]
        together = response(arrays, s, slopes)
        scale = np.abs(together).max()
        np.testing.assert_allclose(together, np.hstack(alone), rtol=0.0, atol=1e-11 * scale)


def test_roots_meet_at_speeds_of_waves_in_isotropic_solids():
    """Those of shear and pressure; nothing is faster, and straight down waves are these two."""
    solid = Isotropic(1.0, 0.3, 1.0)
    fast = solid.response(0.0).k ** -0.5
    for one in (solid, isotropic_as("anisotropic", solid)):
        surface = Admittance.of(one.response(0.0))
        np.testing.assert_allclose(surface.meeting, [1.0, fast], rtol=1e-12)
        assert abs(surface.fastest / fast - 1.0) < 1e-12
    np.testing.assert_allclose(surface.impedance, np.diag([1.0, fast]), atol=1e-12)


STACK = Layered(
    (Layer(0.7, Isotropic(7.5, 0.3, 1.2)), Layer(0.4, Isotropic(1.5, 0.1, 0.7))),
    Isotropic(2.5, 0.25, 1.0),
)
SHEETS = UniformLayers.of(STACK.response(0.0))
#: The same for the reference.
DIGITS = [(7.5, 0.3, 1.2), (1.5, 0.1, 0.7), (2.5, 0.25, 1.0)]


def random_points(count):
    """k, s with Re s > 0, and c, seeded."""
    rng = np.random.default_rng(5)
    for _ in range(count):
        s = complex(10.0 ** rng.uniform(-1.0, 1.0), 10.0 ** rng.uniform(-1.0, 1.3) * rng.choice([-1, 1]))
        yield -(10.0 ** rng.uniform(-1.0, 0.8)), s, rng.uniform(-0.55, 0.55)


def test_symbol_of_layers_is_that_of_many_digits():
    mp.mp.dps = 40
    of = [(plane_strain(E, ν), ρ) for E, ν, ρ in DIGITS]
    layers = [(H, *one) for H, one in zip((0.7, 0.4), of)]
    for k, s, c in random_points(12):
        C = c + 1j * s / k
        V2 = mp.mpmathify(C) ** 2 * STACK.μ / STACK.ρ
        exact = admittance(layers, of[-1], V2, mp.mpf(k)) - admittance([], of[0], V2, mp.mpf(k))
        exact = np.array((exact * STACK.μ).tolist(), dtype=complex)
        found = SHEETS.change(np.array([k]), np.array([C]))[0]
        np.testing.assert_allclose(found, exact, rtol=0.0, atol=1e-13)


def test_echoes_are_the_transform_of_their_symbol():
    """By the trapezoidal rule along the whole axis of k."""
    c, s, x = 0.3, 1.5 + 4.0j, np.array([0.05, 0.4, 1.7])
    κ = np.linspace(-80.0, 80.0, 16000)  # an even number: none at 0, where a formula divides
    found = Echoes(SHEETS, c)(x[None, None], s)
    left, of = κ < 0.0, np.empty((len(κ), 2, 2), dtype=complex)
    of[left] = SHEETS.change(κ[left], c + 1j * s / κ[left])
    # Fields of k > 0 are the conjugates of those of -k and the conjugate of s.
    other = -κ[~left]
    of[~left] = np.conj(SHEETS.change(other, c + 1j * np.conj(s) / other))
    values = of[:, ::-1, ::-1].reshape(-1, 4).T / (1j * κ)
    expected = values @ np.exp(1j * np.outer(κ, x)) * (κ[1] - κ[0]) / (2.0 * np.pi)
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-8 * np.abs(expected).max())


def test_echoes_of_few_panels_of_wavenumbers_are_those_of_each_distance():
    """None of the first panels of wavenumbers is fine enough."""
    above, below = (
        IsotropicAdmittance(*of, 0.0, of[0], 0.0) for of in ((5.148, 3.148), (2.7847, 0.7847))
    )
    sheets = UniformLayers(((above, 1.0, 1.0), (below, 2.4011, 0.6789)), (1.4356,))
    x = np.linspace(0.0315, 1.98, 28)[:, None] + np.linspace(0.0, 0.07, 14)
    together = Echoes(sheets, 0.385)((x,), 16.6 - 68.4j, slopes=True)
    alone = [Echoes(sheets, 0.385)((row[None],), 16.6 - 68.4j, slopes=True) for row in x]
    np.testing.assert_allclose(together, np.concatenate(alone, axis=1), rtol=1e-6, atol=1e-22)
    assert 0.0 < np.abs(together).max() < 1e-9
