"""Buffered and unbuffered reporting (IEC 61850-7-2 clause 17, IEC 61850-8-1 clause 17).

The library's thread copies a report into Python and puts it into the subscriber's queue. It does nothing
else.
"""

import ctypes
import logging
import queue
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from enum import IntFlag
from typing import Final

from mms import errors
from mms.binding.callbacks import guarded
from mms.binding.prototypes import ReportHandler
from mms.binding.value_conversion import decode
from mms.client.connection import Connection
from mms.references import object_reference
from mms.values import NANOSECONDS_PER_MILLISECOND, Value

log: Final = logging.getLogger("mms")

_RCB_ROOM: Final = len("$TimeofEntry")
_ENTRY_ID_OCTETS: Final = 8


class _Field(IntFlag):
    """Attributes that one SetRCBValues request writes (the library's RCB_ELEMENT_...)."""

    ENABLE = 2
    RESERVE = 4
    OPTIONAL_FIELDS = 32
    GENERAL_INTERROGATION = 1024
    ENTRY_ID = 4096


class _Option(IntFlag):
    """Optional fields of a report (OptFlds)."""

    SEQUENCE_NUMBER = 1
    TIMESTAMP = 2
    REASON = 4
    DATA_SET = 8
    DATA_REFERENCE = 16
    BUFFER_OVERFLOW = 32
    ENTRY_ID = 64
    CONFIGURATION_REVISION = 128


_UNBUFFERED_OPTIONS: Final = (
    _Option.SEQUENCE_NUMBER | _Option.TIMESTAMP | _Option.REASON | _Option.DATA_SET | _Option.DATA_REFERENCE
)
_BUFFERED_OPTIONS: Final = _UNBUFFERED_OPTIONS | _Option.BUFFER_OVERFLOW | _Option.ENTRY_ID


class Reason(IntFlag):
    """Why a member is in a report (IEC 61850-7-2); UNKNOWN where the relay does not say."""

    DATA_CHANGE = 1
    QUALITY_CHANGE = 2
    DATA_UPDATE = 4
    INTEGRITY = 8
    GENERAL_INTERROGATION = 16
    UNKNOWN = 32


@dataclass(frozen=True, slots=True)
class ReportMember:
    """One data set member that a report includes.

    Parameters
    ----------
    index : int
        Place of the member in the data set, from 0.
    reference : str or None
        Reference as the relay sends it; None where it sends none.
    value : Value
        The member's value.
    reasons : Reason
        Why the member is included.
    """

    index: int
    reference: str | None
    value: Value
    reasons: Reason


@dataclass(frozen=True, slots=True)
class Report:
    """One report, or one segment of a long one, with its included members.

    Fields that the relay left out are None, and `buffer_overflow` is False.

    Parameters
    ----------
    rcb_reference : str
        Reference of the control block.
    report_id : str
        RptID, as the relay sends it.
    entry_id : bytes or None
        Entry of a buffered block. With it a subscription resumes after this report.
    sequence_number : int or None
        Number of the report since the block was enabled.
    timestamp_ns : int or None
        Time of the entry by the relay's clock [ns, UTC].
    buffer_overflow : bool
        Whether entries before this one may be lost. The first report of a block enabled without an entry ID
        usually says so.
    data_set : str or None
        Reference of the data set.
    members : tuple of ReportMember
        The included members.
    more_segments_follow : bool
        Whether the report goes on in another segment.

    References
    ----------
    IEC 61850-7-2 clause 17; IEC 61850-8-1 clause 17.
    """

    rcb_reference: str
    report_id: str
    entry_id: bytes | None
    sequence_number: int | None
    timestamp_ns: int | None
    buffer_overflow: bool
    data_set: str | None
    members: tuple[ReportMember, ...]
    more_segments_follow: bool = False


class Subscriptions:
    """Report control blocks that one client has enabled.

    Parameters
    ----------
    connection : Connection
        The association with the relay.
    """

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._report_ids: dict[str, str] = {}
        self._handlers: dict[str, object] = {}

    def subscribe(
        self, reference: str, reports: "queue.SimpleQueue[Report]", *, entry_id: bytes | None,
        general_interrogation: bool,
    ) -> None:  # fmt: skip
        """Enable a block and deliver its reports to a queue.

        Parameters
        ----------
        reference : str
            Reference of the block.
        reports : queue.SimpleQueue of Report
            Receives the reports.
        entry_id : bytes or None
            Entry after which a buffered block resumes, 8 octets.
        general_interrogation : bool
            Whether to ask for a report of all members at once.

        Raises
        ------
        ReportControlInUse
            Another client, or this one, has the block.
        EntryNotFound
            The relay no longer holds the entry.
        ValueError
            An entry ID has other than 8 octets, or is given for an unbuffered block.
        """
        operation = f"subscribe to {reference}"
        buffered = _is_buffered(reference)
        if entry_id is not None and (not buffered or len(entry_id) != _ENTRY_ID_OCTETS):
            raise ValueError(
                f"{reference}: an EntryID has {_ENTRY_ID_OCTETS} octets and needs a buffered block"
            )
        with _control_block(self._connection, operation, reference) as block:
            report_id = self._claim(operation, reference, block)
            if not self._connection.lib.ClientReportControlBlock_getDataSetReference(block):
                raise errors.NotFound(
                    self._connection.host, operation, 0, "the block has no data set, so it reports nothing"
                )
            if not buffered:
                self._reserve(operation, block)
            self._set_optional_fields(
                operation, block, _BUFFERED_OPTIONS if buffered else _UNBUFFERED_OPTIONS
            )
            if entry_id is not None:
                self._set_entry_id(operation, block, entry_id)
            self._enable(operation, reference, report_id, block, reports)
            if general_interrogation:
                self._connection.lib.ClientReportControlBlock_setGI(block, True)  # noqa: FBT003 (the library's)
                self._write(operation, block, _Field.GENERAL_INTERROGATION)

    def unsubscribe(self, reference: str) -> None:
        """Disable a block; a buffered one goes on collecting.

        Parameters
        ----------
        reference : str
            Reference of the block.
        """
        operation = f"unsubscribe from {reference}"
        lib = self._connection.lib
        with _control_block(self._connection, operation, reference) as block:
            lib.ClientReportControlBlock_setRptEna(block, False)  # noqa: FBT003 (the library's)
            self._write(operation, block, _Field.ENABLE)
        self._uninstall(operation, reference)

    def _claim(self, operation: str, reference: str, block: int) -> str:
        """Return the block's report ID, once the block is known to be free and its ID to be its own."""
        lib, host = self._connection.lib, self._connection.host
        if reference in self._report_ids:
            raise errors.ReportControlInUse(host, operation, 0, "this client has enabled the block already")
        if lib.ClientReportControlBlock_getRptEna(block):
            raise errors.ReportControlInUse(host, operation, 0, "the block is enabled by another client")
        report_id = (lib.ClientReportControlBlock_getRptId(block) or b"").decode("latin-1")
        # The library finds the block by the report ID; an empty one stands for the block's own reference.
        twin = next(
            (other for other, taken in self._report_ids.items() if taken and taken == report_id), None
        )
        if twin is not None:
            raise errors.ProtocolError(
                host, operation, 0, f"the relay gives {twin} the same report ID {report_id!r}"
            )
        return report_id

    def _reserve(self, operation: str, block: int) -> None:
        self._connection.lib.ClientReportControlBlock_setResv(block, True)  # noqa: FBT003 (the library's)
        try:
            self._write(operation, block, _Field.RESERVE)
        except (errors.AccessDenied, errors.TemporarilyUnavailable) as error:
            raise _in_use(error) from error

    def _set_optional_fields(self, operation: str, block: int, wanted: _Option) -> None:
        """Request the fields we rely on, unless they are set already.

        A relay need not allow writing them: its reports are then taken as they come. Where another client has
        the block, enabling it says so.
        """
        lib = self._connection.lib
        present = int(lib.ClientReportControlBlock_getOptFlds(block))
        if present & wanted == wanted:
            return
        lib.ClientReportControlBlock_setOptFlds(block, present | wanted)
        try:
            self._write(operation, block, _Field.OPTIONAL_FIELDS)
        except (
            errors.AccessDenied, errors.NotFound, errors.ServiceFailed, errors.TemporarilyUnavailable
        ) as error:  # fmt: skip
            log.info("%s: the optional fields stay %#x: %s", error.host, present, error.message)

    def _set_entry_id(self, operation: str, block: int, entry_id: bytes) -> None:
        """Write the entry ID in a request of its own before enabling.

        After enabling, relays ignore the entry ID or refuse the whole request.
        """
        lib = self._connection.lib
        value = lib.MmsValue_newOctetString(_ENTRY_ID_OCTETS, _ENTRY_ID_OCTETS)
        lib.MmsValue_setOctetString(value, entry_id, len(entry_id))
        lib.ClientReportControlBlock_setEntryId(block, value)
        lib.MmsValue_delete(value)
        try:
            self._write(operation, block, _Field.ENTRY_ID)
        except (errors.AccessDenied, errors.TemporarilyUnavailable) as error:
            raise _in_use(error) from error
        except (errors.NotFound, errors.ProtocolError, errors.ServiceFailed) as error:
            message = f"the relay does not hold entry {entry_id.hex()}: reports were lost ({error.message})"
            raise errors.EntryNotFound(error.host, operation, error.code, message) from error

    def _enable(
        self, operation: str, reference: str, report_id: str, block: int, reports: "queue.SimpleQueue[Report]"
    ) -> None:
        connection, lib = self._connection, self._connection.lib

        def receive(_parameter: int | None, report: int) -> None:
            reports.put(_copy(lib, reference, report))

        handler = ReportHandler(guarded(receive, None))
        with connection.exclusive(operation) as pointer:
            connection.keep_callback(handler)
            lib.IedConnection_installReportHandler(
                pointer, reference.encode("ascii"), report_id.encode("latin-1"), handler, None
            )
        self._report_ids[reference], self._handlers[reference] = report_id, handler
        lib.ClientReportControlBlock_setRptEna(block, True)  # noqa: FBT003 (the library's)
        try:
            self._write(operation, block, _Field.ENABLE)
        except errors.MmsError as error:
            self._uninstall(operation, reference)
            if isinstance(error, errors.AccessDenied | errors.TemporarilyUnavailable):
                raise _in_use(error) from error
            raise

    def _uninstall(self, operation: str, reference: str) -> None:
        """Deliver no report of the block from now on."""
        self._report_ids.pop(reference, None)
        with self._connection.exclusive(operation) as pointer:
            self._connection.lib.IedConnection_uninstallReportHandler(pointer, reference.encode("ascii"))
            # The library calls handlers under the lock that uninstalling takes: it is not inside one now.
            handler = self._handlers.pop(reference, None)
            if handler is not None:
                self._connection.release_callback(handler)

    def _write(self, operation: str, block: int, field: _Field) -> None:
        single_request = True
        self._connection.client_request(
            operation, self._connection.lib.IedConnection_setRCBValues, block, int(field), single_request
        )


def _is_buffered(reference: str) -> bool:
    kind = reference.split(".")[1:2]
    if kind == ["BR"]:
        return True
    if kind == ["RP"]:
        return False
    raise ValueError(
        f'not a report control block: {reference!r} (expected "LD/LLN0.BR.name" or "LD/LLN0.RP.name")'
    )


def _in_use(error: errors.MmsError) -> errors.ReportControlInUse:
    message = f"another client holds the block ({error.message})"
    return errors.ReportControlInUse(error.host, error.operation, error.code, message)


@contextmanager
def _control_block(connection: Connection, operation: str, reference: str) -> Iterator[int]:
    """Hold the library's copy of the block's attributes, read by GetBRCBValues or GetURCBValues."""
    name = object_reference(reference, names=3, room=_RCB_ROOM)
    block = connection.client_request(operation, connection.lib.IedConnection_getRCBValues, name, None)
    if block is None:
        raise errors.ProtocolError(connection.host, operation, 0, "no control block came")
    try:
        yield block
    finally:
        connection.lib.ClientReportControlBlock_destroy(block)


def _copy(lib: ctypes.CDLL, reference: str, report: int) -> Report:
    values = lib.ClientReport_getDataSetValues(report)
    has_references = bool(lib.ClientReport_hasDataReference(report))
    members = []
    for index in range(int(lib.MmsValue_getArraySize(values))):
        reasons = int(lib.ClientReport_getReasonForInclusion(report, index))
        if reasons:
            name = lib.ClientReport_getDataReference(report, index) if has_references else None
            value = decode(lib, lib.MmsValue_getElement(values, index))
            members.append(ReportMember(index, _text(name), value, Reason(reasons)))
    entry = decode(lib, lib.ClientReport_getEntryId(report))
    timed = bool(lib.ClientReport_hasTimestamp(report))
    time_ns = int(lib.ClientReport_getTimestamp(report)) * NANOSECONDS_PER_MILLISECOND if timed else None
    return Report(
        rcb_reference=reference,
        report_id=_text(lib.ClientReport_getRptId(report)) or "",
        entry_id=entry if isinstance(entry, bytes) else None,
        sequence_number=int(lib.ClientReport_getSeqNum(report))
        if lib.ClientReport_hasSeqNum(report)
        else None,
        timestamp_ns=time_ns,
        buffer_overflow=bool(lib.ClientReport_hasBufOvfl(report))
        and bool(lib.ClientReport_getBufOvfl(report)),
        data_set=_text(lib.ClientReport_getDataSetName(report))
        if lib.ClientReport_hasDataSetName(report)
        else None,
        members=tuple(members),
        more_segments_follow=bool(lib.ClientReport_getMoreSeqmentsFollow(report)),
    )


def _text(octets: bytes | None) -> str | None:
    return None if octets is None else octets.decode("latin-1")
