"""MMS client of one relay: the ACSI services of IEC 61850-7-2 as methods, mapped by IEC 61850-8-1."""

import queue
from collections.abc import Callable, Sequence
from types import TracebackType
from typing import Self

from mms.client import controls
from mms.client.connection import Connection
from mms.client.data_values import DataSetMember, read_data_set, read_together, read_value
from mms.client.files import FileEntry, Sink, download, list_files
from mms.client.limits import DEFAULT_LIMITS, ClientLimits
from mms.client.model_browser import ModelBrowser
from mms.client.reports import Report, Subscriptions
from mms.errors import MmsError
from mms.references import FunctionalConstraint
from mms.security.tls import TlsConfiguration
from mms.values import Value


class Client(ModelBrowser):
    """Association with one relay.

    A client is a context manager that closes its association. It may be used from several threads; one
    request is under way at a time. Methods raise the kinds of MmsError, and ValueError for a malformed
    reference. No method may be called from `on_closed`.

    Use `Client.connect` to make one.

    Parameters
    ----------
    connection : Connection
        The open association.

    References
    ----------
    IEC 61850-7-2, abstract communication service interface; IEC 61850-8-1, mapping to MMS.
    """

    def __init__(self, connection: Connection) -> None:
        super().__init__(connection)
        self._subscriptions = Subscriptions(connection)
        self._directories: dict[str, tuple[str, ...]] = {}

    @classmethod
    def connect(
        cls, host: str, port: int = 102, *, connect_timeout_s: float = 5.0, request_timeout_s: float = 5.0,
        on_closed: Callable[[], None] | None = None, tls: TlsConfiguration | None = None,
        password: str | None = None, limits: ClientLimits = DEFAULT_LIMITS,
    ) -> Self:  # fmt: skip
        """Associate with a relay.

        Parameters
        ----------
        host : str
            Host name or IPv4 address.
        port : int
            TCP port: 102 by convention, 3782 with TLS.
        connect_timeout_s : float
            Time within which the association is to stand, approximately [s].
        request_timeout_s : float
            Longest wait for the answer to one request [s].
        on_closed : callable, optional
            Called once when the association has ended: on a thread of its own, or on that of whoever closes
            the client. A frozen relay ends nothing: only a successful read shows that it works.
        tls : TlsConfiguration, optional
            Our certificate and those we trust. Without it the association is not encrypted.
        password : str, optional
            Password of ACSE, printable ASCII. It is sent in clear unless `tls` is given.
        limits : ClientLimits
            Limits on exchanges that a request's timeout does not end.

        Returns
        -------
        Client
            The client with its open association.

        Raises
        ------
        ConnectFailed
            No association came about. Its subclasses say why: RelayNotTrusted, CertificateRefused,
            TlsNotSpoken, TlsRequired, AssociationRejected, AssociationBroken.
        CredentialFileError
            A file of `tls` cannot be used; nothing was sent.
        ValueError
            The password cannot be sent.

        References
        ----------
        IEC 61850-7-2 clause 8, Associate; ISO 8650-1 clause 8.1, authentication by password; IEC 62351-3,
        TLS.
        """
        return cls(
            Connection(
                host, port, connect_timeout_s=connect_timeout_s, request_timeout_s=request_timeout_s,
                on_closed=on_closed, tls=tls, password=password, limits=limits,
            )
        )  # fmt: skip

    @property
    def host(self) -> str:
        """Peer as "address:port"."""
        return self._connection.host

    @property
    def is_open(self) -> bool:
        """Whether the association stands, as far as the library knows."""
        return self._connection.is_open

    @property
    def round_trip_s(self) -> float | None:
        """Duration of the latest exchange [s]; None before the first."""
        return self._connection.round_trip_s

    def abandon(self) -> None:
        """Let no further request begin, without waiting.

        The request under way is the last; a download ends with its current part. Further requests raise
        ConnectionLost. Any thread may call this. Whoever opened the client still closes it.
        """
        self._connection.abandon()

    def wait_closed(self, timeout_s: float | None = None) -> bool:
        """Wait until the association has ended.

        Parameters
        ----------
        timeout_s : float, optional
            Longest wait [s]. Without limit by default.

        Returns
        -------
        bool
            False if the association still stands after `timeout_s`.
        """
        return self._connection.wait_closed(timeout_s)

    def close(self) -> None:
        """End the association.

        It waits for a request under way; a download ends with its current part. Closing a closed client does
        nothing.
        """
        self._connection.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def read(self, reference: str, constraint: FunctionalConstraint) -> Value:
        """Read a data object or attribute.

        Parameters
        ----------
        reference : str
            Reference "LD/LN.DO" or "LD/LN.DO.DA".
        constraint : FunctionalConstraint
            Functional constraint of what is read.

        Returns
        -------
        Value
            The value. A structure is a tuple in the order of the model.

        Raises
        ------
        AccessDenied, NotFound, TemporarilyUnavailable, ValueRefused
            The relay answers that it gives no value.
        ProtocolError
            The relay answers with something that is no value.

        References
        ----------
        IEC 61850-7-2, GetDataValues.
        """
        return read_value(self._connection, reference, constraint)

    def read_together(
        self, references: Sequence[str], constraint: FunctionalConstraint
    ) -> tuple[Value | MmsError, ...]:
        """Read several data attributes of one logical device in one request.

        Parameters
        ----------
        references : sequence of str
            References "LD/LN.DO.DA", all of one logical device, one at least.
        constraint : FunctionalConstraint
            Functional constraint of what is read.

        Returns
        -------
        tuple of Value or MmsError
            The values in order; the error, not raised, of each that the relay does not give.

        Raises
        ------
        MmsError
            The relay does not answer, or refuses the request as a whole, as one that cannot read lists does.
        ProtocolError
            The relay answers with something else than so many values.
        ValueError
            The references are of several logical devices, or there are none, or more than 64.

        References
        ----------
        ISO 9506-2, Read with a listOfVariable.
        """
        return read_together(self._connection, references, constraint)

    def read_data_set(self, reference: str) -> tuple[DataSetMember, ...]:
        """Read the values of all members of a data set in one request.

        The directory of a data set is read once for each association.

        Parameters
        ----------
        reference : str
            Reference "LD/LN.name".

        Returns
        -------
        tuple of DataSetMember
            The members in order. One that the relay cannot give has a DataAccessError for its value.

        Raises
        ------
        ProtocolError
            The values do not match the directory.

        References
        ----------
        IEC 61850-7-2, GetDataSetValues.
        """
        if reference not in self._directories:
            self._directories[reference] = self.data_set_directory(reference)
        return read_data_set(self._connection, reference, self._directories[reference])

    def operate(self, reference: str, value: bool, *, originator: str = "mcc") -> None:
        """Operate a controllable object by the control model that it declares.

        Parameters
        ----------
        reference : str
            Reference "LD/LN.DO".
        value : bool
            The value to bring the object to.
        originator : str
            Identification of the originator, at most 16 ASCII characters: long ones have rebooted relays.

        Raises
        ------
        ControlRefused
            The relay refuses; the error says why in words.
        Timeout
            The command termination does not come.

        References
        ----------
        IEC 61850-7-2 clause 20, control.
        """
        controls.operate(self._connection, reference, value=value, originator=originator)

    def subscribe(
        self, rcb_reference: str, reports: "queue.SimpleQueue[Report]", *, entry_id: bytes | None = None,
        general_interrogation: bool = False,
    ) -> None:  # fmt: skip
        """Enable a report control block and deliver its reports to a queue.

        Parameters
        ----------
        rcb_reference : str
            Reference of the block: "LD/LLN0.BR.BRep01", or "LD/LLN0.RP.URep01" if it is unbuffered.
        reports : queue.SimpleQueue of Report
            Receives the reports.
        entry_id : bytes, optional
            The last entry received, 8 octets. A buffered block resumes right after it.
        general_interrogation : bool
            Whether to ask for a report of all members at once.

        Raises
        ------
        ReportControlInUse
            Another client has the block.
        EntryNotFound
            The relay no longer holds the entry `entry_id`.

        References
        ----------
        IEC 61850-7-2 clause 17, reporting.
        """
        self._subscriptions.subscribe(
            rcb_reference, reports, entry_id=entry_id, general_interrogation=general_interrogation
        )

    def unsubscribe(self, rcb_reference: str) -> None:
        """Disable a report control block of this client.

        Parameters
        ----------
        rcb_reference : str
            Reference of the block.
        """
        self._subscriptions.unsubscribe(rcb_reference)

    def files(self, directory: str = "") -> tuple[FileEntry, ...]:
        """List all files of a directory.

        Parameters
        ----------
        directory : str
            Name of the directory, "" for the root.

        Returns
        -------
        tuple of FileEntry
            The files. Names are the relay's octets read as Latin-1.

        Raises
        ------
        Timeout
            The listing takes longer than the limits allow, though each of its parts comes in time.

        References
        ----------
        IEC 61850-7-2 clause 23, file transfer.
        """
        return list_files(self._connection, directory)

    def download(self, name: str, sink: Sink, *, expected_size: int | None = None) -> int:
        """Stream a file to a sink.

        Requests of other threads may go between the parts of the file.

        Parameters
        ----------
        name : str
            Name of the file as the relay lists it.
        sink : Sink
            Receives the bytes in order.
        expected_size : int, optional
            Size of the file as it was listed [byte]. Without it, the size that the relay announces at opening
            must do.

        Returns
        -------
        int
            Number of bytes received.

        Raises
        ------
        NotFound, AccessDenied
            The relay does not give the file.
        FileSizeMismatch
            The bytes are fewer or more than expected, or the name is no file's.
        Timeout
            A part does not come in time, or the throughput is too low.

        References
        ----------
        IEC 61850-7-2 clause 23, GetFile; ISO 9506-2, FileOpen, FileRead, FileClose.
        """
        return download(self._connection, name, sink, expected_size)
