"""Healthy motors that are called faulty, in many records."""

from collections.abc import Sequence
from concurrent.futures import Executor
from functools import partial

from benchmarks.reporting import Section, mark, rate_text, spread, table
from benchmarks.rotor.cases import LOAD_SWINGS, MOTORS, Result, Subject, examined
from core.rotor.finding import RotorState

LOADS = (0.25, 0.4, 0.6, 0.8, 1.0)
OPERATIONS, RECORDS = 3, 20
QUICK_OPERATIONS, QUICK_RECORDS = 1, 2
FIRST_SEED = 1_000
RATE_HZ = 5_000.0
GOAL = 1e-3


def sections(pool: Executor, *, quick: bool) -> list[Section]:
    """The table by how the load swings."""
    operations, records = (QUICK_OPERATIONS, QUICK_RECORDS) if quick else (OPERATIONS, RECORDS)
    subjects = [
        Subject(motor, load, 0, swing, FIRST_SEED + seed, sample_rate_hz=RATE_HZ)
        for motor in MOTORS
        for load in LOADS
        for swing in LOAD_SWINGS
        for seed in range(operations)
    ]
    work = partial(examined, records=records)
    results = [one for many in spread(work, subjects, "healthy", pool) for one in many]
    rows = [_row(swing, [one for one in results if one.subject.swing == swing]) for swing in LOAD_SWINGS]
    false = _count(results, RotorState.FAULT)
    notable = rate_text(false + _count(results, RotorState.WATCH), len(results))
    lines = [
        f"Records of 10 s at 5 kHz of healthy motors at 25 to 100 % load: {len(subjects)} operations, each "
        f"recorded {records} times with noise, relays and parameters drawn anew. A delay of the currents is "
        "taken from the diagnosis of the first.",
        "",
        *table(["load swings", "fault", "watch", "unsupported", "refused by the quality gate"], rows),
        "",
        f"Faults in all: {rate_text(false, len(results))}; goal at most {GOAL:.1%}: "
        f"{mark(false <= GOAL * len(results))}. With watch: {notable}.",
    ]
    command = "python -m benchmarks.rotor --subject false-alarms"
    return [Section("false-alarms", "False alarms", command, tuple(lines))]


def _row(swing: str, results: Sequence[Result]) -> list[str]:
    counts = [_count(results, s) for s in (RotorState.FAULT, RotorState.WATCH, RotorState.UNSUPPORTED)]
    refused = sum(one.finding is None for one in results)
    return [swing, *(f"{count} of {len(results)}" for count in (*counts, refused))]


def _count(results: Sequence[Result], state: RotorState) -> int:
    return sum(one.finding is not None and one.finding.state is state for one in results)
