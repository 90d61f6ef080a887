"""What an estimate is made of, and when a ladder of degrees ends: errors of levels are prescribed."""

from types import SimpleNamespace

import numpy as np
import pytest

from galinx.meshes import MESHES, Requirements
from galinx.meshes.kind import DEGREES
from galinx.solvers.contact.estimate import of_degrees
from galinx.solvers.fem.contact import PunchLevel
from galinx.solvers.fem.ladder import Gauge, MeasuredError, climb, to_tolerance

G = np.array([-0.5])
FIRST = 6


def level(value, left=0.0, rounding=0.0, mirrored=True):
    """One number that is relative to 1, and what a level knows of itself."""
    return SimpleNamespace(
        space=SimpleNamespace(cells=1, size=1, degree=FIRST),
        factor=SimpleNamespace(solves=1, iterations=0, largest_residual=rounding, condition=0.0),
        mirrored=mirrored,
        task=TASK,
        gauges=lambda g, load=None: [
            Gauge("sif", np.full((len(g), 1), value), np.ones((len(g), 1)), left)
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
            rate=of_degrees(2),
        )  # fmt: skip
        self.errors, self.finer, self.solved = errors, finer, []

    def space(self, degree, cuts=1):
        self.solved.append(degree)
        return self, degree


def solved(space, g):
    work, degree = space
    return level(work.errors(degree))


TASK = SimpleNamespace(
    number=0,
    body=SimpleNamespace(alike=True, modes=(), ratio=lambda g, X: g[:, None]),
    probes=lambda g: (g, None),
    response=SimpleNamespace(c=0.3, margin=1.0, n=0.75, m=0.75, n12=0.0, contraction=1j),
)


def estimated():
    """The estimate of three levels that agree, and leave nothing themselves."""
    last = level(0.0)
    measured = [(FIRST - 2 + i, last.gauges(G)) for i in range(3)]
    return MeasuredError(Work(1e-3, None), last, G, measured, 1.0).of(G)["sif"][0]


@pytest.mark.parametrize("lean", [0.0, 0.4])
def test_an_estimate_holds_what_the_far_boundary_leaves_of_the_edges(lean, monkeypatch):
    """Measured at far boundaries of 1e2 to 1e4 a: compliance times leaning, and 1.8 of what is left.

    In a solid without mirror symmetry the pressure leans without friction, by n₁₂/n.
    """
    monkeypatch.setattr(TASK.response, "n12", lean * TASK.response.n)
    kind, wanted = MESHES["confocal"], Requirements(1e-3)
    innermost, far = kind.unseen(wanted, FIRST, 1, 1.0), kind.truncation(wanted, 1.0)
    leaning = (2.0 + 0.55 * np.log(3.0)) * (0.5 + 0.5 * lean + 0.1) / abs(1.0 - 0.5 * lean)
    assert estimated() == pytest.approx(innermost + far * (leaning + 1.8 * far), rel=1e-12)


def degree_of(work):
    """Degree of the last level."""
    return work.solved[-1]


def unmirrored(value, rounding):
    """Intensities at both ends differ there by what the degree leaves, as much as by rounding."""
    made = level(value, rounding=rounding, mirrored=False)
    made.factor.largest_residual = 1e-14
    return made


ANY = (0.0, np.inf)
#: The tolerance, a level by its degree; whether the tolerance is missed, and, if so, by what cells leave;
#: least and highest of the last degree and of the estimate.
LADDERS = {
    "met and no further": (1e-6, lambda p: level(10.0 ** (2.0 - 1.2 * p)), False, None,
                           (8, 8), (10.0**-7.6, 10.0**-6.6)),
    # Slowly, and by steps of different size, of which two together tell how fast.
    "slow, and met": (1e-5, lambda p: level(10.0 ** (-0.6 * p + 0.2 * (p % 2))), False, None,
                      (9, DEGREES[1]), (10.0 ** (-0.6 * DEGREES[1]), 1e-5)),
    "less shown at every degree": (
        1e-6, lambda p: level(10.0 ** (2.0 - 1.2 * p), left=10.0 ** (2.0 - p)), False, None, (9, 9), ANY),
    **{f"no convergence, {ratio}": (
        1e-6, lambda p, ratio=ratio: level(1e-3 * (-ratio) ** p), True, True, (0, FIRST + 1), ANY)
       for ratio in (0.8, 0.95, 1.1)},
    "rounding": (1e-9, lambda p: level(1e-8 * (-1.0) ** p, rounding=1e-7), True, False, ANY, ANY),
    # As where few functions represent a pressure, however well they are resolved.
    "what every level shows": (1e-6, lambda p: level(10.0 ** (2.0 - 1.2 * p), left=1e-5), True, False,
                               (0, FIRST + 1), (1e-5, 3e-5)),
    # Without mirror images a bound on rounding is known: what it explains is rounding, unless it falls.
    "within the bound": (1e-9, lambda p: level(1e-7 * (-1.0) ** p, rounding=1e-7, mirrored=False),
                         True, False, (FIRST + 1, FIRST + 1), ANY),
    "within the bound, and falls": (
        1e-9, lambda p: level(1e-7 * (-0.4) ** p, rounding=1e-7, mirrored=False), False, None, ANY, ANY),
    "falls with the degree": (1e-3, lambda p: unmirrored(*[10.0 ** (2.0 - 0.5 * p)] * 2), False, None,
                              (FIRST + 3, DEGREES[1]), ANY),
}  # fmt: skip


@pytest.mark.parametrize(
    "tolerance, of_degree, missed, of_cells, degrees, worst", LADDERS.values(), ids=LADDERS
)
def test_degrees_rise_until_the_tolerance_is_met_or_cannot_be(
    tolerance, of_degree, missed, of_cells, degrees, worst
):
    """What cells leave falls on finer ones, which are tried then alone."""
    finer = Work(1e-2 * tolerance, lambda p: 0.0)
    work = Work(tolerance, None, finer)
    error = climb(work, TASK, G, lambda space, g: of_degree(space[1])).error
    assert work.solved == list(range(FIRST - 2, degree_of(work) + 1))
    assert degrees[0] <= degree_of(work) <= degrees[1]
    assert error.excessive == missed and worst[0] <= error.worst <= worst[1]
    assert of_cells in (None, error.of_cells)
    told = to_tolerance(work, TASK, G, lambda space, g: of_degree(space[1])).error.missed
    assert bool(finer.solved) == bool(of_cells) and bool(told) == missed


def test_where_finer_cells_do_not_do_either_that_is_said():
    def slow(p):
        return 1e-3 * 0.8**p

    finer = Work(1e-8, slow)
    found = to_tolerance(Work(1e-6, slow, finer), TASK, G, solved)
    assert found.error.excessive
    assert degree_of(finer) < DEGREES[1]
    (said,) = found.error.missed
    assert said.startswith("finite elements at c = 0.3 do not reach the tolerance 1e-06: the estimated")


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
    (text,) = found.error.missed
    assert text.endswith(f"of which {floor:.1e} would remain on any cells")


@pytest.mark.parametrize("lengths", [(1.0, 1e-3, 0.0), (1.0, 0.0, 1e-3), (1.001, 0.0, 0.0)])
def test_a_free_contact_is_off_by_what_its_lengths_and_its_pressures_centre_are_off(lengths):
    """The load is -2 in the unit of stresses times lengths; its centre is its first moment over it."""

    def gauge(half_width, centre, of_pressure):
        contact = SimpleNamespace(
            half_width=np.array([half_width]), centre=np.array([centre]),
            tested=lambda moments: -2.0 * np.array([[of_pressure, 0.0, 0.0, 0.0, 0.0]]),
        )  # fmt: skip
        states, one = SimpleNamespace(contact=contact), np.ones((1, 1))
        return PunchLevel.gauge_of_free(SimpleNamespace(moments=np.eye(6)), states, one, one, 0.0)

    assert gauge(*lengths).change(gauge(1.0, 0.0, 0.0)) == pytest.approx(1e-3, rel=1e-3)
