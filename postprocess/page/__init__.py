"""Self-contained HTML pages: nothing is loaded from elsewhere.

Symbols and numbers as a page shows them.
"""

import re
from pathlib import Path
from typing import Any
from unicodedata import normalize

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup, escape

from ..figures.style import plain

#: Names of stresses, factors and coefficients, as archives, verdicts and figures write them.
_INDEXED = re.compile(r"\b(K|N|F|P|c|v|μ|σ|sigma|κ|δ)_([A-Za-z0-9]{1,3})\b")
_POWER = re.compile(r"(?<![\w.])(-?\d(?:\.\d+)?)e([+-]\d+)\b")
#: As plain text has it.
_RAISED = re.compile(" × 10([⁻⁰¹²³⁴-⁹]+)")


def markup(text: str) -> Markup:
    """A text with its symbols set: K_I, σ_XX, ``$\\mu_C$`` and 4.8e-07 with indices and powers.

    Whatever else the text holds is escaped.
    """
    told = str(escape(plain(text))).replace("sigma_", "σ_")
    told = _RAISED.sub(lambda found: f"&#8239;×&#8239;10<sup>{normalize('NFKC', found[1])}</sup>", told)
    told = _INDEXED.sub(r"<i>\1</i><sub>\2</sub>", told)
    return Markup(
        _POWER.sub(lambda found: f"{found[1]}&#8239;×&#8239;10<sup>{_power(found[2])}</sup>", told)
    )


def _power(digits: str) -> str:
    return str(int(digits)).replace("-", "−")


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
