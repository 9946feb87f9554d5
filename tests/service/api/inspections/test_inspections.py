"""What inspections found: kept, counted, exported, and used for no judgement; on both databases."""

import csv
import io
from typing import Any

import httpx
import pytest

from service.api.inspections.pictures import MAX_PICTURE_BYTES
from service.client.credentials import bearer
from service.storage import Repository
from service.storage.records import InspectionPicture, Role
from service.storage.repository.inspections import MOST_PICTURES
from service.storage.states import AlarmKind
from testing.service.accounts import TESTER, token_of
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.pictures import JPEG_BYTES, SMALL_PNG, png
from testing.service.plants import NOW_NS

MOTOR = "/api/v1/motors/PUMP-A1"
HERE = f"{MOTOR}/inspections"
FIGURES = "/api/v1/inspections/figures"
RAW = {"Content-Type": "application/octet-stream"}
CONFIRMED = {"outcome": "confirmed", "text": "two turns shorted in coil 7", "on_behalf_of": "A. Miller"}


def counts(client: httpx.Client) -> list[tuple[Any, ...]]:
    found = client.get(FIGURES).json()["counts"]
    names = ("kind", "site", "year", "confirmed", "other_cause", "nothing_found", "missed")
    return [tuple(one[name] for name in names) for one in found]


@pytest.fixture
def where(client: httpx.Client, repository: Repository) -> str:
    """Where the inspection of a motor with a fault is."""
    tell(repository, FAULT)
    return client.post(HERE, json=CONFIRMED).headers["location"]


def give(client: httpx.Client, where: str, content: bytes) -> httpx.Response:
    return client.post(f"{where}/pictures", content=content, headers=RAW)


def test_what_was_said_is_kept_beside_what_was_found(client: httpx.Client, repository: Repository) -> None:
    tell(repository, FAULT)
    before = repository.condition("PUMP-A1")
    answer = client.post(HERE, json=CONFIRMED)
    assert answer.status_code == 201, answer.text
    kept = answer.json()
    assert (kept["kind"], kept["outcome"], kept["cause"]) == ("shorted-turns", "confirmed", None)
    assert kept["finding"].startswith("shorted turns")
    assert (kept["by"], kept["on_behalf_of"], kept["pictures"]) == (TESTER, "A. Miller", 0)
    assert client.get(answer.headers["location"]).json() == kept
    assert client.get(HERE).json()["items"] == [kept]
    assert client.get("/api/v1/motors/FAN-A2/inspections").json()["items"] == []
    assert client.get(answer.headers["location"].replace("PUMP-A1", "FAN-A2")).status_code == 404
    assert repository.condition("PUMP-A1") == before, "no judgement follows from it"
    assert repository.motors_to_fold() == ()


def test_hits_and_misses_are_counted_by_kind_site_and_year(
    client: httpx.Client, repository: Repository
) -> None:
    tell(repository, FAULT)
    given: list[dict[str, str]] = [
        {"outcome": "confirmed"},
        {"outcome": "confirmed"},
        {"outcome": "other-cause", "cause": "a loose terminal"},
        {"outcome": "nothing-found"},
        {"outcome": "nothing-found", "kind": "rotor"},
        {"outcome": "other-cause", "kind": "none", "cause": "a worn bearing"},
        {"outcome": "nothing-found", "kind": "none"},
    ]
    for one in given:
        wanted = {"text": "opened", "time": "2026-03-01T10:00:00Z", **one}
        assert client.post(HERE, json=wanted).status_code == 201
    client.post(HERE, json={"outcome": "confirmed", "text": "again", "time": "2025-12-31T23:59:59Z"})
    assert counts(client) == [
        ("none", "FACTORY_A", 2026, 0, 1, 1, 1),
        ("rotor", "FACTORY_A", 2026, 0, 0, 1, 0),
        ("shorted-turns", "FACTORY_A", 2026, 2, 1, 1, 0),
        ("shorted-turns", "FACTORY_A", 2025, 1, 0, 0, 0),
    ]


def test_one_that_was_wrong_is_kept_and_counts_no_more(client: httpx.Client, where: str) -> None:
    assert client.post(f"{where}/withdrawal", json={}).status_code == 422
    gone = client.post(f"{where}/withdrawal", json={"reason": "it was PUMP-A2"}).json()
    assert (gone["withdrawn_by"], gone["withdrawn_reason"]) == (TESTER, "it was PUMP-A2")
    assert counts(client) == []
    assert client.post(f"{where}/withdrawal", json={"reason": "again"}).status_code == 409
    assert give(client, where, SMALL_PNG).status_code == 409
    assert len(client.get(HERE).json()["items"]) == 1


@pytest.mark.parametrize(
    ("wanted", "field"),
    [
        ({"outcome": "confirmed"}, "body.text"),
        ({"outcome": "maybe", "text": "x"}, "body.outcome"),
        ({"outcome": "confirmed", "text": "x"}, "body.outcome"),  # nothing was said
        ({"outcome": "other-cause", "text": "x"}, "body.cause"),
        ({"outcome": "nothing-found", "text": "x", "cause": "y"}, "body.cause"),
        ({"outcome": "nothing-found", "text": "x", "time": "2200-01-01"}, "body.time"),
        ({"outcome": "nothing-found", "text": "x" * 1001}, "body.text"),
    ],
)
def test_what_does_not_go_together_is_refused(
    client: httpx.Client, repository: Repository, wanted: dict[str, str], field: str
) -> None:
    tell(repository, HEALTHY)
    answer = client.post(HERE, json=wanted)
    assert answer.status_code == 422
    assert field in answer.text
    assert client.get(HERE).json()["items"] == []


def test_it_may_be_about_an_alarm_of_the_motor_alone(client: httpx.Client, repository: Repository) -> None:
    repository.raise_alarm("A1_SEL710", AlarmKind.FILE_REFUSED, "E.CFG", "outside", now_ns=NOW_NS)
    tell(repository, FAULT)
    tell(repository, FAULT, now_ns=NOW_NS + 1)
    alarms = {one.motor: one.id for one in repository.open_alarms(limit=10).items}
    wanted = {"outcome": "nothing-found", "text": "tested"}
    kept = client.post(HERE, json={**wanted, "alarm_id": alarms["PUMP-A1"]})
    assert (kept.status_code, kept.json()["alarm_id"]) == (201, alarms["PUMP-A1"])
    assert client.post(HERE, json={**wanted, "alarm_id": alarms[None]}).status_code == 404
    assert client.post(HERE, json={**wanted, "alarm_id": "no-such"}).status_code == 404


@pytest.mark.parametrize(("content", "media_type"), [(SMALL_PNG, "image/png"), (JPEG_BYTES, "image/jpeg")])
def test_a_picture_is_known_by_its_content_and_goes_out_as_nothing_else(
    client: httpx.Client, where: str, content: bytes, media_type: str
) -> None:
    kept = give(client, where, content)
    assert (kept.status_code, kept.json()["pictures"]) == (201, 1)
    shown = client.get(f"{where}/pictures/1")
    assert shown.content == content
    assert shown.headers["content-type"] == media_type
    assert shown.headers["x-content-type-options"] == "nosniff"
    assert shown.headers["content-security-policy"] == "default-src 'none'; sandbox"
    assert client.get(f"{where}/pictures/2").status_code == 404
    assert client.get(f"{where.replace('PUMP-A1', 'FAN-A2')}/pictures/1").status_code == 404


@pytest.mark.parametrize(
    "content",
    [
        b"<svg xmlns='http://www.w3.org/2000/svg'><script>alert(1)</script></svg>",
        b"<html><script>alert(1)</script>",
        b"GIF89a" + bytes(100),
        SMALL_PNG[:-4],
        SMALL_PNG + b"<script>alert(1)</script>",
        b"\xff\xd8\xff" + bytes(30),
        b"%PDF-1.7",
    ],
    ids=["svg", "html", "gif", "half a PNG", "PNG and a script", "half a JPEG", "PDF"],
)
def test_what_is_no_picture_is_refused(client: httpx.Client, where: str, content: bytes) -> None:
    answer = give(client, where, content)
    assert (answer.status_code, "expected a whole PNG or JPEG" in answer.text) == (422, True)
    assert client.get(where).json()["pictures"] == 0


def test_pictures_are_few_and_small(client: httpx.Client, where: str) -> None:
    assert give(client, where, SMALL_PNG + bytes(MAX_PICTURE_BYTES)).status_code == 413
    claimed = client.post(f"{where}/pictures", content=SMALL_PNG, headers={"Content-Type": "image/png"})
    assert claimed.status_code == 415
    for number in range(MOST_PICTURES):
        assert give(client, where, png(number + 1)).status_code == 201
    assert give(client, where, SMALL_PNG).status_code == 409


def test_operators_tell_and_engineers_withdraw(client: httpx.Client, repository: Repository) -> None:
    viewer = bearer(token_of(repository, Role.VIEWER, name="vera"))
    operator = bearer(token_of(repository, Role.OPERATOR, name="otto"))
    wanted = {"outcome": "nothing-found", "text": "tested"}
    assert client.post(HERE, json=wanted, headers=viewer).status_code == 403
    where = client.post(HERE, json=wanted, headers=operator).headers["location"]
    assert client.post(f"{where}/withdrawal", json={"reason": "x"}, headers=operator).status_code == 403
    assert client.get(FIGURES, headers=viewer).status_code == 200


def test_all_of_them_are_a_table(client: httpx.Client, where: str) -> None:
    give(client, where, SMALL_PNG)
    client.post("/api/v1/motors/FAN-A2/inspections", json={"outcome": "nothing-found", "text": "=1+1"})
    exports = "/api/v1/exports/inspections"
    answer = client.get(exports, params={"format": "csv"})
    rows = {row["motor"]: row for row in csv.DictReader(io.StringIO(answer.text.lstrip("\ufeff")))}
    assert set(rows) == {"PUMP-A1", "FAN-A2"}
    pump = rows["PUMP-A1"]
    assert (pump["kind"], pump["outcome"], pump["pictures"]) == ("shorted-turns", "confirmed", "1")
    assert client.get(exports, params={"format": "xlsx"}).content.startswith(b"PK")
    assert "PUMP-A1" not in client.get(exports, params={"format": "csv", "motor": "FAN-A2"}).text


def test_who_has_other_sites_sees_none_of_it(
    client: httpx.Client, repository: Repository, where: str
) -> None:
    give(client, where, SMALL_PNG)
    here, elsewhere = repository.within({"FACTORY_A"}), repository.within({"FACTORY_B"})
    (one,) = here.inspections(limit=10).items
    assert one.pictures == 1
    assert here.inspection_picture("PUMP-A1", one.id, 1) == InspectionPicture("image/png", SMALL_PNG)
    assert len(here.inspection_counts()) == 1
    assert elsewhere.inspections(limit=10).items == ()
    assert elsewhere.inspection_counts() == ()
