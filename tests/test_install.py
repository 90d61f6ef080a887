"""What pip installs: one package, with all that it needs, which calls itself galinx."""

import re
import shutil
import sys
import tomllib
import zipfile
from importlib.util import find_spec

import pytest
from support import HOME, finished

#: What a wheel is made of.
SOURCES = (
    "app", "galinx", "meshes", "postprocess", "scenes", "solvers",
    "pyproject.toml", "README.md", "LICENSE",
)  # fmt: skip
ROOMS = ("app", "meshes", "postprocess", "scenes", "solvers")


@pytest.fixture(scope="module")
def names_and_site(tmp_path_factory):
    """Names of a wheel's files, and a folder that it is unpacked into, as pip does."""
    if missing := [name for name in ("pip", "setuptools", "wheel") if not find_spec(name)]:
        pytest.skip(f"{', '.join(missing)} not installed")
    folder = tmp_path_factory.mktemp("install")
    source, site = folder / "source", folder / "site"
    source.mkdir()
    for name in SOURCES:  # a copy: setuptools leaves its work beside what it packages
        if (HOME / name).is_dir():
            ignored = shutil.ignore_patterns("__pycache__")
            shutil.copytree(HOME / name, source / name, symlinks=True, ignore=ignored)
        else:
            shutil.copy(HOME / name, source)
    offline = ("--no-deps", "--no-build-isolation", "--no-index")
    made = finished([sys.executable, "-m", "pip", "wheel", *offline, "-w", folder, source])
    assert made.returncode == 0, made.stderr
    with zipfile.ZipFile(next(folder.glob("*.whl"))) as wheel:
        wheel.extractall(site)
        return wheel.namelist(), site


def installed(site, *arguments, **variables):
    """Python with what is installed and without the source tree, in another folder."""
    words, variables = [sys.executable, "-P", *arguments], {"PYTHONPATH": str(site)} | variables
    return finished(words, cwd=site.parent, without=("GALINX_COMMAND",), **variables)


def test_every_file_of_a_room_is_installed_once(names_and_site):
    names, _ = names_and_site
    wanted = {
        path.relative_to(HOME).as_posix()
        for room in ROOMS
        for path in (HOME / room).rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    wanted |= {path.name for path in (HOME / "galinx").glob("*.py")}
    found = [name.removeprefix("galinx/") for name in names if name.startswith("galinx/")]
    assert sorted(found) == sorted(wanted)


def test_what_is_installed_works_elsewhere(names_and_site):
    _, site = names_and_site
    script = (
        "import galinx, galinx.app.cli\n"
        "from galinx.app.scene.library import LIBRARY\n"
        "from galinx.app.study.published import published\n"
        "result = galinx.compute(galinx.template('tables4_5', {'solve.methods': ['closed_form']}))\n"
        "result.save('tables.h5'), result.report('tables.html')\n"
        "print(galinx.__file__, 'T302' in LIBRARY, 'table4' in published(), len(result.dataset.f))\n"
    )
    done = installed(site, "-c", script)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == [str(site / "galinx" / "__init__.py"), "True", "True", "12"]
    assert "galinx run scene.toml" in (site.parent / "tables.html").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    "arguments, said",
    [
        (("run", "--help"), "mpirun -n 2 galinx run "),
        (("init", "own_material"), "galinx plan own_material.toml"),
    ],
)
def test_an_installed_command_calls_itself_galinx(names_and_site, arguments, said):
    _, site = names_and_site
    done = installed(site, "-m", "galinx", *arguments, COLUMNS="80")
    assert done.returncode == 0, done.stderr
    assert said in done.stdout and "run.sh" not in done.stdout


#: What conda-forge calls otherwise than PyPI.
CONDA = {"matplotlib": "matplotlib-base", "dolfinx-solver-real": "fenics-dolfinx", "gmsh": "python-gmsh"}


def test_the_conda_environment_has_what_the_package_needs():
    """Each dependency with its least version; of dolfinx those that are supported, in real numbers."""
    yaml = pytest.importorskip("yaml")
    environment = yaml.safe_load((HOME / "environment.yml").read_text(encoding="utf-8"))
    assert environment["name"] == "galinx" and environment["channels"] == ["conda-forge"]
    listed = dict(re.fullmatch(r"([\w-]+)(.*)", line).groups() for line in environment["dependencies"])
    assert len(listed) == len(environment["dependencies"])
    project = tomllib.loads((HOME / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    needed = [*project["dependencies"], *project["optional-dependencies"]["fem"]]
    needed = dict(re.fullmatch(r"([\w-]+)(.*)", line).groups() for line in needed)
    assert needed.pop("dolfinx-solver-real") and listed["fenics-dolfinx"] == ">=0.9"
    assert listed["petsc"] == "=*=real*" and listed["python"] == project["requires-python"]
    assert {CONDA.get(name, name): least for name, least in needed.items()}.items() <= listed.items()


def test_a_container_gets_what_the_command_needs(tmp_path):
    """The files that .dockerignore lets through, run as the Dockerfile does."""
    taken = [
        line[1:] for line in (HOME / ".dockerignore").read_text().splitlines() if line.startswith("!")
    ]
    for name in taken:
        copy = shutil.copytree if (HOME / name).is_dir() else shutil.copy
        copy(HOME / name, tmp_path / name, **({"symlinks": True} if copy is shutil.copytree else {}))
    words = [
        line.split(maxsplit=1)
        for line in (HOME / "Dockerfile").read_text().splitlines()
        if line[:1] > "@"
    ]
    told = {word: rest for word, rest in words}
    assert [word for word, _ in words] == ["FROM", "COPY", "RUN", "ENV", "WORKDIR", "ENTRYPOINT", "CMD"]
    home = told["COPY"].split()[1]
    for line in (
        told["RUN"].split(" && ")[0],
        f"PATH={home}/bin:$PATH galinx run {home}/scenes/table1.toml",
    ):
        line = line.replace(home, str(tmp_path))
        assert finished(["bash", "-c", line], cwd=tmp_path).returncode == 0
