"""Requests long records of motors at their intervals: a series of recordings that are joined.

A long record takes the relay's time and room, so it waits for the right moment: the motor runs at a steady
load, the link has been up for a while, and no other series is under way anywhere. The motor that is overdue
most comes first. So the motors of a plant are spread over time by themselves. What failed is tried again
later, after a pause that grows up to the interval.

All is told by the database, so nothing is forgotten by a restart, and several services ask once.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import structlog

from core.machines.parameters import Nameplate
from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from service.plant import PlantMotor
from service.plant.quantities import AveragingStep
from service.plant.series_rhythm import NoSeriesError, rhythm_of
from service.plant.steadiness import LEAST_SAMPLES, why_not_steady
from service.storage import Repository
from service.storage.records import SeriesHistory
from service.storage.states import LinkState
from service.timing.backoff import Backoff

log = structlog.get_logger(__name__)

PERIOD_S = 10.0
MOST_TRIGGERS = 20
"""A relay whose records are so short that a long one takes more of them is not asked for one by itself."""
UNASSESSED_NS = 30 * NANOSECONDS_PER_DAY
"""A rotor that was not assessed for so long has its motor recorded for long at least so often."""
STEADY_S = 120.0
"""A link is up, and a load is steady, for so long before a long record is asked for."""
SAMPLES_LOOKED_AT = 1000
FIRST_RETRY_S = 3600.0


@dataclass(frozen=True, slots=True)
class _Wanted:
    """What is wanted of a motor."""

    relay: str
    nameplate: Nameplate
    interval_ns: int
    duration_s: float


class LongRecorder:
    """Compares when motors were last recorded for long with their intervals."""

    def __init__(
        self,
        motors: Iterable[PlantMotor],
        repository: Repository,
        *,
        usual_days: float,
        usual_s: float,
        metering_period_s: float,
        steady_s: float = STEADY_S,
    ) -> None:
        """usual_days, usual_s: interval and length where a motor has none of its own; 0 days: none is made.

        metering_period_s: how often the relays' measured values are sampled.  steady_s: for so long must link
        and load have been well; longer where that would be too few samples.
        """
        self._repository = repository
        self._steady_ns = round(
            max(steady_s, (LEAST_SAMPLES + 1) * metering_period_s) * NANOSECONDS_PER_SECOND
        )
        self._wanted: dict[str, _Wanted] = {}
        for motor in motors:
            days = usual_days if motor.long_record_days is None else motor.long_record_days
            if days > 0:
                self._wanted[motor.name] = _Wanted(
                    motor.relay,
                    motor.motor.nameplate,
                    round(days * NANOSECONDS_PER_DAY),
                    usual_s if motor.long_record_s is None else motor.long_record_s,
                )
        self._due_ns: dict[str, int] = {}
        self._look_ns: dict[str, int] = {}  # when to ask again: meanwhile the rotor may be assessed no more
        self._put_off: dict[str, str] = {}

    def request_due(self, now_ns: int) -> None:
        """Request the long record that is overdue most, if its moment is right. Raises SQLAlchemyError."""
        for motor, wanted in self._wanted.items():
            if self._look_ns.get(motor, 0) <= now_ns:
                interval_ns = self._interval_ns(motor, wanted.interval_ns, now_ns)
                self._due_ns[motor] = _due_ns(self._repository.series_history(motor), interval_ns)
                self._look_ns[motor] = min(self._due_ns[motor], now_ns + NANOSECONDS_PER_DAY)
        overdue = sorted((due_ns, motor) for motor, due_ns in self._due_ns.items() if due_ns <= now_ns)
        if not overdue or self._repository.is_series_under_way(now_ns=now_ns):
            return
        for due_ns, motor in overdue:
            reason = self._why_not_now(motor, now_ns)
            if reason is not None:
                self._tell(motor, reason)
                continue
            seconds = self._wanted[motor].duration_s
            made = self._repository.schedule_recording(motor, due_ns=due_ns, now_ns=now_ns, seconds=seconds)
            if made is None:
                self._tell(motor, "an earlier recording request waits for its record")
                continue
            self._put_off.pop(motor, None)
            log.info("long record requested", motor=motor, seconds=seconds, recording_request=made.id)
            return

    def _interval_ns(self, motor: str, usual_ns: int, now_ns: int) -> int:
        """Return how often a motor is recorded for long: at least monthly while its rotor is not assessed."""
        if usual_ns <= UNASSESSED_NS:
            return usual_ns
        assessed_ns = self._repository.rotor_assessed_ns(motor)
        is_recent = assessed_ns is not None and assessed_ns > now_ns - UNASSESSED_NS
        return usual_ns if is_recent else UNASSESSED_NS

    def _why_not_now(self, motor: str, now_ns: int) -> str | None:
        """Return why the moment is not right; None where it is."""
        wanted, since_ns = self._wanted[motor], now_ns - self._steady_ns
        relay = self._repository.relay(wanted.relay)
        if relay.link_state is not LinkState.UP:
            return f"the link to {relay.name} is {relay.link_state}"
        if relay.link_changed_ns is not None and relay.link_changed_ns > since_ns:
            return f"the link to {relay.name} has not been up for long"
        try:
            rhythm = rhythm_of(self._repository.record_length(motor), wanted.duration_s)
        except NoSeriesError as error:
            return f"no series can be made: {error}"
        if rhythm.triggers > MOST_TRIGGERS:
            needed = f"it takes {rhythm.triggers}, at most {MOST_TRIGGERS} are made unasked"
            return f"its relay's records are too short: {needed}"
        measured = self._repository.measurements(
            motor, AveragingStep.AS_SAMPLED.value, limit=SAMPLES_LOOKED_AT, from_ns=since_ns
        )
        return why_not_steady([sample.values for sample in measured.items], wanted.nameplate)

    def _tell(self, motor: str, reason: str) -> None:
        """Log why a long record is put off, once for each kind of reason."""
        kind = reason.partition(":")[0]
        if self._put_off.get(motor) != kind:
            self._put_off[motor] = kind
            log.info("long record put off", motor=motor, reason=reason)


def _due_ns(history: SeriesHistory, interval_ns: int) -> int:
    """Return when a motor is to be recorded for long next [ns UTC]; 0 where it never was."""
    if history.tried_ns is None:
        return 0
    if history.failed == 0:
        return history.tried_ns + interval_ns
    longest_s = interval_ns / NANOSECONDS_PER_SECOND
    pause_s = Backoff(min(FIRST_RETRY_S, longest_s), longest_s).pause_s(history.failed)
    return history.tried_ns + round(pause_s * NANOSECONDS_PER_SECOND)
