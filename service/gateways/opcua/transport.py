"""The server of asyncua with bounds for each connection, and with channels that are what the settings say.

The library keeps what has come of a chunk, however large its header says that it is. It holds sessions over
channels that are not offered, and takes a client's word for whose certificate the channel is. It asks who
a client is while all others wait, and lets connections without a session keep out others. Any number of
sessions may be created on a connection, of which it forgets all but the last one.
"""

import asyncio
import struct
from collections.abc import Iterable, Sequence
from typing import Any, Final

import structlog
from asyncua import Server, ua
from asyncua.common.utils import ServiceError
from asyncua.server.binary_server_asyncio import BinaryServer, OPCUAProtocol
from asyncua.server.uaprocessor import UaProcessor
from asyncua.ua.ua_binary import struct_from_binary, uatcp_to_binary

from core.error_words import one_line
from service.gateways.opcua.sessions import BoundSession, PlantServer
from service.gateways.opcua.trusted_clients import application_uris
from service.gateways.opcua.users import PlantUser, ServiceUsers, logged_in

log = structlog.get_logger(__name__)

LARGEST_UNFINISHED = 2 * 65_535
"""Bytes of a chunk that is not whole yet: twice the largest one that the server agrees to take."""

SILENT_S: Final = 5.0
"""A connection on which nobody has logged in ends after so long; one whose login is looked at may wait."""

LOGIN_LOOK_S: Final = 0.5
"""Between two looks whether such a login is over."""

CREATE: Final = ua.NodeId(ua.ObjectIds.CreateSessionRequest_Encoding_DefaultBinary)
ACTIVATE: Final = ua.NodeId(ua.ObjectIds.ActivateSessionRequest_Encoding_DefaultBinary)
REGISTER: Final = (
    ua.NodeId(ua.ObjectIds.RegisterServerRequest_Encoding_DefaultBinary),
    ua.NodeId(ua.ObjectIds.RegisterServer2Request_Encoding_DefaultBinary),
)
"""Requests of other servers, to be listed by a discovery server: anybody's, and kept for good."""
OF_NO_SESSION: Final = (
    CREATE,
    ua.NodeId(ua.ObjectIds.GetEndpointsRequest_Encoding_DefaultBinary),
    ua.NodeId(ua.ObjectIds.FindServersRequest_Encoding_DefaultBinary),
    ua.NodeId(ua.ObjectIds.CloseSecureChannelRequest_Encoding_DefaultBinary),
)
"""Requests that name no session."""
TRANSFER: Final = ua.NodeId(ua.ObjectIds.TransferSubscriptionsRequest_Encoding_DefaultBinary)


class BoundedServer(Server):  # type: ignore[misc]
    """Serves as the library does, through connections that are bounded."""

    bserver: BinaryServer | None

    def __init__(self, users: ServiceUsers) -> None:
        super().__init__(PlantServer(user_manager=users))

    async def start(self) -> None:
        """Listen. Raises OSError."""
        await self._setup_server_nodes()
        await self.iserver.start()
        address, port = self._get_bind_socket_info()
        self.bserver = _BoundedBinaryServer(self.iserver, address, port, self.limits)
        self.bserver.set_policies(self._policies)
        try:
            await self.bserver.start()
        except BaseException:
            await self.iserver.stop()
            raise

    def sessions(self) -> Sequence[BoundSession]:
        """Return the sessions of clients, also of those whose connection was lost."""
        return list(self.iserver._external_sessions.values())  # noqa: SLF001 - the library has no other list

    async def end_session(self, session: BoundSession) -> None:
        """End a session with its subscriptions, and the connection that it has."""
        await session.close_session(delete_subs=True)
        if self.bserver is None:
            return
        for connection in list(self.bserver.clients):
            if connection.processor.session is session:
                connection.transport.close()


class _BoundedBinaryServer(BinaryServer):  # type: ignore[misc]
    def _make_protocol(self) -> OPCUAProtocol:
        return _BoundedProtocol(
            iserver=self.iserver,
            policies=self._policies,
            clients=self.clients,
            closing_tasks=self.closing_tasks,
            limits=self.limits,
        )


class _BoundedProtocol(OPCUAProtocol):  # type: ignore[misc]
    _buffer: bytes
    processor: UaProcessor | None

    @property
    def is_activated(self) -> bool:
        """Return whether somebody has logged in."""
        session = None if self.processor is None else self.processor.session
        return session is not None and session.is_activated()

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        if len(self.clients) >= self.iserver.max_connections:
            self._make_room()
        super().connection_made(transport)
        if self.processor is not None:
            self.processor = _StrictProcessor(self.iserver, self.transport, self.limits)
            self.processor.others = self.clients
            self.processor.set_policies(self.policies)

    def data_received(self, data: bytes) -> None:
        super().data_received(data)
        if len(self._buffer) <= LARGEST_UNFINISHED:
            return
        log.warning("an OPC UA client sends a chunk without an end", client=str(self.peer_name))
        self._buffer = b""
        if isinstance(self.transport, asyncio.Transport):
            self.transport.abort()

    def _make_room(self) -> None:
        """End the connection that has waited longest without a login, first of those without a session."""
        waiting = [one for one in self.clients if not one.is_activated]  # in the order in which they came
        if waiting:
            longest = min(waiting, key=lambda one: one.processor.session is not None)
            log.debug("an OPC UA client without a login gives way", client=str(longest.peer_name))
            self.clients.remove(longest)
            longest.transport.abort()

    async def _activation_watchdog(self) -> None:
        """Close a connection on which nobody logs in. The library's closes also those that wait for us."""
        await asyncio.sleep(SILENT_S)
        while isinstance(self.processor, _StrictProcessor) and self.processor.is_logging_in:
            await asyncio.sleep(LOGIN_LOOK_S)
        if not self.is_activated and self.transport is not None:
            log.debug("nobody has logged in on a connection of OPC UA", client=str(self.peer_name))
            self.transport.close()


class _StrictProcessor(UaProcessor):  # type: ignore[misc]
    """Answers over channels that are offered; over others it only tells which ones are."""

    session: BoundSession | None
    others: Iterable["_BoundedProtocol"] = ()
    """All connections."""

    is_logging_in = False
    """Whether a name and a password are looked at."""

    def set_policies(self, policies: Any) -> None:
        super().set_policies(policies)
        self._offered = policies

    async def close(self) -> None:
        """Answer no request of a connection that ended: what changes then waits for its client."""
        self._publish_requests.clear()
        await super().close()

    async def process(self, header: Any, body: Any) -> bool:
        try:
            return bool(await super().process(header, body))
        except ua.UaError as error:
            if header.MessageType != ua.MessageType.SecureOpen:
                raise
            log.info("an OPC UA client opens no channel", client=str(self.name), reason=str(error))
            refusal = ua.ErrorMessage(ua.StatusCode(ua.StatusCodes.BadSecurityPolicyRejected), str(error))
            self._transport.write(uatcp_to_binary(ua.MessageType.Error, refusal))
            return False

    async def _process_message(self, typeid: Any, requesthdr: Any, seqhdr: Any, body: Any) -> Any:
        if typeid in REGISTER:
            raise ServiceError(ua.StatusCodes.BadServiceUnsupported)
        if typeid == CREATE:
            self._check_channel()
            return await self._create(typeid, requesthdr, seqhdr, body)
        token = requesthdr.AuthenticationToken
        if self.session is not None and typeid not in OF_NO_SESSION and token != self.session.auth_token:
            raise ServiceError(ua.StatusCodes.BadSessionIdInvalid)
        if typeid == ACTIVATE:
            return await self._activate(typeid, requesthdr, seqhdr, body)
        answered = await super()._process_message(typeid, requesthdr, seqhdr, body)
        if typeid == TRANSFER and self.session is not None:
            self._bring_here(self.session)
        return answered

    async def _activate(self, typeid: Any, requesthdr: Any, seqhdr: Any, body: Any) -> Any:
        """Let somebody in, also on a new connection to a session that there is."""
        self._check_channel()
        wanted = struct_from_binary(ua.ActivateSessionParameters, body.copy())
        existing = self.session or self.iserver.lookup_external_session(requesthdr.AuthenticationToken)
        user = await self._user(existing, wanted.UserIdentityToken)
        is_taken_over = self.session is None and existing is not None
        if is_taken_over:
            existing.check_take_over(self._connection.security_policy.peer_certificate, user)
        with logged_in(user):
            answered = await super()._process_message(typeid, requesthdr, seqhdr, body)
        if is_taken_over:
            self._take_from_others(existing)
        return answered

    async def _create(self, typeid: Any, requesthdr: Any, seqhdr: Any, body: Any) -> Any:
        """Create a session, where the one before has ended: the library forgets that."""
        if self.session is not None and not self.session.is_closed:
            raise ServiceError(ua.StatusCodes.BadTooManySessions)
        self._check_certificate(struct_from_binary(ua.CreateSessionParameters, body.copy()))
        answered = await super()._process_message(typeid, requesthdr, seqhdr, body)
        if self.session is not None:
            self.session.client_certificate = self._connection.security_policy.peer_certificate
        return answered

    def _bring_here(self, session: BoundSession) -> None:
        """Have subscriptions wait for requests of this connection; the library leaves them at another."""
        for number, one in session.subscriptions():
            if one.pub_request_callback == self.get_publish_request:
                continue
            for other in self.others:
                if other.processor is not None:
                    other.processor._publish_results_subs.pop(number, None)  # noqa: SLF001 - see above
            one.pub_result_callback = self.forward_publish_response
            one.pub_request_callback = self.get_publish_request

    def _take_from_others(self, session: BoundSession) -> None:
        """End the connection that had the session before, which may be lost without knowing it."""
        for other in list(self.others):
            if (
                other.processor is not self
                and other.processor is not None
                and other.processor.session is session
            ):
                other.processor.session = None  # a connection's end ends its session
                other.transport.close()

    async def _user(self, session: BoundSession | None, identity: object) -> PlantUser | None:
        """Return whose name and password a client shows; None where the library refuses it, or asks for none.

        Only this connection waits meanwhile: the library takes its next message when this one is done with.
        """
        if session is None or not isinstance(identity, ua.UserNameIdentityToken) or not identity.UserName:
            return None
        try:
            name, password = self.iserver.decrypt_user_token(session, identity)
        except (ValueError, TypeError, struct.error):
            return None
        self.is_logging_in = True
        try:
            user: PlantUser = await self.iserver.user_manager.log_in(
                name, password or "", host=str(self.name[0])
            )
        finally:
            self.is_logging_in = False
        return user

    def _check_channel(self) -> None:
        policy = self._connection.security_policy
        if not any(offered.matches(policy.URI, policy.Mode) for offered in self._offered):
            raise ServiceError(ua.StatusCodes.BadSecurityPolicyRejected)

    def _check_certificate(self, session: ua.CreateSessionParameters) -> None:
        """Refuse a client that names no certificate, or another's: it is asked for whether it is trusted.

        OPC 10000-4 (5.6.2) has the certificate name the application that the client says it is.
        """
        policy = self._connection.security_policy
        if policy.Mode == ua.MessageSecurityMode.None_:
            return
        if not (session.ClientCertificate or b"").startswith(policy.peer_certificate):
            raise ServiceError(ua.StatusCodes.BadCertificateInvalid)
        said, signed = session.ClientDescription.ApplicationUri, application_uris(policy.peer_certificate)
        if said not in signed:
            log.warning(
                "an OPC UA client's certificate is another application's",
                client=str(self.name),
                application=one_line(str(said)),
                of_certificate=one_line(", ".join(signed)),
            )
            raise ServiceError(ua.StatusCodes.BadCertificateUriInvalid)
