"""What tests of several rooms need: commands, processes, scenes computed in memory, spaces and areas."""

import fcntl
import io
import os
import resource
import signal
import subprocess
import sys
from contextlib import chdir, closing, contextmanager, redirect_stderr, redirect_stdout
from functools import cache
from pathlib import Path
from unittest.mock import patch

import numpy as np
import pytest
import tomlkit

HOME = Path(__file__).parent.parent
#: As many kills, random scenes and fine tolerances as before a release?
THOROUGH = bool(os.environ.get("GALINX_THOROUGH"))
#: The scene of the study's Tables 4 and 5.
SCENE = HOME / "scenes" / "tables4_5.toml"


class Hang(BaseException):
    """Something takes longer than it may; no handler of ordinary exceptions takes it."""


@contextmanager
def at_most(seconds=10.0):
    """For a block in the main thread: one that hangs is ended.

    Raises:
        Hang: it took longer.
    """

    def end(*_):
        raise Hang(f"more than {seconds} s")

    before = signal.signal(signal.SIGALRM, end)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def scene_of(name="tables4_5", changes=None):
    """A scene of scenes/, or of a text, with other values by ``"section.key"``, None for none.

    A key without a dot stands for a whole section.
    """
    from galinx.app.scene.changes import changed
    from galinx.app.scene.library import templates
    from galinx.app.scene.read import parse

    text = name if "\n" in name else templates()[name]
    sections = {key: value for key, value in (changes or {}).items() if "." not in key}
    document = tomlkit.parse(text)
    for key, value in sections.items():
        document.pop(key, None)
        if value is not None:
            document[key] = value
    keys = {key: value for key, value in (changes or {}).items() if "." in key}
    return parse(changed(tomlkit.dumps(document) if sections else text, keys))


def of_sections(**sections):
    """A scene of these sections alone."""
    empty = dict.fromkeys(("solid", "punch", "friction", "motion", "solve", "output"))
    return scene_of("tables4_5", empty | sections)


def computed(name="tables4_5", changes=None):
    """The result of such a scene."""
    import galinx

    return galinx.compute(scene_of(name, changes))


def section_of(solid):
    """The section [solid] of a scene that has a solid."""
    from galinx.solvers.parameters import values
    from galinx.solvers.solids import SOLIDS

    kind = next(name for name, known in SOLIDS.items() if known is type(solid))
    given = {key: value for key, value in values(solid).items() if np.size(value) and value is not None}
    return {"kind": kind} | {key: np.asarray(value).tolist() for key, value in given.items()}


CLOSED_FORM = {"solve.methods": ["closed_form"]}
SIE = {"solve.methods": ["sie"]}
#: Results that many tests read, by name: a scene, and what is other in it; by the quickest methods but
#: for the first three.
KEPT = {
    "tables": ("tables4_5", {}),
    "map": ("tables4_5", {
        "output.quantities": ["friction", "sif", "surface", "interior"],
        "output.map": {"X": [-2, 2, 21], "Y": [-2, -0.1, 20]},
    }),
    "inside": ("inside", {"solve.tolerance": 1e-3}),
    "flat": ("tables4_5", CLOSED_FORM),
    "yield": ("tables4_5", CLOSED_FORM | {
        "output.quantities": ["sif", "surface", "yield"], "solid.yield_strength": 6e8,
    }),
    "cylinder": ("cylinder", CLOSED_FORM | {
        "motion.c": [0.0, 0.3, 0.6], "output.map": {"X": [-2, 2, 21], "Y": [-2, -0.1, 20]},
        "output.quantities": ["sif", "surface", "interior"],
    }),
    "laws": ("tables4_5", CLOSED_FORM | {
        "friction.mu_c": [0.3, 0.7], "friction.sigma0_over_load": [1e4, 4e4],
    }),
    "coating": ("coating", SIE),
    "from rest": ("start_from_rest", SIE | {"time.end": 5.0}),
    "slider": ("slider", {"slider.duration": "16 s"}),
} | {
    name: (name, changes)
    for name, changes in {
        "fibres": CLOSED_FORM, "shoulders": CLOSED_FORM, "minor_loops": {},
        "velocity_steps": {}, "fig6": {}, "sinusoidal": {}, "own_material": CLOSED_FORM,
        "cylinder_on_steel": {}, "parameter_study": CLOSED_FORM, "traction": CLOSED_FORM,
        "high_speed": CLOSED_FORM, "study": CLOSED_FORM, "table1": {},
    }.items()
}  # fmt: skip


def once(name, make):
    """A path in the folder of results; the first of all processes of tests that asks for it makes it."""
    path = Path(os.environ["GALINX_KEPT"], name)
    with open(path.with_suffix(".lock"), "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not path.exists():
            make(path)
    return path


@cache
def kept(name):
    """One of these results, computed once."""
    import galinx

    return galinx.load(once(f"{name}.h5", lambda path: computed(*KEPT[name]).save(path)))


@cache
def paper_run():
    """Folder that ``./run.sh`` makes of the study, and what it says."""

    def make(folder):
        folder.mkdir()
        done = command(cwd=folder)
        assert done.returncode == 0, done.stdout + done.stderr
        (folder / "said").write_text(done.stdout + done.stderr, encoding="utf-8")

    folder = once("paper", make)
    return folder / "results", (folder / "said").read_text(encoding="utf-8")


def command(*arguments, script=HOME / "run.sh", **options):
    """Run ``./run.sh ARGUMENTS``; options are those of :func:`finished`."""
    return finished([script, *arguments], **options)


def finished(words, cwd=HOME, without=(), text=True, given=None, **variables):
    """A process that has ended, and its output; what it reads is ``given``, or nothing.

    ``variables`` are added to the environment, those of the names ``without`` taken away.
    """
    environment = clean_environment() | variables
    return subprocess.run(
        [*map(str, words)], cwd=cwd, capture_output=True, text=text, timeout=300,
        env={name: value for name, value in environment.items() if name not in without},
        **({"stdin": subprocess.DEVNULL} if given is None else {"input": given}),
    )  # fmt: skip


def here(*arguments, cwd=HOME, **variables):
    """What :func:`command` returns, of a command in this process, which saves the start of one.

    The pages' examples start all commands as a user does.
    """
    out, err = io.StringIO(), io.StringIO()
    with chdir(cwd), patch.dict(os.environ, variables), redirect_stdout(out), redirect_stderr(err):
        status = called(*map(str, arguments))
    return subprocess.CompletedProcess(arguments, status, out.getvalue(), err.getvalue())


def called(*words):
    """The status of ``galinx WORDS`` in this process, which is left as it was."""
    from galinx.app.cli import run_from_shell
    from galinx.app.process import SIGNALS

    handlers = {number: signal.getsignal(number) for number in SIGNALS}
    me, end = os.getpid(), os._exit

    def leave(status):
        """Processes that a command forks end for good: they must not return into the tests."""
        return sys.exit(status) if os.getpid() == me else end(status)

    try:
        with (
            patch.object(sys, "argv", ["galinx", *words]),
            patch.object(os, "_exit", leave),
            pytest.raises(SystemExit) as ended,
        ):
            run_from_shell()
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
    return ended.value.code


def mpirun(ranks, *arguments):
    """The command that starts this Python on some ranks."""
    beside = Path(sys.executable).with_name("mpirun")
    program = str(beside) if beside.exists() else "mpirun"
    return [program, "-n", str(ranks), sys.executable, *map(str, arguments)]


def clean_environment():
    """The environment without what MPI leaves there, which a second mpirun would trip over."""
    mpi = ("OMPI_", "PMIX_", "PMI_", "PRTE_", "ORTE_", "HYDRA_", "HYDI_", "MPIR_")
    kept = {name: value for name, value in os.environ.items() if not name.startswith(mpi)}
    return kept | {
        "OMPI_ALLOW_RUN_AS_ROOT": "1",
        "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
        "OMPI_MCA_rmaps_base_oversubscribe": "1",
        "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",
        # Tests run side by side: two programs must not want the same core.
        "OMPI_MCA_hwloc_base_binding_policy": "none",
        "PRTE_MCA_hwloc_default_binding_policy": "none",
        "PYTHONPATH": str(HOME),
        # What one process compiles is there for the next, whatever the shell says.
        "PYTHONDONTWRITEBYTECODE": "",
    }


@contextmanager
def full_disk(size):
    """No file may grow beyond ``size``, which is what a full disk does in the end."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    earlier = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    # Python would keep modules that it compiles now cut off at the limit, and read them the next time.
    compiled, sys.dont_write_bytecode = sys.dont_write_bytecode, True
    try:
        yield
    finally:
        sys.dont_write_bytecode = compiled
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
        signal.signal(signal.SIGXFSZ, earlier)


def widest(text):
    """Length of the longest line."""
    return max(map(len, text.splitlines()))


def interrupted(scene, target, states):
    """Compute a scene until more states than these are kept for its archive: then it is interrupted."""
    from galinx.app.run.flow import Memory, compute
    from galinx.postprocess.journal import Journal

    def stop(self, part, keep=Journal.keep):
        keep(self, part)
        if self.states > states:
            raise KeyboardInterrupt

    ended = patch.object(Journal, "keep", stop), pytest.raises(KeyboardInterrupt)
    with ended[0], ended[1], Journal(target, "key") as journal:
        compute(scene, Memory(), None, journal)


def space_on(mesh, refinement, degree, comm=None, form="isotropic"):
    """A finite element space on one of the meshes; this rank alone has it where ``comm`` is not given."""
    from mpi4py import MPI

    from galinx.meshes import MESHES
    from galinx.solvers.fem.space import Space, distribute

    comm, kind = comm or MPI.COMM_SELF, MESHES[mesh]
    cells = None if comm.rank else kind.build(refinement)
    return Space(*distribute(cells, comm), kind.chart, degree, form, 0 if kind.walls else 8)


def state_field(scene, number, extent=10.0, degree=None):
    """Field of a state in SI from one factorisation, on rank 0; None on the others."""
    from galinx.app.results.fields import in_si, solve_states

    with closing(solve_states(scene, [number], [degree], extent)) as states:
        solved = next(states)
        whole = gathered(solved.sampled(extent), solved.comm)
        return None if whole is None else in_si(solved, whole)


def gathered(field, comm):
    """The pieces of a sampled field of all ranks in one, on rank 0; None on the others."""
    from galinx.solvers.fem.export import joined

    pieces = comm.gather(field)
    return None if pieces is None else joined(pieces)


def small_punch(c=0.6, **options):
    """A punch that is solved in a moment, at degree 7."""
    from galinx.meshes.rings import Refinement
    from galinx.solvers.fem.punch import SlidingPunch
    from galinx.solvers.solids.isotropic import MovingFrame

    space = space_on("confocal", Refinement(6, 0.35, 2, (3.0,) * 3), 7)
    return SlidingPunch(space, MovingFrame(2.0, c), **options)


def areas(points, quads):
    """Signed areas of polygons, (m,)."""
    X, Y = points[quads][..., 0], points[quads][..., 1]
    return 0.5 * (X * np.roll(Y, -1, axis=1) - np.roll(X, -1, axis=1) * Y).sum(axis=1)
