"""One MMS association on the client side (IEC 61850-7-2 clause 8: Associate, Release, Abort).

A Connection has one lock and one state, and destroys its C object exactly once. It lets one request at a time
through, because real relays are confused by parallel ones. The other client modules use the association
through `request` and `exclusive`.
"""

import atexit
import ctypes
import logging
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from enum import Enum
from typing import Final, Protocol

from mms import errors
from mms.binding.callbacks import guarded, inside_callback
from mms.binding.connection_deadline import connections_between, end_connections_after, open_sockets
from mms.binding.library import library
from mms.binding.prototypes import ConnectionClosedHandler
from mms.client.closed_notice import ClosedNotice
from mms.client.connect_failure import explain_failure
from mms.client.credentials import Credentials
from mms.client.limits import DEFAULT_LIMITS, ClientLimits
from mms.security.tls import TlsConfiguration

log: Final = logging.getLogger("mms")

_CONNECTION_LOST: Final = 3
_REJECTED: Final = 5
_TIMEOUT: Final = 20
_ATTEMPTS: Final = 5
_PAUSE_BETWEEN_ATTEMPTS_S: Final = 0.02

_ENDLESS: Final = -1


class _State(Enum):
    OPEN = "open"
    CLOSING = "closing"
    CLOSED = "closed"


class ServiceFunction(Protocol):
    """Function of the library whose first arguments are the connection and a cell for the error number."""

    def __call__(self, connection: int, error: object, *arguments: object) -> object:
        """Call the function."""


class Connection:
    """Open association with one relay.

    A host name may have several addresses, some of them dead: each is tried in its share of the time. The
    library may report success and lose the association at the first request. So a first request follows every
    connect, and the whole is tried again when just that happens.

    Parameters
    ----------
    host : str
        Host name or IPv4 address of the MMS server.
    port : int
        TCP port.
    connect_timeout_s : float
        Time within which the association is to stand, approximately [s].
    request_timeout_s : float
        Longest wait for the answer to one request [s].
    on_closed : callable, optional
        Called once when the association has ended.
    tls : TlsConfiguration, optional
        Our certificate and those we trust.
    password : str, optional
        Password of ACSE.
    limits : ClientLimits
        Limits on exchanges that a request's timeout does not end.

    Raises
    ------
    ConnectFailed
        No association came about; its subclasses say why.
    CredentialFileError
        A file of `tls` cannot be used.
    ValueError
        The password cannot be sent.
    """

    def __init__(
        self, host: str, port: int, *, connect_timeout_s: float, request_timeout_s: float,
        on_closed: Callable[[], None] | None = None, tls: TlsConfiguration | None = None,
        password: str | None = None, limits: ClientLimits = DEFAULT_LIMITS,
    ) -> None:  # fmt: skip
        self.host: Final = f"{host}:{port}"
        self.request_timeout_s: Final = request_timeout_s
        self.limits: Final = limits
        self.lib: Final = library()
        self._lock = threading.RLock()
        self._pointer = 0
        self.round_trip_s: float | None = None
        self._handlers: list[object] = []  # C holds them until they are uninstalled or all is destroyed
        addresses = self._resolve(host, port)
        self._credentials = Credentials(self.lib, tls, password)
        try:
            self._connect_to_first(addresses, port, time.monotonic() + connect_timeout_s, on_closed)
        except BaseException:
            self._credentials.destroy()
            raise
        self._state = _State.OPEN
        _open_connections.add(self)

    def _connect_to_first(
        self, addresses: tuple[str, ...], port: int, deadline: float, on_closed: Callable[[], None] | None
    ) -> None:
        """Associate with the first address that accepts. Raise ConnectFailed or a subclass if none does."""
        for turn, address in enumerate(addresses, 1):
            now = time.monotonic()
            end = now + (deadline - now) / (len(addresses) - turn + 1)
            code = self._associate(address, port, end, on_closed)
            if code == 0:
                return
            if turn < len(addresses):
                continue
            error = self._refused(code, (address, port), deadline)
            if len(addresses) > 1:
                reason = f"{error.message} (the last of its addresses {', '.join(addresses)})"
                error = type(error)(self.host, "connect", code, reason)
            raise error

    def _refused(self, code: int, address: tuple[str, int], deadline: float) -> errors.MmsError:
        if code == _CONNECTION_LOST and self._credentials.tls is None:
            reason = "the relay ends every association at once: no session left?"
            return errors.ConnectFailed(self.host, "connect", code, reason)
        if code == _ENDLESS:
            reason = f"expected the names of all it offers in {self.limits.names_s:g} s, and more follow"
            return errors.ConnectFailed(self.host, "connect", 0, reason)
        if code not in (_CONNECTION_LOST, _REJECTED):
            found = errors.client_error(self.host, "connect", code)
            is_broken = isinstance(found, errors.ProtocolError)
            kind = errors.AssociationBroken if is_broken else errors.ConnectFailed
            return kind(self.host, "connect", code, found.message)
        return explain_failure(
            self.host,
            address,
            self._credentials.tls,
            password=self._credentials.has_password,
            deadline=deadline,
        )

    def _resolve(self, host: str, port: int) -> tuple[str, ...]:
        if not 0 < port < 65536:
            raise errors.ConnectFailed(self.host, "connect", 0, f"not a TCP port: {port}")
        try:
            found = socket.getaddrinfo(host, port, socket.AF_INET, socket.SOCK_STREAM)
        except (OSError, UnicodeError) as error:
            raise errors.ConnectFailed(
                self.host, "connect", 0, f"cannot resolve the name: {error}"
            ) from error
        return tuple(dict.fromkeys(str(address[0]) for *_, address in found))

    def _associate(
        self, address: str, port: int, deadline: float, on_closed: Callable[[], None] | None
    ) -> int:
        """Return 0 when the association stands, _CONNECTION_LOST when it was lost at once each time."""
        for attempt in range(1, _ATTEMPTS + 1):
            remaining_s = deadline - time.monotonic()
            if remaining_s <= 0 and attempt > 1:
                break
            self._notice = ClosedNotice(on_closed)
            code = self._attempt(address, port, max(remaining_s, 0.001))
            if code == 0 and self._notice.arm():
                return 0
            self._destroy()
            if code not in (0, _CONNECTION_LOST):
                return code
            log.debug("%s: the association was lost at once, attempt %d of %d", self.host, attempt, _ATTEMPTS)
            time.sleep(_PAUSE_BETWEEN_ATTEMPTS_S)
        return _CONNECTION_LOST

    def _attempt(self, address: str, port: int, timeout_s: float) -> int:
        lib = self.lib
        self._pointer = self._credentials.new_connection()
        self._peer, self._others = (address, port), open_sockets()
        notice = self._notice

        def closed(_parameter: int | None, _connection: int | None) -> None:
            notice.notify()

        handler = ConnectionClosedHandler(guarded(closed, None))
        self._handlers = [handler]
        lib.IedConnection_installConnectionClosedHandler(self._pointer, handler, None)
        timeout_ms = max(1, round(timeout_s * 1000))
        # The connect timeout covers TCP; the request timeout the association and the first request.
        lib.IedConnection_setConnectTimeout(self._pointer, timeout_ms)
        lib.IedConnection_setRequestTimeout(self._pointer, timeout_ms)
        error = ctypes.c_int(0)
        unlimited = self._credentials.tls is None
        with (
            nullcontext()
            if unlimited
            else end_connections_after(connections_between(peer=(address, port)), timeout_s)
        ):
            lib.IedConnection_connect(self._pointer, ctypes.byref(error), address.encode("ascii"), port)
        if error.value == 0:
            with self._limited(self.limits.names_s) as over:
                names = lib.IedConnection_getLogicalDeviceList(self._pointer, ctypes.byref(error))
            if names:
                lib.LinkedList_destroy(names)
            if over.is_set():
                error.value = _ENDLESS
            elif error.value == _TIMEOUT and notice.event.wait(self.limits.loss_notice_s):
                error.value = _CONNECTION_LOST
        lib.IedConnection_setRequestTimeout(self._pointer, round(self.request_timeout_s * 1000))
        return error.value

    def _limited(self, limit_s: float) -> AbstractContextManager[threading.Event]:
        """End this connection when the limit is over; the event tells that it was."""
        return end_connections_after(connections_between(peer=self._peer), limit_s, before=self._others)

    @property
    def is_open(self) -> bool:
        """Whether the association stands, as far as the library knows."""
        return self._state is _State.OPEN and not self._notice.event.is_set()

    @property
    def closing(self) -> bool:
        """Whether `abandon` or `close` has been called."""
        return self._state is not _State.OPEN

    def wait_closed(self, timeout_s: float | None) -> bool:
        """Wait until the association has ended.

        Parameters
        ----------
        timeout_s : float or None
            Longest wait [s]; None for no limit.

        Returns
        -------
        bool
            False if the association still stands.
        """
        return self._notice.event.wait(timeout_s)

    def keep_callback(self, handler: object) -> None:
        """Hold a callback for as long as C may call it.

        Parameters
        ----------
        handler : object
            The ctypes callback.
        """
        with self._lock:
            self._handlers.append(handler)

    def release_callback(self, handler: object) -> None:
        """Let go of a callback that C cannot call any more.

        Parameters
        ----------
        handler : object
            The ctypes callback, as it was given to `keep_callback`.
        """
        with self._lock:
            self._handlers.remove(handler)

    @contextmanager
    def exclusive(self, operation: str) -> Iterator[int]:
        """Hold the association alone: meanwhile nobody else sends a request and nobody closes it.

        Parameters
        ----------
        operation : str
            The service and its object, for messages.

        Yields
        ------
        int
            Pointer to the library's IedConnection.

        Raises
        ------
        ConnectionLost
            The association has ended.
        RuntimeError
            The caller is a callback of the library, which would wait for itself.
        """
        if inside_callback():
            raise RuntimeError(
                f"{operation}: no requests from a callback of the MMS library; hand over to a thread"
            )
        with self._lock:
            if not self.is_open:
                raise errors.ConnectionLost(self.host, operation, 0, "the connection is closed")
            yield self._pointer

    def request(
        self, operation: str, function: ServiceFunction, *arguments: object, longest_s: float | None = None
    ) -> int | None:
        """Carry out one confirmed service.

        Parameters
        ----------
        operation : str
            The service and its object, for messages.
        function : ServiceFunction
            The library's function. It is called with the connection, the error cell and `arguments`.
        *arguments : object
            Further arguments of the function.
        longest_s : float, optional
            Limit for a function that requests part after part [s]. The connection is ended when it is over.

        Returns
        -------
        int or None
            The function's pointer result, if it has one.

        Raises
        ------
        MmsError
            The kind that belongs to the library's error number.
        Timeout
            The answer did not come in time, or `longest_s` is over.
        """
        with self.exclusive(operation) as pointer:
            error = ctypes.c_int(0)
            sent_s = time.monotonic()
            with nullcontext() if longest_s is None else self._limited(longest_s) as over:
                result = function(pointer, ctypes.byref(error), *arguments)
            if error.value not in (_CONNECTION_LOST, _TIMEOUT):
                self.round_trip_s = time.monotonic() - sent_s
        if error.value and over is not None and over.is_set():
            reason = f"expected all names in {longest_s:g} s, and more follow"
            raise errors.Timeout(self.host, operation, 0, reason)
        if error.value:
            raise self.resolve_timeout(errors.client_error(self.host, operation, error.value))
        return result if isinstance(result, int) else None

    def resolve_timeout(self, error: errors.MmsError) -> errors.MmsError:
        """Turn a timeout into ConnectionLost where the association has ended.

        The library ends a request with a timeout when the association is lost meanwhile.

        Parameters
        ----------
        error : MmsError
            Error of a request.

        Returns
        -------
        MmsError
            ConnectionLost in place of Timeout if the association has ended, else `error`.
        """
        if isinstance(error, errors.Timeout) and self._notice.event.wait(self.limits.loss_notice_s):
            return errors.ConnectionLost(self.host, error.operation, error.code, "the connection was lost")
        return error

    def abandon(self) -> None:
        """Let no further request begin, without waiting. The connection is still to be closed."""
        if self._state is _State.OPEN:
            self._state = _State.CLOSING

    def close(self) -> None:
        """Release the association and free it.

        It waits for a request under way, at most that request's timeout. Closing a closed connection does
        nothing.

        Raises
        ------
        RuntimeError
            The caller is a callback of the library, which would wait for itself.
        """
        if inside_callback():
            raise RuntimeError("close: not from a callback of the MMS library; hand over to a thread")
        if self._state is _State.OPEN:
            self._state = _State.CLOSING
        with self._lock:
            if self._state is _State.CLOSED:
                return
            self._state = _State.CLOSED
            self._destroy()
            self._credentials.destroy()
        self._notice.notify()
        _open_connections.discard(self)

    def _destroy(self) -> None:
        pointer, self._pointer = self._pointer, 0
        if pointer:
            self.lib.IedConnection_destroy(pointer)
        self._handlers.clear()


_open_connections: Final[set[Connection]] = set()
"""References that keep the callbacks of a connection forgotten open alive as long as C may call them."""


@atexit.register
def _close_all() -> None:
    for connection in list(_open_connections):
        connection.close()
