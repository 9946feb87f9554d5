"""Assessments of a motor as a fold finds them, and the conditions that follow."""

from collections.abc import Mapping
from dataclasses import replace

from core.condition.assessment import Assessment, Change, Level, Reference
from core.condition.kinds import Kind
from core.condition.verdict.condition import Condition
from core.condition.verdict.judging import condition_of
from core.machines.stator_winding import Winding
from core.units import NANOSECONDS_PER_DAY
from testing.machines.motors import REFERENCE as MOTOR

AS_OF_NS = 1_800_000_000_000_000_000
SINCE_NS = AS_OF_NS - 3 * NANOSECONDS_PER_DAY


def level(value: float, deviation: float = 0.0005, winding: Winding = 1) -> Level:
    phases = (float(winding == 0), float(winding == 1), float(winding == 2))
    return Level(value, deviation, winding, phases=phases)


def reference(
    *, records: int = 60, standing: Level | None = None, score: float = 0.8, complete: bool = True
) -> Reference:
    return Reference(
        records=records,
        complete=complete,
        since_ns=AS_OF_NS - 30 * NANOSECONDS_PER_DAY,
        detectable=0.004 if complete else None,
        standing=level(0.004, 0.005, winding=2) if standing is None else standing,
        standing_score=score,
        from_bus=False,
    )


def change(
    *named: Kind, size: Level | None = None, probabilities: Mapping[Kind, float] | None = None
) -> Change:
    return Change(
        since_ns=SINCE_NS,
        detected_ns=SINCE_NS + NANOSECONDS_PER_DAY,
        probabilities=probabilities or {kind: 1.0 / len(named) for kind in named},
        named=named,
        level=level(0.01) if size is None else size,
        channel=0,
        size=0.02,
    )


def assessment(seen: Change | None = None, **further: object) -> Assessment:
    found = Assessment(
        as_of_ns=AS_OF_NS,
        reference=reference(),
        change=seen,
        standing_fault=False,
        statistic=3.0,
        threshold=16.0,
    )
    return replace(found, **further)  # type: ignore[arg-type]  # fields by name


def judged(found: Assessment | None) -> Condition:
    return condition_of(MOTOR, found, AS_OF_NS)
