"""A pressure of the user's own over layers: transforms of its tractions, finite elements, archives."""

import json

import numpy as np
import pytest
from support import THOROUGH
from test_layers import COAT, GRADED, SCENE
from test_layers_found import SAME, at_speed

import galinx
from galinx.app.errors import BadInput
from galinx.app.plan.plan import make_plan
from galinx.app.results.check import faults
from galinx.app.scene.read import parse

HUMP = [[-1, -1], [0, -1], [0.3, -4], [1, 0]]
POINTS = "points = [[0.2, -0.5], [-1.0, -0.3], [0.7, -3.0]]\n"
INSIDE = [f"interior/{{}}/sigma_{ij}" for ij in ("XX", "YY", "XY")]


def scene(layers=COAT, mu=0.4, tolerance=1e-6, methods=("sie",), quantities=("sif", "surface"),
          pressure=HUMP, more=""):  # fmt: skip
    text = SCENE.format(
        layers=layers, mu=mu, tolerance=tolerance, methods=json.dumps(list(methods)),
        quantities=json.dumps(list(quantities)),
    )  # fmt: skip
    given = f'mode = "traction"\npressure = {json.dumps(pressure)}\n[output]'
    return parse(text.replace("[output]", given) + more)


@pytest.mark.parametrize("share", [0.0, 0.9] if THOROUGH else [0.9])
def test_layers_of_one_solid_are_the_half_plane(share):
    from layers_cases import SUBSTRATE

    asked = ("sif", "surface", "interior")
    layered, plain = (
        galinx.compute(
            at_speed(scene(layers, 0.6, 1e-9, (by,), asked, more=POINTS), share * SUBSTRATE.limit())
        ).data
        for layers, by in ((SAME + SAME, "sie"), ("", "closed_form"))
    )
    for name in ("surface/{}/sigma_XX", "surface/{}/sigma_YY", "states/{}/normal_force", *INSIDE):
        one, other = (data[name.format(by)] for data, by in ((layered, "sie"), (plain, "closed_form")))
        known = np.isfinite(other)
        assert np.array_equal(known, np.isfinite(one)) and known.any()
        assert np.abs(one - other)[known].max() <= 1e-10 * np.abs(other[known]).max()


def test_all_is_linear_in_the_pressure_and_in_friction():
    """Two halves of a pressure add up, and a friction between two is between them."""
    asked = ("sif", "surface", "interfaces")
    parts = [[[-1, -1], [0, -1], [0.3, 0], [1, 0]], [[-1, 0], [0, 0], [0.3, -4], [1, 0]]]
    whole, *some = (galinx.compute(scene(quantities=asked, pressure=one)).data for one in (HUMP, *parts))
    low, high = (galinx.compute(scene(mu=mu, quantities=asked)).data for mu in (0.1, 0.7))
    for path in ("surface/sie/sigma_XX", "interfaces/sie/sigma_XY", "interfaces/sie/sigma_XX_below"):
        size = np.abs(whole[path]).max()
        assert np.abs(whole[path] - sum(one[path] for one in some)).max() <= 1e-9 * size
        assert np.abs(whole[path] - (low[path] + high[path]) / 2.0).max() <= 1e-9 * size


@pytest.mark.parametrize("layers", [COAT, *(GRADED,) * THOROUGH])
@pytest.mark.parametrize("tolerance", [1e-3, *(1e-6,) * THOROUGH])
def test_finite_elements_find_the_same(layers, tolerance, tmp_path):
    asked = ("sif", "surface", "interior", "interfaces")
    result = galinx.compute(scene(layers, 0.4, tolerance, ("sie", "fem"), asked, more=POINTS))
    data = result.data
    assert result.verdict == "PASS", result.attributes["verdict_reasons"]
    for text, word in (("σ_XX against", "sigma_XX"), ("stresses inside against", "inside"),
                       ("stresses at interfaces against", "interfaces")):  # fmt: skip
        off = next(value for name, value in result.comparisons.items() if name.startswith(text))
        allowed = sum(data[f"states/{by}/estimate_{word}"].max() for by in ("fem", "sie"))
        assert 0.0 < off <= min(tolerance, allowed), word
    X, σ = np.array(HUMP).T
    resultant = 55.3e3 * (np.diff(X) * (σ[1:] + σ[:-1])).sum() / 4.0
    assert data["states/fem/normal_force"] == pytest.approx(resultant, rel=1e-12)
    assert "states/fem/K_I_left" not in data and "states/sie/K_I_left" not in data
    result.save(tmp_path / "a.h5")
    assert not faults(tmp_path / "a.h5")


def test_what_cannot_be_put_in_is_said():
    many = np.column_stack([np.linspace(-1.0, 1.0, 40), -np.ones(40)]).tolist()
    with pytest.raises(BadInput, match=r"expected at most 12, 0\.02 apart"):
        make_plan(scene(methods=("sie", "fem"), pressure=many))
    assert make_plan(scene(pressure=many)).methods == ("sie",)
