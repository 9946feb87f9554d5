"""Disks of the service that fill: `disk-filling`."""

import shutil
import socket
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from core.units import SECONDS_PER_DAY
from service.alarms.confirmation import DeadBand, Decision
from service.alarms.kinds import AlarmKind
from service.background.alarm_sources.standing import StandingAlarms
from service.configuration.alarms import AlarmSettings
from service.storage import Repository
from service.storage.records import AlarmPlace, AlarmSpec
from service.storage.records.alarm_sources import AlarmFinding

BACK = 1.2
"""The free share has to be so many times the limit before the alarm is over."""

BACK_DAYS = 2.0
"""And the disk has to fill so many times slower."""

SHORTEST_S, LONGEST_S = 3600.0, SECONDS_PER_DAY
"""How fast a disk fills is told from at least an hour, and from at most a day."""


@dataclass(frozen=True, slots=True)
class Room:
    """How much was free at a time of the monotonic clock."""

    at_s: float
    free_bytes: int


def days_to_full(rooms: Sequence[Room]) -> float | None:
    """Return in how many days a disk is full if it goes on filling as in these looks, oldest first.

    None where they tell too little, and where it does not fill.
    """
    if not rooms or rooms[-1].at_s - rooms[0].at_s < SHORTEST_S:
        return None
    middle = len(rooms) // 2
    early, late = rooms[:middle], rooms[middle:]
    lasted_s = _mean([one.at_s for one in late]) - _mean([one.at_s for one in early])
    filled = _mean([one.free_bytes for one in early]) - _mean([one.free_bytes for one in late])
    if filled <= 0.0:
        return None
    return rooms[-1].free_bytes * lasted_s / filled / SECONDS_PER_DAY


class DiskSource:
    """Looks at the disks that the service writes to, once a minute at most."""

    def __init__(self, rules: AlarmSettings, repository: Repository, directories: Iterable[Path]) -> None:
        self._repository = repository
        self._directories = tuple(directories)
        self._share = _band(rules.disk_free_share, BACK)
        self._days = _band(rules.disk_full_days, BACK_DAYS)
        self._host = socket.gethostname()
        self._rooms: dict[int, deque[Room]] = {}

    def findings(self, now_s: float) -> Iterator[AlarmFinding]:
        """Yield what has changed; `now_s` is monotonic [s]. Raises OSError, SQLAlchemyError."""
        standing = StandingAlarms(self._repository, AlarmKind.DISK_FILLING)
        subjects = set()
        for device, directory in self._disks().items():
            subject = f"{self._host}: {directory}"
            subjects.add(subject)
            usage = shutil.disk_usage(directory)
            rooms = self._rooms.setdefault(device, deque())
            rooms.append(Room(now_s, usage.free))
            while rooms[-1].at_s - rooms[0].at_s > LONGEST_S:
                rooms.popleft()
            share, days = usage.free / usage.total, days_to_full(rooms)
            stands = standing.of(AlarmKind.DISK_FILLING, subject) is not None
            decision = self._decision(share, days, stands=stands)
            if decision is Decision.KEEP and not stands:
                continue
            spec = AlarmSpec(AlarmKind.DISK_FILLING, _told(share, days), subject)
            finding = standing.finding(subject, AlarmPlace(), spec, decision, _told(share, days))
            if finding is not None:
                yield finding
        yield from standing.gone(
            AlarmKind.DISK_FILLING, subjects, "the service does not use it any more", of=f"{self._host}: "
        )

    def _disks(self) -> dict[int, Path]:
        """Return one directory of each disk; part `disk` of GET /readyz tells of one that is not there."""
        found: dict[int, Path] = {}
        for directory in self._directories:
            with suppress(FileNotFoundError):
                found.setdefault(directory.stat().st_dev, directory)
        return found

    def _decision(self, share: float, days: float | None, *, stands: bool) -> Decision:
        decisions = []
        if self._share is not None:
            decisions.append(self._share.decide(share, stands=stands))
        if self._days is not None:
            decisions.append(
                (Decision.CLEAR if stands else Decision.KEEP)
                if days is None
                else self._days.decide(days, stands=stands)
            )
        if Decision.RAISE in decisions:
            return Decision.RAISE
        is_over = stands and all(one is Decision.CLEAR for one in decisions)
        return Decision.CLEAR if is_over else Decision.KEEP


def _band(limit: float, back: float) -> DeadBand | None:
    return DeadBand(limit, back * limit) if limit > 0.0 else None


def _told(share: float, days: float | None) -> str:
    filling = "" if days is None or days > 365 else f"; it will be full in {days:.0f} days"
    return f"{share:.0%} of the disk is free{filling}"


def _mean(figures: Sequence[float]) -> float:
    return sum(figures) / len(figures)
