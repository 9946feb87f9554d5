"""The queries for Grafana give something on a real PostgreSQL, to a role that may only read."""

from collections.abc import Mapping
from pathlib import Path

import psycopg
import pytest
from sqlalchemy import make_url

from service.recording_store.folder import FolderStore
from service.storage import Repository, connect
from testing.service.conditions import FAULT, tell
from testing.service.job_runner import register_runner
from testing.service.plants import NOW_NS, fault, two_motor_plant
from testing.service.rotor_and_supply import BROKEN_ROTOR, SUPPLY, ExaminedRecordings
from tests.docs.pages import ROOT
from tests.service.fixtures import postgresql, postgresql_url

__all__ = ["postgresql", "postgresql_url"]

FILE = ROOT / "examples/monitoring/grafana-postgresql.sql"
DAY_NS = 86_400 * 10**9


def parts() -> Mapping[str, str]:
    """What stands below each name of the file."""
    found: dict[str, list[str]] = {}
    for line in FILE.read_text(encoding="utf-8").splitlines():
        for kind in ("-- role:", "-- query:"):
            if line.startswith(kind):
                found[line.removeprefix("-- ")] = []
                break
        else:
            if found:
                found[list(found)[-1]].append(line)
    return {name: "\n".join(lines) for name, lines in found.items()}


def as_grafana_sends_it(query: str) -> str:
    """The macros and the variable filled in."""
    filled = query.replace("$__unixEpochNanoFrom()", str(NOW_NS - DAY_NS))
    return filled.replace("$__unixEpochNanoTo()", str(NOW_NS + DAY_NS)).replace("$motor", "PUMP-A1")


@pytest.fixture
def seeded(postgresql_url: str, tmp_path: Path) -> str:
    """A plant of which each query has something to tell; the address as psycopg takes it."""
    engine = connect(postgresql_url)
    repository = Repository(engine)
    repository.sync_plant(two_motor_plant())
    register_runner(repository)
    store = FolderStore(tmp_path / "recordings")
    ExaminedRecordings(repository, store).add(BROKEN_ROTOR, SUPPLY, diagnosis=fault(0.03))
    tell(repository, FAULT)
    repository.settle_alarms(now_ns=NOW_NS)
    engine.dispose()
    return make_url(postgresql_url).set(drivername="postgresql").render_as_string(hide_password=False)


def test_each_query_gives_something_and_the_role_can_only_read(seeded: str) -> None:
    found = parts()
    (role,) = (name for name in found if name.startswith("role:"))
    with psycopg.connect(seeded, autocommit=True) as owner:
        owner.execute("DROP ROLE IF EXISTS grafana")
        for statement in found[role].split(";\n"):
            if statement.strip():
                owner.execute(statement.encode())
    with psycopg.connect(seeded, autocommit=True) as reader:
        reader.execute("SET ROLE grafana")
        for name, query in found.items():
            if name.startswith("query:"):
                assert reader.execute(as_grafana_sends_it(query).encode()).fetchall(), name
        for refused in ("SELECT * FROM users", "UPDATE motors SET site = ''", "SELECT * FROM api_tokens"):
            with pytest.raises(psycopg.errors.InsufficientPrivilege):
                reader.execute(refused.encode())
    with psycopg.connect(seeded, autocommit=True) as owner:
        owner.execute("DROP OWNED BY grafana")
        owner.execute("DROP ROLE grafana")


def test_the_level_is_in_percent_at_the_time_of_the_record(seeded: str) -> None:
    (query,) = (text for name, text in parts().items() if "fault level" in name)
    with psycopg.connect(seeded) as reader:
        (time, level, *_rest) = reader.execute(as_grafana_sends_it(query).encode()).fetchall()[0]
    assert time.timestamp() == NOW_NS / 10**9 + 1
    assert level == pytest.approx(3.0)
