"""How the database finds what the API asks for."""

import asyncio
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from http import HTTPStatus
from typing import Any

import httpx
from fastapi import FastAPI
from sqlalchemy import Connection, Engine, event

from service.client.credentials import bearer

GROWING = frozenset(
    {
        "recordings",
        "recording_files",
        "remote_records",
        "recording_requests",
        "jobs",
        "diagnoses",
        "measurements",
        "alarms",
        "alarm_changes",
        "audit_entries",
        "backups",
        "link_changes",
        "deletions",
        "deleted_remote_records",
        "observations",
        "outlines",
        "condition_changes",
        "condition_days",
        "condition_events",
        "rotor_findings",
        "starts",
        "relay_events",
        "relay_statistics",
        "record_figures",
    }
)
"""Tables that have more rows every day."""

PARTIAL = {
    "ix_alarms_standing_raised_ns_id": "cleared_ns",
    "ix_alarms_standing_ied_raised_ns_id": "cleared_ns",
    "ix_alarms_cleared_raised_ns_id": "cleared_ns",
    "ix_alarms_cleared_ied_raised_ns_id": "cleared_ns",
    "ix_alarms_standing_motor_raised_ns_id": "cleared_ns",
    "ix_alarms_cleared_motor_raised_ns_id": "cleared_ns",
    "ix_alarm_changes_announced": "after",
    "ix_alarms_open_urgency_raised_ns_id": "state",
    "ix_alarms_open_site_urgency": "state",
    "ix_alarms_open_ied_urgency": "state",
    "ix_alarms_open_motor_urgency": "state",
    "ix_rotor_course_time_ns": "condition",
    "ix_rotor_course_load_bin": "condition",
    "ix_rotor_course_condition": "condition",
    "ix_record_figures_air_gap": "air_gap",
    "ix_record_figures_supply": "supply",
}
"""Indexes that have just the rows of one filter, and the column that it is about."""

PASSED_BY_ALL = {"observations": "state"}
"""Columns of filters that nearly every row passes, by table: all but the latest observations are folded."""

_STEP = re.compile(
    r"(?P<how>SCAN|SEARCH) (?P<table>\w+?)(?:_\d+)?(?= |$)"
    r"(?: USING (?:COVERING |AUTOMATIC |PARTIAL )*INDEX (?P<index>\w+)(?: \((?P<found_by>.*)\))?)?"
)
_PAGE = re.compile(r"ORDER BY [^()]*LIMIT \S+(?: OFFSET \S+)?\s*$")
_SEQUENTIAL = re.compile(r"Seq Scan on (?P<table>\w+)")


@dataclass(frozen=True, slots=True)
class Statement:
    """A statement that was sent to the database."""

    text: str
    parameters: Any

    def plan(self, connection: Connection) -> Sequence[str]:
        """Return the steps by which the database would answer it."""
        explain = "EXPLAIN QUERY PLAN" if connection.dialect.name == "sqlite" else "EXPLAIN"
        found = connection.exec_driver_sql(f"{explain} {self.text}", self.parameters)
        return [str(row[-1]).strip() for row in found]


def statements_of(app: FastAPI, engine: Engine, path: str) -> Sequence[Statement]:
    """Return the SELECT statements that the API sends to its database to answer a GET request."""
    with noted(engine) as statements:
        asyncio.run(_get(app, path))
    return statements


def whole_scans(statement: Statement, plan: Sequence[str]) -> Sequence[str]:
    """Return those steps of a plan that read, or sort, as much as a growing table or a motor's part holds.

    Of a page, an index must find by all columns that the filters name, and give the rows in order: then the
    page's limit ends it.
    """
    return [step for step in plan if _reads_all(step, statement.text)]


@contextmanager
def noted(engine: Engine) -> Iterator[list[Statement]]:
    """Note the SELECT statements that are sent to the database while the block runs."""
    statements: list[Statement] = []

    def note(_connection: Connection, _cursor: object, text: str, parameters: object, *_: object) -> None:
        if text.startswith("SELECT"):
            statements.append(Statement(text, parameters))

    event.listen(engine, "before_cursor_execute", note)
    try:
        yield statements
    finally:
        event.remove(engine, "before_cursor_execute", note)


async def _get(app: FastAPI, path: str) -> None:
    transport = httpx.ASGITransport(app)
    headers = bearer(app.state.token)
    async with httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1", headers=headers) as client:
        answer = await client.get(path)
    assert answer.status_code == HTTPStatus.OK, f"{path}: {answer.status_code} {answer.text[:300]}"


def _reads_all(step: str, text: str) -> bool:
    sequential = _SEQUENTIAL.search(step)
    if sequential is not None:
        return sequential["table"] in GROWING
    is_page = _PAGE.search(text) is not None
    if step.startswith("USE TEMP B-TREE FOR") and step.endswith("ORDER BY"):
        return is_page
    found = _STEP.match(step)
    if found is None or found["table"] not in GROWING:
        return False
    if found["how"] == "SCAN" and (found["index"] is None or not is_page):
        return True
    return is_page and not _filters(text, found["table"]) <= {
        *re.findall(r"\w+", found["found_by"] or ""),
        PARTIAL.get(found["index"], ""),
    }


def _filters(text: str, table: str) -> set[str]:
    """Return the columns of a table that a statement compares with one value."""
    where = text.partition("WHERE")[2]
    return set(re.findall(rf"\b{table}(?:_\d+)?\.(\w+) (?:=|IS)", where)) - {PASSED_BY_ALL.get(table)}
