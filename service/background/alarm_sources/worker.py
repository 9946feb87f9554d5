"""The periodic look at all that raises alarms.

Several services may share a database: each looks, what one has raised another finds standing, and disks and
certificates are told with the name of their host. Whatever is decided follows from what is stored, so that a
service that starts anew goes on as if it had never stopped.
"""

from collections.abc import Iterable, Iterator
from pathlib import Path

from core.units import NANOSECONDS_PER_SECOND
from service.background.alarm_sources.attacks import AttackSource
from service.background.alarm_sources.backups import BackupSource
from service.background.alarm_sources.certificates import CertificateSource
from service.background.alarm_sources.clocks import ClockSource
from service.background.alarm_sources.disks import DiskSource
from service.background.alarm_sources.links import LinkSource
from service.background.alarm_sources.missing_data import MissingDataSource
from service.background.alarm_sources.trips import TripSource
from service.configuration.settings import Settings
from service.storage import Repository
from service.storage.records.alarm_sources import AlarmFinding
from service.timing.wall_clock import WallClock

PERIOD_S = 5.0
"""Links and floods are looked at this often [s]."""

SLOW_PERIOD_S = 60.0
"""And what changes slowly."""


class AlarmSources:
    """Looks at links, clocks, records, disks, trips, certificates, back-ups and attacks, and gathers floods.

    What follows from ages waits while the wall clock of this host was set a short while ago.
    """

    def __init__(
        self,
        settings: Settings,
        repository: Repository,
        directories: Iterable[Path],
        *,
        started_ns: int,
        slow_period_s: float = SLOW_PERIOD_S,
    ) -> None:
        """directories: those that the service writes to.  started_ns: when the service started."""
        self._repository = repository
        self._most = settings.alarms.flood_alarms
        self._links = LinkSource(settings, repository, started_ns)
        self._clocks = ClockSource(settings.alarms, repository)
        self._records = MissingDataSource(settings, repository, started_ns)
        self._disks = DiskSource(settings.alarms, repository, directories)
        self._certificates = CertificateSource(settings, repository)
        self._backups = BackupSource(settings.backup, repository, started_ns)
        self._trips = TripSource(repository)
        self._attacks = AttackSource(repository)
        self._wall_clock = WallClock()
        self._slow_period_s = slow_period_s
        self._next_slow_s: float | None = None

    def look(self, now_ns: int, monotonic_ns: int) -> None:
        """Raise and clear what has changed since the last look. Raises SQLAlchemyError, OSError."""
        self._wall_clock.compare(now_ns, monotonic_ns)
        self._links.look(now_ns)
        now_s = monotonic_ns / NANOSECONDS_PER_SECOND
        if self._next_slow_s is None or now_s >= self._next_slow_s:
            self._next_slow_s = now_s + self._slow_period_s
            self._repository.settle_findings(tuple(self._slow_findings(now_ns, now_s)), now_ns=now_ns)
        self._repository.gather_floods(self._most, now_ns=now_ns)

    def _slow_findings(self, now_ns: int, now_s: float) -> Iterator[AlarmFinding]:
        yield from self._clocks.findings()
        yield from self._disks.findings(now_s)
        yield from self._trips.findings()
        if not self._wall_clock.was_set:
            yield from self._records.findings(now_ns)
            yield from self._certificates.findings(now_ns)
            yield from self._backups.findings(now_ns)
            yield from self._attacks.findings(now_ns)
