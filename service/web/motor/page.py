"""All that the page of a motor shows, read from the repository."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from core.diagnosis.verdict import Verdict
from core.machines.parameters import MachineKind
from core.units import NANOSECONDS_PER_DAY
from service.api.conditions.documents import condition_document, until_stop_document
from service.api.conditions.schemas import Condition
from service.api.context import ApiContext
from service.condition.staleness import stale_after_ns
from service.storage import Repository
from service.storage.records import (
    Alarm,
    ConditionChange,
    ConditionEvent,
    Inspection,
    MotorHealth,
    RecordingEntry,
    RecordingRequest,
)
from service.web.charts import Chart
from service.web.motor.answer import AnswerSection, answer_section
from service.web.motor.drawings import MotorDrawings, motor_drawings
from service.web.motor.marks import trend_marks
from service.web.motor.measured import MeasuredValues, measured_values
from service.web.motor.nameplate import KnownMotor, known_motor
from service.web.motor.parameters import ParametersSection, parameters_section
from service.web.motor.rotor import RotorSection, rotor_section
from service.web.motor.stop import StopLine, stop_line
from service.web.motor.supply import SupplySection, supply_section
from service.web.motor.swings import SwingSection, swing_section
from service.web.motor.trend import SPANS, TrendSpan, told, trend_chart
from service.web.motor.verdict import MotorVerdict, motor_verdict

MOST_ALARMS: Final = 10
MOST_NOTES: Final = 20
MOST_CHANGES: Final = 10
MOST_INSPECTIONS: Final = 10
MOST_RECORDINGS: Final = 8
MOST_REQUESTS: Final = 3
MEASURED_WITHIN_NS: Final = 30 * NANOSECONDS_PER_DAY


@dataclass(frozen=True, slots=True)
class MotorTrend:
    """The trend of the time that was chosen. chart: None without a record in it; told: what it shows."""

    span: TrendSpan
    chart: Chart | None
    told: str


@dataclass(frozen=True, slots=True)
class MotorPage:
    """What the page shows. known: None before a service has read the motors file; no drawings then."""

    health: MotorHealth
    condition: Condition
    verdict: MotorVerdict
    stop: StopLine | None
    trend: MotorTrend
    answer: AnswerSection
    rotor: RotorSection
    supply: SupplySection
    swings: SwingSection
    parameters: ParametersSection
    known: KnownMotor | None
    drawings: MotorDrawings | None
    measured: MeasuredValues | None
    alarms: Sequence[Alarm]
    notes: Sequence[ConditionEvent]
    inspections: Sequence[Inspection]
    more_notes: bool
    changes: Sequence[ConditionChange]
    recordings: Sequence[RecordingEntry]
    verdicts: Mapping[str, Verdict]
    requests: Sequence[RecordingRequest]


def motor_page(context: ApiContext, name: str, span: TrendSpan, now_ns: int) -> MotorPage:
    """Read what the page of a motor shows. Raises NotFoundError."""
    repository = context.repository
    health = repository.health(name)
    oldest_ns = stale_after_ns(health.motor.schedule, context.settings.stale_after_days)
    condition = condition_document(
        health.condition, now_ns, oldest_ns, health.diagnosis, source=health.motor.parameters_source
    )
    known = known_motor(name, repository.motor_versions(name))
    notes = repository.events(name, limit=MOST_NOTES)
    recordings = repository.recordings(motor=name, limit=MOST_RECORDINGS).items
    return MotorPage(
        health=health,
        condition=condition,
        verdict=motor_verdict(
            health, condition, now_ns, oldest_ns, None if known is None else known.motor.limits.fault_level
        ),
        stop=stop_line(until_stop_document(repository, health.condition, now_ns, oldest_ns), now_ns),
        trend=_trend(repository, name, span, condition, known, now_ns),
        rotor=rotor_section(repository, name, MachineKind.CAGE if known is None else known.motor.kind),
        answer=answer_section(repository, name),
        supply=supply_section(repository, name),
        swings=swing_section(repository, name),
        parameters=parameters_section(repository, name),
        known=known,
        drawings=None
        if known is None
        else motor_drawings(repository, known.motor, condition, health.condition.since_ns, now_ns),
        measured=measured_values(repository.latest_sample(name, since_ns=now_ns - MEASURED_WITHIN_NS)),
        alarms=repository.open_alarms(motor=name, limit=MOST_ALARMS).items,
        notes=notes.items,
        inspections=repository.inspections(name, limit=MOST_INSPECTIONS).items,
        more_notes=notes.next is not None,
        changes=repository.condition_history(name, limit=MOST_CHANGES).items,
        recordings=recordings,
        verdicts=repository.verdicts([one.id for one in recordings]),
        requests=repository.recording_requests(motor=name, limit=MOST_REQUESTS).items,
    )


def span_of(key: str) -> TrendSpan:
    """Return the time with this key. Raises LookupError."""
    for span in SPANS:
        if span.key == key:
            return span
    raise LookupError(key)


def _trend(
    repository: Repository,
    name: str,
    span: TrendSpan,
    condition: Condition,
    known: KnownMotor | None,
    now_ns: int,
) -> MotorTrend:
    trend = repository.thinned_trend(name, from_ns=span.from_ns(now_ns))
    if not trend.records:
        return MotorTrend(span, None, told(trend))
    chart = trend_chart(
        name,
        trend,
        limit=None if known is None else known.motor.limits.fault_level,
        ahead=condition.forecast.limit,
        detectable=condition.reference.detectable,
        marks=trend_marks(repository, name, trend.from_ns, now_ns),
        from_ns=_begin(repository, name, span, now_ns),
        to_ns=now_ns,
    )
    return MotorTrend(span, chart, told(trend))


def _begin(repository: Repository, name: str, span: TrendSpan, now_ns: int) -> int | None:
    """Return where the time shown begins; None for the first record in it, before which there is none."""
    from_ns = span.from_ns(now_ns)
    if from_ns is None or not repository.latest_records(name, limit=1, before_ns=from_ns):
        return None
    return from_ns
