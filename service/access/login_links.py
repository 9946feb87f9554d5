"""Links that log a user in once, without a password: `mcc demo` prints one for the demo's user.

Whoever has the link is let in. So it holds for some minutes, and for one session. Only the owner of the
database's files can have one made.
"""

from typing import Final

from core.units import NANOSECONDS_PER_SECOND
from service.access.bearer_secrets import LONGEST, digest_of, new_session
from service.storage import Repository
from service.storage.records import Actor, User

PATH: Final = "/login/link"
LIFE_S: Final = 900


def new_login_link(repository: Repository, user: str, *, by: Actor, now_ns: int) -> str:
    """Return the secret of a new link of a user. Raises NotFoundError."""
    secret = new_session()
    expires_ns = now_ns + LIFE_S * NANOSECONDS_PER_SECOND
    repository.add_login_link(digest_of(secret), user, expires_ns=expires_ns, by=by, now_ns=now_ns)
    return secret


def is_good(repository: Repository, secret: str, *, now_ns: int) -> bool:
    """Tell whether a link can still be followed."""
    return repository.has_login_link(digest_of(secret), now_ns=now_ns)


def user_of_link(repository: Repository, secret: str, *, now_ns: int) -> User | None:
    """Return whom a link logs in, and use it up; None where it was used, has expired, or never was."""
    if len(secret) > LONGEST:
        return None
    return repository.take_login_link(digest_of(secret), now_ns=now_ns)


def address_of(url: str, secret: str) -> str:
    """Return a link at a service."""
    return f"{url}{PATH}?secret={secret}"
