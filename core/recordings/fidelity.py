"""How finely a file has the values of its record: of the copies of one event the finest is kept."""

import re
from enum import IntEnum
from pathlib import Path

_READ = 1 << 18
_COMTRADE = (".cfg", ".cff")
_BINARY = re.compile(rb"\bBINARY(32)?\b", re.IGNORECASE)
_FLOAT = re.compile(rb"\bFLOAT32\b", re.IGNORECASE)


class Fidelity(IntEnum):
    """Kinds of values, the finest first."""

    FLOAT = 0
    BINARY = 1
    TEXT = 2


def fidelity_of(path: Path) -> Fidelity:
    """Tell how finely a file has its values.

    Parameters
    ----------
    path : pathlib.Path
        The file, as `core.recordings.read` takes it.

    Returns
    -------
    Fidelity
        Numbers of floating point, counts of a converter, or text.

    Raises
    ------
    OSError
        If the file cannot be read.
    """
    if path.suffix.casefold() not in _COMTRADE:
        return Fidelity.TEXT
    with path.open("rb") as file:
        head = file.read(_READ).replace(b"\0", b"")  # UTF-16 has a zero beside each letter
    if _FLOAT.search(head):
        return Fidelity.FLOAT
    return Fidelity.BINARY if _BINARY.search(head) else Fidelity.TEXT
