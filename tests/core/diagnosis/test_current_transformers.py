"""Two current transformers, and others than in the motor's line: the same verdict, with a warning."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from core.diagnosis.verdict import Verdict
from core.findings.examining import examine
from core.machines.motor_file.error import MotorFileError
from core.machines.motor_file.reader import read_motor
from core.machines.motor_file.writer import write_motor
from core.machines.parameters import CurrentPosition, Motor, Transformers
from core.recordings import Recording
from testing.machines.motors import LARGE, MEDIUM
from testing.machines.phase_circuits import Fault, recording, running


def warned(found: Recording, motor: Motor) -> tuple[float, list[str]]:
    """Equivalent level, and what is said of the current transformers."""
    diagnosis = examine(found, motor).diagnosis
    assert diagnosis.verdict is Verdict.FAULT
    said = [one.message for one in diagnosis.quality if one.name == "current transformers"]
    assert all(one.passed for one in diagnosis.quality)
    if motor.transformers.inside_delta or len(found.channels) == 5:
        assert not any(one.name.startswith("current sum") for one in diagnosis.quality)
    assert diagnosis.mu_f is not None
    return diagnosis.mu_f, said


def placed(motor: Motor, position: CurrentPosition) -> Motor:
    return replace(motor, transformers=Transformers(current_position=position))


def test_two_current_transformers_find_the_same_fault() -> None:
    record = recording(running(MEDIUM, 0.5, fault=Fault(0.05, 1)))
    kept = [k for k, channel in enumerate(record.channels) if channel.name != "IB"]
    two = replace(record, samples=record.samples[kept], channels=tuple(record.channels[k] for k in kept))
    level, said = warned(record, MEDIUM)
    assert said == []
    level_of_two, (warning,) = warned(two, MEDIUM)
    assert level_of_two == pytest.approx(level, rel=1e-6)
    assert "phase b has no current transformer: its current is minus the sum of the other two" in warning
    assert "(I0)" in warning


def test_transformers_inside_the_delta_find_the_same_fault() -> None:
    """Of each winding's current the part that is common to all is not known; it cancels out in the lines."""
    record = recording(running(LARGE, 0.5, fault=Fault(0.05, 1)))
    lines = record.samples[:3]
    windings = (lines - np.roll(lines, -1, axis=0)) / 3.0 + 0.1 * lines[:1]
    inside = replace(record, samples=np.vstack([windings, record.samples[3:]]))
    level, _ = warned(record, LARGE)
    found, (warning,) = warned(inside, placed(LARGE, CurrentPosition.INSIDE_DELTA))
    assert found == pytest.approx(level, rel=1e-6)
    assert warning.startswith("inside the delta: ")


def test_transformers_before_the_capacitors_are_warned_of() -> None:
    record = recording(running(MEDIUM, 0.5, fault=Fault(0.05, 1)))
    _, (warning,) = warned(record, placed(MEDIUM, CurrentPosition.BEFORE_CAPACITORS))
    assert warning.startswith("before the capacitors: ")


def test_the_motor_file_says_where_they_sit(tmp_path: Path) -> None:
    path = write_motor(tmp_path / "motor.toml", placed(LARGE, CurrentPosition.INSIDE_DELTA))
    assert read_motor(path).transformers.inside_delta
    path.write_text(path.read_text().replace('connection = "delta"', 'connection = "star"'))
    with pytest.raises(MotorFileError, match=r"current_position.*for a motor in star.*inside-delta"):
        read_motor(path)
    path.write_text(path.read_text().replace('"inside-delta"', '"behind"'))
    with pytest.raises(MotorFileError, match="current_position"):
        read_motor(path)
