"""What people tell of a motor is kept, and its condition follows; on both databases."""

import time
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier

import httpx

from core.condition.events import Event, EventKind
from core.time_stamps import rfc3339
from core.units import NANOSECONDS_PER_DAY
from service.storage import Repository
from service.storage.records import SERVICE, FoldResult
from service.storage.repository.motor_versions import MOTORS_FILE
from testing.service.accounts import TESTER
from testing.service.plants import NOW_NS

MOTOR = "/api/v1/motors/PUMP-A1"
NOTE = {"kind": "maintenance", "text": "terminals cleaned", "on_behalf_of": "A. Miller"}


def test_a_note_is_kept_and_the_condition_is_to_follow_it(
    client: httpx.Client, repository: Repository
) -> None:
    wanted = {**NOTE, "time": "2025-10-09T10:00:00+02:00"}
    answer = client.post(f"{MOTOR}/notes", json=wanted)
    assert answer.status_code == 201
    note = answer.json()
    assert {name: note[name] for name in ("motor", "kind", "text", "by", "on_behalf_of", "time")} == {
        "motor": "PUMP-A1",
        "kind": "maintenance",
        "text": "terminals cleaned",
        "by": TESTER,
        "on_behalf_of": "A. Miller",
        "time": "2025-10-09T08:00:00.000000000Z",
    }
    assert answer.headers["location"] == f"{MOTOR}/notes/{note['id']}"
    assert client.get(answer.headers["location"]).json() == note
    assert client.get(f"{MOTOR}/notes").json()["items"] == [note]
    assert client.get(f"/api/v1/motors/FAN-A2/notes/{note['id']}").status_code == 404
    assert repository.motors_to_fold() == ("PUMP-A1",)


def test_a_remark_is_for_people_only(client: httpx.Client, repository: Repository) -> None:
    before_ns = time.time_ns()
    answer = client.post(f"{MOTOR}/notes", json={"text": "noisy\nbearing \N{SNOWMAN}", "on_behalf_of": "Zoë"})
    note = answer.json()
    assert (note["kind"], note["text"], note["on_behalf_of"]) == ("note", "noisy\nbearing \N{SNOWMAN}", "Zoë")
    assert rfc3339(before_ns) <= note["time"] == note["made_time"] <= rfc3339(time.time_ns())
    assert repository.motors_to_fold() == ()
    assert client.get(f"{MOTOR}/condition/history").json()["items"] == []


def test_a_note_that_was_wrong_is_withdrawn_and_counts_no_more(
    client: httpx.Client, repository: Repository
) -> None:
    where = client.post(f"{MOTOR}/notes", json={**NOTE, "kind": "rewound"}).headers["location"]
    kept = client.post(f"{MOTOR}/notes", json=NOTE).json()
    fold = repository.begin_fold("PUMP-A1", 10)
    assert fold is not None
    assert repository.finish_fold(fold, FoldResult([], [], [], (), None), now_ns=NOW_NS)
    withdrawal = {"reason": "it was FAN-A2", "on_behalf_of": "B. Moore"}
    note = client.post(f"{where}/withdrawal", json=withdrawal).json()
    assert (note["kind"], note["withdrawn_reason"], note["withdrawn_on_behalf_of"]) == (
        "rewound",
        "it was FAN-A2",
        "B. Moore",
    )
    assert note["made_time"] <= note["withdrawn_time"] <= rfc3339(time.time_ns())
    assert client.get(where).json() == note
    assert kept["withdrawn_time"] is None
    fold = repository.begin_fold("PUMP-A1", 10)
    assert fold is not None
    assert [event.id for event in fold.events] == [kept["id"]]
    again = client.post(f"{where}/withdrawal", json=withdrawal)
    assert (again.status_code, "is withdrawn" in again.json()["detail"]) == (409, True)
    assert client.post(f"{where}/withdrawal", json={"on_behalf_of": "B. Moore"}).status_code == 422
    of_another = where.replace("PUMP-A1", "FAN-A2")
    assert client.post(f"{of_another}/withdrawal", json=withdrawal).status_code == 404


def test_what_the_motors_file_tells_is_not_withdrawn(client: httpx.Client, repository: Repository) -> None:
    event = Event(NOW_NS, EventKind.PARAMETERS_EDITED, "stator_resistance_ohm")
    kept = repository.add_event("PUMP-A1", event, by=SERVICE, on_behalf_of=MOTORS_FILE, now_ns=NOW_NS)
    withdrawal = {"reason": "it is as before", "on_behalf_of": "B. Moore"}
    refused = client.post(f"{MOTOR}/notes/{kept.id}/withdrawal", json=withdrawal)
    assert refused.status_code == 409
    assert "is what the motors file tells" in refused.json()["detail"]


def test_a_person_who_is_called_as_the_file_is_withdraws_a_note(client: httpx.Client) -> None:
    where = client.post(f"{MOTOR}/notes", json={**NOTE, "on_behalf_of": MOTORS_FILE}).headers["location"]
    withdrawal = {"reason": "it was FAN-A2", "on_behalf_of": MOTORS_FILE}
    assert client.post(f"{where}/withdrawal", json=withdrawal).status_code == 200


def test_an_edit_of_the_motors_file_is_told_by_editing_it(client: httpx.Client) -> None:
    refused = client.post(f"{MOTOR}/notes", json={**NOTE, "kind": "parameters-edited"})
    assert refused.status_code == 422
    (error,) = refused.json()["errors"]
    assert error["location"] == "body.kind"
    assert "edit the file and restart the service" in error["message"]
    assert client.get(f"{MOTOR}/notes").json()["items"] == []


def test_a_reference_is_restarted_with_a_reason(client: httpx.Client, repository: Repository) -> None:
    answer = client.post(
        f"{MOTOR}/reference", json={"reason": "surge test passed", "on_behalf_of": "A. Miller"}
    )
    assert answer.status_code == 201
    note = client.get(answer.headers["location"]).json()
    assert note == answer.json()
    assert (note["kind"], note["text"], note["on_behalf_of"]) == (
        "reference-restarted",
        "surge test passed",
        "A. Miller",
    )
    assert repository.motors_to_fold() == ("PUMP-A1",)
    for wanted in ({"on_behalf_of": "A. Miller"}, {"reason": " ", "on_behalf_of": "A. Miller"}):
        assert client.post(f"{MOTOR}/reference", json=wanted).status_code == 422
    assert len(client.get(f"{MOTOR}/notes").json()["items"]) == 1


def test_notes_made_at_once_are_all_kept(client: httpx.Client, repository: Repository) -> None:
    together = Barrier(4)

    def add(number: int) -> httpx.Response:
        together.wait(10)
        wanted = {**NOTE, "text": f"note {number}", "time": rfc3339(NOW_NS)}
        return client.post(f"{MOTOR}/notes", json=wanted)

    with ThreadPoolExecutor(4) as pool:
        answers = list(pool.map(add, range(4), timeout=60))
    assert {answer.status_code for answer in answers} == {201}
    kept = client.get(f"{MOTOR}/notes").json()["items"]
    assert sorted(note["text"] for note in kept) == [f"note {number}" for number in range(4)]
    assert sorted(note["id"] for note in kept) == sorted(answer.json()["id"] for answer in answers)
    fold = repository.begin_fold("PUMP-A1", 10)
    assert fold is not None
    assert len(fold.events) == 4


def in_days(days: float) -> str:
    return rfc3339(time.time_ns() + round(days * NANOSECONDS_PER_DAY))


def test_a_time_may_be_a_little_ahead(client: httpx.Client) -> None:
    assert client.post(f"{MOTOR}/notes", json={**NOTE, "time": in_days(0.9)}).status_code == 201
    refused = client.post(f"{MOTOR}/notes", json={**NOTE, "time": in_days(1.1)})
    assert refused.status_code == 422
    (error,) = refused.json()["errors"]
    assert error["location"] == "body.time"
    assert "at most a day ahead" in error["message"]
