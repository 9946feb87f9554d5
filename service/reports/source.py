"""Where reports come from: the database, and what the settings say of times."""

from dataclasses import dataclass
from typing import Self

from service.configuration.settings import Settings
from service.storage import Repository


@dataclass(frozen=True, slots=True)
class ReportSource:
    """What every report is made from.

    time_zone: in which days and months are counted, and times written.  stale_after_days: age of a motor's
    latest record that is too old; None: that follows from its schedule.
    """

    repository: Repository
    time_zone: str = "UTC"
    stale_after_days: float | None = None

    @classmethod
    def of(cls, repository: Repository, settings: Settings) -> Self:
        """Return what reports are made from as the settings say."""
        return cls(repository, settings.notifications.time_zone, settings.stale_after_days)
