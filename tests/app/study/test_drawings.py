"""Which states the study's figures show, read off what is drawn.

Parameters are those of the study's captions and text; friction and stresses are computed here, by
formulas of their own.
"""

import numpy as np
import pytest
from legible import legible
from study_reference import f_of, stresses
from support import HOME, paper_run

import galinx
from galinx.app.figures.style import COLUMN, PAGE
from galinx.app.study.drawings import of_study

SS, HS = 4.786e-7, 0.6
MU, SIGMA, DELTA = (0.1, 0.3, 0.5, 0.7), (12500.0, 25000.0, 50000.0), (0.8, 1.0, 1.2, 1.5)
REFERENCE = {"mu": 0.7, "sigma": 25000.0, "delta": 1.0}
MIDDLE = REFERENCE | {"mu": 0.5}
#: Distance over a from an edge beyond which positions keep enough digits for these formulas.
AWAY = 1e-3

#: Of every figure of stresses: the rows, each with its title and its curves.
ROWS = {
    "fig5": [
        (motion, [REFERENCE | {"motion": motion, "X": X} for X in (0.2, 0.8)])
        for motion in ("FM1", "BM1", "FM2")
    ],
    "fig7": [
        (f"$X/L = {X:g}$", [REFERENCE | {"motion": motion, "X": X} for motion in ("FM1", "BM1", "FM2")])
        for X in (0.2, 0.5, 1.0)
    ],
    "fig8": [
        (f"$X/L = {X:g}$", [REFERENCE | {"motion": "FM1", "X": X, "mu": mu} for mu in MU])
        for X in (0.2, 0.8)
    ],
    "fig9": [
        (motion, [MIDDLE | {"motion": motion, "X": 0.2, "sigma": sigma} for sigma in SIGMA])
        for motion in ("FM1", "FM2")
    ],
    "fig10": [
        ("$X/L = 0.4$", [MIDDLE | {"motion": "FM1", "X": 0.4, "delta": delta} for delta in DELTA])
    ],
}  # fmt: skip


@pytest.fixture(scope="module")
def study_run():
    """The study by both methods."""
    return galinx.load(paper_run()[0] / "study.h5")


@pytest.fixture(scope="module")
def drawings(study_run):
    return {drawing.name: drawing for drawing in of_study(study_run.data, study_run.scene)}


def drawn(axis):
    """Lines and markers of a panel, as arrays of x and y; not the line at zero."""
    of = [line for line in axis.lines if len(line.get_xdata()) > 2]
    marked = [line.get_linestyle() in ("None", "") for line in of]
    data = [np.array(line.get_xydata(), dtype=float) for line in of]
    return [one for one, is_ in zip(data, marked) if not is_], [
        one for one, is_ in zip(data, marked) if is_
    ]


def shows(curve, column, c, tolerance, motion, X, **law):
    """Does a curve show the stress of a state?"""
    x, y = curve.T
    expected = stresses(x, f_of(**law, motion=motion, X=X), c)[column]
    away = np.isfinite(y) & (np.abs(np.abs(x) - 1.0) > AWAY)
    assert away.sum() > 5
    np.testing.assert_allclose(y[away], expected[away], rtol=tolerance, atol=tolerance)


@pytest.mark.parametrize("name", ROWS)
def test_stresses_are_those_of_the_studys_panels(name, drawings):
    """Every panel has the study's curves and no other, under a title that is theirs."""
    axes = drawings[name].figure.axes
    both = len(ROWS[name]) * 2
    assert len(axes) == both + 2 * (name != "fig5")  # the last row shows how far both methods are apart
    for n, axis in enumerate(axes[:both]):
        title, states = ROWS[name][n // 2]
        assert axis.get_title(loc="left") == f"({chr(97 + n)})  {title}"
        lines, markers = drawn(axis)
        assert len(lines) == len(states) + (name == "fig7") and len(markers) == len(states)
        for line, marks, state in zip(lines, markers, states):
            shows(line, n % 2, SS, 1e-7, **state)
            # Slow finite elements, or the closed form at high speed.
            shows(marks, n % 2, *((SS, 3e-3) if name == "fig5" else (HS, 1e-7)), **state)
        if name == "fig7":  # the other reading of BM1: as far from its turn
            shows(lines[-1], n % 2, SS, 1e-7, **(states[1] | {"X": 1.0 - states[1]["X"]}))


def test_no_two_states_of_a_panel_would_pass_for_each_other():
    """What the test above compares tells states apart, but where friction is the same at the turn."""
    x = np.linspace(-1.9, 1.9, 38)
    for name, rows in ROWS.items():
        for _, states in rows:
            f = sorted(f_of(**state) for state in states)
            apart = np.diff(f).min()
            assert apart > 1e-3 or (name == "fig7" and states[0]["X"] == 1.0 and apart == 0.0)
            one, other = (stresses(x, value, SS)[1] for value in (f[0], f[0] + 1e-3))
            assert not np.allclose(one, other, rtol=1e-5, atol=1e-5)


def loops_of(axis, strokes=3):
    """Loops of a panel: its strokes one after the other, (loops, strokes) of x and y."""
    lines, _ = drawn(axis)
    assert len(lines) % strokes == 0
    return [lines[n : n + strokes] for n in range(0, len(lines), strokes)]


def is_loop(strokes, **law):
    for name, line in zip(("FM1", "BM1", "FM2"), strokes, strict=True):
        expected = [f_of(**law, motion=name, X=X) for X in line[:, 0]]
        np.testing.assert_allclose(line[:, 1], expected, atol=1e-12)


def test_loops_are_those_of_the_studys_panels(drawings):
    (axis,) = drawings["fig2"].figure.axes
    (loop,) = loops_of(axis)
    is_loop(loop, **REFERENCE)
    panels = drawings["fig6"].figure.axes
    laws = [
        [REFERENCE] * 4,  # speeds
        [MIDDLE | {"mu": mu} for mu in MU],
        [MIDDLE | {"sigma": sigma} for sigma in SIGMA],
        [MIDDLE | {"delta": delta} for delta in DELTA],
    ]
    for axis, several in zip(panels, laws, strict=True):
        for loop, law in zip(loops_of(axis), several, strict=True):
            is_loop(loop, **law)
    names = [[text.get_text() for text in axis.get_legend().texts] for axis in panels]
    assert names[0] == [r"$c = 4.786 \times 10^{-7}$", "$c = 0.2$", "$c = 0.4$", "$c = 0.6$"]
    assert names[1] == [rf"$\mu_C = {mu:g}$" for mu in MU] and len(names[2]) == 3 and len(names[3]) == 4
    widths = [line.get_linewidth() for line in panels[0].lines if len(line.get_xdata()) > 2][::3]
    assert widths == sorted(widths, reverse=True) and len(set(widths)) == 4  # none hides another


@pytest.mark.parametrize(
    "name, shared",
    [
        ("fig2", "turn (BM1, FM2). μ_C = 0.7, σ₀ l/N = 25 000 m⁻¹, δ_D = 1."),
        ("fig5", "All with μ_C = 0.7, σ₀ l/N = 25 000 m⁻¹, δ_D = 1."),
        ("fig7", "All with μ_C = 0.7, σ₀ l/N = 25 000 m⁻¹, δ_D = 1."),
        ("fig8", "All with σ₀ l/N = 25 000 m⁻¹, δ_D = 1."),
        ("fig9", "All with μ_C = 0.5, δ_D = 1, X/L = 0.2."),
        ("fig10", "All with μ_C = 0.5, σ₀ l/N = 25 000 m⁻¹."),
    ],
)
def test_captions_name_the_parameters_that_all_curves_share(drawings, name, shared):
    assert shared in drawings[name].caption.replace("\u202f", " ")


def test_the_block_has_the_studys_proportions(drawings):
    panel = drawings["fig4"].figure.axes[0]
    edges = panel.lines[0].get_xydata()
    (left, low), (right, high) = np.nanmin(edges, axis=0), np.nanmax(edges, axis=0)
    assert 2.0 / (right - left) == pytest.approx(0.01) and 2.0 / (high - low) == pytest.approx(0.02)
    assert "2a/W = 0.01 and 2a/H = 0.02" in drawings["fig4"].caption


def test_laws_stand_side_by_side_on_contact_stresses(drawings):
    loops, *panels = drawings["laws"].figure.axes
    f = [line.get_ydata()[0] for line in loops.lines if len(line.get_xdata()) == 1]
    assert len(f) == 5 and f[0] == 0.5  # Coulomb's
    assert f[1] == pytest.approx(f_of(**MIDDLE, motion="FM2", X=0.3), abs=1e-12)
    for column, axis in enumerate(panels):
        lines, markers = drawn(axis)
        assert len(lines) == len(markers) == 5
        for line, one in zip(lines, f):
            x, y = line.T
            away = np.isfinite(y) & (np.abs(np.abs(x) - 1.0) > AWAY)
            np.testing.assert_allclose(y[away], stresses(x, one, SS)[column][away], rtol=1e-7, atol=1e-7)
        for mark, one in zip(markers[:4], f):  # these know no speed
            x, y = mark.T
            np.testing.assert_allclose(y, stresses(x, one, HS)[column], rtol=1e-7, atol=1e-7)


def test_what_leans_is_as_the_page_of_signs_says():
    """The numbers of docs/signs.md, and the place where the pressure is least."""
    ends = np.array([-0.9, 0.9]), np.array([-1.1, 1.1])
    table = {
        ("sigma", 12500.0, 0.2): (0.1967, -1.5496, -1.3706, 0.5824, -0.5130),
        ("sigma", 50000.0, 0.2): (0.4323, -1.6531, -1.2641, 1.3799, -1.0456),
        ("delta", 0.8, 0.4): (0.4611, -1.6654, -1.2513, 1.4853, -1.1052),
        ("delta", 1.5, 0.4): (0.3750, -1.6284, -1.2898, 1.1754, -0.9236),
    }
    page = (HOME / "docs" / "signs.md").read_text(encoding="utf-8")
    for (key, value, X), expected in table.items():
        f = f_of(**(MIDDLE | {key: value}), motion="FM1", X=X)
        numbers = (f, *stresses(ends[0], f, SS)[0], *stresses(ends[1], f, SS)[1])
        np.testing.assert_allclose(numbers, expected, atol=6e-5)
        assert "| {:.4f} | {:.4f} | {:.4f} | {:+.4f} | {:.4f} |".format(*expected) in page
    x = np.linspace(-0.9, 0.9, 1801)
    assert x[stresses(x, 0.660, HS)[0].argmax()] == pytest.approx(0.17, abs=2e-3)
    differences = [
        [
            np.abs(
                np.subtract(*(stresses(x, f_of(**REFERENCE, motion=m, X=at), SS)[0] for m, at in pair))
            ).max()
            for pair in ((("FM1", X), ("BM1", X)), (("FM1", X), ("BM1", 1.0 - X)))
        ]
        for X in (0.2, 0.5, 1.0)
    ]
    np.testing.assert_allclose(differences, [[0.44, 0.17], [0.47, 0.47], [0.0, 0.59]], atol=5e-3)


def test_the_studys_figures_are_legible(drawings):
    assert [*drawings] == [*(f"fig{n}" for n in range(1, 11)), "sinusoidal", "laws"]
    shown = [*drawings.values()]
    legible(shown)
    widths = {round(drawing.figure.get_figwidth(), 2) for drawing in shown}
    assert widths == {round(width, 2) for width in (COLUMN, 5.0, PAGE)}
    assert max(drawing.figure.get_figheight() for drawing in shown) * 25.4 <= 230.0  # of a page, in mm
