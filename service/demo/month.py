"""The month that the demo plays in minutes: when it began, and the leaps of the plant's clock."""

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from math import ceil
from pathlib import Path

from service.client.rest_client import Document, ServiceClient

BELATED = timedelta(hours=1)
"""A record that is seen so long after its time is of a plant that lives through its past."""


@dataclass(frozen=True, slots=True)
class Month:
    """A plant that lives through its past in leaps (docs/reference/scenario.md, "A month in minutes").

    began: time zero of the plant.  days: between that and the simulator's start.
    speed_up, leap_every_s: how fast the plant's time runs, and how long it is real between two leaps.
    """

    began: datetime
    days: float
    speed_up: float
    leap_every_s: float

    @property
    def leaps(self) -> int:
        """Number of leaps until the plant's time is the real one."""
        return ceil(self.days * 86_400 / ((self.speed_up - 1) * self.leap_every_s))

    def moments_s(self) -> list[float]:
        """The plant's time after each leap, none of them first [s since it began]."""
        real_s = [self.days * 86_400 + leap * self.leap_every_s for leap in range(self.leaps + 1)]
        return [min(leap * self.leap_every_s * self.speed_up, until_s) for leap, until_s in enumerate(real_s)]

    def leap_at(self, now: datetime) -> int:
        """Number of leaps so far, at most all of them."""
        return min(int((now - self._started) / timedelta(seconds=self.leap_every_s)), self.leaps)

    def until_leap_s(self, leap: int, now: datetime) -> float:
        """Time until that leap [s], negative after it."""
        return (self._started - now).total_seconds() + leap * self.leap_every_s

    @classmethod
    def with_record(cls, clock: Mapping[str, float], recorded: datetime, announced: datetime) -> "Month":
        """Return the month of a plant with that clock, one record of which is known.

        recorded: in the plant's time.  announced: when the service came to know of it, in real time. By how
        much the two differ tells how many leaps there had been.
        """
        days, speed_up, leap_every_s = clock["start_days_ago"], clock["speed_up"], clock["leap_every_s"]
        left_s = (announced - recorded).total_seconds()
        leaps = round((days * 86_400 - left_s) / ((speed_up - 1) * leap_every_s))
        began = recorded - timedelta(seconds=leaps * leap_every_s * speed_up)
        return cls(began, days, speed_up, leap_every_s)

    @property
    def _started(self) -> datetime:
        return self.began + timedelta(days=self.days)


def month_of(scenario: Path, log: str) -> Month | None:
    """The month of a scenario, with its beginning from the simulator's log; None where it has no [clock]."""
    clock = _clock(scenario)
    found = re.search(r"^began (\S+)$", log, re.MULTILINE)
    if clock is None or found is None:
        return None
    return Month(
        datetime.fromisoformat(found[1]), clock["start_days_ago"], clock["speed_up"], clock["leap_every_s"]
    )


def began(service: ServiceClient, scenario: Path) -> datetime | None:
    """When the month of a scenario began that a running plant lives through, by its oldest record.

    That need not be of the month's beginning: a plant that starts slowly misses some leaps. It is None where
    the plant's time is the real one, or no record tells. Raises ServiceError.
    """
    clock = _clock(scenario)
    for motor in service.list_motors():
        point = next(service.get_trend(motor["name"], limit=1), None)
        if point is not None:
            first = service.get_recording(point["recording_id"])
            recorded, announced = _time(first, "recorded_time"), _time(first, "announced_time")
            if clock is None or announced - recorded <= BELATED:
                return None
            return Month.with_record(clock, recorded, announced).began
    return None


def _clock(scenario: Path) -> Mapping[str, float] | None:
    """Return how the plant's time runs in a scenario; None where it is the real one."""
    clock: Mapping[str, float] | None = tomllib.loads(scenario.read_text(encoding="utf-8")).get("clock")
    return clock


def latest_s(health: Document, since: datetime) -> float:
    """Time of the motor's latest record [s since then]; 0 before the first."""
    if health["recorded_time"] is None:
        return 0.0
    return max(0.0, (_time(health, "recorded_time") - since).total_seconds())


def _time(document: Mapping[str, object], field: str) -> datetime:
    return datetime.fromisoformat(str(document[field])).astimezone(UTC)
