"""How finely a file has the values of its record: of the copies of one event the finest is kept."""

import re
from enum import IntEnum
from pathlib import Path
from typing import Final

_READ: Final = 1 << 18
_COMTRADE: Final = (".cfg", ".cff")
_TEXT: Final = (".cev", ".csv", ".tsv", ".txt")
_FORMAT: Final = re.compile(rb'^[\s"]*(ASCII|BINARY|BINARY32|FLOAT32)[\s",]*$', re.IGNORECASE | re.MULTILINE)


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
    suffix = path.suffix.casefold()
    if suffix in _TEXT:
        return Fidelity.TEXT
    if suffix not in _COMTRADE:
        return Fidelity.FLOAT  # tables of numbers
    with path.open("rb") as file:
        head = file.read(_READ).replace(b"\0", b"")  # UTF-16 has a zero beside each letter
    named = _FORMAT.search(head.replace(b"\r", b"\n"))
    kinds = {b"FLOAT32": Fidelity.FLOAT, b"BINARY": Fidelity.BINARY, b"BINARY32": Fidelity.BINARY}
    return Fidelity.TEXT if named is None else kinds.get(named[1].upper(), Fidelity.TEXT)
