"""What is computed once and read by many tests, and which tests are fast, which meet dolfinx.

A test is ``fast``, or ``fem`` and to be run with every dolfinx, or neither. None says so
itself: its place does, and the fixtures that it asks for.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pytest
from support import HOME, SCENE, THOROUGH, command, kept, once

#: Where tests compute no finite elements and start no process.
FAST = (
    "app/plan/", "app/scene/", "app/study/test_misprints.py", "app/study/test_published.py",
    "app/study/test_statements.py", "docs/test_docs.py", "docs/test_quotes.py", "frozen/",
    "meshes/test_halfplane.py", "postprocess/", "solvers/friction/",
    "solvers/contact/", "solvers/solids/", "solvers/test_rational.py", "test_architecture.py",
    "test_files.py", "test_texts.py",
)  # fmt: skip
#: Fixtures that compute; what asks for one is not fast wherever it is.
SLOW = {"tables_run", "map_run", "inside_run", "archives"}
#: Tests of what dolfinx and PETSc do, each way to use them once: forms, spaces, factors, and every kind
#: of scene on one rank and on two (mpi/). What a result is made of then does not depend on their version.
FEM = (
    "app/commands/test_compute.py::test_one_and_two_ranks", "app/results/test_paraview.py::test_stresses",
    "app/run/test_fixed_degree.py::test_multigrid", "meshes/test_store.py", "mpi/",
    *(f"solvers/fem/test_{name}.py" for name in (
        "compiler", "direct", "dolfinx_space", "element", "punch", "space", "versions",
    )),
)  # fmt: skip
#: Tests of a release, with GALINX_THOROUGH=1: the longest of those that have a shorter one beside them,
#: of the same claim, with another seed, solid, punch or method.
RELEASE = (
    "app/results/test_check.py::test_every_number_of_an_archive_is_computed_again_or_compared[fin",
    "app/results/test_check.py::test_what_was_just_computed_has_no_faults[changes1]",
    *(f"app/run/test_agreement.py::test_both_methods_agree[{name}]" for name in (
        "along-1", "coated_along-0", "elastic_along-3", "kinked_on_layers-1", "pressure-0",
        "smooth-1", "tilted-0", "tilted-1", "tilted_on_layers-1", "isotropic-0",
    )),
    *(f"app/run/test_agreement.py::test_named_scenes_agree[{name}]" for name in (
        "a cylinder over a layer", "a pressure over a layer", "triangle",
        "kinks of friction with cells between them",
    )),
    *(f"app/run/test_largest_stresses.py::test_{name}" for name in (
        "largest_values_are_those_of_samples[2]", "largest_values_are_those_of_samples[11]",
        "a_stiff_plate_is_stretched_most_far_beside_the_contact[fem]",
        "stresses_along_a_thin_film_are_largest_where_close_positions_say[two",
        "stresses_along_a_thin_film_are_largest_where_close_positions_say[wedge]",
        "in_plane_stresses_of_a_pressure_are_largest_at_its_knots_and_beside_them[1]",
        "near_the_speed_limit_loose_tolerances_are_met_as_tight_ones_are[-0.8242",
        "the_largest_tension_at_a_step_of_friction_is_between_its_places[parabolic]",
        "the_surface_of_a_layer_yields_beside_a_kink",
    )),
    *(f"app/run/test_along.py::test_{name}" for name in (
        "a_shipped_scene_of_advected_states",
        "one_friction_along_the_contact_yields_as_a_number[punch_]",
        "kinks_of_friction_move_with_the_ends_that_finite_elements_search_for[punch2",
        "kinks_of_friction_move_with_the_ends_that_finite_elements_search_for[punch3",
    )),
    "app/run/test_along.py::test_estimates_cover_the_pressure_beside_kinks_and_between_them[along1",
    "app/run/test_fixed_degree.py::test_the_estimate_covers_the_true_error[2-9]",
    "app/run/test_found_ends.py::test_a_mesh_that_another_replaced",
    *(f"app/run/test_interruptions.py::test_whoever_is_hit_the_run_ends_in_order_and_is_resumed[{hit}]"
      for hit in ("1-galinx-1-1", "2-mpirun-9-2", "2-0-9-2")),
    "app/run/test_layers.py::test_flat_punches_over_graded_tops_reach_the_usual_tolerance",
    "app/run/test_layers.py::test_a_tilted_punch_on_a_layer_of_its_substrate_is_that_on_the_substrate[0.5-0",
    "app/run/test_loads.py::test_a_pressure_that_is_put_in_has_every_load[pressure1]",
    "app/run/test_motions_mirrored.py::test_a_turn[law-physical]",
    "app/run/test_over_time.py::test_a_coating_starts_by_both_methods",
    "app/run/test_over_time.py::test_fast_ramps",
    "app/run/test_over_time.py::test_intensities_of_the_shortest_ramp",
    "app/run/test_random_stacks.py::test_alone_over_thin_coatings_the_estimate_covers_the_pressure[soft]",
    "app/run/test_random_stacks.py::test_the_hardest_stacks_are_within_their_estimates[thin",
    "app/run/test_swept_numbers.py::test_a_swept_strength_is_that_of_each_state[scene0",
    "app/run/test_swept_numbers.py::test_a_tilt_through_zero_is_that_of_each_punch[fem]",
    "app/run/test_sweeps.py::test_a_sweep_is_what_its_speeds_are_by_themselves[solid0",
    "app/run/test_yield.py::test_no_deeper_place_yields_and_the_deepest_does[beside",
    *(f"app/test_symmetries.py::test_the_mirror_image[{name}" for name in (
        "graded, own pressure with jumps", "orthotropic layer, cubic, sie", "orthotropic, wedge, fem",
        "upright fibres layer, parabolic, fem",
    )),
    "solvers/contact/test_inside_any_solid.py::test_stresses_inside_are_sums_of_line_loads[15]",
    "solvers/contact/test_residual.py::test_over_layers_a_pressure_of_the_equation_leaves_nothing_and_a_wrong_one_its_error[graded]",
    "solvers/fem/test_loaded_in_time.py::test_strip_that_is_loaded_by_and_by[0.5]",
    "solvers/friction/test_fit.py::test_laws_of_many_numbers_leave_little_more_than_noise[elasto_plastic",
    "solvers/friction/test_fit.py::test_the_search_passes_by_minima_that_leave_more[gms",
    "solvers/friction/test_slider.py::test_a_swing_that_grows_is_neither_steady_nor_a_cycle[12.0]",
    "solvers/friction/test_slider.py::test_sliders_without_a_cycle_are_followed_to_their_end[law1",
    "solvers/friction/test_slider.py::test_sliders_without_a_cycle_are_followed_to_their_end[law2",
    "solvers/layers/test_contact.py::test_a_length_to_measure_by",
    "solvers/layers/test_stack.py::test_waves_much_shorter_than_a_graded_top_feel_the_power_of_the_depth[1.5]",
    "solvers/transient/test_started.py::test_both_methods_agree[rotated]",
)  # fmt: skip
#: The longest files come first, so that no worker has one left when the others are done.
FIRST = (
    "docs/test_pages.py", "app/test_matrix.py", "solvers/transient/test_started.py",
    "app/run/test_agreement.py", "app/run/test_random_stacks.py", "app/run/test_over_time.py",
    "app/run/test_interruptions.py",
    "app/run/test_motions_mirrored.py", "app/figures/test_figures.py", "app/results/test_report.py",
)  # fmt: skip


def pytest_configure(config):
    """Make the folder of results that all workers read; figures open no windows."""
    os.environ["MPLBACKEND"] = "Agg"
    if not hasattr(config, "workerinput"):
        config.kept = tempfile.TemporaryDirectory(prefix="galinx-tests-")
        os.environ["GALINX_KEPT"] = config.kept.name


def pytest_unconfigure(config):
    if hasattr(config, "kept"):
        config.kept.cleanup()


def pytest_collection_modifyitems(items):
    items.sort(key=lambda item: (*FIRST, place_of(item)).index(place_of(item)))
    for item in items:
        place = place_of(item)
        if not THOROUGH and f"{place}::{item.name}".startswith(RELEASE):
            item.add_marker(pytest.mark.skip("of a release: with GALINX_THOROUGH=1"))
        if place.startswith(FAST) and not SLOW & set(item.fixturenames):
            item.add_marker("fast")
        elif f"{place}::{item.name}".startswith(FEM):
            item.add_marker("fem")


def place_of(item):
    """The file of a test, below this folder."""
    return item.path.relative_to(Path(__file__).parent).as_posix()


@pytest.hookimpl(optionalhook=True)
def pytest_configure_node(node):
    """Give a worker's main thread time to be free for the tests: another one takes no signals.

    It has just said which Python it is, and takes the tests only where it has put that aside. A worker
    whose main thread is busy runs all its tests in a thread of its own.
    """
    time.sleep(1.0)


def pytest_sessionfinish(session, exitstatus):
    """On several ranks, where only tests/mpi is looked at, a selection may leave nothing to run."""
    mpi = getattr(sys.modules.get("mpi4py"), "MPI", None)
    if exitstatus == pytest.ExitCode.NO_TESTS_COLLECTED and mpi and mpi.COMM_WORLD.size > 1:
        session.exitstatus = pytest.ExitCode.OK


@pytest.fixture(autouse=True)
def _fast_tests_keep_their_word(request, monkeypatch):
    """Neither a process nor a finite element space can be made in a fast test."""
    if not request.node.get_closest_marker("fast"):
        return

    def refuse(*_, **__):
        raise AssertionError("this test is not fast: name its place or fixture in conftest.py")

    monkeypatch.setattr(subprocess, "Popen", refuse)
    if space := sys.modules.get("galinx.solvers.fem.space"):
        monkeypatch.setattr(space.Space, "__init__", refuse)
    else:
        monkeypatch.setitem(sys.modules, "dolfinx", None)


@pytest.fixture
def stranger():
    """The beginning of a command that is to be that of a user whom nobody knows."""
    words = ["setpriv", "--reuid", "4321", "--regid", "4321", "--clear-groups"]
    if os.getuid() != 0:
        pytest.skip("needs root, to be another user")
    if subprocess.run([*words, sys.executable, "-c", ""], capture_output=True).returncode:
        pytest.skip(f"needs a Python that everybody may start, {sys.executable} is root's")
    return words


@pytest.fixture(scope="session")
def published():
    """The study's printed tables."""
    return json.loads((HOME / "app" / "study" / "published_tables.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="session")
def references():
    """Closed-form values computed with 40 digits."""
    path = HOME / "tests" / "reference" / "closed_form_values.json"
    return json.loads(path.read_text(encoding="utf-8"))


@pytest.fixture(scope="session")
def tables_run():
    """The result of scenes/tables4_5.toml."""
    return kept("tables")


@pytest.fixture(scope="session")
def inside_run():
    """The result of scenes/inside.toml to a tolerance that is met at once."""
    return kept("inside")


@pytest.fixture(scope="session")
def exact_run():
    """The result of scenes/tables4_5.toml by the closed form alone; takes a moment."""
    return kept("flat")


@pytest.fixture(scope="session")
def map_run():
    """The same by both methods with a map of stresses inside, so that it has every figure."""
    return kept("map")


@pytest.fixture(scope="session")
def archives():
    """The archives that the command makes of scenes/tables4_5.toml on one and on two ranks."""

    def make(path):
        ranks = ("-n", "2") if path.stem == "two" else ()
        done = command(*ranks, "run", SCENE, "-o", path)
        assert done.returncode == 0, done.stderr
        assert "verdict: PASS" in done.stdout

    return [once(f"{count}.h5", make) for count in ("one", "two")]


@pytest.fixture(scope="session")
def archive(archives):
    """The path of the archive that one rank made; to be read only."""
    return archives[0]
