"""The month that the demo plays in minutes: when it began, and the leaps of the plant's clock."""

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from math import ceil
from pathlib import Path

from service.client.rest_client import Document, ServiceClient, segment

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

    @property
    def _started(self) -> datetime:
        return self.began + timedelta(days=self.days)


def month_of(scenario: Path, log: str) -> Month | None:
    """The month of a scenario, with its beginning from the simulator's log; None where it has no [clock]."""
    clock = tomllib.loads(scenario.read_text(encoding="utf-8")).get("clock")
    found = re.search(r"^began (\S+)$", log, re.MULTILINE)
    if clock is None or found is None:
        return None
    return Month(
        datetime.fromisoformat(found[1]), clock["start_days_ago"], clock["speed_up"], clock["leap_every_s"]
    )


def began(service: ServiceClient) -> datetime | None:
    """When the month began that a running plant lives through, by its first record.

    It is None where the plant's time is the real one, or no record tells. Raises ServiceError.
    """
    for motor in service.items("/motors"):
        points = service.get(f"/motors/{segment(str(motor['name']))}/trend", limit="1")["items"]
        if isinstance(points, list) and points:
            first = service.get(f"/recordings/{segment(str(points[0]['recording_id']))}")
            recorded = _time(first, "recorded_time")
            return recorded if _time(first, "announced_time") - recorded > BELATED else None
    return None


def latest_s(health: Document, since: datetime) -> float:
    """Time of the motor's latest record [s since then]; 0 before the first."""
    if health["recorded_time"] is None:
        return 0.0
    return max(0.0, (_time(health, "recorded_time") - since).total_seconds())


def _time(document: Mapping[str, object], field: str) -> datetime:
    return datetime.fromisoformat(str(document[field])).astimezone(UTC)
