"""Source files that pages link to, as pages of the site, with an anchor at each name that is linked to.

In the tree such a link, `` [`Class.name`](../room/file.py) ``, leads to the file. mkdocs loads this file
as a hook.
"""

import ast
import re
from html import escape
from pathlib import Path
from typing import Any

HOME = Path(__file__).resolve().parent.parent

#: A link to a source file, by the name that is meant in it.
LINK = re.compile(r"\[`([\w.]+)`\]\(\.\./([\w/]+)\.py\)")

_PAGE = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title>
<meta name="viewport" content="width=device-width">
<style>body {{margin: 1em}} :target {{background: #fe9}}</style></head>
<body><h1>{title}</h1><pre>{lines}</pre></body></html>
"""

_linked: set[str] = set()


def names(text: str) -> dict[str, int]:
    """Lines, from 1, of what a program names: functions, classes, and of these methods and fields."""
    lines: dict[str, int] = {}

    def look(body: list[ast.stmt], before: str) -> None:
        for node in body:
            if isinstance(node, ast.FunctionDef | ast.ClassDef):
                lines[before + node.name] = node.lineno
            if isinstance(node, ast.ClassDef):
                look(node.body, f"{before}{node.name}.")
            targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
            lines.update(
                {before + name.id: node.lineno for name in targets if isinstance(name, ast.Name)}
            )

    look(ast.parse(text).body, "")
    return lines


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """Links to source files lead to their pages in the site."""
    up = "../" * page.url.count("/")

    def link(match: re.Match[str]) -> str:
        _linked.add(match[2])
        name = match[1].replace("_", "_<wbr>")
        return f'<a href="{up}source/{match[2]}.html#{match[1]}"><code>{name}</code></a>'

    return LINK.sub(link, markdown)


def on_post_build(config: Any, **_: Any) -> None:
    """Write the pages of the files that are linked to."""
    for file in _linked:
        text = (HOME / f"{file}.py").read_text(encoding="utf-8")
        lines = [escape(line) for line in text.splitlines()]
        for name, line in names(text).items():
            lines[line - 1] = f'<span id="{name}">{lines[line - 1]}</span>'
        target = Path(config["site_dir"]) / "source" / f"{file}.html"
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(_PAGE.format(title=f"{file}.py", lines="\n".join(lines)), encoding="utf-8")
