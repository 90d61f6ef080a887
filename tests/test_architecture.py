"""The folder tree is the architecture: which room may import which."""

import ast
import re
from functools import cache
from graphlib import TopologicalSorter

from support import HOME

ROOMS = ("app", "meshes", "solvers", "postprocess")
#: Libraries that are met in one place only.
ONE_PLACE = {
    "gmsh": {"meshes/store.py"},
    "h5py": {"postprocess/hdf5/"},
    "ufl": {"solvers/fem/forms.py", "solvers/fem/versions.py"},
    "matplotlib": {"app/figures/"},
    "jinja2": {"app/results/report.py"},
    "xarray": {"app/results/result.py"},
    "tomlkit": {"app/scene/changes.py"},
    "pint": {"app/scene/units.py"},
    "rich": {"app/console.py"},
}


@cache
def nodes(path):
    """All that a file consists of."""
    return [*ast.walk(ast.parse(path.read_text(encoding="utf-8")))]


def imports(path):
    """Modules that a file imports, wherever in it."""
    for node in nodes(path):
        if isinstance(node, ast.Import):
            yield from (alias.name.removeprefix("galinx.") for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield source(node, path)


def source(node, path):
    """Module that names are imported from, below the folder galinx; a relative one by its place."""
    if not node.level:
        return node.module.removeprefix("galinx.")
    package = path.relative_to(HOME).parts[: -node.level]
    return ".".join([*package, node.module] if node.module else package)


#: By their place below the project's folder.
FILES = {
    path.relative_to(HOME).as_posix(): path for room in ROOMS for path in (HOME / room).rglob("*.py")
}
#: What the mechanics outside solvers/fem/ is made of.
PURE = {
    "solvers", "registry", "texts", "numpy", "scipy", "math", "abc", "dataclasses", "functools",
    "collections", "contextlib", "itertools", "types", "typing", "warnings",
}  # fmt: skip
#: What finite elements are compared with, and may not use: but the mode that prescribes the closed form's
#: pressure has that.
TRACTION, FORMULA = "solvers/fem/traction.py", "solvers.contact.closed_form"
SOLUTIONS = (
    FORMULA, "solvers.contact.exact", "solvers.contact.equation", "solvers.friction",
)  # fmt: skip
#: What both share, and so has no solution either.
SHARED = "solvers/contact/pressure.py"
#: What a room may import of others; app of all. Of the mechanics postprocessing knows the physics, and
#: finite elements and their plan know meshes.
OTHERS = {"postprocess": {"solvers"}, "solvers/fem": {"meshes"}, "solvers/contact/fem_plan": {"meshes"}}


def faults_of_imports(name, found):
    """What a file imports against the rules of its room."""
    roots, room = {module.split(".")[0] for module in found}, name.split("/")[0]
    if room != "app":
        allowed = set().union(*(of for part, of in OTHERS.items() if name.startswith(part)))
        foreign = (roots & set(ROOMS)) - {room} - allowed
        yield from (f"{name} imports from {other}/" for other in foreign)
    if room == "postprocess" and any(module.startswith("solvers.fem") for module in found):
        yield f"{name} imports finite elements"
    for library, places in ONE_PLACE.items():
        if library in roots and not name.startswith(tuple(places)):
            yield f"{name} imports {library}, which is met in {', '.join(sorted(places))} only"
    if name.startswith(("solvers/fem/", SHARED)):
        apart = [module for module in SOLUTIONS if name != TRACTION or module != FORMULA]
        yield from (f"{name} imports {module}" for module in found if module.startswith(tuple(apart)))
    if room == "solvers" and not name.startswith("solvers/fem/"):
        yield from (f"{name} imports {root}, and is no finite element" for root in roots - PURE - allowed)


def test_rooms_import_what_they_may():
    assert len(FILES) > 80
    faults = [
        fault for name, path in FILES.items() for fault in faults_of_imports(name, set(imports(path)))
    ]
    assert not faults, "\n".join(faults)


def test_imports_inside_a_room_are_relative():
    faults = [
        f"{name}:{node.lineno}: {node.module}"
        for name, path in FILES.items()
        for node in nodes(path)
        if isinstance(node, ast.ImportFrom) and not node.level
        if f"{node.module}.".startswith(f"galinx.{name.split('/')[0]}.")
    ]
    assert not faults, "\n".join(faults)


def test_what_is_against_the_rules_is_found():
    assert list(faults_of_imports("solvers/contact/x.py", {"numpy", "meshes.rings"})) == [
        "solvers/contact/x.py imports from meshes/",
        "solvers/contact/x.py imports meshes, and is no finite element",
    ]
    assert list(faults_of_imports("app/x.py", {"solvers.fem", "tomlkit"})) == [
        "app/x.py imports tomlkit, which is met in app/scene/changes.py only"
    ]
    assert list(faults_of_imports("solvers/fem/x.py", {"dolfinx", "solvers.contact.closed_form"}))


def modules():
    """Modules by name, and what each imports of the others, wherever in it."""
    known = {
        name.removesuffix(".py").removesuffix("/__init__").replace("/", "."): path
        for name, path in FILES.items()
    }
    for name, path in known.items():
        found = set()
        for node in nodes(path):
            if isinstance(node, ast.ImportFrom):
                module = source(node, path)
                names = (f"{module}.{alias.name}" for alias in node.names)
                found |= {one if one in known else module for one in names}
        yield name, found & known.keys() - {name}


def test_no_module_imports_what_imports_it():
    graph = dict(modules())
    assert graph["app.run.flow"] >= {"app.plan.variants", "app.run.solve"}
    order = [*TopologicalSorter(graph).static_order()]  # raises where there is a circle
    assert order.index("app.run.flow") > order.index("app.plan.plan")


def test_nothing_is_imported_for_types_alone():
    assert not [name for name, path in FILES.items() if "TYPE_CHECKING" in path.read_text("utf-8")]


#: A dataset's path as the table of quantities spells it, or a format of one.
PATH = re.compile(r"(states|surface|interior|loops|run|scene)/[\w{]")


def test_paths_of_datasets_are_spelled_in_their_table_alone():
    faults = []
    for name, path in FILES.items():
        if name.startswith(("app/", "postprocess/")) and not name.startswith("postprocess/quantities/"):
            for node in nodes(path):
                text = node.value if isinstance(node, ast.Constant) else None
                if isinstance(text, str) and PATH.match(text):
                    faults.append(f"{name}:{node.lineno}: {text}")
    assert not faults, "\n".join(faults)
