"""The record that the commands are timed with."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from core.machines.motor_file.writer import write_motor
from core.recordings import comtrade
from testing.machines.motors import REFERENCE
from testing.machines.phase_circuits import Fault, recording, running

SECONDS = 0.5


def write_record(folder: Path) -> Path:
    """Write 0.5 s at 10 kHz of a motor with shorted turns, and its motor file beside it."""
    write_motor(folder / "motor.toml", REFERENCE)
    record = recording(running(REFERENCE, 0.5, fault=Fault(0.05, 1)), seconds=SECONDS, noise=0.005)
    channels = tuple(
        replace(channel, full_scale=2.0 * float(np.abs(samples).max()))
        for channel, samples in zip(record.channels, record.samples, strict=True)
    )
    return comtrade.write(folder / "HR_1.CFG", replace(record, channels=channels))
