"""What signals do in the database, and how many of their changes are written."""

import time
from dataclasses import replace

from structlog.testing import capture_logs

from mms.goose import SubscribedBlock
from service.alarms.kinds import AlarmKind
from service.gateways.goose.gateway import SignalWriter
from service.gateways.goose.listener import SignalChange
from service.gateways.goose.pending import CHANGES_AT_ONCE, PendingChanges
from service.gateways.goose.signals import Meaning, Signal, WatchedBlock
from service.storage import Repository
from testing.service.plants import NOW_NS

FIRST = Signal("A1PRO/PTRC1.Tr.general", Meaning.TRIP, ("PUMP-A1",), (0, 0))
SECOND = Signal("A1PRO/PTRC2.Tr.general", Meaning.TRIP, ("PUMP-A1", "FAN-A2"), (1, 0))
TRIGGER = Signal("A1CON/GGIO1.SPCSO02.stVal", Meaning.TRIGGER, ("PUMP-A1", "gone"), (2, 0))

BLOCK = WatchedBlock(
    SubscribedBlock(
        reference="A1CFG/LLN0$GO$GPub01",
        data_set="A1CFG/LLN0$DSet04",
        goose_id="A1",
        configuration_revision=1,
        entries=3,
        destination=bytes(6),
        application_id=1,
    ),
    (FIRST, SECOND, TRIGGER),
)


def change(signal: Signal, time_ns: int = NOW_NS, *, is_on: bool) -> SignalChange:
    return SignalChange(BLOCK.subscribed.reference, signal, is_on, time_ns)


def told(repository: Repository) -> list[tuple[str | None, str]]:
    return sorted(
        (one.motor, one.subject)
        for one in repository.open_alarms(limit=10).items
        if one.kind is AlarmKind.MOTOR_TRIPPED and one.cleared_ns is None
    )


def test_each_trip_of_a_motor_stands_until_it_falls(repository: Repository) -> None:
    writer = SignalWriter(repository, most_open=3)
    for signal, is_on in ((FIRST, True), (SECOND, True), (FIRST, True), (FIRST, False)):
        writer.write(change(signal, is_on=is_on), NOW_NS, "one")
    assert told(repository) == [("FAN-A2", SECOND.reference), ("PUMP-A1", SECOND.reference)]
    writer.write(change(SECOND, is_on=False), NOW_NS + 1, "two")
    assert told(repository) == []


def test_a_trigger_asks_for_so_many_records_at_a_time_and_names_who_asked(repository: Repository) -> None:
    writer = SignalWriter(repository, most_open=2)
    for number in range(4):
        for is_on in (True, False):
            writer.write(change(TRIGGER, is_on=is_on), NOW_NS + number, f"{number} {is_on}")
    requests = repository.recording_requests(limit=10).items
    assert [one.motor for one in requests] == ["PUMP-A1"] * 2


def test_a_change_that_is_written_again_asks_for_nothing_twice(repository: Repository) -> None:
    writer = SignalWriter(repository, most_open=5)
    for key in ("one", "one", "two"):
        writer.write(change(TRIGGER, is_on=True), NOW_NS, key)
    requests = repository.recording_requests(limit=10).items
    assert [one.motor for one in requests] == ["PUMP-A1"] * 2


def test_while_nothing_is_written_the_latest_rise_and_fall_wait_in_their_order() -> None:
    pending = PendingChanges([BLOCK])
    for number in range(1000):
        pending.add(change(FIRST, number, is_on=number % 2 == 0))
        pending.add(change(SECOND, number, is_on=True))
    taken = [pending.wait_for_next(0.0) for _ in range(4)]
    assert taken == [
        change(FIRST, 998, is_on=True),
        change(FIRST, 999, is_on=False),
        change(SECOND, 999, is_on=True),
        None,
    ]
    assert (pending.is_empty, pending.problem) == (True, None)


class Clock:
    """A steady clock that the test moves."""

    def __init__(self) -> None:
        self.now_s = 0.0

    def __call__(self) -> float:
        """Tell the time."""
        return self.now_s


def test_of_a_signal_that_toggles_one_change_a_second_is_written_and_the_last_state_in_the_end() -> None:
    """A thousand changes a second for a minute; then the signal stays off."""
    clock = Clock()
    pending = PendingChanges([BLOCK], clock)
    written: list[SignalChange] = []

    def write() -> None:
        while (one := pending.wait_for_next(0.0)) is not None:
            written.append(one)

    with capture_logs() as logged:
        for number in range(60_000):
            clock.now_s = number / 1000
            pending.add(change(FIRST, number, is_on=number % 2 == 0))
            write()
        at_once = CHANGES_AT_ONCE + len(BLOCK.signals)
        assert at_once + 59 <= len(written) <= at_once + 60
        assert pending.problem == (
            "1 of 1 GOOSE control blocks change too often, and not all of it is written: A1CFG/LLN0$GO$GPub01"
        )
        clock.now_s += 2.0
        write()
        assert written[-1] == change(FIRST, 59_999, is_on=False)
        # Another signal of the block waits for a second at most.
        pending.add(change(SECOND, is_on=True))
        clock.now_s += 1.0
        write()
        assert written[-1] == change(SECOND, is_on=True)
    assert [one["block"] for one in logged] == [BLOCK.subscribed.reference]
    clock.now_s += at_once
    assert pending.wait_for_next(0.0) is None
    assert pending.problem is None


def test_a_block_that_toggles_takes_nothing_from_another_one() -> None:
    clock = Clock()
    other = replace(BLOCK, subscribed=replace(BLOCK.subscribed, reference="A2CFG/LLN0$GO$GPub01"))
    pending = PendingChanges([BLOCK, other], clock)
    for number in range(1000):
        pending.add(change(FIRST, number, is_on=number % 2 == 0))
        pending.wait_for_next(0.0)
    trip = SignalChange(other.subscribed.reference, SECOND, is_on=True, time_ns=NOW_NS)
    pending.add(trip)
    assert pending.wait_for_next(0.0) == trip


def test_what_may_be_written_later_is_waited_for() -> None:
    """By the real clock: it comes when it may be written, and not at the end of the wait."""
    pending = PendingChanges([BLOCK])
    taken = 0
    for number in range(1000):
        pending.add(change(FIRST, number, is_on=number % 2 == 0))
        taken += pending.wait_for_next(0.0) is not None
    assert taken <= CHANGES_AT_ONCE + len(BLOCK.signals) + 5
    began_s = time.monotonic()
    assert pending.wait_for_next(60.0) is not None
    assert time.monotonic() - began_s < 30
