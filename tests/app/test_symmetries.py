"""The mirror image of a scene has the mirror image of its answer, and other units change no number."""

from functools import cache

import numpy as np
import pytest
from combined import METHODS, UNITS, answers, cases, check_same, mirrored, words_of
from support import THOROUGH

import galinx
from galinx.app.scene.read import parse
from galinx.postprocess.quantities import declared
from galinx.postprocess.quantities.quantity import ALONG, POINT, STATE

#: By integral equations alone, which takes a moment, and by finite elements.
EXACT = [
    case.but(methods=METHODS[case.layered][:1], words=words_of(case.solid, case.punch, "exact"))
    for case in cases(None if THOROUGH else "cusp")
]
FEM = [
    case.but(methods=("fem",), tolerance=1e-2)
    for case in cases(None if THOROUGH else "parabolic")
    if case.by_finite_elements
][slice(None) if THOROUGH else slice(3, None, 9)]
SOLVED = [pytest.param(case, allowed, id=f"{case}, {case.methods[0]}")
          for some, allowed in ((EXACT, 1e-6), (FEM, 0.1)) for case in some]  # fmt: skip


@cache
def solved(case):
    """Datasets of the states of a case."""
    data = answers(galinx.compute(parse(case.text())).data)
    assert len(data) > 10
    return data


@pytest.mark.parametrize("case, allowed", SOLVED)
def test_the_mirror_image(case, allowed):
    """The stroke, the angle of the solid and the profile turned: forward becomes backward.

    Exact answers are compared with those of the mirror image in other units.
    """
    original, image = solved(case), solved(case.but(mirrored=True, scaled=case in EXACT))
    assert set(image) == {mirrored(name)[0] for name in original}
    for name, values in original.items():
        other, sign = mirrored(name)
        along = [i for i, over in enumerate(declared(name).over) if over in (STATE, POINT, ALONG)]
        unit = UNITS[declared(name).unit] if case in EXACT else 1.0
        check_same(values, sign * np.flip(image[other], along) / unit, allowed, name)
