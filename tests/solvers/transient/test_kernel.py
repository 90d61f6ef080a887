"""The kernels of motion in time against the transform by its definition."""

import numpy as np
import pytest

from galinx.solvers.solids.isotropic import rayleigh_speed
from galinx.solvers.transient.kernel import Kernel


def panels(edges):
    t, w = np.polynomial.legendre.leggauss(20)
    half = np.diff(edges)[:, None] / 2.0
    return (edges[:-1, None] + half * (1.0 + t)).ravel(), (half * w).ravel()


def by_definition(slow, c, x, s):
    """(1/2π) ∫ symbols e^(ikx) dk along the real axis, its far ends turned into the upper half-plane."""

    def symbols(k, bs, bd):
        kC = k * c + 1j * s
        D = 4.0 * k * k * bs * bd - (2.0 * k * k - kC**2) ** 2
        return np.array([bd * kC**2 / D, 1j * k * (2.0 * k * k - kC**2 - 2.0 * bs * bd) / D])

    last = 40.0 * abs(s)
    k, w = panels(np.linspace(-last, last, 2001))
    kC = k * c + 1j * s
    total = symbols(k, np.sqrt(k * k - kC**2), np.sqrt(k * k - slow * kC**2)) @ (w * np.exp(1j * k * x))
    v, w = panels(np.linspace(0.0, 40.0 / x, 201))
    for sign in (1.0, -1.0):
        k = sign * last + 1j * v
        C = c + 1j * s / k
        bs, bd = sign * k * np.sqrt(1.0 - C * C), sign * k * np.sqrt(1.0 - slow * C * C)
        total += symbols(k, bs, bd) @ (1j * sign * w * np.exp(1j * k * x))
    return total / (2.0 * np.pi)


@pytest.mark.parametrize("ν", [0.1, 0.25, 0.3, 0.45])
@pytest.mark.parametrize("c", [0.0, 0.6, -0.6])
@pytest.mark.parametrize("s", [1.0 + 0.0j, 0.9 + 12.0j, 6.0 + 0.5j])
def test_kernels_are_the_transform_of_their_symbols(ν, c, s):
    κ = 3.0 - 4.0 * ν
    slow = (κ - 1.0) / (κ + 1.0)
    found = Kernel(slow, c, rayleigh_speed(κ))(np.array([0.3, 1.5]), s)
    for value, x in zip(found.T, (0.3, 1.5)):
        expected = by_definition(slow, c, x, s)
        np.testing.assert_allclose(value, expected, rtol=0.0, atol=2e-7 * np.abs(expected).max())
