"""Coverage of the intervals that people read, under noise, sensors' errors and parameters' errors at once."""

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from benchmarks.accuracy.alarms import EVERYTHING, STATED, Draw, draw_conditions, record_of_draw
from benchmarks.reporting import mark, rate_text, spread, table
from core.diagnosis.stator import diagnose
from core.diagnosis.verdict import Diagnosis, Verdict
from testing.machines.motors import ALL, REFERENCE

LEVELS = (0.0, 0.01, 0.02, 0.05)
LOADS = (0.1, 0.5, 1.0)
LEAST_COVERED = 0.92
"""A 95 % interval that covers less than this is too narrow."""
HEADER = (
    "parameters off", "mu", "load", "level inside", "its own scatter alone", "width, median", "load inside",
    "refused", "verdicts",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Case:
    """One random record at a given level and load."""

    draw: Draw
    level: float
    load_level: float


@dataclass(frozen=True, slots=True)
class Told:
    """A case and what was told of it."""

    case: Case
    diagnosis: Diagnosis

    @property
    def is_refused(self) -> bool:
        return self.diagnosis.verdict is Verdict.UNDIAGNOSABLE

    @property
    def level_inside(self) -> bool:
        return _inside(self.case.level, self.diagnosis.mu_f_ci95)

    @property
    def scatter_holds(self) -> bool:
        return _inside(self.case.level, self.diagnosis.mu_f_scatter95)

    @property
    def load_inside(self) -> bool:
        return _inside(self.case.load_level, self.diagnosis.load_level_ci95)

    @property
    def width(self) -> float:
        low, high = self.diagnosis.mu_f_ci95 or (0.0, np.nan)
        return high - low

    @property
    def contradicts_itself(self) -> bool:
        """A fault that may be none, or a healthy motor whose level lies above its limit for sure."""
        if self.diagnosis.mu_f_ci95 is None:
            return False
        limit, low = self.case.draw.motor.limits.fault_level, self.diagnosis.mu_f_ci95[0]
        verdict = self.diagnosis.verdict
        return (verdict is Verdict.FAULT and low <= limit) or (verdict is Verdict.HEALTHY and low > limit)


def tell(case: Case) -> Told:
    """Make the record and diagnose it with the nameplate's parameters."""
    condition, disturbances, start_s = draw_conditions(case.draw)
    condition = replace(condition, level=case.level, load_level=case.load_level)
    record = record_of_draw(case.draw, condition, disturbances, start_s)
    return Told(case, diagnose(record, case.draw.motor))


def intervals(*, records: int, pool: Executor) -> Iterator[str]:
    """A row for each level and load of the reference motor, and one for each other motor."""
    rows, all_told = [], []
    for factors, name in ((STATED, "R"), (EVERYTHING, "R, L")):
        prototype = Draw(REFERENCE, 0, faulty=True, factors=factors, cycles=25.0, sample_rate_hz=10_000.0)
        cells = list(product(LEVELS, LOADS))
        cases = [
            Case(replace(prototype, index=records * k + i), level, load)
            for k, (level, load) in enumerate(cells)
            for i in range(records)
        ]
        told = list(spread(tell, cases, f"intervals, {name} off", pool))
        all_told += told
        rows += [
            [name, f"{level:.0%}", f"{load:g}", *_row(told[records * k : records * (k + 1)])]
            for k, (level, load) in enumerate(cells)
        ]
        for level in LEVELS:
            of_level = [one for one in told if one.case.level == level]
            rows.append([name, f"{level:.0%}", "all", *_row(of_level)])
        rows.append([name, "all", "all", *_row(told)])
    for motor in ALL[1:]:
        prototype = Draw(motor, 0, faulty=True, factors=STATED, cycles=25.0, sample_rate_hz=10_000.0)
        cells = list(product(LEVELS, LOADS))
        few = max(1, records // 10)
        cases = [
            Case(replace(prototype, index=few * k + i), level, load)
            for k, (level, load) in enumerate(cells)
            for i in range(few)
        ]
        told = list(spread(tell, cases, f"intervals, {motor.name}", pool))
        all_told += told
        rows.append([f"R, {motor.name}", "all", "all", *_row(told)])
    contradictions = sum(one.contradicts_itself for one in all_told)
    yield "Verdicts that contradict their interval (a `fault` whose interval reaches down to the limit, a"
    yield f"`healthy` whose interval lies above it): {contradictions} of {len(all_told)},"
    yield f"{mark(passed=contradictions == 0)}."
    yield ""
    yield from table(HEADER, rows)


def _row(told: Sequence[Told]) -> list[str]:
    kept = [one for one in told if not one.is_refused]
    if not kept:
        return ["", "", "", "", str(len(told)), ""]
    verdicts = [one.diagnosis.verdict for one in kept]
    inside = sum(one.level_inside for one in kept)
    few = "" if inside >= LEAST_COVERED * len(kept) else " **falls short**"
    return [
        rate_text(inside, len(kept)) + few,
        f"{sum(one.scatter_holds for one in kept) / len(kept):.0%}",
        f"{np.median([one.width for one in kept]):.2%}",
        f"{sum(one.load_inside for one in kept) / len(kept):.1%}",
        str(len(told) - len(kept)),
        ", ".join(
            f"{verdicts.count(verdict)} {verdict}"
            for verdict in (Verdict.HEALTHY, Verdict.WATCH, Verdict.FAULT)
            if verdict in verdicts
        ),
    ]


def _inside(truth: float, interval: tuple[float, float] | None) -> bool:
    return interval is not None and interval[0] <= truth <= interval[1]
