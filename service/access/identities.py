"""Who a secret belongs to, and what its owner may do with it now."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from functools import partial

import structlog
from sqlalchemy.exc import SQLAlchemyError
from structlog.typing import FilteringBoundLogger

from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND, SECONDS_PER_HOUR, SECONDS_PER_MINUTE
from service.access.bearer_secrets import LONGEST, digest_of
from service.access.permissions import Permission, permissions_of
from service.access.reach import Sites, both, permissions_at
from service.access.second_factors import is_asked_of, is_missing
from service.access.tokens import as_it_counts
from service.configuration.access import AccessSettings
from service.storage import Repository
from service.storage.records import ApiToken, Role, User
from service.timing.database_silence import database_trouble, does_not_answer

log: FilteringBoundLogger = structlog.get_logger(__name__)

NOTED_AGAIN_NS = 60 * NANOSECONDS_PER_SECOND
"""That a session or a token is used is written down once in so long, not at each request."""


class Way(StrEnum):
    """How somebody showed who they are."""

    SESSION = "session"
    TOKEN = "token"  # noqa: S105 - the word for one
    PROXY = "proxy"
    NONE = "none"
    """There are no users yet, and the request comes from this machine."""


@dataclass(frozen=True, slots=True)
class Identity:
    """Somebody who showed who they are. session: the digest of its secret; token: the one they showed.

    sites: where the roles hold.
    password_set_by: who else knows the password that they showed, and are to change before they do anything.
    may_make_tokens: whether they have shown the second factor, where they need one.
    """

    name: str
    roles: frozenset[Role]
    permissions: frozenset[Permission]
    way: Way
    sites: Sites = None
    session: str | None = None
    token: ApiToken | None = None
    password_set_by: str | None = None
    may_make_tokens: bool = True


def identity_of_session(
    repository: Repository, limits: AccessSettings, secret: str, *, now_ns: int, is_use: bool = True
) -> Identity | None:
    """Return whose session it is; None where it is nobody's, or over.

    is_use: whether somebody uses it now; False where a page asks by itself, so that it does not go on for
    ever at a desk that everybody has left.
    """
    if len(secret) > LONGEST:
        return None
    return identity_of_login(repository, limits, digest_of(secret), now_ns=now_ns, is_use=is_use)


def identity_of_login(
    repository: Repository, limits: AccessSettings, digest: str, *, now_ns: int, is_use: bool
) -> Identity | None:
    """Return whose session has the secret of this digest; None where it is nobody's, or over."""
    session = repository.session_of(digest)
    if session is None or session.user.disabled:
        return None
    if session.created_ns < oldest_session_ns(limits, now_ns) or session.used_ns < idle_since_ns(
        limits, now_ns
    ):
        return None
    if is_asked_of(limits, session.user) and not session.second_factor:
        return None  # begun before it was asked for
    if is_use and now_ns - session.used_ns > NOTED_AGAIN_NS:
        _note(partial(repository.note_session_used, digest, now_ns=now_ns))
    user = session.user
    return Identity(
        user.name,
        user.roles,
        permissions_after_login(limits, user),
        Way.SESSION,
        user.sites,
        session=digest,
        password_set_by=user.password_set_by,
        may_make_tokens=not is_missing(limits, user),
    )


def permissions_after_login(limits: AccessSettings, user: User) -> frozenset[Permission]:
    """Return what a user may do who has logged in: see to the own account first, where that is to be."""
    may = permissions_at(user.sites, permissions_of(user.roles))
    return may & {Permission.ACCOUNT} if is_account_first(limits, user) else may


def is_account_first(limits: AccessSettings, user: User) -> bool:
    """Tell whether a user sees to the own account before anything else.

    They change a password that another knows, and set up the second factor that their role needs.
    """
    return user.must_change_password or is_missing(limits, user)


def identity_of_token(
    repository: Repository, limits: AccessSettings, secret: str, *, now_ns: int
) -> Identity | None:
    """Return whose token it is; None where it is nobody's, or counts no more."""
    if len(secret) > LONGEST:
        return None
    found = repository.token_with(digest_of(secret))
    if found is None:
        return None
    token, user = as_it_counts(found[0], limits), found[1]
    if user.disabled or (token.expires_ns is not None and token.expires_ns <= now_ns):
        return None
    if user.subject is not None and not _is_confirmed(user, limits, now_ns):
        return None
    if token.used_ns is None or now_ns - token.used_ns > NOTED_AGAIN_NS:
        _note(partial(repository.note_token_used, token.id, now_ns=now_ns))
    sites = both(user.sites, token.sites)
    may = permissions_at(sites, permissions_of(user.roles))
    if token.scope is not None:
        may &= scope_of(token.scope)
    return Identity(
        user.name,
        user.roles,
        may,
        Way.TOKEN,
        sites,
        token=token,
        may_make_tokens=not is_asked_of(limits, user),
    )


def _is_confirmed(user: User, limits: AccessSettings, now_ns: int) -> bool:
    """Tell whether the identity provider let a user of it in lately: nobody is told when it would not."""
    if limits.oidc is None or user.confirmed_ns is None:
        return False
    return now_ns - user.confirmed_ns < limits.oidc.confirmation_days * NANOSECONDS_PER_DAY


def _note(used: Callable[[], None]) -> None:
    """Write down that somebody is here; who only looks is answered also where nothing can be written."""
    try:
        used()
    except SQLAlchemyError as error:
        if not does_not_answer(error):
            raise
        log.warning("the use of a session or token is not noted", error=database_trouble(error))


def oldest_session_ns(limits: AccessSettings, now_ns: int) -> int:
    """Return when the oldest session began that still counts."""
    return now_ns - round(limits.session_hours * SECONDS_PER_HOUR * NANOSECONDS_PER_SECOND)


def idle_since_ns(limits: AccessSettings, now_ns: int) -> int:
    """Return since when a session may have been idle that still counts."""
    return now_ns - round(limits.session_idle_minutes * SECONDS_PER_MINUTE * NANOSECONDS_PER_SECOND)


def scope_of(words: frozenset[str]) -> frozenset[Permission]:
    """Return the permissions of a scope; words of other versions count for nothing."""
    return frozenset(permission for permission in Permission if permission.value in words)
