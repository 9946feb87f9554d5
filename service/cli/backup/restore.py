"""`mcc restore`: a back-up put in the place of a service's data."""

import time
from pathlib import Path

from rich.text import Text
from sqlalchemy.exc import SQLAlchemyError

from service.audit.actions import AuditAction
from service.backup.errors import BackupError
from service.backup.restoring import Restored, restore_backup
from service.backup.source import place_of
from service.cli.audit.actor import command_line_actor
from service.cli.output import failing_clearly, print_document, print_warning, progress, results
from service.configuration.settings import Settings, SettingsError
from service.process.single_instance import AlreadyRunningError
from service.storage import Repository, StorageError, connect
from service.storage.migrations import require_current_tables

REMINDER = (
    "Users, sessions and tokens are again as they were when the back-up was made: end again what was ended "
    "since."
)


def restore(config: Path | None, backup: Path, *, into: Path | None, overwrite: bool, as_json: bool) -> None:
    """Restore a back-up, and print what was restored. Raises CommandError; nothing is changed then."""
    began_s = time.monotonic()
    errors = (SettingsError, StorageError, SQLAlchemyError, OSError, BackupError, AlreadyRunningError)
    with failing_clearly(*errors):
        settings = Settings.load(config, {"data_directory": into})
        if into is not None:
            settings = _all_in(settings, into)
        restored = restore_backup(
            backup,
            place_of(settings),
            overwrite=overwrite,
            progress=lambda told: progress().print(Text(told), soft_wrap=True),
        )
    _note(restored, settings, backup)
    took_s = round(time.monotonic() - began_s, 1)
    if as_json:
        print_document(_document(restored, settings, took_s))
        return
    manifest = restored.manifest
    results().print(
        Text(
            f"{manifest.name}, made {manifest.made}: database and {manifest.recordings} recordings "
            f"({restored.added} new here) restored into {settings.data_directory}, {took_s} s"
        ),
        soft_wrap=True,
    )
    if restored.former is not None:
        results().print(Text(f"the database that was there: {restored.former}"), soft_wrap=True)
    results().print(Text(REMINDER), soft_wrap=True)


def _note(restored: Restored, settings: Settings, backup: Path) -> None:
    """Add the restore to the trail that was restored; a warning says why that is not possible."""
    manifest = restored.manifest
    after = {
        "from": str(backup.absolute()),
        "made": manifest.made,
        "recordings": manifest.recordings,
        "former_database": None if restored.former is None else str(restored.former),
    }
    subject = ("back-up", manifest.name)
    try:
        require_current_tables(settings.database_url)
        engine = connect(settings.database_url)
        try:
            Repository(engine).note_by(
                command_line_actor(), AuditAction.BACKUP_RESTORED, subject, now_ns=time.time_ns(), after=after
            )
        finally:
            engine.dispose()
    except (StorageError, SQLAlchemyError) as error:
        print_warning(f"restored, but the audit trail does not say so: {error}")


def _all_in(settings: Settings, into: Path) -> Settings:
    """Return the settings with all data in one directory, whatever the file says of it."""
    values = settings.model_dump(include={"database_url"})
    is_sqlite = str(values["database_url"]).startswith("sqlite")
    kept = {} if is_sqlite else values
    return Settings.model_validate({"data_directory": into, **kept})


def _document(restored: Restored, settings: Settings, took_s: float) -> dict[str, object]:
    manifest = restored.manifest
    return {
        "name": manifest.name,
        "made": manifest.made,
        "recordings": manifest.recordings,
        "added": restored.added,
        "data_directory": str(settings.data_directory),
        "former_database": None if restored.former is None else str(restored.former),
        "took_s": took_s,
    }
