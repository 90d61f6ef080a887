"""Self-contained HTML pages: nothing is loaded from elsewhere."""

from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from galinx.postprocess.page.symbols import markup


def render(content: dict[str, Any]) -> str:
    """The report page ``page.html`` filled with its content.

    Raises:
        jinja2.UndefinedError: something that the page shows is missing.
    """
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent), autoescape=True, undefined=StrictUndefined
    )
    environment.filters["typeset"] = markup
    return environment.get_template("page.html").render(content)
