"""The service backs itself up once a day, and knows when it did."""

from datetime import UTC, datetime
from pathlib import Path

import pytest

from core.units import NANOSECONDS_PER_DAY as DAY_NS
from core.units import NANOSECONDS_PER_SECOND as SECOND_NS
from service.background.backups import DailyBackup, latest_due_ns
from service.backup.layout import backups_in
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.states import BackupState
from tests.service.fixtures import database_url, engine, repository, store

__all__ = ["database_url", "engine", "repository", "store"]


def at(text: str) -> int:
    return int(datetime.fromisoformat(f"{text}+00:00").timestamp()) * SECOND_NS


@pytest.mark.parametrize(
    ("now", "due"),
    [
        ("2026-11-23T02:29:59", "2026-11-22T02:30:00"),
        ("2026-11-23T02:30:00", "2026-11-23T02:30:00"),
        ("2026-03-01T00:00:00", "2026-02-28T02:30:00"),
    ],
)
def test_the_latest_due_time(now: str, due: str) -> None:
    assert latest_due_ns("02:30", at(now)) == at(due)


def settings_of(directory: Path, **backup: object) -> Settings:
    table = {"directory": directory / "copies", "daily_at": "00:00", "keep": 2, **backup}
    return Settings.model_validate({"data_directory": directory, "backup": table})


def now_ns() -> int:
    return int(datetime.now(UTC).timestamp()) * SECOND_NS


def test_each_day_has_its_back_up_and_the_oldest_go(
    repository: Repository, store: RecordingStore, tmp_path: Path
) -> None:
    assert store
    daily = DailyBackup(settings_of(tmp_path), repository)
    for day in range(3):
        for hour in range(2):
            daily.back_up_if_due(now_ns() + day * DAY_NS + hour)
    names = backups_in(tmp_path / "copies")
    states = [one.state for one in repository.backups(limit=10).items]
    assert (len(names), states) == (2, [BackupState.VERIFIED] * 3)


def test_one_that_fails_says_why_and_is_tried_again(
    repository: Repository, store: RecordingStore, tmp_path: Path
) -> None:
    assert store
    (tmp_path / "copies").write_text("a file in its place")
    daily = DailyBackup(settings_of(tmp_path), repository)
    daily.back_up_if_due(now_ns())
    assert repository.latest_verified_backup() is None
    (tmp_path / "copies").unlink()
    daily.back_up_if_due(now_ns() + 3601 * SECOND_NS)
    assert repository.latest_verified_backup() is not None


def test_without_a_directory_none_is_made(repository: Repository, tmp_path: Path) -> None:
    DailyBackup(Settings(data_directory=tmp_path), repository).back_up_if_due(now_ns())
    assert repository.backups(limit=1).items == ()
