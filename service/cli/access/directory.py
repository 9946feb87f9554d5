"""Users and tokens, reached by way of a running service or in its database.

The database is for who owns its files: they manage users without being one, which makes the first user.
"""

import time
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, cast

from sqlalchemy.exc import SQLAlchemyError

from core.time_stamps import nanoseconds
from service.access.bearer_secrets import digest_of, new_token
from service.access.passwords import UnusablePasswordError, new_hash
from service.access.second_factors import digest_of_code, new_recovery_codes
from service.access.tokens import TokenLifetimeError, as_it_counts, end_of
from service.access.user_names import NAME_RULE, name_of
from service.api.access.schemas import Token, User
from service.cli.audit.actor import command_line_actor
from service.cli.output import CommandError, failing_clearly
from service.client.rest_client import Document, ServiceClient, ServiceError
from service.configuration.access import AccessSettings
from service.configuration.settings import Settings, SettingsError
from service.process.private_files import written_privately
from service.storage import Repository, StorageError, connect, migrate
from service.storage.records import ApiToken, Role
from service.storage.records import User as StoredUser

if TYPE_CHECKING:
    from statorwatch_client.models import Permission, TokenRequest, UserChange

AT_ONCE = 1000


class Directory(Protocol):
    """What can be done with users and tokens. Documents are those of the REST API."""

    def users(self) -> list[Document]:
        """Return all users."""
        ...

    def add_user(
        self,
        name: str,
        roles: Collection[Role],
        sites: Collection[str] | None,
        full_name: str | None,
        password: str | None,
    ) -> Document:
        """Add a user. sites: where the roles hold; None: at all of them."""
        ...

    def change_user(self, name: str, change: Mapping[str, object]) -> Document:
        """Change what is given: full_name, roles, sites, all_sites, disabled."""
        ...

    def set_password(self, name: str, password: str) -> None:
        """Give a user another password."""
        ...

    def unlock(self, name: str) -> None:
        """Forget the failed logins of a user."""
        ...

    def end_sessions(self, name: str) -> None:
        """End all sessions and all tokens of a user."""
        ...

    def reset_second_factor(self, name: str) -> str:
        """Remove a user's second factor; return the code that lets them in once."""
        ...

    def delete_user(self, name: str) -> None:
        """Delete a user."""
        ...

    def tokens(self) -> list[Document]:
        """Return the tokens: of all users, or the own ones of who may not see others'."""
        ...

    def add_token(
        self,
        user: str | None,
        label: str,
        scope: Collection[str] | None,
        sites: Collection[str] | None,
        expires_time: str | None,
    ) -> Document:
        """Make a token of who asks, or in the database of a user whom nobody can log in as.

        The answer has its secret.
        """
        ...

    def revoke_token(self, token_id: str) -> None:
        """End a token."""
        ...

    def revoke_tokens(self, user: str | None) -> None:
        """End all tokens of a user, or of who asks."""
        ...


@contextmanager
def directory(url: str, config: Path | None, *, local: bool) -> Iterator[Directory]:
    """Reach the users of a service: its database with --config or --local, else the service itself.

    Raises CommandError.
    """
    if config is None and not local:
        with failing_clearly(ServiceError), ServiceClient(url) as service:
            yield _AtService(service)
        return
    with written_privately(), failing_clearly(SettingsError, StorageError, SQLAlchemyError, OSError):
        settings = Settings.load(config)
        settings.data_directory.mkdir(parents=True, exist_ok=True)
        migrate(settings.database_url)
        engine = connect(settings.database_url)
        try:
            yield _InDatabase(Repository(engine), settings.access)
        finally:
            engine.dispose()


class _AtService:
    def __init__(self, service: ServiceClient) -> None:
        self._service = service

    def users(self) -> list[Document]:
        return list(self._service.list_users())

    def add_user(
        self,
        name: str,
        roles: Collection[Role],
        sites: Collection[str] | None,
        full_name: str | None,
        password: str | None,
    ) -> Document:
        return self._service.add_user(
            {
                "name": name,
                "roles": [one.value for one in sorted(roles)],
                "sites": None if sites is None else sorted(sites),
                "full_name": full_name,
                "password": password,
            }
        )

    def change_user(self, name: str, change: Mapping[str, object]) -> Document:
        return self._service.change_user(name, cast("UserChange", change))

    def set_password(self, name: str, password: str) -> None:
        self._service.set_password(name, {"password": password})

    def unlock(self, name: str) -> None:
        self._service.unlock_user(name)

    def end_sessions(self, name: str) -> None:
        self._service.end_sessions(name)

    def reset_second_factor(self, name: str) -> str:
        return self._service.reset_second_factor(name)["code"]

    def delete_user(self, name: str) -> None:
        self._service.delete_user(name)

    def tokens(self) -> list[Document]:
        return list(self._service.list_tokens() if self._manages() else self._service.list_own_tokens())

    def add_token(
        self,
        user: str | None,
        label: str,
        scope: Collection[str] | None,
        sites: Collection[str] | None,
        expires_time: str | None,
    ) -> Document:
        words = None if scope is None else cast("list[Permission]", sorted(scope))
        wanted: TokenRequest = {
            "label": label,
            "scope": words,
            "sites": None if sites is None else sorted(sites),
            "expires_time": expires_time,
        }
        if user is not None:
            raise CommandError(
                "--user: expected --config or --local beside it: users make their own tokens (mcc login, "
                "mcc token add LABEL), and only the owner of the service's files makes those of programs"
            )
        return self._service.add_own_token(wanted)

    def revoke_token(self, token_id: str) -> None:
        if self._manages():
            self._service.revoke_token(token_id)
        else:
            self._service.revoke_own_token(token_id)

    def revoke_tokens(self, user: str | None) -> None:
        if user is None:
            self._service.revoke_own_tokens()
        else:
            self._service.revoke_tokens(user)

    def _manages(self) -> bool:
        return "users" in self._service.get_account()["permissions"]


class _InDatabase:
    def __init__(self, repository: Repository, access: AccessSettings) -> None:
        self._repository = repository
        self._access = access
        self._by = replace(command_line_actor(), roles=frozenset({Role.SECADM}))

    def users(self) -> list[Document]:
        found = self._repository.users(limit=AT_ONCE)
        users = list(found.items)
        while found.next is not None:
            found = self._repository.users(limit=AT_ONCE, after=found.next)
            users.extend(found.items)
        return [_user(user) for user in users]

    def add_user(
        self,
        name: str,
        roles: Collection[Role],
        sites: Collection[str] | None,
        full_name: str | None,
        password: str | None,
    ) -> Document:
        proper = name_of(name)
        if proper is None:
            raise CommandError(f"NAME: expected {NAME_RULE}, found {name!r}")
        kept = None if password is None else _hashed(password, proper, full_name)
        user = self._repository.add_user(
            proper,
            roles,
            sites=sites,
            password=kept,
            full_name=full_name,
            by=self._by,
            now_ns=time.time_ns(),
        )
        return _user(user)

    def change_user(self, name: str, change: Mapping[str, object]) -> Document:
        roles, sites, disabled, full_name = (
            change.get(key) for key in ("roles", "sites", "disabled", "full_name")
        )
        user = self._repository.change_user(
            name,
            roles=[Role(role) for role in roles] if isinstance(roles, list) else None,
            sites=list(map(str, sites)) if isinstance(sites, list) else None,
            at_all_sites=change.get("all_sites") is True,
            disabled=disabled if isinstance(disabled, bool) else None,
            full_name=full_name if isinstance(full_name, str) else None,
            by=self._by,
            now_ns=time.time_ns(),
        )
        return _user(user)

    def set_password(self, name: str, password: str) -> None:
        present = self._repository.password_to_change(name, by=self._by)
        kept = _hashed(password, name, self._repository.user(name).full_name, present)
        self._repository.set_password(name, kept, by=self._by, now_ns=time.time_ns())

    def unlock(self, name: str) -> None:
        self._repository.unlock_user(name, by=self._by, now_ns=time.time_ns())

    def end_sessions(self, name: str) -> None:
        self._repository.end_sessions_of(name, by=self._by, now_ns=time.time_ns())

    def reset_second_factor(self, name: str) -> str:
        (code,) = new_recovery_codes(1)
        digest = digest_of_code(code)
        self._repository.reset_second_factor(name, digest, by=self._by, now_ns=time.time_ns())
        return code

    def delete_user(self, name: str) -> None:
        self._repository.delete_user(name, by=self._by, now_ns=time.time_ns())

    def tokens(self) -> list[Document]:
        found = self._repository.tokens(user=None, limit=AT_ONCE)
        tokens = list(found.items)
        while found.next is not None:
            found = self._repository.tokens(user=None, limit=AT_ONCE, after=found.next)
            tokens.extend(found.items)
        return [_token(token, self._access) for token in tokens]

    def add_token(
        self,
        user: str | None,
        label: str,
        scope: Collection[str] | None,
        sites: Collection[str] | None,
        expires_time: str | None,
    ) -> Document:
        if user is None:
            raise CommandError("--user: expected whose token it is, which --config and --local do not tell")
        secret, now_ns = new_token(), time.time_ns()
        wanted_ns = None if expires_time is None else nanoseconds(expires_time)
        with failing_clearly(TokenLifetimeError):
            expires_ns = end_of(wanted_ns, self._access, parent=None, now_ns=now_ns)
        token = self._repository.add_token(
            user,
            label,
            digest_of(secret),
            scope=scope,
            sites=sites,
            expires_ns=expires_ns,
            by=self._by,
            now_ns=now_ns,
        )
        return {**_token(token, self._access), "token": secret}

    def revoke_token(self, token_id: str) -> None:
        self._repository.revoke_token(token_id, user=None, by=self._by, now_ns=time.time_ns())

    def revoke_tokens(self, user: str | None) -> None:
        if user is None:
            raise CommandError("--user: expected whose tokens end, which --config and --local do not tell")
        self._repository.revoke_tokens(user, by=self._by, now_ns=time.time_ns())


def _hashed(password: str, name: str, full_name: str | None, present: str | None = None) -> str:
    try:
        return new_hash(password, name, full_name=full_name, present=present)
    except UnusablePasswordError as error:
        raise CommandError(f"{error}; nothing was changed") from error


def _token(token: ApiToken, access: AccessSettings) -> Document:
    return Token.model_validate(as_it_counts(token, access)).model_dump(mode="json")


def _user(user: StoredUser) -> Document:
    return User.model_validate(user).model_dump(mode="json")
