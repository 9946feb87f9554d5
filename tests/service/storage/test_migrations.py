import json
from pathlib import Path

import pytest
from alembic import command
from sqlalchemy import Engine, inspect, text

from service.alarms.kinds import AlarmKind
from service.recording_store.store import RecordingStore
from service.storage import Repository, StorageError, connect, migrate
from service.storage.migrations import config
from service.storage.records import AlarmPlace, AlarmSpec
from service.storage.states import AlarmState
from testing.service.conditions import DRIFTING, tell
from testing.service.plants import NOW_NS, fault
from testing.service.tables import differences

ON_SQLITE = pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)


def test_migrations_make_the_tables_of_the_models(engine: Engine) -> None:
    with engine.connect() as connection:
        assert differences(connection) == []


def test_migrating_again_changes_nothing(database_url: str, engine: Engine) -> None:
    migrate(database_url)
    assert "recordings" in inspect(engine).get_table_names()


def test_an_older_database_is_brought_up_to_date_with_all_it_holds(
    database_url: str, engine: Engine, repository: Repository, store: RecordingStore
) -> None:
    stored = store.store({"EVENT.CFG": b"config", "EVENT.DAT": b"samples"})
    before = repository.add_recording(stored, motor="PUMP-A1", now_ns=NOW_NS).recording
    with engine.begin() as connection:
        command.downgrade(config(connection), "0001")
    migrate(database_url)
    test_migrations_make_the_tables_of_the_models(engine)
    assert repository.recordings(limit=10).items == (before,)
    assert not repository.add_recording(stored, motor="PUMP-A1", now_ns=NOW_NS).created


def test_a_newer_versions_database_is_left_alone(database_url: str, engine: Engine) -> None:
    with engine.begin() as connection:
        connection.execute(text("UPDATE alembic_version SET version_num = '9999'"))
    with pytest.raises(StorageError, match=r"revision \d{4} or older, found 9999: .* restore the back-up"):
        migrate(database_url)


@ON_SQLITE
def test_sqlite_is_shared_safely(engine: Engine) -> None:
    with engine.connect() as connection:
        pragmas = {
            name: connection.scalar(text(f"PRAGMA {name}"))
            for name in ("journal_mode", "synchronous", "foreign_keys", "busy_timeout")
        }
    assert pragmas == {"journal_mode": "wal", "synchronous": 2, "foreign_keys": 1, "busy_timeout": 30_000}


@pytest.mark.parametrize("url", ["not a url", "sqlite://", "sqlite:///:memory:"])
def test_a_url_that_cannot_be_shared_is_refused(url: str) -> None:
    with pytest.raises(StorageError, match="database_url"):
        connect(url)


def test_a_path_with_a_percent_sign(tmp_path: Path) -> None:
    migrate(f"sqlite:///{tmp_path / '100%.sqlite'}")
    assert (tmp_path / "100%.sqlite").is_file()


def test_a_database_of_the_first_version_keeps_what_it_holds(database_url: str) -> None:
    engine = connect(database_url)
    with engine.begin() as connection:
        command.downgrade(config(connection), "base")
        command.upgrade(config(connection), "0001")
        for statement in (
            "INSERT INTO sites VALUES ('FACTORY_A', 'Factory A', true)",
            "INSERT INTO ieds (name, site, host, port, manufacturer, type, in_service, link_state)"
            " VALUES ('A1', 'FACTORY_A', '10.0.0.7', 102, 'SEL', 'SEL-710', true, 'up')",
            "INSERT INTO motors VALUES ('PUMP-A1', 'pump', 'FACTORY_A', 'A1', true)",
            "INSERT INTO event_reports (id, motor, ied, state, requested_ns)"
            " VALUES ('r', 'PUMP-A1', 'A1', 'diagnosed', 5)",
            "INSERT INTO recordings (id, motor, ied, source, name, size_bytes, state, attempts, announced_ns)"
            " VALUES ('x', 'PUMP-A1', 'A1', 'relay', 'HR_1', 7, 'announced', 0, 5)",
        ):
            connection.execute(text(statement))
    migrate(database_url)
    repository = Repository(engine)
    assert repository.motor("PUMP-A1").schedule is None
    assert repository.recording_request("r").origin == "request"
    assert repository.recording("x").clock_quality is None
    assert repository.relay("A1").link_state == "up"
    assert repository.counts().recordings == {"announced": 1}
    assert repository.counts().recording_requests == {"diagnosed": 1}
    assert repository.link_changes("A1", limit=10).items == ()
    engine.dispose()


def test_an_older_diagnosis_keeps_its_scatter_under_that_name(
    database_url: str, engine: Engine, repository: Repository, store: RecordingStore
) -> None:
    """Versions before 0019 called the scatter the 95 % interval; what all causes add is not known of them."""
    stored = store.store({"EVENT.CFG": b"config", "EVENT.DAT": b"samples"})
    recording = repository.add_recording(stored, motor="PUMP-A1", now_ns=NOW_NS).recording
    repository.register_runner("runner", installation="here", now_ns=NOW_NS, max_attempts=3)
    claimed = repository.claim_job(now_ns=NOW_NS, runner="runner")
    assert claimed is not None
    repository.finish_job(claimed.job.id, fault(0.05), recorded_ns=NOW_NS, now_ns=NOW_NS, runner="runner")
    with engine.begin() as connection:
        command.downgrade(config(connection), "0018")
        before = connection.execute(text("SELECT mu_f_ci95_low, document FROM diagnoses")).one()
    document = before.document if isinstance(before.document, dict) else json.loads(before.document)
    assert before.mu_f_ci95_low == pytest.approx(0.049)
    assert document["mu_f_ci95"] == pytest.approx([0.049, 0.051])
    assert "mu_f_scatter95" not in document

    migrate(database_url)
    found = repository.current_diagnosis(recording.id)
    assert found is not None
    assert found.document["mu_f_ci95"] is None
    assert found.document["mu_f_scatter95"] == pytest.approx([0.049, 0.051])
    assert found.document["load_level_ci95"] is None
    assert found.document["load_level_scatter95"] == pytest.approx([0.47, 0.49])
    assert found.document["detection_limit"] == 0.021
    (level,) = repository.trend("PUMP-A1", "mu_f", limit=1).items
    assert level.ci95 is None
    assert level.scatter95 == pytest.approx((0.049, 0.051))
    assert level.detection_limit == 0.021
    (load,) = repository.trend("PUMP-A1", "load_level", limit=1).items
    assert (load.value, load.ci95) == (0.48, None)


def test_an_older_baseline_has_its_time_and_no_reason(
    database_url: str, engine: Engine, repository: Repository, store: RecordingStore
) -> None:
    ids = []
    for number in range(3):
        stored = store.store({"EVENT.CFF": b"record %d" % number})
        ids.append(repository.add_recording(stored, motor="PUMP-A1", now_ns=NOW_NS).recording.id)
    with engine.begin() as connection:
        command.downgrade(config(connection), "0023")
        for one in ids:
            insert = text("INSERT INTO baseline_recordings VALUES ('PUMP-A1', :id, :chosen_ns)")
            connection.execute(insert, {"id": one, "chosen_ns": NOW_NS})
    migrate(database_url)
    baseline = repository.baseline("PUMP-A1")
    assert {one.id for one in baseline.recordings} == set(ids)
    assert (baseline.chosen_ns, baseline.reason, baseline.by, baseline.doubts) == (NOW_NS, None, None, ())
    assert repository.baseline("FAN-A2").chosen_ns is None


def test_what_an_older_condition_may_be_is_not_known(
    database_url: str, engine: Engine, repository: Repository
) -> None:
    tell(repository, DRIFTING)
    with engine.begin() as connection:
        command.downgrade(config(connection), "0025")
    migrate(database_url)
    (change,) = repository.condition_history("PUMP-A1", limit=10).items
    assert (change.kind, change.candidates) == ("unclear", ())
    tell(repository, DRIFTING, now_ns=NOW_NS + 1)
    assert repository.condition("PUMP-A1").candidates == DRIFTING.candidates


def test_older_alarms_have_a_life_and_call_nobody(
    database_url: str, engine: Engine, repository: Repository
) -> None:
    stands = repository.raise_alarm("A1_SEL710", AlarmKind.FILE_REFUSED, "X", "outside", now_ns=NOW_NS)
    over = repository.raise_alarm("A1_SEL710", AlarmKind.DAILY_LIMIT, "", "full", now_ns=NOW_NS + 1)
    repository.clear_alarms("A1_SEL710", [over.id], now_ns=NOW_NS + 2)
    repository.raise_alarm_at(AlarmPlace(), AlarmSpec(AlarmKind.DISK_FILLING, "full"), now_ns=NOW_NS)
    with engine.begin() as connection:
        command.downgrade(config(connection), "0030")
        assert connection.scalar(text("SELECT count(*) FROM alarms")) == 2, "those of no relay are gone"
    migrate(database_url)
    assert [
        (one.id, one.state, one.site, one.raises, one.priority) for one in repository.alarms(limit=9).items
    ] == [
        (over.id, AlarmState.NORMAL, "FACTORY_A", 1, "low"),
        (stands.id, AlarmState.UNACKNOWLEDGED, "FACTORY_A", 1, "low"),
    ]
    assert [one.event for one in repository.alarm_changes(over.id, limit=9).items] == ["cleared", "raised"]
    with engine.connect() as connection:
        unrouted = text("SELECT count(*) FROM alarm_changes WHERE routed_ns IS NULL")
        assert connection.scalar(unrouted) == 0
    repository.clear_alarms("A1_SEL710", [stands.id], now_ns=NOW_NS + 3)
    assert repository.alarm(stands.id).state is AlarmState.RETURNED_UNACKNOWLEDGED


def test_every_step_leads_back(database_url: str) -> None:
    engine = connect(database_url)
    with engine.begin() as connection:
        command.downgrade(config(connection), "0001")
    assert "alarms" not in inspect(engine).get_table_names()
    assert "origin" not in {column["name"] for column in inspect(engine).get_columns("event_reports")}
    migrate(database_url)
    with engine.connect() as connection:
        assert differences(connection) == []
    engine.dispose()


def test_a_key_that_a_client_shares_with_a_schedule_stands_in_no_way_back(
    database_url: str, engine: Engine, repository: Repository
) -> None:
    repository.request_recording("PUMP-A1", now_ns=NOW_NS, idempotency_key=f"schedule {NOW_NS}")
    repository.fail_recording_request(
        repository.recording_requests(limit=1).items[0].id, "no record", now_ns=NOW_NS
    )
    assert repository.schedule_recording("PUMP-A1", due_ns=NOW_NS, now_ns=NOW_NS) is not None
    with engine.begin() as connection:
        command.downgrade(config(connection), "0016")
    migrate(database_url)
    assert len(repository.recording_requests(limit=10).items) == 2
