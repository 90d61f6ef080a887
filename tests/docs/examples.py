"""Examples of the pages: commands, Python and other blocks found, and what runs them."""

import io
import re
import shlex
import shutil
import subprocess
import sys
from contextlib import chdir, redirect_stderr, redirect_stdout
from pathlib import Path

from support import HOME, THOROUGH, clean_environment, here, paper_run

from galinx.app.cli import cli
from galinx.app.commands import options
from galinx.app.plan.plan import make_plan

DOCS = HOME / "docs"
PAGES = [HOME / "README.md", HOME / "CONTRIBUTING.md", *sorted(DOCS.glob("*.md"))]

#: Words of run.sh that take minutes, run the tests themselves or write into the checkout.
NOT_RUN = ("test", "bench", "stress", "docs")

_FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_COMMAND = re.compile(r"\s*(\w+=\S+ |for .*; do )*\./run\.sh\b")
_INDENTED = re.compile(r"(?<=\n\n)(?: {4}.*\n)+")
_NAMED = re.compile(r"# ([\w-]+\.(?:py|toml))\n")
_STATUS = re.compile(r"#.*\bstatus (\d)\b")
#: The page whose commands are all started as a user does. Of the others those are that ask for ranks,
#: bring models, which would stay registered, or need a shell; what is left runs in this process.
STARTED = "README.md"
_ON_ITS_OWN = ("-n", "-x")
#: Commands that draw, of which most pages quote nothing: their options are read, and other tests draw.
#: All are run where GALINX_THOROUGH asks for it.
_DRAWING = ("plot", "report", "fields", "response", "dispersion")
#: Commands that are run where a page quotes what they print, or names their archive there or in Python.
#: Of the others a run is planned alone, and options of the rest are read.
_COMPUTING = ("run", "paper", "show", "check", "compare", "csv", "fit", "schema")


def name_of(page):
    return page.name


def text_of(page):
    return page.read_text(encoding="utf-8")


def blocks(page, kind):
    """Bodies of the fenced blocks of one kind."""
    return [body for language, body in _FENCE.findall(text_of(page)) if language == kind]


def file_of(block):
    """The file that a block is saved in, which its first line names as a comment; None for none."""
    named = _NAMED.match(block)
    return named[1] if named else None


def save_blocks(page, folder):
    """Blocks that name a file; those of one file follow each other."""
    for block in (*blocks(page, "python"), *blocks(page, "toml")):
        if name := file_of(block):
            with (folder / name).open("a", encoding="utf-8") as file:
                file.write(block)


def commands(page):
    """Lines with ./run.sh of indented blocks and of console blocks."""
    return [command for command, _ in followed(page)]


def followed(page):
    """The same, each with whether a page quotes output before its next block of another kind."""
    found, language, open_ = [], None, 0
    for line in text_of(page).splitlines():
        if line.startswith("```"):
            language = line[3:] if language is None else None
            if language in ("console", "python", "toml"):
                open_ = len(found)
        elif _COMMAND.match(line) and (language == "console" or (not language and line[:4] == "    ")):
            found.append([line.strip(), False])
            continue
        if language == "text" or (language is None and line[:4] == "    "):
            for one in found[open_:]:
                one[1] = True
            open_ = len(found)
    return found


def quotes(page):
    """Output that a page quotes: text blocks and, if it has commands, indented blocks without any."""
    quoted = blocks(page, "text")
    if commands(page):
        indented = _INDENTED.findall(_FENCE.sub("", text_of(page)))
        quoted += [block for block in indented if not any(map(_COMMAND.match, block.splitlines()))]
    return quoted


def words_of(command):
    """What follows ./run.sh, without comment."""
    words = shlex.split(command, comments=True)
    return words[words.index("./run.sh") + 1 :]


def _run(command, cwd):
    """Status and output of a command line of a page in ``cwd``."""
    words = words_of(command)
    if not words:
        results, said = paper_run()
        shutil.copytree(results, cwd / results.name)
        return 0, said
    of_shell = not command.startswith("./run.sh") or {">", "|"} & set(words)
    if not of_shell and cwd.name != STARTED and words[0] not in _ON_ITS_OWN:
        done = here(*words, cwd=cwd)
        return done.returncode, done.stdout + done.stderr
    done = subprocess.run(
        ["bash", "-c", command], cwd=cwd, env=clean_environment(), text=True,
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=200,
    )  # fmt: skip
    return done.returncode, done.stdout


def folder_for(page, folder):
    """A page's folder, in which ./run.sh and scenes/ are those of the checkout."""
    made = folder / page.name
    made.mkdir()
    script = made / "run.sh"
    script.write_text(f'#!/bin/sh\nexec {shlex.quote(str(HOME / "run.sh"))} "$@"\n')
    script.chmod(0o755)
    (made / "scenes").symlink_to(HOME / "scenes")
    return made


def run_page(page, folder):
    """Save the files of a page, run its commands in order, then its Python; what both print."""
    output, faults = "", []
    save_blocks(page, folder)
    for command, quoted in followed(page):
        words = words_of(command)
        if words and words[0] in NOT_RUN:
            continue
        if words and not (THOROUGH or page.name == STARTED or _needed(words, page, quoted)):
            _read(words, folder)
            continue
        wanted = int((_STATUS.search(command) or [0, 0])[1])
        status, told = _run(command, folder)
        output += told
        if status != wanted:
            faults.append(f"{command}\n  status {status}, expected {wanted}\n{told[-1500:]}")
    assert not faults, "\n".join(faults)
    return output + run_python(page, folder)


def _needed(words, page, quoted):
    """Does a page need that a command is run: its output, its archive, or what it says of its place?"""
    name, own = words[2 if words[0] in _ON_ITS_OWN else 0], words[0] == "-x"
    if name in _DRAWING:
        words = words[2:] if own else words
        place, stem = words[words.index("-o") + 1] if "-o" in words else words[1], Path(words[1]).stem
        return quoted and any(f": {place}" in quote and stem in quote for quote in quotes(page))
    if own or quoted or name not in _COMPUTING:
        return True
    shown = "\n".join([*quotes(page), *blocks(page, "python")])
    stems = [Path(word).stem for word in words if word.endswith(".h5")]
    stems = stems or [Path(word).stem for word in words if word.endswith(".toml")]
    return bool(stems) and all(re.search(rf"\b{stem}(_|\.h5)", shown) for stem in stems)


def _read(words, folder):
    """Plan what a command would compute, or read its options."""
    words = words[2:] if words[0] in _ON_ITS_OWN else words
    with chdir(folder):
        words = words[: words.index(">")] if ">" in words else words
        context = cli.commands[words[0]].make_context(words[0], [*words[1:]])
        if words[0] == "run":
            given = (context.params[name] for name in ("scene", "changes", "unset"))
            assert make_plan(options.read(*given))


def run_python(page, folder):
    """Run the Python blocks of a page as one program; its output."""
    program = "\n".join(blocks(page, "python"))
    if ".register(" not in program:
        return run_program(program, folder)
    done = subprocess.run(  # models would stay registered in this process
        ["/usr/bin/python3", "-c", program], cwd=folder, text=True, timeout=200,
        env=clean_environment() | {"PYTHONPATH": str(HOME), "OMP_NUM_THREADS": "1"},
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip
    assert done.returncode == 0, f"{page.name}: {done.stdout}"
    return done.stdout


def run_program(program, folder):
    """Run a program in this process, which saves the imports; its output."""
    said = io.StringIO()
    with chdir(folder), redirect_stdout(said), redirect_stderr(said):
        exec(compile(program, "example", "exec"), {"__name__": "__main__"})
    if plt := sys.modules.get("matplotlib.pyplot"):
        plt.close("all")
    return said.getvalue()
