"""Writes what the program itself knows: pages of commands, scenes and archives, and the scenes' schema.

``./run.sh docs`` runs it before it builds the pages; alone: ``PYTHONPATH=. python3 docs/make.py``.
mkdocs loads it as a hook, so the program is imported only where pages are made.
"""

import json
import os
import re
import runpy
from collections import Counter
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

- 0: good
- 1: the verdict is FAIL, or an archive contradicts itself
- 2: bad input: the message says which key, option or part of an archive, and what was expected
- 3: failure of program or machine, or interrupted

SIGINT (Ctrl-C), SIGTERM, SIGHUP and a killed rank end a command at once, with status 3 and one message.
`--resume` goes on with what a run has finished.

A file gets its name when it is whole. Figures, pages and tables of an archive are replaced unasked.
Scenes, archives and files that galinx did not make are replaced with `--overwrite` only. A file that the
command reads is never replaced, but for the scene of `fit --into`; `--log` only appends.

`run.sh` knows more words than the commands:

- `./run.sh test`: run all tests, those on two ranks included
- `./run.sh bench`: measure run time against error, see [Benchmarks](benchmarks.md)
- `./run.sh bench accuracy`: compute the tables of [Verification](verification.md) again
- `./run.sh docs`: write these reference pages and build all pages as HTML into `site/`
- `./run.sh -n RANKS COMMAND …`: run a command on MPI ranks of this machine, up to 16 a core

Before the command stand

- `-x FILE.py`: run a file that registers [models of your own](howto_extend.md); may be repeated
- `--version`: print the version

An installed `galinx` knows the
commands and these options, not the words above; `mpirun -n RANKS galinx COMMAND …` runs it on ranks.
"""

_SCENE = """\
# Scenes

Written by `docs/make.py` from the keys that check scenes.

A scene is a TOML file that says what to compute. The shortest one:

```toml
[solid]
material = "steel"
[friction]
mu_c = 0.5                       # dimensionless
sigma0_over_load = "25000 1/m"
[motion]
c = 0.3                          # over the shear wave speed
```

- After a key stand its unit, limits and, in brackets, its default. A number is in that unit, or
  dimensionless. A text carries its own: `"193 GPa"`, `"1.5 mm/s"`, `"7.86 g/mm^3"`, with `*`, `/` and
  whole powers `^`. `"5 %"` is 0.05. A unit of another dimension is an error.
- `c` or `speed`, `load`, `X_over_L` and the parameters of a friction law may be lists or ranges. Each
  combination is a state, numbered from 0, on all `strokes`. `c` changes most slowly, then the load, the
  law's parameters in the order of their rows, stroke, position.
- So may any other number of [solid], [[layer]], [punch], [punch.solid] and [friction]: `radius = ["2 mm",
  "5 mm"]`. All combinations come into one archive; the last number changes fastest.
- A range includes both ends, which may carry units: `{from = 0, to = 0.9, number = 10}` is 0, 0.1, … 0.9.
  With `spacing = "log"` the ratios are equal: `{from = 0.01, to = 1, number = 3, spacing = "log"}` is
  0.01, 0.1, 1.
- Each table `[[friction.vary]]` is a product of its own and takes what it leaves out from [friction].
  Here 4 laws result, since 0.5 with 25 000 /m is in both tables:

```toml
[friction]
mu_c = 0.5
sigma0_over_load = "25000 1/m"
[[friction.vary]]
mu_c = [0.1, 0.5, 0.7]
[[friction.vary]]
sigma0_over_load = ["12500 1/m", "25000 1/m"]
```

- `kind`, `profile` and `model` name a solid, a punch and a friction law, each with keys of its own.
  [Extend galinx](howto_extend.md) adds others.
- Texts are in quotes. Rows of numbers are written `[[1, 2], [3, 4]]`; a scene in a file may name a CSV
  file of them, `"rows.csv"`.
- A key may be left out unless its row says "required". An unknown key is an error.
- Results call strokes FM1, … (forward) and BM1, … (backward).
- `title`, before the sections, is shown above tables and figures.

Editors complete and check scenes by `scenes/scene.schema.json`, which `./run.sh schema` prints.
"""

_ARCHIVE = """\
# Archives

Written by `docs/make.py` from the table of quantities, `postprocess/quantities/`.

A run writes one HDF5 file. Every dataset has `units` ("1" for dimensionless) and `long_name`, every
numerical one a checksum. [Read archives](howto_read_archive.md) shows how to read them.

- METHOD is `closed_form`, `sie` (integral equation) or `fem` (finite elements).
- Brackets hold the shape, if not that of the section; the unit; NaN, if there may be no answer; after
  "with" the methods, if not all give the dataset, words of `solve.mode` and `output.quantities`, and
  what else it needs: sharp edges (punch), free ends, a pressure of your own, friction along the contact,
  finite stresses, one method, fitted speeds. Lengths without a unit are over the half-width.
- Words with a slash between them follow the order of the names in their row.
- The place of the largest or smallest value NAME is `NAME_X_over_a` along the surface and, where it may
  lie inside, `NAME_Y_over_a` outwards, over the half-width. The lists leave these out.
- A parameter of a friction law is `/states/KEY`, another swept number `/states/SECTION.KEY`, as
  `/states/solid.E`; both in the SI unit of [their row](scene.md#friction).
- [Your own quantities](howto_extend.md#a-quantity) come beside these.
"""

_WHOLE = """\
## What is read

A fault of an archive ends every command with one message and status 2.

1. The first 512 bytes, HDF5's user block, hold a SHA-256 digest of all bytes that follow. It is verified
   before HDF5 opens the file. `head -n 3 out.h5` shows it, `tail -c +513 out.h5 | sha256sum` computes it.
2. Names, types, shapes, units and attributes must be those of this page.

`check` repeats the friction, the comparisons and the verdict. Values must be in their range, and finite
unless this page, `run/failures` or `comparisons` says otherwise; a contradiction ends it with status 1.
For archives of its own version it computes again, and compares finite elements with closed forms to 1 %:

- closed forms of all states under flat punches, of 24 under other smooth ones, of 6 under those with
  kinks (of 3 where stresses are largest),
- integral equations of 4 states over layers,
- indentations, sizes of linear systems, warnings.

It does not check `run/seconds`, `run/fem`, `sigma_YY_raw`, places of largest stresses by finite elements,
stresses over layers by these alone, motions in time and of sliders.

[Versions](howto_read_archive.md#from-another-version) of the layout: archives of version 1 are not read.
"""

_ATTRIBUTES = """\
## Attributes of the root

"""

_COMPARISONS = """\
## Comparisons

The attribute `comparisons` has the largest value over all states of each comparison that was made;
`show -v` prints values and limits. The verdict is FAIL where one exceeds its limit. With T for
`solve.tolerance`, differences between methods and estimated errors are at most T, but for these:

"""


def commands_page() -> str:
    """Every command: what it does, usage, example, options; options of several commands once."""
    import click

    from galinx.app.cli import cli
    from galinx.app.console import program

    contexts = {
        name: click.Context(command, info_name=f"./run.sh {name}", help_option_names=[])
        for name, command in cli.commands.items()
    }
    options = {
        name: [
            record
            for p in cli.commands[name].params
            if isinstance(p, click.Option) and (record := p.get_help_record(context))
        ]
        for name, context in contexts.items()
    }
    counts = Counter(record for records in options.values() for record in records)
    shared = {names: text for (names, text), count in counts.items() if count > 1 and names[:2] != "-o"}
    rows = [(f"`{names}`", text) for names, text in shared.items()]
    parts = [_COMMANDS, "## Shared options\n", _list(rows)]
    for name, command in cli.commands.items():
        context = contexts[name]
        about, _, example = (command.help or "").partition("Example:")
        usage = " ".join([name, *command.collect_usage_pieces(context)])
        parts.append(f"## {name}\n\n{fill(_plain(about), 106)}\n\n`{usage}`" + ":" * bool(example) + "\n")
        if example:
            parts.append(f"    {_plain(example).replace(program(), './run.sh', 1)}\n")
        of_several = [names for names, text in options[name] if shared.get(names) == text]
        if of_several:
            words = ", ".join(f"`{names.split()[0].rstrip(',')}`" for names in of_several)
            parts.append(fill(f"[Shared options](#shared-options): {words}.", 106) + "\n")
        own = [(f"`{names}`", text) for names, text in options[name] if shared.get(names) != text]
        if own:
            parts.append(_list(own))
    return "\n".join(parts)


def scene_page() -> str:
    """Every section and key of a scene, and the known materials."""
    from galinx.app.scene.library import LIBRARY
    from galinx.app.scene.sections import SECTIONS

    parts = [_SCENE]
    for name, section in SECTIONS.items():
        heading = f"[[{name}]]" if name == "layer" else f"[{name}]"
        parts += [f"## {heading}\n", *_section(section)]
    parts.append("## Materials\n\n`./run.sh materials` prints their constants and sources.\n")
    about = {name: solid.about.replace(";", ",").partition(",")[0] for name, solid in LIBRARY.items()}
    parts.append("".join(f"- `{name}`: {words}\n" for name, words in about.items()))
    return "\n".join(parts)


#: Values of attributes that go without saying.
_PLAIN_VALUES = "a text", "a number", "a finite number", "true"


def archive_page() -> str:
    """Every attribute and dataset of an archive, and every comparison."""
    from galinx.postprocess.compare import RULES
    from galinx.postprocess.quantities import table
    from galinx.postprocess.schema import ATTRIBUTES

    parts, known = [_ARCHIVE, _WHOLE], table()
    told = [
        (f"`{name}`", row.about + f" [{row.expected}]" * (row.expected not in _PLAIN_VALUES))
        for name, row in ATTRIBUTES.items()
    ]
    parts.append(_ATTRIBUTES + _list(told))
    for group in dict.fromkeys(path.partition("/")[0] for path in ("scene/text", *known)):
        rows = [
            row
            for path, row in known.items()
            if path.startswith(f"{group}/")
            and not _laws(row)
            and not _place(path, known)
            and "." not in path  # a swept number of another section
        ]
        (word, *others) = {row.asked_by for row in rows}
        (over, count), *_ = Counter(" × ".join(row.over) for row in rows).most_common()
        given, often = _usual_methods(rows)
        told = [f"With `{word}` among `output.quantities`."] * bool(word and not others)
        told += [f"Shape: {over}."] * (count > 1)
        told += [f"METHOD is {' or '.join(given)}, if not said otherwise."] * often
        table = _list(_datasets(rows, bool(others), over, given))
        parts += filter(None, (f"## /{group}\n", " ".join(told) + "\n" * bool(told), table))
    rules: dict[str, list[str]] = {}
    for rule in RULES.values():
        rules.setdefault(_limit(rule), []).append(rule.text.partition(", ")[0])
    parts.append(_COMPARISONS.rstrip("\n") + "\n")
    others = [(limit, "; ".join(dict.fromkeys(_both(texts)))) for limit, texts in rules.items()]
    parts.append("".join(f"- {limit}: {texts}\n" for limit, texts in others if limit != "at most T"))
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
    """The keys of a section; where it describes a model, then those of the models."""
    from galinx.app.scene.sections import SECTIONS
    from galinx.registry import Registry
    from galinx.solvers.parameters import parameters

    def rows(keys: dict[str, Any]) -> list[tuple[str, ...]]:
        return [_row(key, known) for key, known in keys.items()]

    alternatives = section.alternatives
    if "" in alternatives:
        return [_list(rows(alternatives[""]))]
    keys = next(iter(alternatives.values()))
    chosen, models = next(
        (key, known.kind.options)
        for key, known in keys.items()
        if isinstance(getattr(known.kind, "options", None), Registry)
    )
    own = {model: parameters(models[model]).keys() for model in alternatives}
    first = own[next(iter(own))]
    common = {k: known for k, known in keys.items() if k not in first and not known.stands_for}
    if section is SECTIONS["layer"] or section is SECTIONS["punch.solid"]:
        same = common.keys() & next(iter(SECTIONS["solid"].alternatives.values())).keys()
        words = ", ".join(f"`{key}`" for key in common if key in same)
        constants = f"{words} and constants are those of [[solid]](#solid); required{section.or_else}.\n"
        return [constants, _list(rows({k: v for k, v in common.items() if k not in same}))]
    parts = [_list(rows(common))]
    merged: dict[tuple[str, ...], list[str]] = {}
    for model, keys in alternatives.items():
        for row in rows({k: v for k, v in keys.items() if k in own[model] or v.stands_for}):
            merged.setdefault(row, []).append(f"`{model}`")
    shared = [
        (row[0], "" if len(of) == len(alternatives) else "of " + ", ".join(of), *row[1:])
        for row, of in merged.items()
    ]
    abouts = {model: models[model].about for model in alternatives}
    if section is SECTIONS["friction"]:
        named = "[Friction laws](howto_friction.md#which-law) says what each is for. "
    else:
        named = "".join(f"`{model}`: {about}. " for model, about in abouts.items() if about != model)
    if section is SECTIONS["solid"]:
        named += "A `material` gives what is required. "
    shared = [(", ".join(f"`{key}`" for key in keys), *rest, about) for keys, about, rest in _merged(
        [([key.strip("`")], about, tuple(rest)) for key, *rest, about in shared]
    )]  # fmt: skip
    return [
        *parts,
        f"{named}Keys of each `{chosen}`:\n",
        _list(shared),
    ]


def _row(key: str, known: Any) -> tuple[str, ...]:
    """A key's row: name; kind of value, limits and default; meaning."""
    from galinx.app.scene.library import LIBRARY
    from galinx.app.scene.sections import REQUIRED, entry

    described = entry(known)
    if known.default is REQUIRED:
        default = "required"
    elif "default" in described:
        empty = described["default"] == []
        default = known.without if empty else f"`{json.dumps(described['default'], ensure_ascii=False)}`"
    else:
        default = known.without
    default = f" ({default})" if default not in ("", "none") else ""
    of_library = getattr(known.kind, "options", None) is LIBRARY
    allowed = "[materials](#materials)" if of_library else _allowed(described)
    meaning = "; ".join(filter(None, (known.about, known.note)))
    value = _value(known.kind)
    plain = value == "a text" or (value == "number" and bool(allowed))
    values = ", ".join(filter(None, ("" if plain else value.replace("number [", "["), allowed)))
    return f"`{key}`", values + default, meaning


def _laws(row: Any) -> list[str]:
    """Friction laws of which a dataset is a parameter."""
    from galinx.solvers.friction import LAWS
    from galinx.solvers.parameters import parameters

    name = row.path.rpartition("/")[2]
    return [law for law, model in LAWS.items() if row.symbol and name in parameters(model)]


def _place(path: str, known: dict[str, Any]) -> bool:
    """Whether a dataset is the place of the largest or smallest value that another one holds."""
    ends = ("_X_over_a", "_Y_over_a")
    return any(path.endswith(end) and path.removesuffix(end) in known for end in ends)


def _both(texts: list[str]) -> list[str]:
    """Comparisons; two that differ in their being made with the integral equation are one text."""
    against = " against the integral equation"
    shorter = {text.replace(against, "") for text in texts if against in text}
    return [
        text.replace(against, f" [{against.strip()}]") if text.replace(against, "") in texts else text
        for text in texts
        if against in text or text not in shorter
    ]


def _method(row: Any) -> str:
    """Method that gives a dataset; "" where the run does."""
    from galinx.app.methods import METHODS

    return row.method or next((part for part in row.path.split("/") if part in METHODS), "")


def _names(paths: list[str]) -> list[str]:
    """Paths, without the folder where the one before has the same."""
    pairs = zip([None, *(path.rpartition("/")[0] for path in paths)], paths, strict=False)
    return [path.rpartition("/")[2] if path.rpartition("/")[0] == last else path for last, path in pairs]


def _usual_methods(rows: list[Any]) -> tuple[list[str], bool]:
    """Methods that give most datasets of a section, none if all give some; whether there are any."""
    from galinx.postprocess.quantities.quantity import METHODS

    of_path: dict[str, list[str]] = {}
    for row in rows:
        method = _method(row)
        of_path.setdefault(row.path.replace(f"/{method}/", "/METHOD/"), []).append(f"`{method}`")
    counts = Counter(tuple(methods) for methods in of_path.values() if len(methods) > 1)
    if len(counts) == 0 or any(len(methods) == len(METHODS) for methods in counts):
        return [], False
    return list(counts.most_common(1)[0][0]), True


def _datasets(rows: list[Any], asked: bool, usual: str, given: list[str]) -> list[tuple[str, ...]]:
    """Rows of datasets: one for all methods, and for those whose meanings differ in a word.

    ``asked``: with the word of output.quantities that asks for them; ``usual``: shape, and ``given``:
    methods, that are left out.
    """
    from galinx.app.methods import MODES
    from galinx.postprocess.quantities.quantity import (
        ANYWHERE,
        METHODS,
        NUMBER,
        OVER_A,
        TEXT,
        WHOLE,
        X_OVER_A,
    )  # fmt: skip

    kinds = {TEXT: "text", WHOLE: "whole", NUMBER: ""}
    of_methods: dict[str, list[Any]] = {}
    for row in rows:
        path = row.path.replace(f"/{_method(row)}/", "/METHOD/")
        of_methods.setdefault(path, []).append(row)
    table: list[tuple[list[str], str, tuple[str, ...]]] = []
    for path, same in of_methods.items():
        row, methods = same[0], [_method(r) for r in same]
        if len(same) == 1:
            path = row.path
        nan = any(r.nan_allowed == ANYWHERE for r in same)
        over, unit = " × ".join(row.over), row.unit if row.unit not in ("none", "1") else ""
        values = (over if over != usual else "", kinds[row.type], unit, "NaN" * nan)
        words = [f"`{m}`" for m in methods if len(same) > 1]
        if len(same) == len(METHODS) or words == given:
            words = []
        # Modes of the scene are code; others are words, of which one is an older name.
        words += [f"`{row.mode}`" if row.mode in MODES else row.mode.replace("found", "free")]
        words += [f"`{row.asked_by}`"] * bool(row.asked_by and asked)
        needs = ", ".join(filter(None, words))
        rest = (", ".join(filter(None, (*values, f"with {needs}" * bool(needs)))),)
        # Of lengths the page says once what they are over.
        lengths = row.unit == "1" and row.scale in (OVER_A, X_OVER_A)
        abouts = [re.sub(r",? over the half-width", "", r.about) if lengths else r.about for r in same]
        for said in METHODS.values():
            abouts = [about.removesuffix(f", {said}") for about in abouts]
        table.append(([f"/{path}"], _common(abouts), rest))
    return [
        (", ".join(f"`{name}`" for name in _names(p)), about + f" [{rest}]" * bool(rest))
        for p, about, (rest,) in _merged(table)
    ]


def _common(abouts: list[str]) -> str:
    """What the meanings of a dataset by several methods have in common; all of them where they differ."""
    first, *others = ([part.partition(" (Eq")[0] for part in about.split(", ")] for about in abouts)
    shared = [part for part in first if all(part in other for other in others)]
    return ", ".join(shared) if shared[:1] == first[:1] and others else "; ".join(dict.fromkeys(abouts))


def _merged(table: list[Any]) -> list[Any]:
    """Rows with those that differ in a word of their meaning made one, as long as there are any."""
    for i, (paths, about, rest) in enumerate(table):
        for k in range(i + 1, len(table)):
            more, other, same = table[k]
            if same == rest and (both := _joined(about, other)):
                return _merged(
                    [*table[:i], (paths + more, both, rest), *table[i + 1 : k], *table[k + 1 :]]
                )
    return table


def _joined(one: str, other: str) -> str:
    """Two texts that differ in one word, written once with both words; "" for others."""
    words, others = one.split(), other.split()
    differ = [i for i, pair in enumerate(zip(words, others, strict=False)) if pair[0] != pair[1]]
    if len(words) != len(others) or len(differ) != 1:
        return ""
    (i,) = differ
    words[i] = f"{words[i].rstrip(',')}/{others[i]}"
    return " ".join(words)


def _limit(rule: Any) -> str:
    """Largest value of a PASS."""
    if rule.tolerances is not None:
        limit = "T" if rule.tolerances == 1.0 else f"{rule.tolerances:g} T"
        if rule.limit is not None:
            limit = f"{limit} and {rule.limit:g}" if rule.limit else "0"
    elif rule.limit is None:
        limit = "shown only"
    else:
        limit = f"{rule.limit:g}"
    limit = limit if limit == "shown only" else f"at most {limit}"
    return limit + f", mode `{rule.mode}`" * bool(rule.mode)


def _value(kind: Any) -> str:
    """What kind of value a key wants."""
    if word := getattr(kind, "word", ""):
        return f'`"{word}"` or {_value(kind.kind)}'
    if about := getattr(kind, "about", ""):
        return about
    kind = getattr(kind, "kind", kind)  # of each number of a list
    text = _plain(type(kind).__doc__ or "").replace("``", "`").rstrip(".")
    unit = getattr(kind, "unit", None)
    text = text.partition(", as [[")[0]  # of rows, which the page describes once
    if unit is not None:
        return f"number{f' [{unit}]' * bool(unit)}"
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


def _list(rows: list[tuple[str, ...]]) -> str:
    """A list with a line for each row, whose last column is what the others mean."""
    return "".join(f"- {', '.join(filter(None, row[:-1]))}: {row[-1]}\n" for row in rows)


if __name__ == "__main__":
    from galinx import files

    for path, text in pages().items():
        files.write(path, text.encode())
        print(f"written: {path.relative_to(HOME)}")
