"""Changes of signals that wait to be written, and how many of a control block are written."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from threading import Condition
from typing import Final

import structlog

from service.gateways.goose.listener import SignalChange, named
from service.gateways.goose.signals import Signal, WatchedBlock

log = structlog.get_logger(__name__)

CHANGES_A_SECOND: Final = 1.0
"""So many changes of a control block are written, on and on: each is an event in the alarms' history."""
CHANGES_AT_ONCE: Final = 20
"""So many are written at once after a quiet time, beside the first values of the block's signals."""


@dataclass(slots=True)
class _Allowance:
    """What may be written of a block. left: so many changes, at `counted_s`."""

    most: float
    left: float
    counted_s: float
    is_restless: bool = False
    """A change had to wait, and the block has not been quiet since."""

    def count(self, now_s: float) -> None:
        """Add what may be written since it was counted last."""
        self.left = min(self.most, self.left + (now_s - self.counted_s) * CHANGES_A_SECOND)
        self.counted_s = now_s
        if self.left >= self.most:
            self.is_restless = False

    @property
    def opens_s(self) -> float:
        """When the next change may be written."""
        return self.counted_s + max(0.0, 1.0 - self.left) / CHANGES_A_SECOND


class PendingChanges:
    """Changes of signals that wait for the database, or for their block's allowance.

    The latest rise and the latest fall of each signal are kept, in their order. So nothing grows while the
    database is silent, no trip is lost, and the last state is that of the relay. A signal that rises several
    times meanwhile asks for one record. Whoever toggles signals gets no more than the allowance written.
    """

    def __init__(self, blocks: Sequence[WatchedBlock], clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._changed = Condition()
        self._changes: dict[tuple[Signal, bool], SignalChange] = {}
        now_s = clock()
        most_of = {one.subscribed.reference: CHANGES_AT_ONCE + len(one.signals) for one in blocks}
        self._allowances = {block: _Allowance(most, most, now_s) for block, most in most_of.items()}

    def add(self, change: SignalChange) -> None:
        """Put a change behind the others."""
        key = change.signal, change.is_on
        with self._changed:
            self._changes.pop(key, None)
            self._changes[key] = change
            self._changed.notify()

    def wait_for_next(self, longest_s: float) -> SignalChange | None:
        """Take the next change that may be written; None where there was none for so long."""
        ends_s = self._clock() + longest_s
        with self._changed:
            while True:
                now_s = self._clock()
                change = self._take(now_s)
                if change is not None or now_s >= ends_s:
                    return change
                opens_s = min(
                    (self._allowances[one.block].opens_s for one in self._changes.values()), default=ends_s
                )
                self._changed.wait(max(0.0, min(ends_s, opens_s) - now_s))

    @property
    def is_empty(self) -> bool:
        """Whether nothing waits."""
        with self._changed:
            return not self._changes

    @property
    def problem(self) -> str | None:
        """Return which control blocks change too often; None where none does."""
        with self._changed:
            now_s = self._clock()
            for allowance in self._allowances.values():
                allowance.count(now_s)
            restless = [block for block, allowance in self._allowances.items() if allowance.is_restless]
        if not restless:
            return None
        return (
            f"{len(restless)} of {len(self._allowances)} GOOSE control blocks change too often, and not all "
            f"of it is written: {named(restless)}"
        )

    def _take(self, now_s: float) -> SignalChange | None:
        for key, change in self._changes.items():
            allowance = self._allowances[change.block]
            allowance.count(now_s)
            if allowance.left >= 1:
                allowance.left -= 1
                return self._changes.pop(key)
            if not allowance.is_restless:
                allowance.is_restless = True
                log.warning("a GOOSE control block changes too often: not all is written", block=change.block)
        return None
