"""A gateway whose leases are too old ends, also where its machine was suspended meanwhile."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Event

import pytest

from service.collector.gateway.lease_watchdog import LeaseWatchdog
from service.timing.boot_clock import boot_time_s

LEASE_S = 600.0


class Clock:
    """A clock that goes on when the test says so."""

    def __init__(self) -> None:
        self.now_s = 1000.0

    def __call__(self) -> float:
        return self.now_s


@contextmanager
def watching(clock: Callable[[], float] = boot_time_s) -> Iterator[tuple[LeaseWatchdog, Event]]:
    expired = Event()
    watchdog = LeaseWatchdog(LEASE_S, on_expiry=expired.set, clock=clock)
    watchdog.start()
    try:
        yield watchdog, expired
    finally:
        watchdog.stop()


def test_a_gateway_ends_before_its_lease_does_unless_the_lease_is_renewed() -> None:
    clock = Clock()
    with watching(clock) as (watchdog, expired):
        clock.now_s += 0.79 * LEASE_S
        assert not expired.wait(0.3)
        watchdog.renewed(clock.now_s)
        clock.now_s += 0.79 * LEASE_S
        assert not expired.wait(0.3)
        clock.now_s += 0.02 * LEASE_S
        assert expired.wait(10)


def test_a_gateway_whose_machine_was_suspended_ends_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """A suspend, as a process sees it: only CLOCK_BOOTTIME has gone on, by an hour."""
    suspended_s = 0.0
    clock_gettime = time.clock_gettime

    def gettime(clock_id: int) -> float:
        return clock_gettime(clock_id) + (suspended_s if clock_id == time.CLOCK_BOOTTIME else 0.0)

    monkeypatch.setattr(time, "clock_gettime", gettime)
    with watching() as (_, expired):
        assert not expired.wait(0.3)
        resumed_s = time.monotonic()
        suspended_s = 3600.0
        assert expired.wait(10)
        assert time.monotonic() - resumed_s < LEASE_S / 100, (
            "long before it would look again in a whole lease"
        )
