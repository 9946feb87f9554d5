"""The relay's EVENTS directory: numbered COMTRADE records, the oldest discarded for the newest."""

import re
from pathlib import Path

from core.recordings import Recording, comtrade

EVENTS = "EVENTS"
FIRST_NUMBER = 10000
_CONFIGURATION = re.compile(r"HR_(\d{5,})\.CFG")
# The configuration comes last into the directory and leaves it first: who sees it sees all of its record.
_SUFFIXES_IN_ORDER = (".DAT", ".HDR", ".CFG")


class EventFiles:
    """Records under `root`/EVENTS, at most `capacity` of them.

    They are written under `staging`, which no client sees, and renamed when complete; both directories must
    be on one file system. Numbers go on after those found there, so a restarted relay uses none twice.
    Raises OSError where the directories cannot be made or read.
    """

    def __init__(self, root: Path, staging: Path, capacity: int) -> None:
        self._events = root / EVENTS
        self._staging = staging
        self._capacity = capacity
        self._events.mkdir(parents=True, exist_ok=True)
        self._staging.mkdir(parents=True, exist_ok=True)
        self.last_number = max(self.numbers(), default=None)

    def numbers(self) -> list[int]:
        """Numbers of the complete records, oldest first."""
        names = (_CONFIGURATION.fullmatch(entry.name) for entry in self._events.iterdir())
        return sorted(int(name[1]) for name in names if name)

    def store(self, recording: Recording, header: str) -> int:
        """Write one record completely, discard what is too old, and return the record's number."""
        number = FIRST_NUMBER if self.last_number is None else self.last_number + 1
        name = f"HR_{number:05d}"
        comtrade.write(self._staging / name, recording, header_text=header)
        for suffix in _SUFFIXES_IN_ORDER:
            (self._staging / f"{name}{suffix}").rename(self._events / f"{name}{suffix}")
        self.last_number = number
        for old in self.numbers()[: -self._capacity]:
            for suffix in reversed(_SUFFIXES_IN_ORDER):
                (self._events / f"HR_{old:05d}{suffix}").unlink(missing_ok=True)
        return number
