"""Readers as hostile files would have them, in a module that worker processes import in no time."""

import os
from pathlib import Path

from benchmarks.corpus.outcomes import Agreement, Comparison, Kind, Outcome, Reading


def read(path: Path) -> Outcome:
    """Hang, die, eat memory or fail, by the file's name."""
    match path.stem:
        case "hangs":
            while True:
                pass
        case "dies":
            os._exit(11)
        case "eats":
            bytearray(1 << 36)
        case "fails":
            raise ZeroDivisionError("of the reader")
    return Outcome(Reading.READ)


def compare(path: Path) -> Comparison:
    """Die on the sound file, agree on others."""
    if path.stem == "sound":
        os._exit(12)
    return Comparison(Agreement.AGREES)


HOSTILE = Kind("hostile", (".bad",), read, compare, "nobody")
