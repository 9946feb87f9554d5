"""What is said of a motor in one sentence, and what to do."""

from collections.abc import Sequence
from dataclasses import dataclass

from service.api.conditions.schemas import Condition, PartOfMotor
from service.condition.staleness import missing
from service.condition.wording import advice_now, beside_stator, expected, finding, level_ahead
from service.storage.records import MotorHealth
from service.web.fleet.rows import doubt
from service.web.fleet.states import FleetState, states_of
from service.web.words import day, percent

Interval = tuple[float, float]


@dataclass(frozen=True, slots=True)
class MotorVerdict:
    """What is said of a motor now.

    states: the one that matters most first.  what: the finding in words.  level, interval: fault level in
    all.  change: what of it has come since then.  since_ns: first record that shows it; is_from_first_record:
    it was there before.  limit: level that the forecast is about; days: likely not before, middle, likely by
    then, counted from the latest record; None without a trend.  fault_level: the motor's limit.
    parts: what is said of each part; is_of_winding: nothing counts but stator and channels.
    visible: least step of the level that would be seen; is_of_record: within the latest record alone, because
    the reference is not complete.  records: of the reference.  doubt: why a healthy motor may not be.
    """

    states: tuple[FleetState, ...]
    what: str
    level: float | None
    change: float | None
    interval: Interval | None
    since_ns: int | None
    is_from_first_record: bool
    growth_per_day: float | None
    limit: float | None
    fault_level: float | None
    days: tuple[float, float, float] | None
    visible: float | None
    is_of_record: bool
    records: int
    as_of_ns: int | None
    stood_ns: int | None
    advice: str
    doubt: str
    reasons: Sequence[str]
    parts: Sequence[PartOfMotor]
    is_of_winding: bool

    @property
    def state(self) -> FleetState:
        """Return the state that matters most."""
        return self.states[0]

    @property
    def grows(self) -> bool:
        """Tell whether it is certain that the level grows."""
        return self.days is not None and self.growth_per_day is not None

    def expected(self, now_ns: int) -> str:
        """Return when the level ahead is reached; empty without a trend."""
        if self.days is None or self.limit is None or self.as_of_ns is None:
            return ""
        return expected(
            level_ahead(self.limit, self.fault_level, percent), self.as_of_ns, self.days, now_ns, day
        )


def motor_verdict(
    health: MotorHealth, condition: Condition, now_ns: int, oldest_ns: int, fault_level: float | None
) -> MotorVerdict:
    """Return what is said of a motor.

    oldest_ns: age beyond which its latest record is too old.  fault_level: the motor's limit.
    """
    entry, reference = health.condition, condition.reference
    why = missing(entry.as_of_ns, entry.stood_ns, now_ns, oldest_ns)
    limit = None if health.diagnosis is None else health.diagnosis.detection_limit
    return MotorVerdict(
        states=states_of(entry, now_ns, oldest_ns),
        what=finding(condition, why, complete=reference.complete),
        level=condition.mu_f,
        change=condition.change,
        interval=condition.mu_f_ci95,
        since_ns=entry.since_ns,
        is_from_first_record=condition.since is not None and condition.since == reference.since,
        growth_per_day=condition.growth_per_day,
        limit=condition.forecast.limit,
        fault_level=fault_level,
        days=condition.forecast.days,
        visible=limit if reference.detectable is None else reference.detectable,
        is_of_record=reference.detectable is None,
        records=reference.records,
        as_of_ns=entry.as_of_ns,
        stood_ns=entry.stood_ns,
        advice=advice_now(condition.advice, condition.state, why),
        doubt=doubt(condition, None if health.diagnosis is None else health.diagnosis.verdict),
        reasons=condition.reasons,
        parts=condition.parts,
        is_of_winding=not beside_stator(condition),
    )
