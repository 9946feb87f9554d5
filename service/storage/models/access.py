"""Tables of users, their second factors, sessions, login links and tokens, and of failed logins.

Of passwords and secrets they have hashes only; the secrets of authenticator apps are sealed.
"""

from typing import Final

from sqlalchemy import CheckConstraint, ForeignKey, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from service.storage.models.base import Base

BOTH_ROLES: Final = "roles LIKE '%SECADM%' AND roles LIKE '%SECAUD%'"
"""No row has both: who manages users does not read what is kept of that."""


class UserRow(Base):
    """Somebody who may log in, or whose tokens may be used.

    name: in lower case. roles: their names, with spaces between. sites: where the roles hold; None: at all.
    password: an Argon2 hash; None where nobody
    can log in with one. subject: who an identity provider says it is, with the provider before it.
    password_set_by: who else gave them their password, until they change it. sessions_ended_ns: when somebody
    ended all of their sessions, also those that are no rows here. confirmed_ns: when the identity provider
    last let them in. totp: the secret of their authenticator app, sealed; totp_pending: of one that is not
    confirmed. totp_step: the last step of time whose code was used. second_factor_ns: since when they have
    one.
    """

    __tablename__ = "users"

    name: Mapped[str] = mapped_column(String(100), primary_key=True)
    full_name: Mapped[str | None]
    roles: Mapped[str]
    sites: Mapped[tuple[str, ...] | None]
    password: Mapped[str | None]
    subject: Mapped[str | None] = mapped_column(String(600), unique=True)
    disabled: Mapped[bool]
    created_ns: Mapped[int]
    password_set_ns: Mapped[int | None]
    password_set_by: Mapped[str | None]
    sessions_ended_ns: Mapped[int | None]
    confirmed_ns: Mapped[int | None]
    last_login_ns: Mapped[int | None]
    last_login_origin: Mapped[str | None]
    totp: Mapped[str | None]
    totp_pending: Mapped[str | None]
    totp_step: Mapped[int | None]
    second_factor_ns: Mapped[int | None]

    __table_args__ = (CheckConstraint(f"NOT ({BOTH_ROLES})", name="separate_roles"),)


class UserSessionRow(Base):
    """A login, until it is ended. digest: SHA-256 of the secret that the client has.

    second_factor: whether more was shown than a password. provider_session: an identity provider, and what
    it calls this login.
    """

    __tablename__ = "user_sessions"

    digest: Mapped[str] = mapped_column(String(64), primary_key=True)
    user: Mapped[str] = mapped_column(ForeignKey("users.name"), index=True)
    origin: Mapped[str]
    created_ns: Mapped[int]
    used_ns: Mapped[int] = mapped_column(index=True)
    second_factor: Mapped[bool]
    provider_session: Mapped[str | None] = mapped_column(String(600), index=True)


class RecoveryCodeRow(Base):
    """A code that stands once for a user's second factor. digest: SHA-256 of it."""

    __tablename__ = "recovery_codes"

    digest: Mapped[str] = mapped_column(String(64), primary_key=True)
    user: Mapped[str] = mapped_column(ForeignKey("users.name"), index=True)


class PasskeyRow(Base):
    """A passkey (WebAuthn) of a user. credential, public_key: base64url, as browsers write them.

    signatures: how many the device has counted; 0 where it counts none. used_ns: when it last let them in.
    """

    __tablename__ = "passkeys"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    user: Mapped[str] = mapped_column(ForeignKey("users.name"), index=True)
    label: Mapped[str]
    credential: Mapped[str] = mapped_column(String(1400), unique=True)
    public_key: Mapped[str]
    signatures: Mapped[int]
    created_ns: Mapped[int]
    used_ns: Mapped[int | None]


class UsedOnceRow(Base):
    """What counts once and was used, until it would be too old anyway: a challenge that a passkey answered,
    a logout token. digest: SHA-256 of it.
    """

    __tablename__ = "used_once"

    digest: Mapped[str] = mapped_column(String(64), primary_key=True)
    expires_ns: Mapped[int] = mapped_column(index=True)


class LoginLinkRow(Base):
    """A link that begins one session of a user, until it is followed. digest: SHA-256 of its secret."""

    __tablename__ = "login_links"

    digest: Mapped[str] = mapped_column(String(64), primary_key=True)
    user: Mapped[str] = mapped_column(ForeignKey("users.name"), index=True)
    expires_ns: Mapped[int]


class ApiTokenRow(Base):
    """A secret of a user for a program. scope: permissions, with spaces between; None for all of the user.

    sites: where it holds, of those of the user; None for all of them.
    parent: the token that asked for this one, and with which it ends; None where a person did.
    """

    __tablename__ = "api_tokens"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    user: Mapped[str] = mapped_column(ForeignKey("users.name"), index=True)
    label: Mapped[str]
    digest: Mapped[str] = mapped_column(String(64), unique=True)
    scope: Mapped[str | None]
    sites: Mapped[tuple[str, ...] | None]
    parent: Mapped[str | None] = mapped_column(ForeignKey("api_tokens.id", ondelete="CASCADE"), index=True)
    created_ns: Mapped[int]
    expires_ns: Mapped[int | None]
    used_ns: Mapped[int | None]


class FailedLoginRow(Base):
    """Failed logins in a row: of an account from an address, of an account ("" as address), of an address."""

    __tablename__ = "failed_logins"

    account: Mapped[str] = mapped_column(String(100), primary_key=True)
    address: Mapped[str] = mapped_column(String(100), primary_key=True)
    failures: Mapped[int]
    last_ns: Mapped[int]
    locked_until_ns: Mapped[int]

    __table_args__ = (Index("ix_failed_logins_last_ns", "last_ns"),)
