"""The HTTP server of the API: uvicorn, with limits on its connections."""

import asyncio
import errno
import math
import resource
import socket
from types import FrameType
from typing import Any

import structlog
import uvicorn
from starlette.types import ASGIApp
from structlog.typing import FilteringBoundLogger

from service.api.limits.connection_guard import ConnectionGuard
from service.api.limits.connections import EXTRA, ConnectionLimits, LimitedConnection, OpenConnections
from service.configuration.settings import Settings
from service.process.termination import Termination

log: FilteringBoundLogger = structlog.get_logger(__name__)

ACCEPTED_AT_ONCE = 16
"""Connections between two looks at anything else, each with a descriptor.

So few that the requests of a burst are read and answered while it comes.
"""

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

LAST_REQUESTS_S = 3
"""Time for the requests under way when the service stops."""

OUT_OF_RESOURCES = {errno.EMFILE, errno.ENFILE, errno.ENOBUFS, errno.ENOMEM}


class ApiServer(uvicorn.Server):
    """Answers requests until a signal comes, which the termination is told too."""

    def __init__(
        self, app: ASGIApp, limits: ConnectionLimits, termination: Termination | None = None
    ) -> None:
        self._open = OpenConnections(limits)
        self._termination = termination or Termination()
        super().__init__(
            uvicorn.Config(
                ConnectionGuard(app, self._open),
                http=LimitedConnection,
                ws="none",
                loop="asyncio",
                backlog=ACCEPTED_AT_ONCE,
                timeout_keep_alive=math.ceil(limits.idle_timeout_s),
                log_config=None,
                access_log=False,
                server_header=False,
                timeout_graceful_shutdown=LAST_REQUESTS_S,
            )
        )
        self.server_state = self._open

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        asyncio.get_running_loop().set_exception_handler(self._handle_loop_error)
        await super().startup(sockets)
        for each in sockets or ():
            each.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, UNTAKEN_BYTES)  # its connections inherit it
            each.listen(QUEUE)
        if self._termination.is_asked:  # before this server handled signals
            self.should_exit = True

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        """Handle a signal that asks for the end."""
        self._termination.note()
        super().handle_exit(sig, frame)

    async def on_tick(self, counter: int) -> bool:
        """Look at the connections, ten times a second."""
        now_s = asyncio.get_running_loop().time()
        self._open.close_overdue(now_s)
        self._open.tally.tell(now_s)
        return await super().on_tick(counter)

    def _handle_loop_error(self, loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
        """Count connections that could not be accepted; asyncio has a line, and a traceback, for each."""
        error = context.get("exception")
        if "socket" in context and isinstance(error, OSError) and error.errno in OUT_OF_RESOURCES:
            self._open.tally.add("not_accepted")
        else:
            loop.default_exception_handler(context)


def connection_limits(settings: Settings) -> ConnectionLimits:
    """Return the limits of the settings; fewer connections where this process may not open enough files."""
    descriptors, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
    possible = max(descriptors - OTHER_DESCRIPTORS - EXTRA - 2 * ACCEPTED_AT_ONCE, FEWEST_CONNECTIONS)
    if settings.max_connections > possible:
        log.warning(
            "fewer connections than max_connections says: this process may not open enough files",
            max_connections=settings.max_connections,
            possible=possible,
            open_files=descriptors,
        )
    return ConnectionLimits(
        most=min(settings.max_connections, possible),
        header_timeout_s=settings.header_timeout_s,
        transfer_timeout_s=settings.transfer_timeout_s,
        idle_timeout_s=settings.idle_timeout_s,
    )
