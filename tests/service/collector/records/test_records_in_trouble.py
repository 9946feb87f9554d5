"""Records that come late, by parts, again, or not at all: none is doubled, and none holds up another."""

import os
import time
from dataclasses import replace

import pytest

from service.collector.records.policy import RECORD_POLICY, Attempts, Failure
from service.storage.states import AlarmKind, LinkState, RecordingRequestState, RecordingState
from testing.waiting import eventually
from tests.service.collector.conftest import Bench
from tests.service.collector.records.policies import (
    WRONG_IN_A_ROW,
    with_alarm_after,
    with_first_pause,
    with_rules,
)
from tests.service.collector.scripted_relay import ScriptedRelay


def test_a_relay_that_pauses_while_it_writes_is_waited_for(bench: Bench, relay: ScriptedRelay) -> None:
    with bench.session():
        assert eventually(lambda: bench.link() is LinkState.UP)
        relay.write_file("HR_1.CFG", b"configuration")
        for size in (1000, 2000, 3000):
            relay.write_file("HR_1.DAT", b"x" * size)
            time.sleep(0.5)  # longer than a record that was reported must stand still
        assert eventually(lambda: bench.is_stored("HR_1"))
    (recording,) = bench.recordings()
    assert recording.size_bytes == 3000 + len(b"configuration")


def test_two_records_reported_at_once_are_both_expected(bench: Bench, relay: ScriptedRelay) -> None:
    with bench.with_record_policy(replace(RECORD_POLICY, settle_s=3600.0)).session():
        assert eventually(lambda: bench.link() is LinkState.UP)
        relay.write_record("HR_1", report=False)
        relay.write_file("HR_2.CFG", b"configuration")
        relay.announce()
        assert eventually(lambda: bench.is_stored("HR_1"))
        relay.write_file("HR_2.DAT", b"written after the other was taken")
        assert eventually(lambda: bench.is_stored("HR_2"))


def test_a_file_that_comes_late_makes_no_second_recording(bench: Bench, relay: ScriptedRelay) -> None:
    with bench.session():
        assert eventually(lambda: bench.link() is LinkState.UP)
        relay.write_record("HR_1")
        assert eventually(lambda: bench.is_stored("HR_1"))
        relay.write_file("HR_1.HDR", b"header")
        relay.write_record("HR_2")
        assert eventually(lambda: len(files_of(bench, "HR_1")) == 3)
        assert eventually(lambda: bench.is_stored("HR_2"))
    assert sorted(recording.name for recording in bench.recordings()) == ["HR_1", "HR_2"]
    assert files_of(bench, "HR_1")["HR_1.HDR"] == b"header"


def files_of(bench: Bench, name: str) -> dict[str, bytes]:
    """As the database lists them and the store has them; none of a record that is announced only.

    None either in the moment in which a late file replaces the folder that was just looked up.
    """
    recording = bench.recording(name)
    if recording is None or recording.digest is None:
        return {}
    folder = bench.store.directory(recording.digest)
    listed = bench.repository.recording_files(recording.id)
    try:
        return {file.name: (folder / file.name).read_bytes() for file in listed}
    except FileNotFoundError:
        return {}


def test_a_file_that_silences_the_relay_holds_up_no_other(bench: Bench, relay: ScriptedRelay) -> None:
    at_once = with_alarm_after(Attempts(since_start=1), Failure.LINK_LOST, Failure.PROTOCOL_BROKEN)
    bench.with_record_policy(at_once)
    relay.stuck.add("HR_1")
    relay.write_record("HR_1")
    with bench.session():
        assert eventually(lambda: bench.link() is LinkState.DOWN)
        relay.write_record("HR_2")
        assert eventually(lambda: bench.is_stored("HR_2"))
        assert bench.alarms() == {AlarmKind.FILE_UNSTEADY: ["HR_1"]}
        relay.stuck.clear()
        assert eventually(lambda: bench.is_stored("HR_1"))
        assert eventually(lambda: bench.alarms() == {})


def test_a_file_that_cannot_be_opened_for_a_while_is_asked_for_again(
    bench: Bench, relay: ScriptedRelay
) -> None:
    relay.denied.add("HR_1")
    relay.write_record("HR_1")
    with bench.session():
        assert eventually(lambda: bench.recording("HR_1") is not None)
        relay.write_record("HR_2")
        assert eventually(lambda: bench.is_stored("HR_2"))
        time.sleep(1.5)  # as long as a relay may take to close a file
        relay.denied.clear()
        assert eventually(lambda: bench.is_stored("HR_1"))


def attempts(bench: Bench, name: str) -> int:
    recording = bench.recording(name)
    return 0 if recording is None else recording.attempts


def states(bench: Bench) -> list[RecordingState]:
    return [recording.state for recording in bench.recordings()]


def test_a_relay_that_denies_its_files_for_long_loses_none(bench: Bench, relay: ScriptedRelay) -> None:
    policy = replace(with_first_pause(0.0001), wrong_listings_a_day=WRONG_IN_A_ROW)
    bench.with_record_policy(policy)
    relay.denied.add("HR_1")
    relay.write_record("HR_1")
    with bench.session():
        assert eventually(lambda: attempts(bench, "HR_1") > WRONG_IN_A_ROW + 1)
    with bench.session():  # a restart neither forgives nor forgets
        before = attempts(bench, "HR_1")
        assert eventually(lambda: attempts(bench, "HR_1") > before)
        assert bench.alarms() == {AlarmKind.FILE_UNSTEADY: ["HR_1"]}
        recording = bench.recording("HR_1")
        assert recording is not None
        assert recording.state is RecordingState.ANNOUNCED
        relay.denied.clear()
        assert eventually(lambda: bench.is_stored("HR_1"))
        assert eventually(lambda: bench.alarms() == {})
    (alarm,) = bench.repository.alarms(limit=10).items
    assert "EVENTS/HR_1.CFG': file access denied" in alarm.reason
    assert ", 5 times" in alarm.reason


def test_a_denied_record_that_is_then_not_found_is_no_worse_than_others(
    bench: Bench, relay: ScriptedRelay
) -> None:
    bench.with_record_policy(with_first_pause(0.000001))
    relay.denied.add("HR_1")
    relay.write_record("HR_1")
    with bench.session():
        assert eventually(lambda: attempts(bench, "HR_1") > WRONG_IN_A_ROW)
        denied = attempts(bench, "HR_1")
        relay.absent.add("HR_1")
        relay.denied.clear()
        assert eventually(lambda: states(bench) == [RecordingState.REJECTED])
    assert attempts(bench, "HR_1") >= denied + WRONG_IN_A_ROW


def test_a_record_denied_for_a_day_is_refused_and_stays_an_alarm(bench: Bench, relay: ScriptedRelay) -> None:
    policy = with_first_pause(0.0001)
    denied = replace(policy.rules[Failure.DENIED], refuse_after=(Attempts(in_all=WRONG_IN_A_ROW + 2),))
    bench.with_record_policy(with_rules({Failure.DENIED: denied}, policy))
    relay.denied.add("HR_1")
    relay.write_record("HR_1")
    with bench.session():
        assert eventually(lambda: states(bench) == [RecordingState.REJECTED])
        listings = relay.listings
        assert eventually(lambda: relay.listings > listings + 2)
        assert attempts(bench, "HR_1") == WRONG_IN_A_ROW + 2
        assert bench.alarms() == {AlarmKind.FILE_UNSTEADY: ["HR_1"]}
        for path in relay.events.iterdir():
            path.unlink()
        assert eventually(lambda: bench.alarms() == {})


def test_a_request_for_a_record_that_is_denied_fails_in_time_with_the_reason(
    bench: Bench, relay: ScriptedRelay
) -> None:
    relay.denied.add("HR_10001")
    request_id = bench.request()
    with bench.session():
        assert bench.reaches(request_id, RecordingRequestState.FAILED)
        assert "its record could not be fetched within 2 s" in (bench.requested(request_id).reason or "")
        assert "file access denied" in (bench.requested(request_id).reason or "")


def test_a_trigger_waits_until_what_is_there_is_taken(bench: Bench, relay: ScriptedRelay) -> None:
    relay.busy = True
    relay.write_record("HR_1")
    with bench.session():
        assert eventually(lambda: bench.recording("HR_1") is not None)
        request_id = bench.request()
        time.sleep(0.5)  # it is asked for at once where nothing is in the way
        assert relay.edges == 0
        relay.busy = False
        assert bench.reaches(request_id, RecordingRequestState.FETCHED)
    made = bench.recording("HR_10001")
    assert made is not None
    assert bench.requested(request_id).recording_id == made.id


def untime(relay: ScriptedRelay) -> None:
    for path in relay.events.iterdir():
        os.utime(path, (0, 0))


@pytest.mark.campaign
def test_a_record_that_looks_like_the_one_it_overwrites_is_pulled_once_announced(
    bench: Bench, relay: ScriptedRelay
) -> None:
    """Same name, same size, no times."""
    relay.write_record("HR_1", b"first", report=False)
    relay.write_record("HR_2", b"of long ago", report=False)
    untime(relay)
    with bench.session():
        assert eventually(lambda: bench.is_stored("HR_1") and bench.is_stored("HR_2"))
        relay.write_file("HR_1.DAT", b"other")
        untime(relay)
        opened = relay.opened
        relay.records += 1
        relay.announce()
        assert eventually(lambda: files_of(bench, "HR_1").get("HR_1.DAT") == b"other")
        assert eventually(lambda: relay.opened >= opened + 4), "all are asked for again"
        opened = relay.opened
        time.sleep(bench.settings.record_timeout_s + 0.5)  # longer than what a report announces is expected
        assert relay.opened == opened, "once"
    stored = sorted(recording.name for recording in bench.recordings())
    assert stored == ["HR_1", "HR_1", "HR_2"]


def test_where_a_relay_gives_no_times_a_name_may_come_again(bench: Bench, relay: ScriptedRelay) -> None:
    with bench.session():
        for data in (b"first", b"other"):
            relay.write_record("HR_1", data, report=False)
            for path in relay.events.iterdir():
                os.utime(path, (0, 0))
            relay.announce()
            assert eventually(lambda: bench.is_stored("HR_1"))
            assert eventually(lambda data=data: files_of(bench, "HR_1").get("HR_1.DAT") == data)  # type: ignore[misc]
            for path in relay.events.iterdir():
                path.unlink()
            relay.write_record("HR_2")
            assert eventually(lambda: bench.is_stored("HR_2"))
            for path in relay.events.iterdir():
                path.unlink()
    assert sorted(recording.name for recording in bench.recordings()) == ["HR_1", "HR_1", "HR_2"]
