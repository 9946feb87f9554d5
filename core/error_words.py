"""Words of error messages: what was found, on one line and of a bearable length, and what was meant."""

from collections.abc import Iterable
from difflib import get_close_matches

MOST_SHOWN = 60
"""Of a value that is refused, so many characters are shown."""

ALIKE = 0.6
"""Least likeness of two names, of which one may be meant for the other."""


def nearest(unknown: str, known: Iterable[str]) -> str | None:
    """Return the known name that is most like an unknown one, whatever the capitals.

    Parameters
    ----------
    unknown : str
        The name that was found.
    known : iterable of str
        Names that there are.

    Returns
    -------
    str or None
        One of them; None where none is like it.
    """
    names = {name.casefold(): name for name in known}
    found = get_close_matches(unknown.casefold(), names, n=1, cutoff=ALIKE)
    return names[found[0]] if found else None


def shown(value: object) -> str:
    """Return a value for a message. TOML has integers of any length, of which Python prints only some.

    Parameters
    ----------
    value : object
        What was found.

    Returns
    -------
    str
        How it is shown, cut off where it is long.
    """
    try:
        text = repr(value)
    except ValueError:
        return "a number of thousands of digits"
    return text if len(text) <= MOST_SHOWN else f"{text[:MOST_SHOWN]}..."


def one_line(text: str) -> str:
    """Replace line ends and control characters, which text from files and relays may contain, by spaces.

    Parameters
    ----------
    text : str
        The text.

    Returns
    -------
    str
        The text on one line.
    """
    if text.isprintable():
        return text.strip()
    return "".join(character if character.isprintable() else " " for character in text).strip()
