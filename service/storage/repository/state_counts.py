"""How much there is of everything, by state: for the metrics."""

from enum import StrEnum
from typing import TypeVar

from sqlalchemy import ColumnElement, func, select
from sqlalchemy.orm import InstrumentedAttribute, Session

from service.storage.models import AlarmRow, IedRow, JobRow, RecordingRequestRow, RecordingRow
from service.storage.records import Counts
from service.storage.repository.sessions import Sessions

State = TypeVar("State", bound=StrEnum)


class StateCounts(Sessions):
    def counts(self) -> Counts:
        with self._read() as session:
            return Counts(
                links=_count(session, IedRow.link_state),
                alarms=_count(session, AlarmRow.kind, AlarmRow.cleared_ns.is_(None)),
                recording_requests=_count(session, RecordingRequestRow.state),
                recordings=_count(session, RecordingRow.state),
                jobs=_count(session, JobRow.state),
            )


def _count(
    session: Session, state: InstrumentedAttribute[State], *only_those: ColumnElement[bool]
) -> dict[State, int]:
    rows = session.execute(select(state, func.count()).where(*only_those).group_by(state))
    return {row[0]: row[1] for row in rows}
