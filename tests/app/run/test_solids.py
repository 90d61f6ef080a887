"""Any uniform solid by finite elements: against the closed form, against isotropic, mirrored."""

import json

import numpy as np
import pytest
from support import THOROUGH, computed, here, section_of

import galinx
from galinx.solvers.solids.plane import Orthotropic

CLOSED = {"methods": ["closed_form"]}
#: Stiffness [Pa] of fibres askew to the surface.
SKEW = [40e9, 12e9, 15e9, 16e9, 6e9, 13e9]

FRICTION = {"mu_c": 0.6, "sigma0_over_load": 6e4}


def result_of(solid, share, tolerance, quantities=("sif",), **more):
    """The result of a scene of an orthotropic or anisotropic solid at a share of its limit."""
    return computed(changes={
        "solid": section_of(solid), "friction": FRICTION, "punch": None,
        "motion": {"c": float(share * solid.limit()), "X_over_L": [0.1, 0.7]},
        "solve": {"tolerance": tolerance}, "output": {"quantities": list(quantities)},
    } | more)  # fmt: skip


def solids():
    """Twelve with E1/E2 from 1 to 40, spread over angles and speeds."""
    rng = np.random.default_rng(16)
    for i, stiffest in enumerate(np.geomspace(1.0, 40.0, 12)):
        E1, angle = 1e9 * stiffest, rng.uniform(-90.0, 90.0)
        G12, share = rng.uniform(0.3e9, 0.7e9), rng.uniform(0.0, 0.9)
        yield pytest.param(Orthotropic(E1, 1e9, 1e9, 0.3, 0.3, 0.4, G12, 1500.0, angle), share, id=str(i))


ALL = list(solids())


@pytest.mark.parametrize("solid, share", ALL if THOROUGH else ALL[3::6])
@pytest.mark.parametrize("tolerance", [1e-6, *[1e-9] * THOROUGH])
def test_finite_elements_reach_the_tolerance(solid, share, tolerance):
    result = result_of(solid, share, tolerance)
    error, estimate = (result.data[f"states/fem/{name}"] for name in ("true_error", "estimate"))
    assert result.verdict == "PASS", result.attributes["verdict_reasons"]
    assert error.max() <= tolerance
    assert np.all(error <= estimate) and estimate.max() <= tolerance


@pytest.mark.parametrize("solid, share", ALL if THOROUGH else ALL[5:6])
@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-7] if THOROUGH else [1e-4])
def test_stresses_reach_the_tolerance(solid, share, tolerance):
    """Or say that they do not, where rounding leaves no more digits: of some solids seven."""
    points = {"output.points": [[0.0, -0.5], [0.99, -0.01], [-1.02, -0.003], [1.5, -1.0]]}
    found = result_of(solid, share, tolerance, ("sif", "surface", "interior"), **points)
    data = found.data
    estimates = [data[f"states/fem/estimate_{name}"] for name in ("sigma_XX", "inside")]
    for true, estimate in zip((in_plane_error(data), inside_error(data)), estimates):
        assert np.all(true <= estimate)
    kept = np.max(estimates) <= tolerance
    assert (found.verdict == "PASS") == kept and (kept or tolerance < 1e-6)


def test_stresses_next_to_an_edge_show_nothing_of_how_friction_was_found():
    """What friction leaves in the contact forces does not change with the degree: no estimate sees it."""
    solid, share = ALL[7].values
    data = result_of(solid, share, 1e-6, ("sif", "surface"), **{"solve.degree": 12}).data
    assert np.all(in_plane_error(data) <= data["states/fem/estimate_sigma_XX"])


def in_plane_error(data):
    """Of every state, over the larger of itself and the largest 0.01 a from the edges."""
    exact, X = data["surface/closed_form/sigma_XX"], data["surface/X_over_a"]
    far = np.abs(exact[:, np.abs(np.abs(X) - 1.0) > 0.01 - 1e-12]).max(axis=1, keepdims=True)
    error = np.abs(data["surface/fem/sigma_XX"] - exact)
    return (error / np.maximum(np.abs(exact), far)).max(axis=1)


def inside_error(data):
    """Of every state, over the largest stress 0.01 a from the edges, which no point here is nearer to."""
    of = [[data[f"interior/{m}/sigma_{ij}"] for ij in ("XX", "YY", "XY")] for m in ("fem", "closed_form")]
    found, exact = np.array(of)
    largest = np.abs(exact).max(axis=(0, 2))
    return np.abs(found - exact).max(axis=(0, 2)) / largest


def test_the_block_is_smaller_for_a_solid_stiff_across_its_depth_and_says_so():
    upright = Orthotropic(14e9, 1e9, 1e9, 0.3, 0.3, 0.4, 0.5e9, 1500.0, 90.0)
    data = result_of(upright, 0.3, 1e-2, **{"solve.mesh": "box"}).data
    error, estimate = data["states/fem/true_error"], data["states/fem/estimate"]
    assert error.max() > 0.01 and np.all(error <= estimate) and np.all(estimate <= 10.0 * error)


@pytest.fixture(scope="module")
def skew():
    """Stresses inside by fibres askew to the surface, whose σ_ZZ is known, or is not."""
    solid = {"kind": "anisotropic", "rho": 1600, "stiffness": SKEW}
    more = {
        "solid": solid,
        "solve": CLOSED,
        "output": {"quantities": ["interior"], "points": [[0, -0.5]]},
    }
    whole = {"friction": FRICTION, "motion": {"c": 0.3}, "punch": None} | more
    return [computed(changes=whole | row) for row in ({}, {"solid.stiffness_Z": [1e9, 2e9, 0.0]})]


def test_von_mises_asks_for_what_σ_ZZ_needs(skew):
    for result, known in zip(skew, (False, True)):
        assert ("interior/closed_form/von_mises" in result.data) == known
        assert "interior/closed_form/sigma_1" in result.data


def test_constants_that_are_lists_are_archived(skew, tmp_path):
    """And read again by every command."""
    skew[0].save(tmp_path / "skew.h5")
    for words in (("check", "skew.h5"), ("show", "skew.h5")):
        done = here(*words, cwd=tmp_path)
        assert done.returncode == 0, done.stderr
    assert json.loads(galinx.load(tmp_path / "skew.h5").attributes["solid"])["stiffness"] == SKEW
