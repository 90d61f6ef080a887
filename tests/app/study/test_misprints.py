"""Evidence for docs/signs.md: where the study's equations and numbers contradict each other."""

import numpy as np
import pytest
from scipy.special import roots_jacobi

from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.friction import LAWS
from galinx.solvers.parameters import parameters
from galinx.solvers.solids.isotropic import Isotropic, MovingFrame

#: The study's solid at high speed, and the friction of its first forward motion at X/L = 0.8.
FAST, FRICTION = MovingFrame(2.0, 0.6), 0.7 * (1.0 - np.exp(-25000.0 * 0.8e-4 / 0.7))


def test_eqs_38_and_42_fit_together_and_eq_30_has_the_other_sign():
    """Residual of |πω₁| H[σ_YY] ± ω₂ f σ_YY = 0 over σ_YY; σ_YY has the exponents of Eq 42.

    H is integrated here: what is left of σ_YY(t) - σ_YY(r) over t - r has no pole.
    """
    punch, (ω1, ω2, *_) = FlatPunch(FAST, FRICTION), FAST.ω
    r = np.array([-0.7, -0.2, 0.0, 0.4, 0.8])
    cauchy = np.array([transform(punch, at) for at in r])
    both = np.pi * ω1 * cauchy, ω2 * FRICTION * punch.σ_YY(r)
    right, wrong = (np.abs(both[0] - sign * both[1]) / np.abs(punch.σ_YY(r)) for sign in (1.0, -1.0))
    assert right.max() < 1e-12
    np.testing.assert_allclose(wrong, 2.0 * FRICTION * ω2, rtol=1e-9)
    assert 2.0 * FRICTION * ω2 == pytest.approx(0.7836, abs=5e-5)


def transform(punch, at):
    """(1/π) ⨍ σ_YY(t)/(t - at) dt by Gauss's rule in pieces that shrink towards both edges."""
    x, w = np.polynomial.legendre.leggauss(30)
    shrinking = np.append(0.0, 2.0 ** np.arange(-150.0, 1.0))

    def over(edge, other):
        """From an edge to ``at``, by the distance d from it."""
        ends = abs(at - edge) * shrinking
        half = np.diff(ends)[:, None] / 2.0
        d = (ends[1:, None] + ends[:-1, None]) / 2.0 + half * x
        distances = (d, 2.0 - d) if edge < 0.0 else (2.0 - d, d)
        t = edge + np.sign(other) * d
        regular = (punch.traction(*distances) - punch.σ_YY(at)) / (t - at)
        return float(np.sum(half * w * regular))

    pole = punch.σ_YY(at) * np.log((1.0 - at) / (1.0 + at))
    return (over(-1.0, 1.0) + over(1.0, -1.0) + pole) / np.pi


def test_collocation_points_are_n_minus_1_zeros_with_opposite_exponents():
    """Eq 53 counts N of them and has the exponents the other way round.

    At zeros of P_{N-1}^(-α, -β) Gauss's rule with N points leaves of the Cauchy integral of the weight
    what cot(πα) times the weight does not have already, nothing.
    """
    punch, N = FlatPunch(FAST, FRICTION), 8
    with np.errstate(invalid="ignore"):  # SciPy evaluates a branch it then discards
        t, w = roots_jacobi(N, punch.α, punch.β)
    residuals = []
    for exponents in ((-punch.α, -punch.β), (-punch.β, -punch.α)):
        r, _ = roots_jacobi(N - 1, *exponents)
        residuals.append(np.abs((w / (t - r[:, None])).sum(axis=1) / np.pi).max())
    assert residuals[0] < 1e-12 and residuals[1] > 0.5


def test_the_stiffness_over_the_load_has_the_unit_of_one_over_a_length():
    """σ₀ = 1.5922 N/µm over N = 55.3 N; a law in other lengths gives the same friction."""
    assert parameters(LAWS["dahl"])["sigma0_over_load"].unit == "1/m"
    λ = 1.5922e6 / 55.3
    assert λ == pytest.approx(28792.0, abs=0.5)
    metres, millimetres = LAWS["dahl"](0.7, λ), LAWS["dahl"](0.7, λ / 1e3)
    f = [
        law.exact(np.zeros(1), 1, 0.0, np.array([d]))[0, 0]
        for law, d in ((metres, 2e-5), (millimetres, 2e-2))
    ]
    assert f[0] == pytest.approx(f[1], rel=1e-14) and 0.3 < f[0] < 0.7


def test_eqs_25_and_32_put_the_tension_at_the_leading_end():
    """τ = +f σ: σ_XX beside X = +a is tensile, which the study's Figs 5 and 7 have at X = -a."""
    beside = np.array([-1.05, 1.05])
    assert np.sign(FlatPunch(FAST, FRICTION).σ_XX(beside)).tolist() == [-1.0, 1.0]
    assert np.sign(FlatPunch(FAST, -FRICTION).σ_XX(beside)).tolist() == [1.0, -1.0]


def test_table_3_has_another_speed_than_the_text_and_table_2(published):
    table, solid = published["table3"]["HS"], published["table2"]
    c_s = Isotropic(solid["E_GPa"] * 1e9, solid["nu"], solid["rho_kg_m3"]).c_s
    V = table["c"] * c_s
    assert (round(V, 1), round(1e-4 / V, 11)) == (1880.4, 5.318e-8)
    assert (table["V_m_s"], table["time_s"]) == (1884.0, 5.308e-8)
    assert 1e-4 / table["V_m_s"] == pytest.approx(table["time_s"], abs=5e-12)  # it is no slip of the time
    assert table["V_m_s"] / c_s == pytest.approx(0.60115, abs=5e-6)


def test_tables_4_and_5_are_of_plane_strain(published):
    """Their first entry, FM1 at X/L = 0.2 and slow, in both planes."""
    f, printed = 0.7 * (1.0 - np.exp(-25000.0 * 0.2e-4 / 0.7)), published["table4"]["rows"][0][2]
    frames = [Isotropic(193e9, 0.25, 7860.0, plane).response(4.786e-7) for plane in ("strain", "stress")]
    assert [round(FlatPunch(frame, f).K_I, 4) for frame in frames] == [printed, 0.3155]
