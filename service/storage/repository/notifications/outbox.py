"""Messages that wait: taken by who sends them, sent, tried again, given up.

An attempt is counted before it is made. A message thus reaches its receiver at most as often as its
`attempts` tell. It comes a second time only where the first attempt ended without an answer: the service was
killed, or the connection broke, after the receiver had taken it.
"""

import uuid
from collections.abc import Collection, Mapping, Sequence

from sqlalchemy import delete, func, or_, select

from service.audit.actions import AuditAction
from service.storage.engine import one_at_a_time
from service.storage.errors import StateConflictError, TooManyTestsError
from service.storage.models import NotificationRow
from service.storage.records import NewNotification, Notification
from service.storage.records.actors import Actor
from service.storage.repository.audit.entries import note_change
from service.storage.repository.notifications.composing import compose
from service.storage.repository.sessions import Sessions, found, has_as_many, only, record_of
from service.storage.states import NotificationKind, NotificationState
from service.storage.texts import storable
from service.timing.backoff import Backoff

INTERRUPTED = "the service ended while it sent the message; the receiver may have it"
NOTHING_LEFT = "there was nothing left to tell: acknowledged, over, or told by another alarm"

POSTPONED_NS = 60 * 10**9
LONGEST_POSTPONED_NS = 7 * 86_400 * 10**9
"""An escalation waits so long, minute by minute, for the cause of an alarm that comes and goes."""

MOST_TESTS = 100
"""So many tests of a channel may wait."""


class OutboxRows(Sessions):
    def add_notifications(self, new: Sequence[NewNotification], *, now_ns: int) -> tuple[Notification, ...]:
        """Queue messages, and return those that are new: of each key there is one, for ever."""
        with self._write() as session:
            one_at_a_time(session.connection(), "add messages")
            keys = {one.key for one in new if one.key is not None}
            known = set(session.scalars(select(NotificationRow.key).where(NotificationRow.key.in_(keys))))
            rows = [_new_row(one, now_ns) for one in new if one.key is None or one.key not in known]
            session.add_all(rows)
            session.flush()
            return tuple(record_of(Notification, row) for row in rows)

    def claim_notification(self, channel: str, *, claim: str, now_ns: int) -> Notification | None:
        """Take the next message of a channel that is due, and count the attempt; None without any.

        One that was made later than now is of a time before the clock was set back: it is due. claim: tells
        this attempt from all others.
        """
        made_ns = func.coalesce(NotificationRow.tried_ns, NotificationRow.created_ns)
        query = (
            select(NotificationRow)
            .where(
                NotificationRow.state == NotificationState.QUEUED,
                NotificationRow.channel == channel,
                or_(NotificationRow.not_before_ns <= now_ns, made_ns > now_ns),
            )
            .order_by(NotificationRow.not_before_ns, NotificationRow.id)
        )
        with self._read() as session:
            if session.scalars(query.with_only_columns(NotificationRow.id).limit(1)).first() is None:
                return None
        with self._write() as session:
            while True:
                row = only(session, query.with_for_update(skip_locked=True))
                if row is None:
                    return None
                if row.document is None:
                    row.document, waits = compose(session, row)
                    if row.document is None:
                        _put_off(row, now_ns, waits=waits)
                        session.flush()
                        continue
                row.state, row.claim, row.tried_ns = NotificationState.SENDING, claim, now_ns
                row.attempts += 1
                session.flush()
                return record_of(Notification, row)

    def finish_notification(self, notification_id: str, *, claim: str, now_ns: int) -> bool:
        """Note that a message was sent; False where another has taken it over meanwhile."""
        with self._write() as session:
            row = found(session, NotificationRow, notification_id, "notification", lock=True)
            if row.claim != claim:
                return False
            _finish(row, NotificationState.SENT, None, now_ns)
            return True

    def fail_notification(
        self,
        notification_id: str,
        error: str,
        *,
        claim: str,
        now_ns: int,
        most_attempts: int,
        backoff: Backoff,
        is_final: bool,
    ) -> NotificationState | None:
        """Queue a message again after a pause, or give it up; return its state, None where it is not ours.

        is_final: another attempt would fail as well. A test is not tried again: somebody waits for it.
        """
        with self._write() as session:
            row = found(session, NotificationRow, notification_id, "notification", lock=True)
            if row.claim != claim:
                return None
            is_over = is_final or row.attempts >= most_attempts or row.kind is NotificationKind.TEST
            if is_over:
                _finish(row, NotificationState.DEAD, error, now_ns)
            else:
                pause_s = backoff.pause_s(row.attempts)
                _queue(row, error, not_before_ns=now_ns + round(pause_s * 1e9))
            return row.state

    def claims(self) -> Mapping[str, str]:
        """Return the messages that are being sent, each with the claim on it."""
        query = select(NotificationRow.id, NotificationRow.claim).where(
            NotificationRow.state == NotificationState.SENDING
        )
        with self._read() as session:
            return {notification: claim or "" for notification, claim in session.execute(query)}

    def release_claims(self, claims: Collection[str], *, now_ns: int, most_attempts: int) -> int:
        """Queue the messages again whose senders are dead; return how many they are."""
        if not claims:
            return 0
        with self._write() as session:
            query = select(NotificationRow).where(
                NotificationRow.state == NotificationState.SENDING, NotificationRow.claim.in_(claims)
            )
            rows = session.scalars(query.with_for_update()).all()
            for row in rows:
                if row.attempts >= most_attempts or row.kind is NotificationKind.TEST:
                    _finish(row, NotificationState.DEAD, INTERRUPTED, now_ns)
                else:
                    _queue(row, INTERRUPTED, not_before_ns=now_ns)
            return len(rows)

    def request_test_notifications(
        self, channel: str, recipients: Sequence[str], *, by: Actor, now_ns: int
    ) -> tuple[Notification, ...]:
        """Queue a test for each receiver of a channel. Raises TooManyTestsError."""
        waiting = select(NotificationRow.id).where(
            NotificationRow.channel == channel,
            NotificationRow.kind == NotificationKind.TEST,
            NotificationRow.state.in_((NotificationState.QUEUED, NotificationState.SENDING)),
        )
        document: Mapping[str, object] = {"by": by.name}
        with self._write() as session:
            if has_as_many(session, waiting, MOST_TESTS):
                raise TooManyTestsError(channel, MOST_TESTS)
            rows = [
                _new_row(NewNotification(NotificationKind.TEST, channel, one, document), now_ns)
                for one in recipients
            ]
            session.add_all(rows)
            note_change(session, by, AuditAction.CHANNEL_TESTED, ("channel", channel), now_ns=now_ns)
            session.flush()
            return tuple(record_of(Notification, row) for row in rows)

    def retry_notification(self, notification_id: str, *, by: Actor, now_ns: int) -> Notification:
        """Queue a message again that was given up. Raises NotFoundError, StateConflictError."""
        with self._write() as session:
            row = found(session, NotificationRow, notification_id, "notification", lock=True)
            if row.state is not NotificationState.DEAD:
                raise StateConflictError(
                    "notification", notification_id, present=row.state, wanted=NotificationState.QUEUED
                )
            before = {"attempts": row.attempts, "error": row.error}
            subject = ("notification", notification_id)
            note_change(session, by, AuditAction.NOTIFICATION_RETRIED, subject, now_ns=now_ns, before=before)
            row.attempts, row.finished_ns = 0, None
            _queue(row, row.error, not_before_ns=now_ns)
            session.flush()
            return record_of(Notification, row)

    def give_up_unknown(self, channels: Collection[str], *, before_ns: int, now_ns: int) -> int:
        """Give up the messages made before a time for channels that there are not; return how many."""
        unknown = [
            NotificationRow.state == NotificationState.QUEUED,
            NotificationRow.channel.not_in(channels),
            NotificationRow.created_ns < before_ns,
        ]
        with self._read() as session:
            if session.scalars(select(NotificationRow.id).where(*unknown).limit(1)).first() is None:
                return 0
        with self._write() as session:
            rows = session.scalars(select(NotificationRow).where(*unknown).with_for_update()).all()
            for row in rows:
                _finish(row, NotificationState.DEAD, f"the settings have no channel {row.channel}", now_ns)
            return len(rows)

    def forget_notifications(self, *, before_ns: int, limit: int = 1000) -> int:
        """Delete messages that were sent, given up or withdrawn before a time; return how many."""
        old = select(NotificationRow.id).where(NotificationRow.finished_ns < before_ns).limit(limit)
        with self._read() as session:
            if session.scalars(old.limit(1)).first() is None:
                return 0
        with self._write() as session:
            ids = session.scalars(old).all()
            session.execute(delete(NotificationRow).where(NotificationRow.id.in_(ids)))
            return len(ids)


def _new_row(new: NewNotification, now_ns: int) -> NotificationRow:
    return NotificationRow(
        id=str(uuid.uuid4()),
        kind=new.kind,
        state=NotificationState.QUEUED,
        channel=new.channel,
        recipient=new.recipient,
        key=new.key,
        document=new.document,
        is_held=False,
        created_ns=now_ns,
        closes_ns=now_ns,
        not_before_ns=now_ns,
        attempts=0,
    )


def _put_off(row: NotificationRow, now_ns: int, *, waits: bool) -> None:
    """Look at a message again later that has nothing to say now, or withdraw it."""
    if waits and 0 <= now_ns - row.created_ns < LONGEST_POSTPONED_NS:
        row.not_before_ns, row.tried_ns = now_ns + POSTPONED_NS, now_ns
    else:
        _finish(row, NotificationState.WITHDRAWN, NOTHING_LEFT, now_ns)


def _queue(row: NotificationRow, error: str | None, *, not_before_ns: int) -> None:
    row.state, row.claim, row.not_before_ns = NotificationState.QUEUED, None, not_before_ns
    row.error = None if error is None else storable(error)


def _finish(row: NotificationRow, state: NotificationState, error: str | None, now_ns: int) -> None:
    row.state, row.claim, row.finished_ns = state, None, now_ns
    row.error = None if error is None else storable(error)
