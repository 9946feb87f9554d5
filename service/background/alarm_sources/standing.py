"""The alarms of some kinds that stand, and what is to be done about one by a decision."""

from collections.abc import Container, Iterator

from service.alarms.catalogue import CATALOGUE
from service.alarms.confirmation import Decision
from service.alarms.kinds import AlarmKind, AlarmPriority
from service.storage import Repository
from service.storage.records import Alarm, AlarmPlace, AlarmSpec
from service.storage.records.alarm_sources import AlarmFinding

URGENCY = (AlarmPriority.LOW, AlarmPriority.MEDIUM, AlarmPriority.HIGH, AlarmPriority.CRITICAL)

Key = tuple[AlarmKind, str]
"""A kind, and what tells its alarms apart: a motor, a relay, or a subject."""


class StandingAlarms:
    """The alarms that a source has raised before, by what they are about."""

    def __init__(self, repository: Repository, *kinds: AlarmKind) -> None:
        """Read those of these kinds. Raises SQLAlchemyError."""
        self._alarms = {self._key(alarm): alarm for alarm in repository.standing_alarms_of(*kinds)}

    def of(self, kind: AlarmKind, about: str) -> Alarm | None:
        """Return the alarm about a motor, a relay, a site or, of the service itself, with a subject."""
        return self._alarms.get((kind, about))

    def about(self, kind: AlarmKind) -> Iterator[tuple[str, Alarm]]:
        """Yield what the alarms of a kind are about, with each."""
        return ((about, alarm) for (of_kind, about), alarm in self._alarms.items() if of_kind is kind)

    def finding(
        self, about: str, place: AlarmPlace, spec: AlarmSpec, decision: Decision, why: str
    ) -> AlarmFinding | None:
        """Return what is to be done; None where nothing changes.

        spec: the alarm, if it is raised or stands.  why: what shows that it is over, if it is.
        """
        stands = self.of(spec.kind, about)
        if decision is Decision.CLEAR:
            subject = spec.subject if stands is None else stands.subject
            return AlarmFinding(place, spec.kind, subject, None, why)
        if stands is None:
            is_raised = decision is Decision.RAISE
            return AlarmFinding(place, spec.kind, spec.subject, spec) if is_raised else None
        priority = spec.priority or CATALOGUE[spec.kind].priority
        if (stands.subject, stands.reason, stands.priority) == (spec.subject, spec.reason, priority):
            return None
        is_worse = URGENCY.index(priority) > URGENCY.index(stands.priority)
        return AlarmFinding(place, spec.kind, spec.subject, spec, again=is_worse)

    def gone(
        self, kind: AlarmKind, known: Container[str], why: str, *, of: str = ""
    ) -> Iterator[AlarmFinding]:
        """Yield the clearing of alarms about what is not known any more: it left the plant or the settings.

        known: what there is.  of: how it begins; alarms of other hosts are theirs to clear.
        """
        for about, alarm in self.about(kind):
            if about.startswith(of) and about not in known:
                yield AlarmFinding(_place(alarm), kind, alarm.subject, None, why)

    @staticmethod
    def _key(alarm: Alarm) -> Key:
        return alarm.kind, alarm.motor or alarm.ied or alarm.subject or alarm.site or ""


def _place(alarm: Alarm) -> AlarmPlace:
    return AlarmPlace(alarm.site, alarm.ied, alarm.motor)
