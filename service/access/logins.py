"""Logging in with a password, in three steps: count the attempt, look at the password, begin a session.

The first and the last are short. The second takes memory: whoever calls it bounds how many do at once.
"""

from typing import Protocol

from core.units import NANOSECONDS_PER_SECOND
from service.access.bearer_secrets import digest_of, new_session
from service.access.identities import idle_since_ns, oldest_session_ns
from service.access.passwords import hashed, is_correct, needs_renewal
from service.access.second_factors import is_asked_of
from service.configuration.access import AccessSettings
from service.storage import Repository
from service.storage.records import Actor, LoginLimits

LONGEST_NAME = 100


class SecondLook(Protocol):
    """Looks at what an account shows besides the password; returns why it is refused, or None."""

    def __call__(self, by: Actor, *, now_ns: int) -> str | None: ...


class LoginRefusedError(Exception):
    """The name, the password or the second factor is wrong; which one is not told."""

    def __init__(self) -> None:
        super().__init__("the name or the password is wrong, or the second factor is wrong, used or missing")


class LoginLockedError(Exception):
    """Too many logins failed in a row. retry_after_s: none is tried before."""

    def __init__(self, retry_after_s: int) -> None:
        self.retry_after_s = retry_after_s
        super().__init__(
            f"too many logins failed; none is tried for {retry_after_s} s "
            "(mcc user unlock NAME --config FILE ends the wait)"
        )


def attempt(
    repository: Repository, settings: AccessSettings, account: str, address: str, *, now_ns: int
) -> None:
    """Count an attempt to log in. Raises LoginLockedError."""
    limits = LoginLimits(of_account_and_address=settings.failed_logins, most_s=settings.lockout_minutes * 60)
    until_ns = repository.attempt_login(account, address, limits, now_ns=now_ns)
    if until_ns is not None:
        raise LoginLockedError(1 + (until_ns - now_ns) // NANOSECONDS_PER_SECOND)


def check_password(repository: Repository, account: str, password: str, address: str, *, now_ns: int) -> None:
    """Look at the password of somebody who is logged in. It takes some tenths of a second and 64 MiB.

    Raises LoginRefusedError.
    """
    kept = _right(repository, account, password, address, now_ns=now_ns)
    _succeed(repository, account, password, address, kept)


def check_login(
    repository: Repository,
    settings: AccessSettings,
    account: str,
    password: str,
    second: SecondLook | None,
    address: str,
    *,
    now_ns: int,
) -> bool:
    """Look at what somebody shows to log in; return whether that was a second factor too.

    second: looks at what was shown besides the password, where that is asked for; None: nothing was. It takes
    as long, and the memory, as a password. Raises LoginRefusedError, and what `second` does.
    """
    kept = _right(repository, account, password, address, now_ns=now_ns)
    user = repository.user(account)
    if not is_asked_of(settings, user):
        _succeed(repository, account, password, address, kept)
        return False
    by = Actor(account, address, user.roles)
    refused = "no second factor" if second is None else second(by, now_ns=now_ns)
    if refused is not None:
        repository.note_login_failed(account, address, f"right password, {refused}", now_ns=now_ns)
        raise LoginRefusedError
    _succeed(repository, account, password, address, kept)
    return True


def _right(repository: Repository, account: str, password: str, address: str, *, now_ns: int) -> str:
    """Return the hash of a password that is right. Raises LoginRefusedError."""
    kept = repository.password_of(account)
    if not is_correct(password, kept) or kept is None:
        repository.note_login_failed(account, address, "wrong name or password", now_ns=now_ns)
        raise LoginRefusedError
    return kept


def _succeed(repository: Repository, account: str, password: str, address: str, kept: str) -> None:
    """Hold nothing against who has shown all that is asked; any earlier, guesses of codes were forgotten."""
    repository.forget_attempt(account, address)
    if needs_renewal(kept):
        repository.renew_hash(account, kept, hashed(password))


def begin_session(
    repository: Repository,
    settings: AccessSettings,
    by: Actor,
    way: str,
    *,
    second_factor: bool,
    provider_session: str | None = None,
    ends: str | None,
    now_ns: int,
) -> str:
    """Return the secret of a new session. Raises NotFoundError (the user was deleted meanwhile).

    second_factor: whether more was shown than a password. provider_session: what an identity provider calls
    this login.
    ends: the secret of the session that the browser had, of whomever; it is of no more use to anybody.
    """
    secret = new_session()
    if ends is not None:
        repository.end_session(digest_of(ends), by=by, now_ns=now_ns)
    repository.begin_session(
        digest_of(secret),
        by.name,
        way,
        second_factor=second_factor,
        provider_session=provider_session,
        most=settings.sessions,
        oldest_ns=oldest_session_ns(settings, now_ns),
        idle_since_ns=idle_since_ns(settings, now_ns),
        by=by,
        now_ns=now_ns,
    )
    return secret


def account_of(name: str) -> str:
    """Return the account that somebody means."""
    return name.strip().lower()[:LONGEST_NAME]
