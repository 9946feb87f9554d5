"""The motors of a report, each as it was at the report's time, worst first."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

from core.condition.kinds import Kind, State
from core.motor_condition.parts import RANKS
from core.time_words import clock, day
from service.condition.staleness import Missing, missing, stale_after_ns
from service.condition.wording import advice_now, expected, finding, level_ahead, since
from service.reports.figures import number, share
from service.reports.source import ReportSource
from service.storage import Repository
from service.storage.records import ConditionFigures, ConditionPoint, MotorHealth

PAGE = 500
UNKNOWN = ConditionFigures(state=State.UNKNOWN, kind=Kind.NONE)
NOT_RUNNING, STALE = "not running", "no recent record"


@dataclass(frozen=True, slots=True)
class ReportedMotor:
    """A motor at a time. as_of_ns: its latest record that counts until then; None without any.

    document: what else was said of it then; empty where only later documents are kept.
    missing: why it has no recent record; None where it has one, or was never seen.
    data: the same in words; "" where its latest record is recent.
    """

    health: MotorHealth
    said: ConditionFigures
    as_of_ns: int | None
    document: Mapping[str, object]
    data: str
    missing: Missing | None = None

    @property
    def name(self) -> str:
        """Return the motor's name."""
        return self.health.motor.name

    @property
    def advice(self) -> str:
        """Return what to do; "" where that is not known of the time."""
        advice = self.document.get("advice")
        return advice_now(advice if isinstance(advice, str) else "", self.said.state, self.missing)

    @property
    def finding(self) -> str:
        """Return what was found, as the beginning of a sentence."""
        complete = self.reference.get("complete", True)
        return finding(self.said, self.missing, complete=bool(complete))

    @property
    def reference(self) -> Mapping[str, object]:
        """Return what is said of the reference; nothing where only later documents are kept."""
        reference = self.document.get("reference")
        return reference if isinstance(reference, Mapping) else {}

    def since(self, zone: str) -> str:
        """Return since when the change is there, in words; "" where there is none, or that is not kept."""
        if self.since_ns is None:
            return ""
        is_first = self.document.get("since") == self.reference.get("since")
        return since(clock(self.since_ns, zone), is_from_first_record=is_first)

    @property
    def ahead(self) -> float | None:
        """Return the level that the forecast is about; None where that is not known."""
        return number(self._forecast.get("limit"))

    def expected(self, now_ns: int, zone: str, limit: float | None) -> str:
        """Return when the level ahead is reached; "" without a trend. limit: the motor's."""
        days, ahead = self._forecast.get("days"), self.ahead
        if not isinstance(days, list | tuple) or len(days) != 3 or ahead is None or self.as_of_ns is None:
            return ""
        words = level_ahead(ahead, limit, share)
        return expected(words, self.as_of_ns, days, now_ns, lambda time_ns: day(time_ns, zone))

    @property
    def _forecast(self) -> Mapping[str, object]:
        forecast = self.document.get("forecast")
        return forecast if isinstance(forecast, Mapping) else {}

    @property
    def detectable(self) -> float | None:
        """Return the detection limit of a change; None where it is not known."""
        return number(self.reference.get("detectable"))

    @property
    def since_ns(self) -> int | None:
        """Return the first record that shows the change, where the condition is that of the latest record."""
        return self.health.condition.since_ns if self.document else None


def reported_motors(
    source: ReportSource, until_ns: int, sites: Collection[str] | None = None
) -> Sequence[ReportedMotor]:
    """Return the motors in service as they were then, worst first. Raises SQLAlchemyError."""
    said = source.repository.conditions_at(until_ns)
    found = [
        reported(health, said.get(health.motor.name), until_ns, source.stale_after_days)
        for health in _all(source.repository)
        if sites is None or health.motor.site in sites
    ]
    return sorted(found, key=_attention)


def reported(
    health: MotorHealth, point: ConditionPoint | None, until_ns: int, stale_after_days: float | None
) -> ReportedMotor:
    """Return a motor as it was at a time. point: what was said from its latest record until then on."""
    entry = health.condition
    is_now = entry.as_of_ns is not None and entry.as_of_ns <= until_ns
    as_of_ns = entry.as_of_ns if is_now else (None if point is None else point.time_ns)
    stood_ns = entry.stood_ns if entry.stood_ns is not None and entry.stood_ns <= until_ns else None
    oldest_ns = stale_after_ns(health.motor.schedule, stale_after_days)
    why = missing(as_of_ns, stood_ns, until_ns, oldest_ns)
    return ReportedMotor(
        health=health,
        said=entry if is_now else point or UNKNOWN,
        as_of_ns=as_of_ns,
        document=(entry.document or {}) if is_now else {},
        data=_data(why, as_of_ns),
        missing=why,
    )


def _data(why: Missing | None, as_of_ns: int | None) -> str:
    """Return why there is no recent record, in words."""
    if why is Missing.NOT_RUNNING:
        return NOT_RUNNING
    return STALE if why is Missing.STALE or as_of_ns is None else ""


def _attention(motor: ReportedMotor) -> tuple[int, int, float, str]:
    return RANKS[motor.said.state], motor.data != STALE, -(motor.said.mu_f or 0.0), motor.name


def _all(repository: Repository) -> Sequence[MotorHealth]:
    found: list[MotorHealth] = []
    after = None
    while True:
        page = repository.health_of_motors(limit=PAGE, after=after)
        found += page.items
        after = page.next
        if after is None:
            return found
