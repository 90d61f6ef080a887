"""Texts that can be archived and shown, without control characters; counts of things in words."""

import unicodedata

#: Characters that change the direction of writing.
_DIRECTIONS = {0x061C, 0x200E, 0x200F, *range(0x202A, 0x202F), *range(0x2066, 0x206A)}
#: Unicode's categories of control characters, separators of lines and halves of characters.
_UNSEEN = {"Cc", "Zl", "Zp", "Cs"}


def unseen(text: str) -> str:
    """For a message, where a text has its first control character; "" if it has none."""
    if text.isprintable():  # none of these is; the program checks thousands of texts when it starts
        return ""
    for i, character in enumerate(text):
        if unicodedata.category(character) in _UNSEEN or ord(character) in _DIRECTIONS:
            return f"character {i + 1} is the control character U+{ord(character):04X}, expected none"
    return ""


def counted(count: int, thing: str, things: str = "") -> str:
    """A number of things, as one says it: "1 state", "3 states"."""
    return f"{count} {thing if count == 1 else things or thing + 's'}"
