"""Who a client is, and what it may do: the users of the service, with their roles."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

import structlog
from asyncua import ua
from asyncua.common.utils import ServiceError
from asyncua.crypto.permission_rules import SimpleRoleRuleset, User, UserRole
from asyncua.server.user_managers import UserManager
from sqlalchemy.exc import SQLAlchemyError

from core.error_words import one_line
from service.access.logins import LoginLockedError, LoginRefusedError, account_of, attempt, check_login
from service.access.permissions import Permission, permissions_of
from service.configuration.access import AccessSettings
from service.gateways.opcua.worker_threads import WorkerThreads
from service.storage import NotFoundError, Repository
from service.storage.records import Actor
from service.storage.records import User as Account
from service.timing.database_silence import database_trouble

log = structlog.get_logger(__name__)

ADDRESS = "opcua"
"""Before the host of a client, for the audit trail and for the count of logins that failed."""

WAY: Final = "password"
"""How people say here who they are, as the audit trail has it."""

LOGINS_AT_ONCE: Final = 2
"""Logins that are looked at at a time: a password takes 64 MiB."""


@dataclass
class PlantUser(User):  # type: ignore[misc]
    """Somebody at a session.

    account: as it was at the login; None for who has not said who it is.  address: where from.
    """

    account: Account | None = None
    address: str = ADDRESS

    @property
    def account_name(self) -> str | None:
        """Return the name of the account, if there is one."""
        return None if self.account is None else self.account.name

    def may(self, permission: Permission) -> bool:
        """Return whether the roles allow this. Somebody unknown may look, where the settings say so."""
        if self.account is None:
            return permission is Permission.VIEW
        return permission in permissions_of(self.account.roles)


def actor_of(account: Account, address: str) -> Actor:
    """Return who does what is asked for with an account."""
    return Actor(account.name, address, account.roles)


def has_changed(repository: Repository, account: Account) -> bool:
    """Return whether an account was deleted, disabled or logged out, or has other roles or another password.

    Raises SQLAlchemyError where the database does not answer.
    """
    try:
        return _kept(repository.user(account.name)) != _kept(account)
    except NotFoundError:
        return True


def _kept(account: Account) -> tuple[object, ...]:
    """Return what stays the same as long as a session lasts. created_ns: others may get the name later."""
    return (
        account.created_ns,
        account.roles,
        account.sites,
        account.disabled,
        account.password_set_ns,
        account.sessions_ended_ns,
        account.second_factor_ns,
    )


CALLER: ContextVar[PlantUser | None] = ContextVar("caller", default=None)
"""The user of the request that is answered."""

LOGGED_IN: ContextVar[PlantUser | None] = ContextVar("logged in", default=None)
"""Whose name and password were looked at for the session that is activated."""


class PlantRules(SimpleRoleRuleset):  # type: ignore[misc]
    """Remembers who asks, for methods; nobody changes the address space."""

    def check_validity(self, user: Any, action_type_id: Any, body: Any) -> bool:
        """Return whether the request is allowed at all."""
        CALLER.set(user if isinstance(user, PlantUser) else None)
        return bool(super().check_validity(user, action_type_id, body))


class ServiceUsers(UserManager):  # type: ignore[misc]
    """Looks at names and passwords as the service does: attempts are counted, and every failure is kept."""

    def __init__(self, repository: Repository, settings: AccessSettings, *, anonymous: bool) -> None:
        self._repository = repository
        self._settings = settings
        self._anonymous = anonymous
        self._threads = WorkerThreads("login", LOGINS_AT_ONCE)

    async def log_in(self, name: str, password: str, *, host: str) -> PlantUser:
        """Return whose name and password it is. host: where from. Raises ServiceError."""
        address, wanted = f"{ADDRESS} {host}", account_of(name)
        told = log.bind(user=one_line(wanted), client=host)
        try:
            account = await self._threads.run(partial(self._account, wanted, password, address))
            user = PlantUser(UserRole.User, account.name, account, address)
            if account.must_change_password:
                told.warning("a client is not let in", reason="somebody else set the password (mcc password)")
                raise ServiceError(ua.StatusCodes.BadUserAccessDenied)
            if account.sites is not None:
                told.warning(
                    "a client is not let in", reason="the user has some sites, this server shows all"
                )
                raise ServiceError(ua.StatusCodes.BadUserAccessDenied)
            if not user.may(Permission.VIEW):
                raise ServiceError(ua.StatusCodes.BadUserAccessDenied)
            await self._threads.run(partial(self._note_login, actor_of(account, address)))
        except (LoginLockedError, LoginRefusedError) as refused:
            told.warning("a client is not let in", reason=str(refused))
            raise ServiceError(ua.StatusCodes.BadUserAccessDenied) from refused
        except SQLAlchemyError as error:
            told.warning("a client is not let in", reason=database_trouble(error))
            raise ServiceError(ua.StatusCodes.BadResourceUnavailable) from error
        except NotFoundError as gone:
            raise ServiceError(ua.StatusCodes.BadUserAccessDenied) from gone
        return user

    def get_user(
        self,
        iserver: Any,
        username: str | None = None,
        password: str | None = None,
        certificate: Any = None,
    ) -> User | None:
        """Return who it is; None where nobody may come in so. All clients wait for the answer."""
        del iserver, password, certificate
        if username is None:
            return PlantUser(UserRole.User) if self._anonymous else None
        return LOGGED_IN.get()

    def close(self) -> None:
        """Look at no more logins."""
        self._threads.close()

    def _account(self, name: str, password: str, address: str) -> Account:
        now_ns = time.time_ns()
        attempt(self._repository, self._settings, name, address, now_ns=now_ns)
        account = self._known(name)  # before its password, which may be changed meanwhile
        # OPC UA has no place for a code: who needs one is refused, and programs have users of their own.
        check_login(self._repository, self._settings, name, password, None, address, now_ns=now_ns)
        if account is None:
            raise LoginRefusedError
        return account

    def _note_login(self, by: Actor) -> None:
        """Have the audit trail and the user's last login tell of it. Raises NotFoundError."""
        self._repository.note_login(by.name, WAY, by=by, now_ns=time.time_ns())

    def _known(self, name: str) -> Account | None:
        try:
            return self._repository.user(name)
        except NotFoundError:
            return None


@contextmanager
def logged_in(user: PlantUser | None) -> Iterator[None]:
    """Have a session that is activated in the block belong to this user, whose password was right."""
    token = LOGGED_IN.set(user)
    try:
        yield
    finally:
        LOGGED_IN.reset(token)
