"""What an estimate is made of, and when a ladder of degrees ends: errors of levels are prescribed."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from galinx.meshes import MESHES, Requirements
from galinx.meshes.kind import DEGREES
from galinx.solvers.contact.fem_plan import PressureMoments
from galinx.solvers.contact.pressure import Expansion
from galinx.solvers.contact.recovery import MOMENTS, Polynomials
from galinx.solvers.fem import ladder as error
from galinx.solvers.fem.ladder import Gauge, MeasuredError, climb, to_tolerance

G = np.array([-0.5])
FIRST = 6


def level(value, left=0.0, rounding=0.0, mirrored=True, word="sif"):
    """One number that is relative to 1, and what a level knows of itself."""
    return SimpleNamespace(
        space=SimpleNamespace(cells=1, size=1, degree=FIRST),
        factor=SimpleNamespace(solves=1, iterations=0, largest_residual=rounding, condition=0.0),
        mirrored=mirrored,
        task=TASK,
        gauges=lambda g, load=None: [
            Gauge(word, np.full((len(g), 1), value), np.ones((len(g), 1)), left)
        ],
        rounding=lambda g, load: [rounding],
        close=lambda: None,
    )


class Work:
    """Spaces that are numbers: the degree; ``errors`` are those of a level by its degree."""

    def __init__(self, tolerance, errors, finer=None):
        kind, wanted = MESHES["confocal"], Requirements(tolerance)
        self.plan = SimpleNamespace(
            kind=kind, wanted=wanted, tolerance=tolerance, degrees=(FIRST,), fixed=False, cuts=1,
            tests=PressureMoments(),
        )  # fmt: skip
        self.errors, self.finer, self.said, self.solved = errors, finer, [], []

    def space(self, degree, cuts=1):
        self.solved.append(degree)
        return self, degree

    def warn(self, text):
        self.said.append(text)


def solved(space, g):
    work, degree = space
    return level(work.errors(degree))


TASK = SimpleNamespace(
    number=0,
    body=SimpleNamespace(alike=True, modes=(), ratio=lambda g, X: g[:, None]),
    probes=lambda g: (g, None),
    response=SimpleNamespace(c=0.3, margin=1.0, n=0.75, m=0.75, n12=0.0, contraction=1j),
)


def estimated(left=0.0, rounding=0.0, tolerance=1e-3, word="sif"):
    """The estimate of three levels, the last as given."""
    levels = level(0.0, word=word), level(0.0, word=word), level(0.0, left, rounding, word=word)
    return measured_error(*levels, tolerance).of(G)[word][0]


def measured_error(first, second, last, tolerance=1e-3):
    """Error of the last of three levels."""
    measured = [(FIRST - 2 + i, one.gauges(G)) for i, one in enumerate((first, second, last))]
    return MeasuredError(Work(tolerance, None), last, G, measured, 1.0)


def test_an_estimate_holds_rounding_and_what_a_level_knows_of_itself():
    assert estimated(rounding=1e-5) - estimated() == pytest.approx(3e-5, rel=1e-9)
    assert estimated(left=1e-5) - estimated() == pytest.approx(1e-5, rel=1e-9)


def test_an_estimate_holds_what_the_far_boundary_leaves_of_the_edges():
    """Measured at far boundaries of 1e2 to 1e4 a: compliance times leaning, and 1.8 of what is left."""
    kind, wanted = MESHES["confocal"], Requirements(1e-3)
    innermost, far = kind.unseen(wanted, FIRST, 1, 1.0), kind.truncation(wanted, 1.0)
    leaning = (2.0 + 0.55 * np.log(3.0)) * (0.5 + 0.1)
    assert estimated() == pytest.approx(innermost + far * (leaning + 1.8 * far), rel=1e-12)


@pytest.mark.parametrize("word", ["surface", "interfaces"])
def test_an_estimate_of_stresses_holds_what_the_far_boundary_leaves_of_places_and_of_cells(word):
    """Sizes of 1 take 0.3 + 1.9 of the compliance; cells beside the edges count where places are near."""
    kind, wanted = MESHES["confocal"], Requirements(1e-3)
    cells, far = kind.unseen(wanted, FIRST, 1, 1.0), kind.truncation(wanted, 1.0)
    cells += kind.unseen_beside(wanted, FIRST, 1) if word == "surface" else 0.0
    of_places = (2.0 + 0.55 * np.log(3.0)) * (0.5 + 0.1 + 0.3 + 1.9)
    assert estimated(word=word) == pytest.approx(cells + far * (of_places + 1.8 * far), rel=1e-12)


def climbed(work):
    found = climb(work, TASK, G, solved)
    return degree_of(work), found.error


def degree_of(work):
    """Degree of the last level."""
    return work.solved[-1]


def test_degrees_rise_until_the_tolerance_is_met_and_no_further():
    work = Work(1e-6, lambda p: 10.0 ** (2.0 - 1.2 * p))
    degree, error = climbed(work)
    assert not error.excessive and degree < DEGREES[1]
    assert work.solved == list(range(FIRST - 2, degree + 1))
    assert degree == 8 and work.errors(8) < error.worst < 10.0 * work.errors(8)


@pytest.mark.parametrize("ratio", [0.8, 0.95, 1.1])
def test_a_ladder_that_does_not_converge_ends_before_the_highest_degree(ratio):
    work = Work(1e-6, lambda p: 1e-3 * ratio**p * (-1.0) ** p)
    degree, error = climbed(work)
    assert error.excessive and error.of_cells
    assert degree <= FIRST + 1


def test_a_ladder_that_gets_there_is_not_given_up():
    """Slowly, and by steps of different size, of which two together tell how fast."""
    work = Work(1e-5, lambda p: 10.0 ** (-0.6 * p + (0.2 if p % 2 else 0.0)))
    degree, error = climbed(work)
    assert not error.excessive and 9 <= degree <= DEGREES[1]
    assert work.errors(degree) <= error.worst


def test_where_degrees_do_not_do_cells_are_finer_and_where_these_do_not_that_is_said():
    slow, good = (lambda p: 1e-3 * 0.8**p), (lambda p: 10.0 ** (-1.0 - 1.2 * p))
    finer = Work(1e-8, good)
    work = Work(1e-6, slow, finer)
    found = to_tolerance(work, TASK, G, solved)
    assert not found.error.excessive and found.error.worst <= 1e-6
    assert work.solved and finer.solved and not work.said + finer.said
    finer = Work(1e-8, slow)
    assert to_tolerance(Work(1e-6, slow, finer), TASK, G, solved).error.excessive
    assert degree_of(finer) < DEGREES[1]
    (said,) = finer.said
    assert said.startswith("finite elements at c = 0.3 do not reach the tolerance 1e-06: the estimated")


def test_cells_are_no_finer_where_rounding_is_at_fault(monkeypatch):
    work = Work(1e-9, None)

    def rounded(space, g):
        return level(1e-8 * (-1.0) ** space[1], rounding=1e-7)

    found = to_tolerance(work, TASK, G, rounded)
    assert found.error.excessive and not found.error.of_cells
    assert work.said


def test_a_ladder_ends_where_only_what_every_level_shows_is_left():
    """As where few functions represent a pressure, however well they are resolved."""
    finer = Work(1e-8, lambda p: 0.0)
    work = Work(1e-6, None, finer)

    def unresolved(space, g):
        return level(10.0 ** (2.0 - 1.2 * space[1]), left=1e-5)

    found = to_tolerance(work, TASK, G, unresolved)
    assert found.error.excessive and not finer.solved
    assert 1e-5 <= found.error.worst <= 3e-5
    assert max(work.solved) <= FIRST + 1 and work.said


def test_what_falls_with_the_degree_in_a_solid_without_mirror_is_no_rounding():
    """Intensities at both ends differ there by what the degree leaves, as much as by rounding."""

    def solved(space, g):
        value = 10.0 ** (2.0 - 0.5 * space[1])
        made = level(value, rounding=value, mirrored=False)
        made.factor.largest_residual = 1e-14
        return made

    work = Work(1e-3, None)
    error = climb(work, TASK, G, solved).error
    assert degree_of(work) > FIRST + 2 and (not error.excessive or error.of_cells)


@pytest.mark.parametrize("mirrored", [True, False])
def test_cells_are_no_finer_where_rounding_alone_exceeds_the_tolerance(mirrored):
    """Also where errors are larger still, and would fall."""

    def slow(space, g):
        return level(1e-3 * 0.8 ** space[1] * (-1.0) ** space[1], rounding=1e-6, mirrored=mirrored)

    finer = Work(1e-9, None)
    work = Work(1e-7, None, finer)
    found = to_tolerance(work, TASK, G, slow)
    floor = found.error.floor
    assert found.error.excessive and not finer.solved and floor > 1e-7
    (text,) = work.said
    assert text.endswith(f"of which {floor:.1e} would remain on any cells")


def test_a_level_that_shows_less_at_every_degree_is_not_given_up():
    def resolved(space, g):
        return level(10.0 ** (2.0 - 1.2 * space[1]), left=10.0 ** (2.0 - space[1]))

    work = Work(1e-6, None)
    assert not climb(work, TASK, G, resolved).error.excessive and degree_of(work) == 9


@pytest.mark.parametrize("ratio, ends", [(1.0, True), (0.4, False)])
def test_changes_that_a_bound_on_rounding_explains_are_rounding_unless_they_fall(ratio, ends):
    """Without mirror images only a bound on rounding is known."""
    work = Work(1e-9, None, Work(1e-11, lambda p: 0.0))

    def noisy(space, g):
        return level(1e-7 * ratio ** space[1] * (-1.0) ** space[1], rounding=1e-7, mirrored=False)

    found = to_tolerance(work, TASK, G, noisy)
    assert not work.finer.solved and found.error.excessive == ends
    assert (work.solved == [FIRST - 2, FIRST - 1, FIRST, FIRST + 1]) == ends


def test_the_pressure_and_its_moments_are_gauged():
    smooth = np.array([[-0.3, 0.1, *[0.0] * (MOMENTS - 2)]])
    pressure = Expansion(np.array([[-0.4]]), np.array([[-0.6]]), smooth, Polynomials())
    one = error.of_pressure(pressure, np.array([[-2.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6]]))
    for i in range(1, 6):
        moments = np.array([[-2.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6]])
        moments[0, i] += 2e-3
        assert error.of_pressure(pressure, moments).change(one)[0] == pytest.approx(1e-3)
    steeper = replace(pressure, c=smooth + 1e-3 * (np.arange(MOMENTS) == 2))
    assert error.of_pressure(steeper, np.array([[-2.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6]])).change(one) > 2e-3


@pytest.mark.parametrize("component", range(3))
def test_every_stress_inside_is_gauged(component):
    points = np.array([[0.0, -1.0], [2.0, -0.5]])
    σ = np.array([[[-1.0, 0.2]], [[-0.5, 0.1]], [[0.3, 0.0]]])
    other = σ.copy()
    other[component, 0, 0] += 0.01
    change = error.of_inside(other, points).change(error.of_inside(σ, points))
    assert change[0] == pytest.approx(0.01, rel=0.02)


def test_stresses_are_no_better_than_the_last_digits_of_displacements():
    """All that is known of their rounding without mirror images: 100 over the root of the margin."""
    displacement = SimpleNamespace(
        surface=lambda g, weights, σ_YY: SimpleNamespace(σ_XX=np.array([[2.0, -4.0]])),
        rounding=lambda weights: np.array([[4e-13, 8e-13]]),
    )
    places = SimpleNamespace(X=np.array([-2.0, 2.0]), points=np.empty((0, 2)), around=np.empty((0, 2)))
    task = SimpleNamespace(places=places, response=SimpleNamespace(margin=0.04))
    gauges = error.StressGauges(SimpleNamespace(stresses={"surface"}), task, lambda _: displacement)
    (found,) = gauges.rounding((G, np.ones((1, 1)), np.zeros((1, 2))))
    assert found == pytest.approx(100.0 / 0.2 * 2e-13)


def test_rounding_inside_is_that_of_no_place_on_the_surface_nearer_to_an_edge():
    """Next to an edge cells are small, and derivatives lose digits that those farther away keep."""
    X = np.array([-2.0, -1.001, 1.001, 2.0])
    noise = np.array([1e-12, 1e-9, 1e-9, 2e-12])

    def surface(g, weights, σ_YY):
        return SimpleNamespace(σ_XX=4.0 + np.sign(g) * noise[None])

    displacement = SimpleNamespace(surface=surface, rounding=lambda weights: noise[None])
    places = SimpleNamespace(X=X, points=np.array([[1.0, -0.5], [0.0, -3.0]]), around=np.empty((0, 2)))
    task = SimpleNamespace(places=places, response=SimpleNamespace(margin=1.0))
    gauges = error.StressGauges(
        SimpleNamespace(stresses={"interior", "surface"}), task, lambda _: displacement
    )
    states = G, np.ones((1, 1)), np.zeros((1, 4))
    assert gauges.rounding(states) == pytest.approx([100.0 * 1e-9 / 4.0, 100.0 * 2e-12 / 4.0])
    of_mirrors = gauges.rounding(states, 2.0 * noise[None])
    assert of_mirrors == pytest.approx([2e-9 / 4.0, 4e-12 / 4.0], rel=1e-3)


def test_errors_of_stresses_count_on_slower_convergence_than_those_of_moments():
    error = measured_error(level(0.0), level(0.0), level(0.0))
    assert (error._rate("sif").usual, error._rate("surface").usual) == (0.16, 0.5)
