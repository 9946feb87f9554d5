"""Motor statistics and sequences of events over REST: kept once, beside the service's counts, as marks."""

import time
from pathlib import Path
from typing import Any

import httpx
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from core.time_stamps import nanoseconds
from core.units import NANOSECONDS_PER_SECOND
from service.api import ApiContext
from service.condition.motor_data import document_of
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import Actor, RelayEvent, Sample
from service.storage.states import RelayEventKind
from testing.service.accounts import auditor
from testing.service.plants import motor
from testing.service.starts import START, RecordedStarts
from tests.core.relay_reports.examples import CSER, HEAD, MOT, SER

REPORTS = "/api/v1/motors/PUMP-A1/reports"
LOAD = "/api/v1/motors/PUMP-A1/load-profile"
TIME_NS = nanoseconds("2026-03-29T10:15:30.125Z")
HOUR_NS = 3600 * NANOSECONDS_PER_SECOND
TELLER = Actor("ada", "::1")
TRIPPED = SER.replace("STARTING    Deasserted", "TRIP        Asserted")


@pytest.fixture
def context(repository: Repository, store: RecordingStore, tmp_path: Path) -> ApiContext:
    known = motor("PUMP-A1")
    repository.note_motors({"PUMP-A1": document_of(known)}, now_ns=1)
    return ApiContext(Settings(data_directory=tmp_path), repository, store, motors={"PUMP-A1": known})


def bring(client: httpx.Client, report: str | bytes, **query: str) -> httpx.Response:
    content = report.encode("latin-1") if isinstance(report, str) else report
    headers = {"Content-Type": "text/plain"}
    return client.post(REPORTS, content=content, headers=headers, params=query)


def statistics(client: httpx.Client) -> dict[str, Any]:
    found: dict[str, Any] = client.get(LOAD).json()["relay_statistics"]
    return found


def test_statistics_are_kept_once_and_shown_with_the_load(client: httpx.Client) -> None:
    assert client.get(LOAD).json()["relay_statistics"] is None
    told = bring(client, MOT).json()
    assert (told["kind"], told["motor_statistics"]["added"]) == ("MOT", True)
    assert nanoseconds(told["motor_statistics"]["time"]) == TIME_NS
    assert bring(client, MOT).json()["motor_statistics"]["added"] is False

    found = statistics(client)
    assert (found["starts"], found["longest_start_s"]) == (17, 0.42)
    assert found["running_hours"] == pytest.approx(120 + 330 / 3600)
    assert found["trips"] == {"overcurrent": 1, "thermal overload": 0}
    assert (found["counted_starts"], found["counted_running_hours"]) == (0, 0.0)
    assert found["remarks"] == [
        "the relay counts 17 starts, the service 0: the service has measured nothing in that time",
        "the relay counts 120.1 h running, the service 0.0 h: the service has measured nothing in that time",
    ]


def test_a_service_that_came_later_is_said(client: httpx.Client, repository: Repository) -> None:
    first_ns = nanoseconds("2026-03-20T00:00:00Z")
    amps = dict.fromkeys(("ia_A", "ib_A", "ic_A"), 1.2)
    repository.add_samples(Sample("PUMP-A1", first_ns + k * HOUR_NS // 4, amps) for k in range(40))
    repository.average_measurements(now_ns=TIME_NS)
    bring(client, MOT)
    found = statistics(client)
    assert (found["counted_running_hours"], found["known_hours"]) == (10.0, 10.0)
    assert all("from 2026-03-20T00:00Z on only" in remark for remark in found["remarks"])


def test_agreement_needs_no_remark_and_fewer_of_the_relay_is_a_reset(
    client: httpx.Client, repository: Repository, store: RecordingStore
) -> None:
    recorded = RecordedStarts(repository, store)
    for day in range(3):
        recorded.add(START, at_ns=TIME_NS - (day + 1) * 24 * HOUR_NS)
    same = HEAD + "Since   03/01/2026 00:00:00.000\nNumber of starts   3\n"
    bring(client, same)
    assert statistics(client)["remarks"] == []
    bring(client, same.replace("starts   3", "starts   1").replace("10:15:30", "10:16:30"))
    [remark] = statistics(client)["remarks"]
    assert remark.startswith("the relay counts 1 starts, the service 3: the relay's counters may have been")


def test_statistics_that_do_not_tell_since_when_are_not_compared(client: httpx.Client) -> None:
    bring(client, HEAD + "Number of starts   3\n")
    found = statistics(client)
    assert (found["counted_starts"], found["known_hours"]) == (None, None)
    assert found["remarks"] == ["the report does not tell since when the relay counts"]


@pytest.mark.parametrize("report", [SER, CSER], ids=["plain", "compressed"])
def test_starts_stops_and_trips_are_kept_once(
    client: httpx.Client, repository: Repository, report: str | bytes
) -> None:
    told = bring(client, report).json()
    assert told["kind"] == "SER"
    assert (told["events"]["added"], told["events"]["known"]) == (1, 0)
    assert "RUNNING" in told["events"]["left_out"]
    head = client.get("/api/v1/audit/head", headers=auditor(repository)).json()
    again = bring(client, report).json()["events"]
    assert (again["added"], again["known"]) == (0, 1)
    assert client.get("/api/v1/audit/head", headers=auditor(repository)).json() == head
    started_ns = nanoseconds("2026-03-29T10:15:01.250Z")
    kind = RelayEventKind.START
    kept = repository.relay_events("PUMP-A1", kind, limit=9, from_ns=0, to_ns=time.time_ns())
    assert kept == (RelayEvent(kind, started_ns),)


def test_a_trip_of_the_relay_is_kept(client: httpx.Client, repository: Repository) -> None:
    assert bring(client, TRIPPED).json()["events"]["added"] == 2
    [trip] = repository.relay_events("PUMP-A1", RelayEventKind.TRIP, limit=9, from_ns=0, to_ns=time.time_ns())
    assert trip.time_ns == nanoseconds("2026-03-29T10:15:02.5Z")


@pytest.mark.parametrize(
    ("report", "told"),
    [
        (MOT.replace(" 17", " x"), "body: line 10, number of starts: expected a number, found 'x'"),
        (MOT.replace(HEAD, ""), "body: heading: expected the relay's clock, as Date: and Time:"),
        (MOT.replace("03/29/2026", "03/29/2096"), "body: Date: expected a time that has been"),
        (MOT.replace("03/01/2026", "03/01/2027"), "body: Since: expected a time before that of the report"),
        (SER.replace("03/29/2026 10:15:01", "03/32/2026 10:15:01"), "body: line 9, time: expected a date"),
        (SER.replace("2026", "2096"), "none of 1 events can be kept"),
    ],
)
def test_what_cannot_be_kept_is_refused(client: httpx.Client, report: str, told: str) -> None:
    answer = bring(client, report)
    assert (answer.status_code, answer.headers["content-type"]) == (422, "application/problem+json")
    assert told in answer.json()["detail"]


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.sampled_from([MOT.encode(), SER.encode(), CSER]), st.integers(0, 700), st.binary(max_size=12))
def test_a_damaged_report_is_kept_or_refused(
    client: httpx.Client, report: bytes, place: int, damage: bytes
) -> None:
    damaged = report[:place] + damage + report[place + len(damage) :]
    assert bring(client, damaged).status_code in (200, 422)
    assert client.get(LOAD).status_code == 200


def test_events_come_in_pages_latest_first(client: httpx.Client, repository: Repository) -> None:
    """Events of one time, of one kind or of several, are each told once."""
    times_ns = [TIME_NS + HOUR_NS * (number // 2) for number in range(9)]
    told = {
        RelayEvent(kind, time_ns)
        for number, time_ns in enumerate(times_ns)
        for kind in list(RelayEventKind)[: 1 + number % 3]
    }
    repository.add_relay_events("PUMP-A1", sorted(told, key=str), by=TELLER, now_ns=TIME_NS)
    route = "/api/v1/motors/PUMP-A1/relay-events"
    found, cursor = [], None
    while True:
        query = {"limit": 2} if cursor is None else {"limit": 2, "cursor": cursor}
        page = client.get(route, params=query).json()
        found += [(nanoseconds(one["time"]), one["kind"]) for one in page["items"]]
        assert len(page["items"]) <= 2
        cursor = page["next_cursor"]
        if cursor is None:
            break
    assert found == sorted(((one.time_ns, one.kind.value) for one in told), reverse=True)
    whole = client.get(route).json()
    assert (len(whole["items"]), whole["next_cursor"]) == (len(told), None)
    assert client.get("/api/v1/motors/FAN-A2/relay-events").json()["items"] == []
    assert client.get("/api/v1/motors/NONE/relay-events").status_code == 404
