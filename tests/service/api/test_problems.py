"""Every error has one shape: an RFC 9457 problem document."""

import sqlite3
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import httpx
import pytest
from sqlalchemy import Engine

from service.api import ApiContext, create_app
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository, connect
from testing.service.plants import two_motor_plant
from tests.service.api.serving import serving

NO_SUCH_ID = "00000000-0000-0000-0000-000000000000"


@pytest.mark.parametrize(
    ("method", "path", "status"),
    [
        ("GET", "/nothing", 404),
        ("GET", "/api/v1/motors/NOPE", 404),
        ("GET", "/api/v1/motors/NOPE/trend", 404),
        ("GET", "/api/v1/motors/NOPE/health", 404),
        ("GET", "/api/v1/motors/NOPE/recordings", 404),
        ("GET", "/api/v1/ieds/NOPE", 404),
        ("GET", f"/api/v1/recordings/{NO_SUCH_ID}", 404),
        ("GET", f"/api/v1/recordings/{NO_SUCH_ID}/diagnoses", 404),
        ("GET", f"/api/v1/recordings/{NO_SUCH_ID}/diagnoses/{NO_SUCH_ID}", 404),
        ("POST", f"/api/v1/recordings/{NO_SUCH_ID}/diagnoses", 404),
        ("DELETE", "/api/v1/motors", 405),
        ("GET", "/api/v1/motors?limit=0", 422),
        ("GET", "/api/v1/motors?cursor=nonsense", 422),
        ("GET", "/api/v1/motors?cursor=WzFd", 422),
        ("GET", "/api/v1/event-reports?cursor=WzFlOTk5LCAieCJd", 422),
        ("GET", "/api/v1/motors?cursor=WyJcdWQ4MDAiXQ", 422),  # ["\ud800"], half a surrogate pair
        ("GET", "/api/v1/motors?cursor=WyJcdTAwMDAiXQ", 422),  # ["\u0000"]
        ("GET", "/api/v1/motors/PUMP-A1/trend?from=yesterday", 422),
        ("GET", "/api/v1/recordings/1", 422),
    ],
)
def test_errors_are_problem_documents(client: httpx.Client, method: str, path: str, status: int) -> None:
    response = client.request(method, path)
    assert response.headers["content-type"] == "application/problem+json"
    problem = response.json()
    assert response.status_code == problem["status"] == status
    assert problem["instance"] == path.partition("?")[0]
    assert problem["title"]
    assert problem["detail"]
    assert problem["type"] == "about:blank"


@pytest.mark.parametrize(
    ("method", "path", "allowed"),
    [
        ("PATCH", "/api/v1/motors/PUMP-A1/baseline", "GET, PUT, DELETE"),
        ("OPTIONS", "/api/v1/recordings", "GET, POST"),
        ("POST", "/healthz", "GET, HEAD"),
    ],
)
def test_allow_has_all_methods(client: httpx.Client, method: str, path: str, allowed: str) -> None:
    response = client.request(method, path)
    assert response.status_code == 405
    assert response.headers["allow"] == allowed


def test_a_wrong_request_says_which_field(client: httpx.Client) -> None:
    problem = client.get("/api/v1/motors/PUMP-A1/trend?quantity=x&limit=0").json()
    assert {error["location"] for error in problem["errors"]} == {"query.quantity", "query.limit"}


def test_a_failure_of_the_service(context: ApiContext, engine: Engine) -> None:
    with engine.begin() as connection:
        connection.exec_driver_sql("DROP TABLE remote_records")
        connection.exec_driver_sql("ALTER TABLE ieds RENAME TO gone")
    app = create_app(context)
    with serving(app) as client:
        response = client.get("/api/v1/ieds")
    assert response.status_code == 500
    assert response.headers["content-type"] == "application/problem+json"
    assert "no such table" not in response.text, "what went wrong inside is for the log"


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
def test_a_database_that_is_locked_for_long(tmp_path: Path, store: RecordingStore, database_url: str) -> None:
    repository = Repository(connect(database_url, busy_timeout_s=0.2))
    repository.sync_plant(two_motor_plant())
    app = create_app(ApiContext(Settings(data_directory=tmp_path), repository, store))
    file = database_url.removeprefix("sqlite:///")
    with serving(app) as client, closing(sqlite3.connect(file)) as other:
        other.execute("BEGIN IMMEDIATE")
        response = client.post("/api/v1/motors/PUMP-A1/event-reports")
        assert response.status_code == 503
        assert response.headers["content-type"] == "application/problem+json"
        assert int(response.headers["retry-after"]) > 0
        assert "database is locked" in response.json()["detail"]
        other.rollback()
        assert client.post("/api/v1/motors/PUMP-A1/event-reports").status_code == 202


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({"Host": "rebound.example:8710"}, 421),
        ({"Host": "[::1]:8710"}, 202),
        ({"Host": "LOCALHOST:8710"}, 202),
        ({"Host": "["}, 421),
        ({"Origin": "https://evil.example"}, 403),
        ({"Origin": "null"}, 403),
        ({"Origin": "http://["}, 403),
        ({"Host": "127.0.0.1:8710", "Origin": "http://127.0.0.1:8710"}, 202),
    ],
)
def test_web_pages_of_other_sites_cannot_trigger_relays(
    client: httpx.Client, headers: dict[str, str], status: int
) -> None:
    response = client.post("/api/v1/motors/PUMP-A1/event-reports", headers=headers)
    assert response.status_code == status


def test_any_host_where_it_is_allowed(context: ApiContext) -> None:
    settings = Settings(data_directory=context.settings.data_directory, allowed_hosts=("*",))
    app = create_app(replace(context, settings=settings))
    with serving(app) as client:
        assert client.get("/healthz", headers={"Host": "mcc.plant.example"}).status_code == 200
