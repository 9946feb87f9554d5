"""The life of a record: when it is ready, and when one that failed is asked for again."""

from itertools import pairwise

import pytest

from mms import errors
from service.collector.records.ledger import RecordLedger
from service.collector.records.life import Life, RecordState, SettlingTimes, in_turn
from service.collector.records.listing import ListedRecord
from service.collector.records.policy import DEFAULT_RULES, Failure
from tests.service.collector.conftest import MOTOR, Bench
from tests.service.collector.records.policies import WRONG_IN_A_ROW
from tests.service.collector.records.test_listing import Entry, listed, understood
from tests.service.collector.scripted_relay import NAME


def whole(size: int = 100) -> ListedRecord:
    return understood([Entry("X.CFG", size), Entry("X.DAT", size)]).records[0]


class Looks:
    """Successive looks at a relay that lists one record at most."""

    def __init__(self, bench: Bench) -> None:
        self._ledger = RecordLedger(NAME, MOTOR, bench.repository)

    def at(self, now_s: float, *records: ListedRecord, still_s: float = 0.25) -> Life | None:
        """What the life of the record is then; None without one."""
        states = self._ledger.follow(records)
        for state in states:
            state.settle(now_s, SettlingTimes(still_s, incomplete_s=30, unsteady_s=60))
        return states[0].life if states else None


@pytest.fixture
def looks(bench: Bench) -> Looks:
    return Looks(bench)


def test_a_record_is_ready_once_it_stands_still(looks: Looks) -> None:
    assert looks.at(0.0, whole(10)) is Life.SETTLING
    assert looks.at(0.3, whole(20)) is Life.SETTLING, "it grew: wait again"
    assert looks.at(0.4, whole(20)) is Life.SETTLING
    assert looks.at(0.6, whole(20)) is Life.READY


def test_how_long_it_must_stand_still_may_change_between_two_looks(looks: Looks) -> None:
    assert looks.at(0.0, whole(), still_s=2.0) is Life.SETTLING
    assert looks.at(1.9, whole(), still_s=2.0) is Life.SETTLING
    assert looks.at(1.9, whole(), still_s=0.25) is Life.READY
    assert looks.at(2.0, whole(), still_s=2.0) is Life.READY


def test_a_record_without_its_data_is_given_up_in_the_end(looks: Looks) -> None:
    (half,) = understood(listed("X.CFG")).records
    assert looks.at(0.0, half) is Life.SETTLING
    assert looks.at(29.0, half) is Life.SETTLING
    assert looks.at(30.0, half) is Life.INCOMPLETE


def test_a_record_that_goes_on_changing_is_waited_for_no_longer(looks: Looks) -> None:
    for tenth in range(599):
        assert looks.at(tenth / 10, whole(100 + tenth)) is Life.SETTLING
    assert looks.at(60.0, whole(1000)) is Life.UNSTEADY
    assert looks.at(60.1, whole(1001)) is Life.UNSTEADY
    assert looks.at(60.4, whole(1001)) is Life.READY, "it stands still at last"
    assert looks.at(60.5) is None
    assert looks.at(60.6, whole(1)) is Life.SETTLING, "another record of the same name"


def test_another_format_of_its_name_does_not_hide_how_long_it_changes(bench: Bench) -> None:
    ledger = RecordLedger(NAME, MOTOR, bench.repository)
    (combined,) = understood(listed("X.CFF")).records
    for size, now_s in ((100, 0.0), (200, 70.0)):
        state, other = ledger.follow([whole(size), combined])
        ledger.pass_over([other])
        state.settle(now_s, SettlingTimes(still_s=0.25, incomplete_s=30, unsteady_s=60))
    assert state.life is Life.UNSTEADY


def state_of(name: str) -> RecordState:
    return RecordState(understood(listed(f"{name}.CFG", f"{name}.DAT")).records[0])


def fail(state: RecordState, failure: Failure, now_s: float, reason: str = "") -> None:
    state.fail(failure, reason, now_s, DEFAULT_RULES[failure])


def next_due_s(state: RecordState, now_s: float) -> float:
    """To a tenth of a second."""
    return next(now_s + k / 10 for k in range(10_000) if state.pause_s(now_s + k / 10) <= 0)


def test_pauses_grow_and_have_a_limit() -> None:
    state = state_of("HR_1")
    times_s = [0.0]
    for _ in range(15):
        fail(state, Failure.BUSY, times_s[-1])
        times_s.append(next_due_s(state, times_s[-1]))
    pauses_s = [after - before for before, after in pairwise(times_s)]
    assert pauses_s[0] < 0.5
    assert sorted(pauses_s) == pytest.approx(pauses_s, abs=0.11)
    assert pauses_s[-1] == pytest.approx(60.0, abs=0.11)
    assert 30 < times_s[WRONG_IN_A_ROW - 1] < 90, "a record is refused after about a minute"


def test_a_denied_one_is_asked_for_again_for_a_day() -> None:
    state = state_of("HR_1")
    (limit,) = DEFAULT_RULES[Failure.DENIED].refuse_after
    now_s = 0.0
    for number in range(1, limit.in_all):
        fail(state, Failure.DENIED, now_s)
        assert state.attempts == number
        now_s = next_due_s(state, now_s)
        if number == WRONG_IN_A_ROW:
            assert now_s < 120, "soon at first"
    assert 23 < now_s / 3600 < 25


def test_kinds_of_failures_are_counted_apart() -> None:
    state = state_of("HR_1")
    for number in range(1, 4):
        fail(state, Failure.DENIED, 0.0)
        fail(state, Failure.NOT_AS_LISTED, 0.0)
        assert (state.attempts, state.failures[Failure.NOT_AS_LISTED]) == (2 * number, number)


def test_one_that_failed_comes_last() -> None:
    old, new = state_of("HR_1"), state_of("HR_2")
    old.life = new.life = Life.READY
    assert in_turn([old, new], 0.0) == [old, new]
    fail(old, Failure.LINK_LOST, 0.0)
    assert in_turn([old, new], 0.1) == [new]
    assert in_turn([old, new], 1.0) == [new, old]


def test_what_failed_is_forgotten_once_the_record_is_decided() -> None:
    state = state_of("HR_1")
    fail(state, Failure.BUSY, 0.0, "first")
    assert 0 < state.pause_s(0.0) < 1
    for _ in range(8):
        fail(state, Failure.BUSY, 0.0, "last")
    assert state.pause_s(0.0) > 10
    assert (state.life, state.reason) == (Life.RETRYING, "last")
    state.begin_anew(Life.STORED)
    assert (state.attempts, state.reason, state.pause_s(0.0)) == (0, None, 0.0)


@pytest.mark.parametrize("code", [5, 41, 50, 80, 90, 91, 94, 95])
def test_an_error_of_the_file_service_is_that_of_one_file(code: int) -> None:
    assert type(errors.file_error("relay", "download", code)) is errors.ServiceFailed


@pytest.mark.parametrize("code", [4, 7, 100, 109])
def test_nonsense_and_rejects_are_not(code: int) -> None:
    assert isinstance(errors.file_error("relay", "download", code), errors.ProtocolError)
