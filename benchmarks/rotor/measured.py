"""Measured recordings of motors without a recorded fault of the rotor: none of them may be called faulty.

The sets do not belong to the project: their folder is an argument, and nothing but counts is written.
"""

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.accuracy.measured_records import (
    CURRENTS,
    ITSC_FILE,
    ITSC_FOLDER,
    ITSC_MOTOR,
    MILL,
    MILL_FILES,
    MILL_FOLDER,
    MILL_RATE_HZ,
    VOLTAGES,
    itsc_records,
    mill_samples,
)
from benchmarks.reporting import Section, mark, spread, table
from core.findings.examining import examine
from core.machines.parameters import Motor
from core.recordings import Recording, RecordingError, read
from core.rotor.finding import RotorState
from core.rotor.one_phase_finding import examine_one_phase

LENGTHS_S = (10.0, 1.28)
COMTRADE_FOLDER, COMTRADE_SUFFIXES = "comtrade", {".cfg", ".cff"}
STATES = (RotorState.FAULT, RotorState.WATCH, RotorState.HEALTHY, RotorState.UNSUPPORTED)


@dataclass(frozen=True, slots=True)
class Measured:
    """A record and its motor; with the speed by an encoder [rpm], its first current alone is examined."""

    recording: Recording
    motor: Motor
    currents_only: bool = False
    speed_rpm: float | None = None


@dataclass(frozen=True, slots=True)
class Told:
    """What a record tells; the state is None where it lacks channels that are needed."""

    state: RotorState | None
    severity_dB: float | None = None


def sections(folder: Path, pool: Executor) -> list[Section]:
    """The table by set."""
    rows, faults = [], 0
    for name, records in _sets(folder):
        found = list(spread(told, records, name, pool))
        faults += sum(one.state is RotorState.FAULT for one in found)
        rows.append([name, f"{len(found)}", *_counts(found)])
    lines = (
        "Motors of which no fault of the rotor is recorded. The mill's load changes as it cuts, and in "
        "1.28 s its slip of 1 % is hardly told. Of the set of shorted turns the currents alone were "
        "recorded, without load, and nothing but the line of the supply is left in them. The COMTRADE files "
        "are those of four readers, most of them no motor's.",
        "",
        *table(
            ["set", "records", "fault", "watch", "healthy", "unsupported", "channels lacking", "severity"],
            rows,
        ),
        "",
        f"Faults in all: {faults}; goal none: {mark(faults == 0)}.",
    )
    return [Section("measured", "Measured records", "python -m benchmarks.rotor --data FOLDER", lines)]


def told(measured: Measured) -> Told:
    """Examine one record."""
    motor, recording = measured.motor, measured.recording
    if measured.speed_rpm is not None:
        frequency_hz = motor.nameplate.rated_frequency_Hz
        slip = 1.0 - motor.nameplate.pole_pairs * measured.speed_rpm / (60.0 * frequency_hz)
        alone = examine_one_phase(recording.samples[0], recording.sample_rate_hz, slip, frequency_hz)
        return Told(alone.state)
    try:
        rotor = examine(recording, motor, currents_only=measured.currents_only).rotor
    except RecordingError:
        return Told(None)
    return Told(rotor.state, rotor.severity_dB)


def _sets(folder: Path) -> Iterator[tuple[str, list[Measured]]]:
    if (folder / MILL_FOLDER).is_dir():
        runs = [mill_samples(folder / MILL_FOLDER / name) for name in MILL_FILES]
        for length_s in LENGTHS_S:
            windows = [one for samples, rpm in runs for one in _windows(samples, rpm, length_s)]
            yield f"mill, {length_s:g} s", [Measured(recording, MILL) for recording, _ in windows]
            yield (
                f"mill, {length_s:g} s, one phase and the encoder's speed",
                [Measured(recording, MILL, speed_rpm=speed) for recording, speed in windows],
            )
    if (folder / ITSC_FOLDER).is_dir():
        records = itsc_records(folder / ITSC_FOLDER / ITSC_FILE)
        yield (
            "shorted turns, currents only",
            [Measured(one, ITSC_MOTOR, currents_only=True) for many in records.values() for one in many],
        )
    if (folder / COMTRADE_FOLDER).is_dir():
        yield "COMTRADE files", [Measured(one, MILL) for one in _comtrade(folder / COMTRADE_FOLDER)]


def _windows(
    samples: np.ndarray[tuple[int, int], np.dtype[np.float64]],
    rpm: np.ndarray[tuple[int], np.dtype[np.float64]],
    length_s: float,
) -> Iterator[tuple[Recording, float]]:
    """Yield windows one after the other, with the mean speed in each."""
    length = round(length_s * MILL_RATE_HZ)
    for first in range(0, samples.shape[1] - length + 1, length):
        part = slice(first, first + length)
        recording = Recording(samples[:, part], MILL_RATE_HZ, 0, CURRENTS + VOLTAGES)
        yield recording, float(np.nanmean(rpm[part]))


def _comtrade(folder: Path) -> Iterator[Recording]:
    for path in sorted(folder.rglob("*")):
        if path.suffix.lower() in COMTRADE_SUFFIXES:
            try:
                yield read(path, lenient=True)
            except RecordingError:
                continue


def _counts(found: Sequence[Told]) -> list[str]:
    counts = [sum(one.state is state for one in found) for state in (*STATES, None)]
    levels = [one.severity_dB for one in found if one.severity_dB is not None]
    return [*map(str, counts), f"{min(levels):.1f} to {max(levels):.1f} dB" if levels else ""]
