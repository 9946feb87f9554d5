"""Series of recordings that were asked for as one, and the recordings joined from them."""

from sqlalchemy import exists, or_, select, update
from sqlalchemy.orm import Session, aliased

from core.diagnosis.methods import DEFAULT_METHOD, DEFAULT_MODEL
from core.operation import EXPECTED
from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from service.recording_store.recording import StoredRecording
from service.storage.models import MotorRow, ObservationRow, RecordingRequestRow, RecordingRow
from service.storage.records import Series, SeriesEnd, SeriesHistory
from service.storage.repository.recordings.folders import discard_folder, require_folder
from service.storage.repository.recordings.recordings import brought, fill, new_job, stored_before
from service.storage.repository.recordings.requests import KIND
from service.storage.repository.sessions import Sessions, found
from service.storage.states import JobPriority, RecordingRequestState, RecordingSource, RecordingState
from service.storage.texts import storable

OLDEST_NS = NANOSECONDS_PER_DAY
"""Nobody waits any longer for a series."""
LONGEST_SERIES_NS = 3600 * NANOSECONDS_PER_SECOND
"""A series that is not joined by then is no longer waited for with others."""
MOST_TRIED = 20
"""So many series of a motor are looked back at."""
LOOKED_AT = 100
"""Recordings among which one with a length is looked for."""
LONGEST_S = 30.0
"""No series is longer."""
OF_A_SERIES = "of a series, of which another recording counts in the motor's condition"
BESIDE_NS = 2 * NANOSECONDS_PER_SECOND
"""Records of a series have times within its length and so much more."""


class SeriesRows(Sessions):
    def series_to_join(self, *, now_ns: int) -> tuple[Series, ...]:
        """Return the series whose first recording is diagnosed and that were not joined yet."""
        query = select(RecordingRequestRow).where(
            RecordingRequestRow.requested_ns >= now_ns - OLDEST_NS,
            RecordingRequestRow.seconds.is_not(None),
            RecordingRequestRow.state == RecordingRequestState.DIAGNOSED,
            RecordingRequestRow.joined_recording_id.is_(None),
            RecordingRequestRow.joined_remark.is_(None),
        )
        with self._read() as session:
            requests = session.scalars(query.order_by(RecordingRequestRow.requested_ns)).all()
            return tuple(one for request in requests if (one := _series(session, request)) is not None)

    def add_joined(
        self,
        stored: StoredRecording,
        series: Series,
        parts: tuple[int, ...],
        remark: str | None,
        *,
        now_ns: int,
    ) -> str:
        """Add what a series was joined to, queue its diagnosis, and return its id; asked again, the same.

        parts: which recordings of the series it is made of.  remark: why it has no more of them.
        Raises NotFoundError, FolderGoneError.
        """
        with self._write() as session:
            found(session, MotorRow, series.motor, "motor", lock=True)
            row = stored_before(session, series.motor, None, stored.name, stored)
            if row is None:
                require_folder(session, stored)
                row = brought(session, series.motor, stored.name, RecordingSource.JOINED, now_ns)
                row.parts = tuple(series.recording_ids[part] for part in parts)
                session.execute(
                    update(RecordingRow).where(RecordingRow.id.in_(row.parts)).values(joined_id=row.id)
                )
                fill(session, row, stored, now_ns)
                session.add(new_job(row, DEFAULT_METHOD, DEFAULT_MODEL, JobPriority.UPLOAD, now_ns))
            else:
                discard_folder(session, stored.digest, now_ns)
            request = found(session, RecordingRequestRow, series.request_id, KIND, lock=True)
            request.joined_recording_id = row.id
            request.joined_remark = None if remark is None else storable(remark)
            return row.id

    def leave_unjoined(self, series: Series, remark: str) -> None:
        """Note why a series was not joined; its recordings stay as they are. Raises NotFoundError."""
        with self._write() as session:
            request = found(session, RecordingRequestRow, series.request_id, KIND, lock=True)
            request.joined_remark = storable(remark)

    def is_series_under_way(self, *, now_ns: int) -> bool:
        """Return whether a series was asked for lately and is neither joined nor given up."""
        query = select(RecordingRequestRow.id).where(
            RecordingRequestRow.requested_ns >= now_ns - LONGEST_SERIES_NS,
            RecordingRequestRow.seconds.is_not(None),
            RecordingRequestRow.state != RecordingRequestState.FAILED,
            RecordingRequestRow.joined_recording_id.is_(None),
            RecordingRequestRow.joined_remark.is_(None),
        )
        with self._read() as session:
            return session.scalars(query.limit(1)).first() is not None

    def series_history(self, motor: str) -> SeriesHistory:
        """Return when a motor was last recorded for long, and what was tried in vain since."""
        query = (
            select(RecordingRequestRow.requested_ns, RecordingRequestRow.joined_recording_id)
            .where(RecordingRequestRow.motor == motor, RecordingRequestRow.seconds.is_not(None))
            .order_by(RecordingRequestRow.requested_ns.desc())
            .limit(MOST_TRIED)
        )
        with self._read() as session:
            latest = session.execute(query).all()
        failed = 0
        for requested_ns, joined_recording_id in latest:
            if joined_recording_id is not None:
                return SeriesHistory(latest[0].requested_ns, requested_ns, failed)
            failed += 1
        return SeriesHistory(latest[0].requested_ns if latest else None, None, failed)

    def record_length(self, motor: str) -> tuple[float, float] | None:
        """Return length and pre-trigger time [s] of a motor's latest record that its relay made by a trigger.

        None where none was read yet.
        """
        query = (
            select(RecordingRow.source, RecordingRow.duration_s, RecordingRow.pre_trigger_s)
            .where(RecordingRow.motor == motor)
            .order_by(RecordingRow.announced_ns.desc(), RecordingRow.id.desc())
            .limit(LOOKED_AT)
        )
        with self._read() as session:
            latest = session.execute(query).all()
        for source, duration_s, before_s in latest:
            if source is RecordingSource.RELAY and duration_s is not None and before_s is not None:
                return duration_s, before_s
        return None


def is_counted_part(session: Session, recording: RecordingRow, recorded_ns: int) -> bool:
    """Tell whether a recording is of a series of which another one counts in the motor's condition.

    What overlaps, or follows within seconds, is not more evidence: it would narrow intervals falsely.
    """
    if recording.ied is None:
        return False
    first = aliased(RecordingRow)
    longest_ns = round(LONGEST_S * NANOSECONDS_PER_SECOND) + BESIDE_NS
    query = (
        select(RecordingRequestRow.seconds, RecordingRequestRow.recording_id, first.recorded_ns)
        .join(first, first.id == RecordingRequestRow.recording_id)
        .where(
            RecordingRequestRow.motor == recording.motor,
            RecordingRequestRow.ied == recording.ied,
            RecordingRequestRow.seconds.is_not(None),
            or_(
                first.id == recording.id,
                first.recorded_ns.between(recorded_ns - longest_ns, recorded_ns),
                # The first one waits for its diagnosis, which tells its time.
                first.recorded_ns.is_(None) & (RecordingRequestRow.triggered_ns <= recording.announced_ns),
            ),
        )
    )
    for seconds, first_id, first_ns in session.execute(query):
        length_ns = round((seconds or 0.0) * NANOSECONDS_PER_SECOND) + BESIDE_NS
        begin_ns = recorded_ns if first_id == recording.id else first_ns
        if begin_ns is None:
            begin_ns, length_ns = recorded_ns - length_ns, 2 * length_ns
        end_ns = begin_ns + length_ns
        counted = exists().where(
            ObservationRow.motor == recording.motor,
            ObservationRow.time_ns.between(begin_ns, end_ns),
            ObservationRow.recording_id == RecordingRow.id,
            RecordingRow.id != recording.id,
            RecordingRow.ied == recording.ied,
        )
        if recorded_ns <= end_ns and session.scalar(select(counted)):
            return True
    return False


def _series(session: Session, request: RecordingRequestRow) -> Series | None:
    """Return the recordings that a request has brought; None where its first one is gone."""
    first = None if request.recording_id is None else session.get(RecordingRow, request.recording_id)
    if first is None or first.recorded_ns is None or first.digest is None:
        return None
    length_ns = round((request.seconds or 0.0) * NANOSECONDS_PER_SECOND) + BESIDE_NS
    query = (
        select(RecordingRow)
        .where(
            RecordingRow.motor == request.motor,
            RecordingRow.ied == request.ied,
            RecordingRow.recorded_ns >= first.recorded_ns,
            RecordingRow.recorded_ns <= first.recorded_ns + length_ns,
            RecordingRow.digest.is_not(None),
            RecordingRow.copy_of.is_(None),
        )
        .order_by(RecordingRow.recorded_ns, RecordingRow.id)
    )
    rows = session.scalars(query).all()
    end = next((number for number, row in enumerate(rows) if row.operation in EXPECTED), len(rows))
    running = rows[:end]
    return Series(
        request.id,
        request.motor,
        tuple(row.id for row in running),
        tuple(row.digest for row in running if row.digest is not None),
        tuple(row.recorded_ns for row in running if row.recorded_ns is not None),
        ended_by=_end(rows[end]) if end < len(rows) else None,
        # A recording that waits for its diagnosis may be the one of the trip.
        is_complete=(end < len(rows) or len(rows) >= (request.triggers or 1))
        and all(row.state is not RecordingState.FETCHED for row in running),
    )


def _end(row: RecordingRow) -> SeriesEnd:
    assert row.recorded_ns is not None  # noqa: S101 - the query asks for it
    assert row.operation is not None  # noqa: S101 - it is one of EXPECTED
    return SeriesEnd(row.name, row.recorded_ns, row.operation)
