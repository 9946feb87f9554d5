"""Ends a gateway's visits before anybody else may think it dead.

Whoever has seen a gateway's counter stand still for `lease_s` takes its relays. A gateway that has not
renewed its leases for four fifths of that ends as a process, whatever its threads are doing, and the system
closes its connections. One that was frozen ends as soon as it wakes.
"""

import time
from collections.abc import Callable
from threading import Event, Thread

END = 0.8
LOOKS = 20
"""A lease: so many looks of the fence, for a margin between the fraction above and the whole."""


class LeaseWatchdog:
    """A thread that counts from the beginning of the latest renewal that succeeded.

    on_expiry: called when they stay away for too long.
    """

    def __init__(self, lease_s: float, *, on_expiry: Callable[[], None]) -> None:
        self._lease_s = lease_s
        self._on_expiry = on_expiry
        self._renewed_s = time.monotonic()
        self._closed = Event()
        self._thread = Thread(target=self._watch, name="fence", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def renewed(self, began_s: float) -> None:
        """A renewal succeeded that began at this monotonic time [s]."""
        self._renewed_s = began_s

    def stop(self) -> None:
        self._closed.set()
        self._thread.join()

    def _watch(self) -> None:
        while not self._closed.wait(self._lease_s / LOOKS):
            if time.monotonic() - self._renewed_s > END * self._lease_s:
                self._on_expiry()
                return
