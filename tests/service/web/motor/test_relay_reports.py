"""The form that brings a relay's text report: what it says of each kind, and of one that cannot be kept."""

from pathlib import Path

import httpx
import pytest

from core.relay_reports import ReportKind
from service.access.permissions import Permission
from service.api import ApiContext
from service.api.limits.body_limits import MAX_REPORT_BYTES
from service.condition.motor_data import document_of
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import Role
from testing.service.accounts import token_of
from testing.service.plants import motor
from tests.core.relay_reports.examples import LDP, MOT, MSR, SER
from tests.service.web.pages import HOSTILE, addresses, page, words

HERE = "/motors/PUMP-A1"
REPORTS = f"{HERE}/reports"
TOLD = {
    ReportKind.MOTOR_STARTS: (MSR, "kept as a start that was not recorded"),
    ReportKind.LOAD_PROFILE: (
        LDP,
        "Column P is left out: no report tells its unit: say power_unit, W or kW.",
    ),
    ReportKind.MOTOR_STATISTICS: (MOT, "Motor statistics (MOT) of 2026-03-29"),
    ReportKind.SEQUENCE_OF_EVENTS: (SER, "Kept: 1. Other elements, left out: RUNNING"),
}


@pytest.fixture
def context(repository: Repository, store: RecordingStore, tmp_path: Path) -> ApiContext:
    known = motor("PUMP-A1")
    repository.note_motors({"PUMP-A1": document_of(known)}, now_ns=1)
    return ApiContext(Settings(data_directory=tmp_path), repository, store, motors={"PUMP-A1": known})


def bring(client: httpx.Client, report: str, name: str = "report.txt", **form: str) -> httpx.Response:
    return client.post(REPORTS, files={"report": (name, report.encode("latin-1"))}, data=form)


@pytest.mark.parametrize("kind", ReportKind)
def test_a_report_of_each_kind_is_kept_and_says_so(client: httpx.Client, kind: ReportKind) -> None:
    report, told = TOLD[kind]
    [kept] = words(page(bring(client, report)), "#kept")
    assert f"({kind})" in kept
    assert told in kept


def test_a_report_that_is_brought_again_is_known(client: httpx.Client) -> None:
    bring(client, SER)
    [kept] = words(page(bring(client, SER)), "#kept")
    assert "Kept: 0. Known already: 1." in kept


def test_the_unit_of_power_and_the_order_of_dates_are_taken_from_the_form(client: httpx.Client) -> None:
    [kept] = words(page(bring(client, LDP, power_unit="kW")), "#kept")
    assert "power_W" in kept
    assert "left out" not in kept
    refused = bring(client, SER, date_order="YMD")
    assert refused.status_code == 422
    assert "line 7, time: expected a date and time that exist" in refused.text
    assert "<option selected>YMD</option>" in refused.text


@pytest.mark.parametrize(
    ("report", "name", "told"),
    [
        ("", "", "Nothing was kept: choose its file first."),
        ("", "MOT.TXT", "Nothing was kept of MOT.TXT: its file is empty."),
        (MOT.replace(" 17", " x"), "MOT.TXT", "line 10, number of starts: expected a number, found 'x'."),
        ("nothing", HOSTILE, "&lt;script&gt;"),
    ],
    ids=["none", "empty", "wrong", "hostile"],
)
def test_what_is_wrong_stands_beside_the_form(
    client: httpx.Client, report: str, name: str, told: str
) -> None:
    answer = bring(client, report, name)
    assert answer.status_code == 422
    assert told in answer.text.replace("&#39;", "'")
    assert HOSTILE not in answer.text


def test_a_report_that_is_too_long_is_refused(client: httpx.Client) -> None:
    assert bring(client, SER + "\n" * MAX_REPORT_BYTES).status_code == 413


def test_the_form_is_on_the_page_of_who_may_bring_recordings(
    client: httpx.Client, context: ApiContext
) -> None:
    assert REPORTS in addresses(page(client.get(f"{HERE}/recordings")), "#reports form")
    client.headers["Authorization"] = f"Bearer {token_of(context.repository, Role.VIEWER, name='viewer')}"
    assert not page(client.get(f"{HERE}/recordings")).cssselect("#reports")
    refused = bring(client, SER)
    assert refused.status_code == 403
    assert Permission.RECORDINGS in refused.text
