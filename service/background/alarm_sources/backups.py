"""Back-ups that are overdue: `backup-overdue`. Where the settings name no directory, none is expected."""

from collections.abc import Iterator

from core.time_stamps import rfc3339
from core.units import NANOSECONDS_PER_DAY
from service.alarms.confirmation import Decision
from service.alarms.kinds import AlarmKind
from service.background.alarm_sources.standing import StandingAlarms
from service.configuration.backup import BackupSettings
from service.storage import Repository
from service.storage.records import AlarmPlace, AlarmSpec
from service.storage.records.alarm_sources import AlarmFinding


class BackupSource:
    """Compares the age of the latest verified back-up with what the settings allow."""

    def __init__(self, settings: BackupSettings, repository: Repository, started_ns: int) -> None:
        """started_ns: before the first back-up, time counts from then on."""
        self._settings = settings
        self._repository = repository
        self._started_ns = started_ns

    def findings(self, now_ns: int) -> Iterator[AlarmFinding]:
        """Yield what has changed. Raises SQLAlchemyError."""
        standing = StandingAlarms(self._repository, AlarmKind.BACKUP_OVERDUE)
        if self._settings.directory is None:
            yield from standing.gone(AlarmKind.BACKUP_OVERDUE, (), "[backup] names no directory any more")
            return
        latest = self._repository.latest_verified_backup()
        if latest is not None and latest.ended_ns is not None:
            since_ns = latest.ended_ns
            reason = f"the latest verified back-up is of {rfc3339(since_ns)[:19]}Z"
        else:
            first_ns = self._repository.first_backup_ns()
            since_ns = self._started_ns if first_ns is None else first_ns
            reason = "no back-up was ever made and verified"
        stands = standing.of(AlarmKind.BACKUP_OVERDUE, "") is not None
        is_overdue = now_ns - since_ns > self._settings.overdue_days * NANOSECONDS_PER_DAY
        decision = Decision.KEEP
        if is_overdue != stands:
            decision = Decision.RAISE if is_overdue else Decision.CLEAR
        if decision is Decision.KEEP and not stands:
            return
        spec = AlarmSpec(AlarmKind.BACKUP_OVERDUE, f"{reason} ({self._settings.directory})", one_of_kind=True)
        finding = standing.finding("", AlarmPlace(), spec, decision, reason)
        if finding is not None:
            yield finding
