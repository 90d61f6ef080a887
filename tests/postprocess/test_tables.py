"""What tables leave out: rounding, and loops of a steady motion."""

from support import computed, here

from galinx.postprocess.tables import states_sheet

SCENE = """
solid.material = "steel"
punch.profile = "parabolic"
punch.radius = "5 mm"
punch.load = "100 N/mm"
friction.mu = 0.0
motion.speed = "1 m/s"
solve.methods = ["closed_form"]
"""


def test_the_tension_that_frictionless_contact_has_by_rounding_is_none():
    result = computed(SCENE)
    for tension, shown in ((0.0, "0 MPa"), (4e-9, "0 MPa"), (4e-5, "0.03808 MPa at X = -262.6 µm")):
        result.data["states/closed_form/sigma_XX_max"][:] = tension
        rows = dict(states_sheet(result.data, result.units(), width=80).rows)
        assert rows["largest tension σ_XX"] == shown
        plain = dict(states_sheet(result.data, result.units(dimensionless=True), width=80).rows)
        assert (plain["largest tension σ_XX"] == "0 N/(2a)") is (shown == "0 MPa")


def test_only_strokes_have_a_friction_loop(tmp_path):
    for strokes, loops in ((None, False), (["forward"], True)):
        archive = tmp_path / f"{loops}.h5"
        computed(SCENE, {"friction.mu": 0.2, "motion.strokes": strokes}).save(archive)
        shown = here("show", archive)
        assert shown.returncode == 0 and ("Friction loops" in shown.stdout) is loops
