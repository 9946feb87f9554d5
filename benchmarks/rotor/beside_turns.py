"""A broken bar beside shorted turns, which take power that no load gets."""

from collections import defaultdict
from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass

from benchmarks.reporting import Section, rate_text, spread, table
from benchmarks.rotor.cases import BARS, MOTORS
from core.diagnosis.causes import Cause
from core.findings.examining import examine
from core.rotor.finding import RotorFinding, RotorState
from testing.machines.cause_records import CauseCase, Sizes
from testing.machines.rotor_records import RotorCase

LOADS = (0.25, 0.4, 0.6, 0.8)
LEVELS, QUICK_LEVELS = (0.03, 0.05, 0.08), (0.05,)
REPEATS, QUICK_REPEATS = 4, 2


@dataclass(frozen=True, slots=True)
class Subject:
    """A motor with shorted turns and a broken bar, or a sound rotor."""

    motor: str
    load_level: float
    turns: float
    is_broken: bool
    seed: int


@dataclass(frozen=True, slots=True)
class Result:
    """What one record says. finding: None where the quality gate refused it."""

    subject: Subject
    finding: RotorFinding | None
    turns_found: bool


def sections(pool: Executor, *, quick: bool) -> list[Section]:
    """The table by motor and load."""
    subjects = [
        Subject(motor, load, turns, is_broken, seed)
        for motor in MOTORS
        for load in LOADS
        for turns in (QUICK_LEVELS if quick else LEVELS)
        for is_broken in (False, True)
        for seed in range(QUICK_REPEATS if quick else REPEATS)
    ]
    results = list(spread(_examined, subjects, "beside shorted turns", pool))
    found = sum(one.turns_found for one in results)
    lines = [
        f"{len(results)} records of 5 s at 4 kHz with 3, 5 and 8 % of a phase's turns shorted, drawn as "
        "those of [the classification](classification.md): parameters known within 5 %. The turns were found "
        f"in {found} of them. Fault / watch / healthy / unsupported.",
        "",
        *_table(results),
        "",
        _coverage(results),
    ]
    command = "python -m benchmarks.rotor --subject beside-turns"
    return [Section("beside-turns", "Beside shorted turns", command, tuple(lines))]


def _examined(subject: Subject) -> Result:
    causes = {Cause.SHORTED_TURNS} | ({Cause.ROTOR} if subject.is_broken else set())
    sizes = Sizes(turns=subject.turns)
    case = CauseCase(MOTORS[subject.motor], frozenset(causes), subject.load_level, subject.seed, sizes)
    examined = examine(case.record(), case.known())
    return Result(subject, examined.rotor, examined.diagnosis.phase is not None)


def _table(results: Sequence[Result]) -> list[str]:
    cells: dict[tuple[str, float, bool], list[Result]] = defaultdict(list)
    for result in results:
        subject = result.subject
        cells[subject.motor, subject.load_level, subject.is_broken].append(result)
    rows = [
        [motor, f"{load:.0%}", _cell(cells[motor, load, False]), _cell(cells[motor, load, True])]
        for motor in MOTORS
        for load in LOADS
    ]
    return table(["motor", "load", "sound rotor", "1 of 28 broken"], rows)


def _cell(results: Sequence[Result]) -> str:
    states = [RotorState.UNSUPPORTED if one.finding is None else one.finding.state for one in results]
    order = (RotorState.FAULT, RotorState.WATCH, RotorState.HEALTHY, RotorState.UNSUPPORTED)
    return " / ".join(str(states.count(state)) for state in order)


def _coverage(results: Sequence[Result]) -> str:
    held, count, off = 0, 0, []
    for result in results:
        finding = result.finding
        if not result.subject.is_broken or finding is None:
            continue
        if finding.severity_dB is None or finding.severity_dB_ci95 is None:
            continue
        true_dB = RotorCase(MOTORS[result.subject.motor], broken_share=1 / BARS).asymmetry_dB
        low, high = finding.severity_dB_ci95
        held, count = held + (low <= true_dB <= high), count + 1
        off.append(finding.severity_dB - true_dB)
    if not off:
        return "No record told a severity."
    return (
        f"With a bar broken, the 95 % interval holds the true asymmetry in {rate_text(held, count)}; the "
        f"severity is off by {min(off):+.1f} to {max(off):+.1f} dB."
    )
