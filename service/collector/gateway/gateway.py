"""A gateway: visits the relays it holds leases of, one session a relay, and shares with other gateways."""

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
from service.collector.triggers.deadlines import RequestDeadlines
from service.collector.triggers.unanswered import UnansweredRequests
from service.configuration.settings import Settings
from service.plant import Plant
from service.recording_store.store import RecordingStore
from service.storage import LeaseLostError, Repository
from service.timing.peer_liveness import PeerLiveness

log = structlog.get_logger(__name__)

REQUEST_PERIOD_S = 0.2
"""Between looks into the database for event reports somebody asked for."""

BEATS_OF_A_LEASE = 10
"""How often leases are renewed in the time they last."""

STOP_PATIENCE_S = 2.0
"""A session may be inside a request that lasts up to its time limit; nothing is lost by leaving it there."""


@dataclass(frozen=True, slots=True)
class Identity:
    """Who a gateway is. `id` is never that of two processes that live at the same time."""

    id: str
    host: str
    process_id: int


@dataclass(frozen=True, slots=True)
class _Visit:
    session: RelaySession
    thread: Thread


class Gateway:
    """Visits the relays whose leases this gateway holds. `run` is the main loop of its process."""

    def __init__(
        self,
        identity: Identity,
        plant: Plant,
        repository: Repository,
        store: RecordingStore,
        settings: Settings,
        *,
        on_expiry: Callable[[], None],
        visit_marks: VisitMarks | None = None,
    ) -> None:
        """on_expiry: called when the leases could not be renewed for too long; it has to end the process.

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
        self._visits: dict[str, _Visit] = {}
        self._leaving: dict[str, _Visit] = {}
        self._aside: dict[str, UnansweredRequests] = {}
        self._batches = BatchWriter(repository)
        self._registered = False
        self._watchdog = LeaseWatchdog(settings.lease_s, on_expiry=on_expiry)

    def run(self, stop: Event) -> list[str]:
        """Visit relays until `stop` is set. Returns the threads that did not end in time."""
        self._watchdog.start()
        self._batches.start()
        next_beat_s = 0.0
        while not stop.wait(REQUEST_PERIOD_S):
            try:
                if time.monotonic() >= next_beat_s:
                    self._beat()
                    next_beat_s = time.monotonic() + self._settings.lease_s / BEATS_OF_A_LEASE
                self._let_go()
                for ied in self._repository.ieds_with_requests():
                    if ied in self._visits:
                        self._visits[ied].session.wake()
            except SQLAlchemyError as error:
                log.warning("database does not answer, trying again", error=str(error))
        return self._end()

    def _beat(self) -> None:
        """Renew the leases; take and give back what the others' number makes fair."""
        began_s = time.monotonic()
        if not self._registered:
            if self._leaving:  # what it visited for its former self must have ended before
                self._watchdog.renewed(began_s)
                return
            self._register()
        try:
            share = self._repository.share_relays(
                self._identity.id, self._names, most=self._settings.relays_per_gateway
            )
        except LeaseLostError as error:
            log.warning("starting again", reason=str(error))
            self._registered = False
            self._abandon_all()
            return
        self._watchdog.renewed(began_s)
        self._forget_ended()
        self._leave_alone(share.held)
        busy = self._visits.keys() | self._leaving.keys() | self._aside.keys()
        for ied in share.held - share.surplus - busy:
            self._visit(ied)
        for ied in share.surplus & self._visits.keys():
            self._visits[ied].session.stop()
            self._leaving[ied] = self._visits.pop(ied)
        unvisited = share.surplus - self._leaving.keys()
        if unvisited:
            self._repository.give_back_relays(self._identity.id, unvisited)
        others = {gateway: beats for gateway, beats in share.beats.items() if gateway != self._identity.id}
        for gateway, beats in self._peers.dead(others, time.monotonic()).items():
            if self._repository.end_gateway(gateway, beats=beats, now_ns=time.time_ns()):
                log.warning("a gateway is dead, its relays are shared out", gateway=gateway)

    def _leave_alone(self, held: frozenset[str]) -> None:
        """Relays set aside are not visited; what somebody asks of them fails in time, with the reason."""
        now_ns = time.time_ns()
        aside = {
            each.ied: each.reason
            for each in self._repository.quarantines()
            if each.ied in held and each.holds(now_ns)
        }
        self._aside = {ied: self._aside.get(ied) or self._unanswered(ied) for ied in aside}
        for ied, reason in aside.items():
            self._aside[ied].fail_overdue(f"it is set aside, {reason}")

    def _unanswered(self, ied: str) -> UnansweredRequests:
        return UnansweredRequests(ied, self._repository, RequestDeadlines(self._settings.record_timeout_s))

    def _register(self) -> None:
        self._repository.register_gateway(
            self._identity.id,
            host=self._identity.host,
            process_id=self._identity.process_id,
            now_ns=time.time_ns(),
        )
        self._registered = True

    def _visit(self, ied: str) -> None:
        session = RelaySession(
            self._plant.relay(ied),
            self._plant.motor_of(ied).name,
            self._repository,
            self._store,
            self._settings,
            gateway=self._identity.id,
            visit_marks=self._visit_marks,
            on_sample=self._batches.add_sample,
            on_note=self._batches.add_note,
        )
        thread = Thread(target=session.run, name=f"relay-{ied}", daemon=True)
        thread.start()
        self._visits[ied] = _Visit(session, thread)

    def _let_go(self) -> None:
        """Give back what is not visited any more; others may visit it from then on."""
        ended = [ied for ied, visit in self._leaving.items() if not visit.thread.is_alive()]
        if not ended:
            return
        if self._registered:
            self._repository.give_back_relays(self._identity.id, ended)
        for ied in ended:
            del self._leaving[ied]

    def _forget_ended(self) -> None:
        """Sessions that ended by themselves; the relay is visited anew if its lease stands."""
        for ied in [ied for ied, visit in self._visits.items() if not visit.thread.is_alive()]:
            del self._visits[ied]

    def _abandon_all(self) -> None:
        for ied in list(self._visits):
            visit = self._visits.pop(ied)
            visit.session.abandon()
            self._leaving[ied] = visit

    def _end(self) -> list[str]:
        """Stop every session, free the relays; which threads are left."""
        visits = [*self._visits.values(), *self._leaving.values()]
        for visit in visits:
            visit.session.stop()
        deadline_s = time.monotonic() + STOP_PATIENCE_S
        for visit in visits:
            visit.thread.join(max(0.0, deadline_s - time.monotonic()))
        left = [visit.thread.name for visit in visits if visit.thread.is_alive()]
        self._batches.stop(max(0.0, deadline_s - time.monotonic()))
        self._watchdog.stop()
        if not left:
            try:
                self._repository.end_gateway(self._identity.id, now_ns=time.time_ns())
            except SQLAlchemyError as error:
                log.warning("the leases run out by themselves", error=str(error))
        return left
