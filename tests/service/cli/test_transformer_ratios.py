"""Recordings of secondary values, told so or not: the ratio that explains them is named, and then used."""

import json
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pytest

from core.commissioning.errors import CommissioningError
from core.commissioning.start_detection import start_of
from core.machines.motor_file.reader import read_motor
from core.machines.motor_file.writer import write_motor
from core.machines.parameters import ChannelNames, Motor, Nameplate, ParametersSource, Transformers
from core.machines.typical import typical_parameters
from core.recordings import Recording, comtrade
from service.cli import main
from testing.machines.phase_circuits import recording, running
from testing.machines.starts import StartRecord

EXAMPLES = Path(__file__).parents[3] / "examples"
PUMP = read_motor(EXAMPLES / "pump_3300V.toml")
VOLTAGE_RATIO, CURRENT_RATIO = 30.0, 20.0
"""3300:110 and 100:5."""


def of(motor: Motor, currents: float = 1.0, voltages: float = 1.0) -> Recording:
    """A running motor, its values divided by the ratios."""
    record = recording(running(motor, 0.6), noise=0.001, seconds=0.3)
    divided = record.samples / np.repeat([currents, voltages], 3)[:, np.newaxis]
    channels = tuple(
        replace(channel, full_scale=2.5 * float(np.abs(x).max()))
        for channel, x in zip(record.channels, divided, strict=True)
    )
    return replace(record, samples=divided, channels=channels)


Write = Callable[..., Path]


@pytest.fixture
def written(tmp_path: Path) -> Write:
    """Writes a record whose configuration ends each channel's line as told, (current, voltage)."""

    def write(record: Recording, *ends: str, revision: Literal[1991, 1999, 2013] = 1999) -> Path:
        path = comtrade.write(tmp_path / "RECORD.CFG", record, revision=revision)
        lines = path.read_bytes().decode().split("\r\n")
        for k in range(2, 8) if ends else ():
            lines[k] = ",".join([*lines[k].split(",")[:10], ends[(k - 2) // 3]])
        path.write_bytes("\r\n".join(lines).encode())
        return path

    return write


def diagnosed(
    capsys: pytest.CaptureFixture[str],
    path: Path,
    motor: Motor,
    transformers: Transformers | None = None,
) -> dict[str, Any]:
    told = replace(motor, transformers=transformers or Transformers())
    file = write_motor(path.with_name("motor.toml"), told)
    assert main(["diagnose", str(path), "--motor", str(file), "--json"]) == 0
    found: dict[str, Any] = json.loads(capsys.readouterr().out)
    return found


SECONDARY = of(PUMP, CURRENT_RATIO, VOLTAGE_RATIO)
LOAD = 0.6


def test_secondary_values_of_a_file_that_says_so(written: Write, capsys: pytest.CaptureFixture[str]) -> None:
    found = diagnosed(capsys, written(SECONDARY, "100,5,S", "3300,110,S"), PUMP)
    assert found["verdict"] == "healthy"
    assert found["load_level"] == pytest.approx(LOAD, abs=0.01)


@dataclass(frozen=True)
class Case:
    """A record and the ends of its channels' lines; what is said of them, None for not a word."""

    record: Recording
    ends: tuple[str, ...]
    voltage: str | None
    current: str | None
    right: Transformers
    revision: Literal[1991, 1999] = 1999


UNNAMED = (
    "secondary volts, of transformers of about 3300:110: voltage_ratio = about 30 in",
    "such as 20 (100:5)",
    Transformers(30.0, 20.0),
)
CASES = {
    "P and 1:1, secondary": Case(SECONDARY, ("1,1,P", "1,1,P"), *UNNAMED),
    "S and 1:1, secondary": Case(SECONDARY, ("1,1,S", "1,1,S"), *UNNAMED),
    "1991, secondary": Case(SECONDARY, (), *UNNAMED, 1991),
    "P and the ratio, secondary": Case(
        SECONDARY, ("100,5,P", "3300,110,P"), "voltage_ratio = 30 in", "current_ratio = 20 in",
        Transformers(30.0, 20.0),
    ),
    "S and the ratio, primary": Case(
        of(PUMP), ("100,5,S", "3300,110,S"), "voltage_ratio = 1 in", "current_ratio = 1 in",
        Transformers(1.0, 1.0),
    ),
    "voltages alone": Case(
        of(PUMP, 1.0, VOLTAGE_RATIO), ("100,5,P", "3300,110,P"), "voltage_ratio = 30 in", None,
        Transformers(voltage_ratio=30.0),
    ),
    "currents alone": Case(
        of(PUMP, CURRENT_RATIO), ("100,5,P", "3300,110,P"), None, "current_ratio = 20 in",
        Transformers(current_ratio=20.0),
    ),
    "S and a small ratio, primary": Case(
        of(PUMP), ("60,10,S", "3300,3300,P"), None, "multiplied by a ratio of 6:1, but are primary",
        Transformers(current_ratio=1.0),
    ),
    "kilovolts called volts": Case(
        of(PUMP, 1.0, 1000.0), ("1,1,P", "1,1,P"), "voltage_ratio = 1000 in", None,
        Transformers(voltage_ratio=1000.0),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_the_ratio_that_explains_the_values_is_named_and_makes_the_diagnosis(
    name: str, written: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    case = CASES[name]
    path = written(case.record, *case.ends, revision=case.revision)
    refused = diagnosed(capsys, path, PUMP)
    assert refused["verdict"] == "undiagnosable"
    reasons = " | ".join(refused["reasons"])
    for word, key in ((case.voltage, "voltage_ratio"), (case.current, "current_ratio")):
        assert (key in reasons) is (word is not None), reasons
        assert word is None or word in reasons, reasons
    found = diagnosed(capsys, path, PUMP, case.right)
    assert found["verdict"] == "healthy"
    assert found["load_level"] == pytest.approx(LOAD, abs=0.01)


def test_a_load_that_no_motor_bears_is_not_healthy_but_a_ratio(
    written: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    """Three times the currents are those of another load, as far as the equations go."""
    path = written(of(PUMP), "60,20,S", "3300,3300,P")
    found = diagnosed(capsys, path, PUMP)
    assert found["verdict"] == "watch"
    assert (
        "is more than a motor bears for long: they were multiplied by a ratio of 3:1" in found["reasons"][0]
    )
    assert "current_ratio = 1 in" in found["reasons"][0]
    small = diagnosed(capsys, written(of(PUMP), "20,60,S", "3300,3300,P"), PUMP)
    assert small["verdict"] == "watch"
    # Capacitors behind the relay and less load look the same: both are named.
    assert small["reasons"][1].startswith("capacitors of")
    assert "current_ratio = 1 in" in small["reasons"][1]


def test_secondary_values_of_a_high_voltage_are_no_motor_that_stands(
    written: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    """Secondary volts and amperes of a large motor are less than 1 % of rated, as of one that is off."""
    mill = read_motor(EXAMPLES / "mill_11kV.toml")
    mill = replace(mill, nameplate=replace(mill.nameplate, rated_voltage_V=13_800.0))
    path = written(of(mill, 400.0, 13_800 / 110), "1,1,P", "1,1,P")
    (first, *_) = diagnosed(capsys, path, mill)["reasons"]
    assert "13800:110: voltage_ratio = about 125.5 in" in first
    found = diagnosed(capsys, path, mill, Transformers(13_800 / 110, 400.0))
    assert found["verdict"] == "healthy"


def test_a_power_in_kW_is_asked_about_before_a_ratio_is_named(
    written: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    """The currents of 37 kW are 1000 times those of 37 W; a ratio that hides it would be wrong for good."""
    plate = Nameplate(rated_power_W=37e3, rated_voltage_V=400.0, rated_frequency_Hz=50.0, pole_pairs=2)
    in_kW = replace(plate, rated_power_W=37.0)
    motor, wrong = (
        Motor("FAN", each, typical_parameters(each).parameters, parameters_source=ParametersSource.TYPICAL)
        for each in (plate, in_kW)
    )
    (reason, *_) = diagnosed(capsys, written(of(motor)), wrong)["reasons"]
    asked, _, otherwise = reason.partition("; if it is right, ")
    assert "is rated_power_W of [nameplate] in kW?" in asked
    assert "current_ratio" not in asked
    assert "current_ratio" in otherwise
    record = StartRecord(duration_s=0.4, snr_db=60.0).of(motor)
    with pytest.raises(CommissioningError, match=r"is rated_power_W of \[nameplate\] in kW\?.*current_ratio"):
        start_of(record, in_kW, ChannelNames())


def test_commissioning_names_the_ratios_and_takes_them() -> None:
    record = StartRecord(duration_s=0.4, snr_db=60.0).of(PUMP)
    start = start_of(record, PUMP.nameplate, ChannelNames())
    ratios = np.repeat([CURRENT_RATIO, VOLTAGE_RATIO], 3)[:, np.newaxis]
    named = [
        replace(c, transformer_ratio=r, full_scale=None)
        for c, r in zip(record.channels, ratios.ravel().tolist(), strict=True)
    ]
    secondary = replace(record, samples=record.samples / ratios, channels=tuple(named))
    with pytest.raises(CommissioningError, match="current_ratio = 20 in"):
        start_of(secondary, PUMP.nameplate, ChannelNames())
    with pytest.raises(CommissioningError, match="voltage_ratio = 30 in"):
        start_of(secondary, PUMP.nameplate, ChannelNames(), transformers=Transformers(current_ratio=20.0))
    again = start_of(secondary, PUMP.nameplate, ChannelNames(), transformers=Transformers(30.0, 20.0))
    np.testing.assert_allclose(again.current_ab, start.current_ab, atol=1e-9 * np.abs(start.current_ab).max())
