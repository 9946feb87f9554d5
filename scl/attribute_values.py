"""What the texts of XML attributes mean."""

import re
from functools import lru_cache

_BOOLEANS = {"true": True, "1": True, "false": False, "0": False}


@lru_cache(maxsize=8192)
def decimal(text: str) -> int | None:
    """Read a decimal number of at most 19 digits.

    Parameters
    ----------
    text : str
        The text, perhaps between blanks.

    Returns
    -------
    int or None
        The number; None for anything else.
    """
    stripped = text.strip()
    return int(stripped) if re.fullmatch(r"[0-9]{1,19}", stripped) else None


def boolean(text: str) -> bool | None:
    """Read a boolean, in capitals or not.

    Parameters
    ----------
    text : str
        The text, perhaps between blanks.

    Returns
    -------
    bool or None
        The boolean; None for anything else.
    """
    value = _BOOLEANS.get(text)
    return _BOOLEANS.get(text.strip().lower()) if value is None else value
