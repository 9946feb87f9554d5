"""Whose session it is: OPC 10000-4 (5.6) binds one to its channel, its client and its user.

The library counts the tokens of sessions up from 1000, looks at the token of no request, and gives a session
to whoever names its token on a new channel. It does as much as a request asks for.
"""

import secrets
from typing import Any, Final
from weakref import WeakKeyDictionary

from asyncua import ua
from asyncua.common.utils import ServiceError
from asyncua.crypto.permission_rules import User, UserRole
from asyncua.server.internal_server import InternalServer

from service.gateways.opcua import limits
from service.gateways.opcua.subscriptions import Owners, SubscribingSession
from service.gateways.opcua.timestamps import check_timestamps, stamped
from service.gateways.opcua.users import PlantUser

TOKEN_BYTES: Final = 32
"""As many as OPC 10000-4 asks for."""


class BoundSession(SubscribingSession):
    """A session with a token that nobody guesses, whose requests are bounded."""

    def __init__(
        self, iserver: InternalServer, name: object, user: User | None = None, *, external: bool
    ) -> None:
        super().__init__(
            iserver, iserver.aspace, iserver.subscription_service, name, user or User(role=UserRole.Anonymous)
        )
        self.external = external
        self.auth_token = ua.NodeId(secrets.token_bytes(TOKEN_BYTES), 0, ua.NodeIdType.ByteString)
        if external:
            iserver.register_external_session(self)

    def check_take_over(self, certificate: bytes | None, user: PlantUser | None) -> None:
        """Refuse a new channel of another client or another user. Raises ServiceError.

        user: who logs in on the new channel; None for somebody who does not say who it is.
        """
        if not self.is_activated():
            raise ServiceError(ua.StatusCodes.BadSessionNotActivated)
        if certificate != self.client_certificate:
            raise ServiceError(ua.StatusCodes.BadSecurityChecksFailed)
        if self.account_name != (None if user is None else user.account_name):
            raise ServiceError(ua.StatusCodes.BadIdentityChangeNotSupported)

    async def read(self, params: Any) -> Any:
        limits.check_operations(limits.READ, params.NodesToRead)
        check_timestamps(params.TimestampsToReturn)
        return [stamped(value, params.TimestampsToReturn) for value in await super().read(params)]

    async def write(self, params: Any) -> Any:
        limits.check_operations(limits.WRITE, params.NodesToWrite)
        return await super().write(params)

    async def history_read(self, params: Any) -> Any:
        limits.check_operations(limits.HISTORY_READ, params.NodesToRead)
        check_timestamps(params.TimestampsToReturn, may_be_neither=False)
        return await super().history_read(params)

    async def browse(self, params: Any) -> Any:
        limits.check_operations(limits.BROWSE, params.NodesToBrowse)
        return await super().browse(params)

    async def translate_browsepaths_to_nodeids(self, params: Any) -> Any:
        limits.check_operations(limits.TRANSLATE, params)
        return await super().translate_browsepaths_to_nodeids(params)

    async def call(self, params: Any) -> Any:
        limits.check_operations(limits.CALL, params)
        return await super().call(params)


class PlantServer(InternalServer):  # type: ignore[misc]
    """Holds such sessions. owners: of subscriptions, which may outlive their sessions."""

    def __init__(self, user_manager: Any) -> None:
        super().__init__(user_manager=user_manager)
        self.owners: Owners = WeakKeyDictionary()

    def create_session(self, name: Any, user: User | None = None, external: bool = False) -> BoundSession:
        return BoundSession(self, name, user, external=external)
