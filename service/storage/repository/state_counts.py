"""How much there is of everything, by state: for the metrics."""

from collections import Counter
from collections.abc import Mapping
from enum import StrEnum
from typing import TypeVar

from sqlalchemy import func, select

from service.storage.models import (
    AlarmRow,
    Base,
    IedRow,
    JobRow,
    RecordingRequestRow,
    RecordingRow,
    StandingAlarmCountRow,
    StateCountRow,
)
from service.storage.records import Counts
from service.storage.repository.sessions import Sessions
from service.storage.states import JobState, RecordingRequestState, RecordingState

State = TypeVar("State", bound=StrEnum)


class StateCounts(Sessions):
    def counts(self) -> Counts:
        """Count what there is now; of relays and their alarms, those in service only.

        Alarms of no relay are counted too.
        """
        links = select(IedRow.link_state, func.count()).where(IedRow.in_service).group_by(IedRow.link_state)
        alarms = (
            select(StandingAlarmCountRow.kind, func.sum(StandingAlarmCountRow.number))
            .join(IedRow, IedRow.name == StandingAlarmCountRow.ied)
            .where(IedRow.in_service)
            .group_by(StandingAlarmCountRow.kind)
        )
        of_no_relay = (
            select(AlarmRow.kind, func.count())
            .where(AlarmRow.ied.is_(None), AlarmRow.cleared_ns.is_(None))
            .group_by(AlarmRow.kind)
        )
        with self._read() as session:
            standing = Counter({kind: int(number) for kind, number in session.execute(alarms)})
            standing.update(dict(session.execute(of_no_relay).all()))
            numbers = {
                (row.counted_table, row.state): row.number for row in session.scalars(select(StateCountRow))
            }
            return Counts(
                links=dict(session.execute(links).all()),
                alarms={kind: number for kind, number in standing.items() if number},
                recording_requests=_of(RecordingRequestRow, RecordingRequestState, numbers),
                recordings=_of(RecordingRow, RecordingState, numbers),
                jobs=_of(JobRow, JobState, numbers),
            )


def _of(table: type[Base], states: type[State], numbers: Mapping[tuple[str, str], int]) -> dict[State, int]:
    """Return the numbers of rows by state, without states that have none."""
    found = {state: numbers[table.__tablename__, state] for state in states}
    return {state: number for state, number in found.items() if number}
