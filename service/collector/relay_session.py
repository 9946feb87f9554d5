"""One relay, one thread: connect, subscribe, keep its directory and its event reports up to date, for ever.

What a relay does wrong ends at its own session: the link is down with its reason, and tried again.
"""

import time
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
    Reason,
    Report,
    ReportControlInUse,
    ReportMember,
)
from service.collector.record_directory import RecordDirectory
from service.collector.triggering import Triggering
from service.plant import Relay
from service.recordings import RecordingStore
from service.settings import Settings
from service.storage import Repository
from service.storage.states import LinkState

log = structlog.get_logger(__name__)

HURRIED_PERIOD_S = 0.2
"""Between scans while a record is known to be on its way."""

ENTRY_ID_OCTETS = 8
"""IEC 61850-8-1; anything else a relay sends could not be given back to it."""

FIRST_RETRY_S, LONGEST_RETRY_S = 0.5, 10.0

REMIND_AFTER_S = 600.0
"""A link that stays down for the same reason is logged this often."""


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
        self, relay: Relay, motor: str, repository: Repository, store: RecordingStore, settings: Settings
    ) -> None:
        self._relay = relay
        self._repository = repository
        self._settings = settings
        self._directory = RecordDirectory(relay, motor, repository, store, settings)
        self._triggering = Triggering(relay, repository, record_timeout_s=settings.record_timeout_s)
        self._stopping = Event()
        self._something_to_do = Event()
        self._unsaved_entry_id: bytes | None = None
        self._expecting_until_s = 0.0
        self._link_noted_s = 0.0
        self._failure_logged: tuple[str, float] | None = None
        self._overflow_means_loss = False

    def wake(self) -> None:
        """Somebody asked for an event report."""
        self._something_to_do.set()

    def stop(self) -> None:
        self._stopping.set()
        self._something_to_do.set()

    def run(self) -> None:
        """Visit the relay until stopped, waiting longer each time it does not answer."""
        retry_s = FIRST_RETRY_S
        while not self._stopping.is_set():
            visited_s = time.monotonic()
            reason = None
            try:
                self._visit()
            except MmsError as error:
                reason = str(error)
            except Exception as error:  # a full disk or a bug here must not silence the relay for ever
                log.exception("session failed", relay=self._relay.name)
                reason = f"{type(error).__name__}: {error}"
            if reason is not None:
                self._note_failure(reason)
            if time.monotonic() - visited_s > LONGEST_RETRY_S:
                retry_s = FIRST_RETRY_S
            self._stopping.wait(retry_s)
            retry_s = min(2 * retry_s, LONGEST_RETRY_S)

    def _visit(self) -> None:
        """One connection, until it breaks or the session is stopped. Raises MmsError."""
        with Client.connect(
            self._relay.host,
            self._relay.port,
            connect_timeout_s=self._settings.connect_timeout_s,
            request_timeout_s=self._settings.request_timeout_s,
        ) as client:
            inbox = Inbox(self._something_to_do)
            self._subscribe(client, inbox)
            log.info("connected", relay=self._relay.name, host=self._relay.host, port=self._relay.port)
            self._link_noted_s = 0.0
            self._failure_logged = None
            while not self._stopping.is_set():
                self._something_to_do.clear()
                waiting = self._work(client, inbox)
                self._note_success()
                self._something_to_do.wait(HURRIED_PERIOD_S if waiting else self._settings.poll_period_s)

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
        # A relay names its members as MMS does: LD/LN$FC$DO, with $attribute where one is reported alone.
        node, _, names = member.reference.partition("$")
        reference = f"{node}.{names.partition('$')[2]}".replace("$", ".")
        status = member.value[0] if isinstance(member.value, tuple) and member.value else member.value
        if self._relay.record_made is not None and f"{reference}.".startswith(f"{self._relay.record_made}."):
            return status is True
        return self._relay.fault_number is not None and f"{reference}.".startswith(
            f"{self._relay.fault_number}."
        )

    def _note_success(self) -> None:
        """The relay answered. Written once a poll period: a healthy relay is no reason to wear the disk."""
        now_s = time.monotonic()
        if now_s - self._link_noted_s >= self._settings.poll_period_s:
            self._repository.set_link_state(self._relay.name, LinkState.UP, None, now_ns=time.time_ns())
            self._link_noted_s = now_s

    def _note_failure(self, reason: str) -> None:
        self._log_failure(reason)
        try:
            self._repository.set_link_state(self._relay.name, LinkState.DOWN, reason, now_ns=time.time_ns())
            self._triggering.link_failed(reason)
        except SQLAlchemyError:
            log.exception("database does not answer, trying again")

    def _log_failure(self, reason: str) -> None:
        """A relay that is off for a month is one line at first and one now and then, not one each retry."""
        now_s = time.monotonic()
        if self._failure_logged is not None:
            logged, logged_s = self._failure_logged
            if reason == logged and now_s - logged_s < REMIND_AFTER_S:
                return
        self._failure_logged = (reason, now_s)
        log.warning("link down", relay=self._relay.name, reason=reason)

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
