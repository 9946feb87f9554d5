"""Connections that came and are yet to be served: they wait in the process that accepts them."""

import asyncio
import os
import socket
import subprocess
import sys
from collections.abc import Callable, Coroutine
from pathlib import Path

import structlog
from structlog.typing import FilteringBoundLogger

from service.process.acceptor import HANDED, HANDED_AT_ONCE, REFUSED
from service.process.tally import Tally

log: FilteringBoundLogger = structlog.get_logger(__name__)

PROGRAM = "import sys; sys.path.append(sys.argv.pop(1)); from service.process.acceptor import main; main()"
PACKAGES = str(Path(__file__).parents[3])
VARIABLES = ("LD_LIBRARY_PATH", "SYSTEMROOT")
"""All that the interpreter may need of the environment. Secrets that are there stay with the service."""

AGAIN_S = 1.0
END_LIMIT_S = 5.0

Serve = Callable[[socket.socket], Coroutine[None, None, None]]


class ConnectionQueue:
    """Serves the connections of one listening socket, in the running event loop, until it is closed.

    serve: makes a connection one of the server's. most: those that wait at a time; others wait in the system.
    health: the answer to requests for /healthz without its date, given while `sign_of_life` is called.
    """

    def __init__(
        self, listener: socket.socket, serve: Serve, *, most: int, tally: Tally, health: bytes
    ) -> None:
        self._loop = asyncio.get_running_loop()
        self._listener = listener
        self._serve = serve
        self._most = most
        self._tally = tally
        self._health = health
        self._serving: set[asyncio.Task[None]] = set()
        self._is_open = True
        self._start()

    def close(self) -> None:
        """Accept no more, and close the connections that wait."""
        self._is_open = False
        self._end()

    def sign_of_life(self) -> None:
        """Show that the event loop goes on."""
        try:
            self._acceptor_socket.send(HANDED)
        except OSError:
            return  # it has much to read, or has ended, which is seen elsewhere

    def _start(self) -> None:
        self._acceptor_socket, other = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with other:
            # Few are on their way here. The others wait there.
            other.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 1)
            self._acceptor = subprocess.Popen(  # noqa: S603 - this interpreter, and nothing that a client says
                [
                    sys.executable,
                    *("-I", "-S", "-B", "-c", PROGRAM, PACKAGES),
                    *(str(each) for each in (self._listener.fileno(), other.fileno(), self._most)),
                ],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                env={name: os.environ[name] for name in VARIABLES if name in os.environ},
                pass_fds=(self._listener.fileno(), other.fileno()),
            )
        self._acceptor_socket.setblocking(False)  # noqa: FBT003 - the standard library's
        if self._health:
            self._acceptor_socket.send(self._health)
        self._loop.add_reader(self._acceptor_socket, self._take)

    def _end(self) -> None:
        self._loop.remove_reader(self._acceptor_socket)
        self._acceptor_socket.close()
        try:
            self._acceptor.wait(END_LIMIT_S)
        except subprocess.TimeoutExpired:
            self._acceptor.kill()
            self._acceptor.wait()

    def _take(self) -> None:
        """Serve a few in this turn of the event loop."""
        try:
            message, descriptors, _, _ = socket.recv_fds(
                self._acceptor_socket, HANDED_AT_ONCE, HANDED_AT_ONCE
            )
        except (BlockingIOError, InterruptedError):
            return
        except ConnectionResetError:
            message, descriptors = b"", []
        if not message:
            self._go_on_with_another()
        for _ in range(message.count(REFUSED) + message.count(HANDED) - len(descriptors)):
            self._tally.add("not_accepted")
        for descriptor in descriptors:
            connection = socket.socket(fileno=descriptor)
            connection.setblocking(False)  # noqa: FBT003 - the standard library's
            task = self._loop.create_task(self._serve(connection))
            self._serving.add(task)
            task.add_done_callback(self._serving.discard)

    def _go_on_with_another(self) -> None:
        """Start the process that accepts again, a little later: it has ended, which it never should."""
        self._end()
        log.error("the process that accepts connections ended", exit_code=self._acceptor.returncode)
        self._loop.call_later(AGAIN_S, self._start_again)

    def _start_again(self) -> None:
        if self._is_open:
            self._start()
