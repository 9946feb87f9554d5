"""Starts by motor start reports: rows of their own, or joined with the recording of the same start."""

from collections.abc import Mapping, Sequence
from typing import Any, Final
from uuid import NAMESPACE_OID, uuid5

from sqlalchemy import select
from sqlalchemy.orm import Session

from core.units import NANOSECONDS_PER_SECOND
from service.audit.actions import AuditAction
from service.storage.models import MotorRow, StartRow
from service.storage.records import ImportedStart, ReportedStart, ReportOutcome
from service.storage.records.actors import Actor
from service.storage.repository.alarms.starts import settle_start_alarms
from service.storage.repository.audit.entries import note_change
from service.storage.repository.conditions.motor_conditions import settle_beside_fold
from service.storage.repository.history.start_documents import report_document, reported_start, start_row
from service.storage.repository.sessions import Sessions, found
from service.storage.states import StartSource

SAME_START_NS: Final = 5 * NANOSECONDS_PER_SECOND
"""A report and a recording that are no farther apart tell of one start: a relay may trigger late in it."""


class StartReportRows(Sessions):
    def add_reported_starts(
        self, motor: str, starts: Sequence[ReportedStart], *, by: Actor | None, now_ns: int
    ) -> tuple[ImportedStart, ...]:
        """Keep the starts of a relay's report; what is kept of them already stays as it is.

        by: None leaves no entry in the audit trail.  Raises NotFoundError.
        """
        with self._write() as session:
            row = found(session, MotorRow, motor, "motor", lock=True)
            imported = tuple(_import(session, motor, start) for start in starts)
            counts = {
                outcome.value: sum(one.outcome is outcome for one in imported) for outcome in ReportOutcome
            }
            is_new = counts[ReportOutcome.ADDED] or counts[ReportOutcome.JOINED]
            if is_new and by is not None:
                action, after = AuditAction.REPORT_IMPORTED, {"report": "MSR", **counts}
                note_change(session, by, action, ("motor", motor), now_ns=now_ns, after=after)
            if is_new:
                settle_start_alarms(session, row, now_ns=now_ns)
                settle_beside_fold(session, motor, now_ns=now_ns)
            return imported


def take_report(session: Session, row: StartRow) -> None:
    """Join a recorded start that is new with the report of the same start, where one is kept."""
    nearest = _nearest(session, row.motor, row.time_ns, StartSource.REPORT)
    if nearest is not None:
        row.report = nearest.report
        session.delete(nearest)


def leave_report(session: Session, row: StartRow) -> None:
    """Keep what a report tells of a start whose recording shows it no more."""
    if row.source is StartSource.RECORDING and row.report is not None:
        session.add(_row(row.motor, row.report))


def _import(session: Session, motor: str, start: ReportedStart) -> ImportedStart:
    document = report_document(start)
    own_id = _id(motor, start.time_ns)
    own = session.get(StartRow, own_id)
    recorded = _nearest(session, motor, start.time_ns, StartSource.RECORDING, reported_ns=start.time_ns)
    row = own if recorded is None else recorded
    if row is not None and row.report == document and (recorded is None or own is None):
        return ImportedStart(row.recording_id, start.time_ns, ReportOutcome.KNOWN)
    if own is not None:
        session.delete(own)
        session.flush()
    if recorded is None:
        session.add(_row(motor, document))
        outcome = ReportOutcome.ADDED
    else:
        recorded.report = document
        outcome = ReportOutcome.JOINED
    session.flush()
    return ImportedStart(own_id if recorded is None else recorded.recording_id, start.time_ns, outcome)


def _nearest(
    session: Session, motor: str, time_ns: int, source: StartSource, *, reported_ns: int | None = None
) -> StartRow | None:
    """Return the start that is nearest to a time and may be the same; None where none is.

    reported_ns: of recorded starts, only those without a report, or with the one of that time.
    """
    query = select(StartRow).where(
        StartRow.motor == motor,
        StartRow.source == source,
        StartRow.time_ns >= time_ns - SAME_START_NS,
        StartRow.time_ns <= time_ns + SAME_START_NS,
    )
    near = [
        row
        for row in session.scalars(query)
        if source is StartSource.REPORT or row.report is None or row.report["time_ns"] == reported_ns
    ]
    return min(near, key=lambda row: abs(row.time_ns - time_ns), default=None)


def _row(motor: str, document: Mapping[str, Any]) -> StartRow:
    start = reported_start(document)
    row = start_row(_id(motor, start.time_ns), motor, start.time_ns, start.examined)
    row.source, row.report = StartSource.REPORT, document
    return row


def _id(motor: str, time_ns: int) -> str:
    return str(uuid5(NAMESPACE_OID, f"motor start report: {time_ns} of {motor}"))
