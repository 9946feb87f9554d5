"""Requests that were refused: counted, and written into the audit trail, which they cannot fill."""

import time
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from threading import Lock
from typing import Final

import structlog
from sqlalchemy.exc import SQLAlchemyError
from structlog.typing import FilteringBoundLogger

from service.audit.actions import AuditAction
from service.storage import Repository
from service.storage.records import Actor
from service.timing.database_silence import database_trouble, does_not_answer

log: FilteringBoundLogger = structlog.get_logger(__name__)

PERIOD_S: Final = 60.0
"""The same caller leaves one entry at once, and one more in so long for all that follow."""

MOST_CALLERS: Final = 50
"""So many callers leave entries of their own within a period; all others share one."""

LONGEST_REQUEST: Final = 200

NOBODY: Final = "(nobody)"
"""The audit trail has this in place of the name of who is not known."""


class Refusal(StrEnum):
    """Why a request was refused. The words are labels of the figure in GET /metrics."""

    PERMISSION = "permission"
    """By the caller's roles, or by the scope of their token."""
    TOKEN = "token"  # noqa: S105 - the word for one
    """A token that is unknown, revoked or expired."""
    SESSION = "session"
    """A session that has ended, or never was."""
    LOGIN = "login"
    """A name, password or code that is wrong; the audit trail has an entry of its own for each."""
    LOCKED = "locked"
    """A login during the pause that follows too many that failed."""
    ANONYMOUS = "anonymous"
    """Somebody who does not say who they are, such as a browser before the login."""


ACTIONS: Final[Mapping[Refusal, AuditAction]] = {
    Refusal.PERMISSION: AuditAction.REQUEST_REFUSED,
    Refusal.TOKEN: AuditAction.TOKEN_REFUSED,
    Refusal.SESSION: AuditAction.SESSION_REFUSED,
    Refusal.LOCKED: AuditAction.LOGIN_REFUSED,
}
"""The entries that refusals leave here; the others are counted alone."""

Caller = tuple[Refusal, str, str]
"""Of whom entries are bounded: the kind, the name, the address."""


@dataclass(slots=True)
class _Waiting:
    """What followed an entry. ends_s: another one may be written from then on."""

    actor: Actor
    request: str
    ends_s: float
    requests: int = 0


class Refusals:
    """Counts refusals since the start, and has entries written. For use by many threads."""

    def __init__(self, period_s: float = PERIOD_S) -> None:
        self._period_s = period_s
        self._lock = Lock()
        self._counts: Counter[Refusal] = Counter()
        self._waiting: dict[Caller, _Waiting] = {}

    def counts(self) -> Mapping[Refusal, int]:
        """Return how many requests were refused for each reason; 0 for a reason that never was."""
        with self._lock:
            return {refusal: self._counts[refusal] for refusal in Refusal}

    def note(self, repository: Repository, refusal: Refusal, actor: Actor, request: str) -> None:
        """Count a refusal, and write an entry where its caller has left none for a while.

        request: what was asked for, as its method and path.
        """
        now_s = time.monotonic()
        with self._lock:
            self._counts[refusal] += 1
            if refusal not in ACTIONS:
                return
            key = (refusal, actor.name, actor.origin)
            if key not in self._waiting and len(self._waiting) >= MOST_CALLERS:
                actor = Actor("(others)", "(others)")
                key = (refusal, actor.name, actor.origin)
            waiting = self._waiting.get(key)
            if waiting is not None:
                waiting.requests += 1
                return
            self._waiting[key] = _Waiting(actor, request[:LONGEST_REQUEST], now_s + self._period_s)
        self._write(repository, refusal, actor, request[:LONGEST_REQUEST], 1)

    def settle(self, repository: Repository, *, ending: bool = False) -> None:
        """Write the entries of what followed others whose period is over; of all, where the service ends."""
        now_s = time.monotonic()
        with self._lock:
            over = {key: one for key, one in self._waiting.items() if ending or one.ends_s <= now_s}
            for key, one in over.items():
                if one.requests and not ending:  # it goes on, perhaps: nothing is written at once
                    self._waiting[key] = _Waiting(one.actor, one.request, now_s + self._period_s)
                else:
                    del self._waiting[key]
        for (refusal, _, _), one in over.items():
            if one.requests:
                self._write(repository, refusal, one.actor, one.request, one.requests)

    def _write(
        self, repository: Repository, refusal: Refusal, actor: Actor, request: str, requests: int
    ) -> None:
        """Write an entry and a line of the log. The caller is refused also where nothing can be written."""
        told = log.bind(refusal=refusal.value, actor=actor.name, origin=actor.origin, request=request)
        told.warning("requests were refused", requests=requests)
        try:
            repository.note_by(
                actor,
                ACTIONS[refusal],
                ("request", request),
                now_ns=time.time_ns(),
                after={"requests": requests},
            )
        except SQLAlchemyError as error:
            if not does_not_answer(error):
                raise
            told.error("the audit trail does not have the refusal", error=database_trouble(error))
