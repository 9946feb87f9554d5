"""How `mcc diagnose` prints a verdict, and what a baseline does for it."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from core.diagnosis.causes import Cause
from core.diagnosis.verdict import Hypothesis
from core.machines.motor_file.writer import write_motor
from core.machines.parameters import ParametersSource
from core.quality.finding import QualityFinding
from core.recordings import comtrade
from service.cli import main
from service.cli.output import results
from service.cli.recordings.diagnose import _table
from testing.machines.cause_records import CauseCase
from testing.machines.motors import MEDIUM, REFERENCE
from testing.machines.phase_circuits import Fault, recording, running
from testing.service.findings import findings_of
from testing.service.plants import fault, undiagnosable
from testing.service.rotor_and_supply import SHORT_RECORD

CLIPPED = "IA reads its full scale in 12 samples"


def test_what_keeps_a_record_from_being_diagnosed_is_said_once(capsys: pytest.CaptureFixture[str]) -> None:
    diagnosis = replace(
        undiagnosable(),
        reasons=(CLIPPED,),
        quality=(
            QualityFinding("clipping", 12.0, 0.0, "1", passed=False, message=CLIPPED),
            QualityFinding("duration", 1.0, 0.2, "s", passed=True, message="long enough"),
        ),
    )
    examined = findings_of(diagnosis, rotor=SHORT_RECORD)
    results().print(_table(Path("HR_1.CFG"), Path("motor.toml"), ParametersSource.GIVEN, examined))
    shown = capsys.readouterr().out
    assert shown.count(CLIPPED) == 1
    assert "motor.toml" in shown
    (passed,) = [line for line in shown.splitlines() if "checks passed" in line]
    assert passed.split()[-2] == "1"


@pytest.mark.parametrize(
    ("probabilities", "words"),
    [((0.01, 0.97, 0.02), "b"), ((0.717, 0.003, 0.28), "a (72 %) or c (28 %)"), (None, None)],
)
def test_the_phase_is_told_alone_or_with_the_other_likely_one(
    capsys: pytest.CaptureFixture[str], probabilities: tuple[float, float, float] | None, words: str | None
) -> None:
    turns = Hypothesis(Cause.SHORTED_TURNS, 0.99, 30.0, "equivalent level 5.1%")
    diagnosis = replace(fault(), theta_f=None, phase_probabilities=probabilities, hypotheses=(turns,))
    examined = findings_of(diagnosis, rotor=SHORT_RECORD)
    results().print(_table(Path("HR_1.CFG"), Path("motor.toml"), ParametersSource.GIVEN, examined))
    lines = capsys.readouterr().out.splitlines()
    told = [line.split("│")[2].strip() for line in lines if line.startswith("│ phase ")]
    assert told == ([] if words is None else [words])


@pytest.fixture
def pump(tmp_path: Path) -> Callable[..., Path]:
    """Writes recordings of one motor whose relay reads phase b 3 % high, and its motor file beside them."""
    write_motor(tmp_path / "motor.toml", REFERENCE)

    def write(name: str, load_level: float, *, fault: Fault | None = None) -> Path:
        operation = running(REFERENCE, load_level, fault=fault)
        record = recording(
            operation, noise=0.002, current_gains=(1.0, 1.03, 1.0), seed=round(100 * load_level)
        )
        channels = tuple(
            replace(channel, full_scale=2.0 * float(np.abs(x).max()))
            for channel, x in zip(record.channels, record.samples, strict=True)
        )
        return comtrade.write(tmp_path / f"{name}.CFG", replace(record, channels=channels))

    return write


def test_healthy_recordings_take_off_what_the_relay_makes_up(
    pump: Callable[..., Path], capsys: pytest.CaptureFixture[str]
) -> None:
    healthy = [pump(f"OK{k}", load_level) for k, load_level in enumerate((0.3, 0.5, 0.7, 0.9))]
    baseline = [word for path in healthy[:3] for word in ("--baseline", str(path))]
    faulty = pump("ILL", 0.6, fault=Fault(0.04, 1))

    def diagnosed(path: Path, *options: str) -> dict[str, Any]:
        assert main(["diagnose", str(path), "--json", *options]) == 0
        found: dict[str, Any] = json.loads(capsys.readouterr().out)
        return found

    alone, relative = diagnosed(faulty), diagnosed(faulty, *baseline)
    assert relative["mu_f"] == pytest.approx(0.04, rel=0.1)
    assert relative["mu_f_ci95"][0] < 0.04 < relative["mu_f_ci95"][1]
    assert np.diff(relative["mu_f_ci95"]) < 0.9 * np.diff(alone["mu_f_ci95"])
    assert (relative["verdict"], relative["phase"]) == ("fault", "b")
    assert "relative to a baseline of 3 healthy recordings" in relative["reasons"]
    sound = diagnosed(healthy[3], *baseline)
    assert sound["verdict"] == "healthy"
    assert sound["mu_f"] < 0.5 * diagnosed(healthy[3])["mu_f"]
    assert relative["detection_limit"] < alone["detection_limit"]


def test_two_recordings_are_no_baseline(
    pump: Callable[..., Path], capsys: pytest.CaptureFixture[str]
) -> None:
    paths = [str(pump(f"OK{k}", 0.5)) for k in range(3)]
    words = ["--baseline", paths[1], "--baseline", paths[2], "--json"]
    assert main(["diagnose", paths[0], *words]) == 2
    assert "at least 3 healthy recordings, found 2" in json.loads(capsys.readouterr().out)["error"]["message"]


@pytest.mark.parametrize(
    ("cause", "line"),
    [(Cause.ECCENTRICITY, "air gap permeance ripples by 6"), (Cause.PULSATION, "load torque swings by ")],
)
def test_air_gap_and_load_are_told_where_they_stand_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], cause: Cause, line: str
) -> None:
    case = CauseCase(MEDIUM, frozenset({cause}), 0.7, 42)
    write_motor(tmp_path / "motor.toml", case.known())
    record = case.record()
    channels = tuple(
        replace(channel, full_scale=2.0 * float(np.abs(x).max()))
        for channel, x in zip(record.channels, record.samples, strict=True)
    )
    path = comtrade.write(tmp_path / "ILL.CFG", replace(record, channels=channels))
    assert main(["diagnose", str(path)]) == 0
    shown = " ".join(capsys.readouterr().out.translate({0x2502: " "}).split())
    assert line in shown
    assert main(["diagnose", str(path), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["eccentricity"]["permeance_ripple"] is not None
    assert found["pulsation"]["load_torque"] is not None
    both = ("air gap permeance", "load torque swings")
    assert [one in shown for one in both] == [one in line for one in both], shown


@pytest.mark.parametrize("fault", [None, Fault(0.06, 1)])
def test_a_nameplate_alone_asks_to_be_commissioned_and_calls_nothing_a_fault(
    pump: Callable[..., Path], capsys: pytest.CaptureFixture[str], fault: Fault | None
) -> None:
    record = pump("PUMP", 0.6, fault=fault)
    motor = record.with_name("motor.toml")
    motor.write_text(motor.read_text("utf-8").partition("[parameters]")[0], "utf-8")
    assert main(["diagnose", str(record), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["parameters_source"] == "typical"
    assert any(reason.startswith("collecting; commission me") for reason in found["reasons"])
    low, high = found["mu_f_ci95"]
    if fault is None:
        assert found["verdict"] in ("healthy", "watch")
        assert low == 0.0
    else:
        assert found["verdict"] == "watch"
        assert low <= 0.06 <= high
    assert main(["diagnose", str(record)]) == 0
    assert "typical; collecting; commission me" in capsys.readouterr().out


def test_rotor_and_supply_are_told_beside_the_stator(
    pump: Callable[..., Path], capsys: pytest.CaptureFixture[str]
) -> None:
    record = pump("PUMP", 0.6)
    assert main(["diagnose", str(record), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert set(found["rotor"]) == {
        "state", "lower_sideband_dB", "upper_sideband_dB", "severity_dB", "severity_dB_ci95",
        "detection_limit_dB", "slip", "load_level", "load_bin", "duration_s", "load_oscillation_dB",
        "reasons",
    }  # fmt: skip
    assert found["rotor"]["state"] == "healthy"
    assert found["rotor"]["severity_dB"] < found["rotor"]["detection_limit_dB"] < -40.0
    assert set(found["speed"]) == {
        "state", "source", "speed_rpm", "speed_rpm_ci95", "slip", "model_speed_rpm", "rotor_bars", "margin",
        "alternatives", "reasons",
    }  # fmt: skip
    assert (found["speed"]["state"], found["speed"]["source"]) == ("not-seen", "model")
    assert found["speed"]["speed_rpm"] == pytest.approx(found["speed_rpm"])
    assert found["supply"]["line_voltages_V"] == pytest.approx([380.0] * 3, rel=0.01)
    assert found["supply"]["frequency_hz"] == pytest.approx(50.0, abs=0.01)

    assert main(["diagnose", str(record)]) == 0
    shown = capsys.readouterr().out
    assert "detection limit" in shown
    assert "by the model" in shown
    assert "unbalance" in shown
