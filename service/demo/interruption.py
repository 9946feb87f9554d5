"""Ctrl-C and SIGTERM, heeded where the demo waits and nowhere else.

Raised wherever the interpreter happens to be, an interrupt could strike between the start of a program and
the note of it, and leave a process that nobody ends; or inside a callback, and be lost.
"""

import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

SIGNALS = (signal.SIGINT, signal.SIGTERM)


class Interruption:
    """Whether somebody wants the demo to end."""

    def __init__(self) -> None:
        self._wanted = False

    def note(self, _number: int, _frame: FrameType | None) -> None:
        """The handler of the signals."""
        self._wanted = True

    def pause(self, seconds: float) -> None:
        """Wait a moment [s]. Raises KeyboardInterrupt when somebody wants the demo to end."""
        if not self._wanted:
            time.sleep(seconds)
        if self._wanted:
            raise KeyboardInterrupt


@contextmanager
def interruptible() -> Iterator[Interruption]:
    """Signals only take note while the block runs; whoever pauses in it hears of them."""
    interruption = Interruption()
    before = {number: signal.signal(number, interruption.note) for number in SIGNALS}
    try:
        yield interruption
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
