"""Broken bars found, by motor, load and number of bars, in records of 10 s and of 1.28 s."""

from collections import defaultdict
from collections.abc import Sequence
from concurrent.futures import Executor
from statistics import median

from benchmarks.reporting import Section, mark, rate_text, spread, table
from benchmarks.rotor.cases import BARS, LOAD_SWINGS, MOTORS, Result, Subject, examined
from core.rotor.finding import RotorState
from testing.machines.rotor_records import RotorCase

LOADS = (0.25, 0.5, 0.75, 1.0)
MOST_BARS = 3
LENGTHS_S = (10.0, 1.28)
REPEATS, QUICK_REPEATS = 2, 1
GOAL_LOAD, GOAL = 0.5, 0.95


def sections(pool: Executor, *, quick: bool) -> list[Section]:
    """The tables of both lengths."""
    repeats = QUICK_REPEATS if quick else REPEATS
    lines: list[str] = []
    for duration_s in LENGTHS_S:
        subjects = [
            Subject(motor, load, bars, swing, seed, duration_s)
            for motor in MOTORS
            for load in LOADS
            for bars in range(MOST_BARS + 1)
            for swing in LOAD_SWINGS
            for seed in range(repeats)
        ]
        results = [one for many in spread(examined, subjects, f"{duration_s:g} s", pool) for one in many]
        lines += _table(duration_s, results)
        lines += _coverage(results)
        if duration_s == LENGTHS_S[0]:
            lines += _goal(results)
    command = "python -m benchmarks.rotor --subject detection"
    return [Section("detection", "Bars found", command, tuple(lines))]


def _table(duration_s: float, results: Sequence[Result]) -> list[str]:
    cells: dict[tuple[str, float, int], list[Result]] = defaultdict(list)
    for result in results:
        subject = result.subject
        cells[subject.motor, subject.load_level, subject.broken_bars].append(result)
    rows = []
    for motor in MOTORS:
        for load in LOADS:
            row = [motor, f"{load:.0%}"]
            row += [_cell(cells[motor, load, bars]) for bars in range(MOST_BARS + 1)]
            rows.append(row)
    head = ["motor", "load", *(f"{bars} of 28 broken" for bars in range(MOST_BARS + 1))]
    what = (
        f"Records of {duration_s:g} s, a quarter each with a steady load and with one that swings at, near "
        "and away from 2sf. Shares of fault / watch / healthy / unsupported in percent, and the median "
        "severity."
    )
    return [what, "", *table(head, rows), ""]


def _cell(results: Sequence[Result]) -> str:
    states = [RotorState.UNSUPPORTED if one.finding is None else one.finding.state for one in results]
    order = (RotorState.FAULT, RotorState.WATCH, RotorState.HEALTHY, RotorState.UNSUPPORTED)
    shares = " / ".join(f"{100 * states.count(state) / len(states):.0f}" for state in order)
    levels = [
        one.finding.severity_dB
        for one in results
        if one.finding is not None and one.finding.severity_dB is not None
    ]
    return f"{shares}, {median(levels):.1f} dB" if levels else shares


def _coverage(results: Sequence[Result]) -> list[str]:
    """How often the interval holds the asymmetry of the simulated cage's resistances."""
    errors_dB, held = [], 0
    for one in results:
        subject, finding = one.subject, one.finding
        if not subject.broken_bars or finding is None or finding.severity_dB_ci95 is None:
            continue
        motor = MOTORS[subject.motor]
        true_dB = RotorCase(motor, broken_share=subject.broken_bars / BARS).asymmetry_dB
        low, high = finding.severity_dB_ci95
        held += low <= true_dB <= high
        errors_dB.append((finding.severity_dB or 0.0) - true_dB)
    rate, ends = rate_text(held, len(errors_dB)), f"{min(errors_dB):+.1f} to {max(errors_dB):+.1f} dB"
    return [
        f"With bars broken, the 95 % interval holds the true asymmetry in {rate}; the severity is off by "
        f"{median(errors_dB):+.1f} dB in the middle, {ends} at most.",
        "",
    ]


def _goal(results: Sequence[Result]) -> list[str]:
    one_bar = [one for one in results if one.subject.broken_bars == 1 and one.subject.load_level >= GOAL_LOAD]
    found = sum(one.finding is not None and one.finding.state is RotorState.FAULT for one in one_bar)
    met = mark(found >= GOAL * len(one_bar))
    rate = rate_text(found, len(one_bar))
    return [f"One broken bar at {GOAL_LOAD:.0%} load and above: fault in {rate}; goal {GOAL:.0%}: {met}.", ""]
