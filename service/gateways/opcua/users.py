"""Who a client is, and what it may do: the users of the service, with their roles."""

import time
from contextvars import ContextVar
from dataclasses import dataclass
from typing import Any

import structlog
from asyncua.crypto.permission_rules import SimpleRoleRuleset, User, UserRole
from asyncua.server.user_managers import UserManager
from sqlalchemy.exc import SQLAlchemyError

from service.access.logins import LoginLockedError, LoginRefusedError, account_of, attempt, check_password
from service.access.permissions import Permission, permissions_of
from service.configuration.access import AccessSettings
from service.storage import NotFoundError, Repository
from service.storage.records import Actor
from service.timing.database_silence import database_trouble

log = structlog.get_logger(__name__)

ADDRESS = "opcua"
"""Where logins come from, for the audit trail and for the count of those that failed."""


@dataclass
class PlantUser(User):  # type: ignore[misc]
    """Somebody at a session. actor: None for somebody who has not said who it is."""

    actor: Actor | None = None

    def may(self, permission: Permission) -> bool:
        """Return whether the roles allow this. Somebody unknown may look, where the settings say so."""
        if self.actor is None:
            return permission is Permission.VIEW
        return permission in permissions_of(self.actor.roles)


CALLER: ContextVar[PlantUser | None] = ContextVar("caller", default=None)
"""The user of the request that is answered."""


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

    def get_user(
        self,
        iserver: Any,
        username: str | None = None,
        password: str | None = None,
        certificate: Any = None,
    ) -> User | None:
        """Return who it is; None where nobody may come in so."""
        del iserver, certificate
        if username is None:
            return PlantUser(UserRole.User) if self._anonymous else None
        try:
            actor = self._logged_in(account_of(username), password or "")
        except (LoginLockedError, LoginRefusedError, NotFoundError) as refused:
            log.warning("a client is not let in", reason=str(refused))
            return None
        except SQLAlchemyError as error:
            log.warning("a client is not let in", reason=database_trouble(error))
            return None
        user = PlantUser(UserRole.User, actor.name, actor)
        return user if user.may(Permission.VIEW) else None

    def _logged_in(self, account: str, password: str) -> Actor:
        now_ns = time.time_ns()
        attempt(self._repository, self._settings, account, ADDRESS, now_ns=now_ns)
        check_password(self._repository, account, password, ADDRESS, now_ns=now_ns)
        found = self._repository.user(account)
        return Actor(found.name, ADDRESS, found.roles)
