"""Strain along the surface by Laplace's transform against what is known of it."""

import numpy as np
import pytest
from random_solids import random_solid

from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.solids.isotropic import Isotropic
from galinx.solvers.transient.line_load import both_sides
from galinx.solvers.transient.punch import ON_SURFACE, AlongSurface
from galinx.solvers.transient.transform import Transformed

SOLID = Isotropic(1.0, 0.25, 1.0)
TERMS, SOME = 14, ON_SURFACE[::4]


def strains(solid, c, g, s, X):
    """û,X at places under the pressure of a punch at some s, and that pressure."""
    s, response = np.array(s, dtype=complex), solid.response(c)
    transformed = Transformed(response, solid.limit(), s, TERMS)
    basis = transformed.basis(g)
    (answers,) = transformed.answers(basis)
    along = AlongSurface(response, solid.limit(), s, X)
    a = answers[:, :-1, None]
    return (along.strains(basis) @ a)[..., 0], basis, a


def test_beside_the_contact_it_is_that_of_the_kernel():
    X = np.array([-1.3, 1.3])
    s, g = [0.3, 1.0 + 4.0j, 2.0 - 6.0j], -0.5
    found, basis, a = strains(SOLID, 0.5, g, s, X)
    loads, w = basis.pressure.rule(120)
    σ = (w * (basis.pressure.polynomials(loads) @ a)[..., 0])[:, None]
    ahead, behind = both_sides(SOLID.response(0.5), SOLID.limit(), 1)
    kernels = np.array([
        [behind(loads - X[0], at, True)[2:], ahead(X[1] - loads, at, True)[2:]]
        for at in s
    ])  # fmt: skip
    by_σ_XY = g * np.array([-1.0, 1.0])[:, None] * kernels[:, :, 1]  # behind it that of the mirror image
    expected = ((kernels[:, :, 0] + by_σ_XY) * σ).sum(axis=-1)
    np.testing.assert_allclose(found, expected, rtol=1e-7, atol=1e-8)


@pytest.mark.parametrize(("solid", "c", "g"), [(SOLID, 0.6, -0.5), (random_solid(1), 0.2, 0.4)])
def test_at_late_times_it_is_steady(solid, c, g):
    """What is left falls like s, with its logarithm."""
    steady = FlatPunch(solid.response(c), g)
    σ = np.nan_to_num(steady.σ_YY(SOME))
    expected, weight = steady.σ_XX(SOME), np.minimum(np.sqrt(np.abs(1.0 - SOME**2)), 1.0)
    off = []
    for s in (1e-4, 1e-6):
        u_X = strains(solid, c, g, [s], SOME)[0][0].real
        σ_XX = solid.response(c).σ_XX(u_X, σ, g * σ)
        off.append(np.abs((σ_XX - expected) * weight).max())
    assert off[1] < 3e-4
    assert off[1] < 0.05 * off[0]
