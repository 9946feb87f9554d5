"""Backs the service up once a day, where the settings say where to."""

from datetime import UTC, datetime, time, timedelta
from pathlib import Path
from threading import Event

import structlog

from core.units import NANOSECONDS_PER_SECOND
from service.backup.errors import BackupError, BackupStoppedError
from service.backup.noted import make_noted_backup
from service.backup.source import source_of
from service.configuration.settings import Settings
from service.storage import Repository, StorageError

log = structlog.get_logger(__name__)

PERIOD_S = 30.0


class DailyBackup:
    """Looks whether the back-up of the day is due. Of several services that share a database one makes it.

    A time that passed while no service ran is made up for: what matters of a back-up is its age.
    """

    def __init__(
        self,
        settings: Settings,
        repository: Repository,
        stopping: Event | None = None,
        *,
        settings_file: Path | None = None,
    ) -> None:
        """stopping: set when a back-up under way should end.  settings_file: goes into the back-up."""
        self._settings_file = settings_file
        self._settings = settings
        self._repository = repository
        self._stopping = stopping or Event()

    def back_up_if_due(self, now_ns: int) -> None:
        """Make the back-up of the latest due time unless it is made. Raises SQLAlchemyError.

        Why one failed is kept with it in the database.
        """
        backup = self._settings.backup
        if backup.directory is None:
            return
        due_ns = latest_due_ns(backup.daily_at, now_ns)
        if not self._repository.is_backup_due(due_ns, now_ns=now_ns):
            return
        try:
            made = make_noted_backup(
                self._repository,
                source_of(self._settings, self._settings_file),
                backup.directory,
                keep=backup.keep,
                due_ns=due_ns,
                stopping=self._stopping,
            )
        except BackupStoppedError:
            log.info("back-up stopped, because the service ends")
            return
        except (BackupError, StorageError, OSError) as error:  # no reason to answer no requests
            log.error("back-up failed, to be tried again in an hour", error=str(error))  # noqa: TRY400
            return
        if made is None:
            return
        manifest = made.manifest
        log.info("backed up", directory=str(made.directory), name=manifest.name, copied=made.copied)
        for lost in manifest.lost:
            log.warning("a recording could not be backed up", recording=lost.digest, problem=lost.problem)


def latest_due_ns(daily_at: str, now_ns: int) -> int:
    """Return the latest time of day HH:MM, UTC, that is not later than now."""
    now = datetime.fromtimestamp(now_ns // NANOSECONDS_PER_SECOND, UTC)
    due = datetime.combine(now.date(), time.fromisoformat(daily_at), UTC)
    if due > now:
        due -= timedelta(days=1)
    return int(due.timestamp()) * NANOSECONDS_PER_SECOND
