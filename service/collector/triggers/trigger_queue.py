"""Recording requests of one relay: trigger the relay, wait for its record, or say why there is none.

A request is marked triggered in the database BEFORE the relay is operated. Whatever happens in between, a
crash included, the relay is operated at most once for it: a relay has room for few records, and each new one
drives out an older one. The price is paid in one case, a crash after the mark and before the operation: no
record comes, the request fails at its time limit, and the person asks again. A crash after the operation
costs nothing: the record is in the relay's directory, and the restarted collector gives it to the request.
A gateway that no longer holds the relay's lease is refused the mark. So a gateway that was frozen, and wakes
up after another took over its relays, operates nothing.
"""

import time
from collections.abc import Set
from math import inf
from typing import Protocol

import structlog

from mms import (
    AccessDenied,
    Client,
    ControlRefused,
    FunctionalConstraint,
    NotFound,
    ProtocolError,
    ServiceFailed,
    TemporarilyUnavailable,
    Timestamp,
)
from service.collector.records.scan import Scan
from service.collector.triggers.listed_before import ListedBefore, listed_in
from service.collector.triggers.request_deadlines import RequestDeadlines, UnansweredRequests
from service.collector.triggers.series import SeriesUnderWay
from service.plant import Acquisition, Relay, TriggerAction, acquisition_from_scl
from service.plant.series_rhythm import NoSeriesError, rhythm_of
from service.storage import Repository
from service.storage.records import RecordingRequest, RemoteRecord
from service.storage.states import IN_THE_RELAY, RecordingRequestState

log = structlog.get_logger(__name__)

REFUSALS = (
    AccessDenied, ControlRefused, NotFound, ProtocolError, ServiceFailed, TemporarilyUnavailable, ValueError,
)  # fmt: skip
"""By these errors the relay refuses. ValueError stands for an override that is no reference. Errors of the
link leave a request as it is until its time limit."""

RECALLED_FOR_S = 1.0
"""So long a new record may rely on the requests that were looked up last."""

HOLD_S = 0.05
"""The remote bit stays set so long: relays look at their equations every quarter cycle, some less often."""


class ControlClock(Protocol):
    """Reads the relay's clock from the time stamp of a control's change."""

    def control_stamp(self, client: Client, control: str) -> Timestamp | None:
        """Return the stamp of the latest change; None where the relay gives none. Raises MmsError (link)."""

    def note_change(self, stamp: Timestamp, *, asked_ns: int, answered_ns: int) -> None:
        """Note the stamp of a change between two times of this host's clock. Raises SQLAlchemyError."""


class TriggerQueue:
    """The recording requests of one relay, one at a time. Used by that relay's session alone.

    A new record belongs to the oldest request that was triggered, unless it was listed before the trigger.
    """

    def __init__(
        self,
        relay: Relay,
        repository: Repository,
        *,
        clock: ControlClock,
        record_timeout_s: float,
        gateway: str | None = None,
    ) -> None:
        self._relay = relay
        self._acquisition = acquisition_from_scl(relay)
        self._repository = repository
        self._clock = clock
        self._gateway = gateway
        self._deadlines = RequestDeadlines(record_timeout_s)
        self._unanswered = UnansweredRequests(relay.name, repository, self._deadlines)
        self._outstanding: RecordingRequest | None = None
        self._next: RecordingRequest | None = None
        self._claimed = False
        self._recalled_s = 0.0
        self._operated_for: str | None = None
        self._listed_before = ListedBefore()
        self._held_up_since_s: float | None = None
        self._series: SeriesUnderWay | None = None

    def use(self, acquisition: Acquisition) -> None:
        """Use what a new connection has found. A series ends with its connection."""
        self._acquisition = acquisition
        self._series = None

    def due_in_s(self) -> float:
        """Return the time until the next trigger of a series [s]; infinite where there is none."""
        return inf if self._series is None else self._series.due_in_s(time.monotonic())

    def trigger_again(self, client: Client) -> None:
        """Make the trigger of the series that is due. Raises MmsError (the link).

        Where the relay refuses it the series ends early, and the records made so far are joined.
        """
        series = self._series
        if series is None:
            return
        try:
            client.operate(series.control, True)  # noqa: FBT003 - the value of a control
        except REFUSALS as error:
            log.warning("the series ends early", relay=self._relay.name, reason=str(error))
            self._series = None
            return
        series.triggered(time.monotonic())
        time.sleep(HOLD_S)
        self._end_pulse(client, series.control)

    @property
    def are_open(self) -> bool:
        """Return whether a request was open at the latest look."""
        return self._outstanding is not None or self._next is not None

    def recall(self) -> None:
        """Look up which request, if any, waits for a record of this relay, and which one is next."""
        self._recalled_s = time.monotonic()
        requests = self._repository.open_recording_requests(self._relay.name)
        self._outstanding = next((each for each in requests if each.state in IN_THE_RELAY), None)
        self._next = next((each for each in requests if each.state is RecordingRequestState.REQUESTED), None)
        self._claimed = False
        if self._outstanding is not None and self._outstanding.id != self._operated_for:
            self._take_over(self._outstanding)

    def _take_over(self, request: RecordingRequest) -> None:
        """Go on with the request of a gateway now gone.

        Records which that gateway had seen before the trigger, and could not fetch, belong to no request.
        """
        self._operated_for = request.id
        unfetched = self._repository.unfetched_names(
            self._relay.name, seen_before_ns=request.triggered_ns or 0
        )
        self._listed_before = ListedBefore(open=unfetched)

    def claim(self, record: RemoteRecord) -> str | None:
        """Return the request a new record belongs to; both are then written down in one transaction."""
        # The record before this one may have been what a request waited for, and a fetch may take minutes.
        if self._claimed or time.monotonic() > self._recalled_s + RECALLED_FOR_S:
            self.recall()
        self._claimed = True
        self._deadlines.gave_a_record()
        if self._series is not None:
            self._series.came()
        request = self._outstanding
        if request is None or record in self._listed_before:
            return None
        return request.id

    def follow(self, client: Client, scan: Scan) -> bool:
        """Trigger for the next request, or see how the outstanding one is doing.

        `recall` and a scan come first. Returns whether a record is on its way. Raises MmsError (the link).
        """
        if self._claimed:
            self.recall()
        self._deadlines.answered(time.monotonic())
        request = self._outstanding
        if self._series is not None and self._series.is_over(time.monotonic()):
            self._series = None
        if request is None:
            if self._series is not None:
                return True
            return self._next is not None and (
                self._is_held_up(scan) or self._grant(client, self._next, scan)
            )
        if any(record not in self._listed_before for record in scan.held_back):
            self._fail(
                request,
                f"{self._relay.name}: its record waits in the relay for another day, because the relay sent "
                "as much today as the setting max_relay_bytes_per_day allows",
            )
            return False
        appeared = {record for record in {*scan.waiting, *scan.failing} if record not in self._listed_before}
        still_written = appeared - scan.failing.keys()  # for as long as the directory's own limits allow
        is_overdue = self._series is None and self._deadlines.ends_without_record(request, time.monotonic())
        if appeared and request.state is RecordingRequestState.TRIGGERED:
            self._repository.mark_recorded(request.id, now_ns=time.time_ns())
        elif is_overdue and not still_written:
            self._fail(request, self._why_overdue(request, scan, appeared))
            return False
        return True

    def _why_overdue(self, request: RecordingRequest, scan: Scan, appeared: Set[RemoteRecord]) -> str:
        within = f"within {self._deadlines.timeout_s:g} s"
        failing = min(appeared & scan.failing.keys(), key=lambda record: record.name, default=None)
        if failing is not None:
            return f"{self._relay.name}: its record could not be fetched {within}: {scan.failing[failing]}"
        if request.state is RecordingRequestState.RECORDED:
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
        """Fail the requests that have waited long enough for a relay that cannot be asked; end the series."""
        self._series = None
        self._unanswered.fail_overdue(reason)

    def _is_held_up(self, scan: Scan) -> bool:
        """Return whether the trigger waits for older records that are about to be taken.

        Otherwise, after a crash in between, it would not be known that they were there before the trigger.
        """
        now_s = time.monotonic()
        if not scan.waiting:
            self._held_up_since_s = None
            return False
        if self._held_up_since_s is None:
            self._held_up_since_s = now_s
        return now_s < self._held_up_since_s + self._deadlines.timeout_s

    def _grant(self, client: Client, request: RecordingRequest, scan: Scan) -> bool:
        """Trigger, unless there is nothing to trigger by or no way to have the record."""
        control = self._acquisition.trigger
        if control is None:
            self._fail(request, f"{self._relay.name} cannot be triggered: {self._acquisition.no_trigger}")
        elif scan.unreachable is not None:
            self._fail(request, f"{self._relay.name} is not triggered: {scan.unreachable}")
        else:
            return self._trigger(client, request, control, listed_in(scan))
        return False

    def _is_busy(self, client: Client, request: RecordingRequest, control: str) -> bool:
        """Return whether the relay cannot tell of the control for now: the request then waits its time."""
        try:
            client.read(f"{control}.ctlModel", FunctionalConstraint.CF)
        except TemporarilyUnavailable as error:
            log.info(
                "trigger put off", relay=self._relay.name, recording_request=request.id, reason=str(error)
            )
            self._unanswered.fail_overdue(f"is not triggered: {error}")
            return True
        except REFUSALS:
            return False  # the trigger itself says why
        return False

    def _trigger(self, client: Client, request: RecordingRequest, control: str, listed: ListedBefore) -> bool:
        if self._is_busy(client, request, control):
            return True
        rhythm = None
        if request.seconds is not None:
            try:
                rhythm = rhythm_of(self._repository.record_length(request.motor), request.seconds)
            except NoSeriesError as error:
                self._fail(request, f"{self._relay.name}: {error}")
                return False
        try:
            if _is_set(client, control):
                client.operate(control, False)  # noqa: FBT003 - the value of a control
            stamp_before = self._clock.control_stamp(client, control)
            self._repository.mark_triggered(
                request.id,
                now_ns=time.time_ns(),
                gateway=self._gateway,
                triggers=None if rhythm is None else rhythm.triggers,
            )
            self._operated_for, self._listed_before = request.id, listed
            asked_ns, asked_s = time.time_ns(), time.monotonic()
            client.operate(control, True)  # noqa: FBT003
            answered_ns = time.time_ns()
        except REFUSALS as error:
            self._fail(request, f"{self._relay.name} refuses the trigger: {error}")
            return False
        log.info("triggered", relay=self._relay.name, motor=request.motor, recording_request=request.id)
        time.sleep(HOLD_S)
        stamp = self._clock.control_stamp(client, control)
        if stamp is not None and stamp != stamp_before:
            self._clock.note_change(stamp, asked_ns=asked_ns, answered_ns=answered_ns)
        self._end_pulse(client, control)
        if rhythm is not None:
            self._series = SeriesUnderWay(
                control, rhythm, began_s=asked_s, record_timeout_s=self._deadlines.timeout_s
            )
        return True

    def _end_pulse(self, client: Client, control: str) -> None:
        """Reset the trigger, unless it resets itself. Raises MmsError (the link)."""
        if self._acquisition.trigger_action is TriggerAction.PULSE and not _is_set(client, control):
            return
        try:
            client.operate(control, False)  # noqa: FBT003
        except REFUSALS as error:
            log.warning("the trigger stays set", relay=self._relay.name, control=control, reason=str(error))

    def _fail(self, request: RecordingRequest, reason: str) -> None:
        self._series = None
        self._repository.fail_recording_request(request.id, reason, now_ns=time.time_ns())
        log.warning(
            "recording request failed", relay=self._relay.name, recording_request=request.id, reason=reason
        )


def _is_set(client: Client, control: str) -> bool:
    """Return whether a control is on: False too where it can be written but not read.

    Raises MmsError (the link).
    """
    try:
        return client.read(f"{control}.stVal", FunctionalConstraint.ST) is True
    except (AccessDenied, NotFound, ServiceFailed, TemporarilyUnavailable):
        return False
