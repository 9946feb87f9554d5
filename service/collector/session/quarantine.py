"""Quarantine: for how long a relay that harms the gateway is left alone, and when it is trusted again.

A relay is quarantined when its answers crash the gateway process, or break the protocol again and again. The
first pause is the setting `quarantine_s`; each further one is twice as long, up to a day. A relay that works
for as long as it was quarantined, or is released by a command, starts again with the first pause.
"""

import time
from dataclasses import dataclass
from typing import Self

import structlog

from core.units import SECONDS_PER_DAY
from service.storage import Repository
from service.storage.records import Quarantine
from service.timing.backoff import Backoff

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True)
class QuarantinePolicy:
    """How long relays are left alone.

    backoff: the pause after so many quarantines in a row.
    probation_s: the least time for which a relay must work until it is trusted again [s].
    """

    backoff: Backoff
    probation_s: float = 10.0

    @classmethod
    def starting_with(cls, first_pause_s: float) -> Self:
        """Return the policy whose first pause is this one, and whose longest is a day [s]."""
        return cls(Backoff(first_pause_s, SECONDS_PER_DAY))

    def probation_after_s(self, quarantine: Quarantine) -> float:
        """Return how long a relay must work after this quarantine until it is trusted again [s]."""
        return max(self.probation_s, quarantine.pause_s)


def quarantine_relay(repository: Repository, relay: str, reason: str, policy: QuarantinePolicy) -> Quarantine:
    """Leave a relay alone for a while. Raises SQLAlchemyError."""
    quarantine = repository.set_aside(relay, reason, backoff=policy.backoff, now_ns=time.time_ns())
    log.error(
        "relay set aside", relay=relay, reason=reason, times=quarantine.times, pause_s=quarantine.pause_s
    )
    return quarantine
