"""The HTTP server of the API: uvicorn, with limits on its connections."""

import asyncio
import math
import socket
import sys
from collections.abc import Callable
from types import FrameType

import structlog
import uvicorn
from starlette.types import ASGIApp
from structlog.typing import FilteringBoundLogger

from service.api.access.certificate import ServerCertificate
from service.api.limits.connection_guard import ConnectionGuard
from service.api.limits.connection_queue import ConnectionQueue
from service.api.limits.connections import EXTRA, ConnectionLimits, LimitedConnection, OpenConnections
from service.api.limits.health import health_answer
from service.configuration.settings import Settings
from service.process.open_files import allow_open_files
from service.process.termination import Termination

log: FilteringBoundLogger = structlog.get_logger(__name__)

QUEUE = 2048
"""Connections that the system holds until they are accepted. Those beyond try again after a second."""

UNTAKEN_BYTES = 1 << 17
"""What the system holds of answers for a client; Linux doubles it.

By itself it would let that grow to megabytes, so that a client that takes no answer could have the service
make dozens of them before it has to wait.
"""

OTHER_DESCRIPTORS = 300
"""What else the service may have open: the database, files under way, pipes to its processes."""

FEWEST_CONNECTIONS = 16
FEWEST_WAITING = 32

CERTIFICATE_PERIOD_S = 5.0
"""The files of the certificate are looked at so often."""

LAST_REQUESTS_S = 3
"""Time for the requests under way when the service stops."""

SWITCH_INTERVAL_S = 0.0002
"""So long a thread may keep the others from running [s].

The event loop waits for its turn behind up to forty threads that ask the database. With Python's own 5 ms
that would be 0.2 s for each look at the connections.
"""


class ApiServer(uvicorn.Server):
    """Answers requests until a signal comes, which the termination is told too."""

    def __init__(
        self,
        app: ASGIApp,
        limits: ConnectionLimits,
        termination: Termination | None = None,
        certificate: ServerCertificate | None = None,
        on_shutdown: Callable[[], None] | None = None,
    ) -> None:
        """on_shutdown: ends answers that would else go on; called in the event loop."""
        self._on_shutdown = on_shutdown
        self._open = OpenConnections(limits)
        self._termination = termination or Termination()
        self._certificate = certificate
        self._certificate_seen_s = 0.0
        self._queues: list[ConnectionQueue] = []
        super().__init__(
            uvicorn.Config(
                ConnectionGuard(app, self._open),
                http=LimitedConnection,
                ws="none",
                loop="asyncio",
                timeout_keep_alive=math.ceil(limits.idle_timeout_s),
                log_config=None,
                access_log=False,
                server_header=False,
                proxy_headers=False,  # those of the proxy that the settings name count, and no others
                ssl_context_factory=None if certificate is None else lambda *_: certificate.context,
                timeout_graceful_shutdown=LAST_REQUESTS_S,
            )
        )
        self.server_state = self._open

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        for each in sockets or ():  # before it is called started: who connects from then on is not refused
            each.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, UNTAKEN_BYTES)  # its connections inherit it
            each.listen(QUEUE)
        await super().startup([])  # the sockets have queues of their own
        sys.setswitchinterval(SWITCH_INTERVAL_S)
        health = b"" if self._certificate else await health_answer(self.config.loaded_app)
        for each in sockets or ():
            most = self._open.limits.waiting
            self._queues.append(
                ConnectionQueue(
                    each, self._serve_connection, most=most, tally=self._open.tally, health=health
                )
            )
        if self._termination.is_asked:  # before this server handled signals
            self.should_exit = True

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Accept no more, and end what is under way."""
        for queue in self._queues:
            queue.close()
        if self._on_shutdown is not None:
            self._on_shutdown()
        await super().shutdown(sockets)

    async def _serve_connection(self, connection: socket.socket) -> None:
        """Make an accepted connection one of the server's; close it where that fails."""
        loop = asyncio.get_running_loop()

        def protocol() -> LimitedConnection:
            return LimitedConnection(self.config, self._open, self.lifespan.state, loop)

        try:
            await loop.connect_accepted_socket(
                protocol,
                connection,
                ssl=self.config.ssl,
                ssl_handshake_timeout=self._open.limits.header_timeout_s if self.config.ssl else None,
            )
        except (OSError, TimeoutError):  # the client has gone, or does not speak TLS
            connection.close()

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        """Handle a signal that asks for the end."""
        self._termination.note()
        super().handle_exit(sig, frame)

    async def on_tick(self, counter: int) -> bool:
        """Look at the connections, ten times a second."""
        now_s = asyncio.get_running_loop().time()
        self._open.close_overdue(now_s)
        self._open.tally.tell(now_s)
        for queue in self._queues:
            queue.sign_of_life()
        if self._certificate is not None and now_s >= self._certificate_seen_s + CERTIFICATE_PERIOD_S:
            self._certificate_seen_s = now_s
            self._certificate.renew()
        return await super().on_tick(counter)


def connection_limits(settings: Settings) -> ConnectionLimits:
    """Return the limits of the settings; fewer connections where this process may not open enough files."""
    descriptors = allow_open_files(settings.max_connections + QUEUE + EXTRA + OTHER_DESCRIPTORS)
    possible = max(descriptors - OTHER_DESCRIPTORS - EXTRA - FEWEST_WAITING, FEWEST_CONNECTIONS)
    if settings.max_connections > possible:
        log.warning(
            "fewer connections than max_connections says: this process may not open enough files",
            max_connections=settings.max_connections,
            possible=possible,
            open_files=descriptors,
        )
    most = min(settings.max_connections, possible)
    return ConnectionLimits(
        most=most,
        waiting=min(QUEUE, max(possible - most + FEWEST_WAITING, FEWEST_WAITING)),
        header_timeout_s=settings.header_timeout_s,
        transfer_timeout_s=settings.transfer_timeout_s,
        idle_timeout_s=settings.idle_timeout_s,
    )
