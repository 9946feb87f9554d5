"""One MMS association on the client side (IEC 61850-7-2 clause 8: Associate, Release, Abort).

A Connection has one lock and one state, and destroys its C object exactly once. It lets one request at a time
through, because real relays are confused by parallel ones. The other client modules use the association
through `request` and `exclusive`.
"""

import atexit
import ctypes
import secrets
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from enum import Enum
from typing import Final, Protocol

from mms import errors
from mms.binding.callbacks import inside_callback
from mms.binding.library import library
from mms.client.association import Association, resolve
from mms.client.credentials import Credentials
from mms.client.limits import DEFAULT_LIMITS, ClientLimits
from mms.client.tick_loop import TickedConnection
from mms.security.tls import TlsConfiguration

_CONTROL_NUMBERS: Final = 256


class _State(Enum):
    OPEN = "open"
    CLOSING = "closing"
    CLOSED = "closed"


class ServiceFunction(Protocol):
    """Function of the library whose first arguments are the connection and a cell for the error number."""

    def __call__(self, connection: int, error: ctypes.c_int, *arguments: object) -> object:
        """Call the function."""


class MakeError(Protocol):
    """Function that makes the error for a number of the library."""

    def __call__(self, host: str, operation: str, code: int) -> errors.MmsError:
        """Return the error."""


class Connection:
    """Open association with one relay.

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
        self.round_trip_s: float | None = None
        self._commands: dict[str, int] = {}
        addresses = resolve(host, port)
        self._credentials = Credentials(self.lib, tls, password)
        self._association = Association(self.lib, self._credentials, limits, on_closed)
        try:
            self._association.connect(
                self.host, addresses, port, timeout_s=connect_timeout_s, request_timeout_s=request_timeout_s
            )
        except BaseException:
            self._credentials.destroy()
            raise
        self._state = _State.OPEN
        _open_connections.add(self)

    @property
    def first_names(self) -> list[str] | None:
        """Names of the logical devices, from the first request; None where the relay gave none for now."""
        return self._association.first_names

    @property
    def is_open(self) -> bool:
        """Whether the association stands, as far as the library knows."""
        return self._state is _State.OPEN and not self._association.notice.event.is_set()

    @property
    def closing(self) -> bool:
        """Whether `abandon` or `close` has been called."""
        return self._state is not _State.OPEN

    @property
    def ticked(self) -> TickedConnection | None:
        """The connection as a loop drives it; None where the library has a thread for it."""
        return self._association.connection.ticked

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
        return self._association.notice.event.wait(timeout_s)

    def count_command(self, reference: str) -> int:
        """Count a command on a control object: each has a control number (ctlNum) one above the last.

        The first of an association is any: a relay may take the latest command's number for a repetition.

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
        before = self._commands.setdefault(reference, secrets.randbelow(_CONTROL_NUMBERS))
        self._commands[reference] = (before + 1) % _CONTROL_NUMBERS
        return before

    def keep_callback(self, handler: object) -> None:
        """Hold a callback for as long as C may call it.

        Parameters
        ----------
        handler : object
            The ctypes callback.
        """
        with self._lock:
            self._association.handlers.append(handler)

    def release_callback(self, handler: object) -> None:
        """Let go of a callback that C cannot call any more.

        Parameters
        ----------
        handler : object
            The ctypes callback, as it was given to `keep_callback`.
        """
        with self._lock:
            self._association.handlers.remove(handler)

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
            connection = self._association.connection
            with connection.requesting(self.request_timeout_s):
                yield connection.pointer

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
        with nullcontext() if longest_s is None else self._association.connection.limited(longest_s) as over:
            result = function(pointer, error, *arguments)
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
        if isinstance(error, errors.Timeout) and self._association.notice.event.wait(
            self.limits.loss_notice_s
        ):
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
            self._association.destroy()
            self._credentials.destroy()
        self._association.notice.notify()
        _open_connections.discard(self)


_open_connections: Final[set[Connection]] = set()
"""References that keep the callbacks of a connection forgotten open alive as long as C may call them."""


@atexit.register
def _close_all() -> None:
    for connection in list(_open_connections):
        connection.close()
