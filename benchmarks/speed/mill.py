"""The mill's recordings with its encoder, cut into windows, and the encoder without its glitches."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.ndimage import median_filter

from benchmarks.accuracy.measured_records import MILL_FOLDER, MILL_RATE_HZ, Array, mill_samples
from core.signals.clarke import clarke
from core.signals.decimation import TAPS_PER_FACTOR, decimate

COUNTS_A_MINUTE = 60.0 * 48e6 * 8.0 / 1_800.0
"""Speed [rpm] times the counts of a period of the encoder."""
MEDIAN_SAMPLES, GLITCH_COUNTS = 41, 35.0
"""A period that is so far from the median around it is a glitch. The median is much shorter than a turn,
whose own pattern is no glitch."""


@dataclass(frozen=True, slots=True)
class Run:
    """One recording: currents and voltages, (6, n) [A, V], and the encoder's speed without glitches [rpm]."""

    name: str
    samples: Array
    rpm: Array


@dataclass(frozen=True, slots=True)
class Window:
    """Clarke currents or one current, (2, n) or (1, n) [A], their rate and the encoder's mean speed [rpm]."""

    current: Array
    rate_hz: float
    rpm: float


def runs(folder: Path) -> list[Run]:
    """All recordings of the folder, by name."""
    inner = folder / MILL_FOLDER
    paths = sorted((inner if inner.is_dir() else folder).glob("*cut*.mat"))
    found = []
    for path in paths:
        samples, rpm = mill_samples(path)
        found.append(Run(path.stem, samples, without_glitches(rpm)))
    return found


def without_glitches(rpm: Array) -> Array:
    """The speed; what was rejected is filled from its neighbours, so that a mean counts each angle of the
    shaft alike."""
    at = np.arange(rpm.size)
    sound = np.isfinite(rpm)
    counts = COUNTS_A_MINUTE / np.interp(at, at[sound], rpm[sound])
    sound &= np.abs(counts - median_filter(counts, MEDIAN_SAMPLES)) < GLITCH_COUNTS
    return np.asarray(np.interp(at, at[sound], rpm[sound]))


def windows(
    recorded: Sequence[Run], length_s: float, *, factor: int = 1, phase: int | None = None
) -> Iterator[Window]:
    """Windows one after the other; factor: by which the rate is lowered.  phase: its current alone."""
    length = round(length_s * MILL_RATE_HZ)
    for run in recorded:
        for first in range(0, run.rpm.size - length + 1, length):
            part = slice(first, first + length)
            abc = run.samples[:3, part]
            current = clarke(abc) if phase is None else abc[phase : phase + 1]
            if factor > 1:
                edge = TAPS_PER_FACTOR // 2
                current = decimate(current, factor)[:, edge:-edge]
            yield Window(current, MILL_RATE_HZ / factor, float(run.rpm[part].mean()))
