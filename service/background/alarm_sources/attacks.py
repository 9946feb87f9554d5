"""Attempts to get in, by the audit trail: `password-guessing`, `forged-tokens` and `owner-locked`."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Final

from core.units import NANOSECONDS_PER_SECOND, SECONDS_PER_HOUR
from service.alarms.confirmation import Decision
from service.alarms.kinds import AlarmKind
from service.audit.actions import AuditAction
from service.background.alarm_sources.standing import StandingAlarms
from service.storage import Repository
from service.storage.records import AlarmPlace, AlarmSpec, Role
from service.storage.records.alarm_sources import AlarmFinding, NotedRefusal

LOOKED_BACK_S: Final = SECONDS_PER_HOUR
"""An alarm is over when nothing of its kind came for so long."""

MOST_FAILED: Final = 20
"""So many logins may fail within that time, by people who mistype."""

MOST_TOKENS: Final = 10
"""So many requests with a token that is none may come, as from a program whose token has just expired."""

MOST_NAMED: Final = 3


class AttackSource:
    """Looks through the entries of the last hour, whichever process wrote them."""

    def __init__(self, repository: Repository) -> None:
        self._repository = repository

    def findings(self, now_ns: int) -> Iterator[AlarmFinding]:
        """Yield what has changed. Raises SQLAlchemyError."""
        since_ns = now_ns - round(LOOKED_BACK_S * NANOSECONDS_PER_SECOND)
        noted = self._repository.refusals_since(since_ns)
        reasons = {
            AlarmKind.PASSWORD_GUESSING: _guessing(noted),
            AlarmKind.FORGED_TOKENS: _forged(noted),
            AlarmKind.OWNER_LOCKED: _locked(noted, self._owners()),
        }
        standing = StandingAlarms(self._repository, *reasons)
        for kind, reason in reasons.items():
            stands = standing.of(kind, "")
            if reason is None and stands is None:
                continue
            spec = AlarmSpec(kind, reason or "", one_of_kind=True)
            decision = Decision.CLEAR if reason is None else Decision.RAISE
            finding = standing.finding("", AlarmPlace(), spec, decision, "none came for an hour")
            if finding is not None:
                yield finding

    def _owners(self) -> frozenset[str]:
        return self._repository.users_with(Role.SECADM)


def _guessing(noted: Sequence[NotedRefusal]) -> str | None:
    failed = [one for one in noted if one.action is AuditAction.LOGIN_FAILED]
    locked = [one for one in noted if one.action is AuditAction.LOGIN_LOCKED]
    if not locked and len(failed) <= MOST_FAILED:
        return None
    return f"logins failed within an hour, {_from_where(locked or failed)}"


def _forged(noted: Sequence[NotedRefusal]) -> str | None:
    found = [one for one in noted if one.action is AuditAction.TOKEN_REFUSED]
    if sum(one.requests for one in found) <= MOST_TOKENS:
        return None
    return f"requests came with tokens that are unknown, revoked or expired, {_from_where(found)}"


def _locked(noted: Sequence[NotedRefusal], owners: frozenset[str]) -> str | None:
    locked = {one.subject for one in noted if one.action is AuditAction.LOGIN_LOCKED} & owners
    if not locked:
        return None
    return f"too many logins failed of {', '.join(sorted(locked))}, who may manage users"


def _from_where(noted: Sequence[NotedRefusal]) -> str:
    """Return the addresses that most came from. The words stay the same while no other address comes."""
    counts: Mapping[str, int] = Counter(one.origin for one in noted)
    named = sorted(counts, key=lambda origin: (-counts[origin], origin))
    more = len(named) - MOST_NAMED
    others = f" and {more} other addresses" if more > 0 else ""
    return f"from {', '.join(sorted(named[:MOST_NAMED]))}{others}"
