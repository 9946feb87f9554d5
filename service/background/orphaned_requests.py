"""Ends recording requests whose relay no gateway visits.

A gateway ends the open requests of the relays it holds, also where a relay does not answer. Nobody holds a
relay when gateways crash or do not start, when there are too few of them, or when the relay left the plant. A
request would then stay open for ever, and an open request keeps the motor's schedule from making the next.

The time of a request runs only while nobody visits its relay, by the monotonic clock. It starts again from
zero once a gateway has held the relay for `record_timeout_s` without a break: by then the gateway has dealt
with the request itself.
"""

import time
from collections.abc import Callable

import structlog

from service.configuration.settings import Settings
from service.storage import Repository
from service.storage.records import RecordingRequest
from service.storage.states import RecordingRequestState
from service.timing.peer_liveness import PeerLiveness

log = structlog.get_logger(__name__)

PERIOD_S = 2.0

TRIGGERED_LIMIT_S = 3600.0
"""For a request whose relay was triggered: the record may wait in the relay until a gateway comes back."""


class OrphanedRequestEnder:
    """Fails every open request that has had no gateway for too long."""

    def __init__(
        self,
        settings: Settings,
        repository: Repository,
        *,
        gateway_problem: Callable[[], str | None],
        restart_delay_s: float,
    ) -> None:
        """
        gateway_problem: why gateways of this service do not run; None while all do.
        restart_delay_s: the longest pause before a gateway that ended is started again.
        """
        self._repository = repository
        self._gateway_problem = gateway_problem
        self._record_timeout_s = settings.record_timeout_s
        # Within this time a gateway that ended runs again, or another has taken over its relays.
        self._limit_s = settings.record_timeout_s + settings.lease_s + restart_delay_s
        self._peers = PeerLiveness(settings.lease_s)
        self._checked_s: float | None = None
        self._held_for_s: dict[str, float] = {}
        self._orphaned_for_s: dict[str, float] = {}

    def end_overdue(self, now_s: float) -> None:
        """Fail the requests that have waited too long; `now_s` is monotonic [s]. Raises SQLAlchemyError."""
        passed_s = 0.0 if self._checked_s is None else now_s - self._checked_s
        self._checked_s = now_s
        self._end_dead_gateways(now_s)
        held = self._repository.held_relays()
        self._held_for_s = {relay: self._held_for_s.get(relay, 0.0) + passed_s for relay in held}
        orphaned_for_s = {}
        for request in self._repository.all_open_recording_requests():
            waited_s = orphaned_for_s[request.id] = self._waited_s(request, passed_s)
            if request.ied not in held and waited_s > self._limit_of_s(request):
                self._fail(request, waited_s)
        self._orphaned_for_s = orphaned_for_s

    def _waited_s(self, request: RecordingRequest, passed_s: float) -> float:
        """How long the request has been seen while nobody visited its relay [s]."""
        before_s = self._orphaned_for_s.get(request.id)
        held_for_s = self._held_for_s.get(request.ied)
        if before_s is None:
            return 0.0
        if held_for_s is None:
            return before_s + passed_s
        return before_s if held_for_s < self._record_timeout_s else 0.0

    def _limit_of_s(self, request: RecordingRequest) -> float:
        if request.state is RecordingRequestState.REQUESTED:
            return self._limit_s
        return max(self._limit_s, TRIGGERED_LIMIT_S)

    def _end_dead_gateways(self, now_s: float) -> None:
        """Free the relays of gateways that died with their host: no other gateway may be left to do it."""
        for gateway, count in self._peers.dead(self._repository.heartbeats(), now_s).items():
            if self._repository.end_gateway(gateway, heartbeats=count, now_ns=time.time_ns()):
                log.warning("gateway is dead; its relays are free", gateway=gateway)

    def _fail(self, request: RecordingRequest, waited_s: float) -> None:
        cause = self._cause(request)
        reason = f"{request.ied}: no gateway has visited the relay for {waited_s:.0f} s: {cause}"
        if request.state is not RecordingRequestState.REQUESTED:
            reason += "; it was triggered, and a record it made is pulled without a report when it is visited"
        if self._repository.fail_orphaned_request(request, reason, now_ns=time.time_ns()):
            log.warning("recording request failed", relay=request.ied, request=request.id, reason=reason)

    def _cause(self, request: RecordingRequest) -> str:
        """Why nobody visits the relay, and what can be done about it."""
        if not self._repository.is_in_service(request.ied):
            return "it is not in the plant's files any more; ask for a motor that GET /api/v1/motors lists"
        problem = self._gateway_problem()
        if problem is not None:
            return f"gateways do not run ({problem}); the service's log says why, GET /readyz when they do"
        quarantine = self._repository.quarantine(request.ied)
        if quarantine is not None:
            return f"it was set aside, {quarantine.reason}; see GET /api/v1/ieds/{request.ied}"
        return (
            "the gateways that run hold other relays; see GET /api/v1/gateways, and the settings "
            "relays_per_gateway, scd and motors of each"
        )
