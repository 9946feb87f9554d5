"""Notice that an association has ended."""

import threading
from collections.abc import Callable

from mms.binding.callbacks import guarded, inside_callback


class ClosedNotice:
    """Notice that an association has ended: an event for threads that wait, then the callback, once.

    Parameters
    ----------
    callback : callable or None
        Called once the notice is armed and the association has ended.
    """

    def __init__(self, callback: Callable[[], None] | None) -> None:
        self.event = threading.Event()
        self._callback = callback
        self._lock = threading.Lock()
        self._armed = False

    def arm(self) -> bool:
        """Call the callback from now on.

        Returns
        -------
        bool
            False if the association has ended already.
        """
        with self._lock:
            self._armed = not self.event.is_set()
            return self._armed

    def notify(self) -> None:
        """Set the event, and call the callback the first time."""
        with self._lock:
            first = self._armed
            self._armed = False
            self.event.set()
        if first and self._callback is not None:
            told = guarded(self._callback, None)
            if inside_callback():  # this thread drives other relays too, and does not wait for anybody
                threading.Thread(target=told, name="mms-closed", daemon=True).start()
            else:
                told()
