"""The service's periodic work as its API tells of it."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import httpx
import pytest
from sqlalchemy import Engine

from service.access.refusals import Refusals
from service.api import ApiContext, create_app
from service.application.parts import running
from service.background.workers import Periods, background_workers
from service.configuration.settings import Settings
from service.plant import Schedule
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import RecordingRequest, Series, SeriesHistory
from service.waveforms.computing import compute_here
from testing.service.plants import two_motor_plant
from testing.waiting import eventually
from tests.service.api.serving import serving
from tests.service.fixtures import database_url, engine, store

__all__ = ["database_url", "engine", "store"]

OFTEN = Periods(
    scheduling_s=0.01,
    housekeeping_s=0.01,
    retention_s=0.01,
    orphaned_requests_s=0.01,
    alarm_steps_s=0.01,
    alarm_sources_s=0.01,
    backups_s=0.01,
    joining_s=0.01,
    long_records_s=0.01,
    refusals_s=0.01,
)
PARTS = (
    "schedules",
    "housekeeping",
    "retention",
    "orphaned_requests",
    "alarm_steps",
    "alarm_sources",
    "backups",
    "joining",
    "long_records",
)


class FaultyRepository(Repository):
    """A repository with a bug in what one part calls, until the bug is mended."""

    part = ""

    def schedule_recording(
        self, motor: str, *, due_ns: int, now_ns: int, seconds: float | None = None
    ) -> RecordingRequest | None:
        self._fail_for("schedules")
        return super().schedule_recording(motor, due_ns=due_ns, now_ns=now_ns, seconds=seconds)

    def average_measurements(self, *, now_ns: int) -> None:
        self._fail_for("housekeeping")
        super().average_measurements(now_ns=now_ns)

    def discarded_folders(self) -> tuple[str, ...]:
        self._fail_for("retention")
        return super().discarded_folders()

    def held_relays(self) -> frozenset[str]:
        self._fail_for("orphaned_requests")
        return super().held_relays()

    def end_shelvings(self, *, now_ns: int) -> int:
        self._fail_for("alarm_steps")
        return super().end_shelvings(now_ns=now_ns)

    def gather_floods(self, most: int, *, now_ns: int) -> int:
        self._fail_for("alarm_sources")
        return super().gather_floods(most, now_ns=now_ns)

    def is_backup_due(self, due_ns: int, *, now_ns: int) -> bool:
        self._fail_for("backups")
        return super().is_backup_due(due_ns, now_ns=now_ns)

    def series_to_join(self, *, now_ns: int) -> tuple[Series, ...]:
        self._fail_for("joining")
        return super().series_to_join(now_ns=now_ns)

    def series_history(self, motor: str) -> SeriesHistory:
        self._fail_for("long_records")
        return super().series_history(motor)

    def _fail_for(self, part: str) -> None:
        if part == self.part:
            raise RuntimeError("a bug")


class AlwaysDue(Schedule):
    """A schedule that does not make the test wait for a full minute."""

    def next_after(self, time_ns: int) -> int:
        return time_ns + 1


@contextmanager
def serving_workers(repository: Repository, store: RecordingStore, directory: Path) -> Iterator[httpx.Client]:
    backup = {"directory": directory / "backups"}
    settings = Settings.model_validate({"data_directory": directory, "backup": backup, "long_record_days": 7})
    plant = two_motor_plant()
    often = tuple(replace(motor, schedule=AlwaysDue("* * * * *")) for motor in plant.motors)
    workers = background_workers(
        settings,
        replace(plant, motors=often),
        repository,
        store,
        gateway_problem=lambda: None,
        restart_delay_s=0.0,
        compute=compute_here,
        refusals=Refusals(),
        periods=OFTEN,
    )
    readiness = {name: worker.problem for name, worker in workers.items()}
    with (
        running(workers.values()),
        serving(create_app(ApiContext(settings, repository, store, readiness=readiness))) as client,
    ):
        yield client


@pytest.mark.parametrize("part", PARTS)
def test_work_that_fails_shows_in_the_readiness_and_is_tried_again(
    engine: Engine, store: RecordingStore, tmp_path: Path, part: str
) -> None:
    faulty = FaultyRepository(engine)
    faulty.sync_plant(two_motor_plant())
    with serving_workers(faulty, store, tmp_path) as client:

        def parts() -> dict[str, str]:
            found: dict[str, str] = client.get("/readyz").json()["parts"]
            return found

        others = dict.fromkeys({"database", "refusals", *PARTS} - {part}, "ready")
        faulty.part = part
        assert eventually(lambda: parts() == {**others, part: "RuntimeError: a bug"})
        assert client.get("/readyz").status_code == 503
        faulty.part = ""
        assert eventually(lambda: client.get("/readyz").status_code == 200)
