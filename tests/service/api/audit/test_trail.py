"""The routes of the audit trail."""

import httpx
import pytest
from sqlalchemy import Engine, text

from service.audit.actions import AuditAction
from service.audit.exports import entry_of_line
from service.audit.verification import verify
from service.storage import Repository
from service.storage.records import SERVICE
from testing.service.accounts import auditor
from testing.service.plants import NOW_NS
from tests.service.api.conftest import client as changing_client
from tests.service.api.conftest import context, logs
from tests.service.fixtures import database_url, engine, repository, store

__all__ = ["changing_client", "context", "database_url", "engine", "logs", "repository", "store"]

AUDIT = "/api/v1/audit"


@pytest.fixture
def client(changing_client: httpx.Client, repository: Repository) -> httpx.Client:
    changing_client.headers.update(auditor(repository))
    return changing_client


def trigger(client: httpx.Client, motor: str = "PUMP-A1") -> None:
    assert client.post(f"/api/v1/motors/{motor}/event-reports").status_code == 202


def test_who_changed_what_is_listed_with_the_latest_first(client: httpx.Client) -> None:
    trigger(client)
    trigger(client, "FAN-A2")
    latest, first = client.get(f"{AUDIT}/entries").json()["items"]
    assert (first["number"], first["action"], first["subject"]) == (1, "recording-requested", "PUMP-A1")
    assert (latest["number"], latest["previous"]) == (2, first["hash"])
    assert first["origin"] == "127.0.0.1"
    assert first["time"].endswith("Z")
    assert first["before"] is None
    assert first["after"]["relay"] == "A1_SEL710"
    assert isinstance(first["roles"], list)


def test_entries_are_narrowed_and_come_in_pages(client: httpx.Client) -> None:
    for _ in range(3):
        trigger(client)
    page = client.get(f"{AUDIT}/entries", params={"limit": 2}).json()
    assert [entry["number"] for entry in page["items"]] == [3, 2]
    rest = client.get(f"{AUDIT}/entries", params={"cursor": page["next_cursor"]}).json()
    assert [entry["number"] for entry in rest["items"]] == [1]
    for query, number in (
        ({"subject": "FAN-A2"}, 0),
        ({"subject": "PUMP-A1", "action": "recording-requested"}, 3),
        ({"action": "recording-deleted"}, 0),
        ({"from": "2020-01-01", "to": "2200-01-01"}, 3),
        ({"to": "2020-01-01"}, 0),
        ({"actor": "nobody"}, 0),
    ):
        assert len(client.get(f"{AUDIT}/entries", params=query).json()["items"]) == number, query
    assert client.get(f"{AUDIT}/entries", params={"action": "recording-delete"}).status_code == 422


def test_an_export_is_what_was_hashed(client: httpx.Client, repository: Repository) -> None:
    for number in range(2):
        repository.note_by(SERVICE, AuditAction.NOTE_ADDED, ("motor", str(number)), now_ns=NOW_NS)
    with client.stream("GET", f"{AUDIT}/export") as answer:
        assert answer.headers["content-type"].startswith("application/jsonl")
        entries = [entry_of_line(line) for line in answer.iter_lines()]
    head = client.get(f"{AUDIT}/head").json()
    found = verify(lambda: entries)
    assert (found.fault, found.last.number, found.last.hash) == (None, head["number"], head["hash"])
    part = client.get(f"{AUDIT}/export", params={"first": 2, "last": 9}).text.splitlines()
    assert [entry_of_line(line).number for line in part] == [2]
    assert client.get(f"{AUDIT}/export", params={"first": 0}).status_code == 422


def test_a_verification_names_what_is_wrong(client: httpx.Client, engine: Engine) -> None:
    trigger(client)
    trigger(client)
    head = client.get(f"{AUDIT}/head").json()
    assert head.pop("forwarded") is None
    found = client.get(f"{AUDIT}/verification", params=head).json()
    assert found == {"entries": 2, "last": head, "fault": None, "number": None, "message": None}
    other = client.get(f"{AUDIT}/verification", params={"number": 2, "hash": "0" * 64}).json()
    assert (other["fault"], other["number"]) == ("replaced", 2)
    with engine.begin() as connection:
        connection.execute(text("DROP TRIGGER audit_entries_update"))
        connection.execute(text("UPDATE audit_entries SET actor = 'mallory' WHERE number = 1"))
    found = client.get(f"{AUDIT}/verification").json()
    assert (found["entries"], found["fault"], found["number"]) == (0, "changed", 1)
    assert "entry 1 was changed" in found["message"]


@pytest.mark.parametrize("query", [{"number": "1"}, {"hash": "0" * 64}])
def test_half_an_anchor_is_refused(client: httpx.Client, query: dict[str, str]) -> None:
    answer = client.get(f"{AUDIT}/verification", params=query)
    assert answer.status_code == 422
    assert "expected number and hash of one entry" in answer.json()["detail"]
