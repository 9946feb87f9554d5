"""Event reports of relays that no gateway visits are given up here; all others are their gateway's affair.

A gateway ends the reports of the relays it holds, those that do not answer included. Where none holds a
relay, because gateways crash or do not start, are too few, or the relay left the plant, nobody else would,
and an open report keeps the motor's schedule from asking for the next.

A report's time runs only while nobody visits its relay, by a clock that only goes forward, and begins anew
when a gateway has held the relay for `record_timeout_s` without a break: by then it has seen to it itself.
"""

import time
from collections.abc import Callable
from threading import Event, Thread

import structlog
from sqlalchemy.exc import SQLAlchemyError

from service.collector.gateway.peer_liveness import PeerLiveness
from service.collector.supervision.supervisor import LONGEST_DELAY_S
from service.configuration.settings import Settings
from service.storage import Repository
from service.storage.records import RecordingRequest
from service.storage.states import RecordingRequestState

log = structlog.get_logger(__name__)

PERIOD_S = 2.0

RECORD_PATIENCE_S = 3600.0
"""Of a report that was triggered: its record may wait in the relay, for a gateway that comes back."""


class OrphanedRequests:
    """One thread. `problem` says why gateways of this service do not run, None while all do."""

    def __init__(
        self, settings: Settings, repository: Repository, *, problem: Callable[[], str | None]
    ) -> None:
        self._repository = repository
        self._problem = problem
        self._record_timeout_s = settings.record_timeout_s
        # A gateway that ended is started again, or its relays are taken over, within this grace.
        self._patience_s = settings.record_timeout_s + settings.lease_s + LONGEST_DELAY_S
        self._peers = PeerLiveness(settings.lease_s)
        self._looked_s: float | None = None
        self._held_for_s: dict[str, float] = {}
        self._waited_s: dict[str, float] = {}
        self._stopping = Event()
        self._thread = Thread(target=self._run, name="unvisited", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def stop(self) -> None:
        self._stopping.set()
        self._thread.join()

    def look(self, now_s: float) -> None:
        """Give up what has waited too long; `now_s` is monotonic [s]. Raises SQLAlchemyError: look again."""
        passed_s = 0.0 if self._looked_s is None else now_s - self._looked_s
        self._looked_s = now_s
        self._end_the_dead(now_s)
        held = self._repository.held_relays()
        self._held_for_s = {ied: self._held_for_s.get(ied, 0.0) + passed_s for ied in held}
        waited_s = {}
        for report in self._repository.all_open_recording_requests():
            waited_s[report.id] = self._waited(report, passed_s)
            if report.ied not in held and waited_s[report.id] > self._limit_s(report):
                self._give_up(report, waited_s[report.id])
        self._waited_s = waited_s

    def _waited(self, report: RecordingRequest, passed_s: float) -> float:
        """How long a report has been seen without anybody who visits its relay [s]."""
        before_s = self._waited_s.get(report.id)
        held_for_s = self._held_for_s.get(report.ied)
        if before_s is None:
            return 0.0
        if held_for_s is None:
            return before_s + passed_s
        return before_s if held_for_s < self._record_timeout_s else 0.0

    def _limit_s(self, report: RecordingRequest) -> float:
        requested = report.state is RecordingRequestState.REQUESTED
        return self._patience_s if requested else max(self._patience_s, RECORD_PATIENCE_S)

    def _end_the_dead(self, now_s: float) -> None:
        """A gateway of another host that died leaves its leases behind, and perhaps no gateway to notice."""
        for gateway, beats in self._peers.dead(self._repository.beats(), now_s).items():
            if self._repository.end_gateway(gateway, beats=beats, now_ns=time.time_ns()):
                log.warning("a gateway is dead, its relays are free", gateway=gateway)

    def _give_up(self, report: RecordingRequest, waited_s: float) -> None:
        reason = f"{report.ied}: no gateway has visited the relay for {waited_s:.0f} s: {self._why(report)}"
        if report.state is not RecordingRequestState.REQUESTED:
            reason += "; it was triggered, and a record it made is pulled without a report when it is visited"
        if self._repository.give_up_unvisited(report, reason, now_ns=time.time_ns()):
            log.warning("event report failed", relay=report.ied, recording_request=report.id, reason=reason)

    def _why(self, report: RecordingRequest) -> str:
        """And what to do about it."""
        if not self._repository.is_in_service(report.ied):
            return "it is not in the plant's files any more; ask for a motor that GET /api/v1/motors lists"
        problem = self._problem()
        if problem is not None:
            return f"gateways do not run ({problem}); the service's log says why, GET /readyz when they do"
        quarantine = self._repository.quarantine(report.ied)
        if quarantine is not None:
            return f"it was set aside, {quarantine.reason}; see GET /api/v1/ieds/{report.ied}"
        return (
            "the gateways that run hold other relays; see GET /api/v1/gateways, and the settings "
            "relays_per_gateway, scd and motors of each"
        )

    def _run(self) -> None:
        while not self._stopping.wait(PERIOD_S):
            try:
                self.look(time.monotonic())
            except SQLAlchemyError as error:
                log.warning("database does not answer, trying again", error=str(error))
