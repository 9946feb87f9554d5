"""Users, their sessions and tokens, as the repository hands them out."""

from dataclasses import dataclass

from service.roles import Role


@dataclass(frozen=True, slots=True)
class User:
    """Somebody who may log in.

    has_password: False where nobody can log in with one. subject: who an identity provider says it is.
    sessions_ended_ns: when somebody ended all of their sessions.
    """

    name: str
    full_name: str | None
    roles: frozenset[Role]
    disabled: bool
    has_password: bool
    subject: str | None
    created_ns: int
    password_set_ns: int | None
    sessions_ended_ns: int | None
    last_login_ns: int | None
    last_login_origin: str | None


@dataclass(frozen=True, slots=True)
class UserSession:
    """A login of a user; it was last used at used_ns."""

    user: User
    origin: str
    created_ns: int
    used_ns: int


@dataclass(frozen=True, slots=True)
class ApiToken:
    """A secret of a user for a program, without the secret. scope: None for all that the user may."""

    id: str
    user: str
    label: str
    scope: frozenset[str] | None
    created_ns: int
    expires_ns: int | None
    used_ns: int | None


@dataclass(frozen=True, slots=True)
class LoginLimits:
    """How many logins may fail in a row, and for how long none is tried then.

    Each further failure doubles the time, from least_s to most_s. Failures are forgotten after forget_s.
    """

    of_account_and_address: int = 5
    of_account: int = 50
    of_address: int = 100
    least_s: float = 30.0
    most_s: float = 900.0
    forget_s: float = 3600.0
