"""The server of asyncua with bounds for each connection.

The library keeps what has come of a chunk, however large its header says that it is.
"""

import asyncio

import structlog
from asyncua import Server
from asyncua.server.binary_server_asyncio import BinaryServer, OPCUAProtocol

log = structlog.get_logger(__name__)

LARGEST_UNFINISHED = 2 * 65_535
"""Bytes of a chunk that is not whole yet: twice the largest one that the server agrees to take."""


class BoundedServer(Server):  # type: ignore[misc]
    """Serves as the library does, through connections that are bounded."""

    bserver: BinaryServer | None

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

    def data_received(self, data: bytes) -> None:
        super().data_received(data)
        if len(self._buffer) <= LARGEST_UNFINISHED:
            return
        log.warning("an OPC UA client sends a chunk without an end", client=str(self.peer_name))
        self._buffer = b""
        if isinstance(self.transport, asyncio.Transport):
            self.transport.abort()
