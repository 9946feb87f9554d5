"""Load profiles over REST: measured values of the past, with means, beside those that were polled."""

from pathlib import Path
from typing import Any

import httpx
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from core.time_stamps import nanoseconds
from service.api import ApiContext
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import Actor, Sample
from testing.service.accounts import auditor
from testing.service.plants import SECOND_NS, motor
from tests.core.relay_reports.examples import CLDP, HEAD, LDP

PERSON = Actor("ada", "tests")
REPORTS = "/api/v1/motors/PUMP-A1/reports"
FIRST_NS = nanoseconds("2026-03-29T10:14:00Z")
QUARTER_NS = nanoseconds("2026-03-29T10:00:00Z")


@pytest.fixture
def context(repository: Repository, store: RecordingStore, tmp_path: Path) -> ApiContext:
    motors = {"PUMP-A1": motor("PUMP-A1")}
    return ApiContext(Settings(data_directory=tmp_path), repository, store, motors=motors)


def bring(client: httpx.Client, report: str | bytes, **query: str) -> httpx.Response:
    content = report.encode("latin-1") if isinstance(report, str) else report
    headers = {"Content-Type": "text/plain"}
    return client.post(REPORTS, content=content, headers=headers, params=query)


def measured(client: httpx.Client, step: int = 0) -> list[dict[str, Any]]:
    found = client.get("/api/v1/motors/PUMP-A1/measurements", params={"step": step})
    items: list[dict[str, Any]] = found.json()["items"]
    return items


def profile(rows: int, *, minutes: int = 5) -> str:
    """A profile of rows from 08:00 on; the current of each is its number."""
    lines = [
        f"03/29/2026 {8 + k * minutes // 60:02}:{k * minutes % 60:02}:00.000  {k}.0 {k}.0 {k}.0  50.0"
        for k in range(rows)
    ]
    return HEAD + "LOAD PROFILE\n\nDATE TIME IA_MAG IB_MAG IC_MAG FREQ\n" + "\n".join(lines) + "\n"


@pytest.mark.parametrize("report", [LDP, CLDP], ids=["plain", "compressed"])
def test_rows_become_measured_values_marked_with_their_source(
    client: httpx.Client, report: str | bytes
) -> None:
    answer = bring(client, report, power_unit="kW")

    assert answer.status_code == 200
    told = answer.json()
    assert (told["kind"], told["motor_starts"]) == ("LDP", None)
    assert told["load_profile"]["added"] == 2
    assert told["load_profile"]["left_out"] == []
    first, second = measured(client)
    assert nanoseconds(first["time"]) == FIRST_NS
    assert (first["ia_A"], first["power_W"], first["ic_A"]) == (1.203, 436_200.0, None)
    assert (second["ia_A"], second["source"]) == (1.305, "load-profile")


def test_means_are_made_of_the_past(client: httpx.Client) -> None:
    """Each quarter of an hour has the mean of its three rows; each minute with a row has one."""
    assert bring(client, profile(9)).json()["load_profile"]["added"] == 9
    quarters = measured(client, 900)
    assert [(one["ia_A"], one["samples"], one["source"]) for one in quarters] == [
        (1.0, 3, "load-profile"),
        (4.0, 3, "load-profile"),
        (7.0, 3, "load-profile"),
    ]
    assert [one["ia_A"] for one in measured(client, 60)] == [float(k) for k in range(9)]


def test_a_profile_brought_again_adds_only_what_is_new(client: httpx.Client, repository: Repository) -> None:
    bring(client, profile(9))
    head = client.get("/api/v1/audit/head", headers=auditor(repository)).json()
    again = bring(client, profile(9)).json()["load_profile"]
    assert (again["added"], again["known"]) == (0, 9)
    assert client.get("/api/v1/audit/head", headers=auditor(repository)).json() == head
    longer = bring(client, profile(12)).json()["load_profile"]
    assert (longer["added"], longer["known"]) == (3, 9)
    assert len(measured(client)) == 12
    assert len(measured(client, 900)) == 4


def test_what_was_polled_stays_as_it_is(client: httpx.Client, repository: Repository) -> None:
    polled_ns = nanoseconds("2026-03-29T08:16:00Z")
    repository.add_samples([Sample("PUMP-A1", polled_ns, {"ia_A": 99.0})])
    other_ns = nanoseconds("2026-03-29T09:00:00Z")
    repository.add_samples([Sample("FAN-A2", other_ns, {"ia_A": 5.0})])

    told = bring(client, profile(9)).json()["load_profile"]

    assert (told["added"], told["known"]) == (6, 3)
    quarters = measured(client, 900)
    assert [(one["ia_A"], one["source"]) for one in quarters] == [
        (1.0, "load-profile"),
        (99.0, "polled"),
        (7.0, "load-profile"),
    ]
    others = repository.measurements("FAN-A2", 900, limit=10).items
    assert [one.values["ia_A"] for one in others] == [5.0], "another motor's means are not held up"


def test_polling_after_a_profile_is_averaged_as_ever(client: httpx.Client, repository: Repository) -> None:
    bring(client, profile(3))
    later_ns = nanoseconds("2026-03-29T08:20:00Z")
    repository.add_samples(Sample("PUMP-A1", later_ns + k * 10 * SECOND_NS, {"ia_A": 2.0}) for k in range(6))
    repository.average_measurements(now_ns=later_ns + 3600 * SECOND_NS)
    assert [(one["ia_A"], one["source"]) for one in measured(client, 900)] == [
        (1.0, "load-profile"),
        (2.0, "polled"),
    ]


def test_a_quarter_of_an_hour_that_is_not_over_waits(repository: Repository) -> None:

    rows = [Sample("PUMP-A1", QUARTER_NS + k * 300 * SECOND_NS, {"ia_A": 1.0}) for k in range(4)]
    now_ns = QUARTER_NS + 1100 * SECOND_NS
    told = repository.add_load_profile("PUMP-A1", rows, by=PERSON, now_ns=now_ns)
    assert (told.added, told.known, told.not_over) == (3, 0, 1)


def test_columns_without_a_place_or_a_unit_are_named(client: httpx.Client) -> None:
    report = LDP.replace("IB_MAG", "TCU   ")
    left_out = bring(client, report).json()["load_profile"]["left_out"]
    assert [one["column"] for one in left_out] == ["TCU", "P"]
    assert "power_unit" in left_out[1]["reason"]


def test_a_relay_without_rows_has_none(client: httpx.Client) -> None:
    told = bring(client, HEAD + "LOAD PROFILE\n\nNo Load Profile Data\n").json()["load_profile"]
    assert told == {"added": 0, "known": 0, "not_over": 0, "quantities": [], "left_out": []}


@pytest.mark.parametrize(
    ("report", "told"),
    [
        (LDP.replace("1.203", "x"), "body: line 7, IA_MAG: expected a number, found 'x'"),
        (LDP.replace("1.203", "-1.2"), "body: IA_MAG: expected 0 or more, found -1.2"),
        (LDP.replace("03/29", "13/29"), "body: line 7, time: expected a date and time"),
        (LDP.replace("2026", "2096"), "body: none of 2 rows can be kept"),
        (LDP.replace("_MAG", "_XYZ"), "body: heading: expected IA_MAG"),
    ],
    ids=["figure", "negative", "date", "future", "columns"],
)
def test_what_cannot_be_kept_is_refused(client: httpx.Client, report: str, told: str) -> None:
    answer = bring(client, report)
    assert (answer.status_code, answer.headers["content-type"]) == (422, "application/problem+json")
    assert told in answer.json()["detail"]
    assert measured(client) == []


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.sampled_from([LDP.encode(), CLDP, profile(4).encode()]),
    st.integers(0, 500),
    st.binary(max_size=12),
)
def test_a_damaged_profile_is_kept_or_refused(
    client: httpx.Client, report: bytes, place: int, damage: bytes
) -> None:
    damaged = report[:place] + damage + report[place + len(damage) :]
    assert bring(client, damaged).status_code in (200, 422)
