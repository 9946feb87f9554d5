"""Recordings of one event in several formats: the finest counts, the others are named as its copies."""

from collections.abc import Sequence

from sqlalchemy import delete, select, update
from sqlalchemy.orm import Session

from core.condition.copies import SAME_TIME_NS, Outline, is_copy
from core.diagnosis.methods import DEFAULT_METHOD, DEFAULT_MODEL
from service.storage.models import DiagnosisRow, OutlineRow, RecordingRow
from service.storage.records import RecordingEntry
from service.storage.repository.conditions.observations import forget_observation
from service.storage.repository.history.record_figures import forget_record_figures
from service.storage.repository.history.rotor import forget_rotor_finding
from service.storage.repository.history.starts import forget_start
from service.storage.repository.recordings.recordings import new_job
from service.storage.repository.sessions import Sessions, record_of
from service.storage.states import JobPriority
from service.storage.texts import storable


class CopyRows(Sessions):
    def copies_of(self, recording_id: str) -> tuple[RecordingEntry, ...]:
        """Return the copies of a recording, in whose place it counts."""
        with self._read() as session:
            return tuple(record_of(RecordingEntry, one) for one in _copies(session, recording_id))


def settle_copies(
    session: Session, recording: RecordingRow, outline: Outline | None, now_ns: int, *, is_first: bool
) -> str | None:
    """Have the finest recording of an event count, and name the others as its copies.

    Of recordings as fine as each other the one counts that did before. One that a rule of retention deleted
    counts on: what it told of its motor is still there.

    outline: of the recording that is being diagnosed; None where it cannot have copies.  is_first: it was
    never diagnosed before.
    Returns why it does not count, for people; None where it counts.
    """
    if not is_first:
        forget_outline(session, recording.id)
    others = [] if outline is None else _others_of_the_event(session, recording.motor, outline)
    if not is_first:
        ids = {other.recording_id for other in others}
        _release(session, [one for one in _copies(session, recording.id) if one.id not in ids], now_ns)
    if outline is None:
        recording.copy_of = None
        return None
    own = _outline_row(recording, outline)
    session.add(own)
    session.flush()
    rows = {one.recording_id: session.get(RecordingRow, one.recording_id) for one in (*others, own)}
    counting = min((*others, own), key=lambda one: _order(one, rows[one.recording_id], is_new=one is own))
    for one in (*others, own):
        row = rows[one.recording_id]
        if row is not None and one is not counting:
            _make_copy(session, row, counting.recording_id, rows[counting.recording_id])
    if counting is not own:
        return recording.reason
    recording.copy_of = None
    return None


def release_copies(session: Session, recording: RecordingRow, now_ns: int) -> None:
    """Have the copies of a recording that is deleted diagnosed again: one of them counts in its place."""
    _release(session, _copies(session, recording.id), now_ns)


def forget_outline(session: Session, recording_id: str) -> None:
    """Have a recording no longer found as one of an event."""
    session.execute(delete(OutlineRow).where(OutlineRow.recording_id == recording_id))


def _others_of_the_event(session: Session, motor: str, outline: Outline) -> list[OutlineRow]:
    near = select(OutlineRow).where(
        OutlineRow.motor == motor,
        OutlineRow.time_ns.between(outline.time_ns - SAME_TIME_NS, outline.time_ns + SAME_TIME_NS),
    )
    return [row for row in session.scalars(near) if is_copy(outline, record_of(Outline, row))]


def _order(one: OutlineRow, row: RecordingRow | None, *, is_new: bool) -> tuple[bool, int, bool, bool]:
    """Return what the recordings of an event are sorted by. The first one counts."""
    return row is not None, one.fidelity, row is not None and row.copy_of is not None, is_new


def _make_copy(session: Session, row: RecordingRow, counting_id: str, counting: RecordingRow | None) -> None:
    """Name a recording as a copy; nothing of what it tells counts any more."""
    name = "" if counting is None else f"{counting.name} "
    row.copy_of = counting_id
    row.reason = storable(f"a copy of recording {name}({counting_id}): the same event, which counts once")
    of_row = (DiagnosisRow.recording_id == row.id, DiagnosisRow.current)
    session.execute(update(DiagnosisRow).where(*of_row).values(says_nothing=True))
    forget_observation(session, row.id)
    forget_start(session, row.id)
    forget_rotor_finding(session, row.id)
    forget_record_figures(session, row.id)


def _copies(session: Session, recording_id: str) -> Sequence[RecordingRow]:
    query = select(RecordingRow).where(RecordingRow.copy_of == recording_id)
    return session.scalars(query.order_by(RecordingRow.announced_ns, RecordingRow.id)).all()


def _release(session: Session, rows: Sequence[RecordingRow], now_ns: int) -> None:
    """Have copies diagnosed again as recordings that may count."""
    for row in rows:
        row.copy_of, row.reason = None, None
        forget_outline(session, row.id)
        session.add(new_job(row, DEFAULT_METHOD, DEFAULT_MODEL, JobPriority.REPETITION, now_ns))
    session.flush()


def _outline_row(recording: RecordingRow, outline: Outline) -> OutlineRow:
    return OutlineRow(
        recording_id=recording.id,
        motor=recording.motor,
        time_ns=outline.time_ns,
        fidelity=int(outline.fidelity),
        currents_A=outline.currents_A,
        voltages_V=outline.voltages_V,
    )
