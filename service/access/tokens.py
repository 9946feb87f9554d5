"""How long tokens last: no longer than the settings and the token that asks for them let them."""

from dataclasses import replace

from core.time_stamps import rfc3339
from core.units import NANOSECONDS_PER_DAY
from service.configuration.access import AccessSettings
from service.storage.records import ApiToken


class TokenLifetimeError(ValueError):
    """A token is to last as it may not; it says what was expected and found."""


def end_of(
    wanted_ns: int | None, access: AccessSettings, *, parent: ApiToken | None, now_ns: int
) -> int | None:
    """Return when a new token ends: when it is wanted to, by default as late as it may; None for no end.

    parent: the token that asks for it, None where a person does. Raises TokenLifetimeError.
    """
    parent_ns = None if parent is None else parent.expires_ns
    last_ns = _earliest(_limit_ns(now_ns, access), parent_ns)
    if wanted_ns is None:
        return last_ns
    if wanted_ns <= now_ns:
        raise TokenLifetimeError("expected a time that is still to come")
    if last_ns is not None and wanted_ns > last_ns:
        is_of_parent = last_ns == parent_ns
        because = "the end of the token that asks" if is_of_parent else "setting access.token_days"
        raise TokenLifetimeError(
            f"expected a time no later than {rfc3339(last_ns)} ({because}), found {rfc3339(wanted_ns)}"
        )
    return wanted_ns


def as_it_counts(token: ApiToken, access: AccessSettings) -> ApiToken:
    """Return a token with the end that the settings leave it: they may be stricter than when it was made."""
    return replace(token, expires_ns=_earliest(_limit_ns(token.created_ns, access), token.expires_ns))


def _limit_ns(created_ns: int, access: AccessSettings) -> int | None:
    """Return when a token ends at the latest; None where it need not."""
    days = access.token_days
    return None if days == "unlimited" else created_ns + round(days * NANOSECONDS_PER_DAY)


def _earliest(*times_ns: int | None) -> int | None:
    return min((time_ns for time_ns in times_ns if time_ns is not None), default=None)
