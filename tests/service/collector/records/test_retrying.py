"""When a record that failed is asked for again."""

from itertools import pairwise

import pytest

from mms import errors
from service.collector.records.directory import DENIED_ATTEMPTS, PULL_ATTEMPTS
from service.collector.records.listing import ListedRecord
from service.collector.records.retrying import LONGEST_PAUSE_OF_THE_DENIED_S, LONGEST_PAUSE_S, RetrySchedule

OLD, NEW = ListedRecord("HR_1", ()), ListedRecord("HR_2", ())


def next_due_s(retries: RetrySchedule, record: ListedRecord, now_s: float) -> float:
    """To a tenth of a second."""
    return next(now_s + k / 10 for k in range(10_000) if retries.due([record], now_s + k / 10))


def test_pauses_grow_and_have_a_limit() -> None:
    retries = RetrySchedule()
    times_s = [0.0]
    for _ in range(15):
        retries.failed(OLD, "busy", times_s[-1])
        times_s.append(next_due_s(retries, OLD, times_s[-1]))
    pauses_s = [after - before for before, after in pairwise(times_s)]
    assert pauses_s[0] < 0.5
    assert sorted(pauses_s) == pytest.approx(pauses_s, abs=0.11)
    assert pauses_s[-1] == pytest.approx(LONGEST_PAUSE_S, abs=0.11)
    assert 30 < times_s[PULL_ATTEMPTS - 1] < 90, "a record is refused after about a minute"


def test_a_denied_one_is_asked_for_again_for_a_day() -> None:
    retries = RetrySchedule()
    now_s = 0.0
    for number in range(1, DENIED_ATTEMPTS):
        assert retries.failed(OLD, "denied", now_s, longest_s=LONGEST_PAUSE_OF_THE_DENIED_S) == number
        now_s = next_due_s(retries, OLD, now_s)
        if number == PULL_ATTEMPTS:
            assert now_s < 120, "soon at first"
    assert 23 < now_s / 3600 < 25


def test_verdicts_are_counted_apart() -> None:
    retries = RetrySchedule()
    for number in range(1, 4):
        retries.failed(OLD, "denied", 0.0)
        retries.failed(OLD, "not found", 0.0, is_verdict=True)
        assert (retries.number(OLD), retries.verdicts(OLD)) == (2 * number, number)
    assert retries.verdicts(NEW) == 0


def test_one_that_failed_comes_last() -> None:
    retries = RetrySchedule()
    assert retries.due([OLD, NEW], 0.0) == (OLD, NEW)
    retries.failed(OLD, "the connection was lost", 0.0)
    assert retries.due([OLD, NEW], 0.1) == (NEW,)
    assert retries.due([OLD, NEW], 1.0) == (NEW, OLD)


def test_what_is_put_off_and_why() -> None:
    retries = RetrySchedule()
    assert retries.failed(OLD, "first", 0.0) == 1
    assert retries.put_off(0.0) == frozenset()
    for _ in range(8):
        retries.failed(OLD, "last", 0.0)
    assert retries.put_off(0.0) == {"HR_1"}
    assert retries.reasons() == {"HR_1": "last"}
    retries.keep([NEW])
    assert (retries.number(OLD), retries.reasons()) == (0, {})


@pytest.mark.parametrize("code", [5, 41, 50, 80, 90, 91, 94, 95])
def test_an_error_of_the_file_service_is_that_of_one_file(code: int) -> None:
    assert type(errors.file_error("relay", "download", code)) is errors.FileServiceFailed


@pytest.mark.parametrize("code", [4, 7, 8, 100, 109])
def test_nonsense_and_rejects_are_not(code: int) -> None:
    assert type(errors.file_error("relay", "download", code)) is errors.ProtocolError
