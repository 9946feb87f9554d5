"""A relay that has much to give, and takes longer over it than an event report may take."""

import os
import time

import pytest

from service.storage.states import LinkState, RecordingRequestState
from testing.waiting import eventually
from tests.service.collector.conftest import Bench
from tests.service.collector.scripted_relay import ScriptedRelay

OPENING_S = 0.4
"""Two files of four records take more than `record_timeout_s` of the bench, 2 s."""

OLD_RECORDS = [f"HR_{number}" for number in range(1, 9)]


def stored(bench: Bench) -> int:
    return sum(bench.is_stored(name) for name in OLD_RECORDS)


def test_a_record_that_comes_while_old_ones_are_fetched_again_is_not_missed(
    bench: Bench, relay: ScriptedRelay
) -> None:
    for name in OLD_RECORDS:
        relay.write_record(name)
    relay.silent = True
    with bench.session():
        assert eventually(lambda: stored(bench) == len(OLD_RECORDS))
        request_id = bench.request()
        assert bench.reaches(request_id, RecordingRequestState.TRIGGERED)
        relay.opening_s = OPENING_S
        for path in relay.events.iterdir():
            changed_s = path.stat().st_mtime - 3600
            os.utime(path, (changed_s, changed_s))
        opened = relay.opened
        relay.announce()
        assert eventually(lambda: relay.opened > opened)
        relay.write_record("HR_10001")
        assert eventually(lambda: bench.requested(request_id).state is not RecordingRequestState.TRIGGERED)
        assert bench.reaches(request_id, RecordingRequestState.FETCHED), bench.requested(request_id).reason
    made = bench.recording("HR_10001")
    assert made is not None
    assert bench.requested(request_id).recording_id == made.id


@pytest.mark.campaign
def test_requests_wait_while_a_relay_gives_what_it_has_with_cuts_in_between(
    bench: Bench, relay: ScriptedRelay
) -> None:
    for name in OLD_RECORDS:
        relay.write_record(name)
    relay.opening_s = OPENING_S
    with bench.session():
        assert eventually(lambda: stored(bench) == 1)
        request_ids = [bench.request() for _ in range(2)]
        relay.stop()
        assert eventually(lambda: bench.link() is LinkState.DOWN)
        again = bench.start_relay()
        again.opening_s = OPENING_S
        assert eventually(lambda: stored(bench) >= 5)
        again.stop()
        assert eventually(lambda: bench.link() is LinkState.DOWN)
        last = bench.start_relay()
        try:
            assert all(
                bench.reaches(request_id, RecordingRequestState.FETCHED) for request_id in request_ids
            ), [bench.requested(request_id).reason for request_id in request_ids]
        finally:
            last.stop()


def test_a_record_that_takes_long_to_write_is_not_missed(bench: Bench, relay: ScriptedRelay) -> None:
    relay.silent = True
    with bench.session():
        request_id = bench.request()
        assert bench.reaches(request_id, RecordingRequestState.TRIGGERED)
        relay.write_record("HR_10001", b"x")
        began_s = time.monotonic()
        while time.monotonic() < began_s + bench.settings.record_timeout_s + 1.0:
            with (relay.events / "HR_10001.DAT").open("ab") as file:
                file.write(b"x")
            time.sleep(0.05)  # it never stands still for as long as it must
        assert bench.requested(request_id).state is RecordingRequestState.RECORDED, bench.requested(
            request_id
        ).reason
        assert bench.reaches(request_id, RecordingRequestState.FETCHED)
