"""The work of notifications: alarms become messages, digests are made, messages are sent.

One thread makes the messages, and one for each channel sends them, so that a receiver that does not answer
holds up nobody else's. All they share is the database: several services may do the same work.
"""

import time
from collections.abc import Collection, Mapping
from functools import partial
from threading import Event

import structlog

from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from service.configuration.settings import Settings
from service.notifications.delivery import Delivery
from service.notifications.digests import due_digests
from service.notifications.reports import due_reports
from service.notifications.routes import targets
from service.notifications.silent_claims import SilentClaims
from service.storage import Repository
from service.storage.records import Gathering
from service.timing.periodic_worker import PeriodicWorker

log = structlog.get_logger(__name__)

PERIOD_S = 1.0
STOPPING_S = 10.0
"""A message that is being sent has so long to end when the service stops; then it is sent once more later."""

WRITING_S = 60.0
"""Time beyond the channel's own in which a message is written, and what came of it is noted."""

FORGETTING_PERIOD_S = 600.0
UNKNOWN_CHANNEL_NS = NANOSECONDS_PER_DAY
"""Another service on this database may know the channel, until it has had time to say so."""


class NotificationWork:
    """A part of the service: makes messages and sends them, from `start` to `stop`."""

    def __init__(
        self, settings: Settings, repository: Repository, *, installation: str, period_s: float = PERIOD_S
    ) -> None:
        """installation: of this service, which alone uses its data directory."""
        wanted = settings.notifications
        self._settings = settings
        self._repository = repository
        self._installation = installation
        self._stopping = Event()
        longest_s = max((channel.timeout_s for channel in wanted.channels.values()), default=0.0)
        self._silent = SilentClaims(longest_s + WRITING_S)
        self._forget_at_s: float | None = None
        self._maker = PeriodicWorker(
            "making of messages", self._make, period_s=period_s, at_once=True, stopping=self._stopping
        )
        self._senders: Mapping[str, PeriodicWorker] = {
            name: PeriodicWorker(
                f"sending through {name}",
                Delivery(
                    name,
                    channel,
                    wanted,
                    repository,
                    installation=installation,
                    stopping=self._stopping,
                    stale_after_days=settings.stale_after_days,
                ).deliver,
                period_s=period_s,
                stopping=self._stopping,
                # A queue of messages to a receiver that does not answer takes long, and is no fault of ours.
                overdue_s=float("inf"),
            )
            for name, channel in wanted.channels.items()
        }

    def start(self) -> None:
        """Take up what an earlier life of this service left, and begin. Raises SQLAlchemyError."""
        claims = self._repository.claims().values()
        self._release([claim for claim in claims if claim.startswith(f"{self._installation} ")])
        for worker in (self._maker, *self._senders.values()):
            worker.start()

    def stop(self) -> None:
        """End the work; a message under way may come to its end."""
        self._stopping.set()
        deadline_s = time.monotonic() + STOPPING_S
        for worker in (self._maker, *self._senders.values()):
            worker.stop(max(deadline_s - time.monotonic(), 0.0))

    def problem(self) -> str | None:
        """Return why messages are not made or sent at present; a receiver that does not answer is none."""
        for worker in (self._maker, *self._senders.values()):
            problem = worker.problem()
            if problem is not None:
                return problem
        return None

    def wake(self) -> None:
        """Send what is due now instead of at the end of a pause."""
        for worker in self._senders.values():
            worker.wake()

    def _make(self) -> None:
        """Make the messages that are due. Raises SQLAlchemyError."""
        wanted, repository = self._settings.notifications, self._repository
        now_ns = time.time_ns()
        gathering = Gathering(_ns(wanted.gather_s), _ns(wanted.pause_s))
        decide = partial(targets, wanted, now_ns=now_ns)
        while not self._stopping.is_set() and repository.route_alarm_changes(
            decide, gathering, now_ns=now_ns
        ):
            pass
        for due in (due_digests, due_reports):
            for message in due(self._settings, repository, now_ns):
                repository.add_notifications([message], now_ns=now_ns)
        self._release(self._silent.among(repository.claims(), time.monotonic_ns()))
        self._forget(now_ns)

    def _release(self, claims: Collection[str]) -> None:
        released = self._repository.release_claims(
            claims,
            now_ns=time.time_ns(),
            most_attempts=self._settings.notifications.attempts,
        )
        if released:
            log.warning("messages of a service that ended are sent again", number=released)

    def _forget(self, now_ns: int) -> None:
        """Now and then delete old messages, and give up those that no channel takes."""
        now_s = time.monotonic()
        if self._forget_at_s is not None and now_s < self._forget_at_s:
            return
        self._forget_at_s = now_s + FORGETTING_PERIOD_S
        wanted = self._settings.notifications
        unknown = self._repository.give_up_unknown(
            [*wanted.channels], before_ns=now_ns - UNKNOWN_CHANNEL_NS, now_ns=now_ns
        )
        if unknown:
            log.warning("messages given up: the settings have no channel for them", number=unknown)
        keep_ns = round(wanted.keep_days * NANOSECONDS_PER_DAY)
        while not self._stopping.is_set() and self._repository.forget_notifications(
            before_ns=now_ns - keep_ns
        ):
            pass


def _ns(seconds: float) -> int:
    return round(seconds * NANOSECONDS_PER_SECOND)
