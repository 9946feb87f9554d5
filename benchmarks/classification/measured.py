"""What is said of measured records: a motor of a mill, and one whose turns were shorted on a bench.

Neither set belongs to the project: its folder is an argument, and nothing but figures is written.
"""

from collections import Counter
from collections.abc import Iterator
from concurrent.futures import Executor
from dataclasses import dataclass, replace
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
from benchmarks.reporting import Section, spread, table
from core.classification.causes import PRIORS, Cause
from core.classification.record import classify_record
from core.condition.measuring.observing import examine
from core.machines.parameters import Motor
from core.recordings import Recording
from testing.machines.cause_records import SOME_TIME_NS

MILL_S = 5.0


@dataclass(frozen=True, slots=True)
class Measured:
    """One record of a motor, and whether its voltages are missing."""

    recording: Recording
    motor: Motor
    currents_only: bool = False


@dataclass(frozen=True, slots=True)
class Said:
    """The answer in words, and the probabilities of the causes."""

    words: str
    probabilities: dict[Cause, float]


def sections(folder: Path, pool: Executor) -> list[Section]:
    """The answers to both sets."""
    lines = [*_mill(folder, pool), "", *_itsc(folder, pool)]
    command = "python -m benchmarks.classification --data FOLDER"
    return [Section("measured", "Measured records", command, tuple(lines))]


def said_of(measured: Measured) -> Said:
    """Examine a record and answer."""
    examined = examine(measured.recording, measured.motor, currents_only=measured.currents_only)
    answer = classify_record(examined, measured.motor)
    return Said(answer.words, {one.cause: one.probability for one in answer.likelihoods})


def _mill(folder: Path, pool: Executor) -> Iterator[str]:
    windows = []
    for name in MILL_FILES:
        samples, _ = mill_samples(folder / MILL_FOLDER / name)
        length = round(MILL_S * MILL_RATE_HZ)
        for first in range(0, samples.shape[1] - length + 1, length):
            part = samples[:, first : first + length]
            windows.append(Recording(part, MILL_RATE_HZ, SOME_TIME_NS, CURRENTS + VOLTAGES))
    found = list(spread(said_of, [Measured(one, MILL) for one in windows], "mill", pool))
    yield (
        f"A mill's motor while it cuts metal: {len(found)} windows of {MILL_S:g} s with voltages. No "
        "fault of it is known; its cutter makes the load swing."
    )
    yield ""
    yield from table(["answer", "windows"], [[one, str(n)] for one, n in _counted(found)])
    yield ""
    means = {cause: float(np.mean([one.probabilities.get(cause, 0.0) for one in found])) for cause in PRIORS}
    likely = sorted(means, key=lambda cause: -means[cause])[:4]
    yield "Mean probabilities: " + ", ".join(f"{cause} {means[cause]:.2f}" for cause in likely) + "."


def _itsc(folder: Path, pool: Executor) -> Iterator[str]:
    by_class = itsc_records(folder / ITSC_FOLDER / ITSC_FILE)
    labels = [(name, one) for name, records in by_class.items() for one in records]
    cases = [
        Measured(replace(one, start_time_ns=SOME_TIME_NS), ITSC_MOTOR, currents_only=True)
        for _, one in labels
    ]
    found = list(spread(said_of, cases, "bench", pool))
    rows = [
        [kind, answer, str(n)]
        for kind, wanted in (("healthy", "HLT"), ("turns shorted", ""))
        for answer, n in _counted(
            [
                said
                for said, (name, _) in zip(found, labels, strict=True)
                if ("HLT" in name) == (wanted == "HLT")
            ]
        )
    ]
    yield (
        f"A motor on a bench, {len(found)} records of 1 s without voltages, turns of one phase shorted in "
        "most. Without voltages a fault, a channel and the supply look alike, and that is what is said."
    )
    yield ""
    yield from table(["truth", "answer", "records"], rows)


def _counted(found: list[Said]) -> list[tuple[str, int]]:
    return Counter(one.words for one in found).most_common()
