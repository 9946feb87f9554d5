"""One relay, one thread: connect, subscribe, keep its directory and its event reports up to date, for ever.

What a relay does wrong ends at its own session: the link is down with its reason, and tried again.
"""

import math
import time
from collections.abc import Callable
from contextlib import ExitStack, nullcontext
from threading import Event

import structlog
from sqlalchemy.exc import SQLAlchemyError

from mms import Client, ClientLimits, CredentialFileError, MmsError, ProtocolError
from service.collector.records.allowance import DailyAllowance
from service.collector.records.directory import RecordDirectory, Scan
from service.collector.records.event_folder import EventFolder
from service.collector.session.clock import ClockWatch
from service.collector.session.discovery import Discovery
from service.collector.session.link import Link
from service.collector.session.metering import Metering
from service.collector.session.protocol_fault_counter import ProtocolFaultCounter
from service.collector.session.quarantine import QuarantinePolicy
from service.collector.session.relay_alarms import RelayAlarms
from service.collector.session.report_subscription import ReportQueue, ReportSubscription
from service.collector.session.visit_marks import VisitMark, VisitMarks
from service.collector.triggers.trigger_queue import TriggerQueue
from service.configuration.relay_access import AccessError, credentials
from service.configuration.settings import Settings
from service.plant import Relay
from service.recording_store.store import RecordingStore
from service.storage import LeaseLostError, Repository
from service.storage.records import LinkNote, Sample

log = structlog.get_logger(__name__)

HURRIED_PERIOD_S = 0.2
"""Between scans while a record is known to be on its way."""

LISTING_PAUSE = 4.0
"""Of the time that listing the directory takes: so long a pause before the next, also while in a hurry."""

FIRST_RETRY_S, LONGEST_RETRY_S = 0.5, 10.0


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
        visit_marks: VisitMarks | None = None,
        on_sample: Callable[[Sample], None] | None = None,
        on_note: Callable[[LinkNote], None] | None = None,
        client_limits: ClientLimits | None = None,
    ) -> None:
        """`gateway`: who holds the relay's lease; None where relays are not shared.

        visit_marks: where a visit is marked, for whoever finds the process dead; None where nobody looks.
        on_sample: takes what the relay measures; None where nobody wants it.
        on_note: takes what goes over a link that stays up; None where it is written at once.
        client_limits: how much the MMS client takes from a relay that keeps answering; its own by default.
        """
        self._relay = relay
        self._repository = repository
        self._settings = settings
        self._client_limits = client_limits or ClientLimits()
        figures = repository.link_figures(relay.name)
        allowance = DailyAllowance(
            settings.max_relay_bytes_per_day, day=figures.day, used_bytes=figures.day_bytes
        )
        self._link = Link(relay.name, repository, allowance, on_note=on_note)
        alarms = RelayAlarms(relay.name, repository)
        self._discovery = Discovery(relay, repository, alarms)
        self._subscription = ReportSubscription(relay.name, repository, self._link)
        self._folder = EventFolder(relay.name, settings.events_directory, relay.overrides.events_directory)
        self._directory = RecordDirectory(
            relay,
            motor,
            repository,
            store,
            settings,
            folder=self._folder,
            alarms=alarms,
            allowance=allowance,
            on_bytes=self._link.received,
        )
        self._clock = ClockWatch(relay.name, repository)
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
        self._protocol_faults = ProtocolFaultCounter(
            relay.name, repository, QuarantinePolicy(settings.quarantine_s)
        )
        self._visit_marks = visit_marks
        self._mark: VisitMark | None = None
        self._client: Client | None = None
        self._stopping = Event()
        self._stirred = Event()
        self._asked = Event()
        self._expecting_until_s = 0.0

    def wake(self) -> None:
        """Somebody asked for an event report."""
        self._asked.set()
        self._stirred.set()

    def stop(self) -> None:
        """End after what is under way."""
        self._stopping.set()
        self.wake()

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
            trouble = "does not answer"
            broken = False
            try:
                self._visit()
            except (MmsError, CredentialFileError, AccessError) as error:
                reason = str(error)
                broken = isinstance(error, ProtocolError)
            except LeaseLostError as error:
                log.warning("visit ended", relay=self._relay.name, reason=str(error))
                return
            except Exception as error:  # a full disk or a bug here must not silence the relay for ever
                log.exception("session failed", relay=self._relay.name)
                reason = f"{type(error).__name__}: {error}"
                trouble = "is not visited"
            if reason is not None and not self._stopping.is_set():
                self._note_failure(trouble, reason)
                if broken and self._is_set_aside(reason):
                    return
            if time.monotonic() - visited_s > LONGEST_RETRY_S:
                retry_s = FIRST_RETRY_S
            self._stopping.wait(retry_s)
            retry_s = min(2 * retry_s, LONGEST_RETRY_S)

    def _visit(self) -> None:
        """One connection, until it breaks or the session is stopped.

        Raises MmsError; CredentialFileError, AccessError for what is to be shown the relay.
        """
        with ExitStack() as marked:
            if self._visit_marks is not None:
                self._mark = marked.enter_context(self._visit_marks.mark(self._relay.name))
            self._protocol_faults.visit_begins()
            self._visit_marked()

    def _visit_marked(self) -> None:
        shown = credentials(self._settings.relays, self._relay.name)
        with Client.connect(
            self._relay.host,
            self._relay.port,
            connect_timeout_s=self._settings.connect_timeout_s,
            request_timeout_s=self._settings.request_timeout_s,
            tls=shown.tls,
            password=shown.spoken_password,
            limits=self._client_limits,
        ) as client:
            self._client = client
            self._begin(client)
            log.info("connected", relay=self._relay.name, host=self._relay.host, port=self._relay.port)
            while not self._stopping.is_set():
                self._asked.clear()
                waiting = self._work(client)
                self._link.answered(client.round_trip_s, "; ".join(self._remarks()) or None)
                self._protocol_faults.round_succeeded()
                self._wait(client, self._hurried_period_s() if waiting else self._settings.poll_period_s)
            self._link.left()

    def _hurried_period_s(self) -> float:
        """A relay that takes long to list its records is not kept busy with that alone."""
        gentle_s = max(HURRIED_PERIOD_S, LISTING_PAUSE * self._directory.listing_s)
        return min(gentle_s, self._settings.poll_period_s)

    def _begin(self, client: Client) -> None:
        """A new connection: find out what the relay is, and use that. Raises MmsError."""
        acquisition = self._discovery.look(client)
        self._triggers.use(acquisition)
        self._clock.use(acquisition.measurands)
        self._folder.begin()
        if self._metering is not None:
            self._metering.begin(acquisition.measurands)
        self._subscription.begin(client, ReportQueue(self._stirred), acquisition)
        self._link.connected()

    def _remarks(self) -> list[str]:
        """What of the relay cannot be had at present."""
        told = (self._subscription.refusal, self._folder.missing, self._folder.unread)
        return [words for words in told if words is not None]

    def _wait(self, client: Client, longest_s: float) -> None:
        """Until there is something to do, or for so long; what is to be sampled meanwhile is.

        Reports that tell of no record, of which a chattering input sends many, are heeded and change nothing.
        """
        until_s = time.monotonic() + longest_s
        while not (self._asked.is_set() or self._stopping.is_set()) and time.monotonic() < until_s:
            due_in_s = math.inf if self._metering is None else self._metering.due_in_s()
            if self._metering is not None and due_in_s <= 0:
                self._metering.sample(client)
                continue
            with nullcontext() if self._mark is None else self._mark.idle():
                self._stirred.wait(min(due_in_s, until_s - time.monotonic()))
            self._stirred.clear()
            if self._handle_reports():
                return

    def _handle_reports(self) -> bool:
        """Whether what has arrived tells of a record."""
        tells = self._subscription.handle_all()
        if tells:
            self._expecting_until_s = time.monotonic() + self._settings.record_timeout_s
        return tells

    def _note_failure(self, trouble: str, reason: str) -> None:
        self._link.failed(reason)
        try:
            self._triggers.link_failed(f"{trouble}: {reason}")
        except SQLAlchemyError:
            log.exception("database does not answer, trying again")

    def _is_set_aside(self, reason: str) -> bool:
        """A visit ended by a broken protocol: whether that was once too often."""
        try:
            return self._protocol_faults.count_fault(reason)
        except SQLAlchemyError:
            log.exception("database does not answer, trying again")
            return False

    def _work(self, client: Client) -> bool:
        """One round: reports, directory, event reports. Returns whether a record is on its way."""
        self._subscription.keep(client)
        self._handle_reports()
        self._triggers.recall()
        told = time.monotonic() < self._expecting_until_s
        if self._expecting_until_s and not told:
            self._directory.doubt_the_untimed()
            self._expecting_until_s = 0.0
        scan = self._directory.scan(client, self._triggers.claim, told=told)
        triggered = self._triggers.follow(client, scan)
        if not triggered and not scan.waiting:
            self._clock.look(client)
        if scan.taken and not scan.waiting:
            self._expecting_until_s = 0.0
        expecting = bool(scan.waiting) or time.monotonic() < self._expecting_until_s
        if not expecting:
            self._subscription.save()
        self._note_findings(scan)
        # Where a report will tell of the record, there is nothing to look for until it comes.
        return expecting or (triggered and self._subscription.report_control is None)

    def _note_findings(self, scan: Scan) -> None:
        self._discovery.note(
            report_control=self._subscription.report_control,
            directory=self._folder.directory,
            remarks=self._remarks(),
            ignored=scan.ignored,
            ignored_in_all=scan.ignored_in_all,
        )
