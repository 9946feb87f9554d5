"""Waiting for a condition instead of sleeping."""

import time
from collections.abc import Callable

FIRST_PAUSE_S, LONGEST_PAUSE_S = 0.002, 0.05
"""Between two looks: short for what is there at once, longer for what would be slowed down by being asked."""


def eventually(condition: Callable[[], object], within_s: float = 30.0) -> bool:
    """Whether the condition comes true in time."""
    deadline_s = time.monotonic() + within_s
    pause_s = FIRST_PAUSE_S
    while not condition():
        if time.monotonic() >= deadline_s:
            return bool(condition())
        time.sleep(pause_s)
        pause_s = min(1.5 * pause_s, LONGEST_PAUSE_S)
    return True


def wait_until(condition: Callable[[], object], what: str = "the condition", within_s: float = 60.0) -> None:
    """Wait for the condition; raise an AssertionError that names it when it does not come true in time."""
    assert eventually(condition, within_s), f"waited {within_s:g} s for {what}"
