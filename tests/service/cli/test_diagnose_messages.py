"""What `mcc diagnose` and `mcc follow` say of files as relays write them, and what to do about them."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from core.machines.motor_file.writer import write_motor
from core.recordings import Channel, Quantity, Recording, comtrade
from service.cli import main
from service.jobs.task import Diagnosed, DiagnosisTask
from service.jobs.worker import diagnose_recording
from service.recording_store.recording import LocalFile
from testing.machines.motors import REFERENCE
from testing.machines.phase_circuits import recording, running

Edit = Callable[[str], str]


def sound() -> Recording:
    """A running motor with a spare input beside its currents and voltages."""
    record = recording(running(REFERENCE, 0.6), noise=0.002, seconds=0.3)
    spare = Channel("SPARE", Quantity.OTHER, None, "A", 1.0)
    channels = [
        replace(channel, full_scale=2.0 * float(np.abs(x).max()))
        for channel, x in zip(record.channels, record.samples, strict=True)
    ]
    return replace(
        record, samples=np.vstack([record.samples, record.samples[:1]]), channels=(*channels, spare)
    )


def constant_spare(text: str) -> str:
    lines = text.split("\r\n")
    k = next(k for k, line in enumerate(lines) if ",SPARE," in line)
    fields = lines[k].split(",")
    lines[k] = ",".join([*fields[:5], "0", "0", "0", "0", "0", "0", "0", "S"])
    return "\r\n".join(lines)


def of_the_year_2000(text: str) -> str:
    first, rest = text.split("\r\n", 1)
    return ",".join([*first.split(",")[:2], "2000"]) + "\r\n" + rest


@pytest.fixture
def relay(tmp_path: Path) -> Callable[..., Path]:
    """Writes a recording as a relay of such a configuration would; the motor's file lies beside it."""
    write_motor(tmp_path / "motor.toml", REFERENCE)

    def write(name: str, *edits: Edit, record: Recording | None = None) -> Path:
        path = comtrade.write(tmp_path / f"{name}.CFG", record or sound(), revision=1999)
        text = path.read_bytes().decode()
        for edit in edits:
            text = edit(text)
        path.write_bytes(text.encode())
        return path

    return write


def diagnosed(capsys: pytest.CaptureFixture[str], path: Path, *options: str) -> dict[str, Any]:
    assert main(["diagnose", str(path), "--json", *options]) == 0
    found: dict[str, Any] = json.loads(capsys.readouterr().out)
    return found


def failure(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    assert main(["diagnose", *words]) == 1
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    return said


def test_departures_that_change_no_value_are_warnings_beside_the_same_verdict(
    relay: Callable[..., Path], capsys: pytest.CaptureFixture[str]
) -> None:
    plain = diagnosed(capsys, relay("PLAIN"))
    path = relay("ODD", constant_spare, of_the_year_2000)
    odd = diagnosed(capsys, path)
    assert (odd["verdict"], odd["mu_f"]) == (plain["verdict"], plain["mu_f"])
    assert odd["verdict"] == "healthy"
    warnings = [one for one in odd["quality"] if one["name"] == "file"]
    assert [one["passed"] for one in warnings] == [True, True]
    assert "found '2000': read as the edition of 1999" in warnings[0]["message"]
    assert "constant: 'SPARE' (0 A)" in warnings[1]["message"]
    assert not [one for one in plain["quality"] if one["message"]]
    assert main(["diagnose", str(path)]) == 0
    assert "constant: 'SPARE' (0 A)" in capsys.readouterr().out
    # The service reads the same way, and keeps the warnings with the diagnosis.
    outcome = diagnose_recording(DiagnosisTask(LocalFile(path), REFERENCE, "hcpa", "split-winding"))
    assert isinstance(outcome, Diagnosed)
    assert [finding.message for finding in outcome.findings.diagnosis.quality if finding.is_warning] == [
        one["message"] for one in warnings
    ]


def test_without_voltages_the_option_is_named(
    relay: Callable[..., Path], capsys: pytest.CaptureFixture[str]
) -> None:
    whole = sound()
    currents = replace(whole, samples=whole.samples[:3], channels=whole.channels[:3])
    one_voltage = replace(whole, samples=whole.samples[:4], channels=whole.channels[:4])
    for name, record in (("CURRENTS", currents), ("ONE", one_voltage)):
        path = str(relay(name, record=record))
        assert "voltages" in (said := failure(capsys, path))
        assert "--currents-only does without" in said
        assert diagnosed(capsys, Path(path), "--currents-only")["currents_only"]


def test_a_damaged_file_names_the_lenient_reader_where_that_helps(
    relay: Callable[..., Path], capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    path = relay("CUT")
    data = path.with_suffix(".DAT")
    data.write_bytes(data.read_bytes()[:-7])
    said = failure(capsys, str(path))
    assert "--lenient reads it all the same" in said
    assert "2999 samples are read" in said
    assert any("2999 samples" in reason for reason in diagnosed(capsys, path, "--lenient")["reasons"])
    data.write_bytes(b"")
    assert "--lenient" not in failure(capsys, str(path))
    assert "--lenient" not in failure(capsys, str(path), "--lenient")
    assert "--lenient" not in failure(capsys, str(tmp_path / "GONE.CFG"))


def test_commissioning_mends_and_names_the_option_as_well(
    relay: Callable[..., Path], capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    path = relay("CUT")
    data = path.with_suffix(".DAT")
    data.write_bytes(data.read_bytes()[:-7])
    words = ["commission", str(path), "--nameplate", str(tmp_path / "motor.toml")]
    words += ["--output", str(tmp_path / "found.toml")]
    assert main(words) == 1
    assert "--lenient reads it all the same" in capsys.readouterr().err
    assert main([*words, "--lenient"]) == 1
    mended, why = capsys.readouterr().err.splitlines()
    assert "2999 samples are read" in mended
    assert "a motor already running" in why


def test_a_record_of_unknown_time_is_diagnosed_but_put_into_no_course(
    relay: Callable[..., Path], capsys: pytest.CaptureFixture[str]
) -> None:
    def undated(text: str) -> str:
        lines = text.split("\r\n")
        return "\r\n".join("31/02/2024,06:30:00.0" if line.count("/") == 2 else line for line in lines)

    path = relay("UNDATED", undated)
    assert "the time is unknown" in failure(capsys, str(path))
    found = diagnosed(capsys, path, "--lenient")
    assert found["verdict"] == "healthy"
    assert any("the time is unknown" in reason for reason in found["reasons"])
    motor = str(path.with_name("motor.toml"))
    dated = relay("DATED")
    assert main(["follow", str(path), str(dated), "--motor", motor, "--lenient", "--json"]) == 0
    followed = json.loads(capsys.readouterr().out)
    assert [Path(one["record"]).name for one in followed["history"]] == ["DATED.CFG"]
    (skipped,) = followed["skipped"]
    assert "none that can be read: it has no place among the others" in skipped["reason"]
    assert main(["follow", str(path), str(dated), "--motor", motor, "--json"]) == 0
    (skipped,) = json.loads(capsys.readouterr().out)["skipped"]
    assert "--lenient reads it all the same" in skipped["reason"]
