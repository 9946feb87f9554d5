"""One relay, one thread: connect, subscribe, keep its directory and its event reports up to date, for ever.

What a relay does wrong ends at its own session: the link is down with its reason, and tried again.
"""

import math
import time
from collections.abc import Callable
from contextlib import ExitStack, nullcontext
from queue import Empty, SimpleQueue
from threading import Event

import structlog
from sqlalchemy.exc import SQLAlchemyError

from mms import (
    AccessDenied,
    Client,
    EntryNotFound,
    MmsError,
    NotFound,
    ProtocolError,
    Reason,
    Report,
    ReportControlInUse,
    ReportMember,
)
from service.collector.alarms import RelayAlarms
from service.collector.allowance import DailyAllowance
from service.collector.continuity import Continuity, is_of, status_of
from service.collector.link import Link
from service.collector.metering import Metering
from service.collector.quarantine import Conduct
from service.collector.record_directory import RecordDirectory
from service.collector.triggering import Triggering
from service.collector.visiting import Mark, Visits
from service.plant import Relay
from service.recordings import RecordingStore
from service.settings import Settings
from service.storage import LeaseLostError, Repository
from service.storage.records import Sample

log = structlog.get_logger(__name__)

HURRIED_PERIOD_S = 0.2
"""Between scans while a record is known to be on its way."""

ENTRY_ID_OCTETS = 8
"""IEC 61850-8-1; anything else a relay sends could not be given back to it."""

FIRST_RETRY_S, LONGEST_RETRY_S = 0.5, 10.0


class Inbox(SimpleQueue[Report]):
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


class RelaySession:
    """Everything between the service and one relay. `run` is the body of the session's own thread."""

    def __init__(
        self,
        relay: Relay,
        motor: str,
        repository: Repository,
        store: RecordingStore,
        settings: Settings,
        *,
        gateway: str | None = None,
        visits: Visits | None = None,
        on_sample: Callable[[Sample], None] | None = None,
    ) -> None:
        """`gateway`: who holds the relay's lease; None where relays are not shared.

        visits: where a visit is marked, for whoever finds the process dead; None where nobody would look.
        on_sample: takes what the relay measures; None where nobody wants it.
        """
        self._relay = relay
        self._repository = repository
        self._settings = settings
        figures = repository.link_figures(relay.name)
        allowance = DailyAllowance(
            settings.max_relay_bytes_per_day, day=figures.day, used_bytes=figures.day_bytes
        )
        self._link = Link(relay.name, repository, allowance, period_s=settings.poll_period_s)
        self._directory = RecordDirectory(
            relay,
            motor,
            repository,
            store,
            settings,
            link=self._link,
            alarms=RelayAlarms(relay.name, repository),
            allowance=allowance,
        )
        self._triggering = Triggering(
            relay, repository, record_timeout_s=settings.record_timeout_s, gateway=gateway
        )
        self._metering = (
            None
            if on_sample is None
            else Metering(relay, motor, period_s=settings.metering_period_s, on_sample=on_sample)
        )
        self._conduct = Conduct(relay.name, repository, first_pause_s=settings.quarantine_s)
        self._visits = visits
        self._mark: Mark | None = None
        self._client: Client | None = None
        self._stopping = Event()
        self._something_to_do = Event()
        self._unsaved_entry_id: bytes | None = None
        self._expecting_until_s = 0.0
        self._overflow_means_loss = False
        self._continuity = Continuity(relay.fault_number)

    def wake(self) -> None:
        """Somebody asked for an event report."""
        self._something_to_do.set()

    def stop(self) -> None:
        """End after what is under way."""
        self._stopping.set()
        self._something_to_do.set()

    def abandon(self) -> None:
        """End with the request under way: somebody else may visit the relay soon."""
        self.stop()
        client = self._client
        if client is not None:
            client.abandon()

    def run(self) -> None:
        """Visit the relay until stopped, waiting longer each time it does not answer."""
        retry_s = FIRST_RETRY_S
        while not self._stopping.is_set():
            visited_s = time.monotonic()
            reason = None
            broken = False
            try:
                self._visit()
            except MmsError as error:
                reason = str(error)
                broken = isinstance(error, ProtocolError)
            except LeaseLostError as error:
                log.warning("visit ended", relay=self._relay.name, reason=str(error))
                return
            except Exception as error:  # a full disk or a bug here must not silence the relay for ever
                log.exception("session failed", relay=self._relay.name)
                reason = f"{type(error).__name__}: {error}"
            if reason is not None and not self._stopping.is_set():
                self._note_failure(reason)
                if broken and self._is_set_aside(reason):
                    return
            if time.monotonic() - visited_s > LONGEST_RETRY_S:
                retry_s = FIRST_RETRY_S
            self._stopping.wait(retry_s)
            retry_s = min(2 * retry_s, LONGEST_RETRY_S)

    def _visit(self) -> None:
        """One connection, until it breaks or the session is stopped. Raises MmsError."""
        with ExitStack() as marked:
            if self._visits is not None:
                self._mark = marked.enter_context(self._visits.mark(self._relay.name))
            self._conduct.visited()
            self._visit_marked()

    def _visit_marked(self) -> None:
        with Client.connect(
            self._relay.host,
            self._relay.port,
            connect_timeout_s=self._settings.connect_timeout_s,
            request_timeout_s=self._settings.request_timeout_s,
        ) as client:
            self._client = client
            inbox = Inbox(self._something_to_do)
            self._continuity.begin()
            self._subscribe(client, inbox)
            log.info("connected", relay=self._relay.name, host=self._relay.host, port=self._relay.port)
            self._link.connected()
            if self._metering is not None:
                self._metering.begin()
            while not self._stopping.is_set():
                self._something_to_do.clear()
                waiting = self._work(client, inbox)
                self._link.answered(client.round_trip_s)
                self._conduct.answered()
                self._wait(client, HURRIED_PERIOD_S if waiting else self._settings.poll_period_s)

    def _wait(self, client: Client, longest_s: float) -> None:
        """Until there is something to do, or for so long; what is to be sampled meanwhile is."""
        until_s = time.monotonic() + longest_s
        while not self._something_to_do.is_set() and time.monotonic() < until_s:
            due_in_s = math.inf if self._metering is None else self._metering.due_in_s()
            if self._metering is not None and due_in_s <= 0:
                self._metering.sample(client)
                continue
            with nullcontext() if self._mark is None else self._mark.waiting():
                self._something_to_do.wait(min(due_in_s, until_s - time.monotonic()))

    def _subscribe(self, client: Client, inbox: Inbox) -> None:
        """Have reports from where the last saved one left off; without reports, the directory is polled."""
        self._unsaved_entry_id = None
        control = self._relay.report_control
        if control is None:
            log.info("the relay reports no records, the directory is polled", relay=self._relay.name)
            return
        try:
            entry_id = self._repository.entry_id(self._relay.name)
            # A block enabled without an EntryID begins with the overflow bit set, whatever it lost.
            self._overflow_means_loss = entry_id is not None
            try:
                client.subscribe(control, inbox, entry_id=entry_id)
            except EntryNotFound:
                self._overflow_means_loss = False
                self._link.lost_reports()
                log.warning(
                    "reports lost: the relay no longer holds the last one seen", relay=self._relay.name
                )
                client.subscribe(control, inbox)
        except (AccessDenied, NotFound, ReportControlInUse) as error:
            log.warning("no reports, the directory is polled", relay=self._relay.name, reason=str(error))

    def _heed(self, report: Report) -> None:
        """A report hurries the scans when it says that a record is, or will soon be, in the directory."""
        overflowed = report.buffer_overflow and self._overflow_means_loss
        self._overflow_means_loss = True
        if overflowed:
            # No loss: whatever the lost reports announced is in the directory, which is scanned anyway.
            log.info("the relay's report buffer had overflowed", relay=self._relay.name)
        missed = self._continuity.missed_before(report)
        if missed is not None:
            log.info("reports missed", relay=self._relay.name, reason=missed)
        self._link.reported(gap=overflowed or missed is not None)
        if report.entry_id is not None and len(report.entry_id) == ENTRY_ID_OCTETS:
            self._unsaved_entry_id = report.entry_id
        if any(self._tells_of_a_record(member) for member in report.members):
            self._expecting_until_s = time.monotonic() + self._settings.record_timeout_s
            log.info("record announced", relay=self._relay.name)

    def _tells_of_a_record(self, member: ReportMember) -> bool:
        if not member.reasons & (Reason.DATA_CHANGE | Reason.UNKNOWN):
            return False
        if member.reference is None:
            return True
        if self._relay.record_made is not None and is_of(member.reference, self._relay.record_made):
            return status_of(member) is True
        return self._relay.fault_number is not None and is_of(member.reference, self._relay.fault_number)

    def _note_failure(self, reason: str) -> None:
        self._link.failed(reason)
        try:
            self._triggering.link_failed(reason)
        except SQLAlchemyError:
            log.exception("database does not answer, trying again")

    def _is_set_aside(self, reason: str) -> bool:
        """A visit ended by a broken protocol: whether that was once too often."""
        try:
            return self._conduct.broke_the_protocol(reason)
        except SQLAlchemyError:
            log.exception("database does not answer, trying again")
            return False

    def _work(self, client: Client, inbox: Inbox) -> bool:
        """One round: reports, directory, event reports. Returns whether a record is on its way."""
        for report in inbox.drain():
            self._heed(report)
        self._triggering.recall()
        scan = self._directory.scan(client, self._triggering.claim)
        triggered = self._triggering.follow(client, scan)
        if scan.taken:
            self._expecting_until_s = 0.0
        expecting = bool(scan.waiting) or time.monotonic() < self._expecting_until_s
        if self._unsaved_entry_id is not None and not expecting:
            # Only now: after a crash the relay repeats every report from this EntryID on, and what the
            # reports before it announced is safe.
            self._repository.save_entry_id(self._relay.name, self._unsaved_entry_id)
            self._unsaved_entry_id = None
        return expecting or triggered
