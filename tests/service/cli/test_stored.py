"""`mcc trend`, `recordings`, `upload`, `rediagnose`, `baseline`: against the API on a real port."""

import csv
import io
import json
import zipfile
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import httpx
import pytest

from service.api import ApiContext, create_app
from service.cli.app import main
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.service.conditions import FAULT, tell
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER
from testing.service.plants import NOW_NS, SECOND_NS, fault, healthy, motor
from testing.service.rotor_and_supply import (
    BROKEN_ROTOR,
    ECCENTRIC_ROTOR,
    SHORT_RECORD,
    SUPPLY,
    SWINGING_LOAD,
    ExaminedRecordings,
)
from testing.service.small_record import CFG, DAT
from testing.service.starts import START, RecordedStarts
from tests.core.relay_reports.examples import LDP, MOT, MSR, SER
from tests.service.api.serving import serving
from tests.service.fixtures import database_url, engine, repository, store

__all__ = ["database_url", "engine", "repository", "store"]

Mcc = Callable[..., str]
FORMULA = "=1+1 the relay's"


@pytest.fixture
def recorded(repository: Repository, store: RecordingStore) -> list[str]:
    """Four recordings of PUMP-A1, a second apart: three healthy ones, then a fault."""
    ids = []
    for k, diagnosis in enumerate([healthy(), healthy(), healthy(), fault(0.02)]):
        stored = store.store({f"E{k}.CFF": b"samples %d" % k})
        added = repository.add_recording(stored, motor="PUMP-A1", now_ns=NOW_NS + k)
        claimed = repository.claim_job(now_ns=NOW_NS + k, runner=RUNNER)
        assert claimed is not None
        recorded_ns = NOW_NS + k * SECOND_NS
        repository.finish_job(
            claimed.job.id, findings_of(diagnosis), recorded_ns=recorded_ns, now_ns=recorded_ns, runner=RUNNER
        )
        ids.append(added.recording.id)
    return ids


@pytest.fixture
def client(repository: Repository, store: RecordingStore, tmp_path: Path) -> Iterator[httpx.Client]:
    motors = {"PUMP-A1": motor("PUMP-A1")}
    context = ApiContext(Settings(data_directory=tmp_path), repository, store, motors=motors)
    with serving(create_app(context)) as client:
        yield client


@pytest.fixture
def mcc(client: httpx.Client, capsys: pytest.CaptureFixture[str]) -> Mcc:
    """Run a command against the service; returns what it prints."""

    def run(*words: str, ends: int = 0) -> str:
        assert main([*words, "--url", str(client.base_url)]) == ends
        output = capsys.readouterr()
        return output.err if ends else output.out

    return run


def rows(text: str) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(text)))


def test_starts(mcc: Mcc, repository: Repository, store: RecordingStore) -> None:
    starts = RecordedStarts(repository, store)
    for _ in range(5):
        starts.add(START)
    starts.add(replace(START, acceleration_s=2.0))

    table = mcc("starts", "PUMP-A1")
    assert table.count("reference") == 5
    assert "not told apart" in " ".join(table.split())
    found = json.loads(mcc("starts", "PUMP-A1", "--json", "--limit", "1"))["starts"]
    assert [one["acceleration_s"] for one in found] == [2.0]
    assert [one["is_reference"] for one in rows(mcc("starts", "PUMP-A1", "--csv"))][:1] == ["True"]
    assert mcc("starts", "FAN-A2") == "no starts\n"


def test_starts_of_a_report(mcc: Mcc, tmp_path: Path) -> None:
    report = tmp_path / "MSR.TXT"
    report.write_text(MSR, encoding="ascii")
    first, second = mcc("import-report", "PUMP-A1", str(report)).splitlines()
    assert "10:15:01 UTC: a start that was not recorded (" in first
    assert "08:00:00 UTC: left out:" in second
    assert "was there already" in mcc("import-report", "PUMP-A1", str(report))
    told = json.loads(mcc("import-report", "PUMP-A1", str(report), "--json"))
    assert [one["outcome"] for one in told["motor_starts"]["starts"]] == ["known"]
    [start] = rows(mcc("starts", "PUMP-A1", "--csv"))
    assert (start["source"], start["acceleration_s"], start["recording_id"]) == ("report", "0.3", "")

    report.write_text(LDP, encoding="ascii")
    added, left_out = mcc("import-report", "PUMP-A1", str(report)).splitlines()
    assert added == "rows of load that were not known: 2"
    assert left_out == "column P: left out: no report tells its unit: say power_unit, W or kW"
    again = mcc("import-report", "PUMP-A1", str(report), "--power-unit", "W")
    assert "rows of quarters of an hour that are known already: 2" in again
    report.write_text(MOT, encoding="ascii")
    assert "10:15:30 UTC: kept; mcc load shows them" in mcc("import-report", "PUMP-A1", str(report))
    report.write_text(SER, encoding="ascii")
    events, others = mcc("import-report", "PUMP-A1", str(report)).splitlines()
    assert events == "starts, stops and trips that were not known: 1"
    assert others == "other elements, left out: RUNNING, Relay Powered Up"
    assert "10:15:01 UTC" in mcc("relay-events", "PUMP-A1")
    [event] = json.loads(mcc("relay-events", "PUMP-A1", "--json"))["relay_events"]
    assert event == {"time": "2026-03-29T10:15:01.250000000Z", "kind": "start"}
    report.write_text(MSR.replace("7.10", "x"), encoding="ascii")
    refused = " ".join(mcc("import-report", "PUMP-A1", str(report), ends=1).split())
    assert "line 13, I(A): expected a number, found 'x'" in refused
    assert "expected a file" in mcc("import-report", "PUMP-A1", str(tmp_path / "none"), ends=1)


def test_a_trend(mcc: Mcc, recorded: list[str]) -> None:
    table = mcc("trend", "PUMP-A1").splitlines()
    assert [line.split()[0] for line in table if line.strip()][2:] == ["2025-10-09"] * 4
    assert f"2.00 [1.60..2.40] 2.10 fault {recorded[3]}" in " ".join(table[-2].split())
    found = json.loads(mcc("trend", "PUMP-A1", "--json"))["points"]
    assert [point["recording_id"] for point in found] == recorded
    [last] = rows(mcc("trend", "PUMP-A1", "--csv", "--limit", "1"))
    assert (last["time"], last["value"], last["recording_id"]) == (found[3]["time"], "0.02", recorded[3])
    assert float(last["ci95_low"]) == found[3]["ci95"][0]
    load = mcc("trend", "PUMP-A1", "--quantity", "load_level", "--from", "2025-10-09", "--to", "2025-10-10")
    assert load.count("0.480 [0.460..0.500]") == 4
    assert mcc("trend", "PUMP-A1", "--from", "2025-10-10") == "no points\n"
    assert "did you mean 'PUMP-A1'?" in mcc("trend", "pump-a1", ends=1)


def test_the_trend_of_a_condition(mcc: Mcc, repository: Repository) -> None:
    tell(repository, FAULT)
    assert mcc("trend", "PUMP-A1", "--quantity", "condition_level") == "no points\n"


def test_the_trend_of_the_rotor(mcc: Mcc, repository: Repository, store: RecordingStore) -> None:
    recorded = ExaminedRecordings(repository, store)
    recorded.add(SHORT_RECORD, SUPPLY)
    broken = recorded.add(BROKEN_ROTOR, SUPPLY)
    words = ("trend", "PUMP-A1", "--quantity", "rotor_severity_dB")
    shown = " ".join(mcc(*words).split())
    assert "rotor severity dB detection limit dB rotor recording" in shown
    assert " UTC - - not assessed " in shown
    assert f"-29.0 [-31.0..-27.5] -52.0 fault {broken}" in shown
    first, second = json.loads(mcc(*words, "--json"))["points"]
    assert (first["value"], first["state"], first["reasons"]) == (
        None,
        "unsupported",
        ["the record is too short for this slip"],
    )
    assert (second["value"], second["ci95"], second["detection_limit"]) == (-29.0, [-31.0, -27.5], -52.0)
    [last] = rows(mcc(*words, "--csv", "--limit", "1"))
    assert (last["value"], last["ci95_low"], last["detection_limit"]) == ("-29.0", "-31.0", "-52.0")
    assert (last["state"], last["recording_id"]) == ("fault", broken)
    assert mcc(*words, "--to", "2025-10-09") == "no points\n"


@pytest.mark.parametrize(
    ("quantity", "heading", "shown"),
    [
        ("frequency_hz", "frequency Hz", "50.010"),
        ("voltage_deviation", "voltage deviation %", "-0.27"),
        ("voltage_unbalance_iec", "voltage unbalance iec %", "0.71"),
        ("voltage_unbalance_nema", "voltage unbalance nema %", "0.68"),
        ("derating", "derating", "1.000"),
        ("thd_voltage", "thd voltage %", "2.10"),
        ("harmonic_voltage_factor", "harmonic voltage factor", "0.0085"),
        ("current_unbalance", "current unbalance %", "2.00"),
        ("thd_current", "thd current %", "3.50"),
        ("active_power_W", "active power W", "612.5"),
        ("power_factor", "power factor", "0.610"),
    ],
)
def test_the_trend_of_the_supply(
    mcc: Mcc, repository: Repository, store: RecordingStore, quantity: str, heading: str, shown: str
) -> None:
    recording = ExaminedRecordings(repository, store).add(None, SUPPLY)
    table = " ".join(mcc("trend", "PUMP-A1", "--quantity", quantity).split())
    assert f"time {heading} recording" in table
    assert f" UTC {shown} {recording}" in table
    [point] = json.loads(mcc("trend", "PUMP-A1", "--quantity", quantity, "--json"))["points"]
    assert (point["value"], point["recording_id"]) == (getattr(SUPPLY, quantity), recording)
    [row] = rows(mcc("trend", "PUMP-A1", "--quantity", quantity, "--csv"))
    assert float(row["value"]) == getattr(SUPPLY, quantity)


@pytest.mark.parametrize(
    ("quantity", "heading", "shown", "value"),
    [
        (
            "gap_permeance_ripple",
            "gap permeance ripple % detection limit %",
            "5.25 [4.86..5.64] 0.75",
            0.0525,
        ),
        ("turn_load_torque", "turn load torque %", "0.10 [0.00..0.49]", 0.001),
        ("swing_load_torque", "swing load torque % detection limit %", "6.25 [5.96..6.54] 0.50", 0.0625),
        ("swing_frequency_hz", "swing frequency Hz", "4.125", 4.125),
    ],
)
def test_the_trend_of_air_gap_and_load(
    mcc: Mcc,
    repository: Repository,
    store: RecordingStore,
    quantity: str,
    heading: str,
    shown: str,
    value: float,
) -> None:
    recorded = ExaminedRecordings(repository, store)
    recording = recorded.add(SHORT_RECORD, eccentricity=ECCENTRIC_ROTOR, pulsation=SWINGING_LOAD)
    table = " ".join(mcc("trend", "PUMP-A1", "--quantity", quantity).split())
    assert f"time {heading} recording" in table
    assert f" UTC {shown} {recording}" in table
    [point] = json.loads(mcc("trend", "PUMP-A1", "--quantity", quantity, "--json"))["points"]
    assert (point["value"], point["recording_id"]) == (value, recording)
    [row] = rows(mcc("trend", "PUMP-A1", "--quantity", quantity, "--csv"))
    assert float(row["value"]) == value


@pytest.mark.parametrize("words", [("recordings",), ("recordings", "list")])
def test_recordings_are_listed(mcc: Mcc, recorded: list[str], words: tuple[str, ...]) -> None:
    shown = mcc(*words)
    assert [line.split()[-1] for line in shown.splitlines()[3:] if line.strip()] == recorded[::-1]
    assert (shown.count("diagnosed: healthy"), shown.count("diagnosed: fault")) == (3, 1)
    assert mcc(*words, "FAN-A2") == "no recordings\n"
    assert mcc(*words, "--state", "failed") == "no recordings\n"
    assert [row["id"] for row in rows(mcc(*words, "PUMP-A1", "--csv", "--limit", "2"))] == recorded[:1:-1]
    assert len(json.loads(mcc(*words, "--json"))["recordings"]) == 4
    assert "expected one of --csv and --json" in mcc(*words, "--csv", "--json", ends=2)


def test_a_recording_comes_and_goes(
    mcc: Mcc, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, client: httpx.Client
) -> None:
    for name, content in (("EVENT.CFG", CFG), ("EVENT.DAT", DAT)):
        (tmp_path / name).write_bytes(content)
    files = (str(tmp_path / "EVENT.CFG"), str(tmp_path / "EVENT.DAT"))
    added = json.loads(mcc("upload", "FAN-A2", *files, "--json"))
    assert added["motor"] == "FAN-A2"
    again = mcc("upload", "FAN-A2", *files)
    assert "was there already, fetched" in again
    assert "mcc recordings list FAN-A2 shows what comes of it; mcc upload --wait 60 waits" in again
    assert "no verdict within 0.01 s" in mcc("upload", "FAN-A2", *files, "--wait", "0.01", ends=1)
    assert "expected a file" in mcc("upload", "FAN-A2", str(tmp_path / "NONE.CFF"), ends=1)
    assert "the .DAT file that belongs to" in mcc("upload", "FAN-A2", files[0], ends=1)
    monkeypatch.chdir(tmp_path)
    saved = Path(json.loads(mcc("recordings", "download", added["id"], "--json"))["file"])
    assert saved.name.startswith("FAN-A2_20")
    assert saved.suffix == ".zip"
    with zipfile.ZipFile(saved) as archive:
        assert {name: archive.read(name) for name in archive.namelist()} == {
            "EVENT.CFG": CFG,
            "EVENT.DAT": DAT,
        }
    assert "File exists" in mcc("recordings", "download", added["id"], ends=1), "nothing is overwritten"
    (tmp_path / "other").mkdir()
    mcc("recordings", "download", added["id"], "--output", str(tmp_path / "other"))
    assert (tmp_path / "other" / saved.name).read_bytes()[:2] == b"PK"


def test_an_upload_is_waited_for(mcc: Mcc, tmp_path: Path, repository: Repository) -> None:
    files = [tmp_path / name for name in ("EVENT.CFG", "EVENT.DAT")]
    for file, content in zip(files, (CFG, DAT), strict=True):
        file.write_bytes(content)
    words = ("upload", "FAN-A2", *map(str, files))
    mcc(*words)
    claimed = repository.claim_job(now_ns=NOW_NS * 2, runner=RUNNER)
    assert claimed is not None
    repository.finish_job(
        claimed.job.id, findings_of(fault(0.02)), recorded_ns=NOW_NS, now_ns=NOW_NS, runner=RUNNER
    )
    for shown in (mcc(*words, "--wait", "60"), mcc(*words)):
        assert "FAN-A2: fault in phase" in shown
    assert json.loads(mcc(*words, "--wait", "60", "--json"))["diagnosis"]["verdict"] == "fault"


def test_what_was_refused_says_why(mcc: Mcc, tmp_path: Path, repository: Repository) -> None:
    file = tmp_path / "EVENT.CFF"
    file.write_bytes(b"no recording")
    mcc("upload", "FAN-A2", str(file))
    claimed = repository.claim_job(now_ns=NOW_NS * 2, runner=RUNNER)
    assert claimed is not None
    repository.reject_recording(claimed.job.id, "EVENT.CFF: line 1: wrong", now_ns=NOW_NS, runner=RUNNER)
    assert "rejected: EVENT.CFF: line 1" in mcc("upload", "FAN-A2", str(file), "--wait", "60", ends=1)
    assert "was there already, rejected: EVENT.CFF: line 1" in mcc("upload", "FAN-A2", str(file))
    assert "FAN-A2, EVENT: rejected: EVENT.CFF: line 1: wrong" in mcc("recordings").splitlines()


def test_files_of_two_recordings_are_refused(mcc: Mcc, tmp_path: Path) -> None:
    for name, content in (("ONE.CFG", CFG), ("TWO.DAT", DAT)):
        (tmp_path / name).write_bytes(content)
    refused = mcc("upload", "FAN-A2", str(tmp_path / "ONE.CFG"), str(tmp_path / "TWO.DAT"), ends=1)
    assert "have the same name, found 'ONE.CFG' and 'TWO.DAT'" in refused


@pytest.mark.parametrize("columns", ["80", "100", "250"])
def test_ids_stay_whole(mcc: Mcc, recorded: list[str], columns: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Other commands need them."""
    monkeypatch.setenv("COLUMNS", columns)
    mcc("baseline", "set", "PUMP-A1", *recorded[:3])
    for words in (("recordings",), ("recordings", "PUMP-A1")):
        assert set(recorded) <= set(mcc(*words).split()), words
    assert set(recorded[:3]) <= set(mcc("baseline", "PUMP-A1").split())
    assert set(recorded) <= set(mcc("rediagnose", *recorded, "--wait", "0").split())


def test_recordings_are_diagnosed_again(mcc: Mcc, recorded: list[str], repository: Repository) -> None:
    shown = mcc("rediagnose", recorded[0], recorded[1], "--wait", "0")
    assert " ".join(shown.split()).count("queued") == 2
    [run] = json.loads(mcc("rediagnose", recorded[3], "--wait", "0", "--json"))["diagnoses"]
    assert (run["state"], run["recording_id"]) == ("queued", recorded[3])
    claimed = repository.claim_job(now_ns=NOW_NS * 2, runner=RUNNER)
    assert claimed is not None
    assert claimed.job.recording_id in recorded
    unknown = "00000000-0000-4000-8000-000000000000"
    assert "there is no recording" in mcc("rediagnose", unknown, ends=1)


def test_a_baseline_is_chosen_and_dropped(mcc: Mcc, recorded: list[str]) -> None:
    assert mcc("baseline", "PUMP-A1") == "no baseline\n"
    assert "3 recordings are its baseline" in mcc(
        "baseline", "set", "PUMP-A1", *recorded[:3], "--reason", "new"
    )
    shown = mcc("baseline", "PUMP-A1")
    assert [line.split()[-1] for line in shown.splitlines()[3:6]] == recorded[:3]
    assert ": new (" in shown
    assert [row["id"] for row in rows(mcc("baseline", "show", "PUMP-A1", "--csv"))] == recorded[:3]
    few = mcc("baseline", "set", "PUMP-A1", *recorded[:2], ends=1)
    assert few == "mcc: recording_ids: expected at least 3 different ones, found 2\n"
    assert "recording_id: expected an id such as mcc recordings list shows, found 'E1'" in mcc(
        "recordings", "download", "E1", ends=1
    )
    assert "in doubt" in mcc("baseline", "set", "PUMP-A1", *recorded[1:], ends=1), "one shows a fault"
    assert json.loads(mcc("baseline", "PUMP-A1", "--json"))["reason"] == "new"
    assert "no baseline any more" in mcc("baseline", "drop", "PUMP-A1")
    assert json.loads(mcc("baseline", "PUMP-A1", "--json"))["recordings"] == []
