"""What is measured of stresses and slopes."""

import numpy as np

from galinx.solvers.contact import stresses
from galinx.solvers.solids.isotropic import Isotropic


def test_flatness_compares_slopes_under_the_punch_with_those_beside_it():
    X = np.array([-1.5, -1.05, -0.95, -0.5, 0.9, 1.1])
    v_X = np.array([[4.0, 99.0, 99.0, -1.0, 0.5, -2.0], [2.0, 0.0, 0.0, 0.0, -1.0, 0.0]])
    surface = stresses.Surface(stresses.Places(X, np.empty((0, 2))), v_X, v_X, v_X=v_X)
    np.testing.assert_array_equal(stresses.flatness(surface), [0.25, 0.5])


def test_stress_measures_follow_from_principal_stresses():
    random = np.random.default_rng(5)
    XX, YY, XY = random.normal(size=(3, 200))
    for plane in ("strain", "stress"):
        ZZ = Isotropic(1.0, 0.3, 1.0, plane).σ_ZZ(XX, YY, XY)
        tensor = np.zeros((200, 3, 3))
        tensor[:, 0, 0], tensor[:, 1, 1], tensor[:, 2, 2] = XX, YY, ZZ
        tensor[:, 0, 1] = tensor[:, 1, 0] = XY
        deviator = np.linalg.eigvalsh(
            tensor - np.trace(tensor, axis1=1, axis2=2)[:, None, None] * np.eye(3) / 3
        )
        expected = np.sqrt(1.5 * (deviator**2).sum(axis=1))
        np.testing.assert_allclose(stresses.von_mises(XX, YY, XY, ZZ), expected, rtol=1e-12)
        # Hooke's law: no strain, or no stress, out of the plane.
        held = ZZ - 0.3 * (XX + YY) if plane == "strain" else ZZ
        np.testing.assert_allclose(held, 0.0, atol=1e-15)
        low, high = np.linalg.eigvalsh(tensor[:, :2, :2]).T
        np.testing.assert_allclose(stresses.maximum_shear(XX, YY, XY), (high - low) / 2.0, rtol=1e-12)
