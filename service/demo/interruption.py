"""Ctrl-C and SIGTERM, which end the demo where it pauses and nowhere else.

By default Python raises KeyboardInterrupt wherever the program happens to be. That could be between the start
of a child process and the assignment that remembers it, so that nobody would end the child; or inside a
callback, where the exception would be lost.
"""

import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

SIGNALS = (signal.SIGINT, signal.SIGTERM)


class Interruption:
    """Remembers a signal until the next pause."""

    def __init__(self) -> None:
        self._signalled = False

    def handle(self, _number: int, _frame: FrameType | None) -> None:
        """Handle one of SIGNALS."""
        self._signalled = True

    def pause(self, seconds: float) -> None:
        """Wait some seconds. Raises KeyboardInterrupt once a signal has come."""
        if not self._signalled:
            time.sleep(seconds)
        if self._signalled:
            raise KeyboardInterrupt


@contextmanager
def interruptible() -> Iterator[Interruption]:
    """While the block runs, signals are raised by `pause` alone."""
    interruption = Interruption()
    before = {number: signal.signal(number, interruption.handle) for number in SIGNALS}
    try:
        yield interruption
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
