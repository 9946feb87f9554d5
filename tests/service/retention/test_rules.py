"""Old recordings, and what belongs to them, are deleted by rules: never the newest, never a baseline."""

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from sqlalchemy import Engine
from sqlalchemy.orm import Session

from core.diagnosis.verdict import Diagnosis
from core.units import NANOSECONDS_PER_DAY as DAY_NS
from service.background.retention import Retention
from service.cli.app import main
from service.configuration.retention import RetentionSettings
from service.configuration.settings import Settings, SettingsError
from service.recording_store.folder import FolderStore
from service.retention.batches import Batches, Pace
from service.retention.rules import rules
from service.storage import Repository
from service.storage.records import SERVICE, Amount, Sample
from service.storage.states import DeletedBy
from service.timing.wall_clock import SETTLING_S
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER
from testing.service.plants import NOW_NS, SECOND_NS, fault, healthy, undiagnosable

MOTOR = "PUMP-A1"
WHOLE = Pace(round_s=600.0)
"""A round that ends by itself, also where one deletion takes a busy machine twenty seconds."""
SETTLED_NS = round(SETTLING_S * SECOND_NS)


def uploaded(
    repository: Repository, store: FolderStore, day: int, diagnosis: Diagnosis | None, motor: str = MOTOR
) -> str:
    """A recording of some day, diagnosed at once, or rejected."""
    at_ns = NOW_NS + day * DAY_NS
    stored = store.store({f"D{day}.CFF": f"{motor} {day}".encode()})
    added = repository.add_recording(stored, motor=motor, now_ns=at_ns).recording
    claimed = repository.claim_job(now_ns=2**62, runner=RUNNER)
    assert claimed is not None
    if diagnosis is None:
        repository.reject_recording(claimed.job.id, "cannot be read", now_ns=at_ns, runner=RUNNER)
    else:
        repository.finish_job(
            claimed.job.id, findings_of(diagnosis), recorded_ns=at_ns, now_ns=at_ns, runner=RUNNER
        )
    return added.id


def left(repository: Repository, motor: str = MOTOR) -> list[str]:
    return [entry.id for entry in repository.recordings(motor=motor, limit=100).items]


def settings_of(directory: Path, **kept: object) -> Settings:
    return Settings.model_validate({"data_directory": directory, "retention": {"keep_newest": 1, **kept}})


def apply(settings: Settings, repository: Repository, day: float) -> dict[str, tuple[Amount, int]]:
    """What each rule would delete, and how many it did."""
    now_ns = NOW_NS + round(day * DAY_NS)
    return {
        rule.setting.removeprefix("retention."): (rule.amount(), rule.forget(Batches(WHOLE)))
        for rule in rules(settings, repository, now_ns)
        if rule.days is not None
    }


def test_each_verdict_and_state_has_its_time(
    repository: Repository, store: FolderStore, tmp_path: Path
) -> None:
    kinds = {"healthy": healthy(), "fault": fault(), "undiagnosable": undiagnosable(), "rejected": None}
    ids = {
        name: [uploaded(repository, store, day, result) for day in (number, 10 + number)]
        for number, (name, result) in enumerate(kinds.items())
    }
    newest = uploaded(repository, store, 20, fault())
    settings = settings_of(tmp_path, healthy_days=15, undiagnosable_days=5, rejected_days=5)
    done = apply(settings, repository, 21)
    assert {name: number for name, (_, number) in done.items() if number} == {
        "healthy_days": 1,
        "undiagnosable_days": 2,
        "rejected_days": 2,
    }
    amount, _ = done["healthy_days"]
    assert amount == Amount(1, len(f"{MOTOR} 0"), NOW_NS, NOW_NS)
    assert left(repository) == [newest, ids["fault"][1], ids["healthy"][1], ids["fault"][0]]
    told = {deletion.id: deletion for deletion in repository.deletions(limit=10).items}
    assert told.keys() == {ids["healthy"][0], *ids["undiagnosable"], *ids["rejected"]}
    assert told[ids["healthy"][0]].deleted_by is DeletedBy.RETENTION
    assert told[ids["healthy"][0]].reason == "older than retention.healthy_days = 15"


def test_what_a_rule_deletes_is_told_in_the_audit_trail(
    repository: Repository, store: FolderStore, tmp_path: Path
) -> None:
    ids = [uploaded(repository, store, day, healthy()) for day in range(3)]
    before = repository.audit_entries(limit=1).items[0].number
    apply(settings_of(tmp_path, healthy_days=1, keep_newest=1), repository, 1000)
    apply(settings_of(tmp_path, healthy_days=1, deletions_days=1), repository, 2000)
    entries = [entry for entry in repository.audit_entries(limit=10).items if entry.number > before]
    assert {(entry.actor, entry.origin, entry.action) for entry in entries} == {
        ("statorwatch", "service", "retention-applied")
    }
    told = [(entry.subject, json.loads(entry.before or "")) for entry in entries]
    recordings = [one for rule, values in told for one in values.get("recordings", ())]
    assert set(recordings) < set(ids)
    assert sum(values["deleted"] for rule, values in told if rule == "retention.healthy_days") == 2
    assert sum(values["deleted"] for rule, values in told if rule == "retention.deletions_days") == 2


def test_the_newest_and_the_baseline_stay(repository: Repository, store: FolderStore, tmp_path: Path) -> None:
    ids = [uploaded(repository, store, day, healthy()) for day in range(8)]
    alone = uploaded(repository, store, 0, healthy(), "FAN-A2")
    repository.set_baseline(MOTOR, ids[:3], by=SERVICE, now_ns=NOW_NS)
    settings = settings_of(tmp_path, healthy_days=1, keep_newest=2)
    assert apply(settings, repository, 1000)["healthy_days"][1] == 3
    assert left(repository) == [ids[7], ids[6], *ids[2::-1]]
    assert left(repository, "FAN-A2") == [alone]
    assert apply(settings, repository, 1000)["healthy_days"] == (Amount(0, 0, None, None), 0)


def test_an_old_record_that_comes_late_pushes_no_newer_one_out(
    repository: Repository, store: FolderStore, tmp_path: Path
) -> None:
    newest = uploaded(repository, store, 0, healthy())
    late = repository.add_recording(
        store.store({"LATE.CFF": b"late"}), motor=MOTOR, now_ns=NOW_NS + DAY_NS
    ).recording.id
    claimed = repository.claim_job(now_ns=2**62, runner=RUNNER)
    assert claimed is not None
    recorded_ns = NOW_NS - 100 * DAY_NS
    repository.finish_job(
        claimed.job.id, findings_of(healthy()), recorded_ns=recorded_ns, now_ns=NOW_NS, runner=RUNNER
    )
    assert apply(settings_of(tmp_path, healthy_days=1), repository, 1000)["healthy_days"][1] == 0
    assert left(repository) == [late, newest]


class InterruptedRepository(Repository):
    """Something happens after the expired recordings were chosen, and before the first is deleted."""

    def __init__(self, engine: Engine, happens: Callable[[], object]) -> None:
        super().__init__(engine)
        self._happens: Callable[[], object] | None = happens

    @contextmanager
    def _write(self, *, ahead: bool = False) -> Iterator[Session]:
        happens, self._happens = self._happens, None
        if happens is not None:
            happens()
        with super()._write(ahead=ahead) as session:
            yield session


def test_a_recording_whose_verdict_changes_meanwhile_stays(
    repository: Repository, store: FolderStore, engine: Engine, tmp_path: Path
) -> None:
    ids = [uploaded(repository, store, day, healthy()) for day in range(3)]

    def diagnose_again() -> None:
        repository.request_diagnosis(ids[0], now_ns=NOW_NS)
        claimed = repository.claim_job(now_ns=2**62, runner=RUNNER)
        assert claimed is not None
        repository.finish_job(
            claimed.job.id, findings_of(fault()), recorded_ns=NOW_NS, now_ns=NOW_NS, runner=RUNNER
        )

    interrupted = InterruptedRepository(engine, diagnose_again)
    assert apply(settings_of(tmp_path, healthy_days=1), interrupted, 1000)["healthy_days"][1] == 1
    assert left(repository) == [ids[2], ids[0]]


def test_a_recording_that_becomes_the_newest_meanwhile_stays(
    repository: Repository, store: FolderStore, engine: Engine, tmp_path: Path
) -> None:
    ids = [uploaded(repository, store, day, healthy()) for day in range(2)]
    interrupted = InterruptedRepository(
        engine, lambda: repository.delete_recording(ids[1], "of another motor", now_ns=NOW_NS)
    )
    assert apply(settings_of(tmp_path, healthy_days=1), interrupted, 1000)["healthy_days"][1] == 0
    assert left(repository) == ids[:1]


def test_what_is_no_recording_has_its_times_too(
    repository: Repository, store: FolderStore, tmp_path: Path
) -> None:
    recording_id = uploaded(repository, store, 0, fault())
    repository.request_diagnosis(recording_id, now_ns=NOW_NS)
    claimed = repository.claim_job(now_ns=2**62, runner=RUNNER)
    assert claimed is not None
    repository.finish_job(
        claimed.job.id, findings_of(fault()), recorded_ns=NOW_NS, now_ns=NOW_NS, runner=RUNNER
    )
    uploaded(repository, store, 1, None)
    ended = repository.request_recording(MOTOR, now_ns=NOW_NS)
    repository.fail_recording_request(ended.id, "a test", now_ns=NOW_NS)
    waiting = repository.request_recording(MOTOR, now_ns=NOW_NS)
    repository.delete_recording(uploaded(repository, store, 2, fault()), "a test", now_ns=NOW_NS)
    names = ("superseded_diagnoses_days", "failed_jobs_days", "event_reports_days", "deletions_days")
    settings = settings_of(tmp_path, **dict.fromkeys(names, 30))
    assert {name: apply(settings, repository, 20)[name][1] for name in names} == dict.fromkeys(names, 0)
    done = apply(settings, repository, 40)
    assert {name: done[name][1] for name in names} == dict.fromkeys(names, 1)
    assert all(done[name][0].size_bytes > 0 for name in names)
    assert len(repository.jobs(recording_id, limit=10).items) == 1
    assert repository.current_diagnosis(recording_id) is not None
    assert [one.id for one in repository.recording_requests(limit=10).items] == [waiting.id]
    assert repository.deletions(limit=10).items == ()


def test_without_settings_everything_is_kept(
    repository: Repository, store: FolderStore, tmp_path: Path
) -> None:
    uploaded(repository, store, 0, fault())
    uploaded(repository, store, 1, None)
    kept = {name for name in RetentionSettings.model_fields if name.startswith("keep_")}
    assert RetentionSettings().model_dump(exclude=kept, exclude_none=True) == {}
    assert apply(Settings(data_directory=tmp_path), repository, 3000) == {}
    assert len(left(repository)) == 2


def test_the_rules_are_applied_once_a_day_by_a_clock_that_can_be_trusted(
    repository: Repository, store: FolderStore, tmp_path: Path
) -> None:
    ids = [uploaded(repository, store, day, healthy()) for day in range(3)]
    retention = Retention(settings_of(tmp_path, healthy_days=2), repository, store)
    retention.delete_old(NOW_NS + 5 * DAY_NS // 2, 0)
    assert len(left(repository)) == 3, "nobody knows yet whether the clock is right"
    retention.delete_old(NOW_NS + 5 * DAY_NS // 2 + SETTLED_NS, SETTLED_NS)
    assert left(repository) == ids[:0:-1]
    assert len(list(store.root.glob("??/*"))) == 2
    retention.delete_old(NOW_NS + 13 * DAY_NS // 4 + SETTLED_NS, 3 * DAY_NS // 4 + SETTLED_NS)
    assert left(repository) == ids[:0:-1], "not yet"
    retention.delete_old(NOW_NS + 7 * DAY_NS // 2 + SETTLED_NS, DAY_NS + SETTLED_NS)
    assert left(repository) == ids[2:]


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
def test_the_command_shows_what_would_go_and_deletes_it(
    repository: Repository, store: FolderStore, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    ids = [uploaded(repository, store, day, healthy()) for day in range(3)]
    config = tmp_path / "mcc.toml"
    config.write_text('data_directory = "."\n[retention]\nhealthy_days = 30\nkeep_newest = 1\n')
    where = ["--config", str(config)]
    assert main(["retention", "--dry-run", *where]) == 0
    shown = capsys.readouterr().out
    assert "retention.healthy_days" in shown
    assert "2025-10-09 08:53:20 UTC" in shown
    assert "not set, so all is kept: retention.watch_days" in shown
    assert len(left(repository)) == 3
    assert main(["retention", "--json", *where]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["dry_run"] is False
    rule = document["rules"][0]
    assert (rule["rule"], rule["days"], rule["rows"], rule["deleted"]) == ("retention.healthy_days", 30, 2, 2)
    assert left(repository) == ids[2:]
    assert len(list(store.root.glob("??/*"))) == 1
    entry = repository.audit_entries(limit=1).items[0]
    assert (entry.origin, entry.action, entry.subject) == (
        "command line",
        "retention-applied",
        "retention.healthy_days",
    )


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
def test_the_command_deletes_no_measured_value_that_was_not_averaged(
    repository: Repository, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The service was off for longer than samples are kept; it averages them when it starts."""
    samples = [Sample(MOTOR, NOW_NS + number * SECOND_NS, {"ia_A": 1.0}) for number in range(3)]
    repository.add_samples(samples)
    config = tmp_path / "mcc.toml"
    config.write_text('data_directory = "."\nmetering_sample_days = 1\n')
    assert main(["retention", "--config", str(config)]) == 0
    assert "metering" not in capsys.readouterr().out
    assert len(repository.measurements(MOTOR, 0, limit=10).items) == 3


def test_the_command_makes_no_database(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    config = tmp_path / "mcc.toml"
    config.write_text('data_directory = "."\n')
    for more in ([], ["--dry-run"]):
        assert main(["retention", *more, "--config", str(config)]) == 1
        told = capsys.readouterr().err
        assert "database_url: expected an SQLite file, found none at " in told
        assert "start the service once" in told
        assert "sqlalche.me" not in told
    assert list(tmp_path.iterdir()) == [config]
    (tmp_path / "statorwatch.sqlite").touch()
    assert main(["retention", "--dry-run", "--config", str(config)]) == 1
    assert "found none: start the service once" in " ".join(capsys.readouterr().err.split())


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("[retention]\nhealthy_days = 0", "retention.healthy_days.*: expected greater than or equal to 1"),
        ("[retention]\nhealthy = 5", "retention.healthy: expected a setting named in"),
        ("[retention]\nkeep_newest = 0", "retention.keep_newest: expected greater than or equal to 1"),
    ],
)
def test_what_is_wrong_with_a_rule_is_named(tmp_path: Path, content: str, message: str) -> None:
    config = tmp_path / "mcc.toml"
    config.write_text(content)
    with pytest.raises(SettingsError, match=message):
        Settings.load(config)
