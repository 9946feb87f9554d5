"""Time of the whole way of a record of 10 s at 10 kHz, from its file to the answer, warm."""

from collections.abc import Iterator
from concurrent.futures import Executor
from dataclasses import replace
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter

import numpy as np

from benchmarks.classification.cases import MOTORS, ONE_RECORD
from benchmarks.classification.picture import in_words
from benchmarks.reporting import Section, mark, table
from core.diagnosis.causes import NOTHING, Causes
from core.findings.examining import examine
from core.machines.parameters import Motor
from core.recordings import Recording, comtrade, read
from testing.machines.cause_records import CauseCase

DURATION_S, RATE_HZ = 10.0, 10_000.0
LOAD_LEVEL, SEED = 0.75, 9_000
GOAL_S = 0.5
REPEATS, QUICK_REPEATS = 9, 2
STEPS = ("its file read", "examined", "the whole way", "longest")


def sections(pool: Executor, *, quick: bool) -> list[Section]:
    """The table by motor and cause."""
    del pool  # measured one by one, with nothing of its own beside
    rows: list[list[str]] = []
    longest_s = 0.0
    with TemporaryDirectory() as folder:
        for name, causes in _cases():
            case = CauseCase(
                MOTORS[name], causes, LOAD_LEVEL, SEED, duration_s=DURATION_S, sample_rate_hz=RATE_HZ
            )
            path = comtrade.write(Path(folder) / f"{len(rows)}.CFG", _with_scales(case.record()))
            times_s = _times(path, case.known(), QUICK_REPEATS if quick else REPEATS)
            whole_s = [sum(one) for one in times_s]
            longest_s = max(longest_s, median(whole_s))
            figures_s = [
                *(median(step) for step in zip(*times_s, strict=True)),
                median(whole_s),
                max(whole_s),
            ]
            rows.append([f"{name}, {in_words(causes)}", *(f"{1e3 * one:.0f} ms" for one in figures_s)])
    lines = (
        f"Records of {DURATION_S:g} s at {RATE_HZ / 1e3:g} kHz with six channels, as binary COMTRADE: read, "
        "checked, diagnosed, with the condition's observation, rotor, supply, air gap and swings, and their "
        f"causes weighed. One process, warm; medians of {QUICK_REPEATS if quick else REPEATS} runs, and the "
        "longest of them.",
        "",
        *table(["record", *STEPS], rows),
        "",
        f"Slowest record: {1e3 * longest_s:.0f} ms; goal {1e3 * GOAL_S:.0f} ms: {mark(longest_s <= GOAL_S)}.",
    )
    return [Section("speed", "Speed", "python -m benchmarks.classification --subject speed", lines)]


def _cases() -> Iterator[tuple[str, Causes]]:
    for name in MOTORS:
        yield name, NOTHING
    for cause in ONE_RECORD:
        yield "medium", frozenset({cause})


def _with_scales(record: Recording) -> Recording:
    """Return a record whose channels have the scales that a file needs."""
    channels = tuple(
        replace(channel, full_scale=1.5 * float(np.abs(samples).max()))
        for channel, samples in zip(record.channels, record.samples, strict=True)
    )
    return replace(record, channels=channels)


def _times(path: Path, motor: Motor, repeats: int) -> list[tuple[float, float]]:
    """Return how long reading and examining took in each run [s]; a run before is not counted."""
    times_s = []
    for _ in range(repeats + 1):
        begun = perf_counter()
        recording = read(path)
        after_reading = perf_counter()
        examine(recording, motor)
        times_s.append((after_reading - begun, perf_counter() - after_reading))
    return times_s[1:]
