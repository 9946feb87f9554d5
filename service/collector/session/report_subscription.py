"""The subscription to a relay's reports: which report control block is used, and what a report means.

The best block is tried first: the buffered one that the SCL names, then other buffered ones whose data set
holds RcdMade, then unbuffered ones. If the relay refuses all, its directory is polled, and they are tried
again now and then.
"""

import time
from queue import Empty, SimpleQueue
from threading import Event

import structlog

from mms import (
    AccessDenied,
    Client,
    EntryNotFound,
    NotFound,
    ProtocolError,
    Reason,
    Report,
    ReportControlInUse,
    ReportMember,
    ServiceFailed,
    TemporarilyUnavailable,
)
from service.collector.session.link import Link
from service.collector.session.notes import Notes
from service.collector.session.session_policy import SESSION_POLICY
from service.plant import Acquisition
from service.storage import Repository
from service.storage.records import ReportPosition

log = structlog.get_logger(__name__)

ENTRY_ID_OCTETS = 8
"""An EntryID has this size (IEC 61850-8-1). One of another size could not be given back to the relay."""

MOST_BLOCKS = 16
"""So many blocks are tried at a time: at some relays a block has many instances, all of them taken."""

REFUSALS = (
    AccessDenied, NotFound, ProtocolError, ReportControlInUse, ServiceFailed, TemporarilyUnavailable,
    ValueError,
)  # fmt: skip
"""These errors concern one block, and the link is fine. ValueError stands for a reference that is none."""

SEQUENCE_NUMBERS = 65_536
"""A report's sequence number has 16 bits (IEC 61850-7-2, SqNum) and begins again after the last."""


class ReportQueue(SimpleQueue[Report]):
    """Reports as they arrive from the thread of the MMS layer; each sets `arrival`."""

    def __init__(self, arrival: Event) -> None:
        super().__init__()
        self._arrival = arrival

    def put(self, item: Report, block: bool = True, timeout: float | None = None) -> None:
        super().put(item, block, timeout)
        self._arrival.set()

    def drain(self) -> list[Report]:
        """Return what has arrived, oldest first."""
        reports: list[Report] = []
        while True:
            try:
                reports.append(self.get_nowait())
            except Empty:
                return reports


class ReportContinuity:
    """Detects lost reports, from their sequence numbers and from the relay's own count of its records.

    It follows the reports of one control block over one connection after the other. No record is lost with a
    report, because the directory is scanned after every report. The figure says how far a relay's reports can
    be relied upon.

    fault_number: reference of the relay's count of records (FltNum), where it has one.
    """

    def __init__(self, fault_number: str | None) -> None:
        self._fault_number = fault_number
        self._sequence_number: int | None = None
        self._records: int | None = None

    def begin(self) -> None:
        """Begin a new connection: some relays begin to count their reports anew."""
        self._sequence_number = None

    def missed_before(self, report: Report) -> str | None:
        """Return what was missed before this report, in words; None when nothing was."""
        reasons = []
        expected, found = self._sequence_number, report.sequence_number
        if found is not None:
            # A report in parts has the same number in each.
            if expected is not None and found not in (expected, (expected + 1) % SEQUENCE_NUMBERS):
                reasons.append(f"report {found} came after {expected}")
            self._sequence_number = found
        for member in report.members:
            if self._fault_number is None or member.reference is None:
                continue
            records = _status_of(member)
            if _is_of(member.reference, self._fault_number) and isinstance(records, int):
                if self._records is not None and records not in (self._records, self._records + 1):
                    reasons.append(f"the relay's record {records} came after {self._records}")
                self._records = records
        return "; ".join(reasons) or None


class ReportSubscription:
    """The subscription of one relay, over one connection after the other. Used by its session alone.

    report_control: the block in use; None where the directory is polled.  refusal: why the relay refused all
    its blocks; None where one is in use, or the relay has none.
    """

    def __init__(
        self,
        relay: str,
        repository: Repository,
        link: Link,
        notes: Notes,
        *,
        retry_s: float = SESSION_POLICY.report_retry_s,
    ) -> None:
        """Begin without a block; `begin` subscribes.

        retry_s: between attempts to get a block, where all were refused.
        notes: takes where to resume.
        """
        self._relay = relay
        self._repository = repository
        self._link = link
        self._retry_s = retry_s
        self._notes = notes
        self._acquisition: Acquisition | None = None
        self._continuity = ReportContinuity(None)
        self._queue = ReportQueue(Event())
        self._unsaved_entry_id: bytes | None = None
        self._overflow_means_loss = False
        self._next_attempt_s = 0.0
        self.report_control: str | None = None
        self.refusal: str | None = None

    def begin(self, client: Client, queue: ReportQueue, acquisition: Acquisition) -> None:
        """Subscribe over a new connection, from the report after the last saved one.

        Raises MmsError (the link), SQLAlchemyError.
        """
        if self._acquisition is None or self._acquisition.record_number != acquisition.record_number:
            self._continuity = ReportContinuity(acquisition.record_number)
        self._acquisition = acquisition
        self._queue = queue
        self._continuity.begin()
        self._unsaved_entry_id = None
        self._subscribe(client)

    def retry_if_due(self, client: Client) -> None:
        """Try the blocks again if all were refused and it is time to. Raises MmsError (the link)."""
        if self.refusal is not None and time.monotonic() >= self._next_attempt_s:
            self._subscribe(client)

    def handle_all(self) -> bool:
        """Handle what has arrived. Returns whether a record is, or will soon be, in the directory."""
        announced = [self.handle(report) for report in self._queue.drain()]
        return any(announced)

    def handle(self, report: Report) -> bool:
        """Handle one report. Returns whether it announces a record."""
        overflowed = report.buffer_overflow and self._overflow_means_loss
        self._overflow_means_loss = True
        if overflowed:
            # No loss: whatever the lost reports announced is in the directory, which is scanned anyway.
            log.info("the relay's report buffer had overflowed", relay=self._relay)
        missed = self._continuity.missed_before(report)
        if missed is not None:
            log.info("reports missed", relay=self._relay, reason=missed)
        self._link.reported(gap=overflowed or missed is not None)
        if report.entry_id is not None and len(report.entry_id) == ENTRY_ID_OCTETS:
            self._unsaved_entry_id = report.entry_id
        announced = any(self._announces_a_record(member) for member in report.members)
        if announced:
            log.info("record announced", relay=self._relay)
        return announced

    def save_entry_id(self) -> None:
        """Save the EntryID of the latest report, when its record is stored. Raises SQLAlchemyError.

        After a crash the relay repeats every report from the saved EntryID on.
        """
        if self._unsaved_entry_id is not None:
            self._notes.add_position(ReportPosition(self._relay, self._unsaved_entry_id, self.report_control))
            self._unsaved_entry_id = None

    def _subscribe(self, client: Client) -> None:
        assert self._acquisition is not None  # noqa: S101 - begin comes first
        self._next_attempt_s = time.monotonic() + self._retry_s
        self.report_control, self.refusal = None, None
        controls = self._acquisition.report_controls[:MOST_BLOCKS]
        if not controls:
            log.info("the relay reports no records, the directory is polled", relay=self._relay)
            return
        refusals = []
        for control in controls:
            try:
                self._enable(client, control)
            except REFUSALS as error:
                refusals.append(str(error))
                continue
            self.report_control = control
            if refusals:
                log.warning(
                    "another report block is used", relay=self._relay, block=control, reason=refusals[0]
                )
            return
        more = f" (and {len(refusals) - 1} others)" if len(refusals) > 1 else ""
        self.refusal = f"no reports, the directory is polled: {refusals[0]}{more}"
        log.warning("no reports, the directory is polled", relay=self._relay, reason=refusals[0])

    def _enable(self, client: Client, control: str) -> None:
        if ".RP." in control:
            self._overflow_means_loss = False
            client.subscribe(control, self._queue)
            return
        entry_id = self._repository.entry_id(self._relay, control)
        # A block enabled without an EntryID begins with the overflow bit set, whatever it lost.
        self._overflow_means_loss = entry_id is not None
        try:
            client.subscribe(control, self._queue, entry_id=entry_id)
        except EntryNotFound:
            self._overflow_means_loss = False
            self._link.lost_reports()
            log.warning("reports lost: the relay no longer holds the last one seen", relay=self._relay)
            client.subscribe(control, self._queue)

    def _announces_a_record(self, member: ReportMember) -> bool:
        assert self._acquisition is not None  # noqa: S101 - begin comes first
        if not member.reasons & (Reason.DATA_CHANGE | Reason.UNKNOWN):
            return False
        if member.reference is None:
            return True
        record_made, record_number = self._acquisition.record_made, self._acquisition.record_number
        if record_made is not None and _is_of(member.reference, record_made):
            return _status_of(member) is True
        return record_number is not None and _is_of(member.reference, record_number)


def _is_of(member: str, reference: str) -> bool:
    """Return whether a report's member belongs to a data object.

    A relay names its members as MMS does: LD/LN$FC$DO, with $attribute where one is reported alone.
    """
    node, _, names = member.partition("$")
    return f"{node}.{names.partition('$')[2]}.".replace("$", ".").startswith(f"{reference}.")


def _status_of(member: ReportMember) -> object:
    """Return the status value of a member that is reported alone or with quality and time."""
    return member.value[0] if isinstance(member.value, tuple) and member.value else member.value
