from pathlib import Path

import numpy as np
import pytest
from conftest import run_scene
from galinx.meshes.halfplane import MESHES
from mpi4py import MPI
from scipy.special import eval_chebyt

from galinx.clock import Clock
from galinx.meshes.rings import TAGS, Refinement
from galinx.postprocess import compare
from galinx.solvers.errors import MeshError, SolveError
from galinx.solvers.fem import direct as linear
from galinx.solvers.fem.direct import Factor
from galinx.solvers.fem.distributed import distribute
from galinx.solvers.fem.punch import SlidingPunch
from galinx.solvers.fem.space import Space
from galinx.solvers.fem.surface import SurfaceTrace
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.solids.isotropic import MovingFrame


def disagreement(data):
    """Value of every comparison by name."""
    return {found.name: found.value for found in compare.comparisons(data, 55.3e3)}


def test_tables_4_and_5_to_every_printed_digit(tables_run):
    from galinx.app.study.published import intensity_rows

    data, _ = tables_run
    rows = [row for name in ("table4", "table5") for row in intensity_rows(name, data)]
    assert len(rows) == 12
    for row in rows:
        assert [round(K, 4) for K in row.K_I[1:]] == [row.K_I[0]] * 3
        np.testing.assert_allclose(row.diff_percent[1:], row.diff_percent[0], atol=0.015)
        assert row.agrees


def test_accuracy_at_the_default_tolerance(tables_run):
    data, attributes = tables_run
    found = disagreement(data)
    assert found[compare.K_I] <= 1e-6
    assert found[compare.PRESSURE] <= 1e-5 and found[compare.IN_PLANE] <= 1e-4
    assert found[compare.EXPONENTS] <= 2e-4
    assert attributes["verdict"] == "PASS"


def test_forces_balance(tables_run):
    data, _ = tables_run
    np.testing.assert_allclose(data["states/fem/normal_force"], -55.3e3, rtol=1e-9)
    np.testing.assert_allclose(data["states/fem/tangential_force"], -55.3e3 * data["states/g"], rtol=1e-9)


def test_work_does_not_grow_with_the_number_of_states(tables_run):
    """At each speed a factorisation for the results, and some of lower degree that measure the error."""
    few, _ = tables_run
    positions = ", ".join(f"{x:g}" for x in np.linspace(0.0, 1.0, 200))
    many, _ = run_scene("tables4_5", ("X_over_L = [0.2, 0.8]", f"X_over_L = [{positions}]"))
    assert len(many["states/f"]) == 1200
    assert list(many["run/fem/factorisations"]) == list(few["run/fem/factorisations"])
    assert few["run/fem/factorisations"].max() <= 4
    # Some seventeen fields at each of three degrees, each solved for and refined.
    assert many["run/fem/back_substitutions"].max() < 120


@pytest.mark.parametrize("mode", ["contact", "traction"])
def test_finite_elements_need_no_closed_form(mode):
    data, attributes = run_scene(
        "tables4_5",
        ('methods = ["closed_form", "fem"]', 'methods = ["fem"]'),
        ('mesh = "confocal"', f'mode = "{mode}" #'),
    )
    assert not any("closed_form" in name for name in data)
    assert np.isfinite(data["surface/fem/sigma_XX"]).all()
    assert attributes["verdict"] == "PASS"


def test_states_at_once_are_the_states_one_by_one(tables_run):
    data, _ = tables_run
    one, _ = run_scene(
        "tables4_5",
        ("X_over_L = [0.2, 0.8]", "X_over_L = [0.8]"),
        ("c = [4.786e-7, 0.6]", "c = [0.6]"),
        ('strokes = ["forward", "backward", "forward"]', 'strokes = ["forward"]'),
    )
    for name in ("states/fem/K_I_left", "states/fem/v0", "surface/fem/sigma_XX"):
        np.testing.assert_allclose(one[name][0], data[name][7], rtol=1e-8)


@pytest.mark.parametrize("c", [0.0, 0.9])
@pytest.mark.parametrize("tolerance", [1e-3, 1e-9])
def test_the_tolerance_is_reached_and_the_estimate_honest(c, tolerance):
    data, _ = run_scene(
        "tables4_5",
        ("c = [4.786e-7, 0.6]", f"c = [{c}]"),
        ("tolerance = 1e-6", f"tolerance = {tolerance}"),
        ("mu_c = 0.7", "mu_c = 1.0"),
    )
    true, estimate = data["states/fem/true_error"].max(), data["states/fem/estimate"].max()
    assert true <= tolerance and estimate <= tolerance
    assert true <= 3.0 * estimate


def test_high_speed():
    data, attributes = run_scene("high_speed", ("[0.0, 0.3, 0.6, 0.8, 0.9]", "[0.9]"))
    found = disagreement(data)
    assert found[compare.K_I] <= 1e-6
    assert found[compare.PRESSURE] <= 1e-4 and found[compare.IN_PLANE] <= 1e-4
    assert attributes["verdict"] == "PASS"


@pytest.mark.parametrize("nu", [-0.9, 0.49, 0.4999, 0.5])
def test_no_solid_locks(nu):
    data, attributes = run_scene("tables4_5", ("nu = 0.25", f"nu = {nu}"))
    found = disagreement(data)
    assert attributes["verdict"] == "PASS"
    assert found[compare.K_I] <= 1e-6 and found[compare.IN_PLANE] <= 1e-5


def test_graded_mesh():
    data, attributes = run_scene("graded")
    found = disagreement(data)
    assert found[compare.K_I] <= 1e-5 and found[compare.EXPONENTS] <= 2e-3
    assert found[compare.PRESSURE] <= 1e-3 and found[compare.IN_PLANE] <= 1e-3
    assert attributes["verdict"] == "PASS"


def test_box_is_limited_by_its_walls():
    data, _ = run_scene("box", ("c = [4.786e-7, 0.6]", "c = [4.786e-7]"))
    assert 1e-3 < disagreement(data)[compare.K_I] < 1e-2


def test_given_tractions_leave_the_punch_flat():
    data, attributes = run_scene("traction")
    found = disagreement(data)
    assert found[compare.SLOPE] <= 1e-6 and found[compare.IN_PLANE] <= 1e-4
    assert attributes["verdict"] == "PASS"


def test_a_given_uniform_traction_has_its_known_stress():
    """Uniform σ_YY = -1 without friction at rest: σ_XX = σ_YY under the load, 0 beside it."""
    data, attributes = run_scene(
        "traction",
        ('mode = "traction"', 'mode = "traction"\npressure = [[-1, -1], [1, -1]] #'),
        ("c = [4.786e-7, 0.6]", "c = [0.0]"),
        ("X_over_L = [0.2, 0.8]", "X_over_L = [0.0]"),
        ('strokes = ["forward", "backward", "forward"]', 'strokes = ["forward"]'),
    )
    X, σ_XX = data["surface/X_over_a"], data["surface/fem/sigma_XX"][0]
    away = np.abs(1.0 - np.abs(X)) > 0.02
    np.testing.assert_allclose(σ_XX[away], np.where(np.abs(X) < 1.0, -1.0, 0.0)[away], atol=1e-4)
    assert data["states/fem/normal_force"] == pytest.approx(-55.3e3, rel=1e-12)
    assert attributes["verdict"] == "not judged"


def test_the_two_signs_of_friction_are_mirror_images(tables_run):
    physical, _ = tables_run
    printed, _ = run_scene("tables4_5", ('sign = "physical"', 'sign = "eq25"'))
    np.testing.assert_array_equal(printed["states/g"], -physical["states/g"])
    np.testing.assert_allclose(
        printed["states/fem/K_I_left"], physical["states/fem/K_I_right"], rtol=1e-9
    )
    np.testing.assert_allclose(
        printed["surface/fem/sigma_XX"], physical["surface/fem/sigma_XX"][:, ::-1], rtol=1e-5, atol=1e-7
    )


def test_pressure_and_tension_lead_at_the_trailing_end(tables_run):
    """Physical sign, forward: both the stronger singularity and the tension are at X = -a."""
    data, _ = tables_run
    X = data["surface/X_over_a"]
    behind, ahead = np.argmin(np.abs(X + 1.05)), np.argmin(np.abs(X - 1.05))
    for i in np.flatnonzero(data["states/f"] > 0.0):
        assert data["states/fem/beta"][i] < data["states/fem/alpha"][i]
        assert data["surface/fem/sigma_XX"][i, behind] > 0.0 > data["surface/fem/sigma_XX"][i, ahead]


def moment_error(mesh, refinement, degree, c=0.6, g=0.66):
    """Largest error of the pressure's first six Chebyshev moments over N."""
    kind = MESHES[mesh]
    space = Space(*distribute(kind.build(refinement), MPI.COMM_WORLD), TAGS, kind.chart, degree)
    solver = SlidingPunch(space, 2.0, c)
    state = solver.states(g)
    X = kind.chart.surface_position(space.contact.s)
    exact = FlatPunch(MovingFrame(2.0, c), g)
    t, w = np.polynomial.legendre.leggauss(200)
    τ, w = (t + 1.0) / 2.0, w / 2.0
    near, stretch = τ**8, 8.0 * τ**7
    errors = []
    for n in range(6):
        moment = np.sum(
            w * stretch * exact.σ_YY_by_distance(near, 2.0 - near) * eval_chebyt(n, near - 1.0)
        )
        moment += np.sum(
            w * stretch * exact.σ_YY_by_distance(2.0 - near, near) * eval_chebyt(n, 1.0 - near)
        )
        errors.append(abs(state.normal[0] @ eval_chebyt(n, X) - moment) / 2.0)
    solver.destroy()
    return max(errors)


def test_exponential_convergence_in_the_degree():
    refinement = Refinement(8, 0.35, 2, (3.0,) * 7)
    degrees = np.arange(3, 8)
    errors = [moment_error("confocal", refinement, p) for p in degrees]
    decades_a_degree = -np.polyfit(degrees, np.log10(errors), 1)[0]
    assert decades_a_degree > 0.9
    assert errors[-1] < 1e-7


def test_between_facets_the_right_one_counts_whatever_rounding_does():
    s = np.array([[-1.0, 0.0], [1e-16, 2.0]])
    trace = SurfaceTrace(s, np.abs(s)[..., None, None] * np.ones((2, 1)))
    for at in (-1e-16, 0.0, 2e-16):
        np.testing.assert_allclose(trace.derivative([at]), 1.0)
    np.testing.assert_allclose(trace.derivative([-1e-6]), -1.0)


def test_convergence_in_the_grading():
    """The energy in the innermost ring, of radius ρ, goes as ρ^(2 + 2α), α = -1/2 without friction."""
    ratio, levels = 0.5, np.array([3, 4, 5, 6])
    columns = (1.0,) * 15
    errors = [moment_error("graded", Refinement(n, ratio, 2, columns), 6, g=0.0) for n in levels]
    expected = 2.0 * (2.0 + 2.0 * -0.5)  # a ring of size s in (ξ, η) has the radius s²/2
    rate = np.polyfit(levels * np.log(ratio), np.log(errors), 1)[0]
    assert rate == pytest.approx(expected, rel=0.05)


def test_a_missing_boundary_part_is_named():
    kind = MESHES["confocal"]
    mesh, tags = distribute(kind.build(Refinement(1, 0.3, 1, (1.0,))), MPI.COMM_WORLD)
    with pytest.raises(MeshError, match="far"):
        Space(mesh, tags, TAGS | {"far": 17}, kind.chart, 2)


@pytest.mark.parametrize("entry", [0.0, float("nan")])
def test_a_singular_matrix_is_not_taken_for_a_solution(entry):
    from petsc4py import PETSc

    A = PETSc.Mat().createAIJ((4, 4), comm=PETSc.COMM_SELF)
    A.setUp()
    for i in range(4):
        A.setValue(i, i, 2.0 if i else entry)
    A.assemble()
    b = A.createVecLeft()
    b.set(1.0)
    with pytest.raises(SolveError):
        Factor(A, Clock()).solve(b)


def small_punch(c=0.6, **options):
    kind = MESHES["confocal"]
    cells = kind.build(Refinement(6, 0.35, 2, (3.0,) * 3))
    return SlidingPunch(Space(*distribute(cells, MPI.COMM_SELF), TAGS, kind.chart, 7), 2.0, c, **options)


@pytest.mark.parametrize("c, refines", [(0.0, False), (0.6, False), (0.9192, True)])
def test_solutions_are_refined_where_that_changes_forces(c, refines):
    """Near the Rayleigh speed, 0.9194 c_s, rounding grows."""
    always, where_needed = (small_punch(c, negligible=share) for share in (0.0, 1e-10))
    wanted, found = (punch.states([-0.5, 0.5]) for punch in (always, where_needed))
    fields = len(where_needed.fields)
    assert always.factor.solves == 2 * len(always.fields)
    assert where_needed.factor.solves == (2 * fields if refines else fields + 1)
    scale = np.linalg.norm(wanted.normal)
    assert np.linalg.norm(found.normal - wanted.normal) <= 2e-10 * scale


def test_a_workspace_that_was_too_small_is_enlarged_once(monkeypatch):
    expected = small_punch().states(0.5).normal
    monkeypatch.setattr(linear, "WORKSPACE", (-80, 400))
    np.testing.assert_allclose(small_punch().states(0.5).normal, expected, rtol=1e-9)
    monkeypatch.setattr(linear, "WORKSPACE", (-80, -80))
    with pytest.raises(SolveError, match=r"status -9.*it wanted [0-9]+ MB a rank"):
        small_punch()


def test_factors_are_freed():
    def resident():
        return int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1]) * 4096

    sizes = []
    for _ in range(40):
        small_punch().destroy()
        sizes.append(resident())
    # Unfreed, each would leave two megabytes.
    assert sizes[-1] - sizes[9] < 15e6


def test_the_condition_is_recorded(tables_run):
    data, _ = tables_run
    assert (data["run/fem/largest_condition"] > 1e3).all()
    assert (data["run/fem/largest_condition"] < 1e7).all()


def test_a_pressure_that_pulls_fails():
    pulling = ('mode = "traction"', 'mode = "traction"\npressure = [[-1, -2], [0, 1], [1, -2]] #')
    _, attributes = run_scene("traction", pulling)
    assert attributes["verdict"] == "FAIL"
    assert "tension under the punch, over N/(2a): 1.0e+00, at most 0" in attributes["verdict_reasons"]
