"""`mcc rotor`: one phase's current from a file, with the speed."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from core.recordings import comtrade
from service.cli.app import main
from testing.machines.motors import REFERENCE
from testing.machines.rotor_records import RotorCase, one_phase

RATE_HZ = 5_000.0
STEP_A = 0.04
LOAD = RotorCase(REFERENCE, load_level=0.9)
SPEED = ("--speed-rpm", f"{1_500.0 * (1.0 - LOAD.slip()):.0f}")


def written(path: Path, broken_share: float) -> Path:
    """A second of phase a in steps of 40 mA with a spike, as one column."""
    case = replace(LOAD, broken_share=broken_share)
    current = STEP_A * np.round(one_phase(case.record(1.0, RATE_HZ, seed=3)) / STEP_A)
    current[1_700] += 2.0
    np.savetxt(path, current, fmt="%.2f")
    return path


def told(capsys: pytest.CaptureFixture[str], *words: str) -> Any:
    assert main(["rotor", *words, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def test_a_broken_bar_stands_out_from_a_healthy_record(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    healthy, broken = written(tmp_path / "healthy.csv", 0.0), written(tmp_path / "broken.csv", 1.0 / 28.0)
    found = told(capsys, str(broken), *SPEED, "--rate", "5000", "--healthy", str(healthy))
    assert found["state"] == "watch"
    assert found["change_dB_ci95"][0] > 10.0
    assert found["spikes"] == 1
    assert found["pole_pairs"] == 2
    assert any("never more than watch" in reason for reason in found["reasons"])
    beside = told(capsys, str(healthy), *SPEED, "--rate", "5000", "--healthy", str(healthy))
    assert (beside["state"], beside["change_dB"]) == ("healthy", 0.0)


def test_a_table_for_people_says_where_the_sidebands_are(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    broken = written(tmp_path / "broken.csv", 1.0 / 28.0)
    assert main(["rotor", str(broken), *SPEED, "--rate", "5000"]) == 0
    shown = capsys.readouterr().out
    assert "lower sideband" in shown
    assert "as broken bars make it" in shown


def test_a_channel_of_a_comtrade_record_is_chosen_by_name(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    record = replace(LOAD, broken_share=1.0 / 28.0).record(1.0, RATE_HZ)
    path = comtrade.write(tmp_path / "motor.CFG", record, revision=2013, data_format="FLOAT32")
    assert told(capsys, str(path), *SPEED, "--column", record.channels[1].name)["state"] == "watch"
    assert main(["rotor", str(path), *SPEED]) == 2
    assert "--column" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (SPEED, 1, "--rate"),
        (("--speed-rpm", "1500", "--rate", "5000"), 2, "synchronous"),
        ((*SPEED, "--rate", "5000", "--column", "IA"), 2, "found IA"),
    ],
)
def test_what_cannot_be_used_says_what_would_do(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], words: tuple[str, ...], code: int, said: str
) -> None:
    assert main(["rotor", str(written(tmp_path / "a.csv", 0.0)), *words]) == code
    assert said in capsys.readouterr().err


def test_a_speed_too_near_the_synchronous_one_is_unsupported(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = written(tmp_path / "light.csv", 0.0)
    found = told(capsys, str(path), "--speed-rpm", "1490", "--rate", "5000")
    assert (found["state"], found["lower_sideband_dB"]) == ("unsupported", None)
    assert "it takes" in found["reasons"][0]


SECOND = np.arange(RATE_HZ)


def table(path: Path, header: str, times: Any, current: Any) -> Path:
    rows = (f"{t:.6f},{i:.5f}" for t, i in zip(times, current, strict=True))
    path.write_text("\n".join((header, *rows)) + "\n", encoding="utf-8")
    return path


def healthy_current() -> Any:
    return one_phase(LOAD.record(1.0, RATE_HZ, seed=3))


@pytest.mark.parametrize(
    ("header", "step"),
    [("Time,Channel A\n(ms),(A)\n", 1e3), ("t (us),IA", 1e6), ("time_ms,IA", 1e3), ("time,IA", 1.0)],
)
def test_times_count_in_the_unit_that_the_file_names(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], header: str, step: float
) -> None:
    path = table(tmp_path / "scope.csv", header, SECOND * step / RATE_HZ, healthy_current())
    found = told(capsys, str(path), *SPEED)
    assert found["state"] == "healthy"
    assert found["duration_s"] == pytest.approx(1.0, rel=1e-3)


@pytest.mark.parametrize(
    ("header", "times", "words", "said"),
    [
        ("n,IA", SECOND, (), ("--rate", "'n'")),
        ("time,IA", SECOND / RATE_HZ, ("--rate", "49"), ("49 Hz", "50 Hz")),
        ("time,IA", SECOND / RATE_HZ, ("--rate", "100"), ("100 Hz", "50 Hz")),
        ("n,IA", SECOND, ("--rate", "5"), ("5 Hz", "50 Hz", "kHz")),
        ("time,IA", SECOND / RATE_HZ, ("--rate", "4000"), ("5000 Hz", "4000 Hz")),
        ("time,IA", SECOND * 1e3 / RATE_HZ, (), ("5 Hz", "50 Hz", "ms")),
        ("time,IA", SECOND / 50.0, (), ("50 Hz", "rms values")),
    ],
)
def test_a_rate_that_cannot_be_is_refused_with_both_figures(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    header: str,
    times: Any,
    words: tuple[str, ...],
    said: tuple[str, ...],
) -> None:
    path = table(tmp_path / "record.csv", header, times, healthy_current())
    assert main(["rotor", str(path), *SPEED, *words, "--json"]) == 1
    message = json.loads(capsys.readouterr().out)["error"]["message"]
    assert all(figure in message for figure in said), message


def test_rms_values_are_no_current(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rms = 7.0 + 0.1 * np.sin(2.0 * np.pi * 4.0 * SECOND / RATE_HZ)
    path = table(tmp_path / "rms.csv", "time,IA", SECOND / RATE_HZ, rms)
    found = told(capsys, str(path), *SPEED)
    assert found["state"] == "unsupported"
    assert "rms values" in found["reasons"][0]


def test_another_frequency_than_the_rated_one_is_no_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wave = np.sin(2.0 * np.pi * 16.0 * SECOND / RATE_HZ)
    path = table(tmp_path / "slow.csv", "time,IA", SECOND / RATE_HZ, wave)
    found = told(capsys, str(path), *SPEED)
    assert (found["state"], found["lower_sideband_dB"]) == ("unsupported", None)
    assert "no line near 50 Hz" in found["reasons"][0]
