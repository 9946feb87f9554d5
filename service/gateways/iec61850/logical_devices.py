"""Names of the logical devices: one for each motor, and one for the whole plant."""

import hashlib
import re
from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Final

PLANT: Final = "PLANT"
"""The logical device of the whole plant."""

LONGEST: Final = 40
"""Letters of a name: with that of the IED, clients know 64."""

_OTHERS: Final = re.compile(r"[^A-Za-z0-9_]+")


def logical_devices(motors: Iterable[str]) -> Mapping[str, str]:
    """Return the logical device of each motor: its name, in the letters that IEC 61850 allows.

    Where two motors would have the same one, or that of the plant, each gets a mark made from its own name.
    """
    words = {motor: _word(motor) for motor in motors}
    taken = Counter(word.upper() for word in words.values())
    return {
        motor: word
        if taken[word.upper()] == 1 and word.upper() != PLANT and _is_whole(motor, word)
        else _marked(motor, word)
        for motor, word in words.items()
    }


def _word(motor: str) -> str:
    """Return the name in letters, digits and underscores, with a letter first."""
    word = _OTHERS.sub("_", motor).strip("_")
    return (word if word[:1].isalpha() else f"M_{word}")[:LONGEST]


def _is_whole(motor: str, word: str) -> bool:
    """Return whether the word tells the name apart from others: no letter is lost but ASCII punctuation."""
    return motor.isascii() and len(motor) <= LONGEST and bool(word)


def _marked(motor: str, word: str) -> str:
    mark = hashlib.blake2b(motor.encode(), digest_size=3).hexdigest()
    return f"{word[: LONGEST - len(mark) - 1]}_{mark}"
