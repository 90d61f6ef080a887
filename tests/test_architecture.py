"""The folder tree is the architecture: which room may import which."""

import ast

import pytest
from conftest import HOME

ROOMS = ("app", "meshes", "solvers", "postprocess")
#: Libraries that are met in one place only.
ONE_PLACE = {
    "gmsh": {"meshes/gmsh_model.py"},
    "h5py": {"postprocess/hdf5/"},
    "ufl": {"solvers/fem/forms.py", "solvers/fem/space.py", "solvers/fem/adapter.py"},
    "matplotlib": {"postprocess/figures/", "app/results/drawings.py"},
    "jinja2": {"postprocess/page.py"},
    "xarray": {"postprocess/named.py", "app/results/result.py"},
    "tomlkit": {"app/scene/changes.py"},
    "pint": {"app/scene/units.py"},
}


def imports(path):
    """Modules that a file imports, wherever in it."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name.removeprefix("galinx.") for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.module.removeprefix("galinx.")


FILES = [path for room in ROOMS for path in sorted((HOME / room).rglob("*.py"))]


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(HOME)))
def test_imports(path):
    name = path.relative_to(HOME).as_posix()
    found = set(imports(path))
    roots = {module.split(".")[0] for module in found}
    allowed = {
        "app": set(ROOMS),
        "postprocess": {"postprocess"},
        "meshes": {"meshes"},
        "solvers": {"solvers"},
    }
    assert not (roots & set(ROOMS)) - allowed[path.relative_to(HOME).parts[0]]
    for library, places in ONE_PLACE.items():
        assert library not in roots or name.startswith(tuple(places))
    if name.startswith("solvers/") and not name.startswith("solvers/fem/"):
        assert roots <= {
            "solvers",
            "numpy",
            "scipy",
            "math",
            "dataclasses",
            "functools",
            "collections",
            "typing",
        }
    if name.startswith("solvers/fem/"):
        assert not any(module.startswith(("solvers.sie", "solvers.friction")) for module in found)


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(HOME)))
def test_files_stay_readable(path):
    assert len(path.read_text(encoding="utf-8").splitlines()) <= 330
