"""`mcc backup`: a back-up of database and recordings while the service runs, and its verification."""

import time
from pathlib import Path

from rich.text import Text
from sqlalchemy.exc import SQLAlchemyError

from service.backup.errors import BackupError
from service.backup.making import MadeBackup
from service.backup.noted import make_noted_backup
from service.backup.source import source_of
from service.backup.verification import Verified, verify_backup
from service.cli.audit.actor import command_line_actor
from service.cli.output import CommandError, failing_clearly, print_document, progress, results
from service.configuration.settings import Settings, SettingsError
from service.storage import Repository, StorageError, connect
from service.storage.migrations import require_current_tables

MB = 1e6


def back_up(config: Path | None, directory: Path | None, *, keep: int | None, as_json: bool) -> None:
    """Back up into a directory, or that of the settings, and print what was made. Raises CommandError."""
    began_s = time.monotonic()
    with failing_clearly(SettingsError, StorageError, SQLAlchemyError, OSError, BackupError):
        settings = Settings.load(config)
        target = _directory(settings, directory)
        require_current_tables(settings.database_url)
        engine = connect(settings.database_url)
        try:
            made = make_noted_backup(
                Repository(engine),
                source_of(settings, config),
                target,
                keep=keep,
                by=command_line_actor(),
                progress=lambda told: progress().print(Text(told), soft_wrap=True),
            )
        finally:
            engine.dispose()
    if made is None:
        raise CommandError("another service has made this back-up")
    document = {**_made(made), "took_s": round(time.monotonic() - began_s, 1)}
    if as_json:
        print_document(document)
        return
    manifest = made.manifest
    _say(
        f"{target / manifest.name}: {manifest.recordings} recordings ({made.copied} new), "
        f"{manifest.files} files, {manifest.size_bytes / MB:.1f} MB, verified, {document['took_s']} s"
    )
    if made.removed:
        _say(f"removed: {', '.join(made.removed)}")
    for lost in manifest.lost:
        _say(f"not backed up, because it is lost already: {lost.problem}")


def verify(config: Path | None, directory: Path | None, *, as_json: bool) -> None:
    """Read every file of a back-up again. Raises CommandError where anything is wrong."""
    with failing_clearly(SettingsError, OSError, BackupError):
        target = directory or _directory(Settings.load(config), None)
        verified = verify_backup(target)
        verified.require_whole()
    if as_json:
        print_document(_verified(verified))
        return
    manifest = verified.manifest
    _say(
        f"{verified.directory / manifest.name}: whole: {manifest.recordings} recordings, "
        f"{manifest.files} files, {manifest.size_bytes / MB:.1f} MB, made {manifest.made} "
        f"by {manifest.program}"
    )


def _directory(settings: Settings, given: Path | None) -> Path:
    directory = given or settings.backup.directory
    if directory is None:
        raise BackupError("expected a DIRECTORY, or the setting backup.directory; found none")
    return directory.absolute()


def _made(made: MadeBackup) -> dict[str, object]:
    manifest = made.manifest
    return {
        **manifest.model_dump(exclude={"tables", "sums", "format"}),
        "directory": str(made.directory),
        "copied": made.copied,
        "removed": list(made.removed),
        "verified": True,
    }


def _verified(verified: Verified) -> dict[str, object]:
    manifest = verified.manifest
    return {
        **manifest.model_dump(exclude={"tables", "sums", "format"}),
        "directory": str(verified.directory),
        "verified": True,
    }


def _say(line: str) -> None:
    results().print(Text(line), soft_wrap=True)
