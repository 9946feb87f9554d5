"""Trips of motors that left the plant: `motor-tripped` is over then. All else the GOOSE gateway tells."""

from collections.abc import Iterator

from service.alarms.kinds import AlarmKind
from service.background.alarm_sources.standing import StandingAlarms
from service.storage import Repository
from service.storage.records.alarm_sources import AlarmFinding


class TripSource:
    """Compares the motors of standing trips with those in service."""

    def __init__(self, repository: Repository) -> None:
        self._repository = repository

    def findings(self) -> Iterator[AlarmFinding]:
        """Yield what has changed. Raises SQLAlchemyError."""
        standing = StandingAlarms(self._repository, AlarmKind.MOTOR_TRIPPED)
        known = self._repository.schedules()
        yield from standing.gone(AlarmKind.MOTOR_TRIPPED, known, "the motor left the plant")
