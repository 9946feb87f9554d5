"""`mcc audit list`: who changed what, latest first."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from difflib import get_close_matches
from itertools import islice
from pathlib import Path
from typing import Any

from rich.text import Text
from sqlalchemy.exc import SQLAlchemyError

from core.error_words import one_line
from core.time_stamps import nanoseconds, rfc3339
from service.audit.actions import AuditAction
from service.audit.entries import AuditEntry
from service.cli.output import CommandError, failing_clearly
from service.cli.rows import Column, print_rows, require_one_format
from service.client.rest_client import Document, ServiceClient, ServiceError
from service.client.verdicts import local_time
from service.configuration.settings import Settings, SettingsError
from service.storage import Repository, StorageError, connect
from service.storage.migrations import require_current_tables

AT_ONCE = 1000

FIELDS = (
    *("number", "time", "actor", "origin", "roles", "action", "subject_kind", "subject", "before", "after"),
    *("previous", "hash"),
)
COLUMNS: Mapping[str, Column] = {
    "number": lambda row: str(row["number"]),
    "time": lambda row: local_time(row["time"]),
    "who, from": lambda row: _lines(row["actor"], row["origin"]),
    "what, of what, before -> after": lambda row: _lines(
        row["action"], f"{row['subject_kind']} {row['subject']}", _change(row)
    ),
}
"""Few, so that a terminal of 80 columns has room for them: what belongs together is one below the other."""


def show_entries(
    url: str,
    config: Path | None,
    chosen: dict[str, str | None],
    *,
    limit: int,
    as_csv: bool,
    as_json: bool,
) -> None:
    """Print entries of the audit trail, those that meet all that is chosen. Raises CommandError.

    config: read the database of these settings; without it the service is asked.
    """
    require_one_format(as_csv=as_csv, as_json=as_json)
    query: dict[str, Any] = {name: word for name, word in chosen.items() if word is not None}
    if config is not None:
        with failing_clearly(SettingsError, StorageError, SQLAlchemyError):
            found = list(islice(_of_database(config, query), limit))
    else:
        with failing_clearly(ServiceError), ServiceClient(url) as service:
            asked = {"from_" if name == "from" else name: word for name, word in query.items()}
            entries = service.list_audit_entries(limit=min(limit, AT_ONCE), **asked)
            found = list(islice(entries, limit))
    if as_csv:
        found = [_flat(entry) for entry in found]
    whole = ("number", "time")
    print_rows("entries", found, FIELDS, COLUMNS, as_csv=as_csv, as_json=as_json, whole=whole)


def _of_database(config: Path, query: Mapping[str, str]) -> Iterator[Document]:
    """Yield the entries that the database has, as the service would tell them. Raises CommandError."""
    settings = Settings.load(config)
    action, from_ns, to_ns = _action(query), _time(query, "from"), _time(query, "to")
    require_current_tables(settings.database_url)
    engine = connect(settings.database_url)
    try:
        repository, after = Repository(engine), None
        while True:
            page = repository.audit_entries(
                limit=AT_ONCE,
                after=after,
                actor=query.get("actor"),
                action=action,
                subject=query.get("subject"),
                from_ns=from_ns,
                to_ns=to_ns,
            )
            yield from map(_document, page.items)
            after = page.next
            if after is None:
                return
    finally:
        engine.dispose()


def _action(query: Mapping[str, str]) -> AuditAction | None:
    word = query.get("action")
    if word is None:
        return None
    try:
        return AuditAction(word)
    except ValueError as error:
        near = get_close_matches(word, [*AuditAction], 1)
        hint = f": did you mean {near[0]}?" if near else ", such as recording-deleted"
        raise CommandError(
            f"--action: expected an action of the audit trail, found {word!r}{hint}"
        ) from error


def _time(query: Mapping[str, str], name: str) -> int | None:
    try:
        return nanoseconds(query[name]) if name in query else None
    except ValueError as error:
        raise CommandError(f"--{name}: {error}") from error


def _document(entry: AuditEntry) -> Document:
    """Return an entry as the REST API has it."""
    return {
        **asdict(entry),
        "time": rfc3339(entry.time_ns),
        "roles": entry.roles.split(),
        "before": None if entry.before is None else json.loads(entry.before),
        "after": None if entry.after is None else json.loads(entry.after),
    }


def _flat(entry: Document) -> Document:
    """Return an entry with texts for spreadsheets."""
    roles = entry["roles"]
    texts = {
        name: None if entry[name] is None else json.dumps(entry[name], ensure_ascii=False)
        for name in ("before", "after")
    }
    return {**entry, **texts, "roles": " ".join(roles) if isinstance(roles, list) else roles}


def _lines(*texts: object) -> Text:
    """Return a cell with a line for each of these that says something."""
    return Text("\n".join(filter(None, (one_line(str(text)) for text in texts))))


def _change(entry: Document) -> str:
    """Return the values before and after."""
    before, after = (_words(entry[name]) for name in ("before", "after"))
    return f"{before} -> {after}" if before else after


def _words(values: object) -> str:
    if not isinstance(values, dict):
        return ""
    return ", ".join(f"{name} {value}" for name, value in values.items() if value is not None)
