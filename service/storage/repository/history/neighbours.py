"""Recordings of a motor beside one another."""

from sqlalchemy import and_, or_, select
from sqlalchemy.orm import Session

from service.storage.models import RecordingRow
from service.storage.records import RecordingEntry
from service.storage.repository.sessions import Sessions, only


class NeighbourRows(Sessions):
    def neighbours(self, recording: RecordingEntry) -> tuple[str | None, str | None]:
        """Return the ids of the motor's stored recordings before and after one, in the order of lists."""
        with self._read() as session:
            return _beside(session, recording, later=False), _beside(session, recording, later=True)


def _beside(session: Session, recording: RecordingEntry, *, later: bool) -> str | None:
    time, number = RecordingRow.announced_ns, RecordingRow.id
    at_once = time == recording.announced_ns
    if later:
        beyond = or_(time > recording.announced_ns, and_(at_once, number > recording.id))
        order = (time.asc(), number.asc())
    else:
        beyond = or_(time < recording.announced_ns, and_(at_once, number < recording.id))
        order = (time.desc(), number.desc())
    query = select(RecordingRow).where(
        RecordingRow.motor == recording.motor, RecordingRow.digest.is_not(None), beyond
    )
    found = only(session, query.order_by(*order))
    return None if found is None else found.id
