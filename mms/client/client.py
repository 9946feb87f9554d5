"""The MMS client of one relay: ACSI services of IEC 61850-7-2 as methods, mapped by IEC 61850-8-1."""

import queue
from collections.abc import Callable
from dataclasses import dataclass
from types import TracebackType
from typing import Final, Self

from mms import errors
from mms.binding.value_conversion import decode
from mms.client import controls
from mms.client.connection import Connection
from mms.client.data_sets import data_set_members
from mms.client.files import FileEntry, Sink, download, list_files
from mms.client.limits import DEFAULT_LIMITS, ClientLimits
from mms.client.reports import Report, Subscriptions
from mms.references import FunctionalConstraint, logical_device, object_reference
from mms.security.tls import TlsConfiguration
from mms.values import DataAccessError, Value

_DATA_OBJECT, _DATA_SET, _BUFFERED, _UNBUFFERED = range(4)  # the library's ACSIClass

_ACCESS_ERRORS: Final[dict[DataAccessError, type[errors.MmsError]]] = {
    DataAccessError.ACCESS_DENIED: errors.AccessDenied,
    DataAccessError.ACCESS_UNSUPPORTED: errors.AccessDenied,
    DataAccessError.TEMPORARILY_UNAVAILABLE: errors.TemporarilyUnavailable,
    DataAccessError.OBJECT_INVALIDATED: errors.NotFound,
    DataAccessError.UNDEFINED: errors.NotFound,
    DataAccessError.NON_EXISTENT: errors.NotFound,
}


@dataclass(frozen=True, slots=True)
class DataSetMember:
    """One member of a data set: its reference "LD/LN.DO.DA[FC]" and its value."""

    reference: str
    value: Value


class Client:
    """An association with one relay; a context manager, which closes it.

    Safe to use from several threads: one request is under way at a time. Methods raise MmsError's kinds, and
    ValueError for a malformed reference. Never call one from `on_closed`.
    """

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._subscriptions = Subscriptions(connection)
        self._directories: dict[str, tuple[str, ...]] = {}

    @classmethod
    def connect(
        cls, host: str, port: int = 102, *, connect_timeout_s: float = 5.0, request_timeout_s: float = 5.0,
        on_closed: Callable[[], None] | None = None, tls: TlsConfiguration | None = None,
        password: str | None = None, limits: ClientLimits = DEFAULT_LIMITS,
    ) -> Self:  # fmt: skip
        """Associate; ConnectFailed, or its kind that says why, if that does not succeed within about
        `connect_timeout_s`.

        With `tls`, over TLS (usually at port 3782), and with nobody but the pinned: RelayNotTrusted,
        CertificateRefused, TlsNotSpoken, or CredentialFileError before anything is sent; TlsRequired without.
        `password` is ACSE's, printable ASCII, in clear unless there is `tls`: AssociationRejected.

        `on_closed` is called once, on a thread of the library, when the association has ended, whoever ended
        it. A frozen relay ends nothing: only a successful read shows health.
        """
        return cls(
            Connection(
                host, port, connect_timeout_s=connect_timeout_s, request_timeout_s=request_timeout_s,
                on_closed=on_closed, tls=tls, password=password, limits=limits,
            )
        )  # fmt: skip

    @property
    def host(self) -> str:
        """The peer as "address:port"."""
        return self._connection.host

    @property
    def is_open(self) -> bool:
        return self._connection.is_open

    @property
    def round_trip_s(self) -> float | None:
        """How long the latest answer took [s]; None before the first."""
        return self._connection.round_trip_s

    def abandon(self) -> None:
        """From any thread, without waiting: the request under way is the last, a download ends early.

        Further ones raise ConnectionLost. Whoever opened the client still closes it.
        """
        self._connection.abandon()

    def wait_closed(self, timeout_s: float | None = None) -> bool:
        """Wait until the association has ended; False if it still stands after `timeout_s`."""
        return self._connection.wait_closed(timeout_s)

    def close(self) -> None:
        """End the association; harmless when ended. Waits for a request under way; a download ends early."""
        self._connection.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    # GetServerDirectory, GetLogicalDeviceDirectory, GetLogicalNodeDirectory

    def logical_devices(self) -> list[str]:
        """The logical devices (MMS domains), e.g. A1_SEL710CON."""
        lib = self._connection.lib
        return self._connection.strings(
            self._connection.request("list logical devices", lib.IedConnection_getLogicalDeviceList)
        )

    def logical_nodes(self, device: str) -> list[str]:
        """The logical nodes of one logical device, e.g. RBGGIO1; NotFound if there is no such device."""
        name = logical_device(device)
        lib = self._connection.lib
        return self._connection.strings(
            self._connection.request(
                f"list logical nodes of {device}", lib.IedConnection_getLogicalDeviceDirectory, name
            )
        )

    def data_objects(self, node: str) -> list[str]:
        """The data objects of a logical node "LD/LN"."""
        return self._node_directory(node, _DATA_OBJECT)

    def data_sets(self, node: str) -> list[str]:
        """The data sets of a logical node "LD/LN"."""
        return self._node_directory(node, _DATA_SET)

    def buffered_reports(self, node: str) -> list[str]:
        """The buffered report control blocks of a logical node "LD/LN"."""
        return self._node_directory(node, _BUFFERED)

    def unbuffered_reports(self, node: str) -> list[str]:
        """The unbuffered report control blocks of a logical node "LD/LN"."""
        return self._node_directory(node, _UNBUFFERED)

    def _node_directory(self, node: str, kind: int) -> list[str]:
        lib = self._connection.lib
        return self._connection.strings(
            self._connection.request(
                f"directory of {node}",
                lib.IedConnection_getLogicalNodeDirectory,
                object_reference(node),
                kind,
                longest_s=self._connection.limits.directory_s,
            )
        )

    # GetDataValues, GetDataSetValues, GetDataSetDirectory

    def read(self, reference: str, constraint: FunctionalConstraint) -> Value:
        """The value of a data object or attribute; a structure is a tuple in the order of the model.

        AccessDenied, NotFound, TemporarilyUnavailable, ValueRefused: the relay says that it gives none.
        """
        operation = f"read {reference}[{constraint.name}]"
        lib = self._connection.lib
        pointer = self._connection.request(
            operation, lib.IedConnection_readObject, object_reference(reference), int(constraint)
        )
        try:
            value = self._decode(operation, pointer)
        finally:
            lib.MmsValue_delete(pointer)
        if isinstance(value, DataAccessError):
            kind = _ACCESS_ERRORS.get(value, errors.ValueRefused)
            raise kind(self.host, operation, value.value, value.name.lower().replace("_", " "))
        return value

    def data_set_directory(self, reference: str) -> tuple[str, ...]:
        """The members' references "LD/LN.DO.DA[FC]" of the data set "LD/LN.name"."""
        return data_set_members(self._connection, reference)

    def read_data_set(self, reference: str) -> tuple[DataSetMember, ...]:
        """All members' values in one request; the directory is read once a connection.

        A member the relay cannot give has a DataAccessError for its value.
        """
        if reference not in self._directories:
            self._directories[reference] = self.data_set_directory(reference)
        names = self._directories[reference]
        operation = f"read data set {reference}"
        lib = self._connection.lib
        data_set = self._connection.request(
            operation, lib.IedConnection_readDataSetValues, object_reference(reference, names=2), None
        )
        if data_set is None:
            raise errors.ProtocolError(self.host, operation, 0, "no values came")
        try:
            values = self._decode(operation, lib.ClientDataSet_getValues(data_set))
        finally:
            lib.ClientDataSet_destroy(data_set)
        if not isinstance(values, tuple) or len(values) != len(names):
            raise errors.ProtocolError(
                self.host, operation, 0, f"expected {len(names)} values, found {values!r:.80}"
            )
        return tuple(DataSetMember(name, value) for name, value in zip(names, values, strict=True))

    def _decode(self, operation: str, pointer: int | None) -> Value:
        try:
            return decode(self._connection.lib, pointer)
        except ValueError as error:
            raise errors.ProtocolError(self.host, operation, 0, str(error)) from error

    # Operate, reports, files

    def operate(self, reference: str, value: bool, *, originator: str = "mcc") -> None:
        """Operate the controllable object "LD/LN.DO" by the control model it declares.

        ControlRefused says why in words. Keep the originator short: long ones have rebooted relays.
        """
        controls.operate(self._connection, reference, value=value, originator=originator)

    def subscribe(
        self, rcb_reference: str, reports: "queue.SimpleQueue[Report]", *, entry_id: bytes | None = None,
        general_interrogation: bool = False,
    ) -> None:  # fmt: skip
        """Enable the block "LD/LLN0.BR.BRep01" (or RP.URep01, unbuffered); its reports come to the queue.

        With `entry_id`, the last entry received, a buffered block resumes right after it: EntryNotFound if
        the relay no longer holds it. ReportControlInUse if another client has the block.
        """
        self._subscriptions.subscribe(
            rcb_reference, reports, entry_id=entry_id, general_interrogation=general_interrogation
        )

    def unsubscribe(self, rcb_reference: str) -> None:
        """Disable a report control block of this client."""
        self._subscriptions.unsubscribe(rcb_reference)

    def files(self, directory: str = "") -> tuple[FileEntry, ...]:
        """All files of a directory, "" for the root; names are the relay's octets read as Latin-1."""
        return list_files(self._connection, directory)

    def download(self, name: str, sink: Sink, *, expected_size: int | None = None) -> int:
        """Stream a file to `sink.write`; returns the number of bytes.

        NotFound, AccessDenied, FileSizeMismatch (short, long, or not a file). Other threads' requests go
        between the parts.
        """
        return download(self._connection, name, sink, expected_size)
