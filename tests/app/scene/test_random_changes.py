"""Whatever stands behind ``--set``: a scene, or one readable message, in a moment.

GALINX_THOROUGH=1 tries as many as a release does.
"""

import random

import pytest
from support import SCENE, THOROUGH, at_most

from galinx.app.errors import BadInput
from galinx.app.plan.plan import make_plan
from galinx.app.scene.changes import from_words
from galinx.app.scene.read import read

TEXTS = 300 if THOROUGH else 20

KEYS = [
    "title", "solid", "solid.E", "solid.nu", "solid.material", "solid.plane", "punch.profile",
    "punch.load", "friction.mu_c", "friction.model", "friction.delta", "friction.pre_sliding", "motion.c",
    "motion.speed", "motion.strokes", "motion.X_over_L", "solve.degree", "solve.cuts", "solve.tolerance",
    "solve.methods", "solve.pressure", "solve.mesh", "output.points", "output.map", "output.quantities",
    "title.x", "a.b.c", "new.x", "solid.E.x", ".", "..", "solid.", ".E", '"solid".E', "solid.'E'",
    "[solid].E", "[[solid]].E", "solid[0]", "sol\x1bid.E",
]  # fmt: skip
VALUES = [
    "", "9" * 5000, "-" + "9" * 5000, "0x" + "f" * 6000, "9" * 400, "1e999", "inf", "nan", "-0", "0b1",
    "[" * 3000, "[" * 3000 + "]" * 3000, "[" * 400 + "1" + "]" * 400, "{" * 3000, "{a=" * 500 + "}" * 500,
    "{a=1}", "{}", "{X=[1,2,3]}", "{X={a=1},Y=2}", "{X=[" + "9" * 400 + ",2,3],Y=[1,2,3]}", "{a.b.c=1}",
    "[{a=1}]", "[[{a=1},2],[3,4]]", "[[1,2],[3]]", "[[true,1],[1,1]]", "[]", "[[]]", "[true]", "[1,", "]",
    "1979-05-27", "07:32:00", "true", '"\\u001b[31m"', "\x1b[31m", "\x9b31m", "\u202etxt", "\udcff",
    "\x00", "a\nb=1", "1\n[x]\ny=2", "'''a\nb'''", '"', "'", "#", "1 #c", "=", "\\", '"\\x',
    "a" * 100_000, "[" + "1," * 5000 + "]", "1 Pa*9**9**9", "30 deg", "5 %", "193 GPa", "0.5", "[0.1]",
    "stress", "closed_form", '["closed_form"]', '["forward", {a=1}]', "1.5 mm/s", "1_000", "{a",
    "{from=0, to=0.9, number=5}", "{from=1e-300, to=1e300, number=1000, spacing='log'}",
    "{from=0, to=0, number=1}", "{from={}, to=[], number=nan}",
    "{from=1, to=2, number=" + "9" * 400 + "}",
]  # fmt: skip


@pytest.mark.parametrize("n", range(TEXTS))
def test_a_change_gives_a_scene_or_a_message(n):
    choose = random.Random(n)
    words = [f"{choose.choice(KEYS)}={choose.choice(VALUES)}" for _ in range(choose.choice([1, 1, 1, 2]))]
    if n % 5 == 0:  # any characters
        words[0] = words[0][: choose.randint(0, 40)] + "".join(
            map(chr, choose.choices(range(1, 300), k=8))
        )
    with at_most():
        try:
            assert make_plan(read(SCENE, from_words(words))).states > 0
        except BadInput as error:
            assert 0 < len(str(error).strip()) < 3000, words
