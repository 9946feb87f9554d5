"""Where a whole audit trail is read from: a service, its database, or a file that was exported."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from sqlalchemy.exc import SQLAlchemyError

from service.audit.entries import START, Anchor, AuditEntry
from service.audit.exports import AuditFileError, entry_of_line, read_export
from service.audit.verification import Read
from service.cli.output import failing_clearly
from service.client.rest_client import ServiceClient, ServiceError
from service.configuration.settings import Settings, SettingsError
from service.storage import Repository, StorageError, connect
from service.storage.migrations import require_current_tables


@dataclass(frozen=True, slots=True)
class Trail:
    """Entries behind `start`. head: the last one that was written, None where that is not known."""

    read: Read
    start: Anchor
    head: Anchor | None


@contextmanager
def opened(url: str, config: Path | None, file: Path | None, *, first: int = 1) -> Iterator[Trail]:
    """Open a trail: the file, or the database of the settings, or that of the service at the address.

    first: number of the first entry that is wanted; a file is read from its beginning. Raises CommandError.
    """
    errors = (AuditFileError, OSError, ServiceError, SettingsError, StorageError, SQLAlchemyError)
    with failing_clearly(*errors):
        if file is not None:
            yield Trail(partial(read_export, file), _start_of(file), None)
        elif config is not None:
            with _of_database(config, first) as trail:
                yield trail
        else:
            with ServiceClient(url) as service:
                yield _of_service(service, first)


def _start_of(file: Path) -> Anchor:
    """Return what the first entry of an export follows: it may be a part of a trail."""
    first = next(read_export(file), None)
    return START if first is None else Anchor(first.number - 1, first.previous)


@contextmanager
def _of_database(config: Path, first: int) -> Iterator[Trail]:
    settings = Settings.load(config)
    require_current_tables(settings.database_url)
    engine = connect(settings.database_url, limits=None)  # whoever reads the trail may pause
    try:
        with Repository(engine).audit_trail() as trail:
            yield Trail(partial(trail.entries, first=first), START, trail.head)
    finally:
        engine.dispose()


def _of_service(service: ServiceClient, first: int) -> Trail:
    found = service.get_audit_head()
    head = Anchor(found["number"], found["hash"])

    def read() -> Iterator[AuditEntry]:
        if head.number >= first:
            with service.export_audit_trail(first=first, last=head.number) as trail:
                for text in trail.iter_lines():
                    yield entry_of_line(text)

    return Trail(read, START, head)
