"""The first page of a motor: its state by part, its alarms, and its charts over one time."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from service.api.conditions.documents import until_stop_document
from service.condition.trend_marks import trend_marks
from service.storage import Repository
from service.storage.records import Alarm
from service.web.charts import Chart
from service.web.motor.measured_charts import measured_charts
from service.web.motor.page import MotorHead
from service.web.motor.stop import StopLine, stop_line
from service.web.motor.strip import StripLine, strip
from service.web.motor.trend import trend_chart
from service.web.words import age

MOST_ALARMS: Final = 10


@dataclass(frozen=True, slots=True)
class Overview:
    """What the page shows. trend: None without a record in the time shown."""

    strip: Sequence[StripLine]
    stop: StopLine | None
    alarms: Sequence[Alarm]
    trend: Chart | None
    charts: Sequence[Chart]


def overview(repository: Repository, head: MotorHead) -> Overview:
    """Read what the page shows."""
    name, verdict, now_ns = head.name, head.verdict, head.shown.now_ns
    as_of = None if verdict.as_of_ns is None else age(verdict.as_of_ns, now_ns)
    motor = None if head.known is None else head.known.motor
    return Overview(
        strip=strip(head.condition.parts, verdict.states, head.health.ied.link_state, as_of),
        stop=stop_line(
            until_stop_document(repository, head.health.condition, now_ns, head.oldest_ns), now_ns
        ),
        alarms=repository.open_alarms(motor=name, limit=MOST_ALARMS).items,
        trend=_trend(repository, head),
        charts=measured_charts(repository, name, motor, head.shown),
    )


def _trend(repository: Repository, head: MotorHead) -> Chart | None:
    trend = repository.thinned_trend(head.name, from_ns=head.shown.from_ns)
    if not trend.records:
        return None
    return trend_chart(
        head.name,
        trend,
        limit=None if head.known is None else head.known.motor.limits.fault_level,
        ahead=head.condition.forecast.limit,
        detectable=head.condition.reference.detectable,
        marks=trend_marks(repository, head.name, trend.from_ns, head.shown.now_ns),
        shown=head.shown,
    )
