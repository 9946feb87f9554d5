"""What is said of measured records: a motor of a mill, one whose turns were shorted on a bench, and others.

No set belongs to the project: their folder is an argument, and nothing but figures is written.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
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
from benchmarks.classification.cases import ONE_RECORD
from benchmarks.reporting import Section, spread, table
from core.diagnosis.causes import IN_WORDS, PRIORS, Cause
from core.findings.examining import examine
from core.machines.parameters import Motor
from core.recordings import Recording, RecordingError, read
from testing.machines.cause_records import SOME_TIME_NS

MILL_S = 5.0
COMTRADE_FOLDER, COMTRADE_SUFFIXES = "comtrade", {".cfg", ".cff"}
LACKING = "refused: channels are lacking"


@dataclass(frozen=True, slots=True)
class Measured:
    """One record of a motor, and whether its voltages are missing."""

    recording: Recording
    motor: Motor
    currents_only: bool = False


@dataclass(frozen=True, slots=True)
class Said:
    """The answer in words, the probabilities of the causes, and of which of them anything is known."""

    words: str
    probabilities: dict[Cause, float]
    known: frozenset[Cause]


def sections(folder: Path, pool: Executor) -> list[Section]:
    """The answers to the sets, and what each set tells."""
    mill = list(spread(said_of, _mill_records(folder), "mill", pool))
    classes, records = _itsc_records(folder)
    itsc = list(spread(said_of, records, "bench", pool))
    files = list(spread(said_of, _comtrade_records(folder), "COMTRADE", pool))
    lines = [*_mill(mill), "", *_itsc(classes, itsc), "", *_comtrade(files), "", *_told(mill, itsc, files)]
    command = "python -m benchmarks.classification --data FOLDER"
    return [Section("measured", "Measured records", command, tuple(lines))]


def said_of(measured: Measured) -> Said:
    """Examine a record and answer."""
    try:
        examined = examine(measured.recording, measured.motor, currents_only=measured.currents_only)
    except RecordingError:
        return Said(LACKING, {}, frozenset())
    answer = examined.classification
    return Said(
        answer.words,
        {one.cause: one.probability for one in answer.likelihoods},
        frozenset(one.cause for one in answer.likelihoods if one.log_likelihood_ratio is not None),
    )


def _mill_records(folder: Path) -> list[Measured]:
    windows = []
    for name in MILL_FILES:
        samples, _ = mill_samples(folder / MILL_FOLDER / name)
        length = round(MILL_S * MILL_RATE_HZ)
        for first in range(0, samples.shape[1] - length + 1, length):
            part = samples[:, first : first + length]
            windows.append(Recording(part, MILL_RATE_HZ, SOME_TIME_NS, CURRENTS + VOLTAGES))
    return [Measured(one, MILL) for one in windows]


def _mill(found: Sequence[Said]) -> Iterator[str]:
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


def _itsc_records(folder: Path) -> tuple[list[str], list[Measured]]:
    """Return the classes of the set, one a record, and the records."""
    by_class = itsc_records(folder / ITSC_FOLDER / ITSC_FILE)
    labels = [(name, one) for name, records in by_class.items() for one in records]
    records = [
        Measured(replace(one, start_time_ns=SOME_TIME_NS), ITSC_MOTOR, currents_only=True)
        for _, one in labels
    ]
    return [name for name, _ in labels], records


def _itsc(classes: Sequence[str], found: Sequence[Said]) -> Iterator[str]:
    by_kind: dict[str, list[Said]] = {"healthy": [], "turns shorted": []}
    for name, said in zip(classes, found, strict=True):
        by_kind["healthy" if "HLT" in name else "turns shorted"].append(said)
    rows = [[kind, answer, str(n)] for kind, said in by_kind.items() for answer, n in _counted(said)]
    yield (
        f"A motor on a bench, {len(found)} records of 1 s without voltages, turns of one phase shorted in "
        "most. Without voltages a fault, a channel and the supply look alike, and that is what is said. The "
        "motor's parameters are not published: those of its file are guessed."
    )
    yield ""
    yield from table(["truth", "answer", "records"], rows)


def _comtrade_records(folder: Path) -> list[Measured]:
    found = []
    for path in sorted((folder / COMTRADE_FOLDER).rglob("*")):
        if path.suffix.lower() in COMTRADE_SUFFIXES:
            try:
                found.append(Measured(read(path, lenient=True), MILL))
            except RecordingError:
                continue
    return found


def _comtrade(found: Sequence[Said]) -> Iterator[str]:
    yield (
        f"{len(found)} COMTRADE files of four readers, most of them of lines and of no motor. They are taken "
        "for records of the mill's motor, and no cause may be told of them."
    )
    yield ""
    yield from table(["answer", "files"], [[one, str(n)] for one, n in _counted(found)])


def _told(mill: Sequence[Said], itsc: Sequence[Said], files: Sequence[Said]) -> Iterator[str]:
    yield "Of which causes each set tells anything, in how many of its records, and what it lacks:"
    yield ""
    sets = (
        ("mill", mill, "a fault"),
        ("turns shorted on a bench", itsc, "voltages, load, and all but the supply's line in its currents"),
        ("COMTRADE files", files, "a motor"),
    )
    rows = [
        [
            name,
            str(len(found)),
            *(str(sum(cause in one.known for one in found)) for cause in ONE_RECORD),
            lack,
        ]
        for name, found, lack in sets
    ]
    nothing = ["0"] * len(ONE_RECORD)
    rows.append(["one phase, bars broken", "not in the folder", *nothing, "two currents, and all voltages"])
    yield from table(["set", "records", *(IN_WORDS[cause] for cause in ONE_RECORD), "it lacks"], rows)
    yield ""
    yield (
        "The last row is the public set of one phase's current of a motor with broken bars. The causes take "
        "three currents, so nothing can be said of it here; `mcc rotor` tells of its cage, at most watch "
        "([rotor](rotor.md#one-phase))."
    )


def _counted(found: Sequence[Said]) -> list[tuple[str, int]]:
    return Counter(one.words for one in found).most_common()
