"""Tables of users, their sessions, login links and tokens, and of failed logins.

Of passwords and secrets they have hashes only.
"""

from sqlalchemy import ForeignKey, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from service.storage.models.base import Base


class UserRow(Base):
    """Somebody who may log in, or whose tokens may be used.

    name: in lower case. roles: their names, with spaces between. password: an Argon2 hash; None where nobody
    can log in with one. subject: who an identity provider says it is, with the provider before it.
    sessions_ended_ns: when somebody ended all of their sessions, also those that are no rows here.
    """

    __tablename__ = "users"

    name: Mapped[str] = mapped_column(String(100), primary_key=True)
    full_name: Mapped[str | None]
    roles: Mapped[str]
    password: Mapped[str | None]
    subject: Mapped[str | None] = mapped_column(String(600), unique=True)
    disabled: Mapped[bool]
    created_ns: Mapped[int]
    password_set_ns: Mapped[int | None]
    sessions_ended_ns: Mapped[int | None]
    last_login_ns: Mapped[int | None]
    last_login_origin: Mapped[str | None]


class UserSessionRow(Base):
    """A login, until it is ended. digest: SHA-256 of the secret that the client has."""

    __tablename__ = "user_sessions"

    digest: Mapped[str] = mapped_column(String(64), primary_key=True)
    user: Mapped[str] = mapped_column(ForeignKey("users.name"), index=True)
    origin: Mapped[str]
    created_ns: Mapped[int]
    used_ns: Mapped[int] = mapped_column(index=True)


class LoginLinkRow(Base):
    """A link that begins one session of a user, until it is followed. digest: SHA-256 of its secret."""

    __tablename__ = "login_links"

    digest: Mapped[str] = mapped_column(String(64), primary_key=True)
    user: Mapped[str] = mapped_column(ForeignKey("users.name"), index=True)
    expires_ns: Mapped[int]


class ApiTokenRow(Base):
    """A secret of a user for a program. scope: permissions, with spaces between; None for all of the user."""

    __tablename__ = "api_tokens"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    user: Mapped[str] = mapped_column(ForeignKey("users.name"), index=True)
    label: Mapped[str]
    digest: Mapped[str] = mapped_column(String(64), unique=True)
    scope: Mapped[str | None]
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
