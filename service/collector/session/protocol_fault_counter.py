"""Counts how often a relay breaks the protocol, and decides whether it is quarantined or trusted again."""

import time
from collections.abc import Callable

import structlog

from service.collector.session.quarantine import QuarantinePolicy, quarantine_relay
from service.collector.session.session_policy import SESSION_POLICY, SessionPolicy
from service.storage import Repository
from service.storage.records import Quarantine

log = structlog.get_logger(__name__)


class ProtocolFaultCounter:
    """Counts the protocol faults of one relay. Used by that relay's session alone."""

    def __init__(
        self,
        relay: str,
        repository: Repository,
        quarantine: QuarantinePolicy,
        *,
        policy: SessionPolicy = SESSION_POLICY,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Begin with a relay that is trusted; `recall` says whether it is.

        clock: tells a time that only goes forward [s].
        """
        self._relay = relay
        self._repository = repository
        self._quarantine = quarantine
        self._policy = policy
        self._clock = clock
        self._faults = 0
        self._visited_s = clock()
        self._probation_s: float | None = None

    def recall(self) -> None:
        """Read from the database whether the relay is on probation. Raises SQLAlchemyError."""
        latest = self._repository.quarantine(self._relay)
        self._probation_s = None if latest is None else self._quarantine.probation_after_s(latest)

    def visit_begins(self) -> None:
        """Note that a visit begins."""
        self._visited_s = self._clock()

    def round_succeeded(self) -> None:
        """Note that a round of a visit went well. Raises SQLAlchemyError."""
        well_s = self._clock() - self._visited_s
        if well_s > self._policy.good_visit_s:
            self._faults = 0
        if self._probation_s is not None and well_s > self._probation_s:
            self._repository.release(self._relay, now_ns=time.time_ns())
            self._probation_s = None
            log.info("relay trusted again", relay=self._relay)

    def count_fault(self, reason: str) -> Quarantine | None:
        """Count a visit that ended by a broken protocol.

        Returns the quarantine, if there is one now. Raises SQLAlchemyError.
        """
        self._faults += 1
        if self._faults < self._policy.faults_in_a_row:
            return None
        why = f"it broke the protocol {self._faults} times in a row, at last: {reason}"
        return quarantine_relay(self._repository, self._relay, why, self._quarantine)
