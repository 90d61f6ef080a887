"""Writes what the program itself knows: pages of commands, scenes and archives, and the scenes' schema.

``./run.sh docs`` runs it before it builds the pages; alone: ``PYTHONPATH=. python3 docs/make.py``.
mkdocs loads it as a hook, so the program is imported only where pages are made.
"""

import json
import os
import runpy
from pathlib import Path
from textwrap import fill
from typing import Any

HOME = Path(__file__).resolve().parent.parent

# Pages name the command as it is called in the tree.
os.environ["GALINX_COMMAND"] = "./run.sh"

_COMMANDS = """\
# Commands

Written by `docs/make.py` from the program; `./run.sh COMMAND --help`, or `-h`, prints the same.

`./run.sh` without a command reproduces the study, like `./run.sh paper -o results`. Paths are relative to
the folder you are in. Exit status:

| status | meaning |
|---|---|
| 0 | good |
| 1 | the verdict is FAIL, or an archive contradicts itself |
| 2 | bad input: the message says which key, option or part of an archive, and what was expected |
| 3 | failure of program or machine, or interrupted |

SIGINT (Ctrl-C), SIGTERM and SIGHUP end a command at once, with status 3 and one message, whichever of
several processes they reach; so does a rank that is killed. What a run has finished is kept for
`--resume`. Signals that were ignored when the command was started, as by `nohup`, stay ignored.

A file appears under its name when it is whole. What is made from an archive is made again unasked; what
galinx did not make, scenes and archives are replaced with `--overwrite` only. Files that a command reads,
folders, devices and FIFOs never are, links are followed, and `--log` adds to logs only.

Words that `run.sh` knows besides the commands:

| word | what it does |
|---|---|
| `./run.sh test` | run all tests, those on two ranks included |
| `./run.sh bench` | measure run time against error, see [Benchmarks](benchmarks.md) |
| `./run.sh bench accuracy` | compute the tables of [Verification](verification.md) again |
| `./run.sh docs` | write these reference pages and build all pages as HTML into `site/` |
| `./run.sh -n RANKS COMMAND …` | run a command on MPI ranks of this machine, up to 16 a core |

Before the command stand

| option | meaning |
|---|---|
| `-x FILE.py` | run a file that registers [models of your own](howto_extend.md); may be repeated |
| `--version` | print the version |

With the folder `bin` on `PATH` the same command is called `galinx`. An installed `galinx` knows the
commands and these options, not the words above; `mpirun -n RANKS galinx COMMAND …` runs it on ranks.
"""

_SCENE = """\
# Scenes

Written by `docs/make.py` from the keys that check scenes.

A scene is a TOML file that says what is to be computed. The shortest one:

```toml
[solid]
material = "steel"
[friction]
mu_c = 0.5                       # dimensionless
sigma0_over_load = "25000 1/m"
[motion]
c = 0.3                          # over the shear wave speed
```

- A number is in the unit of its row. A text carries its own unit: `"193 GPa"`, `"1 mm"`, `"1.5 mm/s"`: a
  number, then units with `*`, `/` and whole powers `^` between them, as in `"7.86 g/mm^3"` and
  `"25000 1/m"`. A unit of another dimension is an error; degrees, counts and bits are no numbers, and
  `"5 %"` is 0.05.
- `c` or `speed`, and the parameters of the friction law, may be lists or ranges. All their combinations
  are computed, each on all `strokes` at all `X_over_L`. Every combination is a state. States are numbered
  from 0; `c` changes most slowly, then the law's parameters in the order of their rows, stroke, position.
- Tables `[[friction.vary]]` stand for a sum of such products: the lists of each are combined with each
  other and with what [friction] says of the other parameters, and not with those of the next. Here μ_C is
  varied, then σ₀l/N, in 4 laws, since that of 0.5 and 25 000 /m is in both:

```toml
[friction]
mu_c = 0.5
sigma0_over_load = "25000 1/m"
[[friction.vary]]
mu_c = [0.1, 0.5, 0.7]
[[friction.vary]]
sigma0_over_load = ["12500 1/m", "25000 1/m"]
```

- A range stands where a list may: `c = {from = 0, to = 0.9, number = 10}` is 0, 0.1, … 0.9. Both ends
  belong to it and may carry units. `spacing = "log"` makes ratios equal instead of differences: `mu_c =
  {from = 0.01, to = 1, number = 3, spacing = "log"}` is 0.01, 0.1, 1.
- `kind`, `profile` and `model` name a solid, a punch and a friction law, each with keys of its own.
  [Extend galinx](howto_extend.md) adds others.
- A key that the program does not know is an error, with the nearest known key in the message.
- Strokes are called FM1, FM2, … (forward) and BM1, BM2, … (backward) in results.

Editors that read JSON schemas for TOML complete and check scenes by `scenes/scene.schema.json`, the
output of `./run.sh schema`. The first line of the scenes in `scenes/` names it.

`title` stands before the sections: free text, shown above tables and figures.
"""

_ARCHIVE = """\
# Archives

Written by `docs/make.py` from the table of quantities, `postprocess/quantities/`.

One HDF5 file a run. It appears under its name only when it is whole: it is written beside it, read back,
compared, sealed and renamed. Every numerical dataset carries a checksum, every dataset `units` ("1" for
dimensionless) and `long_name`. An archive, and how to read it in Python:

    ./run.sh run scenes/tables4_5.toml -o out.h5

```python
import h5py

with h5py.File("out.h5") as file:
    K_I = file["states/fem/K_I_right"][()]
    motion = file["states/motion"].asstr()[()]
```

Other ways are in [Read archives](howto_read_archive.md).

Datasets that nothing asks for are absent; the column "there with" says what does: a name of
`solve.methods`, `solve.mode` or `friction.model`, or a word of `output.quantities`. The column "compared"
names rows of [Comparisons](#comparisons). Quantities of your own come beside these, see
[Extend galinx](howto_extend.md).
"""

_WHOLE = """\
## What is read

Every command reads archives through one door, `postprocess/hdf5/archive.py`. What does not come through
is not shown: one message names the fault, exit status 2.

1. The first 512 bytes, HDF5's user block, hold a SHA-256 digest of all bytes that follow: numbers,
   texts, names, units, attributes. It is verified before HDF5 opens the file. By hand: `head -n 3
   out.h5` shows it, `tail -c +513 out.h5 | sha256sum` gives it.
2. Names, types, shapes, units and ranges are held against the tables of this page, texts and JSON of
   attributes against theirs. Sizes that go by the same word are the same everywhere, and no number is
   NaN or infinite but where this page allows it, or where `run/failures` or `comparisons` tell of it.

`check` goes on: friction is followed once more, what was compared is compared again, the verdict judged
again; of its own version it also knows which datasets the scene asks for, and computes again what is
cheap: closed forms of all states under flat punches, of 24 under other smooth ones and of 6 under those
with kinks (of 3 where stresses are largest), integral equations of 4 states over layers, indentations,
sizes of linear systems, warnings. Finite elements are held against closed forms to 1 %, whether or not
the scene asks for both. Not covered are `run/seconds` and what `run/fem` says of solves, `sigma_YY_raw`,
places of largest stresses by finite elements, stresses over layers by these alone, motions in time and of
sliders. What contradicts that is a fault, exit status 1. Who changes numbers so that they fit each other
and the schema, and makes the
digest again, has made another archive.

Archives of schema version 1 had no digest and are not read. Those of version 2 do not tell of their solid
and its speeds.
"""

_ATTRIBUTES = """\
## Attributes of the root

"""

_COMPARISONS = """\
## Comparisons

What is held against what, a number each: the attribute `comparisons` has the largest over all states by
its text; the verdict is FAIL where one exceeds its limit. T is `solve.tolerance`.

"""


def commands_page() -> str:
    """Every command: what it does, usage, example, options."""
    import click

    from galinx.app.cli import cli
    from galinx.app.console import program

    parts = [_COMMANDS]
    for name, command in cli.commands.items():
        context = click.Context(command, info_name=f"./run.sh {name}", help_option_names=[])
        about, _, example = (command.help or "").partition("Example:")
        usage = " ".join([context.info_name or "", *command.collect_usage_pieces(context)])
        options = (p for p in command.params if isinstance(p, click.Option))
        rows = [record for p in options if (record := p.get_help_record(context))]
        parts.append(f"## {name}\n\n{fill(_plain(about), 106)}\n\nUsage: `{usage}`\n")
        if example:
            shown = _plain(example).replace(program(), "./run.sh", 1)
            parts.append(f"Example:\n\n    {shown}\n")
        if rows:
            parts.append(_table(("option", "meaning"), [(f"`{names}`", text) for names, text in rows]))
    return "\n".join(parts)


def scene_page() -> str:
    """Every section and key of a scene, and the known materials."""
    from galinx.app.scene.library import LIBRARY
    from galinx.app.scene.sections import SECTIONS

    parts = [_SCENE]
    for name, section in SECTIONS.items():
        parts += [f"## {section.heading.format(name)}\n", *_section(section)]
    parts.append("## Materials\n\nNames for `solid.material`; `./run.sh materials` prints them.\n")
    rows = [
        (
            f"`{n}`",
            m.about,
            f"`{m.kind}`",
            m.told,
            m.source,
            m.yield_strength or "–",
            m.yield_source or "–",
        )
        for n, m in LIBRARY.items()
    ]
    heads = ("name", "solid", "kind", "constants", "source", "yield strength", "its source")
    parts.append(_table(heads, rows))
    return "\n".join(parts)


def archive_page() -> str:
    """Every attribute and dataset of an archive, and every comparison."""
    from galinx.postprocess.quantities import table
    from galinx.postprocess.schema import ATTRIBUTES, RULES

    parts, known = [_ARCHIVE, _WHOLE], table()
    told = [(f"`{name}`", row.about, row.expected) for name, row in ATTRIBUTES.items()]
    parts.append(_ATTRIBUTES + _table(("attribute", "what", "value"), told))
    for group in dict.fromkeys(path.partition("/")[0] for path in ("scene/text", *known)):
        rows = [_dataset(path, row) for path, row in known.items() if path.startswith(f"{group}/")]
        heads = ("dataset", "what", "shape", "unit", "values", "there with", "compared")
        parts += [f"## /{group}\n", _table(heads, rows)]
    rules = [
        (name, rule.text, ", ".join(f"`{row.path}`" for row in rule.needs), _limit(rule))
        for name, rule in RULES.items()
    ]
    parts.append(_COMPARISONS + _table(("name", "text", "datasets", "at most"), rules))
    return "\n".join(parts)


def schema_text() -> str:
    """The JSON schema of scenes as ``./run.sh schema`` prints it."""
    from galinx.app.scene.sections import schema

    return json.dumps(schema(), ensure_ascii=False, indent=1) + "\n"


def pages() -> dict[Path, str]:
    """All files that are made, and their text."""
    return {
        HOME / "docs" / "archive.md": archive_page(),
        HOME / "docs" / "commands.md": commands_page(),
        HOME / "docs" / "gallery.md": runpy.run_path(str(HOME / "docs" / "gallery.py"))["page"](),
        HOME / "docs" / "scene.md": scene_page(),
        HOME / "scenes" / "scene.schema.json": schema_text(),
    }


def on_files(files: Any, **_: Any) -> Any:
    """For mkdocs: the site holds pages, pictures and the notebook, no programs."""
    for file in list(files):
        if file.src_path.endswith((".py", ".pyc")):
            files.remove(file)
    return files


def _section(section: Any) -> list[str]:
    """The keys of a section; where it describes a model, then those of each model."""
    from galinx.registry import Registry
    from galinx.solvers.parameters import parameters

    heads = ("key", "value", "default", "allowed", "meaning")

    def rows(keys: dict[str, Any]) -> list[tuple[str, ...]]:
        return [_row(key, known, section.or_else) for key, known in keys.items()]

    alternatives = section.alternatives
    if "" in alternatives:
        return [_table(heads, rows(alternatives[""]))]
    keys = next(iter(alternatives.values()))
    chosen, models = next(
        (key, known.kind.options)
        for key, known in keys.items()
        if isinstance(getattr(known.kind, "options", None), Registry)
    )
    own = {model: parameters(models[model]).keys() for model in alternatives}
    first = own[next(iter(own))]
    common = {k: known for k, known in keys.items() if k not in first and not known.stands_for}
    parts = [_table(heads, rows(common))]
    for model, keys in alternatives.items():
        of_model = {k: known for k, known in keys.items() if k in own[model] or known.stands_for}
        about = models[model].about
        what = f", {about}" * (about != model)
        parts += [f'With `{chosen} = "{model}"`{what}:\n', _table(heads, rows(of_model))]
    return parts


def _row(key: str, known: Any, or_else: str) -> tuple[str, ...]:
    """A key's row; ``or_else`` is what else would do where it is missing."""
    from galinx.app.scene.sections import REQUIRED, entry

    described = entry(known)
    if known.default is REQUIRED:
        default = f"required{or_else}"
    elif "default" in described:
        empty = described["default"] == []
        default = known.without if empty else f"`{json.dumps(described['default'], ensure_ascii=False)}`"
    else:
        default = known.without
    meaning = "; ".join(filter(None, (known.about, known.note)))
    return f"`{key}`", _value(known.kind), default, _allowed(described), meaning


def _dataset(path: str, row: Any) -> tuple[str, ...]:
    """A dataset's row."""
    from galinx.postprocess.quantities.quantity import ANYWHERE, NUMBER, TEXT, WHOLE
    from galinx.postprocess.schema import RULES

    what = row.about + "; tells states apart" * bool(row.symbol)
    what += "; NaN where it cannot be told" * (row.nan_allowed == ANYWHERE)
    compared = ", ".join(name for name, rule in RULES.items() if row in rule.needs)
    shape, unit = " × ".join(row.over), row.unit.replace("none", "")
    kinds = {TEXT: "text", WHOLE: "whole", NUMBER: ""}
    values = " ".join(filter(None, (kinds[row.type], str(row.range))))
    return f"`/{path}`", what, shape, unit, values, _there(row), compared


def _there(row: Any) -> str:
    """What a dataset is there with; nothing where it always is."""
    from galinx.app.methods import METHODS
    from galinx.postprocess.quantities.quantity import LOCAL
    from galinx.solvers.friction import LAWS
    from galinx.solvers.parameters import parameters

    name = row.path.rpartition("/")[2]
    laws = [law for law, model in LAWS.items() if row.symbol and name in parameters(model)]
    method = row.method or next((part for part in row.path.split("/") if part in METHODS), "")
    method = "any method" if method == LOCAL else method and f"`{method}`"
    words = [method, *(f"`{word}`" for word in (row.mode, row.asked_by, *laws) if word)]
    return ", ".join(filter(None, words)) or "every run"


def _limit(rule: Any) -> str:
    """Largest value of a PASS."""
    if rule.tolerances is not None:
        limit = "T" if rule.tolerances == 1.0 else f"{rule.tolerances:g} T"
    else:
        limit = "told only" if rule.limit is None else f"{rule.limit:g}"
    return limit + f", mode `{rule.mode}`" * bool(rule.mode)


def _value(kind: Any) -> str:
    """What kind of value a key wants."""
    kind = getattr(kind, "kind", kind)  # of a value that all laws share
    text = _plain(type(kind).__doc__ or "").replace("``", "`").rstrip(".")
    unit = getattr(kind, "unit", None)
    if unit is not None:
        several = ", a list or a range" if type(kind).__name__ == "Numbers" else ""
        return f"number [{unit or 'dimensionless'}]{several}"
    return text[0].lower() + text[1:] if text[:2] != "`{" else text


def _allowed(described: Any) -> str:
    """The limits in an entry of the schema, wherever they stand."""
    signs = {"exclusiveMinimum": ">", "minimum": ">=", "exclusiveMaximum": "<", "maximum": "<="}
    if isinstance(described, list):
        return next(filter(None, map(_allowed, described)), "")
    if not isinstance(described, dict):
        return ""
    if "enum" in described:
        return ", ".join(f'`"{value}"`' for value in described["enum"])
    limits = [f"{sign} {described[key]:g}" for key, sign in signs.items() if key in described]
    inner = (value for key, value in described.items() if key in ("anyOf", "items"))
    return ", ".join(limits) or next(filter(None, map(_allowed, inner)), "")


def _plain(text: str) -> str:
    return " ".join(text.split())


def _table(heads: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    lines = [heads, ("---",) * len(heads)] + [[c.replace("|", "\\|") for c in row] for row in rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


if __name__ == "__main__":
    from galinx import files

    for path, text in pages().items():
        files.write(path, text.encode())
        print(f"written: {path.relative_to(HOME)}")
