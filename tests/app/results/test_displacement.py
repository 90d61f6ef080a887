"""A state's displacement in dolfinx, for those who go on there."""

import numpy as np
import pytest
from support import THOROUGH, computed

from galinx import template
from galinx.app.errors import BadInput

ALONE = {"motion.strokes": ["forward"], "motion.X_over_L": 0.0}


@pytest.mark.parametrize(
    "mesh, c, tolerance",
    [("confocal", 0.6, 1e-8), ("graded", 0.6, 1e-4), *([("confocal", 0.0, 1e-8)] if THOROUGH else [])],
)
def test_its_energy_is_the_work_of_the_tractions_round_it(mesh, c, tolerance):
    """Without friction: of strain less motion, N v₀/2 and that of what is beyond; in physical space."""
    import ufl
    from dolfinx import fem
    from dolfinx.mesh import locate_entities_boundary, meshtags

    changes = {"motion.c": c, "solve.mesh": mesh, "solve.tolerance": tolerance}
    # So fine a tolerance of stresses along the surface would ask for more than this needs.
    changes |= {"output.quantities": ["sif"]} if tolerance < 1e-6 else {}
    result = computed("tables4_5", ALONE | changes)
    assert result.data["states/f"][0] == 0.0
    u, solid = result.displacement(), result.scene.solid
    domain = u.function_space.mesh
    strain = ufl.sym(ufl.grad(u))
    λ = 2.0 * solid.μ * solid.ν / (1.0 - 2.0 * solid.ν)
    stress = λ * ufl.tr(strain) * ufl.Identity(2) + 2.0 * solid.μ * strain
    slope, inertia = u.dx(0), solid.μ * c**2
    density = ufl.inner(stress, strain) / 2.0 - inertia * ufl.inner(slope, slope) / 2.0
    X, Y = np.abs(domain.geometry.x[:, :2]).max(axis=0)
    far = np.sort(locate_entities_boundary(domain, 1, lambda x: np.hypot(x[0] / X, x[1] / Y) > 0.999))
    tags, quadrature = meshtags(domain, 1, far, np.ones(len(far), np.int32)), {"quadrature_degree": 24}
    dx = ufl.Measure("dx", domain, metadata=quadrature)
    ds = ufl.Measure("ds", domain, subdomain_data=tags, metadata=quadrature)
    n = ufl.FacetNormal(domain)
    traction = stress * n - inertia * slope * n[0]
    energy, beyond, load = (
        fem.assemble_scalar(fem.form(one))
        for one in (density * dx, ufl.inner(traction, u) / 2.0 * ds(1), traction[1] * ds(1))
    )
    N = result.scene.punch.load
    assert load == pytest.approx(N, rel=1e-7)
    assert energy == pytest.approx(N * result.data["states/fem/v0"][0] / 2.0 + beyond, rel=1e-7)


@pytest.mark.parametrize(
    "mesh, tolerance, c", [("confocal", 1e-4, 0.8), ("confocal", 1e-7, 0.0), ("graded", 1e-4, 0.8)]
)
def test_indentation_is_alike_at_all_tolerances(mesh, tolerance, c):
    """Without friction v = (2n/π) arcosh X - v₀ beside a flat punch, far away (2n/π) log 2X - v₀."""
    changes = {"motion.c": c, "solve.mesh": mesh, "solve.tolerance": tolerance}
    result = computed("tables4_5", ALONE | changes)
    solid, N = result.scene.solid, result.scene.punch.load
    exact = N / solid.μ * solid.response(c).n / np.pi * np.log(200.0)
    assert result.data["states/fem/v0"][0] == pytest.approx(exact, rel=0.1 * tolerance)


def test_what_has_no_displacement_is_bad_input():
    from galinx.app.results.fields import displacement

    with pytest.raises(BadInput, match="state 99: no such state; expected 0 to 11"):
        displacement(template("tables4_5"), 99)
    with pytest.raises(BadInput, match=r"expected ν <= 0\.49"):
        displacement(template("tables4_5", {"solid.nu": 0.495}), 0)
