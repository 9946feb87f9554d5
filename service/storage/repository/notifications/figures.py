"""Figures of alarms for digests: how often they called in a time, and the states of those not over."""

from collections.abc import Collection, Mapping

from sqlalchemy import func, select

from service.storage.models import AlarmChangeRow, AlarmRow, NotificationRow
from service.storage.models.alarms import is_open
from service.storage.repository.sessions import Sessions
from service.storage.states import AlarmKind, AlarmState, NotificationState


class AlarmFigureRows(Sessions):
    def calls_of_alarms(
        self, *, from_ns: int, to_ns: int, sites: Collection[str] | None = None
    ) -> Mapping[AlarmKind, int]:
        """Return how often alarms of each kind called, from_ns <= time < to_ns; sites: None for all."""
        query = (
            select(AlarmRow.kind, func.count())
            .join(AlarmChangeRow, AlarmChangeRow.alarm == AlarmRow.id)
            .where(
                AlarmChangeRow.after == AlarmState.UNACKNOWLEDGED,
                AlarmChangeRow.before != AlarmState.UNACKNOWLEDGED,
                AlarmChangeRow.changed_ns >= from_ns,
                AlarmChangeRow.changed_ns < to_ns,
            )
            .group_by(AlarmRow.kind)
        )
        if sites is not None:
            query = query.where(AlarmRow.site.in_(sites))
        with self._read() as session:
            return dict(session.execute(query).all())

    def open_alarm_states(self, *, sites: Collection[str] | None = None) -> Mapping[AlarmState, int]:
        """Return how many alarms are in each state, of those that are not over; sites: None for all."""
        query = select(AlarmRow.state, func.count()).where(is_open()).group_by(AlarmRow.state)
        if sites is not None:
            query = query.where(AlarmRow.site.in_(sites))
        with self._read() as session:
            return dict(session.execute(query).all())

    def given_up_notifications(self, *, from_ns: int, to_ns: int) -> int:
        """Return how many messages were given up, from_ns <= time < to_ns."""
        query = select(func.count()).where(
            NotificationRow.state == NotificationState.DEAD,
            NotificationRow.finished_ns >= from_ns,
            NotificationRow.finished_ns < to_ns,
        )
        with self._read() as session:
            return session.scalar(query) or 0

    def is_known_notification(self, key: str) -> bool:
        """Tell whether a message that is made once only was made."""
        with self._read() as session:
            query = select(NotificationRow.id).where(NotificationRow.key == key).limit(1)
            return session.scalars(query).first() is not None
