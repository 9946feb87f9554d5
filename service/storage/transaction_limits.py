"""How long a transaction may hold up others on PostgreSQL, where its process stands still."""

from dataclasses import dataclass

from service.configuration.settings import Settings

IDLES_A_LEASE = 3
LOCK_WAITS_A_LEASE = 2
"""Leases are renewed three times a lease at least: one renewal may be late by the wait for a lock."""

USUAL_LEASE_S = 30.0


@dataclass(frozen=True, slots=True)
class TransactionLimits:
    """Hold how long the server puts up with a transaction.

    idle_s: it ends one whose process asks nothing for so long, and its locks are free [s].
    lock_wait_s: a statement that has waited for a lock for so long fails, and is tried again later [s].
    """

    idle_s: float
    lock_wait_s: float

    @classmethod
    def of_lease(cls, lease_s: float) -> "TransactionLimits":
        """Return those of processes whose leases last so long [s]."""
        return cls(lease_s / IDLES_A_LEASE, lease_s / LOCK_WAITS_A_LEASE)


USUAL = TransactionLimits.of_lease(USUAL_LEASE_S)
"""For commands that hold no lease."""


def limits_of(settings: Settings) -> TransactionLimits:
    """Return what the settings say; those that are not set follow from the lease."""
    usual = TransactionLimits.of_lease(settings.lease_s)
    return TransactionLimits(
        usual.idle_s if settings.transaction_idle_s is None else settings.transaction_idle_s,
        usual.lock_wait_s if settings.lock_wait_s is None else settings.lock_wait_s,
    )
