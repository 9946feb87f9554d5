"""Lists as files, over REST: all rows, in three formats, however the client asks."""

import csv
import io
from collections.abc import Sequence
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any

import httpx
import openpyxl
import pytest
from pyarrow import parquet

from core.starts.changes import REFERENCE_STARTS
from core.starts.examining import examine_start
from service.api import ApiContext, create_app
from service.api.exports import answers
from service.api.limits.admission import Admission
from service.exports import formats
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import Sample
from service.storage.states import AlarmKind
from testing.machines.motors import LARGE
from testing.machines.starts import StartRecord
from testing.no_room import no_room
from testing.service.conditions import FAULT, tell
from testing.service.diagnosed import add_diagnosed
from testing.service.observations import observation
from testing.service.plants import NOW_NS, SECOND_NS, fault, undiagnosable
from testing.service.rotor_and_supply import (
    BROKEN_ROTOR,
    ECCENTRIC_ROTOR,
    SUPPLY,
    SWINGING_LOAD,
    ExaminedRecordings,
)
from testing.service.starts import START, RecordedStarts
from tests.service.api.serving import serving

XLSX = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"
PARQUET = "application/vnd.apache.parquet"
TREND = "/api/v1/motors/PUMP-A1/trend"
EXPORTS = "/api/v1/exports"

Rows = list[dict[str, Any]]


def read(answer: httpx.Response) -> Rows:
    """The rows of a file, by the names of their columns; times as date-times."""
    assert answer.status_code == 200, answer.text
    media_type = answer.headers["content-type"].partition(";")[0]
    content = io.BytesIO(answer.content)
    if media_type == "text/csv":
        return list(csv.DictReader(io.StringIO(answer.text, newline="")))
    if media_type == XLSX:
        sheet = openpyxl.load_workbook(content).worksheets[0]
        names, *rows = sheet.iter_rows(values_only=True)
        return [dict(zip(names, row, strict=True)) for row in rows]
    assert media_type == PARQUET
    table = parquet.read_table(content)
    assert isinstance(table.to_pylist(), list)
    return [dict(row) for row in table.to_pylist()]


@pytest.fixture
def trend(repository: Repository, store: RecordingStore) -> Sequence[str]:
    """Four recordings of PUMP-A1, a second apart, of which two are of the same time, and one of FAN-A2."""
    told = (
        (fault(0.01), 0, "E0"),
        (fault(0.02), 1, "E1"),
        (fault(0.03), 1, "E2"),
        (undiagnosable(), 2, "E3"),
    )
    ids = [
        add_diagnosed(repository, store, diagnosis, NOW_NS + at * SECOND_NS, name=name)
        for diagnosis, at, name in told
    ]
    return [*ids, add_diagnosed(repository, store, fault(0.05), NOW_NS, motor="FAN-A2")]


def test_a_trend_in_every_format(client: httpx.Client, trend: Sequence[str]) -> None:
    found = read(client.get(TREND, params={"format": "csv"}))
    assert [row["recording_id"] for row in found[:1] + found[3:]] == [trend[0], trend[3]]
    assert sorted(float(row["mu_f"]) for row in found[:3]) == [0.01, 0.02, 0.03]
    assert found[0]["time"] == "2025-10-09T08:53:20.000000000Z"
    assert (found[0]["motor"], found[0]["verdict"], found[0]["theta_f"]) == ("PUMP-A1", "fault", "1")
    assert (found[3]["verdict"], found[3]["mu_f"], found[3]["state"]) == ("undiagnosable", "", "")
    items = client.get(TREND).json()["items"]
    assert [row["recording_id"] for row in found] == [item["recording_id"] for item in items]
    excel = read(client.get(TREND, params={"format": "xlsx"}))
    assert excel[0]["time (UTC)"] == datetime(2025, 10, 9, 8, 53, 20)
    assert {row["mu_f"] for row in excel} == {0.01, 0.02, 0.03, None}
    columns = read(client.get(TREND, params={"format": "parquet"}))
    assert columns[0]["time"] == datetime(2025, 10, 9, 8, 53, 20, tzinfo=UTC)
    assert {row["mu_f"] for row in columns} == {0.01, 0.02, 0.03, None}
    assert list(columns[0]) == list(found[0])


def test_a_trend_has_what_is_said_of_the_motor_too(
    client: httpx.Client, repository: Repository, store: RecordingStore
) -> None:
    add_diagnosed(repository, store, fault(0.01), NOW_NS, observed=observation(0))
    tell(repository, FAULT)
    (row,) = read(client.get(TREND, params={"format": "csv"}))
    assert (row["state"], row["kind"], row["phase"]) == ("fault", "shorted-turns", "b")
    assert (row["mu_f"], row["condition_level"], row["change"]) == ("0.01", "0.0121", "0.012")


@pytest.mark.parametrize(
    ("accept", "media_type"),
    [
        ("text/csv", "text/csv; charset=utf-8; header=present"),
        (XLSX, XLSX),
        (PARQUET, PARQUET),
        ("*/*", "application/json"),
        ("text/html,*/*;q=0.8", "application/json"),
    ],
)
def test_the_header_accept_chooses_the_format(
    client: httpx.Client, trend: Sequence[str], accept: str, media_type: str
) -> None:
    answer = client.get(TREND, headers={"Accept": accept})
    assert answer.headers["content-type"] == media_type
    assert client.get(TREND, headers={"Accept": accept}, params={"format": "json"}).json()["items"]
    answer = client.get(f"{EXPORTS}/trend", headers={"Accept": accept})
    assert answer.headers["content-type"].partition(";")[0] in ("text/csv", XLSX, PARQUET)


@pytest.mark.parametrize("accept", ["text/csv", XLSX, PARQUET])
def test_a_trend_has_what_is_shown_of_rotor_and_supply(
    client: httpx.Client, repository: Repository, store: RecordingStore, accept: str
) -> None:
    recorded = ExaminedRecordings(repository, store)
    recorded.add(BROKEN_ROTOR, SUPPLY, eccentricity=ECCENTRIC_ROTOR, pulsation=SWINGING_LOAD)
    recorded.add(None)
    first, second = read(client.get(TREND, headers={"Accept": accept}))
    figures = {
        "rotor_severity_dB": -29.0, "rotor_severity_dB_ci95_low": -31.0, "rotor_detection_limit_dB": -52.0,
        "rotor_lower_sideband_dB": -35.5, "rotor_upper_sideband_dB": -41.0, "load_oscillation_dB": -60.0,
        "slip": 0.031, "frequency_hz": 50.01, "voltage_unbalance_nema": 0.0068, "thd_voltage": 0.021,
        "derating": 1.0, "harmonic_voltage_factor": 0.0085, "current_unbalance": 0.02, "thd_current": 0.035,
        "active_power_W": 612.5, "power_factor": 0.61, "gap_permeance_ripple": 0.0525,
        "gap_permeance_ripple_deviation": 0.002, "gap_detection_limit": 0.0075, "turn_load_torque": 0.001,
        "turn_load_torque_deviation": 0.002, "turn_frequency_hz": 24.25, "swing_load_torque": 0.0625,
        "swing_load_torque_deviation": 0.0015, "swing_detection_limit": 0.005, "swing_noise": 0.001,
        "swing_frequency_hz": 4.125,
    }  # fmt: skip
    assert first["rotor_state"] == "fault"
    assert {name: float(first[name]) for name in figures} == figures
    assert second["rotor_state"] == "unsupported"
    assert not any(second[name] for name in figures)


@pytest.mark.parametrize("wanted", ["csv", "xlsx", "parquet"])
def test_starts_have_what_the_model_tells(
    client: httpx.Client, repository: Repository, store: RecordingStore, wanted: str
) -> None:
    examined = examine_start(StartRecord(snr_db=45.0).of(LARGE), LARGE)
    assert examined.torque is not None
    assert examined.parameters is not None
    recorded = RecordedStarts(repository, store)
    first, second = recorded.add(START), recorded.add(examined)
    other = recorded.add(START, "FAN-A2")
    path = f"{EXPORTS}/starts"
    rows = read(client.get(path, params={"format": wanted}))
    assert [row["recording_id"] for row in rows] == [other, second, first]
    whole, bare = read(client.get(path, params={"format": wanted, "motor": "PUMP-A1"}))
    name = "rotor_resistance_ohm"
    figures = {
        "acceleration_s": examined.figures.acceleration_s,
        "load_torque_Nm": examined.torque.load_torque_Nm,
        name: examined.parameters.values[name],
        f"{name}_ci95_low": examined.parameters.ci95[name][0],
        f"{name}_ci95_high": examined.parameters.ci95[name][1],
    }
    assert {one: float(whole[one]) for one in figures} == pytest.approx(figures, rel=1e-12)
    assert (float(bare["acceleration_s"]), float(bare["i2t_A2s"])) == (1.25, 333.5)
    assert int(bare["is_from_rest"]) == 1
    assert not any(bare[one] for one in ("rotor_state", "load_torque_Nm", name, "share_of_hot_limit"))


def test_starts_are_told_beside_the_first_ones_and_within_their_hour(
    client: httpx.Client, repository: Repository, store: RecordingStore
) -> None:
    recorded = RecordedStarts(repository, store)
    for _ in range(REFERENCE_STARTS):
        recorded.add(START)
    recorded.add(replace(START, acceleration_s=2.5))
    latest, *earlier = read(client.get(f"{EXPORTS}/starts", params={"motor": "PUMP-A1"}))
    told = client.get("/api/v1/motors/PUMP-A1/starts").json()["items"][0]
    assert latest["comparison"] == told["comparison"]["state"] == "not-told-apart"
    assert latest["possible_causes"].split() == told["comparison"]["possible"]
    change = told["comparison"]["changes"]["acceleration"]
    assert float(latest["acceleration_change"]) == pytest.approx(change["change"])
    assert float(latest["acceleration_change_ci95_low"]) == pytest.approx(change["ci95"][0])
    assert int(latest["starts_within_hour"]) == told["starts_within_hour"] == REFERENCE_STARTS + 1
    assert not any(row["comparison"] for row in earlier)
    assert [int(row["starts_within_hour"]) for row in earlier] == [*range(REFERENCE_STARTS, 0, -1)]


def test_several_motors_or_all_in_one_file(client: httpx.Client, trend: Sequence[str]) -> None:
    both = read(client.get(f"{EXPORTS}/trend"))
    assert [row["motor"] for row in both] == ["FAN-A2", *["PUMP-A1"] * 4]
    chosen = {"motor": ["PUMP-A1", "FAN-A2"]}
    assert [row["motor"] for row in read(client.get(f"{EXPORTS}/trend", params=chosen))] == [
        *["PUMP-A1"] * 4,
        "FAN-A2",
    ]
    window = {"from": "2025-10-09T08:53:21Z", "to": "2025-10-09T08:53:22Z", "motor": "PUMP-A1"}
    assert {row["mu_f"] for row in read(client.get(f"{EXPORTS}/trend", params=window))} == {"0.02", "0.03"}
    recordings = read(client.get(f"{EXPORTS}/recordings"))
    assert {row["recording_id"] for row in recordings} == set(trend)
    assert {row["verdict"] for row in recordings} == {"fault", "undiagnosable"}


def test_recordings_as_the_list_has_them(client: httpx.Client, trend: Sequence[str]) -> None:
    for path, query in (
        ("/api/v1/recordings", {}),
        ("/api/v1/recordings", {"motor": "FAN-A2"}),
        ("/api/v1/recordings", {"state": "announced"}),
        ("/api/v1/motors/PUMP-A1/recordings", {}),
        ("/api/v1/motors/PUMP-A1/recordings", {"operation": "start"}),
    ):
        items = client.get(path, params=query).json()["items"]
        rows = read(client.get(path, params={**query, "format": "csv"}))
        assert [row["recording_id"] for row in rows] == [item["id"] for item in items]
        assert [row["verdict"] or None for row in rows] == [item["verdict"] for item in items]


def test_measurements_as_the_list_has_them(client: httpx.Client, repository: Repository) -> None:
    values = {"ia_A": 7.5, "power_W": -800.0}
    repository.add_samples(Sample("PUMP-A1", NOW_NS + i * 10 * SECOND_NS, values) for i in range(1200))
    repository.average_measurements(now_ns=NOW_NS + 20_000 * SECOND_NS)
    path = "/api/v1/motors/PUMP-A1/measurements"
    rows = read(client.get(path, params={"format": "csv"}))
    assert len(rows) == 1200, "more than a page"
    assert len({row["time"] for row in rows}) == 1200
    assert (rows[0]["ia_A"], rows[0]["power_W"], rows[0]["vab_V"]) == ("7.5", "-800.0", "")
    minutes = read(client.get(path, params={"format": "parquet", "step": 60}))
    assert [row["samples"] for row in minutes][:2] == [4, 6]
    of_all = read(client.get(f"{EXPORTS}/measurements", params={"step": 60}))
    assert len(of_all) == len(minutes)


def test_hostile_words_of_a_relay_are_no_formulas(client: httpx.Client, repository: Repository) -> None:
    repository.raise_alarm(
        "A1_SEL710", AlarmKind.FILE_REFUSED, "=cmd|' /C calc'!A0", "+1;=2\x07\u202e", now_ns=NOW_NS
    )
    (row,) = read(client.get(f"{EXPORTS}/alarms"))
    assert (row["subject"], row["reason"]) == ("'=cmd|' /C calc'!A0", "'+1;'=2")
    (row,) = read(client.get(f"{EXPORTS}/alarms", params={"format": "xlsx"}))
    assert row["subject"] == "=cmd|' /C calc'!A0"


def test_alarms_as_the_lists_have_them(client: httpx.Client, repository: Repository) -> None:
    for at, relay in enumerate(("A1_SEL710", "A2_SEL710", "A1_SEL710")):
        repository.raise_alarm(relay, AlarmKind.FILE_REFUSED, f"{at}", "odd", now_ns=NOW_NS + at)
    for path in (
        "/api/v1/alarms",
        "/api/v1/alarms?ied=A1_SEL710",
        "/api/v1/alarms?standing=false",
        "/api/v1/alarms/open",
        "/api/v1/alarms/open?state=acknowledged",
        "/api/v1/alarms/open?ied=A2_SEL710",
    ):
        items = client.get(path).json()["items"]
        rows = read(client.get(path, headers={"Accept": "text/csv"}))
        assert [(row["alarm_id"], row["priority"], row["state"]) for row in rows] == [
            (item["id"], item["priority"], item["state"]) for item in items
        ]


def test_what_is_wrong_is_told_in_words(client: httpx.Client, trend: Sequence[str]) -> None:
    for path, status, words in (
        (f"{TREND}?format=pdf", 422, "csv"),
        (f"{TREND}?format=csv&limit=10", 422, "a file has the whole list: leave limit out"),
        (f"{TREND}?format=csv&cursor=x", 422, "leave cursor out"),
        (f"{EXPORTS}/trend?motor=PUMP-A1&motor=PUMP-A2", 404, "PUMP-A1"),
        (f"{EXPORTS}/trend?motors=PUMP-A1", 422, "did you mean 'motor'?"),
        (f"{EXPORTS}/trend?format=csv&format=csv", 422, "expected it once"),
        (f"{EXPORTS}/trend?format=json", 422, "csv"),
        (f"{EXPORTS}/alarms?motor=NOPE", 404, "NOPE"),
        ("/api/v1/motors/NOPE/trend?format=csv", 404, "NOPE"),
    ):
        answer = client.get(path)
        assert (answer.status_code, words in answer.json()["detail"]) == (status, True), answer.text
        assert answer.headers["content-type"] == "application/problem+json"


def test_the_file_has_a_name_that_every_system_takes(client: httpx.Client, trend: Sequence[str]) -> None:
    disposition = client.get(TREND, params={"format": "csv"}).headers["content-disposition"]
    assert disposition.startswith('attachment; filename="trend_PUMP-A1_20')
    assert disposition.endswith('Z.csv"')
    disposition = client.get(f"{EXPORTS}/trend", params={"format": "xlsx"}).headers["content-disposition"]
    assert disposition.startswith('attachment; filename="trend_20')


def test_parquet_without_its_library_is_refused_in_words(
    client: httpx.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(formats, "find_spec", lambda _name: None)
    answer = client.get(TREND, params={"format": "parquet"})
    assert answer.status_code == 406
    assert "statorwatch[parquet]" in answer.json()["detail"]
    assert client.get(TREND, params={"format": "csv"}).status_code == 200


def test_a_full_disk_is_503_with_words(client: httpx.Client, trend: Sequence[str]) -> None:
    client.get(TREND, params={"format": "xlsx"}).raise_for_status()  # all is imported and cached
    with no_room():
        answer = client.get(TREND, params={"format": "xlsx"})
    assert answer.status_code == 503
    assert "no room on the disk" in answer.json()["detail"]
    assert client.get(TREND, params={"format": "xlsx"}).status_code == 200


def test_few_files_are_made_at_a_time(context: ApiContext) -> None:
    none = replace(context, exports=Admission("exports", 0, wait_s=0.01))
    with serving(create_app(none)) as client:
        answer = client.get(TREND, params={"format": "csv"})
        assert answer.status_code == 503
        assert "exports" in answer.json()["detail"]
        assert client.get(TREND).status_code == 200, "pages of JSON go on"


def test_a_file_that_is_broken_off_does_not_look_complete(
    client: httpx.Client, trend: Sequence[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(answers, "LONGEST_S", -1.0)
    with pytest.raises(httpx.RemoteProtocolError):
        client.get(TREND, params={"format": "csv"})
