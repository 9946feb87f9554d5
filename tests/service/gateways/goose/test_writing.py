"""What signals do in the database."""

from service.alarms.kinds import AlarmKind
from service.gateways.goose.gateway import SignalWriter
from service.gateways.goose.listener import SignalChange
from service.gateways.goose.receiver import PendingChanges
from service.gateways.goose.signals import Meaning, Signal
from service.storage import Repository
from testing.service.plants import NOW_NS

FIRST = Signal("A1PRO/PTRC1.Tr.general", Meaning.TRIP, ("PUMP-A1",), (0, 0))
SECOND = Signal("A1PRO/PTRC2.Tr.general", Meaning.TRIP, ("PUMP-A1", "FAN-A2"), (1, 0))
TRIGGER = Signal("A1CON/GGIO1.SPCSO02.stVal", Meaning.TRIGGER, ("PUMP-A1", "gone"), (2, 0))


def told(repository: Repository) -> list[tuple[str | None, str]]:
    return sorted(
        (one.motor, one.subject)
        for one in repository.open_alarms(limit=10).items
        if one.kind is AlarmKind.MOTOR_TRIPPED and one.cleared_ns is None
    )


def test_each_trip_of_a_motor_stands_until_it_falls(repository: Repository) -> None:
    writer = SignalWriter(repository, most_open=3)
    for signal, is_on in ((FIRST, True), (SECOND, True), (FIRST, True), (FIRST, False)):
        writer.write(SignalChange(signal, is_on, NOW_NS), NOW_NS, "one")
    assert told(repository) == [("FAN-A2", SECOND.reference), ("PUMP-A1", SECOND.reference)]
    writer.write(SignalChange(SECOND, is_on=False, time_ns=NOW_NS), NOW_NS + 1, "two")
    assert told(repository) == []


def test_a_trigger_asks_for_so_many_records_at_a_time_and_names_who_asked(repository: Repository) -> None:
    writer = SignalWriter(repository, most_open=2)
    for number in range(4):
        for is_on in (True, False):
            writer.write(SignalChange(TRIGGER, is_on, NOW_NS), NOW_NS + number, f"{number} {is_on}")
    requests = repository.recording_requests(limit=10).items
    assert [one.motor for one in requests] == ["PUMP-A1"] * 2


def test_a_change_that_is_written_again_asks_for_nothing_twice(repository: Repository) -> None:
    writer = SignalWriter(repository, most_open=5)
    change = SignalChange(TRIGGER, is_on=True, time_ns=NOW_NS)
    for key in ("one", "one", "two"):
        writer.write(change, NOW_NS, key)
    requests = repository.recording_requests(limit=10).items
    assert [one.motor for one in requests] == ["PUMP-A1"] * 2


def test_while_nothing_is_written_the_latest_rise_and_fall_wait_in_their_order() -> None:
    pending = PendingChanges()
    for number in range(1000):
        pending.add(SignalChange(FIRST, number % 2 == 0, number))
        pending.add(SignalChange(SECOND, is_on=True, time_ns=number))
    taken = [pending.wait_for_next(0.0) for _ in range(4)]
    assert taken == [
        SignalChange(FIRST, is_on=True, time_ns=998),
        SignalChange(FIRST, is_on=False, time_ns=999),
        SignalChange(SECOND, is_on=True, time_ns=999),
        None,
    ]
