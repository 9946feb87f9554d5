"""`mcc audit list`: who changed what, latest first."""

import json
from itertools import islice

from core.error_words import one_line
from service.cli.output import failing_clearly
from service.cli.rows import print_rows, require_one_format
from service.client.rest_client import Document, ServiceClient, ServiceError
from service.client.verdicts import to_the_second

FIELDS = (
    *("number", "time", "actor", "origin", "roles", "action", "subject_kind", "subject", "before", "after"),
    *("previous", "hash"),
)
COLUMNS = {
    "number": lambda row: str(row["number"]),
    "time": lambda row: to_the_second(row["time"]),
    "who": lambda row: str(row["actor"]),
    "from": lambda row: str(row["origin"]),
    "what": lambda row: str(row["action"]),
    "of": lambda row: f"{row['subject_kind']} {row['subject']}",
    "change": lambda row: _change(row),
}


def show_entries(
    url: str,
    chosen: dict[str, str | None],
    *,
    limit: int,
    as_csv: bool,
    as_json: bool,
) -> None:
    """Print entries of the audit trail, those that meet all that is chosen. Raises CommandError."""
    require_one_format(as_csv=as_csv, as_json=as_json)
    query = {name: word for name, word in chosen.items() if word is not None}
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        found = list(islice(service.items("/audit/entries", limit=str(min(limit, 1000)), **query), limit))
    if as_csv:
        found = [_flat(entry) for entry in found]
    whole = ("number", "time")
    print_rows("entries", found, FIELDS, COLUMNS, as_csv=as_csv, as_json=as_json, whole=whole)


def _flat(entry: Document) -> Document:
    """Return an entry with texts for spreadsheets."""
    roles = entry["roles"]
    texts = {
        name: None if entry[name] is None else json.dumps(entry[name], ensure_ascii=False)
        for name in ("before", "after")
    }
    return {**entry, **texts, "roles": " ".join(roles) if isinstance(roles, list) else roles}


def _change(entry: Document) -> str:
    """Return the values before and after, in one line."""
    before, after = (_words(entry[name]) for name in ("before", "after"))
    return one_line(f"{before} -> {after}" if before else after)


def _words(values: object) -> str:
    if not isinstance(values, dict):
        return ""
    return ", ".join(f"{name} {value}" for name, value in values.items() if value is not None)
