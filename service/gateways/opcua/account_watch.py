"""Ends the sessions of users whose account was deleted, disabled or changed after they had logged in."""

import asyncio
from collections.abc import Collection
from typing import Final

import structlog
from sqlalchemy.exc import SQLAlchemyError

from service.gateways.opcua.transport import BoundedServer
from service.gateways.opcua.users import PlantUser, has_changed
from service.storage import Repository
from service.storage.records import User as Account

log = structlog.get_logger(__name__)

LOOK_S: Final = 2.0
"""Between two looks at the accounts of those who are here."""


class AccountWatch:
    """Looks at the accounts of all sessions, also of those that only read or are told of changes."""

    def __init__(self, server: BoundedServer, repository: Repository) -> None:
        self._server = server
        self._repository = repository

    async def run(self) -> None:
        """Look again and again."""
        while True:
            await asyncio.sleep(LOOK_S)
            await self._look()

    async def _look(self) -> None:
        here = [(one, one.user) for one in self._server.sessions() if isinstance(one.user, PlantUser)]
        accounts = {user.account for _, user in here if user.account is not None}
        try:
            changed = await asyncio.to_thread(self._changed, accounts)
        except SQLAlchemyError:  # nothing of an account can be changed either; the plant's follower tells it
            return
        for session, user in here:
            if user.account in changed and session.user is user:
                log.info("a session ends: the account of its user has changed", user=user.name)
                await self._server.end_session(session)

    def _changed(self, accounts: Collection[Account]) -> Collection[Account]:
        return {account for account in accounts if has_changed(self._repository, account)}
