"""`mcc follow`: a motor's condition from files, without a service."""

import json
import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from core.condition.following.follower import Follower
from core.condition.measuring.observing import observe
from core.condition.verdict.judging import condition_of
from core.machines.motor_file.reader import read_motor
from core.machines.motor_file.writer import write_motor
from core.recordings import comtrade, read
from core.recordings.comtrade.writer import DataFormat
from core.time_stamps import rfc3339
from core.units import NANOSECONDS_PER_DAY
from service.cli import main
from service.cli.conditions.followed_records import FEW, find_records, observe_all, observe_record
from service.cli.conditions.view import print_condition
from testing.machines.motors import MEDIUM, REFERENCE
from testing.machines.phase_circuits import Fault
from testing.machines.record_series import BEGUN_NS, HOUR_NS, write_series

RECORDS = FEW + 2
MOST_COLUMNS = 130
"""Of what is printed into a file or a pipe."""


@pytest.fixture(scope="module")
def plant(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the records of a motor, and its file beside it."""
    folder = tmp_path_factory.mktemp("plant")
    write_motor(folder / "PUMP.toml", REFERENCE)
    (folder / "records").mkdir()
    write_series(folder / "records", REFERENCE, RECORDS)
    return folder


@pytest.fixture
def few(plant: Path, tmp_path: Path) -> Path:
    """A folder of its own with three of the records and the motor's file."""
    shutil.copy(plant / "PUMP.toml", tmp_path)
    for k in range(3):
        for suffix in (".CFG", ".DAT"):
            shutil.copy(plant / "records" / f"R{k:04d}{suffix}", tmp_path)
    return tmp_path


def followed(capsys: pytest.CaptureFixture[str], folder: Path, *words: str) -> dict[str, Any]:
    assert main(["follow", *words, "--motor", str(folder / "PUMP.toml"), "--json"]) == 0
    document: dict[str, Any] = json.loads(capsys.readouterr().out)
    return document


def test_the_document_is_that_of_the_records_folded_in_their_order(
    plant: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    motor = read_motor(plant / "PUMP.toml")
    follower = Follower(motor)
    paths = sorted((plant / "records").glob("*.CFG"))
    for path in paths:
        observation = observe(read(path), motor)
        assert observation is not None
        follower.fold(observation)
    last_ns = BEGUN_NS + (RECORDS - 1) * HOUR_NS
    expected = condition_of(motor, follower.assessment(), last_ns).as_dict()
    document = followed(capsys, plant, *(str(path) for path in reversed(paths)))
    assert {key: document[key] for key in expected} == expected
    assert (document["motor"], document["as_of"]) == ("PUMP", rfc3339(last_ns))
    assert [entry["time"] for entry in document["history"]] == [
        rfc3339(BEGUN_NS + k * HOUR_NS) for k in range(RECORDS)
    ]
    assert document["history"][-1]["state"] == document["state"]
    assert document["skipped"] == []


def test_turns_that_short_are_found_with_their_phase(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_motor(tmp_path / "PUMP.toml", REFERENCE)
    faulty_from = 30
    write_series(
        tmp_path, REFERENCE, 50, fault=lambda k: Fault(0.02, winding=2) if k >= faulty_from else None
    )
    document = followed(capsys, tmp_path, str(tmp_path))
    assert (document["state"], document["phase"]) == ("fault", "c")
    assert "shorted-turns" in (document["kind"], *document["candidates"])
    assert document["change_ci95"][0] < 0.02 < document["change_ci95"][1]
    assert document["since"] == rfc3339(BEGUN_NS + faulty_from * HOUR_NS)
    states = [entry["state"] for entry in document["history"]]
    assert set(states[:faulty_from]) == {"healthy"}
    assert "watch" in states[faulty_from:]


def test_parameters_that_do_not_fit_are_named_over_several_records(
    plant: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    placeholder = replace(REFERENCE.parameters, stator_self_inductance_H=0.35)
    write_motor(tmp_path / "PUMP.toml", replace(REFERENCE, parameters=placeholder))
    document = followed(capsys, tmp_path, str(plant / "records"))
    assert document["reasons"][0].startswith(
        "the parameters in the motor's file do not fit its records (L_s): commission this motor"
    )
    assert "Commission this motor (mcc commission)" in document["advice"]


def test_a_motor_with_nothing_but_a_nameplate_is_followed_and_asks_to_be_commissioned(
    plant: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    complete = (plant / "PUMP.toml").read_text("utf-8")
    (tmp_path / "PUMP.toml").write_text(complete.partition("[parameters]")[0], "utf-8")
    assert main(["follow", str(plant / "records"), "--motor", str(tmp_path / "PUMP.toml"), "--json"]) == 0
    printed = capsys.readouterr()
    document = json.loads(printed.out)
    assert document["state"] in ("unknown", "watch")
    assert document["reasons"][0].startswith("collecting; commission me")
    assert document["mu_f"] is not None
    assert "no record after" not in printed.err


def test_several_processes_see_what_one_sees(plant: Path) -> None:
    motor = read_motor(plant / "PUMP.toml")
    paths = find_records([str(plant / "records")])
    told: list[tuple[int, int]] = []
    together = observe_all(paths, motor, lenient=False, advance=lambda done, of: told.append((done, of)))
    assert together == [observe_record(path, motor, lenient=False) for path in paths]
    assert told == [(k, RECORDS) for k in range(1, RECORDS + 1)]


def test_folders_patterns_and_files_mean_each_record_once(few: Path) -> None:
    (few / "BELOW").mkdir()
    shutil.copy(few / "R0000.CFG", few / "BELOW" / "R0009.cfg")
    (few / "R0001.CEV").write_text("the same event in the other format")
    (few / "notes.txt").write_text("no recording")
    found = find_records([str(few), str(few / "R*.CFG"), str(few / "R0000.CFG")])
    assert [path.name for path in found] == ["R0009.cfg", "R0000.CFG", "R0001.CFG", "R0002.CFG"]
    missing = [str(few / "R0100.CFG"), str(few / "X*.CFG")]
    assert [str(path) for path in find_records(missing)] == missing


def test_what_cannot_be_used_is_named_and_the_rest_is_followed(
    few: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (few / "BAD.CFG").write_text("nothing of the kind")
    (few / "PICTURE.png").write_bytes(b"\x89PNG")
    for suffix in (".CFG", ".DAT"):
        shutil.copy(few / f"R0001{suffix}", few / f"COPY{suffix}")
    document = followed(capsys, few, str(few), str(few / "PICTURE.png"), str(few / "GONE.CFG"))
    assert len(document["history"]) == 3
    reasons = {Path(one["record"]).name: one["reason"] for one in document["skipped"]}
    assert set(reasons) == {"BAD.CFG", "PICTURE.png", "GONE.CFG", "R0001.CFG"}
    assert "copy of" in reasons["R0001.CFG"]
    assert "suffix" in reasons["PICTURE.png"]


def test_of_an_event_in_several_formats_the_finest_counts(
    few: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    event = read(few / "R0001.CFG")
    (few / "R0001.CFG").unlink()
    formats: dict[str, DataFormat] = {"OSCA001": "ASCII", "OSC16B001": "BINARY", "OSC32F001": "FLOAT32"}
    for name, data_format in formats.items():
        comtrade.write(few / f"{name}.CFG", event, revision=2013, data_format=data_format)
    document = followed(capsys, few, str(few))
    assert [Path(one["record"]).name for one in document["history"]] == [
        "R0000.CFG",
        "OSC32F001.CFG",
        "R0002.CFG",
    ]
    skipped = {Path(one["record"]).name: one["reason"] for one in document["skipped"]}
    assert set(skipped) == {"OSCA001.CFG", "OSC16B001.CFG"}
    assert all("a copy of" in one and "OSC32F001.CFG" in one for one in skipped.values())


def test_records_of_a_stopped_motor_only_age_the_condition(
    few: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    running = read(few / "R0000.CFG")
    silent = replace(
        running, samples=0.0 * running.samples, start_time_ns=running.first_time_ns + 8 * NANOSECONDS_PER_DAY
    )
    stopped = comtrade.write(few / "STOPPED.CFG", silent)
    document = followed(capsys, few, str(few))
    before = followed(capsys, few, str(few / "R*.CFG"))
    (skipped,) = document["skipped"]
    assert (skipped["record"], skipped["operation"]) == (str(stopped), "not-running")
    assert (document["stale"], before["stale"]) == (True, False)
    assert document["as_of"] == before["as_of"]
    assert not followed(capsys, few, str(few), "--stale-after", "9")["stale"]


def test_without_a_usable_record_it_fails_with_the_reasons(
    few: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (few / "BAD.CFG").write_text("nothing of the kind")
    words = ["follow", str(few / "BAD.CFG"), "--motor", str(few / "PUMP.toml"), "--json"]
    assert main(words) == 1
    answer = capsys.readouterr()
    error = json.loads(answer.out)["error"]
    assert error["type"] == "NoUsableRecord"
    assert error["skipped"][0]["record"] == str(few / "BAD.CFG")
    assert "none of 1 records" in answer.err
    (few / "EMPTY").mkdir()
    assert main(["follow", str(few / "EMPTY"), "--motor", str(few / "PUMP.toml")]) == 1
    assert "no recordings in" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "words"), [("gone", "there is no such file or folder"), ("gone-*.CFG", "no file matches")]
)
def test_a_name_that_leads_nowhere_is_told_as_that(
    few: Path, name: str, words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["follow", str(few / name), "--motor", str(few / "PUMP.toml")]) == 1
    assert f"{name}: {words}" in capsys.readouterr().err


def test_events_are_taken_between_the_records_in_their_time(
    few: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    between = rfc3339(BEGUN_NS + HOUR_NS + HOUR_NS // 2)
    document = followed(capsys, few, str(few), "--event", f"{between}=rewound:new winding")
    assert document["events"] == [{"time": between, "kind": "rewound", "reason": "new winding"}]
    assert document["reference"]["records"] == 1


def test_an_event_after_the_latest_record_is_warned_of_and_told(
    few: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    after = rfc3339(BEGUN_NS + 9 * HOUR_NS)
    words = ["follow", str(few), "--motor", str(few / "PUMP.toml"), "--json", "--event"]
    assert main([*words, f"{after}=note:hums"]) == 0
    assert "warning" not in capsys.readouterr().err
    assert main([*words, f"{after}=rewound:new winding"]) == 0
    answer = capsys.readouterr()
    assert "warning: there is no record after the latest event" in answer.err
    document = json.loads(answer.out)
    assert document["state"] == "unknown"
    (reason,) = document["reasons"]
    assert "rewound (new winding) of 2026-01-05T" in reason


def test_events_come_from_a_file_too_with_the_motor_as_it_is_then(
    few: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (few / "events.toml").write_text(
        "[[event]]\ntime = 2026-01-05T10:30:00+01:00\n"
        'kind = "parameters-edited"\nreason = "as commissioned"\nmotor = "PUMP-EDITED.toml"\n'
        '[[event]]\ntime = "2026-01-05T09:15:00Z"\nkind = "note"\n'
    )
    shutil.copy(few / "PUMP.toml", few / "PUMP-EDITED.toml")
    document = followed(capsys, few, str(few), "--events", str(few / "events.toml"))
    assert document["motor"] == "PUMP"
    assert [one["kind"] for one in document["events"]] == ["note", "parameters-edited"]
    assert document["events"][1]["time"].startswith("2026-01-05T09:30:00")
    assert document["reference"]["records"] == 3


@pytest.mark.parametrize(
    ("option", "text"),
    [
        ("--event", "yesterday=rewound"),
        ("--event", "2026-01-31T12:00:00Z=polished"),
        ("--event", "2026-01-31T12:00:00Z=parameters-edited:as commissioned"),
        ("--events", "[[event]]\ntime = 2026-01\nkind = 'rewound'\n"),
        ("--events", "[[event]]\ntime = 2026-01-31T12:00:00Z\nkind = 3\n"),
        ("--events", "[[event]]\ntime = 2026-01-31T12:00:00Z\nkind = 'rewound'\nwho = 'me'\n"),
        ("--events", "[[event]]\ntime = 2026-01-31T12:00:00Z\nkind = 'parameters-edited'\n"),
        ("--events", "event = 3\n"),
        ("--events", "[motor]\n"),
        ("--events", "= = ="),
    ],
)
def test_what_is_no_event_is_wrong_use(
    few: Path, option: str, text: str, capsys: pytest.CaptureFixture[str]
) -> None:
    if option == "--events":
        (few / "events.toml").write_text(text)
        text = str(few / "events.toml")
    assert main(["follow", str(few), "--motor", str(few / "PUMP.toml"), option, text, "--json"]) == 2
    error = json.loads(capsys.readouterr().out)["error"]
    assert error["type"] == "EventUnusable"


def test_edited_parameters_need_the_motor_as_it_is_then(
    few: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    event = "2026-01-31T12:00:00Z=parameters-edited"
    assert main(["follow", str(few), "--motor", str(few / "PUMP.toml"), "--event", event]) == 2
    told = " ".join(capsys.readouterr().err.split())
    assert f"--event {event}: expected the motor as it is from then on" in told
    assert 'motor = "MOTOR.toml" in a file for --events' in told


def test_other_motors_of_the_bus_take_part(
    plant: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_motor(tmp_path / "FAN.toml", MEDIUM)
    write_series(tmp_path, MEDIUM, RECORDS)  # the same seed: the same supply
    (tmp_path / "BAD.CFG").write_text("nothing of the kind")
    records = str(plant / "records")
    document = followed(capsys, plant, records, "--neighbour", f"{tmp_path / 'FAN.toml'}={tmp_path}")
    assert document["bus"] == [{"motor": "FAN", "records": RECORDS, "skipped": 1}]
    assert document["reference"]["from_bus"]
    alone = followed(capsys, plant, records)
    assert (alone["bus"], alone["reference"]["from_bus"]) == ([], False)


@pytest.mark.parametrize("word", ["FAN.toml", "=records", "PUMP.toml="])
def test_what_is_no_neighbour_is_wrong_use(few: Path, word: str, capsys: pytest.CaptureFixture[str]) -> None:
    motor = str(few / "PUMP.toml")
    assert main(["follow", str(few), "--motor", motor, "--neighbour", word, "--json"]) == 2
    assert json.loads(capsys.readouterr().out)["error"]["type"] == "NeighbourUnusable"
    assert main(["follow", str(few), "--motor", motor, "--neighbour", f"{motor}={few}"]) == 2
    assert "other names" in capsys.readouterr().err


def test_people_read_state_and_advice_first(few: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["follow", str(few), "--motor", str(few / "PUMP.toml")]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "PUMP: healthy"
    assert lines[1].startswith("Nothing needs to be done")
    assert any(line.startswith("why") for line in lines[2:])
    (row,) = [
        line for line in lines if line.strip().startswith("2026-01-05 09:00:00 UTC") and "healthy" in line
    ]
    assert row.split()[3] == "3"
    assert max(len(line) for line in lines) <= MOST_COLUMNS


def test_names_and_reasons_cannot_play_with_the_terminal(
    few: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (few / "A\x1b[2J\n[red]\udcff.CFG").write_text("\x1b]0;mine\x07")
    document = followed(capsys, few, str(few))
    assert all(character.isprintable() for one in document["skipped"] for character in one["record"])
    assert main(["follow", str(few), "--motor", str(few / "PUMP.toml")]) == 0
    shown = capsys.readouterr().out
    assert "\x1b" not in shown
    assert "[red]" in shown
    unknown = replace(condition_of(REFERENCE, None, BEGUN_NS), motor="\x1b]0;mine\x07")
    print_condition(unknown.as_dict(), [], [("\x1b[2Jname", "\x07reason")])
    shown = capsys.readouterr().out
    assert not {"\x1b", "\x07"} & set(shown)
    assert "unknown" in shown


def test_one_event_in_several_formats_counts_once_in_its_finest(
    few: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before = followed(capsys, few, str(few))
    event = read(few / "R0001.CFG")
    comtrade.write(few / "OSCA.CFG", event, data_format="ASCII", revision=2013)
    comtrade.write(few / "OSC32F.CFG", event, data_format="FLOAT32", revision=2013)
    comtrade.write(few / "WHOLE.CFF", event, data_format="FLOAT32", revision=2013)
    document = followed(capsys, few, str(few))
    assert [one["record"].rpartition("/")[2] for one in document["history"]] == [
        "R0000.CFG",
        "OSC32F.CFG",
        "R0002.CFG",
    ]
    reasons = {one["record"].rpartition("/")[2]: one["reason"] for one in document["skipped"]}
    assert set(reasons) == {"R0001.CFG", "OSCA.CFG", "WHOLE.CFF"}
    assert all("OSC32F.CFG: the same event" in reason for reason in reasons.values())
    assert document["reference"]["records"] == before["reference"]["records"]
    assert document["mu_f"] == pytest.approx(before["mu_f"], abs=1e-4)


def test_records_of_one_time_that_differ_are_two_events(
    few: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    event = read(few / "R0001.CFG")
    other = replace(event, samples=1.01 * event.samples)
    comtrade.write(few / "R0009.CFG", other, data_format="FLOAT32", revision=2013)
    document = followed(capsys, few, str(few))
    assert len(document["history"]) == 4
    assert document["skipped"] == []
