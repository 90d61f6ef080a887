"""Numbers, symbols and units as formulas write them."""

import pytest

from galinx.texts import folded, in_tex, number, plain


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        (4.786e-7, "4.786 × 10⁻⁷"), (1e-6, "10⁻⁶"), (-2.5e7, "-2.5 × 10⁷"), (0.6, "0.6"), (0.0, "0"),
        (25000.0, "25\u202f000"), (1880.4162, "1880"), (0.0015, "0.0015"), (999999.9, "10⁶"),
        (0.00099999, "0.001"), (5e-324, "4.941 × 10⁻³²⁴"), (100000.0, "100\u202f000"), (-0.25, "-0.25"),
    ],
)  # fmt: skip
def test_numbers_are_typeset(value, shown):
    assert plain(f"${number(value)}$") == shown


def test_formulas_become_plain_text():
    assert plain(r"at $\mu_C = 0.7$, $\sigma_0 l/N$") == "at μ_C = 0.7, σ₀ l/N"
    assert plain(r"$\delta_D$ and $\mathrm{own\_key}$, $\lambda$") == "δ_D and own_key, λ"
    assert plain(r"$\vartheta_0$") == "ϑ₀" and in_tex("MPa·m^(-β)") == r"MPa·m$^{-\beta}$"


def test_lines_are_folded_between_words_and_formulas_stay_whole():
    text = r"in-plane stress $\sigma_{XX} / (N / 2a)$ on the surface"
    lines = folded(text, 18).split("\n")
    assert " ".join(lines) == text and r"$\sigma_{XX} / (N / 2a)$" in text
    assert any(r"$\sigma_{XX} / (N / 2a)$" in line for line in lines)
    assert all(len(plain(line)) <= 18 for line in lines)
