"""Names of users, in lower case, so that nobody is taken for somebody else."""

import re
from typing import Final

NAME_RULE: Final = "1 to 100 letters (a to z), digits or any of . _ - + @, the first a letter or digit"
_NAME: Final = re.compile(r"[a-z0-9][a-z0-9._+@-]{0,99}")

RESERVED: Final = frozenset({"statorwatch", "anonymous", "service"})
"""The audit trail calls others so."""


def name_of(text: str) -> str | None:
    """Return the name that somebody wrote, None for what is no user's name."""
    name = text.strip().lower()
    return name if _NAME.fullmatch(name) and name not in RESERVED else None
