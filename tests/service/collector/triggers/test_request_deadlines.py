"""Whose time runs when; the limit is ten seconds."""

from dataclasses import replace

from service.collector.triggers.request_deadlines import RequestDeadlines
from service.storage.records import RecordingRequest
from service.storage.states import RecordingRequestOrigin, RecordingRequestState

TRIGGERED = RecordingRequest(
    id="one",
    motor="PUMP-A1",
    ied="A1",
    origin=RecordingRequestOrigin.REQUEST,
    state=RecordingRequestState.TRIGGERED,
    reason=None,
    recording_id=None,
    requested_ns=0,
    triggered_ns=0,
    recorded_ns=None,
    fetched_ns=None,
    diagnosed_ns=None,
    failed_ns=None,
)
RECORDED = replace(TRIGGERED, state=RecordingRequestState.RECORDED)
QUEUED = replace(TRIGGERED, id="two", state=RecordingRequestState.REQUESTED)


def test_a_request_ends_when_no_record_comes_in_time() -> None:
    deadlines = RequestDeadlines(10.0)
    for now_s in (100.0, 105.0, 110.0):
        deadlines.answered(now_s)
        assert not deadlines.ends_without_record(TRIGGERED, now_s)
    assert deadlines.ends_without_record(TRIGGERED, 110.1)
    assert not deadlines.ends_without_record(RECORDED, 110.1), "the next state has its own time"


def test_an_outage_is_not_time_in_which_a_record_could_be_seen() -> None:
    deadlines = RequestDeadlines(10.0)
    assert not deadlines.ends_without_record(TRIGGERED, 100.0)
    assert not deadlines.ends_without_answer(TRIGGERED, 103.0)
    deadlines.answered(142.0)
    assert not deadlines.ends_without_record(TRIGGERED, 142.0)
    assert not deadlines.ends_without_record(TRIGGERED, 148.9)
    assert deadlines.ends_without_record(TRIGGERED, 149.1), "three seconds before, seven after"


def test_a_link_that_fails_again_and_again_prolongs_no_request_for_ever() -> None:
    deadlines = RequestDeadlines(10.0)
    visits = 0
    while not deadlines.ends_without_record(TRIGGERED, visits * 2.0):
        assert not deadlines.ends_without_answer(TRIGGERED, visits * 2.0 + 1.0)
        visits += 1
        deadlines.answered(visits * 2.0)
    assert visits == 11, "half of the time the relay answered"


def test_requests_end_when_the_relay_stays_silent_each_in_its_own_time() -> None:
    deadlines = RequestDeadlines(10.0)
    assert not deadlines.ends_without_answer(TRIGGERED, 100.0)
    assert not deadlines.ends_without_answer(QUEUED, 108.0)
    assert deadlines.ends_without_answer(TRIGGERED, 110.1)
    assert not deadlines.ends_without_answer(QUEUED, 118.0)
    assert deadlines.ends_without_answer(QUEUED, 118.1)


def test_no_time_runs_while_the_relay_gives_records() -> None:
    deadlines = RequestDeadlines(10.0)
    assert not deadlines.ends_without_answer(QUEUED, 100.0)
    assert not deadlines.ends_without_record(TRIGGERED, 100.0)
    deadlines.gave_a_record()
    assert not deadlines.ends_without_answer(QUEUED, 200.0)
    assert not deadlines.ends_without_record(TRIGGERED, 200.0)
    assert deadlines.ends_without_record(TRIGGERED, 210.1)
