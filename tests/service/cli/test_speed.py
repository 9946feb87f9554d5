"""mcc speed: speeds of recordings, bars that they teach, and the file that keeps them."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from core.machines.motor_file.writer import write_motor
from core.recordings import comtrade
from service.cli import main
from tests.core.findings.test_seen_speed import BARS, HEALTHY, known, with_lines


@pytest.fixture(scope="module")
def record(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A recording of a second in which slot lines are seen."""
    recording, _ = with_lines(HEALTHY, 1.0)
    fine = tuple(
        replace(channel, full_scale=2.0 * float(np.abs(x).max()))
        for channel, x in zip(recording.channels, recording.samples, strict=True)
    )
    return comtrade.write(tmp_path_factory.mktemp("speed") / "FAN.CFG", replace(recording, channels=fine))


def test_given_bars_show_the_speed(record: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    motor = write_motor(tmp_path / "fan.toml", known())
    assert main(["speed", str(record), "--motor", str(motor), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["motor"], found["rotor_bars"], found["possible_bars"]) == ("fan", BARS, [BARS])
    [told] = found["records"]
    assert (told["record"], told["state"], told["source"]) == ("FAN.CFG", "seen", "current")
    assert main(["speed", str(record), "--motor", str(motor)]) == 0
    shown = capsys.readouterr().out
    assert "seen in the current" in shown
    assert "28, given" in shown


def test_what_recordings_teach_is_kept(
    record: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    motor, lines = write_motor(tmp_path / "fan.toml", known(bars=None)), tmp_path / "lines.json"
    command = ["speed", str(record), "--motor", str(motor), "--lines", str(lines), "--json"]
    assert main(command) == 0
    first = json.loads(capsys.readouterr().out)
    assert first["records"][0]["state"] == "alternatives"
    assert BARS in first["possible_bars"]
    assert main(command) == 0
    capsys.readouterr()
    assert len(json.loads(lines.read_text("utf-8"))["evidence"]) == 2


def test_another_file_of_lines_is_refused(
    record: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    motor, lines = write_motor(tmp_path / "fan.toml", known()), tmp_path / "lines.json"
    lines.write_text("{}", "utf-8")
    assert main(["speed", str(record), "--motor", str(motor), "--lines", str(lines)]) == 1
    assert "mcc speed --lines" in " ".join(capsys.readouterr().err.split())
    assert lines.read_text("utf-8") == "{}"
