import numpy as np
import pytest

from galinx.postprocess import compare

X = np.array([-1.5, -0.5, 0.0, 0.5, 1.5])
EXACT = np.array([[2.0, -1.0, -1.0, -1.0, 4.0]])
INSIDE = np.array([[-0.5, 0.2]])
METHODS = ("closed_form", "fem")
PRESSURE = np.array([[np.nan, -1.0, -2.0, -1.0, np.nan]])


def archive(**changes):
    data = {
        "states/g": np.array([0.5]),
        "states/alpha": np.array([-0.4]),
        "states/beta": np.array([-0.6]),
        "states/closed_form/K_I_left": np.array([0.3]),
        "states/closed_form/K_I_right": np.array([0.3]),
        "states/fem/normal_force": np.array([-10.0]),
        "states/fem/tangential_force": np.array([-5.0]),
        "states/fem/K_I_left": np.array([0.3]),
        "states/fem/K_I_right": np.array([0.3]),
        "states/fem/alpha": np.array([-0.4]),
        "states/fem/beta": np.array([-0.6]),
        "states/fem/estimate": np.array([0.0]),
        "states/fem/slope_under_punch": np.array([0.0]),
        "surface/X_over_a": X,
        "surface/closed_form/sigma_XX": EXACT,
        "surface/closed_form/sigma_YY": PRESSURE,
        "surface/fem/sigma_XX": EXACT,
        "surface/fem/sigma_YY": PRESSURE,
        "surface/fem/sigma_YY_raw": PRESSURE,
        "states/fem/estimate_sigma_XX": np.array([0.0]),
        "states/fem/estimate_inside": np.array([0.0]),
        "interior/X_over_a": np.array([0.0, 3.0]),
        "interior/Y_over_a": np.array([-1.0, -1.0]),
        **{f"interior/{method}/sigma_{ij}": INSIDE for method in METHODS for ij in ("XX", "YY", "XY")},
    } | changes
    return {found.name: found.value for found in compare.comparisons(data, 10.0, compare.RULES)}


def test_what_agrees_is_zero():
    found = archive()
    assert len(found) == 10 and max(found.values()) == 0.0


@pytest.mark.parametrize(
    "path, value, name, wanted",
    [
        ("states/fem/normal_force", [-10.1], "force balance", 0.01),
        ("states/fem/tangential_force", [5.0], "force balance", 1.0),
        ("states/fem/K_I_left", [0.27], "K_I", 0.1),
        ("states/fem/K_I_right", [0.33], "K_I", 0.1),
        ("states/fem/estimate", [0.1], "estimate", 0.1),
        ("states/fem/estimate_sigma_XX", [0.1], "estimate of sigma_XX", 0.1),
        ("states/fem/estimate_inside", [0.1], "estimate inside", 0.1),
        ("states/fem/alpha", [-0.38], "exponents", 0.02),
        ("states/fem/beta", [-0.62], "exponents", 0.02),
        ("states/fem/slope_under_punch", [0.1], "slope under the punch", 0.1),
        ("surface/fem/sigma_YY", [[np.nan, -1.0, -2.2, -1.0, np.nan]], "sigma_YY", 0.1),
        ("interior/fem/sigma_XY", [[-0.5, 0.25]], "stresses inside", 0.1),
        ("surface/fem/sigma_XX", [[2.4, -1.0, -1.0, -1.0, 4.0]], "sigma_XX", 0.1),
    ],
)
def test_what_disagrees_is_measured(path, value, name, wanted):
    found = archive(**{path: np.array(value)})
    assert found[name] == pytest.approx(wanted)
    assert sum(found.values()) == pytest.approx(wanted)


def test_tension_is_flagged_and_nothing_else_is():
    pulled = np.array([[np.nan, -1.0, 0.25, -1.0, np.nan]])
    assert "tension" not in archive()
    assert archive(**{"surface/fem/sigma_YY": pulled})["tension"] == 0.25
