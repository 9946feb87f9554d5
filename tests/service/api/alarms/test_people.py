"""What people do about alarms, asked for as clients do."""

import time
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier
from uuid import uuid4

import httpx
import pytest

from core.units import NANOSECONDS_PER_DAY
from service.alarms.catalogue import CATALOGUE
from service.api.times import rfc3339
from service.storage import Repository
from service.storage.records import Actor, Alarm, AlarmPlace, AlarmSpec
from service.storage.states import AlarmKind
from service.timing.undo_time import UNDO_NS
from testing.service.plants import NOW_NS

URL = "/api/v1/alarms"
RELAY = "A1_SEL710"


@pytest.fixture
def alarm(repository: Repository) -> Alarm:
    return repository.raise_alarm(RELAY, AlarmKind.FILE_REFUSED, "X.CFG", "outside", now_ns=NOW_NS)


@pytest.fixture
def growing(repository: Repository) -> Alarm:
    spec = AlarmSpec(AlarmKind.CONDITION_FAULT, "shorted turns", one_of_kind=True, value=0.01)
    return repository.raise_alarm_at(AlarmPlace(motor="PUMP-A1"), spec, now_ns=NOW_NS)


def grown_to(repository: Repository, value: float) -> Alarm:
    spec = AlarmSpec(AlarmKind.CONDITION_FAULT, "shorted turns", one_of_kind=True, value=value)
    return repository.raise_alarm_at(AlarmPlace(motor="PUMP-A1"), spec, now_ns=NOW_NS + 1)


def test_acknowledge_with_a_comment(client: httpx.Client, repository: Repository, alarm: Alarm) -> None:
    answer = client.post(f"{URL}/{alarm.id}/acknowledgements", json={"comment": " ordered a new card "})
    found = answer.json()
    assert (answer.status_code, found["state"], found["standing"]) == (200, "acknowledged", True)
    assert (found["comment"], found["changed_by"] != "statorwatch") == ("ordered a new card", True)
    assert client.get(f"{URL}/{alarm.id}").json() == found
    latest, first = client.get(f"{URL}/{alarm.id}/changes").json()["items"]
    assert (first["event"], first["by"], first["comment"]) == ("raised", "statorwatch", "outside")
    assert (latest["event"], latest["before"], latest["after"], latest["by"], latest["comment"]) == (
        ("acknowledged", "unacknowledged", "acknowledged", found["changed_by"], "ordered a new card")
    )
    repository.clear_alarms(RELAY, [alarm.id], now_ns=NOW_NS + 5)
    assert client.get(f"{URL}/{alarm.id}").json()["state"] == "normal"
    assert client.get(f"{URL}/open").json()["items"] == []


def test_who_acknowledged_by_mistake_undoes_it_within_ten_minutes(
    client: httpx.Client, repository: Repository, alarm: Alarm, growing: Alarm
) -> None:
    undo = f"{URL}/acknowledgements/undo"
    both = {"alarms": [alarm.id, growing.id]}
    refused = client.post(undo, json=both)
    assert refused.status_code == 409
    assert "nothing was undone" in refused.json()["detail"]
    client.post(f"{URL}/acknowledgements", json=both | {"comment": "all of them"})
    long_ago = time.time_ns() - UNDO_NS - 1
    repository.raise_alarm(RELAY, AlarmKind.FILE_REFUSED, "Y.CFG", "outside", now_ns=NOW_NS)
    other = repository.raise_alarm(RELAY, AlarmKind.FILE_REFUSED, "Z.CFG", "outside", now_ns=NOW_NS)
    repository.acknowledge_alarm(other.id, by=Actor("bob", "::1"), now_ns=time.time_ns())
    answer = client.post(undo, json={"alarms": [*both["alarms"], other.id]})
    assert answer.status_code == 200
    assert {one["id"]: one["state"] for one in answer.json()["undone"]} == dict.fromkeys(
        both["alarms"], "unacknowledged"
    )
    (late,) = answer.json()["refused"]
    assert late["alarm"] == other.id
    assert "by bob" in late["detail"]
    latest = client.get(f"{URL}/{alarm.id}/changes").json()["items"][0]
    assert (latest["event"], latest["before"]) == ("acknowledgement-undone", "acknowledged")
    me = answer.json()["undone"][0]["changed_by"]
    repository.acknowledge_alarm(alarm.id, by=Actor(me, "::1"), now_ns=long_ago)
    assert client.post(undo, json={"alarms": [alarm.id]}).status_code == 409, "it is too late"


def test_a_refusal_names_who_was_first_and_what_is_possible(client: httpx.Client, alarm: Alarm) -> None:
    path = f"{URL}/{alarm.id}/acknowledgements"
    first = client.post(path, json={"comment": "mine"})
    who = first.json()["changed_by"]
    answer = client.post(path)
    assert (answer.status_code, answer.headers["content-type"]) == (409, "application/problem+json")
    assert answer.json()["detail"] == (
        f"alarm {alarm.id} cannot be acknowledged: it is acknowledged (by {who}: mine); possible now: "
        "shelve, take out of service"
    )
    for method, way, possible in (
        ("DELETE", "shelving", "shelve, take out of service"),
        ("DELETE", "out-of-service", "shelve, take out of service"),
    ):
        answer = client.request(method, f"{URL}/{alarm.id}/{way}")
        assert answer.status_code == 409
        assert answer.json()["detail"].endswith(f"possible now: {possible}")


@pytest.mark.parametrize(
    ("method", "way"),
    [
        ("GET", ""),
        ("GET", "/changes"),
        ("POST", "/acknowledgements"),
        ("DELETE", "/shelving"),
        ("PUT", "/out-of-service"),
        ("DELETE", "/out-of-service"),
    ],
)
def test_an_alarm_that_there_is_not(client: httpx.Client, method: str, way: str) -> None:
    unknown = uuid4()
    answer = client.request(method, f"{URL}/{unknown}{way}")
    assert (answer.status_code, answer.json()["detail"]) == (404, f"there is no alarm '{unknown}'")


def test_two_people_at_once_of_whom_one_is_first(client: httpx.Client, alarm: Alarm) -> None:
    together = Barrier(4)

    def acknowledge(number: int) -> int:
        together.wait(10)
        path = f"{URL}/{alarm.id}/acknowledgements"
        return client.post(path, json={"comment": f"person {number}"}).status_code

    with ThreadPoolExecutor(4) as pool:
        assert sorted(pool.map(acknowledge, range(4))) == [200, 409, 409, 409]
    events = [one["event"] for one in client.get(f"{URL}/{alarm.id}/changes").json()["items"]]
    assert events == ["acknowledged", "raised"]


def test_several_at_once_of_which_some_cannot_be(
    client: httpx.Client, repository: Repository, alarm: Alarm, growing: Alarm
) -> None:
    known = repository.raise_alarm(RELAY, AlarmKind.DAILY_LIMIT, "", "full", now_ns=NOW_NS)
    assert client.post(f"{URL}/{known.id}/acknowledgements").status_code == 200
    unknown = str(uuid4())
    wanted = {"alarms": [alarm.id, alarm.id, known.id, unknown, growing.id], "comment": "seen"}
    answer = client.post(f"{URL}/acknowledgements", json=wanted)
    assert answer.status_code == 200
    assert {one["id"] for one in answer.json()["acknowledged"]} == {alarm.id, growing.id}
    refused = {one["alarm"]: one["detail"] for one in answer.json()["refused"]}
    assert refused[unknown] == f"there is no alarm '{unknown}'"
    assert "cannot be acknowledged: it is acknowledged (by " in refused[known.id]
    answer = client.post(f"{URL}/acknowledgements", json={"alarms": [unknown, known.id]})
    assert answer.status_code == 409
    assert answer.json()["detail"].startswith("nothing was acknowledged: ")
    assert len(answer.json()["errors"]) == 2
    for number in (0, 101):
        wrong = {"alarms": [unknown] * number}
        assert client.post(f"{URL}/acknowledgements", json=wrong).status_code == 422
    for document in ({"alarms": ["x"]}, {}):
        assert client.post(f"{URL}/acknowledgements", json=document).status_code == 422


def test_shelve_until_a_time(client: httpx.Client, repository: Repository, alarm: Alarm) -> None:
    until_ns = time.time_ns() + NANOSECONDS_PER_DAY
    wanted = {"until": rfc3339(until_ns), "comment": "spare part on Friday"}
    found = client.put(f"{URL}/{alarm.id}/shelving", json=wanted).json()
    assert (found["state"], found["shelved_until"], found["shelved_above"]) == (
        ("shelved", rfc3339(until_ns), None)
    )
    assert client.get(f"{URL}/open?state=shelved").json()["items"] == [found]
    assert repository.end_shelvings(now_ns=until_ns - 1) == 0
    assert repository.end_shelvings(now_ns=until_ns) == 1
    again = client.get(f"{URL}/{alarm.id}").json()
    assert (again["state"], again["shelved_until"], again["changed_by"]) == (
        ("unacknowledged", None, "statorwatch")
    )


def test_shelve_until_it_grows(client: httpx.Client, repository: Repository, growing: Alarm) -> None:
    found = client.put(f"{URL}/{growing.id}/shelving", json={"growth": 0.005}).json()
    assert (found["state"], found["shelved_above"], found["seen_value"]) == ("shelved", 0.015, 0.01)
    assert grown_to(repository, 0.015).state == "shelved"
    assert grown_to(repository, 0.016).state == "unacknowledged"
    latest = client.get(f"{URL}/{growing.id}/changes").json()["items"][0]
    assert (latest["event"], latest["comment"]) == ("reopened", "it has grown to 0.016, beyond 0.015")


def test_a_shelving_can_be_given_another_end(
    client: httpx.Client, repository: Repository, growing: Alarm
) -> None:
    path = f"{URL}/{growing.id}/shelving"
    assert client.put(path, json={"growth": 0.005}).status_code == 200
    until_ns = time.time_ns() + NANOSECONDS_PER_DAY
    found = client.put(path, json={"until": rfc3339(until_ns)}).json()
    assert (found["shelved_until"], found["shelved_above"]) == (rfc3339(until_ns), None)
    assert grown_to(repository, 1.0).state == "shelved"


def test_a_shelving_always_has_an_end(client: httpx.Client, alarm: Alarm) -> None:
    path, now_ns = f"{URL}/{alarm.id}/shelving", time.time_ns()
    for wrong, why in (
        ({}, "a shelving always has an end"),
        ({"comment": "for ever"}, "a shelving always has an end"),
        ({"until": rfc3339(now_ns - 1)}, "expected a time from now to 90 days ahead"),
        ({"until": rfc3339(now_ns + 91 * NANOSECONDS_PER_DAY)}, "take the alarm out of service"),
        ({"growth": 0}, "greater than 0"),
        ({"growth": -0.1}, "greater than 0"),
        ({"growth": "inf"}, "finite number"),
    ):
        answer = client.put(path, json=wrong)
        assert answer.status_code == 422, wrong
        assert why in answer.json()["detail"]
    answer = client.put(path, json={"growth": 0.1})
    assert answer.status_code == 409
    assert "(file-refused) has no value that could grow; shelve it until a time" in answer.json()["detail"]
    assert client.get(f"{URL}/{alarm.id}").json()["state"] == "unacknowledged"


def test_out_of_service_and_back(client: httpx.Client, repository: Repository, alarm: Alarm) -> None:
    path = f"{URL}/{alarm.id}/out-of-service"
    found = client.put(path, json={"comment": "the relay is replaced"}).json()
    assert (found["state"], found["comment"]) == ("out-of-service", "the relay is replaced")
    repository.clear_alarms(RELAY, [alarm.id], now_ns=NOW_NS + 1)
    again = repository.raise_alarm(RELAY, AlarmKind.FILE_REFUSED, "X.CFG", "outside", now_ns=NOW_NS + 2)
    assert (again.id, again.state, again.raises) == (alarm.id, "out-of-service", 2)
    back = client.request("DELETE", path, params={"comment": "replaced"}).json()
    assert (back["state"], back["comment"]) == ("unacknowledged", "replaced")


def test_what_people_do_is_in_the_audit_trail(
    client: httpx.Client, repository: Repository, growing: Alarm
) -> None:
    path = f"{URL}/{growing.id}"
    client.post(f"{path}/acknowledgements", json={"comment": "seen"})
    client.put(f"{path}/shelving", json={"growth": 0.5})
    client.request("DELETE", f"{path}/shelving")
    client.put(f"{path}/out-of-service")
    client.request("DELETE", f"{path}/out-of-service")
    client.request("DELETE", f"{path}/out-of-service")
    entries = repository.audit_entries(limit=10, subject=growing.id).items
    assert [entry.action for entry in reversed(entries)] == [
        "alarm-acknowledged",
        "alarm-shelved",
        "alarm-unshelved",
        "alarm-taken-out-of-service",
        "alarm-put-back-in-service",
    ]
    assert '"comment":"seen"' in str(entries[-1].after)
    assert '"shelved_above":0.51' in str(entries[-2].after).replace('"0.51"', "0.51")


def test_an_alarm_says_what_has_happened_what_follows_and_what_to_do(
    client: httpx.Client, alarm: Alarm
) -> None:
    found = client.get(f"{URL}/{alarm.id}").json()
    description = CATALOGUE[AlarmKind.FILE_REFUSED]
    assert (found["cause"], found["consequence"], found["advice"]) == (
        (description.cause, description.consequence, description.action)
    )
    assert found["priority"] == description.priority
