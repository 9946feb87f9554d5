"""The alarms of one relay: each is raised once, however often its cause is seen, until that is gone."""

import time
from collections.abc import Collection
from functools import cached_property

import structlog

from service.collector.session.session_policy import SESSION_POLICY
from service.storage import Repository
from service.storage.states import AlarmKind

log = structlog.get_logger(__name__)

AND_MORE = "(and more)"


class RelayAlarms:
    """The standing alarms of one relay, raised and cleared by that relay's session alone.

    No other process changes them, so they are read from the database once, when they are first needed.
    """

    def __init__(self, relay: str, repository: Repository, *, most: int = SESSION_POLICY.most_alarms) -> None:
        """Read nothing yet.

        most: so many alarms of a kind stand; one more says that there are others.
        """
        self._relay = relay
        self._repository = repository
        self._most = most

    @cached_property
    def _standing(self) -> dict[tuple[AlarmKind, str], str]:
        """Return the ids of the standing alarms. Raises SQLAlchemyError."""
        return {
            (alarm.kind, alarm.subject): alarm.id for alarm in self._repository.standing_alarms(self._relay)
        }

    def standing(self, kind: AlarmKind) -> frozenset[str]:
        """Return the subjects of the standing alarms of this kind. Raises SQLAlchemyError."""
        return frozenset(subject for of_kind, subject in self._standing if of_kind is kind)

    def raise_alarm(self, kind: AlarmKind, subject: str, reason: str) -> None:
        """Raise an alarm unless it stands already. Raises SQLAlchemyError."""
        if (kind, subject) in self._standing:
            return
        if len(self.standing(kind)) >= self._most:
            subject, reason = AND_MORE, f"more than {self._most} of this kind; the others are not listed"
            if (kind, subject) in self._standing:
                return
        alarm = self._repository.raise_alarm(self._relay, kind, subject, reason, now_ns=time.time_ns())
        self._standing[kind, subject] = alarm.id
        log.warning("alarm", relay=self._relay, kind=str(kind), subject=subject, reason=reason)

    def keep(self, kind: AlarmKind, subjects: Collection[str]) -> None:
        """Clear the alarms of this kind whose subject is not among these. Raises SQLAlchemyError."""
        over = [
            key
            for key in self._standing
            if key[0] is kind and key[1] not in subjects and not (key[1] == AND_MORE and subjects)
        ]
        if not over:
            return
        ids = [self._standing[key] for key in over]
        self._repository.clear_alarms(self._relay, ids, now_ns=time.time_ns())
        for key in over:
            del self._standing[key]
            log.info("alarm over", relay=self._relay, kind=str(key[0]), subject=key[1])
