"""A relay's reports: which block tells of its records, and what a report means.

The best block comes first: the buffered one the SCL names, then other buffered ones whose data set holds
RcdMade, then unbuffered ones. Without any the directory is polled, and they are tried again now and then.
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
    TemporarilyUnavailable,
)
from service.collector.session.link import Link
from service.collector.session.report_continuity import ReportContinuity, is_of, status_of
from service.plant import Acquisition
from service.storage import Repository

log = structlog.get_logger(__name__)

ENTRY_ID_OCTETS = 8
"""IEC 61850-8-1; anything else a relay sends could not be given back to it."""

RETRY_S = 60.0
"""Between attempts to get a block that was refused: another client may have left it."""

MOST_BLOCKS = 16
"""Tried at a time: a block has many instances at some relays, all of them taken."""

REFUSALS = (AccessDenied, NotFound, ProtocolError, ReportControlInUse, TemporarilyUnavailable, ValueError)
"""Of one block, the link being fine; ValueError: a reference that is none."""


class ReportQueue(SimpleQueue[Report]):
    """Reports as they arrive from the MMS layer's thread; whoever waits on `arrival` wakes up."""

    def __init__(self, arrival: Event) -> None:
        super().__init__()
        self._arrival = arrival

    def put(self, item: Report, block: bool = True, timeout: float | None = None) -> None:
        super().put(item, block, timeout)
        self._arrival.set()

    def drain(self) -> list[Report]:
        """What has arrived, oldest first."""
        reports: list[Report] = []
        while True:
            try:
                reports.append(self.get_nowait())
            except Empty:
                return reports


class ReportSubscription:
    """Of one relay, over one connection after the other. Used by that relay's session alone.

    report_control: the block in use, None where the directory is polled.  refusal: why none of the blocks the
    relay offers could be had, None where one is in use or there is none.
    """

    def __init__(self, relay: str, repository: Repository, link: Link) -> None:
        self._relay = relay
        self._repository = repository
        self._link = link
        self._acquisition: Acquisition | None = None
        self._continuity = ReportContinuity(None)
        self._inbox = ReportQueue(Event())
        self._unsaved_entry_id: bytes | None = None
        self._overflow_means_loss = False
        self._next_attempt_s = 0.0
        self.report_control: str | None = None
        self.refusal: str | None = None

    def begin(self, client: Client, inbox: ReportQueue, acquisition: Acquisition) -> None:
        """A new connection: reports go on where the last saved one left off. Raises MmsError (the link)."""
        if self._acquisition is None or self._acquisition.record_number != acquisition.record_number:
            self._continuity = ReportContinuity(acquisition.record_number)
        self._acquisition = acquisition
        self._inbox = inbox
        self._continuity.begin()
        self._unsaved_entry_id = None
        self._attempt(client)

    def keep(self, client: Client) -> None:
        """Where no block could be had, try again when it is time. Raises MmsError (the link)."""
        if self.refusal is not None and time.monotonic() >= self._next_attempt_s:
            self._attempt(client)

    def handle_all(self) -> bool:
        """Whether what has arrived says that a record is, or will soon be, in the directory."""
        told = [self.handle(report) for report in self._inbox.drain()]
        return any(told)

    def handle(self, report: Report) -> bool:
        """Whether a report says so."""
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
        tells = any(self._tells_of_a_record(member) for member in report.members)
        if tells:
            log.info("record announced", relay=self._relay)
        return tells

    def save(self) -> None:
        """What the reports so far announced is safe.

        Not before: after a crash the relay repeats every report from this EntryID on.
        """
        if self._unsaved_entry_id is not None:
            self._repository.save_entry_id(self._relay, self._unsaved_entry_id, self.report_control)
            self._unsaved_entry_id = None

    def _attempt(self, client: Client) -> None:
        assert self._acquisition is not None  # noqa: S101 - begin comes first
        self._next_attempt_s = time.monotonic() + RETRY_S
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
            client.subscribe(control, self._inbox)
            return
        entry_id = self._repository.entry_id(self._relay, control)
        # A block enabled without an EntryID begins with the overflow bit set, whatever it lost.
        self._overflow_means_loss = entry_id is not None
        try:
            client.subscribe(control, self._inbox, entry_id=entry_id)
        except EntryNotFound:
            self._overflow_means_loss = False
            self._link.lost_reports()
            log.warning("reports lost: the relay no longer holds the last one seen", relay=self._relay)
            client.subscribe(control, self._inbox)

    def _tells_of_a_record(self, member: ReportMember) -> bool:
        assert self._acquisition is not None  # noqa: S101 - begin comes first
        if not member.reasons & (Reason.DATA_CHANGE | Reason.UNKNOWN):
            return False
        if member.reference is None:
            return True
        record_made, record_number = self._acquisition.record_made, self._acquisition.record_number
        if record_made is not None and is_of(member.reference, record_made):
            return status_of(member) is True
        return record_number is not None and is_of(member.reference, record_number)
