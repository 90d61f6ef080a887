"""Pressures over layers, read off the moments that functions of a stretched variable have with them."""

import numpy as np
import pytest

from galinx.meshes.layered import steepness
from galinx.solvers.contact.recovery import Stretch, from_moments

HALF = np.array([-0.5])


def of_flat_punch(stretch, polynomials, middle=0.0, half_width=1.0):
    """The pressure that has a flat punch's moments, by Gauss and Chebyshev's rule in its own contact."""
    nodes = np.cos(np.pi * (np.arange(16000) + 0.5) / 16000)
    f = stretch.values(middle + half_width * nodes, polynomials + stretch.of_ends)
    return from_moments(f.mean(axis=0)[None], HALF, HALF, stretch)


@pytest.mark.parametrize(("graded", "polynomials"), [(False, 12), (False, 20), (True, 6)])
def test_a_contact_that_ends_elsewhere_changes_the_pressure_at_its_ends_by_the_steepness(
    graded, polynomials
):
    """Read by the same functions, which know nothing of where it ends."""
    stretch, length, r = Stretch(0.8, graded), 1e-6, np.linspace(-1.0, 1.0, 7)
    whole = of_flat_punch(stretch, polynomials)
    assert whole.series(r) == pytest.approx(1.0 / np.pi, rel=1e-6)
    shorter = of_flat_punch(stretch, polynomials, -0.5 * length, 1.0 - 0.5 * length)
    right = np.abs(shorter.series(r) - whole.series(r))[0]
    moved = (right + right[::-1]).max() * np.pi / length / steepness(polynomials, stretch.h)
    if graded:
        assert 1.0 < moved < 400.0
    else:
        assert moved == pytest.approx(1.0, rel=0.1)
