"""Users as the pages show them: roles, sessions, locks and tokens."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Final

from core.units import NANOSECONDS_PER_DAY
from service.access.identities import idle_since_ns, oldest_session_ns
from service.access.permissions import MEANINGS, PERMISSIONS_OF, Permission
from service.access.tokens import as_it_counts
from service.api.access.schemas import MOST_SITES
from service.api.context import ApiContext
from service.api.pages import decode, encode
from service.configuration.access import AccessSettings
from service.storage import Repository
from service.storage.records import ApiToken, Role, User
from service.web.addresses import address

MOST_SHOWN: Final = 100

LIFETIMES: Final = (7, 30, 90, 365)
"""How long a new token may be used [days], beside what the settings let one last."""

SOON_NS: Final = 14 * NANOSECONDS_PER_DAY


@dataclass(frozen=True, slots=True)
class UserLine:
    """A user with what is not in their own row. sessions: that are open."""

    user: User
    sessions: int
    tokens: int
    locked_until_ns: int | None

    @property
    def roles(self) -> Sequence[str]:
        """Return the roles in their order."""
        return [role.value for role in Role if role in self.user.roles]

    @property
    def way(self) -> str:
        """Return how somebody logs in as them."""
        if self.user.subject is not None:
            return "at the identity provider"
        return "with a password" if self.user.has_password else "not at all: tokens alone"


@dataclass(frozen=True, slots=True)
class TokenLine:
    """A token in a list."""

    token: ApiToken
    has_expired: bool
    expires_soon: bool

    @property
    def scope(self) -> str:
        """Return what it may do."""
        may = "all that its user may" if self.token.scope is None else ", ".join(sorted(self.token.scope))
        return may if self.token.sites is None else f"{may}, at {', '.join(sorted(self.token.sites))}"


@dataclass(frozen=True, slots=True)
class RoleWords:
    """A role, with what it may do."""

    role: Role
    meanings: Sequence[str]


@dataclass(frozen=True, slots=True)
class People:
    """What the page of all users shows."""

    lines: Sequence[UserLine]
    next_path: str | None
    tokens: Sequence[TokenLine]
    next_tokens_path: str | None
    roles: Sequence[RoleWords]


def people(context: ApiContext, *, cursor: str | None, tokens_cursor: str | None, now_ns: int) -> People:
    """Read what the page of all users shows. Raises ProblemError for a cursor that is none."""
    users = context.repository.users(limit=MOST_SHOWN, after=decode(cursor, str))
    tokens = context.repository.tokens(user=None, limit=MOST_SHOWN, after=decode(tokens_cursor, str))
    return People(
        lines=lines_of(context, users.items, now_ns=now_ns),
        next_path=None if users.next is None else address("/people", cursor=encode(users.next)),
        tokens=token_lines(context, tokens.items, now_ns=now_ns),
        next_tokens_path=None
        if tokens.next is None
        else address("/people", tokens_cursor=encode(tokens.next)) + "#tokens",
        roles=roles(),
    )


def lines_of(context: ApiContext, users: Sequence[User], *, now_ns: int) -> Sequence[UserLine]:
    """Return users as the list shows them."""
    names, access = [user.name for user in users], context.settings.access
    sessions = context.repository.open_sessions(
        names, oldest_ns=oldest_session_ns(access, now_ns), idle_since_ns=idle_since_ns(access, now_ns)
    )
    tokens = context.repository.tokens_of_users(names)
    locks = context.repository.locks_of_users(names, now_ns=now_ns)
    return [
        UserLine(user, sessions.get(user.name, 0), tokens.get(user.name, 0), locks.get(user.name))
        for user in users
    ]


def token_lines(context: ApiContext, tokens: Sequence[ApiToken], *, now_ns: int) -> Sequence[TokenLine]:
    """Return tokens as the lists show them."""
    return [_token_line(as_it_counts(token, context.settings.access), now_ns) for token in tokens]


def lifetimes(access: AccessSettings) -> Sequence[tuple[int | None, str]]:
    """Return how long a new token may be used, in days and words; None for as long as it may."""
    most = access.token_days
    if most == "unlimited":
        return [*((days, f"{days} days") for days in LIFETIMES), (None, "without an end")]
    return [*((days, f"{days} days") for days in LIFETIMES if days < most), (None, f"{most:g} days")]


def roles() -> Sequence[RoleWords]:
    """Return all roles with what each may do."""
    return [
        RoleWords(role, [MEANINGS[one] for one in Permission if one in PERMISSIONS_OF[role]]) for role in Role
    ]


def site_names(repository: Repository) -> Sequence[str]:
    """Return the names of the plant's sites."""
    return [site.name for site in repository.sites(limit=MOST_SITES).items]


def scope_choices(permissions: Collection[Permission]) -> Sequence[tuple[Permission, str]]:
    """Return the permissions that a token may be narrowed to, with their meanings."""
    return [(one, MEANINGS[one]) for one in Permission if one in permissions]


def _token_line(token: ApiToken, now_ns: int) -> TokenLine:
    expires_ns = token.expires_ns
    has_expired = expires_ns is not None and expires_ns <= now_ns
    soon = expires_ns is not None and not has_expired and expires_ns - now_ns < SOON_NS
    return TokenLine(token, has_expired, soon)
