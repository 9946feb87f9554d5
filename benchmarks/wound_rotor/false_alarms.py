"""Healthy motors with a wound rotor that are called faulty."""

from collections.abc import Sequence
from concurrent.futures import Executor

from benchmarks.reporting import Section, rate_text, spread, table
from benchmarks.wound_rotor.cases import MOTORS, Knowledge, Result, Subject, examined
from core.diagnosis.verdict import Verdict
from core.rotor.finding import RotorState

LOADS, SEEDS, FIRST_SEED = (0.3, 0.6, 0.9), 28, 5_000
RINGS: tuple[tuple[Knowledge, float], ...] = (
    ("shorted", 0.0),
    ("unknown", 0.0),
    ("unknown", 0.05),
    ("unknown", 0.15),
)
SWINGS = (0.0, 0.03)


def sections(pool: Executor, *, quick: bool) -> list[Section]:
    """The table by what is at the rings and whether the load swings."""
    subjects = [
        Subject(motor, load, share, knowledge, FIRST_SEED + seed, swing=swing)
        for motor in MOTORS
        for knowledge, share in RINGS
        for swing in SWINGS
        for load in LOADS[: 1 if quick else None]
        for seed in range(1 if quick else SEEDS // (1 + (swing > 0)))
    ]
    results = list(spread(examined, subjects, "healthy", pool))
    rows = []
    for knowledge, share in RINGS:
        for swing in SWINGS:
            here = [
                one
                for one in results
                if (one.subject.knowledge, one.subject.external_share, one.subject.swing)
                == (knowledge, share, swing)
            ]
            rows.append([f"{knowledge}, {share:.0%}", f"{swing:.0%}", *_row(here)])
    stator = sum(one.found.diagnosis.verdict is Verdict.FAULT for one in results)
    rotor = sum(one.found.rotor.state is RotorState.FAULT for one in results)
    lines = [
        f"{len(results)} records of 4 s of both motors, healthy. Unbalance up to 1 %, gains within 0.5 %. "
        "The load swings at 0.5 to 12 Hz, which is anywhere where the sidebands may be.",
        "",
        *table(
            [
                "at the rings",
                "load swings",
                "stator: fault",
                "watch",
                "undiagnosable",
                "rotor: fault",
                "watch",
                "unsupported",
            ],
            rows,
        ),
        "",
        f"Faults of the stator in all: {rate_text(stator, len(results))}; of the rotor: "
        f"{rate_text(rotor, len(results))}.",
    ]
    command = "python -m benchmarks.wound_rotor --subject false-alarms"
    return [Section("false-alarms", "False alarms", command, tuple(lines))]


def _row(results: Sequence[Result]) -> list[str]:
    verdicts = [one.found.diagnosis.verdict for one in results]
    states = [one.found.rotor.state for one in results]
    counts = [verdicts.count(one) for one in (Verdict.FAULT, Verdict.WATCH, Verdict.UNDIAGNOSABLE)]
    counts += [states.count(one) for one in (RotorState.FAULT, RotorState.WATCH, RotorState.UNSUPPORTED)]
    return [f"{count} of {len(results)}" for count in counts]
