"""What pages name exists: tests, and other pages."""

import re
import runpy

from support import HOME

TESTS = HOME / "tests"
FILES = {path.name: path for path in TESTS.rglob("test_*.py")}
PAGES = [HOME / "README.md", HOME / "CONTRIBUTING.md", *sorted((HOME / "docs").glob("*.md"))]


def test_files_of_tests_have_names_of_their_own():
    """Pages name them without folder, and pytest tells them apart by their names."""
    assert len(FILES) == len(list(TESTS.rglob("test_*.py"))) > 40


def test_tests_that_the_pages_name_exist():
    faults, named = [], 0
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        for folder, file, name in re.findall(r"`((?:[\w-]+/)*)(test_\w+\.py)(?:::(\w+))?`", text):
            named += 1
            path = FILES.get(file)
            if not path or (folder and path != HOME / folder / file):
                faults.append(f"{page.name}: {folder}{file}")
            elif name and f"def {name}(" not in path.read_text(encoding="utf-8"):
                faults.append(f"{page.name}: {file}::{name}")
        for name in re.findall(r"`(test_\w+)`", text):
            if not any(f"def {name}(" in path.read_text(encoding="utf-8") for path in FILES.values()):
                faults.append(f"{page.name}: {name}")
    assert not faults, "\n".join(faults)
    assert named > 50


def test_links_between_pages_hold():
    faults = [
        f"{page.name}: {target}"
        for page in [*PAGES, *(HOME / "benchmarks").rglob("*.md")]
        for target in re.findall(r"\]\(([\w/-]*\.[\w./-]+)\)", page.read_text(encoding="utf-8"))
        if "://" not in target and not (page.parent / target).exists()
    ]
    assert not faults, "\n".join(faults)


def test_the_page_of_equations_names_code_and_tests_that_exist_for_each():
    """Every row has code and a test, each name is in the file it links to, and no equation is missing."""
    sources = runpy.run_path(str(HOME / "docs" / "sources.py"))
    page = (HOME / "docs" / "equations.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| ([\d–, ]+) \|(.*)\|$", page, re.MULTILINE)
    numbers_shown, faults = [], []
    for numbers, row in rows:
        for first, _, last in (part.partition("–") for part in numbers.split(", ")):
            numbers_shown += range(int(first), int(last or first) + 1)
        links = sources["LINK"].findall(row)
        for name, file in links:
            path = HOME / f"{file}.py"
            if not path.exists() or name not in sources["names"](path.read_text(encoding="utf-8")):
                faults.append(f"Eq {numbers}: {name} is not in {file}.py")
        of_tests = [name.startswith("test_") and file.startswith("tests/") for name, file in links]
        if not any(of_tests) or all(of_tests):
            faults.append(f"Eq {numbers}: expected code and a test")
    assert not faults, "\n".join(faults)
    assert sorted(numbers_shown) == [*range(1, 59)]
    assert page.count("](../") == sum(len(sources["LINK"].findall(row)) for _, row in rows)
