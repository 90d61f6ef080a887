"""A state's displacement in dolfinx, for those who go on there."""

import numpy as np
import pytest
from support import THOROUGH, computed

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
