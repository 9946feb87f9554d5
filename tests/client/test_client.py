"""The client package against a service on a real port."""

import asyncio
import csv
import io
import zipfile
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path

import httpx
import pytest
from fastapi import FastAPI

from service.api import ApiContext, create_app
from service.api.access.certificate import ServerCertificate
from service.api.server import connection_limits
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from statorwatch_client import AsyncClient, Client, ProblemError, ServiceError
from testing.relays.certificates import identity
from testing.service.diagnosed import add_diagnosed
from testing.service.plants import NOW_NS, SECOND_NS, fault
from testing.service.small_record import CFG, DAT
from tests.service.api.serving import listening, serving
from tests.service.fixtures import database_url, engine, migrated_sqlite, repository, store

__all__ = ["database_url", "engine", "migrated_sqlite", "repository", "store"]

MOTOR = "PUMP-A1"
FIRST_TIME = datetime.fromtimestamp(NOW_NS / 1e9, UTC)


@pytest.fixture
def app(repository: Repository, store: RecordingStore, tmp_path: Path) -> FastAPI:
    """A service with three recordings of a motor, an hour apart."""
    for number in range(3):
        told = fault(0.01 * (number + 1))
        add_diagnosed(repository, store, told, NOW_NS + number * 3600 * SECOND_NS, name=f"E{number}")
    return create_app(ApiContext(Settings(data_directory=tmp_path), repository, store))


@pytest.fixture
def served(app: FastAPI) -> Iterator[httpx.Client]:
    with serving(app) as client:
        yield client


@pytest.fixture
def token(served: httpx.Client) -> str:
    made = served.post("/api/v1/account/tokens", json={"label": "client"}).raise_for_status()
    return str(made.json()["token"])


@pytest.fixture
def client(served: httpx.Client, token: str) -> Iterator[Client]:
    with Client(str(served.base_url), token=token) as client:
        yield client


def test_a_list_is_followed_from_page_to_page(client: Client) -> None:
    whole = list(client.get_trend(MOTOR))
    assert [point["value"] for point in whole] == pytest.approx([0.01, 0.02, 0.03])
    assert list(client.get_trend(MOTOR, limit=1)) == whole


def test_times_are_texts_dates_or_datetimes(client: Client) -> None:
    later = FIRST_TIME + timedelta(minutes=30)
    for time in (later, later.isoformat(), later.astimezone(tz=None)):
        assert len(list(client.get_trend(MOTOR, from_=time))) == 2
    assert list(client.get_trend(MOTOR, to=FIRST_TIME.date())) == []


def test_a_refusal_is_a_problem_with_a_type(client: Client) -> None:
    with pytest.raises(ProblemError, match="NONE") as refused:
        client.get_motor("NONE/..")
    assert (refused.value.status, refused.value.problem["status"]) == (404, 404)
    with pytest.raises(ProblemError) as refused:
        next(client.get_trend(MOTOR, limit=0))
    (wrong,) = refused.value.problem["errors"] or []
    assert (refused.value.status, wrong["location"]) == (422, "query.limit")


def test_nobody_is_told_nothing(served: httpx.Client, token: str) -> None:
    for shown in (None, f"{token[:-4]}0000"):
        with Client(str(served.base_url), token=shown) as nobody, pytest.raises(ProblemError) as refused:
            nobody.get_account()
        assert refused.value.status == 401


def test_no_token_that_a_header_cannot_hold_is_sent_or_shown() -> None:
    with pytest.raises(ServiceError, match="expected a token") as refused:
        Client("http://127.0.0.1:9", token="sec\nret")  # noqa: S106 - none
    assert "sec" not in str(refused.value)


def test_a_file_is_saved_while_it_comes(client: Client, tmp_path: Path) -> None:
    recording = next(client.list_recordings(motor=MOTOR))
    with client.download_recording(recording["id"]) as file:
        assert file.media_type == "application/zip"
        assert file.name is not None
        size_bytes = file.save(tmp_path / file.name)
    assert (tmp_path / file.name).stat().st_size == size_bytes
    assert zipfile.is_zipfile(tmp_path / file.name)
    with client.get_trend_file(MOTOR, format="csv") as file:
        rows = list(csv.DictReader(io.StringIO("\n".join(file.iter_lines()))))
    assert [float(row["mu_f"]) for row in rows] == pytest.approx([0.01, 0.02, 0.03])
    with pytest.raises(ProblemError), client.download_recording("none"):
        pass


def test_an_upload_tells_whether_it_is_new(client: Client) -> None:
    files = {"EVENT.CFG": CFG, "EVENT.DAT": DAT}
    first, is_new = client.upload_recording("FAN-A2", files)
    again, is_new_again = client.upload_recording("FAN-A2", files)
    assert (is_new, is_new_again) == (True, False)
    assert first["id"] == again["id"]


def test_a_change_is_made_and_told(client: Client) -> None:
    kept = client.add_note(MOTOR, {"kind": "maintenance", "text": "looked at", "on_behalf_of": "me"})
    assert [note["id"] for note in client.list_notes(MOTOR)] == [kept["id"]]
    request = client.request_event_report(MOTOR, idempotency_key="once")
    assert client.request_event_report(MOTOR, idempotency_key="once")["id"] == request["id"]


def test_coroutines_do_the_same(served: httpx.Client, token: str, tmp_path: Path) -> None:
    async def ask() -> tuple[list[float | None], str, bytes, int | None]:
        async with AsyncClient(str(served.base_url), token=token) as client:
            values = [point["value"] async for point in client.get_trend(MOTOR, limit=2)]
            motor = await client.get_motor(MOTOR)
            async with client.get_trend_file(MOTOR, format="csv") as file:
                await file.save(tmp_path / "trend.csv")
            async with client.get_trend_file(MOTOR, format="csv") as file:
                text = await file.read()
            try:
                await client.get_motor("NONE")
            except ProblemError as error:
                return values, motor["name"], text, error.status
        raise AssertionError("there is no such motor")

    values, name, text, status = asyncio.run(ask())
    assert values == pytest.approx([0.01, 0.02, 0.03])
    assert (name, status) == (MOTOR, 404)
    assert (tmp_path / "trend.csv").read_bytes() == text


def test_an_authority_of_the_plant_is_trusted_where_its_file_is_named(app: FastAPI, tmp_path: Path) -> None:
    authority = identity(tmp_path, "authority", authority=True)
    own = identity(tmp_path, "mcc", issuer=authority)
    certificate = ServerCertificate(own.certificate_file, own.key_file)
    limits = connection_limits(app.state.context.settings)
    with listening(app, limits, certificate) as port:
        url = f"https://127.0.0.1:{port}"
        with Client(url, ca_file=authority.certificate_file) as client:
            assert client.get_health_of_service()["status"] == "ok"
        with Client(url) as client, pytest.raises(ServiceError, match="CERTIFICATE_VERIFY_FAILED"):
            client.get_health_of_service()
    with pytest.raises(ServiceError, match="expected certificates"):
        Client("https://127.0.0.1", ca_file=tmp_path / "none.pem")
