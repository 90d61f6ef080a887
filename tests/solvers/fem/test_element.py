import numpy as np
import pytest
from support import space_on

from galinx.meshes.rings import Refinement
from galinx.solvers.fem.forms import FORMS
from galinx.solvers.solids.isotropic import Isotropic, MovingFrame


def test_values_inside_cells_follow_from_those_on_their_boundaries():
    """A linear field is a solution at rest."""
    space, response = space_on("graded", Refinement(2, 0.3, 1, (1.0, 1.0)), 4), MovingFrame(2.2, 0.0)
    x = space.coordinates
    u = np.stack([0.3 * x[:, 0] - 0.2 * x[:, 1], 0.7 * x[:, 1] + 0.1 * x[:, 0] + 2.0], axis=-1)
    at = u[space._cell_nodes]
    found = space.extended(at[:, space.kernel.outer, :, None], response, np.arange(len(at)))
    np.testing.assert_allclose(found[..., 0], at, atol=1e-12 * np.abs(u).max())


κ, C = 2.2, 0.6
K, COUPLING = (κ + 1.0) / (κ - 1.0), 2.0 / (κ - 1.0)


@pytest.mark.parametrize(
    "name, constants",
    [("isotropic", [κ, C]), ("anisotropic", [K, K - 2.0, 0.0, K, 0.0, 1.0, C])],
    ids=["isotropic", "anisotropic"],
)
def test_the_weak_form_has_the_coefficients_of_eqs_15_and_16(name, constants):
    """Integration by parts makes u,XX, u,YY, v,XX, v,YY and both mixed derivatives of its energy."""
    (H,) = FORMS[name].densities(np.array([constants]))  # of u,X u,Y v,X v,Y
    np.testing.assert_allclose(np.diag(H), [K - C**2, 1.0, 1.0 - C**2, K], rtol=1e-14)
    assert H[0, 3] + H[1, 2] == pytest.approx(COUPLING, rel=1e-14)  # v,XY in Eq 15, u,XY in Eq 16
    np.testing.assert_allclose(H[[0, 0, 3, 3], [1, 2, 1, 2]], 0.0, atol=1e-15)
    np.testing.assert_array_equal(H, H.T)


@pytest.mark.parametrize("form, ν", [("isotropic", 0.25), ("nearly incompressible", 0.499)])
@pytest.mark.parametrize("mesh", ["confocal", "graded"])
def test_a_translation_needs_no_force(mesh, form, ν):
    """Not even the last digits of one: near the Rayleigh speed the body moves far before it deforms."""
    space = space_on(mesh, Refinement(4, 0.3, 2, (1.0, 1.0)), 8, form=form)
    response = MovingFrame(2.0, 0.9) if ν == 0.25 else Isotropic(1.0, ν, 1.0).response(0.9)
    S = space.condensed(response, np.arange(space.cells))
    nodes = len(space.kernel.outer)
    for i in range(2):
        motion = np.zeros(S.shape[1])
        motion[i : 2 * nodes : 2] = 1.0
        force = S @ motion
        # Little more than what summing a row's numbers leaves; without care it is 3 to 50 times as much.
        assert np.abs(force).max() <= 2.0 * np.finfo(float).eps * np.abs(S).sum(axis=2).max()
