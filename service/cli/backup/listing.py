"""`mcc backup --list`: the back-ups that the database knows of, and why some failed."""

from pathlib import Path

from rich.box import SIMPLE_HEAD
from rich.text import Text
from sqlalchemy.exc import SQLAlchemyError

from core.error_words import one_line
from core.time_stamps import rfc3339
from core.time_words import clock
from service.cli.output import failing_clearly, print_document, results
from service.client.tables import FittedTable
from service.configuration.settings import Settings, SettingsError
from service.storage import Repository, StorageError, connect
from service.storage.migrations import require_current_tables
from service.storage.records import BackupEntry

SHOWN = 100


def list_backups(config: Path | None, *, as_json: bool) -> None:
    """Print the latest back-ups, newest first. Raises CommandError."""
    with failing_clearly(SettingsError, StorageError, SQLAlchemyError, OSError):
        settings = Settings.load(config)
        require_current_tables(settings.database_url)
        engine = connect(settings.database_url)
        try:
            found = Repository(engine).backups(limit=SHOWN).items
        finally:
            engine.dispose()
    if as_json:
        print_document({"backups": [_document(one) for one in found]})
        return
    if not found:
        results().print("no back-ups")
        return
    table = FittedTable(box=SIMPLE_HEAD, collapse_padding=True)
    for heading in ("began", "state", "back-up", "recordings", "MB"):
        table.add_column(heading, no_wrap=heading in ("began", "state"))
    for one in found:
        table.add_row(
            clock(one.began_ns, None, seconds=True),
            Text(str(one.state)),
            Text(_where(one)),
            "-" if one.recordings is None else str(one.recordings),
            "-" if one.size_bytes is None else f"{one.size_bytes / 1e6:.1f}",
        )
    results().print(table)


def _where(one: BackupEntry) -> str:
    if one.problem is not None:
        return f"{one.directory}: {one_line(one.problem)}"
    return one.directory if one.name is None else f"{one.directory}/{one.name}"


def _document(one: BackupEntry) -> dict[str, object]:
    return {
        "state": one.state,
        "directory": one.directory,
        "name": one.name,
        "began_time": rfc3339(one.began_ns),
        "ended_time": None if one.ended_ns is None else rfc3339(one.ended_ns),
        "recordings": one.recordings,
        "files": one.files,
        "size_bytes": one.size_bytes,
        "problem": one.problem,
    }
