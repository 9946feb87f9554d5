"""End a gateway before anybody else may think it dead.

Whoever has seen a gateway's counter stand still for `lease_s` takes over its relays. A gateway that has not
renewed its leases for four fifths of that ends as a process, whatever its threads are doing, and the system
closes its connections. A gateway that was frozen, or whose machine was suspended, ends as soon as it runs
again.
"""

from collections.abc import Callable

from service.timing.boot_clock import boot_time_s
from service.timing.periodic_worker import PeriodicWorker

USABLE_FRACTION = 0.8
"""Of the lease; the rest is the margin in which the process ends."""

CHECKS_PER_LEASE = 20
LONGEST_CHECK_PERIOD_S = 0.1
"""A thread's wait stands still while the machine is suspended: the rest of it comes after the resume."""


class LeaseWatchdog:
    """Watch, on a thread of its own, how long ago the leases were renewed.

    Times are those of the boot clock, which goes on while the machine is suspended.
    """

    def __init__(
        self, lease_s: float, *, on_expiry: Callable[[], None], clock: Callable[[], float] = boot_time_s
    ) -> None:
        """Prepare the thread; the leases count as renewed now.

        on_expiry: called when the latest renewal is too long ago; it has to end the process.
        """
        self._usable_s = USABLE_FRACTION * lease_s
        self._on_expiry = on_expiry
        self._clock = clock
        self._renewed_s = clock()
        period_s = min(lease_s / CHECKS_PER_LEASE, LONGEST_CHECK_PERIOD_S)
        self._worker = PeriodicWorker("the lease watchdog", self._check, period_s=period_s)

    def start(self) -> None:
        """Start the thread."""
        self._worker.start()

    def stop(self) -> None:
        """End the thread, and wait for that."""
        self._worker.stop()

    def problem(self) -> str | None:
        """Return why the leases are not watched at present; None while they are."""
        return self._worker.problem()

    def renewed(self, began_s: float) -> None:
        """Note that a renewal succeeded which began at this time of the clock [s].

        The beginning counts: others may have seen the counter from then on.
        """
        self._renewed_s = began_s

    def _check(self) -> None:
        """Call `on_expiry` if the latest renewal is too long ago."""
        if self._clock() - self._renewed_s > self._usable_s:
            self._on_expiry()
