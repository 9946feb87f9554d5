"""Waiting for a condition instead of sleeping."""

import os
import time
from collections.abc import Callable

FIRST_PAUSE_S, LONGEST_PAUSE_S = 0.002, 0.05
"""Between two looks: short for what is there at once, longer for what would be slowed down by being asked."""

PATIENT_S = 10.0
"""Shorter waits are part of what is tested; longer ones only end a test that hangs."""

PATIENCE_IN_CI = 3.0
"""Machines of CI may be so many times slower."""


def eventually(condition: Callable[[], object], within_s: float = 30.0) -> bool:
    """Whether the condition comes true in time. In CI waits of `PATIENT_S` and more last longer."""
    deadline_s = time.monotonic() + _lasting_s(within_s)
    pause_s = FIRST_PAUSE_S
    while not condition():
        if time.monotonic() >= deadline_s:
            return bool(condition())
        time.sleep(pause_s)
        pause_s = min(1.5 * pause_s, LONGEST_PAUSE_S)
    return True


def wait_until(condition: Callable[[], object], what: str = "the condition", within_s: float = 60.0) -> None:
    """Wait for the condition; raise an AssertionError that names it when it does not come true in time."""
    assert eventually(condition, within_s), f"waited {_lasting_s(within_s):g} s for {what}"


def _lasting_s(within_s: float) -> float:
    is_patience = os.environ.get("CI") == "true" and within_s >= PATIENT_S
    return PATIENCE_IN_CI * within_s if is_patience else within_s
