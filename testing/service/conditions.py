"""Conditions for tests: of a healthy motor, of one with a fault, and how the database gets to know them."""

from dataclasses import fields, replace

from core.condition.assessment import Level, Reference
from core.condition.events import Event, EventKind
from core.condition.forecast.outcome import Forecast
from core.condition.kinds import Kind, State
from core.condition.verdict.condition import Condition
from core.tracking.finding import TrackedParameters
from core.units import NANOSECONDS_PER_DAY
from service.storage import Repository
from service.storage.records import (
    Checkpoint,
    ConditionChange,
    ConditionEntry,
    ConditionFigures,
    ConditionPoint,
    FoldResult,
)
from service.storage.records.actors import SERVICE
from testing.service.plants import NOW_NS

HEALTHY = Condition(
    motor="PUMP-A1",
    state=State.HEALTHY,
    kind=Kind.NONE,
    candidates=(),
    phase=None,
    phase_probabilities=None,
    axis_deg=None,
    mu_f=0.0004,
    mu_f_ci95=(0.0, 0.012),
    change=0.0,
    change_ci95=None,
    size=None,
    size_ci95=None,
    since_ns=None,
    forecast=Forecast(0.005),
    reference=Reference(
        records=64,
        complete=True,
        since_ns=NOW_NS - 64 * NANOSECONDS_PER_DAY,
        detectable=0.0045,
        standing=Level(0.004, 0.005, 1, phases=(0.01, 0.98, 0.01)),
        standing_score=0.8,
        from_bus=False,
    ),
    as_of_ns=NOW_NS,
    stale=False,
    advice="Nothing needs to be done.",
    reasons=("the reference holds 64 records",),
)

FAULT = replace(
    HEALTHY,
    state=State.FAULT,
    kind=Kind.SHORTED_TURNS,
    phase="b",
    mu_f=0.0121,
    mu_f_ci95=(0.009, 0.0225),
    change=0.012,
    change_ci95=(0.009, 0.015),
    size=0.012,
    size_ci95=(0.009, 0.015),
    since_ns=NOW_NS - 3 * NANOSECONDS_PER_DAY,
    forecast=Forecast(0.02, (12.0, 20.0, 41.0), 0.0004),
    advice="Check the winding of phase b. Stop the motor at the next opportunity.",
    reasons=("shorted turns in phase b: 1.20 %", "the interval lies above the motor's limit of 0.50 %"),
)

OPEN_PHASE = replace(
    FAULT,
    phase=None,
    phase_probabilities=(0.72, 0.0, 0.28),
    advice="Check the winding. Stop the motor at the next opportunity.",
    reasons=("shorted turns in phase a (72 %) or c (28 %): 1.20 %",),
)
"""A fault that lies in one of two phases."""

DRIFTING = replace(
    HEALTHY,
    state=State.WATCH,
    kind=Kind.UNCLEAR,
    candidates=(Kind.VOLTAGE_CHANNEL, Kind.SHORTED_TURNS),
    phase="c",
    change=0.003,
    change_ci95=(0.0, 0.008),
    size=0.004,
    size_ci95=(0.0, 0.008),
    since_ns=NOW_NS - NANOSECONDS_PER_DAY,
    advice="Check the voltage transformer of phase c first.",
    reasons=("something has changed",),
)

UNKNOWN = replace(HEALTHY, state=State.UNKNOWN, mu_f=None, mu_f_ci95=None, change=None, as_of_ns=None)


def entry_of(condition: Condition) -> ConditionEntry:
    """The row of a condition."""
    low, high = condition.mu_f_ci95 or (None, None)
    change_low, change_high = condition.change_ci95 or (None, None)
    return ConditionEntry(
        motor=condition.motor,
        version=1,
        state=condition.state,
        kind=condition.kind,
        candidates=condition.candidates,
        phase=condition.phase,
        mu_f=condition.mu_f,
        mu_f_ci95_low=low,
        mu_f_ci95_high=high,
        change=condition.change,
        change_ci95_low=change_low,
        change_ci95_high=change_high,
        since_ns=condition.since_ns,
        as_of_ns=condition.as_of_ns,
        document=condition.as_dict(),
    )


def tell(
    repository: Repository,
    condition: Condition,
    *,
    now_ns: int = NOW_NS,
    parameters: TrackedParameters | None = None,
) -> None:
    """Have the database say this condition of its motor from each of the motor's records on.

    It is folded as if an event had made it.
    """
    event_id = told_event(repository, condition.motor, now_ns=now_ns)
    fold(repository, condition, event_id, now_ns=now_ns, parameters=parameters)


def told_event(repository: Repository, motor: str, *, now_ns: int = NOW_NS) -> str:
    """Have a motor's events hold one more; return its name. What follows from it is not folded yet."""
    event = Event(now_ns, EventKind.MAINTENANCE, "new bearing")
    return repository.add_event(motor, event, by=SERVICE, on_behalf_of="ann", now_ns=now_ns).id


def fold(
    repository: Repository,
    condition: Condition,
    event_id: str,
    *,
    now_ns: int = NOW_NS,
    parameters: TrackedParameters | None = None,
) -> None:
    """Have the database say this condition of its motor, as if that event had made it: one transaction."""
    begun = repository.begin_fold(condition.motor, 1000)
    assert begun is not None
    entry = entry_of(condition)
    figures = {field.name: getattr(entry, field.name) for field in fields(ConditionFigures)}
    points = [
        ConditionPoint(recording_id=one.recording_id, time_ns=one.observation.time_ns, **figures)
        for one in begun.observations
    ]
    change = ConditionChange(
        motor=condition.motor, time_ns=now_ns, recording_id=None, event_id=event_id, **figures
    )
    folded = Checkpoint(max([now_ns, *(point.time_ns for point in points)]), len(points), b"", {})
    result = FoldResult(points, [change], [folded], tuple(begun.earlier), entry)
    if parameters is not None:
        result = replace(result, parameters=parameters.as_dict())
    assert repository.finish_fold(begun, result, now_ns=now_ns)
