"""Whether the relay trips the motor, from the states that are recorded beside the samples."""

import re

import numpy as np
from numpy.typing import NDArray

from core.recordings import Digitals

_WORDS = re.compile(r"[A-Z]?[a-z]+|[A-Z]+|[0-9]+")
_TRIP = re.compile(r"(?!re)\w*trip[abc]?|trips|tripped|tripping|trp|ptrc|ausloesung|generalaus")
"""Words such as TRIP, TRIPA and JAMTRIP; a RETRIP is that of another breaker."""
_STOP = re.compile("stop|stopcmd")
_OTHERWISE = frozenset(
    {
        *(
            "not",
            "no",
            "block",
            "blk",
            "blocked",
            "inhibit",
            "enable",
            "enabled",
            "en",
            "test",
            "reset",
            "rst",
        ),
        *("alarm", "alm", "warning", "warn", "supervision", "circuit", "coil", "tcs", "healthy"),
        *("count", "counter"),
    }
)
"""Words that make another state of one: a trip that is blocked, a supervision of the trip circuit."""


def is_tripped(digitals: Digitals | None) -> bool:
    """Tell whether a trip signal rises in the recording, and no command to stop comes with it.

    Some relays give their trip signal for each opening of the contactor. The command tells the two apart.

    Parameters
    ----------
    digitals : Digitals or None
        States recorded beside the samples.

    Returns
    -------
    bool
        Whether the relay trips the motor; False where no such state is recorded.
    """
    if digitals is None or digitals.packed.shape[0] == 0:
        return False
    trip, stop = (_first_rise(digitals, words) for words in (_TRIP, _STOP))
    return trip is not None and (stop is None or trip < stop)


def _first_rise(digitals: Digitals, wanted: re.Pattern[str]) -> int | None:
    """Return the sample at which the first of some states rises; None where none does."""
    rises = [
        int(np.argmax(risen))
        for k, name in enumerate(digitals.names)
        if _means(name, wanted) and (risen := _risen(digitals, k)).any()
    ]
    return min(rises, default=None)


def _risen(digitals: Digitals, k: int) -> NDArray[np.bool_]:
    state = (digitals.packed[:, k // 8] >> (k % 8) & 1).astype(np.bool_)
    return np.asarray(state[1:] & ~state[:-1])


def _means(name: str, wanted: re.Pattern[str]) -> bool:
    words = {word.lower() for word in _WORDS.findall(name)}
    return any(map(wanted.fullmatch, words)) and not words & _OTHERWISE
