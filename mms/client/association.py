"""Making of an association: connect, associate, and a first request that shows that it stands.

A host name may have several addresses, some of them dead: each is tried in its share of the time. The library
may report success and lose the association at the first request. So a first request follows every connect,
and the whole is tried again when just that happens.
"""

import ctypes
import logging
import socket
import time
from collections.abc import Callable
from typing import Final

from mms import errors
from mms.binding.linked_lists import take_names
from mms.binding.made_socket import DescriptorsExhaustedError
from mms.client.closed_notice import ClosedNotice
from mms.client.connect_failure import explain_failure
from mms.client.credentials import Credentials
from mms.client.library_connection import LibraryConnection
from mms.client.limits import ClientLimits

log: Final = logging.getLogger("mms")

_CONNECTION_LOST: Final = 3
_REJECTED: Final = 5
_TIMEOUT: Final = 20
_MALFORMED: Final = 34
_REQUEST_REJECTED: Final = 98
_OF_FIRST_REQUEST: Final = {2: _CONNECTION_LOST, 3: _TIMEOUT, 4: _MALFORMED}
"""Numbers of the library's MMS services in those of its client functions; others are rejects."""
_ENDLESS: Final = -1

_ATTEMPTS: Final = 5
_PAUSE_BETWEEN_ATTEMPTS_S: Final = 0.02


def resolve(host: str, port: int) -> tuple[str, ...]:
    """Find the IPv4 addresses of a host.

    Parameters
    ----------
    host : str
        Host name or IPv4 address.
    port : int
        TCP port.

    Returns
    -------
    tuple of str
        The addresses, each once.

    Raises
    ------
    ConnectFailed
        The name is unknown or the number is no TCP port.
    """
    named = f"{host}:{port}"
    if not 0 < port < 65536:
        raise errors.ConnectFailed(named, "connect", 0, f"not a TCP port: {port}")
    try:
        found = socket.getaddrinfo(host, port, socket.AF_INET, socket.SOCK_STREAM)
    except (OSError, UnicodeError) as error:
        raise errors.ConnectFailed(named, "connect", 0, f"cannot resolve the name: {error}") from error
    return tuple(dict.fromkeys(str(address[0]) for *_, address in found))


class Association:
    """The library's connection object of one association, and what belongs to it.

    Parameters
    ----------
    lib : ctypes.CDLL
        The library.
    credentials : Credentials
        What the relay is shown.
    limits : ClientLimits
        Limits on exchanges that a request's timeout does not end.
    on_closed : callable or None
        Called once when the association has ended.

    Attributes
    ----------
    connection : LibraryConnection
        The library's connection object, once `connect` has returned.
    notice : ClosedNotice
        Tells that the association has ended.
    handlers : list of object
        Callbacks that C holds until they are uninstalled or all is destroyed.
    first_names : list of str or None
        Names of the logical devices, from the first request; None where the relay gave none for now.
    """

    def __init__(
        self,
        lib: ctypes.CDLL,
        credentials: Credentials,
        limits: ClientLimits,
        on_closed: Callable[[], None] | None,
    ) -> None:
        self._lib = lib
        self._credentials = credentials
        self._limits = limits
        self._on_closed = on_closed
        self.connection: LibraryConnection
        self.notice = ClosedNotice(on_closed)
        self.handlers: list[object] = []
        self.first_names: list[str] | None = None

    def connect(
        self, host: str, addresses: tuple[str, ...], port: int, *, timeout_s: float, request_timeout_s: float
    ) -> None:
        """Associate with the first address that accepts.

        Parameters
        ----------
        host : str
            The relay as the user named it, "host:port".
        addresses : tuple of str
            IPv4 addresses, tried in turn.
        port : int
            TCP port.
        timeout_s : float
            Time within which the association is to stand, approximately [s].
        request_timeout_s : float
            Longest wait for the answer to one later request [s].

        Raises
        ------
        ConnectFailed
            None accepts; its subclasses say why.
        """
        deadline = time.monotonic() + timeout_s
        for turn, address in enumerate(addresses, 1):
            now = time.monotonic()
            end = now + (deadline - now) / (len(addresses) - turn + 1)
            code = self._associate(host, address, port, end)
            if code == 0:
                self._lib.IedConnection_setRequestTimeout(
                    self.connection.pointer, round(request_timeout_s * 1000)
                )
                return
            if turn < len(addresses):
                continue
            error = self._refused(host, code, (address, port), deadline)
            if len(addresses) > 1:
                reason = f"{error.message} (the last of its addresses {', '.join(addresses)})"
                error = type(error)(host, "connect", code, reason)
            raise error

    def destroy(self) -> None:
        """Free the library's object, and with it the callbacks."""
        self.connection.destroy()
        self.handlers.clear()

    def _refused(self, host: str, code: int, address: tuple[str, int], deadline: float) -> errors.MmsError:
        if code == _CONNECTION_LOST and self._credentials.tls is None:
            reason = "the relay ends every association at once: no session left?"
            return errors.ConnectFailed(host, "connect", code, reason)
        if code == _ENDLESS:
            reason = f"expected the names of all it offers in {self._limits.names_s:g} s, and more follow"
            return errors.ConnectFailed(host, "connect", 0, reason)
        if code not in (_CONNECTION_LOST, _REJECTED):
            found = errors.client_error(host, "connect", code)
            is_broken = isinstance(found, errors.ProtocolError)
            kind = errors.AssociationBroken if is_broken else errors.ConnectFailed
            return kind(host, "connect", code, found.message)
        return explain_failure(
            host, address, self._credentials.tls, password=self._credentials.has_password, deadline=deadline
        )

    def _associate(self, host: str, address: str, port: int, deadline: float) -> int:
        """Return 0 when the association stands, _CONNECTION_LOST when it was lost at once each time."""
        for attempt in range(1, _ATTEMPTS + 1):
            remaining_s = deadline - time.monotonic()
            if remaining_s <= 0 and attempt > 1:
                break
            self.notice = ClosedNotice(self._on_closed)
            code = self._attempt(address, port, max(remaining_s, 0.001))
            if code == 0 and self.notice.arm():
                return 0
            self.destroy()
            if code not in (0, _CONNECTION_LOST):
                return code
            log.debug("%s: the association was lost at once, attempt %d of %d", host, attempt, _ATTEMPTS)
            time.sleep(_PAUSE_BETWEEN_ATTEMPTS_S)
        return _CONNECTION_LOST

    def _attempt(self, address: str, port: int, timeout_s: float) -> int:
        self.connection = LibraryConnection(
            self._lib,
            self._credentials.new_connection(),
            has_thread=self._credentials.tls is not None,
            notice=self.notice,
        )
        try:
            code = self.connection.connect(address, port, timeout_s)
        except DescriptorsExhaustedError as error:
            self.destroy()
            raise errors.ConnectFailed(f"{address}:{port}", "connect", 0, str(error)) from error
        return code or self._first_request(timeout_s)

    def _first_request(self, timeout_s: float) -> int:
        """Return 0 if the relay answers properly: that it cannot tell its names for now is an answer."""
        lib = self._lib
        error = ctypes.c_int(0)
        connection = self.connection
        with connection.limited(self._limits.names_s) as over, connection.requesting(timeout_s):
            mms = lib.IedConnection_getMmsConnection(connection.pointer)
            names = lib.MmsConnection_getDomainNames(mms, ctypes.byref(error))
        listed = take_names(lib, names)
        if over.is_set():
            return _ENDLESS
        if errors.is_answered(error.value):
            self.first_names = None if error.value else listed
            return 0
        code = _OF_FIRST_REQUEST.get(error.value, _REQUEST_REJECTED)
        if code == _TIMEOUT and self.notice.event.wait(self._limits.loss_notice_s):
            return _CONNECTION_LOST
        return code
