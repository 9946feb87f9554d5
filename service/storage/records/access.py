"""Users, their sessions and tokens, as the repository hands them out."""

from dataclasses import dataclass

from service.roles import Role


@dataclass(frozen=True, slots=True)
class User:
    """Somebody who may log in.

    sites: where the roles hold; None: at all of them. has_password: False where nobody can log in with one.
    subject: who an identity provider says it is.
    password_set_by: who else gave them their password, until they change it. sessions_ended_ns: when somebody
    ended all of their sessions. confirmed_ns: when the identity provider last let them in.
    second_factor_ns: since when they have one.
    """

    name: str
    full_name: str | None
    roles: frozenset[Role]
    sites: frozenset[str] | None
    disabled: bool
    has_password: bool
    subject: str | None
    created_ns: int
    password_set_ns: int | None
    password_set_by: str | None
    sessions_ended_ns: int | None
    confirmed_ns: int | None
    last_login_ns: int | None
    last_login_origin: str | None
    second_factor_ns: int | None

    @property
    def must_change_password(self) -> bool:
        """Return whether somebody else knows the password: nothing is done with it but changing it."""
        return self.password_set_by is not None

    @property
    def has_second_factor(self) -> bool:
        """Return whether their password lets nobody in alone."""
        return self.second_factor_ns is not None


@dataclass(frozen=True, slots=True)
class TotpSecrets:
    """The secret of a user's authenticator app, sealed; pending: of one that is being set up."""

    confirmed: str | None
    pending: str | None


@dataclass(frozen=True, slots=True)
class NewPasskey:
    """What a device has made for a user. credential, public_key: base64url. signatures: counted so far."""

    credential: str
    public_key: str
    signatures: int


@dataclass(frozen=True, slots=True)
class Passkey:
    """A passkey of a user. signatures: how many its device has counted; 0 where it counts none."""

    id: str
    user: str
    label: str
    credential: str
    public_key: str
    signatures: int
    created_ns: int
    used_ns: int | None


@dataclass(frozen=True, slots=True)
class UserSession:
    """A login of a user; it was last used at used_ns.

    second_factor: whether more was shown than a password.
    """

    user: User
    origin: str
    created_ns: int
    used_ns: int
    second_factor: bool


@dataclass(frozen=True, slots=True)
class ApiToken:
    """A secret of a user for a program, without the secret. scope: None for all that the user may.

    sites: where it holds, of those of the user; None for all of them.
    parent: the token that asked for this one, and with which it ends; None where a person did.
    """

    id: str
    user: str
    label: str
    scope: frozenset[str] | None
    sites: frozenset[str] | None
    parent: str | None
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
