"""Symbols and numbers as a page shows them."""

import re
import unicodedata

from markupsafe import Markup, escape

#: Names of stresses, factors and coefficients, as archives, verdicts and figures write them.
_INDEXED = re.compile(r"\b(K|N|F|P|c|v|μ|σ|sigma|κ|δ)_([A-Za-z0-9]{1,3})\b")
_POWER = re.compile(r"(?<![\w.])(-?\d(?:\.\d+)?)e([+-]\d+)\b")
_LOWERED = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
_TEX = re.compile(r"\$([^$]*)\$")


def markup(text: str) -> Markup:
    """A text with its symbols set: K_I, σ_XX, ``$\\mu_C$`` and 4.8e-07 with indices and powers.

    Whatever else the text holds is escaped.
    """
    told = str(escape(plain(text))).replace("sigma_", "σ_")
    told = _INDEXED.sub(r"<i>\1</i><sub>\2</sub>", told)
    return Markup(
        _POWER.sub(lambda found: f"{found[1]}&#8239;×&#8239;10<sup>{_power(found[2])}</sup>", told)
    )


def plain(text: str) -> str:
    """A text whose formulas are without TeX."""
    return _TEX.sub(lambda found: _untexed(found[1]), text)


def _power(digits: str) -> str:
    return str(int(digits)).replace("-", "−")


def _untexed(formula: str) -> str:
    """TeX as the symbols it stands for; indices stay behind underscores."""
    told = re.sub(r"\\math\w+\{([^{}]*)\}", r"\1", formula)
    told = re.sub(r"\\times\s*10\^\{?(-?\d+)\}?", r"e+\1", told).replace(" e+", "e+").replace("e+-", "e-")
    told = re.sub(r"\\([A-Za-z]+)", _greek, told.replace(r"\,", " ").replace(r"\_", "_"))
    return re.sub(r"_(\d)", lambda found: found[1].translate(_LOWERED), re.sub(r"[{}]", "", told))


def _greek(word: re.Match[str]) -> str:
    kind = "CAPITAL" if word[1][0].isupper() else "SMALL"
    try:
        return unicodedata.lookup(f"GREEK {kind} LETTER {word[1].upper()}").replace("µ", "μ")
    except KeyError:
        return word[1]
