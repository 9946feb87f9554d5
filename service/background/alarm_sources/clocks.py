"""Relays' clocks that are off: `clock-off`."""

from collections.abc import Iterator

from core.time_stamps import rfc3339
from core.units import NANOSECONDS_PER_SECOND
from service.alarms.confirmation import DeadBand, Decision
from service.alarms.kinds import AlarmKind
from service.background.alarm_sources.standing import StandingAlarms
from service.configuration.alarms import AlarmSettings
from service.storage import Repository
from service.storage.records import AlarmPlace, AlarmSpec
from service.storage.records.alarm_sources import AlarmFinding, ClockOutlook
from service.storage.states import ClockQuality


class ClockSource:
    """Compares the latest comparison of each clock with the limit."""

    def __init__(self, rules: AlarmSettings, repository: Repository) -> None:
        self._repository = repository
        self._band = DeadBand(rules.clock_off_s, rules.clock_off_s / 2.0)

    def findings(self) -> Iterator[AlarmFinding]:
        """Yield what has changed. Raises SQLAlchemyError."""
        standing = StandingAlarms(self._repository, AlarmKind.CLOCK_OFF)
        clocks = self._repository.clock_outlooks()
        for clock in clocks:
            stands = standing.of(AlarmKind.CLOCK_OFF, clock.relay) is not None
            decision = self._decision(clock, stands=stands)
            if decision is Decision.KEEP and not stands:
                continue
            spec = AlarmSpec(AlarmKind.CLOCK_OFF, _told(clock), one_of_kind=True)
            place = AlarmPlace(relay=clock.relay)
            finding = standing.finding(clock.relay, place, spec, decision, _told(clock))
            if finding is not None:
                yield finding
        known = {clock.relay for clock in clocks}
        yield from standing.gone(AlarmKind.CLOCK_OFF, known, "the relay left the plant")

    def _decision(self, clock: ClockOutlook, *, stands: bool) -> Decision:
        if clock.quality is ClockQuality.FAILED:
            return Decision.KEEP if stands else Decision.RAISE
        off_s = abs(clock.offset_ns) / NANOSECONDS_PER_SECOND
        surely_s = off_s - clock.uncertainty_ns / NANOSECONDS_PER_SECOND
        return self._band.decide_between(surely_s, off_s, stands=stands)


def _told(clock: ClockOutlook) -> str:
    if clock.quality is ClockQuality.FAILED:
        return "the relay says that its clock has failed"
    off_s, within_s = (one / NANOSECONDS_PER_SECOND for one in (clock.offset_ns, clock.uncertainty_ns))
    direction = "ahead" if off_s > 0 else "behind"
    return (
        f"the relay's clock is {abs(off_s):.1f} s {direction} (+-{within_s:.1f} s), "
        f"measured {rfc3339(clock.measured_ns)[:19]}Z; the relay says it is {clock.quality.value}"
    )
