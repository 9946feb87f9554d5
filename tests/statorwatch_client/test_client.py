"""The typed client against a service on a real port: values, pages, files, errors."""

import io
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path

import pytest

from service.api import ApiContext, create_app
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import Sample
from statorwatch_client import Client, ServiceError
from testing.service.diagnosed import add_diagnosed
from testing.service.observations import observation
from testing.service.plants import NOW_NS, SECOND_NS, fault
from tests.service.api.serving import serving
from tests.service.fixtures import database_url, engine, migrated_sqlite, repository, store

__all__ = ["database_url", "engine", "migrated_sqlite", "repository", "store"]

MOTOR = "PUMP-A1"
RECORDS = 5
NOBODY_ID = "00000000-0000-4000-8000-000000000000"


@pytest.fixture
def plant(repository: Repository, store: RecordingStore, tmp_path: Path) -> Iterator[Client]:
    for number in range(RECORDS):
        at_ns = NOW_NS + number * 3600 * SECOND_NS
        add_diagnosed(repository, store, fault(0.02), at_ns, name=f"E{number}", observed=observation(number))
    repository.add_samples([Sample(MOTOR, NOW_NS, {"ia_A": 7.5})])
    with serving(create_app(ApiContext(Settings(data_directory=tmp_path), repository, store))) as served:
        token = served.headers["Authorization"].removeprefix("Bearer ")
        with Client(str(served.base_url), token=token) as client:
            yield client


def test_pages_follow_each_other(plant: Client) -> None:
    page = plant.get_trend(MOTOR, quantity="mu_f", limit=2)
    assert (len(page["items"]), page["next_cursor"] is None) == (2, False)
    points = list(plant.iter_trend(MOTOR, quantity="mu_f", limit=2))
    assert [point["value"] for point in points] == [0.02] * RECORDS
    assert points[0] == page["items"][0]


def test_values_are_sent_as_the_api_reads_them(plant: Client) -> None:
    healths = [motor["health"] for motor in plant.iter_motors(health=True)]
    assert all(health is not None for health in healths)
    since = datetime.fromtimestamp(NOW_NS / SECOND_NS + 2 * 3600, UTC)
    assert len(list(plant.iter_trend(MOTOR, from_=since))) == RECORDS - 2
    assert len(list(plant.iter_trend(MOTOR, from_=since.isoformat().replace("+00:00", "Z")))) == RECORDS - 2


def test_files_come_as_they_are(plant: Client) -> None:
    sink = io.BytesIO()
    assert plant.export_trend(sink, motor=[MOTOR, "FAN-A2"], format_="csv") == len(sink.getvalue())
    lines = sink.getvalue().decode().splitlines()
    assert (lines[0].split(",")[0], len(lines)) == ("motor", RECORDS + 1)


def test_what_is_changed_is_changed(plant: Client) -> None:
    note = plant.add_note(MOTOR, document={"kind": "note", "text": "bearing greased", "by": "Ann"})
    assert [each["id"] for each in plant.iter_notes(MOTOR)] == [note["id"]]
    withdrawn = plant.withdraw_note(MOTOR, note["id"], document={"reason": "another motor", "by": "Ann"})
    assert withdrawn["withdrawn_by"] == "Ann"
    made = plant.add_own_token(document={"label": "reader", "scope": ["view"]})
    with Client(plant.transport.url, token=made["token"]) as reader:
        assert MOTOR in [motor["name"] for motor in reader.iter_motors()]
        with pytest.raises(ServiceError) as refused:
            reader.request_event_report(MOTOR)
        assert refused.value.status == 403


def test_a_request_is_made_once_for_a_key(plant: Client) -> None:
    first = plant.request_event_report(MOTOR, idempotency_key="daily-7")
    assert plant.request_event_report(MOTOR, idempotency_key="daily-7")["id"] == first["id"]


def test_errors_say_what_and_why(plant: Client) -> None:
    with pytest.raises(ServiceError, match="NO-SUCH") as missing:
        plant.get_motor("NO-SUCH")
    assert missing.value.status == 404
    with pytest.raises(ServiceError, match="limit"):
        plant.list_motors(limit=0)
    with pytest.raises(ServiceError) as unknown:
        plant.download_recording(NOBODY_ID, io.BytesIO())
    assert unknown.value.status == 404
    with Client(plant.transport.url, token="nobodys") as stranger, pytest.raises(ServiceError) as refused:  # noqa: S106
        stranger.get_account()
    assert refused.value.status == 401


def test_names_are_one_segment_of_a_path(plant: Client) -> None:
    with pytest.raises(ServiceError) as wrong:
        plant.get_motor("../users")
    assert wrong.value.status in (404, 422)


@pytest.mark.parametrize("url", ["ftp://127.0.0.1", "127.0.0.1:8710", "http://user:secret@host:port"])
def test_an_address_that_is_none_is_refused_without_its_password(url: str) -> None:
    with pytest.raises(ServiceError, match="expected a URL") as refused:
        Client(url)
    assert "secret" not in str(refused.value)
