"""One relay and its session, over real MMS."""

import os
import time
from itertools import pairwise
from pathlib import Path

import pytest
from structlog.testing import capture_logs

from core.units import NANOSECONDS_PER_SECOND
from mms import Client, DataAccessError
from service.collector.session.link import Link
from service.collector.session.session_policy import SessionPolicy
from service.recording_store.arriving import Incoming
from service.storage.records import ReportPosition
from service.storage.states import AlarmKind, LinkState, RecordingRequestState, RecordingState
from service.timing.backoff import Backoff
from testing.waiting import eventually
from tests.service.collector.conftest import MOTOR, Bench
from tests.service.collector.records.policies import with_first_pause
from tests.service.collector.scripted_relay import CONTROL, NAME, ScriptedRelay

SOON = Backoff(first_s=0.05, longest_s=10.0)


def test_a_request_becomes_a_stored_record(bench: Bench, relay: ScriptedRelay) -> None:
    with bench.session() as session:
        assert eventually(lambda: bench.link() is LinkState.UP)
        request_id = bench.request()
        session.wake()
        assert bench.reaches(request_id, RecordingRequestState.FETCHED)
    request = bench.requested(request_id)
    (recording,) = bench.recordings()
    assert request.recording_id == recording.id
    assert request.triggered_ns is not None
    assert recording.digest is not None
    stored = bench.store.find(recording.digest)
    assert (bench.store.directory(stored.digest) / "HR_10001.DAT").read_bytes() == b"record 1"
    assert relay.edges == 1
    assert relay.server.read(f"{CONTROL}.stVal") is False, "the bit is ready for the next edge"


def test_records_made_before_the_service_came_are_pulled(bench: Bench, relay: ScriptedRelay) -> None:
    relay.write_record("HR_1", b"first")
    relay.write_record("HR_2", b"second")
    with bench.session():
        assert eventually(lambda: len(bench.recordings()) == 2)
    assert relay.edges == 0


def test_a_report_hurries_the_next_record(bench: Bench, relay: ScriptedRelay) -> None:
    slow = bench.settings.model_copy(update={"poll_period_s": 60.0})
    bench.settings = slow
    with bench.session():
        assert eventually(lambda: bench.link() is LinkState.UP)
        relay.write_record("HR_7")
        assert eventually(lambda: len(bench.recordings()) == 1)
        assert eventually(lambda: bench.repository.entry_id(NAME) is not None)


def test_each_request_gets_its_own_record_one_at_a_time(bench: Bench, relay: ScriptedRelay) -> None:
    request_ids = [bench.request() for _ in range(3)]
    with bench.session():
        assert all(bench.reaches(request_id, RecordingRequestState.FETCHED) for request_id in request_ids)
    requests = [bench.requested(request_id) for request_id in request_ids]
    assert len({request.recording_id for request in requests}) == 3
    for earlier, later in pairwise(requests):
        assert earlier.fetched_ns is not None
        assert later.triggered_ns is not None
        assert earlier.fetched_ns <= later.triggered_ns
    assert relay.edges == 3


def test_a_remote_bit_left_set_is_cleared_first(bench: Bench, relay: ScriptedRelay) -> None:
    with Client.connect("127.0.0.1", relay.port) as client:
        relay.silent = True
        client.operate(CONTROL, True)  # noqa: FBT003 - the value of a control
        relay.silent = False
    request_id = bench.request()
    with bench.session():
        assert bench.reaches(request_id, RecordingRequestState.FETCHED)
    assert relay.edges == 2


@pytest.mark.parametrize("refusal", [DataAccessError.HARDWARE_FAULT, DataAccessError.TEMPORARILY_UNAVAILABLE])
def test_a_remote_bit_that_cannot_be_read_is_cleared(
    bench: Bench, relay: ScriptedRelay, refusal: DataAccessError
) -> None:
    relay.unreadable_while_set = refusal
    request_id = bench.request()
    with bench.session():
        assert bench.reaches(request_id, RecordingRequestState.FETCHED)
    assert relay.edges == 1
    assert not relay.is_set
    assert bench.repository.link_figures(NAME).connections == 1


def test_a_refused_trigger_says_why_and_the_link_stays(bench: Bench, relay: ScriptedRelay) -> None:
    relay.refuses = True
    request_id = bench.request()
    with bench.session():
        assert bench.reaches(request_id, RecordingRequestState.FAILED)
        assert eventually(lambda: bench.link() is LinkState.UP)
    assert "refuses the trigger" in (bench.requested(request_id).reason or "")


def test_a_trigger_without_record_fails_at_its_time_limit(bench: Bench, relay: ScriptedRelay) -> None:
    relay.silent = True
    request_id = bench.request()
    with bench.session():
        assert bench.reaches(request_id, RecordingRequestState.FAILED)
    assert "expected a record within 2 s" in (bench.requested(request_id).reason or "")
    assert relay.edges == 1


def test_a_crash_between_trigger_and_record_neither_triggers_twice_nor_loses_it(
    bench: Bench, relay: ScriptedRelay
) -> None:
    relay.silent = True
    request_id = bench.request()
    with bench.session():
        assert bench.reaches(request_id, RecordingRequestState.TRIGGERED)
    assert eventually(lambda: relay.edges == 1)
    relay.write_record("HR_10001", b"made while the collector was away")
    with bench.session():
        assert bench.reaches(request_id, RecordingRequestState.FETCHED)
    assert relay.edges == 1
    assert len(bench.recordings()) == 1


def test_a_crash_just_before_the_operation_costs_the_request_and_nothing_else(
    bench: Bench, relay: ScriptedRelay
) -> None:
    request_id = bench.request()
    bench.repository.mark_triggered(request_id, now_ns=time.time_ns())
    with bench.session():
        assert bench.reaches(request_id, RecordingRequestState.FAILED)
    assert relay.edges == 0


def test_a_restart_doubles_nothing(bench: Bench, relay: ScriptedRelay) -> None:
    for number in range(3):
        relay.write_record(f"HR_{number}", bytes([number]))
    for _ in range(3):
        with bench.session():
            assert eventually(lambda: len(bench.recordings()) == 3)
    assert len(bench.recordings()) == 3


def test_the_same_record_under_a_new_time_is_not_doubled(bench: Bench, relay: ScriptedRelay) -> None:
    relay.write_record("HR_1")
    with bench.session():
        assert eventually(lambda: [r.state for r in bench.recordings()] == [RecordingState.FETCHED])
        for file in relay.events.iterdir():
            os.utime(file, (1_000_000_000, 1_000_000_000))
        relay.write_record("HR_2")
        assert eventually(lambda: {r.name for r in bench.recordings()} == {"HR_1", "HR_2"})
        assert eventually(lambda: all(r.state is RecordingState.FETCHED for r in bench.recordings()))
    assert len(bench.recordings()) == 2


def test_a_record_whose_time_changes_is_not_what_the_next_trigger_made(
    bench: Bench, relay: ScriptedRelay
) -> None:
    relay.write_record("HR_1", b"of yesterday")
    relay.silent = True
    with bench.session():
        assert eventually(lambda: [r.state for r in bench.recordings()] == [RecordingState.FETCHED])
        request_id = bench.request()
        assert bench.reaches(request_id, RecordingRequestState.TRIGGERED)
    for file in relay.events.iterdir():
        os.utime(file, (1_000_000_000, 1_000_000_000))
    relay.write_record("HR_2", b"made while the collector was away")
    with bench.session():
        assert bench.reaches(request_id, RecordingRequestState.FETCHED)
    recordings = {recording.name: recording.id for recording in bench.recordings()}
    assert bench.requested(request_id).recording_id == recordings["HR_2"]


def test_a_clock_that_is_set_ends_no_report(
    bench: Bench, relay: ScriptedRelay, monkeypatch: pytest.MonkeyPatch
) -> None:
    right_ns = time.time_ns
    relay.silent = True
    bench.settings = bench.settings.model_copy(update={"record_timeout_s": 20.0})
    request_id = bench.request()
    with bench.session():
        assert bench.reaches(request_id, RecordingRequestState.TRIGGERED)
        monkeypatch.setattr(time, "time_ns", lambda: right_ns() + 3600 * NANOSECONDS_PER_SECOND)
        relay.write_record("HR_10001", b"after the clock was set")
        assert bench.reaches(request_id, RecordingRequestState.FETCHED)


def test_a_cut_ends_no_request_that_waits_for_its_turn(bench: Bench, relay: ScriptedRelay) -> None:
    long_ago_ns = time.time_ns() - 3600 * NANOSECONDS_PER_SECOND
    request_ids = [bench.repository.request_recording(MOTOR, now_ns=long_ago_ns).id for _ in range(3)]
    relay.stop()
    with bench.session():
        assert eventually(lambda: bench.link() is LinkState.DOWN)
        again = bench.start_relay()
        try:
            assert all(bench.reaches(request_id, RecordingRequestState.FETCHED) for request_id in request_ids)
        finally:
            again.stop()


def test_a_relay_that_is_down_says_so_and_comes_back(bench: Bench) -> None:
    bench.policy = SessionPolicy(reconnect=Backoff(first_s=0.05, longest_s=0.5))
    request_id = bench.request()
    with bench.session():
        assert eventually(lambda: bench.link() is LinkState.DOWN)
        assert str(bench.relay.port) in (bench.repository.relay(NAME).link_reason or "")
        assert bench.reaches(request_id, RecordingRequestState.FAILED)
        assert "does not answer" in (bench.requested(request_id).reason or "")
        relay = bench.start_relay()
        try:
            assert eventually(lambda: bench.link() is LinkState.UP, within_s=15)
        finally:
            relay.stop()
        assert eventually(lambda: bench.link() is LinkState.DOWN)


def test_a_record_without_its_data_is_rejected_and_fails_nothing_else(
    bench: Bench, relay: ScriptedRelay
) -> None:
    relay.write_file("HR_1.CFG", b"configuration alone")
    relay.write_record("HR_2")
    with bench.session():
        assert eventually(lambda: {r.state for r in bench.recordings()} >= {RecordingState.REJECTED})
    states = {recording.name: recording for recording in bench.recordings()}
    assert states["HR_2"].state is RecordingState.FETCHED
    assert states["HR_1"].reason == "HR_1: expected a .DAT file in EVENTS, found none"


def test_a_record_that_grows_is_pulled_whole(bench: Bench, relay: ScriptedRelay) -> None:
    with bench.session():
        relay.write_file("HR_1.CFG", b"configuration")
        for size in range(1, 8):
            relay.write_file("HR_1.DAT", b"x" * size)
            time.sleep(0.06)  # the relay writes slowly; the session looks in between
        assert eventually(lambda: [r.state for r in bench.recordings()] == [RecordingState.FETCHED])
    (recording,) = bench.recordings()
    assert recording.digest is not None
    assert (bench.store.directory(recording.digest) / "HR_1.DAT").read_bytes() == b"x" * 7


def test_a_record_too_large_is_rejected_with_its_recording_request(
    bench: Bench, relay: ScriptedRelay
) -> None:
    relay.silent = True
    request_id = bench.request()
    with bench.session():
        assert bench.reaches(request_id, RecordingRequestState.TRIGGERED)
        relay.write_record("HR_1", b"x" * 200_000)
        assert bench.reaches(request_id, RecordingRequestState.FAILED)
    (recording,) = bench.recordings()
    assert recording.state is RecordingState.REJECTED
    assert "HR_1.DAT: expected at most 100000 bytes" in (recording.reason or "")


def test_a_record_listed_before_the_trigger_is_not_the_triggered_one(
    bench: Bench, relay: ScriptedRelay
) -> None:
    relay.write_record("HR_1", b"a trip of its own", report=False)
    request_id = bench.request()
    with bench.session():
        assert bench.reaches(request_id, RecordingRequestState.FETCHED)
    recordings = {recording.name: recording.id for recording in bench.recordings()}
    assert bench.requested(request_id).recording_id == recordings["HR_10001"]
    assert set(recordings) == {"HR_1", "HR_10001"}


def test_a_record_that_could_not_be_fetched_before_the_trigger_is_not_the_triggered_one_after_a_crash(
    bench: Bench, relay: ScriptedRelay
) -> None:
    relay.silent = True
    relay.denied.add("HR_1")
    relay.write_record("HR_1", b"a trip of its own")
    bench = bench.with_settings(record_timeout_s=10.0)
    with bench.session():
        assert eventually(lambda: bench.recording("HR_1") is not None)
        request_id = bench.request()
        assert bench.reaches(request_id, RecordingRequestState.TRIGGERED)
    relay.denied.clear()
    with bench.session():
        assert eventually(lambda: bench.is_stored("HR_1"))
        relay.write_record("HR_10001", b"what the trigger made")
        assert bench.reaches(request_id, RecordingRequestState.FETCHED)
    recordings = {recording.name: recording.id for recording in bench.recordings()}
    assert bench.requested(request_id).recording_id == recordings["HR_10001"]


def test_the_entry_id_is_saved_only_when_its_record_is_safe(
    bench: Bench, relay: ScriptedRelay, monkeypatch: pytest.MonkeyPatch
) -> None:
    def disk_full(incoming: Incoming) -> None:
        raise OSError(28, "No space left on device")

    relay.write_record("HR_1")
    with monkeypatch.context() as full, bench.session():
        full.setattr(Incoming, "keep", disk_full)
        assert eventually(lambda: bench.link() is LinkState.DOWN)
        assert "No space left" in (bench.repository.relay(NAME).link_reason or "")
        assert bench.repository.entry_id(NAME) is None
    with bench.session():
        assert eventually(lambda: [r.state for r in bench.recordings()] == [RecordingState.FETCHED])
        assert eventually(lambda: bench.repository.entry_id(NAME) is not None)


def test_a_full_disk_is_not_blamed_on_the_relay(
    bench: Bench, relay: ScriptedRelay, monkeypatch: pytest.MonkeyPatch
) -> None:
    def disk_full(incoming: Incoming) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Incoming, "keep", disk_full)
    request_id = bench.request()
    with bench.session():
        assert bench.reaches(request_id, RecordingRequestState.FAILED)
    assert "is not visited: OSError: [Errno 28] No space left" in (bench.requested(request_id).reason or "")


def test_without_the_report_control_block_the_directory_is_polled(bench: Bench, relay: ScriptedRelay) -> None:
    with bench.session():
        assert eventually(lambda: bench.link() is LinkState.UP)
        with bench.session():
            relay.write_record("HR_1")
            assert eventually(lambda: len(bench.recordings()) == 1)


def test_a_link_out_of_the_events_folder_is_not_followed(
    bench: Bench, relay: ScriptedRelay, tmp_path: Path
) -> None:
    secret = tmp_path / "secret"
    secret.write_bytes(b"not the relay's to give")
    bench.with_record_policy(with_first_pause(0.01))
    (relay.events / "HR_1.DAT").symlink_to(secret)
    relay.write_file("HR_1.CFG", b"configuration")
    with bench.session():
        assert eventually(lambda: bench.alarms() == {AlarmKind.FILE_UNSTEADY: ["HR_1"]})
    (recording,) = bench.recordings()
    assert recording.state is RecordingState.ANNOUNCED
    assert "file access denied" in (recording.reason or "")
    stored = [path.read_bytes() for path in bench.store.root.rglob("*") if path.is_file()]
    assert secret.read_bytes() not in stored


def test_a_busy_relay_is_asked_again(bench: Bench, relay: ScriptedRelay) -> None:
    relay.busy = True
    relay.write_record("HR_1")
    with bench.session():
        assert eventually(lambda: [r.state for r in bench.recordings()] == [RecordingState.ANNOUNCED])
        relay.busy = False
        assert eventually(lambda: [r.state for r in bench.recordings()] == [RecordingState.FETCHED])


def test_a_hostile_name_costs_its_own_file_only(bench: Bench, relay: ScriptedRelay) -> None:
    relay.write_file("HR_1\x1b[2J.CFG", b"clears the screen of whoever reads the log")
    relay.write_record("HR_2")
    with bench.session():
        assert eventually(lambda: [r.state for r in bench.recordings()] == [RecordingState.FETCHED])
    assert [recording.name for recording in bench.recordings()] == ["HR_2"]


def test_a_relay_that_forgot_the_last_report_is_subscribed_anew(bench: Bench, relay: ScriptedRelay) -> None:
    forgotten = bytes.fromhex("0000000012345678")
    bench.repository.save_report_positions([ReportPosition(NAME, forgotten, None)])
    with bench.session():
        assert eventually(lambda: bench.link() is LinkState.UP)
        relay.write_record("HR_1")
        assert eventually(lambda: [r.state for r in bench.recordings()] == [RecordingState.FETCHED])
        assert eventually(lambda: bench.repository.entry_id(NAME) not in (None, forgotten))


def test_a_relay_that_stays_down_is_logged_once(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    bench.policy = SessionPolicy(reconnect=SOON)
    failures: list[str] = []
    failed = Link.failed

    def counted(link: Link, reason: str) -> None:
        failures.append(reason)
        failed(link, reason)

    monkeypatch.setattr(Link, "failed", counted)
    with capture_logs() as logs, bench.session():
        assert eventually(lambda: len(failures) >= 3)
    assert [entry["event"] for entry in logs].count("link down") == len(set(failures)) == 1


def test_a_relay_that_stays_down_is_mentioned_now_and_then(bench: Bench) -> None:
    bench.policy = SessionPolicy(reconnect=SOON, reminder_s=0.0)
    with capture_logs() as logs, bench.session():
        assert eventually(lambda: [entry["event"] for entry in logs].count("link down") >= 2)
