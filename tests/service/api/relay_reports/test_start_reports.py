"""Motor start reports over REST: rows of their own, joined with recordings, refused with what is wrong."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import httpx
import pytest

from core.time_stamps import nanoseconds
from service.api import ApiContext, create_app
from service.api.limits.body_limits import MAX_REPORT_BYTES
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import Actor
from testing.service.accounts import auditor
from testing.service.plants import SECOND_NS, motor
from testing.service.starts import START, RecordedStarts
from tests.core.relay_reports.examples import HEAD, MSR
from tests.service.api.serving import serving

HERE = "/api/v1/motors/PUMP-A1/starts"
REPORTS = "/api/v1/motors/PUMP-A1/reports"
STARTED_NS = nanoseconds("2026-03-29T10:15:01.250Z")
PART = replace(START, acceleration_s=None, running_current_A=None, i2t_A2s=40.0, i2t_over_s=0.1)
PERSON = Actor("ada", "tests")


@pytest.fixture
def context(repository: Repository, store: RecordingStore, tmp_path: Path) -> ApiContext:
    motors = {"PUMP-A1": motor("PUMP-A1")}
    return ApiContext(Settings(data_directory=tmp_path), repository, store, motors=motors)


@pytest.fixture
def recorded(repository: Repository, store: RecordingStore) -> RecordedStarts:
    return RecordedStarts(repository, store)


def bring(client: httpx.Client, report: str, **query: str) -> httpx.Response:
    headers = {"Content-Type": "text/plain"}
    return client.post(REPORTS, content=report.encode("latin-1"), headers=headers, params=query)


def listed(client: httpx.Client) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = client.get(HERE).json()["items"]
    return found


def test_a_report_becomes_a_start_marked_with_its_source(client: httpx.Client) -> None:
    answer = bring(client, MSR)

    assert answer.status_code == 200
    [imported], [left_out] = (
        answer.json()["motor_starts"]["starts"],
        answer.json()["motor_starts"]["left_out"],
    )
    assert (nanoseconds(imported["time"]), imported["outcome"]) == (STARTED_NS, "added")
    assert nanoseconds(left_out["time"]) == nanoseconds("2026-03-28T08:00:00Z")
    assert "expected at least 3 points, found 1" in left_out["reason"]
    [start] = listed(client)
    assert (start["source"], start["recording_id"], start["id"]) == ("report", None, imported["id"])
    assert (start["acceleration_s"], start["peak_current_A"], start["lowest_voltage_V"]) == (0.3, 8.62, 371.5)
    assert start["from_report"] == []
    details = client.get(f"{HERE}/{imported['id']}").json()
    assert details["curve"]["current_A"] == [8.62, 7.10, 1.31]
    assert "no samples" in details["remark"]


def test_the_same_report_again_changes_nothing(client: httpx.Client, repository: Repository) -> None:
    bring(client, MSR)
    before, head = listed(client), client.get("/api/v1/audit/head", headers=auditor(repository)).json()

    assert [one["outcome"] for one in bring(client, MSR).json()["motor_starts"]["starts"]] == ["known"]

    assert listed(client) == before
    assert client.get("/api/v1/audit/head", headers=auditor(repository)).json() == head


@pytest.mark.parametrize("report_first", [True, False])
def test_a_report_and_a_recording_of_one_start_are_one_row(
    client: httpx.Client, recorded: RecordedStarts, report_first: bool
) -> None:
    if report_first:
        bring(client, MSR)
    recording_id = recorded.add(PART, at_ns=STARTED_NS + 2 * SECOND_NS)
    outcome = bring(client, MSR).json()["motor_starts"]["starts"][0]["outcome"]

    assert outcome == ("known" if report_first else "joined")
    [start] = listed(client)
    assert (start["source"], start["recording_id"]) == ("recording", recording_id)
    assert start["peak_current_A"] == START.peak_current_A
    assert start["lowest_voltage_V"] == START.lowest_voltage_V
    assert start["acceleration_s"] == start["i2t_over_s"] == 0.3
    assert start["i2t_A2s"] == pytest.approx(0.1 * (8.62**2 + 7.10**2 + 1.31**2))
    assert set(start["from_report"]) == {"acceleration_s", "i2t_A2s", "i2t_over_s"}


def test_a_recording_some_seconds_farther_away_is_another_start(
    client: httpx.Client, recorded: RecordedStarts
) -> None:
    recorded.add(START, at_ns=STARTED_NS + 6 * SECOND_NS)
    assert bring(client, MSR).json()["motor_starts"]["starts"][0]["outcome"] == "added"
    assert [one["source"] for one in listed(client)] == ["recording", "report"]


def test_a_report_outlives_another_diagnosis_and_the_recording(
    client: httpx.Client, recorded: RecordedStarts, repository: Repository
) -> None:
    recording_id = recorded.add(PART, at_ns=STARTED_NS)
    bring(client, MSR)
    repository.request_diagnosis(recording_id, now_ns=STARTED_NS + SECOND_NS)
    recorded.diagnose(replace(PART, peak_current_A=99.0), STARTED_NS)
    [start] = listed(client)
    assert (start["peak_current_A"], start["acceleration_s"]) == (99.0, 0.3)

    repository.delete_recording(recording_id, "another motor's", by=PERSON, now_ns=STARTED_NS)

    [start] = listed(client)
    assert (start["source"], start["peak_current_A"]) == ("report", 8.62)


def test_reported_starts_are_not_compared_with_recorded_ones(
    client: httpx.Client, recorded: RecordedStarts
) -> None:
    for day in range(5):
        recorded.add(START, at_ns=STARTED_NS - (day + 2) * 86_400 * SECOND_NS)
    bring(client, MSR)
    assert [(one["source"], one["is_reference"], one["comparison"]) for one in listed(client)][:2] == [
        ("report", False, None),
        ("recording", True, None),
    ]


def test_reported_starts_alone_are_compared_with_the_first_ones(client: httpx.Client) -> None:
    for day in range(1, 6):
        bring(client, MSR.replace("03/29/2026 10:15:01", f"03/{day:02}/2026 10:15:01"))
    slower = MSR.replace("0.30 s", "0.20 s")
    assert bring(client, slower).status_code == 200
    latest, *first = listed(client)
    assert all(one["is_reference"] for one in first)
    assert latest["comparison"]["state"] == "not-told-apart"


def test_times_of_a_clock_in_local_time_are_put_into_utc(context: ApiContext) -> None:
    berlin = replace(context, time_zones={"PUMP-A1": "Europe/Berlin"})
    with serving(create_app(berlin)) as client:
        [start] = bring(client, MSR).json()["motor_starts"]["starts"]
        assert nanoseconds(start["time"]) == nanoseconds("2026-03-29T08:15:01.250Z")
        swapped = MSR.replace("03/29/2026", "29/03/2026").replace("03/28/2026", "28/03/2026")
        assert (
            bring(client, swapped, date_order="DMY").json()["motor_starts"]["starts"][0]["outcome"] == "known"
        )


def test_a_relay_without_starts_has_none(client: httpx.Client) -> None:
    answer = bring(client, HEAD + "MOTOR START REPORT\n\nNo Motor Start Data Available\n")
    assert (answer.status_code, answer.json()["motor_starts"]) == (200, {"starts": [], "left_out": []})


@pytest.mark.parametrize(
    ("report", "told"),
    [
        (MSR.replace("7.10", "x.10"), "body: line 13, I(A): expected a number, found 'x.10'"),
        (MSR.replace("03/29/2026 10", "13/29/2026 10"), "body: line 6, time: expected a date and time"),
        ("hello", "body: end: expected a report of motor starts (MSR), load (LDP)"),
        (MSR.replace("2026", "2096"), "none of 2 starts can be kept"),
    ],
    ids=["figure", "date", "nothing", "future"],
)
def test_what_cannot_be_kept_is_refused_with_line_and_field(
    client: httpx.Client, report: str, told: str
) -> None:
    answer = bring(client, report)
    assert answer.status_code == 422
    assert answer.headers["content-type"] == "application/problem+json"
    assert told in answer.json()["detail"]
    assert listed(client) == []


def test_a_body_is_a_text_within_its_limit_for_a_motor_of_the_plant(client: httpx.Client) -> None:
    assert bring(client, MSR + "\n" * MAX_REPORT_BYTES).status_code == 413
    assert client.post(REPORTS, json={"report": MSR}).status_code == 415
    path = REPORTS.replace("PUMP-A1", "NONE")
    text = {"Content-Type": "text/plain"}
    assert client.post(path, content=MSR, headers=text).status_code == 404
    path = REPORTS.replace("PUMP-A1", "FAN-A2")
    assert client.post(path, content=MSR, headers=text).status_code == 409
