"""Scenes changed from outside."""

import pytest
from support import SCENE, at_most

from galinx.app.errors import BadInput
from galinx.app.scene.changes import changed, from_words
from galinx.app.scene.read import parse, read


def test_a_change_stands_in_the_text_and_comments_stay():
    text = SCENE.read_text(encoding="utf-8")
    result = changed(text, {"friction.mu_c": [0.3, 0.5], "solve.tolerance": 1e-4})
    assert "mu_c = [0.3, 0.5]" in result and "tolerance = 0.0001" in result
    assert result.count("#") == text.count("#") and "# σ₀ l/N" in result
    assert parse(result).friction.parameters["mu_c"] == (0.3, 0.5)


def test_words_are_toml_values_or_texts():
    changes = from_words(
        ["friction.mu_c=[0.3, 0.5]", "solid.E=70 GPa", "title=Two words", "motion.c=0.1"]
    )
    assert changes == {
        "friction.mu_c": [0.3, 0.5], "solid.E": "70 GPa", "title": "Two words", "motion.c": 0.1
    }  # fmt: skip


def test_long_lists_are_put_in_in_a_moment():
    values = [0.9 * i / 10_000 for i in range(10_000)]
    with at_most():
        text = changed(
            SCENE.read_text(encoding="utf-8"), {"motion.c": values, "x.y": [[1, 2.5], ["a", True]]}
        )
    assert 'y = [[1, 2.5], ["a", true]]' in text and f"c = {values}" in text


@pytest.mark.parametrize("key", ["friction", "a.b.c", "mu_c"])
def test_keys_name_section_and_key(key):
    with pytest.raises(BadInput, match="cannot be changed"):
        read(SCENE, {key: 1.0})


@pytest.mark.parametrize(
    "word, message",
    [
        ("solid.E=" + "9" * 5000, "thousands of digits"),
        ("solve.degree=" + "9" * 400, "found a whole number of about 400 digits, expected >= 1, <= 12"),
        ("solve.degree=0x" + "f" * 6000, "found a whole number of about 7225 digits"),
        ("solid.E=" + "[" * 3000, "solid.E .*: found '\\[+"),
        ("motion.c=" + "[" * 3000 + "]" * 3000, "motion.c"),
        ("motion.c=" + "[" * 300 + "]" * 300, "motion.c .*: found \\["),
        ("friction.mu_c=[{a = 1}]", "mu_c .*: found {'a': 1}, expected"),
        ("solid.E={a = " + "9" * 400 + "}", "found {'a': a whole number of about 400 digits}"),
        ("title={a = 1}", "title: found {'a': 1}, expected a text"),
        ("title.x=1", "found 'title' without keys"),
        ("title=" + "a" * 100_000, "100000 characters"),
        ("title=\udcff", "UTF-8"),
        ("x" * 5000 + ".y=1", "no such section"),
        ("solid." + "x" * 5000 + "=1", "no such key"),
        ("solid.E=1 Pa*9**9**9", "a number, then units"),
    ],
    ids=lambda text: text[:12],
)
def test_what_is_long_deep_or_a_table_is_refused_with_a_short_message(word, message):
    with pytest.raises(BadInput, match=message) as caught:
        read(SCENE, {"title": ""} | from_words([word]))
    assert len(str(caught.value)) < 600


def test_keys_are_taken_away():
    changes = from_words(["motion.speed={from = '1 mm/s', to = 1, number = 3}"], ["motion.c", "title"])
    scene = read(SCENE, changes)
    assert scene.motion.c is None and scene.motion.speed == (0.001, 0.5005, 1.0) and scene.title == ""


@pytest.mark.parametrize(
    "key, message",
    [
        ("motion.cc", "found no key 'motion.cc' to take away; did you mean motion.c?"),
        ("motion.speed", "found no key 'motion.speed' to take away"),
        ("titel", "did you mean title"),
        ("motion", "did you mean motion.c"),
        ("\udcff", "valid: title, "),
    ],
)
def test_only_what_is_there_is_taken_away(key, message):
    with pytest.raises(BadInput, match=message.replace("?", r"\?")):
        read(SCENE, from_words([], [key]))


def test_a_key_is_set_or_taken_away():
    with pytest.raises(BadInput, match=r"--set and --unset motion\.c exclude each other"):
        from_words(["motion.c=0.1"], ["motion.c"])


def test_another_law_replaces_the_parameters_of_the_old_one():
    text = changed(SCENE.read_text("utf-8"), {"friction.model": "coulomb"})
    friction = parse(text).friction
    assert [*friction.parameters] == ["mu_c"] and friction.pre_sliding == 1e-4
    with pytest.raises(BadInput, match="mu_s: missing"):
        parse(changed(SCENE.read_text("utf-8"), {"friction.model": "stribeck"}))
