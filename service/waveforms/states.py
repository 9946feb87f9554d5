"""The states recorded beside the samples: which change, when, and which stay as they are."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from service.waveforms.opened import Opened

MOST_CHANGES: Final = 2000
"""Of one state. One that bounces more often is cut off there, and says so."""


@dataclass(frozen=True, slots=True)
class StateTimeline:
    """One state. changes_s: when it changes, from `begins_with` on; `is_cut` where there are more."""

    name: str
    begins_with: bool
    changes_s: tuple[float, ...]
    is_cut: bool = False

    def at(self, time_s: float) -> bool:
        """Return the state at a time."""
        return self.begins_with ^ (sum(1 for one in self.changes_s if one <= time_s) % 2 == 1)


def timelines(shown: Opened) -> tuple[StateTimeline, ...]:
    """Return all states of a recording in the file's order."""
    digitals = shown.recording.digitals
    if digitals is None or shown.samples == 0:
        return ()
    states = digitals.unpacked()
    times = shown.recording.time_s
    found = []
    for column, name in enumerate(digitals.names):
        one = states[:, column]
        changes = np.flatnonzero(one[1:] != one[:-1]) + 1
        at = tuple(times[changes[:MOST_CHANGES]].tolist())
        found.append(StateTimeline(name, bool(one[0]), at, changes.size > MOST_CHANGES))
    return tuple(found)
