"""The session with one relay, on a thread of its own: connect, subscribe, pull records, trigger, measure.

What a relay does wrong ends with its own session: the link is down with the reason, and is tried again.
"""

import math
import time
from collections.abc import Callable
from contextlib import ExitStack, nullcontext
from threading import Event

import structlog
from sqlalchemy.exc import SQLAlchemyError

from core.machines.parameters import Motor
from mms import Client, CredentialFileError, MmsError, ProtocolError
from service.collector.records.directory import RecordDirectory
from service.collector.records.event_folders import EventFolders
from service.collector.records.pull import DailyAllowance
from service.collector.records.scan import Scan
from service.collector.session.clock_monitor import ClockMonitor
from service.collector.session.discovery import Discovery
from service.collector.session.link import Link
from service.collector.session.metering import Metering
from service.collector.session.notes import Notes, WrittenAtOnce
from service.collector.session.protocol_fault_counter import ProtocolFaultCounter
from service.collector.session.quarantine import QuarantinePolicy
from service.collector.session.relay_alarms import RelayAlarms
from service.collector.session.report_subscription import ReportQueue, ReportSubscription
from service.collector.session.session_policy import SESSION_POLICY, SessionPolicy
from service.collector.session.visit_marks import VisitMark, VisitMarks
from service.collector.text_reports.text_reports import TextReports
from service.collector.triggers.trigger_queue import TriggerQueue
from service.configuration.relay_access import AccessError, credentials
from service.configuration.settings import Settings
from service.plant import Relay
from service.recording_store.store import RecordingStore
from service.storage import LeaseLostError, Repository
from service.storage.records import Quarantine, Sample
from service.timing.backoff import RestartDelay
from service.timing.database_silence import database_trouble

log = structlog.get_logger(__name__)

HURRIED_PERIOD_S = 0.2
"""The directory is scanned this often while a record is known to be on its way."""

LISTING_PAUSE = 4.0
"""The next listing of the directory waits for so many times the time that the latest one took."""


class RelaySession:
    """Does everything between the service and one relay. `run` is the body of the session's own thread."""

    def __init__(
        self,
        relay: Relay,
        motor: str,
        repository: Repository,
        store: RecordingStore,
        settings: Settings,
        *,
        gateway: str | None = None,
        visit_marks: VisitMarks | None = None,
        on_sample: Callable[[Sample], None] | None = None,
        notes: Notes | None = None,
        reported: Motor | None = None,
        policy: SessionPolicy = SESSION_POLICY,
    ) -> None:
        """Put together what one relay needs; `run` then reads what is known of it, and connects.

        gateway: who holds the relay's lease, and wakes this session while somebody waits for a recording;
        None where relays are not shared, and each round looks whether somebody does.
        visit_marks: where a visit is marked, for whoever finds the process dead; None where nobody looks.
        on_sample: takes what the relay measures; None where nobody wants it.
        notes: takes what the session has to say all the time; None where that is written at once.
        reported: the motor that the relay's text reports tell of; None where nobody wants them.
        """
        self._relay = relay
        self._repository = repository
        self._settings = settings
        self._policy = policy
        allowance = self._allowance = DailyAllowance(settings.max_relay_bytes_per_day)
        notes = WrittenAtOnce(repository) if notes is None else notes
        self._link = Link(relay.name, notes, allowance, reminder_s=policy.reminder_s)
        alarms = RelayAlarms(relay.name, repository, most=policy.most_alarms)
        self._discovery = Discovery(relay, alarms, notes)
        self._subscription = ReportSubscription(
            relay.name, repository, self._link, notes, retry_s=policy.report_retry_s
        )
        self._folders = EventFolders(
            relay.name,
            settings.events_directory,
            relay.overrides.events_directory,
            policy=policy.records,
        )
        self._directory = RecordDirectory(
            relay,
            motor,
            repository,
            store,
            settings,
            folders=self._folders,
            alarms=alarms,
            allowance=allowance,
            on_bytes=self._link.received,
            policy=policy.records,
        )
        self._clock = ClockMonitor(relay.name, repository, notes)
        self._stopping = Event()
        self._is_woken = gateway is not None
        self._triggers = TriggerQueue(
            relay,
            repository,
            clock=self._clock,
            record_timeout_s=settings.record_timeout_s,
            gateway=gateway,
        )
        self._metering = (
            None
            if on_sample is None
            else Metering(relay, motor, period_s=settings.metering_period_s, on_sample=on_sample)
        )
        self._text_reports = (
            None
            if reported is None
            else TextReports(
                relay,
                reported,
                repository,
                period_s=settings.text_report_period_s,
                allowance=allowance,
                on_bytes=self._link.received,
            )
        )
        self._protocol_faults = ProtocolFaultCounter(
            relay.name, repository, QuarantinePolicy.starting_with(settings.quarantine_s), policy=policy
        )
        self._has_recalled = False
        self._visit_marks = visit_marks
        self._mark: VisitMark | None = None
        self._client: Client | None = None
        self._wake_up = Event()
        self._requested = Event()
        self._record_expected_until_s = 0.0
        self._busy: str | None = None

    def wake(self) -> None:
        """Look for requests now: somebody has requested a recording."""
        self._requested.set()
        self._wake_up.set()

    def stop(self) -> None:
        """End after the request under way."""
        self._stopping.set()
        self.wake()

    def abandon(self) -> None:
        """End in the middle of the request under way: another gateway may visit the relay soon."""
        self.stop()
        client = self._client
        if client is not None:
            client.abandon()

    def run(self) -> None:
        """Visit the relay until stopped, with a longer pause after each visit that fails."""
        delay = RestartDelay(self._policy.reconnect, stable_after_s=self._policy.reconnect.longest_s)
        while not self._stopping.is_set():
            began_s = time.monotonic()
            if not self._visit_once():
                return
            self._stopping.wait(delay.after_run_s(time.monotonic() - began_s))

    def _visit_once(self) -> bool:
        """Make one visit, and note why it ended. Returns whether the relay is to be visited again."""
        try:
            if not self._has_recalled:
                self._recall()
        except SQLAlchemyError as error:
            log.warning("not visited yet", relay=self._relay.name, reason=database_trouble(error))
            return True
        try:
            self._visit()
        except (MmsError, CredentialFileError, AccessError) as error:
            return self._handle_failure(
                "does not answer", str(error), broken=isinstance(error, ProtocolError)
            )
        except LeaseLostError as error:
            log.warning("visit ended", relay=self._relay.name, reason=str(error))
            return False
        except Exception as error:  # a full disk or a bug here must not silence the relay for ever
            log.exception("session failed", relay=self._relay.name)
            return self._handle_failure("is not visited", f"{type(error).__name__}: {error}", broken=False)
        return True

    def _handle_failure(self, trouble: str, reason: str, *, broken: bool) -> bool:
        """Note a visit that failed. Returns whether the relay is to be visited again.

        broken: the relay broke the protocol, which brings a quarantine if it happens too often.
        """
        if self._stopping.is_set():
            return True
        quarantine = self._count_fault(reason) if broken else None
        if quarantine is None:
            self._link.failed(reason)
        else:
            self._link.set_aside(quarantine)
        self._tell_those_who_wait(trouble, reason)
        return quarantine is None

    def _count_fault(self, reason: str) -> Quarantine | None:
        try:
            return self._protocol_faults.count_fault(reason)
        except SQLAlchemyError:
            log.exception("database does not answer, trying again")
            return None

    def _tell_those_who_wait(self, trouble: str, reason: str) -> None:
        try:
            self._triggers.link_failed(f"{trouble}: {reason}")
        except SQLAlchemyError:
            log.exception("database does not answer, trying again")

    def _visit(self) -> None:
        """Hold one connection, until it breaks or the session is stopped.

        Raises MmsError; CredentialFileError, AccessError for the session's own credentials; LeaseLostError;
        SQLAlchemyError; OSError.
        """
        with ExitStack() as marked:
            if self._visit_marks is not None:
                self._mark = marked.enter_context(self._visit_marks.mark(self._relay.name))
            self._protocol_faults.visit_begins()
            with self._connect() as client:
                self._client = client
                self._begin(client)
                log.info("connected", relay=self._relay.name, host=self._relay.host, port=self._relay.port)
                self._work_until_stopped(client)

    def _recall(self) -> None:
        """Read what was known of the relay before. Raises SQLAlchemyError."""
        figures = self._repository.link_figures(self._relay.name)
        self._allowance.resume(figures.day, figures.day_bytes)
        self._protocol_faults.recall()
        self._has_recalled = True

    def _connect(self) -> Client:
        """Return a client that is connected. Raises MmsError, CredentialFileError, AccessError."""
        own = credentials(self._settings.relays, self._relay.name)
        return Client.connect(
            self._relay.host,
            self._relay.port,
            connect_timeout_s=self._settings.connect_timeout_s,
            request_timeout_s=self._settings.request_timeout_s,
            tls=own.tls,
            password=own.spoken_password,
            limits=self._policy.client,
        )

    def _work_until_stopped(self, client: Client) -> None:
        while not self._stopping.is_set():
            asked = self._requested.is_set()
            self._requested.clear()
            waiting = self._work(client, asked=asked)
            self._link.answered(client.round_trip_s, "; ".join(self._remarks()) or None)
            self._protocol_faults.round_succeeded()
            self._wait(client, self._hurried_period_s() if waiting else self._settings.poll_period_s)
        self._link.visit_ended()

    def _hurried_period_s(self) -> float:
        """Return the pause between scans in a hurry [s]; longer where listing alone keeps the relay busy."""
        gentle_s = max(HURRIED_PERIOD_S, LISTING_PAUSE * self._directory.listing_s)
        return min(gentle_s, self._settings.poll_period_s)

    def _begin(self, client: Client) -> None:
        """Find out what the relay offers over a new connection, and use that. Raises MmsError."""
        acquisition = self._discovery.discover(client)
        self._triggers.use(acquisition)
        self._clock.begin(acquisition.measurands)
        self._folders.begin()
        if self._metering is not None:
            self._metering.begin(acquisition.measurands)
        self._subscription.begin(client, ReportQueue(self._wake_up), acquisition)
        self._requested.set()  # what was asked of an earlier session may be open
        self._link.connected()

    def _remarks(self) -> list[str]:
        """Return what cannot be had of the relay at present."""
        busy = None if self._busy is None else f"no recording is fetched for now: {self._busy}"
        reasons = (self._subscription.refusal, busy, self._folders.missing)
        return [reason for reason in reasons if reason is not None]

    def _wait(self, client: Client, longest_s: float) -> None:
        """Wait until there is something to do, or for so long; do what falls due meanwhile.

        That is the triggers of a series, and samples that end before the next of them.
        Reports that announce no record, of which a chattering input sends many, do not end the wait.
        """
        until_s = time.monotonic() + longest_s
        while not (self._requested.is_set() or self._stopping.is_set()) and time.monotonic() < until_s:
            due_in_s = self._triggers.due_in_s()
            if due_in_s <= 0:
                self._triggers.trigger_again(client)
                continue
            if self._metering is not None and self._metering.takes_s() < due_in_s:
                due_in_s = min(due_in_s, self._metering.due_in_s())
                if due_in_s <= 0:
                    self._metering.sample(client)
                    continue
            with nullcontext() if self._mark is None else self._mark.idle():
                self._wake_up.wait(max(0.0, min(due_in_s, until_s - time.monotonic())))
            self._wake_up.clear()
            if self._handle_reports():
                return

    def _handle_reports(self) -> bool:
        """Handle the reports that have arrived. Returns whether one announces a record."""
        announced = self._subscription.handle_all()
        if announced:
            self._record_expected_until_s = time.monotonic() + self._settings.record_timeout_s
        return announced

    def _work(self, client: Client, *, asked: bool) -> bool:
        """Do one round: reports, directory, requests. Returns whether a record is on its way.

        asked: somebody may have requested a recording.
        """
        until_trigger_s = self._triggers.due_in_s()
        if until_trigger_s == math.inf:
            self._subscription.retry_if_due(client)
        self._handle_reports()
        if asked or not self._is_woken or self._triggers.are_open:
            self._triggers.recall()
        if until_trigger_s < LISTING_PAUSE * self._directory.listing_s:
            return True
        expected = time.monotonic() < self._record_expected_until_s
        if self._record_expected_until_s and not expected:
            self._directory.pull_untimed_again()
            self._record_expected_until_s = 0.0
        scan = self._directory.scan(client, self._triggers.claim, expected=expected, within_s=until_trigger_s)
        self._busy = scan.busy
        if scan.busy is not None:
            self._triggers.link_failed(f"lists no files for now: {scan.busy}")
            return expected
        triggered = self._triggers.follow(client, scan)
        if not triggered and not scan.waiting:
            self._clock.measure_if_due(client)
        if scan.taken and not scan.waiting:
            self._record_expected_until_s = 0.0
        expecting = bool(scan.waiting) or time.monotonic() < self._record_expected_until_s
        if not expecting:
            self._subscription.save_entry_id()
        if self._text_reports is not None and not (expecting or triggered) and until_trigger_s == math.inf:
            self._text_reports.work_if_due(client)
        self._note_findings(scan)
        # Where a report will announce the record, there is nothing to look for until it comes.
        return expecting or (triggered and self._subscription.report_control is None)

    def _note_findings(self, scan: Scan) -> None:
        reports = self._text_reports
        unread = [] if reports is None or reports.remark is None else [reports.remark]
        self._discovery.save(
            report_control=self._subscription.report_control,
            directory=self._folders.directory,
            remarks=[*self._remarks(), *unread],
            text_reports=() if reports is None else reports.offered,
            ignored=scan.ignored,
            ignored_in_all=scan.ignored_in_all,
        )
