"""A state's displacement in dolfinx, for those who go on there."""

import numpy as np
import pytest
from support import computed

from galinx import template
from galinx.app.errors import BadInput

ALONE = {"motion.strokes": ["forward"], "motion.X_over_L": 0.0}


@pytest.mark.parametrize(
    "mesh, c, tolerance", [("confocal", 0.0, 1e-6), ("confocal", 0.6, 1e-6), ("graded", 0.6, 1e-4)]
)
def test_its_energy_is_the_work_of_the_load(mesh, c, tolerance):
    """Without friction, of strain less motion: N v₀/2. The form is integrated in the physical plane."""
    import ufl
    from dolfinx import fem

    changes = {"motion.c": c, "solve.mesh": mesh, "solve.tolerance": tolerance}
    result = computed("tables4_5", ALONE | changes)
    assert result.data["states/f"][0] == 0.0
    u, solid = result.displacement(), result.scene.solid
    domain = u.function_space.mesh
    strain = ufl.sym(ufl.grad(u))
    λ = 2.0 * solid.μ * solid.ν / (1.0 - 2.0 * solid.ν)
    stress = λ * ufl.tr(strain) * ufl.Identity(2) + 2.0 * solid.μ * strain
    slope = u.dx(0)
    density = ufl.inner(stress, strain) / 2.0 - solid.μ * c**2 * ufl.inner(slope, slope) / 2.0
    dx = ufl.Measure("dx", domain, metadata={"quadrature_degree": 24})
    energy = fem.assemble_scalar(fem.form(density * dx))
    work = result.scene.punch.load * result.data["states/fem/v0"][0] / 2.0
    assert energy == pytest.approx(work, rel=1e-7)


def test_it_is_that_of_the_punch(tables_run):
    u = tables_run.displacement(7)
    a, domain = tables_run.scene.punch.profile.half_width, u.function_space.mesh
    X, Y, _ = domain.geometry.x.T / a
    assert Y.max() <= 1e-12 and X.min() == pytest.approx(-X.max(), rel=1e-9) and X.max() > 1e6
    nodes = np.reshape(u.x.array, (-1, 2))
    v0 = tables_run.data["states/fem/v0"][7]
    under = np.isclose(nodes[:, 1], -v0, rtol=1e-9, atol=0.0)
    assert under.sum() > 50 and nodes[:, 1].min() > -1.5 * v0
    assert u.name == "displacement"


def test_what_has_no_displacement_is_bad_input():
    from galinx.app.results.one_state import displacement

    with pytest.raises(BadInput, match="state 99: no such state; expected 0 to 11"):
        displacement(template("tables4_5"), 99)
    with pytest.raises(BadInput, match=r"expected ν <= 0\.49"):
        displacement(template("tables4_5", {"solid.nu": 0.495}), 0)
