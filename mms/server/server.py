"""MMS server with an IEC 61850 data model: the relay's side (IEC 61850-7-2, mapped by IEC 61850-8-1).

The library serves without threads of its own; a ServerPump drives any number of servers from one thread.
"""

import threading
from collections.abc import Callable, Iterable, Mapping
from enum import Enum
from pathlib import Path
from types import TracebackType
from typing import Final, Self

from mms.binding.library import library
from mms.errors import ModelError, ServerStartFailed
from mms.security.passwords import make_authenticator
from mms.security.tls import TlsConfiguration, TlsContext
from mms.server.attributes import Attributes
from mms.server.connection_limits import ConnectionLimits
from mms.server.controls import OperateHandler
from mms.server.file_access import FileGuard, FileHook
from mms.server.handlers import Handlers
from mms.server.model import Model
from mms.server.pump import ServerPump
from mms.server.read_access import ReadHandler
from mms.server.services import MOST_CONNECTIONS, Identity, Services, create_server, name_server
from mms.values import Quality, Value


class _State(Enum):
    CREATED = "created"
    RUNNING = "running"
    STOPPED = "stopped"


class Server:
    """One simulated IED; a context manager that serves while it is entered.

    Handlers run on the pump's thread, one at a time, with the server locked. They should return at once. They
    may update this server, and post to any server. They must not update or read another server, nor take a
    lock that another thread holds while it updates or reads this one. A handler that raises is logged and
    counts as a refusal.

    `start` or a ServerPump makes the server listen. Replace served files by renaming: a file that shrinks
    while it is sent is filled up with whatever the memory holds.

    Parameters
    ----------
    model_text : str
        The library's configuration text.
    port : int
        TCP port.
    ied_name : str, optional
        Name of the IED in place of the text's.
    address : str
        IPv4 address to listen at.
    file_root : pathlib.Path, optional
        Folder whose files are served, read only. Without it there is no file service.
    max_connections : int
        Most clients at once, up to the library's own limit of 5.
    report_buffer_bytes : int
        Buffer of each report control block [byte].
    on_file_request : FileHook, optional
        Function that is asked first about each file request.
    tls : TlsConfiguration, optional
        Our certificate and those we trust. With it only clients with a pinned certificate are served.
    passwords : iterable of str
        Accepted passwords. Without any, no password is required.
    tls_handshake_timeout_s : float
        Longest TLS handshake, during which nobody else is served [s].
    association_timeout_s : float, optional
        Time after which a client that has not associated is sent away [s]. Without it the library waits.
    identity : Identity, optional
        What the Identify service answers. The library's own name by default.
    dynamic_data_sets : int
        Most data sets of a logical device, those of its model included. Clients may create so many. 0 for no
        such service.
    optional_fields_writable : bool
        Whether clients may choose the optional fields of reports (OptFlds).

    Raises
    ------
    ModelError
        The text is wrong in any way, also where the library would not mind.
    CredentialFileError
        A file of `tls` cannot be used.
    ValueError
        The port or the number of connections is out of range, or a password cannot be sent.
    """

    def __init__(
        self, model_text: str, *, port: int, ied_name: str | None = None, address: str = "127.0.0.1",
        file_root: Path | None = None, max_connections: int = MOST_CONNECTIONS,
        report_buffer_bytes: int = 65_536, on_file_request: FileHook | None = None,
        tls: TlsConfiguration | None = None, passwords: Iterable[str] = (),
        tls_handshake_timeout_s: float = 5.0, association_timeout_s: float | None = None,
        identity: Identity | None = None, dynamic_data_sets: int = 0, optional_fields_writable: bool = True,
    ) -> None:  # fmt: skip
        if not 0 < port < 65536:
            raise ValueError(f"not a TCP port: {port} (the library cannot choose one)")
        services = Services(
            file_root, max_connections, report_buffer_bytes, dynamic_data_sets, optional_fields_writable
        )
        self.address: Final = address
        self.port: Final = port
        self._lib: Final = library()
        self._lock = threading.RLock()
        self._state = _State.CREATED
        self._updated: Callable[[], None] | None = None
        self._limits = ConnectionLimits(
            (address, port),
            handshake_s=None if tls is None else tls_handshake_timeout_s,
            association_s=association_timeout_s,
        )
        self._pump: ServerPump | None = None
        authenticate = make_authenticator(self._lib, passwords)
        self._tls = None if tls is None else TlsContext(self._lib, tls)
        try:
            self._model = Model(self._lib, model_text, ied_name)
            try:
                tls_pointer = None if self._tls is None else self._tls.pointer
                self._server = create_server(self._lib, self._model.pointer, tls_pointer, services)
            except ModelError:
                self._model.destroy()
                raise
        except BaseException:
            if self._tls is not None:
                self._tls.destroy()
            raise
        self._attributes = Attributes(self._lib, self._model, self._server)
        name_server(self._lib, self._server, address, identity)
        self._handlers = Handlers(self._lib, self._model, self._server, self._attributes)
        if authenticate is not None:
            self._handlers.authenticate(authenticate)
        if file_root is not None:
            self._handlers.guard_files(FileGuard(file_root, on_file_request))

    # Lifetime

    @property
    def is_running(self) -> bool:
        """Whether the server listens and serves."""
        return self._state is _State.RUNNING

    @property
    def connections(self) -> int:
        """Number of connected clients."""
        with self._lock:
            return int(self._lib.IedServer_getNumberOfOpenConnections(self._server)) if self.is_running else 0

    def start(self) -> None:
        """Listen and serve on a thread of its own.

        Raises
        ------
        ServerStartFailed
            The address and port cannot be had.
        """
        pump = ServerPump([self])
        pump.start()
        self._pump = pump

    def stop(self) -> None:
        """Close every connection and free the server, for good; a second call does nothing."""
        pump, self._pump = self._pump, None
        if pump is not None:
            pump.stop()
        self.close()

    def __enter__(self) -> Self:
        if self._state is _State.CREATED:
            self.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()

    # Data

    def update(self, reference: str, value: Value | Quality) -> None:
        """Set one data attribute, and report it if that triggers a report.

        Parameters
        ----------
        reference : str
            Reference "LD/LN.DO.DA", the LD with the IED's name.
        value : Value or Quality
            The new value.

        Raises
        ------
        ModelError
            There is no such attribute, or the value does not fit its type.
        """
        self.update_many({reference: value})

    def update_many(self, values: Mapping[str, Value | Quality], *, whole_objects: bool = False) -> None:
        """Set several attributes as one change: a reader sees all of them or none.

        Either every value fits or nothing is changed. Times are set first, so that an event carries its own.
        What is set before the server listens are its first values: no report tells them. A report is closed
        when a second value of one of its members changes, so that one change may take several reports, each
        of whole members. With `whole_objects` it takes one.

        Parameters
        ----------
        values : mapping of str to Value or Quality
            New values by reference.
        whole_objects : bool
            Whether the data sets have whole data objects alone. A member that is an attribute could miss its
            change.

        Raises
        ------
        ModelError
            There is no such attribute, or a value does not fit its type.
        """
        with self._lock:
            self._require_alive("update")
            self._attributes.apply_posted_or_log()
            self._attributes.update(values, whole_objects=whole_objects)
            self._note_update()

    def post(self, values: Mapping[str, Value | Quality]) -> None:
        """Set several attributes as one change, soon: a client's request meanwhile may still miss it.

        Any thread may call this, with any lock held, because it does not wait for the server's. The pump
        makes the changes in the order they were posted, within a millisecond or so. What a handler posts is
        there before its client is answered. A change that does not fit the model is logged. A stopped server
        makes none.

        Parameters
        ----------
        values : mapping of str to Value or Quality
            New values by reference, not changed by the caller afterwards.
        """
        self._attributes.post(values)
        self._note_update()

    def apply_posted(self) -> None:
        """Make the posted changes now.

        Raises
        ------
        ModelError
            A change does not fit the model. Those after it stay posted.
        """
        with self._lock:
            self._require_alive("apply_posted")
            self._attributes.apply_posted()

    def read(self, reference: str) -> Value:
        """Read one of this server's own data attributes.

        Parameters
        ----------
        reference : str
            Reference "LD/LN.DO.DA".

        Returns
        -------
        Value
            The present value.

        Raises
        ------
        ModelError
            There is no such attribute.
        """
        with self._lock:
            self._require_alive("read")
            self._attributes.apply_posted_or_log()
            return self._attributes.read(reference)

    # Controls

    def on_operate(self, reference: str, handler: OperateHandler) -> None:
        """Set the handler for Operate of a controllable object. The handler itself updates stVal.

        Parameters
        ----------
        reference : str
            Reference "LD/LN.DO".
        handler : callable
            Called with a ControlAction. It returns True to accept, False or an AddCause to refuse. With
            normal security a refusal is a negative response, with enhanced security a negative
            CommandTermination.

        References
        ----------
        IEC 61850-7-2 clause 20, control.
        """
        with self._lock:
            self._require_alive("on_operate")
            self._handlers.on_operate(reference, handler)

    def on_read(self, reference: str, handler: ReadHandler) -> None:
        """Set the handler that is asked before a client reads a data object or a part of it.

        Parameters
        ----------
        reference : str
            Reference "LD/LN.DO".
        handler : callable
            Called without arguments. It returns None, or the DataAccessError that the client gets instead of
            the value.
        """
        with self._lock:
            self._require_alive("on_read")
            self._handlers.on_read(reference, handler)

    # Called by the pump

    def listen(self) -> None:
        """Open the port. The pump calls this and then serves.

        Raises
        ------
        ServerStartFailed
            The address and port cannot be had.
        """
        with self._lock:
            where = f"{self.address}:{self.port}"
            if self._state is not _State.CREATED:
                raise ServerStartFailed(where, "start the server", 0, f"the server is {self._state.value}")
            self._lib.IedServer_startThreadless(self._server, self.port)
            if not self._lib.IedServer_isRunning(self._server):
                # Without this the library would later end a thread that it never began.
                self._lib.IedServer_stopThreadless(self._server)
                reason = "cannot listen there: the port is taken, or the address is not this machine's"
                raise ServerStartFailed(where, "start the server", 0, reason)
            self._attributes.apply_posted_or_log()
            self._attributes.has_clients = True
            self._state = _State.RUNNING
            self._limits.start()

    def serve_pending(self) -> bool:
        """Serve what clients have sent. The pump calls this.

        Returns
        -------
        bool
            False if nothing had come.
        """
        with self._lock:
            if self._state is not _State.RUNNING or self._lib.IedServer_waitReady(self._server, 0) <= 0:
                return False
            self._attributes.apply_posted_or_log()
            self._process_incoming()
            self._lib.IedServer_performPeriodicTasks(self._server)
            return True

    def take_turn(self) -> bool:
        """Do periodic tasks and send waiting reports. The pump calls this.

        The library sends reports only while it looks for data, and there it waits 1 ms for some to come.

        Returns
        -------
        bool
            True if that waited a millisecond.
        """
        with self._lock:
            if self._state is not _State.RUNNING:
                return False
            self._attributes.apply_posted_or_log()
            self._lib.IedServer_performPeriodicTasks(self._server)
            if self._lib.IedServer_getNumberOfOpenConnections(self._server) == 0:
                return False
            self._process_incoming()
            # A command that came in that millisecond is carried out now, not in the next turn.
            self._lib.IedServer_performPeriodicTasks(self._server)
            return True

    def _process_incoming(self) -> None:
        """Accept, read and answer. A TLS handshake is waited for, with everything else at a standstill."""
        with self._limits.accepting():
            self._lib.IedServer_processIncomingData(self._server)

    def tell_updates(self, updated: Callable[[], None]) -> None:
        """Call this after each update, on whichever thread made it. The pump wants to know.

        Parameters
        ----------
        updated : callable
            Must neither wait nor fail.
        """
        self._updated = updated

    def _note_update(self) -> None:
        if self._updated is not None:
            self._updated()

    def close(self) -> None:
        """Free the server once no pump drives it: stop, destroy the server, then its model."""
        with self._lock:
            if self._state is _State.STOPPED:
                return
            if self._state is _State.RUNNING:
                self._limits.stop()
                self._lib.IedServer_stopThreadless(self._server)
            self._state = _State.STOPPED
            self._lib.IedServer_destroy(self._server)
            self._server = 0
            if self._tls is not None:
                self._tls.destroy()
            self._model.destroy()
            self._handlers.clear()

    def _require_alive(self, operation: str) -> None:
        if self._state is _State.STOPPED:
            raise RuntimeError(f"{operation}: the server {self.address}:{self.port} is stopped")
