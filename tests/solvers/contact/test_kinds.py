"""Kinds of contacts: what the ends of each are, what it lacks, and how loads scale it."""

import numpy as np
import pytest

from galinx.solvers.contact.prescribed_pressure import LinearPressure
from galinx.solvers.contact.solution import (
    FLAT,
    FREE,
    GIVEN_ENDS,
    ONE_FREE,
    PRESCRIBED,
    PUNCH,
    SHARP,
    SOLVED,
    make_contact,
)
from galinx.solvers.profiles.punches import Flat, Parabolic, RoundedFlat, Wedge
from galinx.solvers.solids.isotropic import Isotropic

SOLID = Isotropic(E=1e9, ν=0.3, ρ=1000.0)
PRESSURE = LinearPressure(np.array([-1.0, 0.5, 1.0]), np.array([-0.5, -1.5, 0.0]))
FREE_ENDS = {PUNCH, FLAT, GIVEN_ENDS}


@pytest.mark.parametrize(
    "profile, pressure, ends, lacks, growth",
    [
        (Flat(1e-3), None, SHARP, set(), 1.0),
        (Flat(1e-3), PRESSURE, PRESCRIBED, {SOLVED}, 1.0),
        (Flat(1e-3, 0.5), None, ONE_FREE, FREE_ENDS, None),
        (Parabolic(0.1), None, FREE, FREE_ENDS, 2.0),
        (Parabolic(0.1), PRESSURE, FREE, FREE_ENDS, 2.0),
        (Wedge(1e-2), None, FREE, FREE_ENDS, 4.0),
        (RoundedFlat(1e-3, 0.1), None, FREE, FREE_ENDS, None),
    ],
)
def test_a_kind_says_what_it_is(profile, pressure, ends, lacks, growth):
    contact = make_contact(SOLID, profile, 1e4, pressure)
    assert contact.ends == ends and contact.lacks.keys() & {*FREE_ENDS, SOLVED} == lacks
    assert contact.growth(4e4) == (growth and pytest.approx(growth, rel=1e-14))
    assert contact.alike == (growth is not None)
    if growth is not None:
        wider = contact.loaded(4e4).half_width / contact.half_width
        assert wider == pytest.approx(growth, rel=1e-9)
    assert contact.found == (GIVEN_ENDS in lacks)
