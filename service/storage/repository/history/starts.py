"""Starts: recorded ones are kept with the diagnosis of their recording; all are listed."""

from collections.abc import Mapping, Sequence
from itertools import groupby
from math import isfinite
from operator import attrgetter

from sqlalchemy import delete, select
from sqlalchemy.orm import Session

from core.starts.examined import ExaminedStart
from core.starts.figures import MotorStart
from core.starts.stress import HOUR_NS, starts_within_hour
from service.storage.errors import NotFoundError
from service.storage.models import MotorRow, StartRow
from service.storage.records import Cursor, Page, StartEntry
from service.storage.repository.conditions.tracking import follow_again, followed_start
from service.storage.repository.history.start_documents import FIGURES, start_entry, start_row
from service.storage.repository.history.start_reports import leave_report, take_report
from service.storage.repository.sessions import Order, Sessions, found, page_of


class StartRows(Sessions):
    def starts(
        self, motor: str | None = None, *, limit: int, after: Cursor | None = None
    ) -> Page[StartEntry]:
        """Return the starts of a motor or of all, latest first. Raises NotFoundError."""
        query = select(StartRow)
        if motor is not None:
            query = query.where(StartRow.motor == motor)
        order: Order = [StartRow.time_ns, StartRow.recording_id]
        with self._read() as session:
            if motor is not None:
                found(session, MotorRow, motor, "motor")
            return page_of(session, query, order, start_entry, limit=limit, after=after, descending=True)

    def start(self, motor: str, recording_id: str) -> StartEntry:
        """Return one start of a motor. Raises NotFoundError."""
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            row = session.get(StartRow, recording_id)
            if row is None or row.motor != motor:
                raise NotFoundError("start", recording_id)
            return start_entry(row)

    def times_of_starts(self, motor: str, *, from_ns: int, to_ns: int) -> Sequence[int]:
        """Return when a motor was started between two times, both included, in their order."""
        query = (
            select(StartRow.time_ns)
            .where(StartRow.motor == motor, StartRow.time_ns >= from_ns, StartRow.time_ns <= to_ns)
            .order_by(StartRow.time_ns)
        )
        with self._read() as session:
            return session.scalars(query).all()

    def starts_within_hour(self, entries: Sequence[StartEntry]) -> Mapping[str, int]:
        """Return how many starts their motor had in the hour up to each of these, by id."""
        counts: dict[str, int] = {}
        motor_of = attrgetter("motor")
        for motor, of_motor in groupby(sorted(entries, key=motor_of), key=motor_of):
            together = list(of_motor)
            times = [one.time_ns for one in together]
            known = self.times_of_starts(motor, from_ns=min(times) - HOUR_NS, to_ns=max(times))
            counts |= {one.recording_id: starts_within_hour(known, one.time_ns) for one in together}
        return counts


def keep_start(
    session: Session,
    recording_id: str,
    motor: str,
    time_ns: int,
    start: ExaminedStart | None,
    *,
    is_first: bool = False,
) -> None:
    """Keep what a recording shows of a start, in place of what an earlier diagnosis found; None for none.

    is_first: there was no earlier diagnosis.
    """
    if not is_first:
        forget_start(session, recording_id)
    if start is None or not _is_finite(start.figures):
        return
    if followed_start(time_ns, start.parameters) is not None:
        follow_again(session, motor, time_ns)
    session.flush()
    row = start_row(recording_id, motor, time_ns, start)
    take_report(session, row)
    session.add(row)


def forget_start(session: Session, recording_id: str) -> None:
    """Delete what a recording showed of a start; what the relay's report tells of it stays."""
    row = session.get(StartRow, recording_id)
    if row is None:
        return
    if row.model is not None:
        follow_again(session, row.motor, row.time_ns)
    session.execute(delete(StartRow).where(StartRow.recording_id == recording_id))
    leave_report(session, row)


def _is_finite(start: MotorStart) -> bool:
    """Return whether all figures are numbers: samples near the largest number have no square."""
    curve = start.curve
    figures = [getattr(start, name) for name in FIGURES]
    known = [one for one in (*figures, *curve.current_A, *(curve.voltage_V or ())) if one is not None]
    return all(map(isfinite, known))
