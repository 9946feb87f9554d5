"""Lists as long as they may be, asked for by many at once."""

import json
import sqlite3
import uuid
from collections.abc import Callable, Mapping
from contextlib import closing
from pathlib import Path

from benchmarks.attacks.attack import Attack, Statuses, Target, at_once
from benchmarks.attacks.recordings import RECORDINGS, form_of, uploaded

EXAMPLES = Path(__file__).parents[2] / "examples"
EXAMPLE = ("RUNNING.CFG", "RUNNING.DAT")
ROWS = 1000
SECOND_NS = 1_000_000_000
BEGIN_NS = 1_760_000_000 * SECOND_NS
REASONS = ["the record is one of many, and its reasons are as long as those of others, or longer"] * 36
"""With them the document of a diagnosis has some 3.6 kB."""

Row = Mapping[str, object]


def _diagnoses(target: Target) -> Target:
    """Leave a recording with so many diagnoses, copies of its own."""
    found = uploaded(target, form_of(*((EXAMPLES / name).read_bytes() for name in EXAMPLE)))
    with closing(sqlite3.connect(target.database, timeout=60)) as database, database:
        job, diagnosis = _row(database, "jobs"), _row(database, "diagnoses")
        document = json.dumps(json.loads(str(diagnosis["document"])) | {"reasons": REASONS})
        for number in range(ROWS):
            job = {**job, "id": str(uuid.uuid4()), "created_ns": BEGIN_NS + number}
            keys = {"id": str(uuid.uuid4()), "job_id": job["id"], "current": False}
            _insert(database, "jobs", job)
            _insert(database, "diagnoses", {**diagnosis, **keys, "document": document})
    return found


def _measurements(target: Target) -> Target:
    """Leave so many measurements of a motor, with all quantities."""
    with closing(sqlite3.connect(target.database, timeout=60)) as database, database:
        columns = [name for _, name, *_ in database.execute("PRAGMA table_info(measurements)")]
        for number in range(ROWS):
            values = dict.fromkeys(columns, 1234.56789 + number / 7)
            time_ns = BEGIN_NS + number * 900 * SECOND_NS
            key = {"motor": "PUMP-A1", "step_s": 900, "time_ns": time_ns, "samples": 1}
            _insert(database, "measurements", values | key)
    return target


def _row(database: sqlite3.Connection, table: str) -> Row:
    cursor = database.execute(f"SELECT * FROM {table}")  # noqa: S608 - own names
    return dict(zip([column for column, *_ in cursor.description], cursor.fetchone(), strict=True))


def _insert(database: sqlite3.Connection, table: str, row: Row) -> None:
    places = ", ".join(f":{name}" for name in row)
    database.execute(f"INSERT INTO {table} ({', '.join(row)}) VALUES ({places})", row)  # noqa: S608 - own names


def _lists(times: int, path: str) -> Callable[[Target], Statuses]:
    return lambda target: at_once(times, lambda: target.ask("GET", path.format(target.recording)))


_DIAGNOSES = f"{RECORDINGS}/{{}}/diagnoses"
_MEASUREMENTS = "/api/v1/motors/PUMP-A1/measurements?step=900&limit=1000"

ATTACKS = (
    Attack("diagnoses, 30 at once, 1000 of each", _lists(30, f"{_DIAGNOSES}?limit=1000"), _diagnoses),
    Attack("diagnoses, 60 long lists at once", _lists(60, f"{_DIAGNOSES}?limit=100"), _diagnoses),
    Attack("measurements, 60 long lists at once", _lists(60, _MEASUREMENTS), _measurements),
    Attack("measurements, 150 long lists at once", _lists(150, _MEASUREMENTS), _measurements),
)
