"""Event reports somebody asked for: trigger the relay, wait for its record, or say why there is none.

A report is marked triggered in the database BEFORE the relay is operated. Whatever happens in between, a
crash included, the relay is operated at most once for it: its room for records is small, and each one more
drives out an older one. The price is paid in one unlucky case, a crash after the mark and before the
operation: no record comes, the report fails at its time limit, and the person asks again. A crash after the
operation costs nothing: the record is in the relay's directory, and the restarted collector gives it to the
report. The mark is refused to a gateway that does not hold the relay's lease any more: a gateway that was
frozen, and wakes up after another took its relays over, operates nothing.
"""

import time
from collections.abc import Set

import structlog

from mms import (
    AccessDenied,
    Client,
    ControlRefused,
    FunctionalConstraint,
    NotFound,
    ProtocolError,
    TemporarilyUnavailable,
    Timestamp,
    ValueRefused,
)
from service.collector.records.directory import Scan
from service.collector.session.clock import ClockWatch, reading, stamp_of
from service.collector.triggers.deadlines import RequestDeadlines
from service.plant import Acquisition, Relay, TriggerAction, promised
from service.storage import Repository
from service.storage.records import RecordingRequest
from service.storage.states import IN_THE_RELAY, RecordingRequestState

log = structlog.get_logger(__name__)

REFUSALS = (AccessDenied, ControlRefused, NotFound, ProtocolError, ValueError)
"""The relay answers, and the answer is no; ValueError: an override that is no reference. Link errors leave a
report as it is, until its time limit."""

HOLD_S = 0.05
"""How long the remote bit stays set: relays look at their equations every quarter cycle, some less often."""


class Triggering:
    """The event reports of one relay, one at a time. Used by that relay's session alone.

    A new record belongs to the oldest report that was triggered, unless it was listed before the trigger.
    """

    def __init__(
        self, relay: Relay, repository: Repository, *, record_timeout_s: float, gateway: str | None = None
    ) -> None:
        self._relay = relay
        self._acquisition = promised(relay)
        self._repository = repository
        self._clock = ClockWatch(relay.name, repository)
        self._gateway = gateway
        self._deadlines = RequestDeadlines(record_timeout_s)
        self._outstanding: RecordingRequest | None = None
        self._next: RecordingRequest | None = None
        self._claimed = False
        self._operated_for: str | None = None
        self._listed_before: frozenset[str] = frozenset()
        self._held_up_since_s: float | None = None

    def use(self, acquisition: Acquisition) -> None:
        """What a new connection has found."""
        self._acquisition = acquisition
        self._clock.use(acquisition.measurands)

    def recall(self) -> None:
        """Look up which report, if any, waits for a record of this relay, and which one is next."""
        reports = self._repository.open_recording_requests(self._relay.name)
        self._outstanding = next((each for each in reports if each.state in IN_THE_RELAY), None)
        self._next = next((each for each in reports if each.state is RecordingRequestState.REQUESTED), None)
        self._claimed = False
        if self._outstanding is not None and self._outstanding.id != self._operated_for:
            self._take_over(self._outstanding)

    def _take_over(self, report: RecordingRequest) -> None:
        """Triggered by a gateway now gone: what it had seen before and could not fetch is another record."""
        self._operated_for = report.id
        self._listed_before = self._repository.unfetched_names(
            self._relay.name, seen_before_ns=report.triggered_ns or 0
        )

    def claim(self, record_name: str) -> str | None:
        """The report a new record belongs to; it is that record's once both are written down together."""
        self.recall()
        self._claimed = True
        self._deadlines.gave_a_record()
        report = self._outstanding
        if report is None or record_name in self._listed_before:
            return None
        return report.id

    def follow(self, client: Client, scan: Scan) -> bool:
        """After `recall` and a scan: trigger the next report, or see how the outstanding one is doing.

        Returns whether a record is on its way. Raises MmsError when the link fails.
        """
        if self._claimed:
            self.recall()
        self._deadlines.answered(time.monotonic())
        report = self._outstanding
        if report is None:
            if self._next is not None:
                return self._is_held_up(scan) or self._grant(client, self._next, scan)
            if not scan.waiting:
                self._clock.look(client)
            return False
        held_back = [name for name in scan.held_back if name not in self._listed_before]
        if held_back:
            self._fail(
                report,
                f"{self._relay.name}: its record waits in the relay for another day, because the relay sent "
                "as much today as the setting max_relay_bytes_per_day allows",
            )
            return False
        appeared = {*scan.waiting, *scan.failing} - self._listed_before
        still_written = appeared - scan.failing.keys()  # for as long as the directory's own limits allow
        is_overdue = self._deadlines.ends_without_record(report, time.monotonic())
        if appeared and report.state is RecordingRequestState.TRIGGERED:
            self._repository.mark_recorded(report.id, now_ns=time.time_ns())
        elif is_overdue and not still_written:
            self._fail(report, self._why_overdue(report, scan, appeared))
            return False
        return True

    def _why_overdue(self, report: RecordingRequest, scan: Scan, appeared: Set[str]) -> str:
        within = f"within {self._deadlines.timeout_s:g} s"
        failing = sorted(appeared & scan.failing.keys())
        if failing:
            return f"{self._relay.name}: its record could not be fetched {within}: {scan.failing[failing[0]]}"
        if report.state is RecordingRequestState.RECORDED:
            return (
                f"{self._relay.name}: its record was seen in the relay, but is gone, or still changes after "
                f"{self._deadlines.timeout_s:g} s"
            )
        if scan.no_folder is not None:
            return f"{self._relay.name}: expected a record {within} of the trigger; {scan.no_folder}"
        return (
            f"{self._relay.name}: expected a record {within} of the trigger, "
            "found none; check the relay's event report settings (ER)"
        )

    def link_failed(self, reason: str) -> None:
        """The relay cannot be asked, `reason` says why: reports that waited for it long enough fail."""
        now_s = time.monotonic()
        for report in self._repository.open_recording_requests(self._relay.name):
            if self._deadlines.ends_without_answer(report, now_s):
                self._fail(report, f"{self._relay.name} {reason}")

    def _is_held_up(self, scan: Scan) -> bool:
        """Whether the trigger had better wait for records that are about to be taken, which it has not made.

        After a crash in between, nobody would know that they were there before it.
        """
        now_s = time.monotonic()
        if not scan.waiting:
            self._held_up_since_s = None
            return False
        if self._held_up_since_s is None:
            self._held_up_since_s = now_s
        return now_s < self._held_up_since_s + self._deadlines.timeout_s

    def _grant(self, client: Client, report: RecordingRequest, scan: Scan) -> bool:
        """Trigger, unless there is nothing to trigger by or no way to have the record."""
        control = self._acquisition.trigger
        if control is None:
            self._fail(report, f"{self._relay.name} cannot be triggered: {self._acquisition.no_trigger}")
        elif scan.unreachable is not None:
            self._fail(report, f"{self._relay.name} is not triggered: {scan.unreachable}")
        else:
            return self._trigger(client, report, control, scan.listed)
        return False

    def _trigger(
        self, client: Client, report: RecordingRequest, control: str, listed: frozenset[str]
    ) -> bool:
        try:
            if _is_set(client, control):
                client.operate(control, False)  # noqa: FBT003 - the value of a control
            stamp_before = _stamp_of(client, control)
            self._repository.mark_triggered(report.id, now_ns=time.time_ns(), gateway=self._gateway)
            self._operated_for, self._listed_before = report.id, listed
            asked_ns = time.time_ns()
            client.operate(control, True)  # noqa: FBT003
            answered_ns = time.time_ns()
        except REFUSALS as error:
            self._fail(report, f"{self._relay.name} refuses the trigger: {error}")
            return False
        log.info("triggered", relay=self._relay.name, motor=report.motor, recording_request=report.id)
        time.sleep(HOLD_S)
        stamp = _stamp_of(client, control)
        if stamp is not None and stamp != stamp_before:
            self._clock.note(reading(stamp, asked_ns=asked_ns, answered_ns=answered_ns))
        if self._acquisition.trigger_action is TriggerAction.PULSE and not _is_set(client, control):
            return True
        try:
            client.operate(control, False)  # noqa: FBT003
        except REFUSALS as error:
            log.warning("the trigger stays set", relay=self._relay.name, control=control, reason=str(error))
        return True

    def _fail(self, report: RecordingRequest, reason: str) -> None:
        self._repository.fail_recording_request(report.id, reason, now_ns=time.time_ns())
        log.warning("event report failed", relay=self._relay.name, recording_request=report.id, reason=reason)


def _stamp_of(client: Client, control: str) -> Timestamp | None:
    """Of a control's latest change; None where the relay gives none. Raises MmsError (the link)."""
    return stamp_of(client, f"{control}.t", FunctionalConstraint.ST)


def _is_set(client: Client, control: str) -> bool:
    """Whether a control is on; some relays do not let what may be written be read. Raises MmsError (link)."""
    try:
        return client.read(f"{control}.stVal", FunctionalConstraint.ST) is True
    except (AccessDenied, NotFound, TemporarilyUnavailable, ValueRefused):
        return False
