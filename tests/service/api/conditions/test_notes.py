"""What is refused as a note of a motor."""

from dataclasses import replace

import httpx
import pytest

from service.storage import Repository
from testing.service.plants import two_motor_plant

MOTOR = "/api/v1/motors/PUMP-A1"
NOTE = {"kind": "maintenance", "text": "terminals cleaned", "on_behalf_of": "A. Miller"}


WRONG_VALUES: list[tuple[str, object]] = [
    ("text", ""),
    ("text", " \n "),
    ("text", "x" * 501),
    ("text", "a\0b"),
    ("text", 5),
    ("text", None),
    ("on_behalf_of", ""),
    ("on_behalf_of", "x" * 101),
    ("on_behalf_of", "A.\nMiller"),
    ("on_behalf_of", "A\x1b[31mMiller"),
    ("on_behalf_of", ["A. Miller"]),
    ("kind", "exploded"),
    ("kind", None),
    ("time", 1_760_000_000),
    ("time", "yesterday"),
    ("time", "2025-02-30"),
    ("time", "2025-10-09T08:00:00"),
    ("time", "0000-01-01T00:00:00Z"),
    ("time", "9999-12-31T23:59:59Z"),
    ("time", "1" * 5000),
    ("time", {}),
]
WRONG_BODIES = [
    (b"", 422),
    (b"[]", 422),
    (b"null", 422),
    (b"{", 422),
    (b'{"text": "\\ud800", "reason": "\\ud800", "on_behalf_of": "A. Miller"}', 422),
    (b'{"text": "' + b"x" * 8192 + b'", "on_behalf_of": "A"}', 413),
    (b"{" + b",".join(b'"f%d": 1' % number for number in range(300)) + b"}", 422),
    (b"[" * 4000, 400),
]


def test_a_note_that_is_not_as_documented_is_refused(client: httpx.Client) -> None:
    for name, value in WRONG_VALUES:
        refused = client.post(f"{MOTOR}/notes", json={**NOTE, name: value})
        assert refused.status_code == 422, (name, value)
        assert refused.headers["content-type"] == "application/problem+json"
        assert refused.json()["errors"][0]["location"] == f"body.{name}"
    assert client.get(f"{MOTOR}/notes").json()["items"] == []


@pytest.mark.parametrize("path", ["notes", "reference"])
def test_a_body_that_is_no_note_is_refused(client: httpx.Client, path: str) -> None:
    for body, status in WRONG_BODIES:
        headers = {"Content-Type": "application/json"}
        refused = client.post(f"{MOTOR}/{path}", content=body, headers=headers)
        assert refused.status_code == status, body[:50]
        assert refused.headers["content-type"] == "application/problem+json"
    assert client.get(f"{MOTOR}/notes").json()["items"] == []


@pytest.mark.parametrize("path", ["notes", "reference"])
def test_web_pages_of_other_sites_tell_nothing(client: httpx.Client, path: str) -> None:
    wanted = {**NOTE, "reason": "tested"}
    for headers, status in (
        ({"Origin": "https://evil.example"}, 403),
        ({"Host": "rebound.example:8710"}, 421),
    ):
        assert client.post(f"{MOTOR}/{path}", json=wanted, headers=headers).status_code == status
    assert client.get(f"{MOTOR}/notes").json()["items"] == []


def test_nothing_is_told_of_a_motor_that_left_the_plant(client: httpx.Client, repository: Repository) -> None:
    plant = two_motor_plant()
    repository.sync_plant(replace(plant, motors=plant.motors[1:]))
    for path, wanted in (("notes", NOTE), ("reference", {"reason": "tested", "on_behalf_of": "A. Miller"})):
        refused = client.post(f"{MOTOR}/{path}", json=wanted)
        assert refused.status_code == 409
        assert "not in the plant's files any more" in refused.json()["detail"]
    assert client.get(f"{MOTOR}/notes").json()["items"] == []
    assert client.get(f"{MOTOR}/condition").status_code == 200, "what is known of it stays"


def test_notes_are_neither_changed_nor_deleted(client: httpx.Client) -> None:
    where = client.post(f"{MOTOR}/notes", json=NOTE).headers["location"]
    for method in ("PUT", "PATCH", "DELETE"):
        refused = client.request(method, where)
        assert (refused.status_code, refused.headers["allow"]) == (405, "GET")


def test_the_longest_note_is_kept_whole(client: httpx.Client) -> None:
    longest = {"text": "\N{PILE OF POO}" * 500, "on_behalf_of": "\N{SNOWMAN}" * 100}
    note = client.post(f"{MOTOR}/notes", json=longest).json()
    assert (note["text"], note["on_behalf_of"]) == (longest["text"], longest["on_behalf_of"])
