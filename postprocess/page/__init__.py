"""HTML pages, self-contained: nothing is loaded from elsewhere, and symbols and numbers are typeset."""

import re
from base64 import b64encode
from functools import cache
from gzip import compress
from importlib.util import find_spec
from pathlib import Path
from typing import Any
from unicodedata import normalize

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup, escape

from galinx.texts import plain

#: Names of stresses, factors and coefficients, as archives, verdicts and figures write them.
_INDEXED = re.compile(r"\b(K|N|F|P|c|v|μ|σ|sigma|κ|δ)_([A-Za-z0-9]{1,3})\b")
_POWER = re.compile(r"(?<![\w.])(-?\d(?:\.\d+)?)e([+-]\d+)\b")
#: Powers of ten as plain text writes them.
_RAISED = re.compile(" × 10([⁻⁰¹²³⁴-⁹]+)")


def markup(text: str) -> Markup:
    """Markup of a text with its symbols set: K_I, σ_XX, ``$\\mu_C$`` and 4.8e-07 with indices and powers.

    Whatever else the text holds is escaped.
    """
    page = str(escape(plain(text))).replace("sigma_", "σ_")
    page = _RAISED.sub(lambda power: f"&#8239;×&#8239;10<sup>{normalize('NFKC', power[1])}</sup>", page)
    page = _INDEXED.sub(r"<i>\1</i><sub>\2</sub>", page)
    return Markup(
        _POWER.sub(lambda power: f"{power[1]}&#8239;×&#8239;10<sup>{_power(power[2])}</sup>", page)
    )


def _power(digits: str) -> str:
    return str(int(digits)).replace("-", "−")


def render(content: dict[str, Any]) -> str:
    """Report page ``page.html`` filled with its content.

    Raises:
        jinja2.UndefinedError: something that the page shows is missing.
    """
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent), autoescape=True, undefined=StrictUndefined
    )
    environment.filters["typeset"] = markup
    return environment.get_template("page.html").render(content | {"plotly": _plotly()})


#: plotly.js beside its Python package: of Debian, and of PyPI.
_SCRIPTS = ("/usr/share/python3-plotly/plotly.js", "package_data/plotly.min.js")


@cache
def _plotly() -> str:
    """plotly.js, compressed, as text; browsers unpack it."""
    spec = find_spec("plotly")
    folder = Path(spec.origin).parent if spec and spec.origin else Path()
    path = next(path for path in (folder / name for name in reversed(_SCRIPTS)) if path.is_file())
    return b64encode(compress(path.read_bytes(), 9, mtime=0)).decode()
