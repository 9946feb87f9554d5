"""How often the API asks the database: not more often because there is more in it."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import httpx
import pytest
from sqlalchemy import Connection, Engine, event

from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.states import AlarmKind, LinkState
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER
from testing.service.links import set_link_state
from testing.service.plants import NOW_NS, fault, motor, two_motor_plant

Asked = Callable[[str], Sequence[str]]


@pytest.fixture
def asked(engine: Engine, client: httpx.Client) -> Iterator[Asked]:
    """GET a path, and return the statements it takes."""
    statements: list[str] = []
    client.get("/api/v1/sites")  # the first use of a token is noted

    def note(_connection: Connection, _cursor: object, statement: str, *_: object) -> None:
        statements.append(statement)

    def ask(path: str) -> Sequence[str]:
        statements.clear()
        assert client.get(path).status_code == 200
        return tuple(statements)

    event.listen(engine, "before_cursor_execute", note)
    yield ask
    event.remove(engine, "before_cursor_execute", note)


@pytest.fixture
def recording_id(repository: Repository, store: RecordingStore) -> str:
    return repository.add_recording(
        store.store({"E.CFF": b"samples"}), motor="PUMP-A1", now_ns=NOW_NS
    ).recording.id


def diagnose(repository: Repository) -> None:
    claimed = repository.claim_job(now_ns=NOW_NS, runner=RUNNER)
    assert claimed is not None
    repository.finish_job(
        claimed.job.id, findings_of(fault()), recorded_ns=NOW_NS, now_ns=NOW_NS, runner=RUNNER
    )


def plan_of(engine: Engine, statement: str) -> list[str]:
    """How SQLite means to find what a statement asks for."""
    with engine.connect() as connection:
        bound = tuple(range(statement.count("?")))
        return [row[-1] for row in connection.exec_driver_sql(f"EXPLAIN QUERY PLAN {statement}", bound)]


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
def test_the_metrics_read_no_table_that_grows(
    asked: Asked, client: httpx.Client, repository: Repository, engine: Engine, recording_id: str
) -> None:
    diagnose(repository)
    statements = asked("/metrics")
    for table in ("recordings", "recording_requests", "jobs"):
        assert not [statement for statement in statements if f"FROM {table}" in statement]
    for statement in statements:
        if "FROM alarms" in statement:
            plan = " ".join(plan_of(engine, statement))
            assert "SEARCH alarms USING" in plan, "alarms that are over are passed by"
    (latest,) = [statement for statement in statements if "FROM diagnoses" in statement]
    assert "FROM motors" in latest, "one look into the index of the trend for each motor"
    plan = " ".join(plan_of(engine, latest))
    assert "SEARCH diagnoses_1 USING COVERING INDEX ix_diagnoses_trend (motor=?" in plan
    assert "SCAN diagnoses" not in plan
    figures = client.get("/metrics").text
    assert 'mcc_recordings{state="diagnosed"} 1.0' in figures
    assert 'mcc_jobs{state="done"} 1.0' in figures
    assert "fetched" not in figures


def test_the_metrics_leave_out_relays_that_left_the_plant(
    client: httpx.Client, repository: Repository
) -> None:
    set_link_state(repository, "A2_SEL710", LinkState.DOWN, "refused", now_ns=NOW_NS)
    for ied in ("A1_SEL710", "A2_SEL710"):
        repository.raise_alarm(ied, AlarmKind.DAILY_LIMIT, "", "full", now_ns=NOW_NS)
    plant = two_motor_plant()
    repository.sync_plant(replace(plant, relays=plant.relays[:1], motors=plant.motors[:1]))
    figures = client.get("/metrics").text
    assert 'mcc_links{state="unknown"} 1.0' in figures
    assert 'state="down"' not in figures
    assert 'mcc_alarms{kind="daily-limit"} 1.0' in figures


def test_the_health_of_many_motors_takes_no_more_statements_than_of_two(
    asked: Asked, client: httpx.Client, repository: Repository, recording_id: str
) -> None:
    diagnose(repository)
    path = "/api/v1/motors?health=true"
    few = asked(path)
    plant = two_motor_plant()
    more = tuple(replace(plant.motors[0], motor=motor(f"PUMP-B{number}")) for number in range(20))
    repository.sync_plant(replace(plant, motors=(*plant.motors, *more)))
    assert len(asked(path)) == len(few)
    listed = client.get(path).json()["items"]
    assert len(listed) == 22
    for one in listed:
        assert one["health"] == client.get(f"/api/v1/motors/{one['name']}/health").json()
    assert {one["name"]: one["health"]["verdict"] for one in listed if one["health"]["verdict"]} == {
        "PUMP-A1": "fault"
    }


def test_motors_are_listed_without_their_health_unless_it_is_asked_for(client: httpx.Client) -> None:
    for one in client.get("/api/v1/motors").json()["items"]:
        assert {**one, "winding": None} == client.get(f"/api/v1/motors/{one['name']}").json()


def test_many_diagnoses_take_no_more_statements_than_one(
    asked: Asked, client: httpx.Client, repository: Repository, recording_id: str
) -> None:
    path = f"/api/v1/recordings/{recording_id}/diagnoses"
    diagnose(repository)
    few = asked(path)
    for number in range(5):
        repository.request_diagnosis(recording_id, now_ns=NOW_NS + number)
    for _ in range(4):
        diagnose(repository)
    assert len(asked(path)) == len(few)
    runs = client.get(path).json()["items"]
    assert sorted((run["state"], run["result"] is not None) for run in runs) == [
        *[("done", True)] * 5,
        ("queued", False),
    ]


def test_a_diagnosis_of_another_recording_is_not_found(
    client: httpx.Client, repository: Repository, store: RecordingStore, recording_id: str
) -> None:
    other = repository.add_recording(store.store({"F.CFF": b"others"}), motor="PUMP-A1", now_ns=NOW_NS)
    (job,) = client.get(f"/api/v1/recordings/{recording_id}/diagnoses").json()["items"]
    assert client.get(f"/api/v1/recordings/{recording_id}/diagnoses/{job['id']}").status_code == 200
    assert client.get(f"/api/v1/recordings/{other.recording.id}/diagnoses/{job['id']}").status_code == 404
