"""Keys and sections that a scene has twice, which TOML's reader refuses without naming them."""

import re

_AT = re.compile(r"Cannot (?:overwrite a value|declare .* twice) \(at line (\d+),")
_SECTION = re.compile(r"\s*\[+\s*([^\[\]]+?)\s*\]+")
_KEY = re.compile(r"\s*([\"']?)([\w.-]+)\1\s*=")


def repeated(text: str, said: str) -> str:
    """What a scene has twice, and where, for a message; "" where the reader says something else.

    Args:
        text: of the scene.
        said: by TOML's reader.
    """
    found = _AT.match(said)
    if not found:
        return ""
    lines, last = text.splitlines(), int(found[1])
    section = ""
    places: dict[str, int] = {}
    for number, line in enumerate(lines[:last], 1):
        name = ""
        if head := _SECTION.match(line):
            section = name = f"[{head[1]}]"
        elif key := _KEY.match(line):
            name = f"{section} {key[2]}".strip()
        if name and number == last and name in places:
            what = "put its keys together" if head else "keep one"
            return f"found {name} twice, in lines {places[name]} and {number}; {what}"
        places.setdefault(name, number)
    return ""
