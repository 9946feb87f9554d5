"""Counts how often a relay breaks the protocol, and decides whether it is quarantined or trusted again."""

import time
from collections.abc import Callable

import structlog

from service.collector.session.quarantine import QuarantinePolicy, quarantine_relay
from service.storage import Repository

log = structlog.get_logger(__name__)

FAULTS_IN_A_ROW = 5
"""So many visits that end by a broken protocol, with no good visit between them, bring a quarantine."""

GOOD_VISIT_S = 10.0
"""A visit is good when it goes well for so long; one good answer is not enough."""


class ProtocolFaultCounter:
    """Counts the protocol faults of one relay. Used by that relay's session alone."""

    def __init__(
        self,
        relay: str,
        repository: Repository,
        policy: QuarantinePolicy,
        *,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """clock: tells a time that only goes forward [s]. Raises SQLAlchemyError."""
        self._relay = relay
        self._repository = repository
        self._policy = policy
        self._clock = clock
        self._faults = 0
        self._visited_s = clock()
        quarantine = repository.quarantine(relay)
        self._probation_s = None if quarantine is None else policy.probation_after_s(quarantine)

    def visit_begins(self) -> None:
        """Note that a visit begins."""
        self._visited_s = self._clock()

    def round_succeeded(self) -> None:
        """Note that a round of a visit went well. Raises SQLAlchemyError."""
        well_s = self._clock() - self._visited_s
        if well_s > GOOD_VISIT_S:
            self._faults = 0
        if self._probation_s is not None and well_s > self._probation_s:
            self._repository.release(self._relay, now_ns=time.time_ns())
            self._probation_s = None
            log.info("relay trusted again", relay=self._relay)

    def count_fault(self, reason: str) -> bool:
        """Count a visit that ended by a broken protocol.

        Returns whether the relay is quarantined now. Raises SQLAlchemyError.
        """
        self._faults += 1
        if self._faults < FAULTS_IN_A_ROW:
            return False
        why = f"it broke the protocol {self._faults} times in a row, at last: {reason}"
        quarantine_relay(self._repository, self._relay, why, self._policy)
        return True
