"""Text as every database and every answer can hold it."""

import re

MOST_CHARACTERS = 4000
"""A reason is cut to this length. Channel names, which reasons repeat, may be as long as their file."""

_UNSTORABLE = re.compile("[\0\ud800-\udfff]")


def storable(text: str) -> str:
    """Return a text without what PostgreSQL (NUL) or UTF-8 (half a surrogate pair) cannot hold, and cut."""
    cut = text if len(text) <= MOST_CHARACTERS else f"{text[:MOST_CHARACTERS]}..."
    return _UNSTORABLE.sub("\N{REPLACEMENT CHARACTER}", cut)
