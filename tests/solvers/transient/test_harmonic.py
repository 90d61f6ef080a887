"""Loads that oscillate: known limits, the mirror image, and finite elements in time."""

import numpy as np
import pytest
from random_solids import random_solid
from starts import ByFiniteElements

from galinx.solvers.solids.isotropic import Isotropic
from galinx.solvers.transient.harmonic import OscillatingPunch, highest
from galinx.solvers.transient.history import smooth
from galinx.solvers.transient.transform import Transformed

SOLIDS = [Isotropic(1.0, 0.25, 1.0), random_solid(0), random_solid(2)]


def oscillation(solid, c, g, ω):
    return OscillatingPunch(solid.response(c), solid.limit(), np.asarray(ω)).oscillation(g)


@pytest.mark.parametrize("solid", SOLIDS)
@pytest.mark.parametrize("share, g", [(0.0, 0.0), (0.5, -0.4)])
def test_at_low_frequencies_the_pressure_is_steady_and_the_punch_sinks_by_a_logarithm(solid, share, g):
    """v̂₀ = -(N̂/πμ) (n + g n₁₂) log iω + what is the same at all of them, but for ω log ω."""
    c = share * solid.limit()
    steady, found = solid.response(c), oscillation(solid, c, g, [1e-6, 2e-6])
    v, n = found.flexibility, steady.n + g * steady.n12
    assert abs((v[1] - v[0]) / np.log(2.0) + 2.0 / np.pi * n) < 2e-4 * abs(v[0])
    # Centre β - α of the flat punch, α = -1/2 - atan(g q/n)/π.
    assert abs(found.centre - 2.0 * np.arctan(g * steady.q / n) / np.pi).max() < 1e-4


@pytest.mark.parametrize("solid", SOLIDS)
def test_at_high_frequencies_plane_waves_go_down(solid):
    """Two edges add what falls like 1/ω."""
    c, g = 0.3 * solid.limit(), 0.3
    punch = OscillatingPunch(
        solid.response(c), solid.limit(), np.linspace(10.0, 20.0, 11) * solid.limit()
    )
    found = punch.oscillation(g)
    damping = found.stiffness / (1j * found.ω)
    np.testing.assert_allclose(damping.mean(), punch.plane_waves(g), rtol=0.04)
    isotropic = OscillatingPunch(SOLIDS[0].response(0.0), SOLIDS[0].limit(), np.array([1.0]))
    assert abs(isotropic.plane_waves(0.3) - 3.0**0.5) < 1e-12  # c_d/c_s at ν = 1/4


def test_polynomials_tell_their_error():
    """At half of the highest frequency that is known, against some more of them."""
    solid = SOLIDS[0]
    steady, limit = solid.response(0.5), solid.limit()
    last = highest(steady, limit) / 2.0
    found = OscillatingPunch(steady, limit, np.array([last])).oscillation(-0.4)
    basis = (more := Transformed(steady, limit, np.array([1j * last]), 64, 0.1)).basis(-0.4)
    ((best,),) = more.answers(basis)
    off = abs(found.flexibility[0] / best[-1] - 1.0)
    assert off < found.error[0] + 1e-11 < 1e-7


def test_finite_elements_in_time_answer_alike():
    """Laplace's transform of what a pulse of the load does, at complex s: ∫ e^(-st) v₀ dt."""
    started, g = ByFiniteElements(SOLIDS[0], 0.6, 5.0, 50, degree=5, innermost=1e-3), -0.4
    run = started.run(g, lambda t: smooth(t, 1.0) - smooth(t - 1.0, 1.0))
    load = smooth(run.t, 1.0) - smooth(run.t - 1.0, 1.0)
    s = 2.0 + 1j * np.array([0.0, 1.0, 3.0])
    weights = np.tile([4.0, 2.0], 25) / 3.0 * 0.1  # Simpson's; both begin with 0 and end with next to it
    by_time = [np.exp(-np.multiply.outer(s, run.t)) @ (weights * values) for values in (run.v0, load)]
    punch = Transformed(started.response, SOLIDS[0].limit(), s, 24)
    (found,) = punch.answers(punch.basis(g))
    np.testing.assert_allclose(by_time[0] / by_time[1], found[:, -1], rtol=2e-3)
