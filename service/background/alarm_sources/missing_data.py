"""Motors without a valid record for longer than their schedule promises: `missing-data`."""

from collections.abc import Iterator

from core.time_stamps import rfc3339
from service.alarms.confirmation import Decision
from service.alarms.kinds import AlarmKind
from service.background.alarm_sources.standing import StandingAlarms
from service.condition.staleness import stale_after_ns
from service.configuration.settings import Settings
from service.plant.schedule import Schedule
from service.storage import Repository
from service.storage.records import AlarmPlace, AlarmSpec
from service.storage.records.alarm_sources import AlarmFinding, RecordOutlook
from service.storage.states import LinkState

LONGEST_GRACE = 2
"""A link that comes back now and then does not put off the alarm for ever: after so many of these times it
is raised all the same."""


class MissingDataSource:
    """Compares the age of each motor's latest valid record with what its schedule promises."""

    def __init__(self, settings: Settings, repository: Repository, started_ns: int) -> None:
        """started_ns: what is not known of the time before counts from then on."""
        self._repository = repository
        self._stale_after_days = settings.stale_after_days
        self._started_ns = started_ns

    def findings(self, now_ns: int) -> Iterator[AlarmFinding]:
        """Yield what has changed. Raises SQLAlchemyError."""
        standing = StandingAlarms(self._repository, AlarmKind.MISSING_DATA)
        motors = self._repository.record_outlooks()
        for motor in motors:
            stands = standing.of(AlarmKind.MISSING_DATA, motor.motor) is not None
            decision = self._decision(motor, now_ns, stands=stands)
            spec = AlarmSpec(
                AlarmKind.MISSING_DATA, _told(motor), one_of_kind=True, recording_id=motor.recording_id
            )
            place = AlarmPlace(motor=motor.motor)
            finding = standing.finding(motor.motor, place, spec, decision, "there is a valid record again")
            if finding is not None:
                yield finding
        known = {motor.motor for motor in motors}
        yield from standing.gone(AlarmKind.MISSING_DATA, known, "the motor left the plant")

    def _decision(self, motor: RecordOutlook, now_ns: int, *, stands: bool) -> Decision:
        over = Decision.CLEAR if stands else Decision.KEEP
        if motor.schedule is None and self._stale_after_days is None:
            return over  # nothing promises a record
        longest_ns = stale_after_ns(motor.schedule, self._stale_after_days)
        began_ns = self._latest_ns(motor)
        if now_ns - began_ns <= longest_ns:
            return over
        if stands or motor.link is not LinkState.UP:
            return Decision.KEEP  # while the link is down, that is the cause, and an alarm of its own
        up_ns = motor.link_changed_ns or began_ns
        is_back_for_long = now_ns - up_ns > longest_ns or now_ns - began_ns > (1 + LONGEST_GRACE) * longest_ns
        return Decision.RAISE if is_back_for_long else Decision.KEEP

    def _latest_ns(self, motor: RecordOutlook) -> int:
        """Return when the motor was last recorded or seen to stand, or since when it should have been."""
        seen = [time_ns for time_ns in (motor.as_of_ns, motor.stood_ns) if time_ns is not None]
        if seen:
            return max(seen)
        return self._started_ns if motor.requested_ns is None else motor.requested_ns


def _told(motor: RecordOutlook) -> str:
    schedule = "" if motor.schedule is None else f"; scheduled {Schedule(motor.schedule).in_words()}"
    if motor.as_of_ns is None:
        return f"there is no valid record yet{schedule}"
    return f"the latest valid record is of {rfc3339(motor.as_of_ns)[:19]}Z{schedule}"
