"""Visit the relays whose leases a gateway holds, one session a relay, and share with other gateways."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from threading import Event, Thread

import structlog
from sqlalchemy.exc import SQLAlchemyError

from service.collector.gateway.batch_writer import BatchWriter
from service.collector.gateway.lease_watchdog import LeaseWatchdog
from service.collector.session.relay_session import RelaySession
from service.collector.session.visit_marks import VisitMarks
from service.collector.triggers.request_deadlines import RequestDeadlines, UnansweredRequests
from service.configuration.settings import Settings
from service.plant import Plant
from service.recording_store.store import RecordingStore
from service.storage import LeaseLostError, Repository
from service.timing.boot_clock import boot_time_s
from service.timing.peer_liveness import PeerLiveness
from service.timing.periodic_worker import PeriodicWorker

log = structlog.get_logger(__name__)

REQUEST_PERIOD_S = 0.2
"""Between two queries for the recordings somebody has requested."""

LONGEST_STARTING_S = 0.5
"""Of sessions, before the dispatcher does its other work."""

RENEWALS_PER_LEASE = 10
"""How often leases are renewed in the time they last."""

STOP_TIMEOUT_S = 2.0
"""A session may be inside a request that lasts up to its time limit; nothing is lost by leaving it there."""


@dataclass(frozen=True, slots=True)
class GatewayIdentity:
    """Identify a gateway. `id` is never that of two processes that live at the same time."""

    id: str
    host: str
    process_id: int


@dataclass(frozen=True, slots=True)
class _SessionThread:
    """Hold a relay's session and the thread it runs on."""

    session: RelaySession
    thread: Thread


class Gateway:
    """Visit the relays whose leases this gateway holds. `run` lasts as long as its process.

    One thread, the dispatcher, renews the leases, starts and stops the sessions and wakes them. An error in
    it that lasts keeps the leases from being renewed: the lease watchdog then ends the process, and whoever
    supervises it starts another.
    """

    def __init__(
        self,
        identity: GatewayIdentity,
        plant: Plant,
        repository: Repository,
        store: RecordingStore,
        settings: Settings,
        *,
        on_expiry: Callable[[], None],
        visit_marks: VisitMarks | None = None,
    ) -> None:
        """Prepare a gateway that holds no relay yet.

        on_expiry: called when the leases could not be renewed for too long; it has to end the process.

        visit_marks: where it marks which relays it is busy with; None where nobody would read them.
        """
        self._visit_marks = visit_marks
        self._identity = identity
        self._plant = plant
        self._repository = repository
        self._store = store
        self._settings = settings
        self._names = frozenset(relay.name for relay in plant.relays)
        self._peers = PeerLiveness(settings.lease_s)
        self._sessions: dict[str, _SessionThread] = {}
        self._ending: dict[str, _SessionThread] = {}
        self._quarantined: dict[str, UnansweredRequests] = {}
        self._to_start: set[str] = set()
        self._batches = BatchWriter(repository, gateway=identity.id)
        self._registered = False
        self._next_renewal_s = 0.0
        self._dispatcher = PeriodicWorker("the dispatcher", self._dispatch, period_s=REQUEST_PERIOD_S)
        self._watchdog = LeaseWatchdog(settings.lease_s, on_expiry=on_expiry)

    def run(self, stop: Event) -> list[str]:
        """Visit relays until `stop` is set. Returns the names of the threads that did not end in time."""
        self._watchdog.start()
        self._batches.start()
        self._dispatcher.start()
        stop.wait()
        self._dispatcher.stop()
        return self._stop_all()

    def problem(self) -> str | None:
        """Return which thread of the gateway does not do its work at present; None while all do."""
        problems = {
            "dispatcher": self._dispatcher.problem(),
            "batch writer": self._batches.problem(),
            "lease watchdog": self._watchdog.problem(),
        }
        return "; ".join(f"{name}: {text}" for name, text in problems.items() if text is not None) or None

    def _dispatch(self) -> None:
        """Renew the leases when that is due; start sessions; wake those that are asked for a recording.

        Raises SQLAlchemyError.
        """
        if boot_time_s() >= self._next_renewal_s:
            self._renew_leases()
            self._next_renewal_s = boot_time_s() + self._settings.lease_s / RENEWALS_PER_LEASE
        self._start_sessions()
        self._give_back_ended()
        for relay in self._repository.relays_with_requests():
            if relay in self._sessions:
                self._sessions[relay].session.wake()

    def _renew_leases(self) -> None:
        """Renew the leases; stop sessions, and note which to start, as this gateway's fair share changes.

        Raises SQLAlchemyError.
        """
        began_s = boot_time_s()
        if not self._registered:
            if self._ending:  # sessions of its former registration must have ended before the next one
                self._watchdog.renewed(began_s)
                return
            self._register()
        try:
            share = self._repository.share_relays(
                self._identity.id,
                self._names,
                most=self._settings.relays_per_gateway,
                problem=self.problem(),
            )
        except LeaseLostError as error:
            log.warning("starting again", reason=str(error))
            self._registered = False
            self._to_start.clear()
            self._abandon_all()
            return
        self._watchdog.renewed(began_s)
        self._remove_ended()
        self._update_quarantined(share.held)
        busy = self._sessions.keys() | self._ending.keys() | self._quarantined.keys()
        self._to_start = set(share.held - share.surplus - busy)
        for relay in share.surplus & self._sessions.keys():
            self._sessions[relay].session.stop()
            self._ending[relay] = self._sessions.pop(relay)
        unvisited = share.surplus - self._ending.keys()
        if unvisited:
            self._repository.give_back_relays(self._identity.id, unvisited)
        self._end_dead_peers(share.heartbeats)

    def _end_dead_peers(self, heartbeats: dict[str, int]) -> None:
        """Free the relays of the gateways whose counters stand still."""
        peers = {gateway: count for gateway, count in heartbeats.items() if gateway != self._identity.id}
        for gateway, count in self._peers.dead(peers, time.monotonic()).items():
            if self._repository.end_gateway(gateway, heartbeats=count, now_ns=time.time_ns()):
                log.warning("a gateway is dead, its relays are shared out", gateway=gateway)

    def _update_quarantined(self, held: frozenset[str]) -> None:
        """Note which relays are set aside. They are not visited; requests for them fail in time."""
        now_ns = time.time_ns()
        reasons = {
            each.ied: each.reason
            for each in self._repository.quarantines()
            if each.ied in held and each.holds(now_ns)
        }
        self._quarantined = {
            relay: self._quarantined.get(relay) or self._unanswered_requests(relay) for relay in reasons
        }
        for relay, reason in reasons.items():
            self._quarantined[relay].fail_overdue(f"it is set aside, {reason}")

    def _unanswered_requests(self, relay: str) -> UnansweredRequests:
        """Return what ends the requests for a relay that is not visited."""
        return UnansweredRequests(relay, self._repository, RequestDeadlines(self._settings.record_timeout_s))

    def _register(self) -> None:
        """Enter the gateway in the database, holding nothing. Raises SQLAlchemyError."""
        self._repository.register_gateway(
            self._identity.id,
            host=self._identity.host,
            process_id=self._identity.process_id,
            now_ns=time.time_ns(),
        )
        self._registered = True

    def _start_sessions(self) -> None:
        """Start sessions for a moment; the others are started in the next rounds.

        With hundreds of relays, to start all of them takes longer than a lease lasts.
        """
        until_s = boot_time_s() + LONGEST_STARTING_S
        while self._to_start and boot_time_s() < until_s:
            self._start_session(self._to_start.pop())

    def _start_session(self, relay: str) -> None:
        """Start the session of a relay on a thread of its own."""
        motor = self._plant.motor_of(relay).motor
        session = RelaySession(
            self._plant.relay(relay),
            motor.name,
            self._repository,
            self._store,
            self._settings,
            gateway=self._identity.id,
            visit_marks=self._visit_marks,
            on_sample=self._batches.add_sample,
            notes=self._batches,
            reported=motor,
        )
        thread = Thread(target=session.run, name=f"relay-{relay}", daemon=True)
        thread.start()
        self._sessions[relay] = _SessionThread(session, thread)

    def _give_back_ended(self) -> None:
        """Give back the relays whose stopped sessions have ended; others may visit them from now on."""
        ended = [relay for relay, visit in self._ending.items() if not visit.thread.is_alive()]
        if not ended:
            return
        if self._registered:
            self._repository.give_back_relays(self._identity.id, ended)
        for relay in ended:
            del self._ending[relay]

    def _remove_ended(self) -> None:
        """Remove the sessions that ended by themselves; a relay whose lease is held gets a new one."""
        for relay in [relay for relay, visit in self._sessions.items() if not visit.thread.is_alive()]:
            del self._sessions[relay]

    def _abandon_all(self) -> None:
        """End every session at once, because others may visit the relays already."""
        for relay in list(self._sessions):
            visit = self._sessions.pop(relay)
            visit.session.abandon()
            self._ending[relay] = visit

    def _stop_all(self) -> list[str]:
        """Stop every session and free the relays. Returns the names of the threads that are left."""
        visits = [*self._sessions.values(), *self._ending.values()]
        for visit in visits:
            visit.session.stop()
        deadline_s = time.monotonic() + STOP_TIMEOUT_S
        for visit in visits:
            visit.thread.join(max(0.0, deadline_s - time.monotonic()))
        left = [visit.thread.name for visit in visits if visit.thread.is_alive()]
        self._batches.stop(max(0.0, deadline_s - time.monotonic()))
        self._watchdog.stop()
        if not left:
            try:
                self._repository.end_gateway(self._identity.id, now_ns=time.time_ns())
            except SQLAlchemyError as error:
                log.warning("the leases expire by themselves", error=str(error))
        return left
