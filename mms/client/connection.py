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
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from enum import Enum
from typing import Final, Protocol

from mms import errors
from mms.binding.callbacks import guarded, inside_callback
from mms.binding.connection_deadline import connections_between, end_connections_after, open_sockets
from mms.binding.library import library
from mms.binding.linked_lists import take_names
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
_MALFORMED: Final = 34
_REQUEST_REJECTED: Final = 98
_OF_FIRST_REQUEST: Final = {2: _CONNECTION_LOST, 3: _TIMEOUT, 4: _MALFORMED}
"""Numbers of the library's MMS services in those of its client functions; others are rejects."""
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


class MakeError(Protocol):
    """Function that makes the error for a number of the library."""

    def __call__(self, host: str, operation: str, code: int) -> errors.MmsError:
        """Return the error."""


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
        self.first_names: list[str] | None = None
        """Names of the logical devices, from the first request; None where the relay gave none for now."""
        self._handlers: list[object] = []  # C holds them until they are uninstalled or all is destroyed
        self._commands: Counter[str] = Counter()
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
        code = error.value or self._first_request()
        lib.IedConnection_setRequestTimeout(self._pointer, round(self.request_timeout_s * 1000))
        return code

    def _first_request(self) -> int:
        """Return 0 if the relay answers properly: that it cannot tell its names for now is an answer."""
        lib = self.lib
        error = ctypes.c_int(0)
        with self._limited(self.limits.names_s) as over:
            mms = lib.IedConnection_getMmsConnection(self._pointer)
            names = lib.MmsConnection_getDomainNames(mms, ctypes.byref(error))
        listed = take_names(lib, names)
        if over.is_set():
            return _ENDLESS
        if errors.is_answered(error.value):
            self.first_names = None if error.value else listed
            return 0
        code = _OF_FIRST_REQUEST.get(error.value, _REQUEST_REJECTED)
        if code == _TIMEOUT and self._notice.event.wait(self.limits.loss_notice_s):
            return _CONNECTION_LOST
        return code

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

    def count_command(self, reference: str) -> int:
        """Count a command on a control object: each has a control number (ctlNum) one above the last.

        Parameters
        ----------
        reference : str
            Reference of the control object.

        Returns
        -------
        int
            The control number of the command before this one, 0 to 255; the library adds one.

        References
        ----------
        IEC 61850-7-2 clause 20, ctlNum.
        """
        before = self._commands[reference]
        self._commands[reference] = (before + 1) % 256
        return before

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
        self, operation: str, function: ServiceFunction, *arguments: object, longest_s: float | None = None,
        make_error: MakeError = errors.mms_error,
    ) -> int | None:  # fmt: skip
        """Carry out one confirmed service by a function of the library's MMS layer.

        These functions pass on what the relay answers: a ServiceError is told from a Reject.

        Parameters
        ----------
        operation : str
            The service and its object, for messages.
        function : ServiceFunction
            The library's function. It is called with the MMS connection, the error cell and `arguments`.
        *arguments : object
            Further arguments of the function.
        longest_s : float, optional
            Limit for a function that requests part after part [s]. The connection is ended when it is over.
        make_error : callable
            Makes the error for a number of the library's MmsError.

        Returns
        -------
        int or None
            The function's result, if it is a pointer or a number.

        Raises
        ------
        MmsError
            The kind that belongs to the library's error number.
        Timeout
            The answer did not come in time, or `longest_s` is over.
        """
        with self.exclusive(operation) as pointer:
            mms = self.lib.IedConnection_getMmsConnection(pointer)
            return self._carry_out(operation, function, mms, arguments, longest_s, make_error)

    def client_request(self, operation: str, function: ServiceFunction, *arguments: object) -> int | None:
        """Carry out one service by a function of the library's client layer.

        Parameters
        ----------
        operation : str
            The service and its object, for messages.
        function : ServiceFunction
            The library's function. It is called with the connection, the error cell and `arguments`.
        *arguments : object
            Further arguments of the function.

        Returns
        -------
        int or None
            The function's result, if it is a pointer or a number.

        Raises
        ------
        MmsError
            The kind that belongs to the library's error number.
        """
        with self.exclusive(operation) as pointer:
            return self._carry_out(operation, function, pointer, arguments, None, errors.client_error)

    def _carry_out(
        self, operation: str, function: ServiceFunction, pointer: int, arguments: tuple[object, ...],
        longest_s: float | None, make_error: MakeError,
    ) -> int | None:  # fmt: skip
        error = ctypes.c_int(0)
        sent_s = time.monotonic()
        with nullcontext() if longest_s is None else self._limited(longest_s) as over:
            result = function(pointer, ctypes.byref(error), *arguments)
        took_s = time.monotonic() - sent_s
        if not error.value:
            self.round_trip_s = took_s
            return result if isinstance(result, int) else None
        if over is not None and over.is_set():
            reason = f"expected all names in {longest_s:g} s, and more follow"
            raise errors.Timeout(self.host, operation, 0, reason)
        failure = make_error(self.host, operation, error.value)
        if not isinstance(failure, errors.ConnectionLost | errors.Timeout):
            self.round_trip_s = took_s
        raise self.resolve_timeout(failure)

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
