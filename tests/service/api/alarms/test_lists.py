"""Lists of alarms and their key figures, asked for as clients do."""

import time

import httpx

from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from service.api.times import rfc3339
from service.storage import Repository
from service.storage.records import SERVICE, AlarmPlace, AlarmSpec
from service.storage.states import AlarmKind, AlarmPriority
from testing.service.plants import NOW_NS

URL = "/api/v1/alarms"
RELAY, OTHER = "A1_SEL710", "A2_SEL710"


def test_what_to_act_on_first_is_at_the_top(client: httpx.Client, repository: Repository) -> None:
    def raised(subject: str, priority: AlarmPriority, number: int) -> str:
        spec = AlarmSpec(AlarmKind.FILE_REFUSED, "outside", subject, priority=priority)
        return repository.raise_alarm_at(AlarmPlace(relay=RELAY), spec, now_ns=NOW_NS + number).id

    known = raised("known", AlarmPriority.CRITICAL, 0)
    gone = raised("gone", AlarmPriority.CRITICAL, 1)
    shelved = raised("shelved", AlarmPriority.CRITICAL, 2)
    over = raised("over", AlarmPriority.CRITICAL, 3)
    for number, priority in enumerate(AlarmPriority):
        raised(priority, priority, 10 + number)
    raised("high, later", AlarmPriority.HIGH, 20)
    repository.acknowledge_alarms([known, over], by=SERVICE, now_ns=NOW_NS + 30)
    repository.shelve_alarm(shelved, until_ns=NOW_NS + 99, by=SERVICE, now_ns=NOW_NS + 30)
    repository.clear_alarms(RELAY, [gone, over], now_ns=NOW_NS + 31)
    expected = ["critical", "high, later", "high", "medium", "low", "known", "gone", "shelved"]
    listed = client.get(f"{URL}/open").json()["items"]
    assert [one["subject"] for one in listed] == expected
    paged: list[str] = []
    cursor = None
    while cursor is not None or not paged:
        query = {"limit": 3} | ({} if cursor is None else {"cursor": cursor})
        page = client.get(f"{URL}/open", params=query).json()
        paged += [one["subject"] for one in page["items"]]
        cursor = page["next_cursor"]
    assert paged == expected
    assert client.get(f"{URL}/open", params={"state": "acknowledged"}).json()["items"] == listed[5:6]
    assert client.get(f"{URL}/open", params={"site": "FACTORY_A"}).json()["items"] == listed
    assert client.get(f"{URL}/open", params={"site": "ELSEWHERE"}).json()["items"] == []
    assert client.get(f"{URL}/open", params={"ied": OTHER}).json()["items"] == []
    assert client.get(f"{URL}/open", params={"motor": "PUMP-A1"}).json()["items"] == []
    for wrong in ({"ied": "NO"}, {"motor": "NO"}):
        assert client.get(f"{URL}/open", params=wrong).status_code == 404
    assert client.get(f"{URL}/open", params={"state": "odd"}).status_code == 422
    assert {one["id"] for one in client.get(URL).json()["items"]} > {over}


def test_key_figures(client: httpx.Client, repository: Repository) -> None:
    now_ns = time.time_ns()
    today_ns = now_ns // NANOSECONDS_PER_DAY * NANOSECONDS_PER_DAY
    hour_ns = 3600 * NANOSECONDS_PER_SECOND
    for number in range(5):  # comes and goes on the day before yesterday, every 20 minutes
        at_ns = today_ns - 2 * NANOSECONDS_PER_DAY + number * hour_ns // 3
        chattering = repository.raise_alarm(RELAY, AlarmKind.FILE_UNSTEADY, "X", "denied", now_ns=at_ns)
        repository.clear_alarms(RELAY, [chattering.id], now_ns=at_ns + 1)
    for number in range(4):  # as often, and far apart
        at_ns = today_ns - NANOSECONDS_PER_DAY + number * hour_ns
        slow = repository.raise_alarm(OTHER, AlarmKind.FILE_UNSTEADY, "X", "denied", now_ns=at_ns)
        repository.clear_alarms(OTHER, [slow.id], now_ns=at_ns + 1)
    long = repository.raise_alarm(
        RELAY, AlarmKind.TIME_ZONE, "", "off", now_ns=now_ns - NANOSECONDS_PER_DAY - 1
    )
    repository.raise_alarm(RELAY, AlarmKind.DAILY_LIMIT, "", "full", now_ns=now_ns - 1)
    found = client.get(f"{URL}/figures", params={"days": 4}).json()
    assert found["from_time"] == rfc3339(today_ns - 3 * NANOSECONDS_PER_DAY)
    calls = [day["calls"] for day in found["days"]]
    assert (calls[0], calls[1] + calls[2] + calls[3], len(calls)) == (0, 11, 4)
    assert calls[1] >= 5
    assert [day["date"] for day in found["days"]] == sorted(day["date"] for day in found["days"])
    assert 11 / 4 <= found["calls_per_day"] <= 11 / 3
    assert [(one["ied"], one["kind"], one["calls"]) for one in found["frequent"]][:2] == [
        (RELAY, "file-unsteady", 5),
        (OTHER, "file-unsteady", 4),
    ]
    assert [(one["ied"], one["kind"], one["calls"]) for one in found["chattering"]] == [
        (RELAY, "file-unsteady", 3)
    ]
    assert found["open"] == {"unacknowledged": 2, "returned-unacknowledged": 2}
    assert ([one["id"] for one in found["standing_long"]], found["standing_long_in_all"]) == ([long.id], 1)
    assert client.get(f"{URL}/figures", params={"days": 1}).json()["frequent"][0]["calls"] == 1
    for wrong in ("0", "367", "x"):
        assert client.get(f"{URL}/figures", params={"days": wrong}).status_code == 422


def test_key_figures_of_a_service_without_alarms(client: httpx.Client) -> None:
    found = client.get(f"{URL}/figures").json()
    assert (len(found["days"]), found["calls_per_day"], found["open"]) == (30, 0.0, {})
    assert (found["frequent"], found["chattering"], found["standing_long"]) == ([], [], [])


def test_an_alarm_leads_to_its_motor_relay_and_recording_and_a_flood_to_its_members(
    client: httpx.Client, repository: Repository
) -> None:
    fault = AlarmSpec(AlarmKind.CONDITION_FAULT, "why", "shorted turns in phase b", recording_id="5b0e")
    repository.raise_alarm_at(AlarmPlace(motor="PUMP-A1"), fault, now_ns=NOW_NS)
    for number in range(12):
        spec = AlarmSpec(AlarmKind.FILE_REFUSED, "outside", f"file {number}")
        repository.raise_alarm_at(AlarmPlace(relay=OTHER), spec, now_ns=NOW_NS + number)
    repository.gather_floods(10, now_ns=NOW_NS + 12)
    alarm, flood, *members = client.get(f"{URL}/open").json()["items"]
    assert alarm["links"] == {
        "motor": "/api/v1/motors/PUMP-A1",
        "ied": "/api/v1/ieds/A1_SEL710",
        "recording": "/api/v1/recordings/5b0e",
        "part_of": None,
    }
    assert client.get(alarm["links"]["motor"]).status_code == 200
    assert flood["links"] == dict.fromkeys(alarm["links"])
    assert len(members) == 12
    assert {one["links"]["part_of"] for one in members} == {f"{URL}/{flood['id']}"}
    told = client.get(URL, params={"part_of": flood["id"]}).json()["items"]
    assert {one["id"] for one in told} == {one["id"] for one in members}
    assert client.get(URL, params={"part_of": "no id"}).status_code == 422
    rows = client.get(URL, params={"part_of": flood["id"], "format": "csv"}).text.splitlines()
    assert sum("file-refused" in row for row in rows) == 12
