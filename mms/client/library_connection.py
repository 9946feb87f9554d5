"""One connection object of the library: it connects, its requests end in time, and it is destroyed once."""

import ctypes
import select
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from typing import Final

from mms.binding.callbacks import guarded
from mms.binding.made_socket import let_go, made_socket
from mms.binding.prototypes import ConnectionClosedHandler, StateChangedHandler
from mms.client.closed_notice import ClosedNotice
from mms.client.tick_loop import TickedConnection, least_busy_loop

_CLOSED, _CONNECTING, _CONNECTED, _CLOSING = range(4)
"""The library's IedConnectionState."""
_REJECTED: Final = 5
"""The library's IED_ERROR_CONNECTION_REJECTED."""


class LibraryConnection:
    """One IedConnection of the library, for one attempt to connect.

    Without TLS it has no thread: whoever connects ticks it, then a loop does. With TLS it has one of the
    library's own.

    Parameters
    ----------
    lib : ctypes.CDLL
        The library.
    pointer : int
        Pointer to the IedConnection, which this object destroys.
    has_thread : bool
        Whether the library drives the connection by a thread of its own.
    notice : ClosedNotice
        Told when the connection has ended.
    """

    def __init__(self, lib: ctypes.CDLL, pointer: int, *, has_thread: bool, notice: ClosedNotice) -> None:
        self._lib = lib
        self.pointer = pointer
        self._has_thread = has_thread
        self._notice = notice
        self._state = _CONNECTING
        self._settled = threading.Event()
        self._socket: socket.socket | None = None
        self._ticked: TickedConnection | None = None

        def closed(_parameter: int | None, _connection: int | None) -> None:
            notice.notify()

        def changed(_parameter: int | None, _connection: int | None, state: int) -> None:
            self._state = state
            if state in (_CONNECTED, _CLOSED):
                self._settled.set()

        self._handlers = (
            ConnectionClosedHandler(guarded(closed, None)),
            StateChangedHandler(guarded(changed, None)),
        )
        lib.IedConnection_installConnectionClosedHandler(pointer, self._handlers[0], None)
        lib.IedConnection_installStateChangedHandler(pointer, self._handlers[1], None)

    def connect(self, address: str, port: int, timeout_s: float) -> int:
        """Connect and associate.

        Parameters
        ----------
        address : str
            IPv4 address.
        port : int
            TCP port.
        timeout_s : float
            Time within which the association is to stand [s].

        Returns
        -------
        int
            Number of the library's IedClientError; 0 where the association stands.

        Raises
        ------
        DescriptorsExhaustedError
            The library cannot use the socket that it got.
        """
        lib, error = self._lib, ctypes.c_int(0)
        end_s = time.monotonic() + timeout_s
        timeout_ms = max(1, round(timeout_s * 1000))
        lib.IedConnection_setConnectTimeout(self.pointer, timeout_ms)
        lib.IedConnection_setRequestTimeout(self.pointer, timeout_ms)
        self._socket = made_socket(
            lambda: lib.IedConnection_connectAsync(
                self.pointer, ctypes.byref(error), address.encode("ascii"), port
            ),
            (address, port),
        )
        if self._socket is None:
            return error.value or _REJECTED
        if self._has_thread:
            if not self._settled.wait(timeout_s):
                self._shut_down()
        else:
            self._tick_until_settled(self._socket, end_s)
        if self._state != _CONNECTED:
            return _REJECTED
        if not self._has_thread:
            self._ticked = least_busy_loop().drive(self.pointer, self._socket, self._notice.event.is_set)
        return 0

    def _tick_until_settled(self, made: socket.socket, end_s: float) -> None:
        """Tick whenever something has come, until the association stands or has failed."""
        ready = select.poll()
        ready.register(made, select.POLLOUT)  # TCP stands, or has failed
        while not self._settled.is_set():
            remaining_s = end_s - time.monotonic()
            # The tick after the one that failed closes the connection; nothing comes before it.
            if self._state != _CLOSING:
                if remaining_s <= 0:
                    return
                if not ready.poll(remaining_s * 1000):
                    continue
                ready.modify(made, select.POLLIN)
            self._lib.IedConnection_tick(self.pointer)

    def requesting(self, timeout_s: float) -> AbstractContextManager[None]:
        """See to it that requests made in the block end in time.

        Parameters
        ----------
        timeout_s : float
            Longest wait for an answer, as the library knows it [s].

        Returns
        -------
        context manager
            The block.
        """
        return nullcontext() if self._ticked is None else self._ticked.requesting(timeout_s)

    @property
    def ticked(self) -> TickedConnection | None:
        """The connection as a loop drives it; None where the library has a thread for it."""
        return self._ticked

    @contextmanager
    def limited(self, limit_s: float) -> Iterator[threading.Event]:
        """End the connection when a limit is over and the block has not ended.

        Parameters
        ----------
        limit_s : float
            The limit [s].

        Yields
        ------
        threading.Event
            Tells that the connection was ended.
        """
        over = threading.Event()

        def end() -> None:
            over.set()
            self._shut_down()

        timer = threading.Timer(limit_s, end)
        timer.daemon = True
        timer.start()
        try:
            yield over
        finally:
            timer.cancel()

    def _shut_down(self) -> None:
        """End the TCP connection, which the library notices."""
        if self._socket is not None:
            with suppress(OSError):  # it has ended already
                self._socket.shutdown(socket.SHUT_RDWR)

    def destroy(self) -> None:
        """Free the library's object; a second call does nothing."""
        if self._ticked is not None:
            self._ticked.stop()
        if self._socket is not None:
            let_go(self._socket)
        pointer, self.pointer = self.pointer, 0
        if pointer:
            self._lib.IedConnection_destroy(pointer)
