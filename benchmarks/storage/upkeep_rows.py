"""The rows of the filled database that are about its upkeep: back-ups, one a day, and the audit trail."""

from collections.abc import Iterator

from sqlalchemy import Connection, text

from benchmarks.storage.plant import motor_name
from benchmarks.storage.rows import BEGIN_NS, SPAN_NS, Amounts, Row, Table, id_of, time_of
from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND

BACKUP = 10
"""Kind of the ids of back-ups, beside those of `rows`."""

_BACKUP_COLUMNS = (
    "id",
    "state",
    "directory",
    "name",
    "due_ns",
    "began_ns",
    "ended_ns",
    "recordings",
    "files",
)
_ENTRY_COLUMNS = (
    "number", "time_ns", "actor", "origin", "roles", "action", "subject_kind", "subject", "previous", "hash",
)  # fmt: skip


def tables(amounts: Amounts) -> Iterator[Table]:
    """Yield the tables about the upkeep that grow."""
    yield Table("backups", _BACKUP_COLUMNS, _backups())
    yield Table("audit_entries", _ENTRY_COLUMNS, _entries(amounts))


def end_trail(connection: Connection, amounts: Amounts) -> None:
    """Make the last entry of the audit trail its head."""
    connection.execute(
        text("UPDATE audit_head SET number = :number, hash = :hash"),
        {"number": amounts.alarms, "hash": _hash(amounts.alarms)},
    )


def _backups() -> Iterator[Row]:
    for day in range(SPAN_NS // NANOSECONDS_PER_DAY):
        due_ns = BEGIN_NS + day * NANOSECONDS_PER_DAY
        ended_ns = due_ns + 60 * NANOSECONDS_PER_SECOND
        yield id_of(BACKUP, day), "verified", "/backups", f"{day}", due_ns, due_ns, ended_ns, 1000, 1000


def _entries(amounts: Amounts) -> Iterator[Row]:
    """Yield as many entries as there are alarms; their hashes are none that anybody verifies."""
    of = amounts.alarms
    for number in range(1, of + 1):
        motor = motor_name(number % amounts.motors)
        yield (
            number, time_of(number, of), f"person {number % 20}", "127.0.0.1", "OPERATOR",
            "recording-requested", "motor", motor, _hash(number - 1), _hash(number),
        )  # fmt: skip


def _hash(number: int) -> str:
    return f"{number:064x}"
