import re

from support import HOME


def test_tests_that_the_docs_name_exist():
    named = 0
    for page in (HOME / "docs").glob("*.md"):
        for file, name in re.findall(
            r"`(?:tests/)?(test_\w+\.py)::(\w+)`", page.read_text(encoding="utf-8")
        ):
            named += 1
            assert f"def {name}(" in (HOME / "tests" / file).read_text(encoding="utf-8"), (
                f"{file}::{name}"
            )
    assert named > 30


def test_links_between_pages_hold():
    for page in [HOME / "README.md", *(HOME / "docs").glob("*.md"), *(HOME / "benchmarks").rglob("*.md")]:
        for target in re.findall(r"\]\(([\w/-]*\.[\w./-]+)\)", page.read_text(encoding="utf-8")):
            assert "://" in target or (page.parent / target).exists(), f"{page.name}: {target}"
