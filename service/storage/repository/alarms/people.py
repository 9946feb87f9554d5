"""What people do about alarms. A step that is not possible is refused with what is."""

from sqlalchemy.orm import Session

from service.storage.models import AlarmRow
from service.storage.records import Alarm
from service.storage.repository.alarms.changes import change
from service.storage.repository.alarms.suppression import suppress_by_design
from service.storage.repository.sessions import Sessions, found, record_of
from service.storage.states import AlarmEvent


class AlarmPeopleRows(Sessions):
    def acknowledge_alarm(self, alarm_id: str, *, by: str, now_ns: int, comment: str | None = None) -> Alarm:
        """Note that somebody has taken notice of an alarm. Raises NotFoundError, AlarmActionError."""
        return self._do(alarm_id, AlarmEvent.ACKNOWLEDGED, by, now_ns, comment)

    def shelve_alarm(
        self,
        alarm_id: str,
        *,
        by: str,
        now_ns: int,
        until_ns: int | None = None,
        growth: float | None = None,
        comment: str | None = None,
    ) -> Alarm:
        """Set an alarm aside until a time, until its value has grown by so much, or whichever comes first.

        Raises NotFoundError, AlarmActionError, ValueError (no end, or growth of an alarm without a value).
        """
        with self._write() as session:
            row = found(session, AlarmRow, alarm_id, "alarm", lock=True)
            if until_ns is None and growth is None:
                raise ValueError("expected a time, or by how much it may grow, at which the shelving ends")
            if growth is not None and row.value is None:
                raise ValueError(f"alarm {alarm_id} ({row.kind.value}) has no value that could grow")
            _change(session, row, AlarmEvent.SHELVED, by, now_ns, comment)
            row.shelved_until_ns = until_ns
            row.shelved_above = None if growth is None or row.value is None else row.value + growth
            return record_of(Alarm, row)

    def unshelve_alarm(self, alarm_id: str, *, by: str, now_ns: int, comment: str | None = None) -> Alarm:
        """End the shelving of an alarm: it calls again if its cause stands.

        Raises NotFoundError, AlarmActionError.
        """
        return self._do(alarm_id, AlarmEvent.UNSHELVED, by, now_ns, comment)

    def take_alarm_out_of_service(
        self, alarm_id: str, *, by: str, now_ns: int, comment: str | None = None
    ) -> Alarm:
        """Set an alarm aside until somebody puts it back. Raises NotFoundError, AlarmActionError."""
        return self._do(alarm_id, AlarmEvent.TAKEN_OUT_OF_SERVICE, by, now_ns, comment)

    def put_alarm_back_in_service(
        self, alarm_id: str, *, by: str, now_ns: int, comment: str | None = None
    ) -> Alarm:
        """Have an alarm call again, if its cause stands. Raises NotFoundError, AlarmActionError."""
        return self._do(alarm_id, AlarmEvent.PUT_BACK_IN_SERVICE, by, now_ns, comment)

    def _do(self, alarm_id: str, event: AlarmEvent, by: str, now_ns: int, comment: str | None) -> Alarm:
        with self._write() as session:
            row = found(session, AlarmRow, alarm_id, "alarm", lock=True)
            _change(session, row, event, by, now_ns, comment)
            return record_of(Alarm, row)


def _change(
    session: Session, row: AlarmRow, event: AlarmEvent, by: str, now_ns: int, comment: str | None
) -> None:
    if event in {AlarmEvent.ACKNOWLEDGED, AlarmEvent.SHELVED}:
        row.seen_value = row.value
    change(session, row, event, now_ns=now_ns, by=by, comment=comment)
    suppress_by_design(session, row, now_ns=now_ns)
