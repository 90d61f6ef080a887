"""Texts that act instead of being seen are refused where they come in."""

import re
import unicodedata

import pytest

import galinx
from galinx.app.errors import BadInput
from galinx.app.scene.read import parse
from galinx.solvers.friction.law import FrictionLaw
from galinx.texts import in_tex, plain, unseen


@pytest.mark.parametrize("code", [0, 7, 10, 27, 127, 0x9B, 0x2028, 0x202E, 0x2066, 0x061C, 0xD800])
def test_control_characters_are_found(code):
    found = unseen(f"ab{chr(code)}c")
    assert found == f"character 3 is the control character U+{code:04X}, expected none"


def test_what_can_be_seen_is_allowed():
    assert not unseen("σ₀ l/N — “Müller” 摩擦 حك 👩‍🔬 ")
    shown = "".join(chr(i) for i in range(0x20, 0x3000) if unicodedata.category(chr(i))[0] in "LNPS")
    assert not unseen(shown)


@pytest.mark.parametrize(
    "text, fault",
    [
        ('title = "a\\u0000"\n', "title: character 2 is the control character U+0000"),
        ('"q\\u001b" = 1\n', "the key q\\x1b: character 2 is the control character U+001B"),
        ('[solve]\nmethods = ["fem", "\\u0007"]\n', "solve.methods[1]: character 1 is"),
        ('[output]\nmap = {X = [[{a = "\\u202E"}]]}\n', "output.map.X[0][0].a: character 1 is"),
        (f'{"a." * 5000}a = "\\u0000"\n', "a.a: character 1 is the control character U+0000"),
    ],
    ids=["title", "key", "list", "deep", "deepest"],
)
def test_a_scene_with_one_is_refused_at_the_start(text, fault):
    with pytest.raises(BadInput) as caught:
        parse(text)
    assert fault in str(caught.value)


@pytest.mark.parametrize(
    "registry, model, fault",
    [
        ("LAWS", 3, "found 3, expected a class with the members of FrictionLaw"),
        ("LAWS", type("Silent", (FrictionLaw,), {"about": ""}), "Silent lacks friction of FrictionLaw"),
        ("SOLIDS", str, "str lacks about, above, c_s, "),
        ("PROFILES", object(), "expected a class with the members of Profile"),
        ("PROFILES", dict, "dict lacks about, height, slope, words of Profile"),
        ("MESHES", str, "expected an instance of MeshKind"),
        ("QUANTITIES", None, "found None, expected an instance of Quantity"),
        ("METHODS", 1, "expected an instance of MethodKind"),
        ("RULES", "rule", "expected an instance of Rule"),
    ],
)
def test_what_is_no_model_is_refused_where_it_is_registered(registry, model, fault):
    models = getattr(galinx, registry)
    with pytest.raises(TypeError, match=re.escape(fault)):
        models.register("mine", model)
    with pytest.raises(TypeError, match="expected a text for its name"):
        models.register(7, next(iter(models.values())))
    assert "mine" not in models and 7 not in models


def test_exponents_are_raised_and_numbers_of_layers_are_no_powers():
    assert in_tex("kg/m^3") == "kg/m$^{3}$" and in_tex("N/m^1.5") == "N/m$^{1.5}$"
    assert plain(r"$\mathrm{E}^{(1)} = 2 \times 10^{-3}$") == "E⁽¹⁾ = 2 × 10⁻³"
