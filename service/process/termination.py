"""SIGTERM and Ctrl-C, which ask the service to end: also while it starts, and in each of its processes."""

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

ENDING = (signal.SIGTERM, signal.SIGINT)

LONGEST_STEP_S = 5.0
"""A step of the start that takes longer is interrupted where it is."""


class Termination:
    """Remembers that the service is asked to end. Its start looks between two steps, and ends in order.

    An exception out of a signal's handler would come in the midst of whatever runs: a library would log it as
    an error, or swallow it, and the service would go on.
    """

    def __init__(self) -> None:
        self._is_asked = False
        self._is_armed = False

    @property
    def is_asked(self) -> bool:
        """Whether a signal has come."""
        return self._is_asked

    def note(self) -> None:
        """Remember a signal that somebody else handles."""
        self._is_asked = True

    def step(self) -> None:
        """Begin another step of the start. Raises SystemExit where a signal has come."""
        if self._is_asked:
            self._disarm()
            raise SystemExit(0)

    @contextmanager
    def heeded(self) -> Iterator[None]:
        """Handle the signals while the block runs."""
        before = {number: signal.signal(number, self._handle) for number in ENDING}
        try:
            yield
        finally:
            self._disarm()
            for number, handler in before.items():
                signal.signal(number, handler)

    def _handle(self, _number: int, _frame: FrameType | None) -> None:
        if not self._is_asked:
            self._is_asked = self._is_armed = True
            signal.signal(signal.SIGALRM, _interrupt)
            signal.setitimer(signal.ITIMER_REAL, LONGEST_STEP_S)

    def _disarm(self) -> None:
        if self._is_armed:
            signal.setitimer(signal.ITIMER_REAL, 0)


def _interrupt(_number: int, _frame: FrameType | None) -> None:
    raise SystemExit(0)


@contextmanager
def held_back(*numbers: signal.Signals) -> Iterator[None]:
    """Hold these signals back in this thread. A process that is started meanwhile begins with them held back.

    Ctrl-C reaches every process of a terminal, and systemd sends SIGTERM to every process of a service: a
    process that still loads would end with a traceback, or be taken for one that has crashed.
    """
    before = signal.pthread_sigmask(signal.SIG_BLOCK, numbers)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def leave_to_parent(*numbers: signal.Signals) -> None:
    """Ignore these signals, which may have been held back: the process that started this one ends it."""
    for number in numbers:
        signal.signal(number, signal.SIG_IGN)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, numbers)
