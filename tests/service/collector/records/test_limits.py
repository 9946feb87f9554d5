"""What a relay may do to the store: names, sizes and amounts that are refused, and told."""

import time
from dataclasses import replace
from pathlib import Path

from core.units import NANOSECONDS_PER_DAY
from mms.binding.prototypes import PROTOTYPES
from service.collector.records.policy import RECORD_POLICY
from service.collector.records.pull import BLOCK_BYTES, DailyAllowance
from service.storage.states import AlarmKind, LinkState, RecordingRequestState, RecordingState
from testing.waiting import eventually
from tests.service.collector.conftest import Bench
from tests.service.collector.scripted_relay import NAME, ScriptedRelay

RECORD_BYTES = 2 * BLOCK_BYTES
"""What a small record of two files counts for."""


def test_a_file_too_large_is_an_alarm_while_the_relay_has_it(bench: Bench, relay: ScriptedRelay) -> None:
    relay.write_record("HR_1", b"x" * 200_000)
    relay.write_record("HR_2")
    with bench.session():
        assert eventually(lambda: bench.is_stored("HR_2"))
        assert bench.alarms() == {AlarmKind.FILE_TOO_LARGE: ["HR_1"]}
        (relay.events / "HR_1.DAT").unlink()
        (relay.events / "HR_1.CFG").unlink()
        assert eventually(lambda: bench.alarms() == {})
    (alarm,) = bench.repository.alarms(limit=10).items
    assert "expected at most 100000 bytes (setting max_file_bytes), found 200000" in alarm.reason


def test_a_day_s_limit_holds_back_and_loses_nothing(bench: Bench, relay: ScriptedRelay) -> None:
    for number in range(3):
        relay.write_record(f"HR_{number}", bytes([number]))
    bench.with_settings(max_relay_bytes_per_day=2 * RECORD_BYTES)
    for _ in range(2):  # a restart does not begin a new day
        with bench.session():
            assert eventually(lambda: bench.alarms() == {AlarmKind.DAILY_LIMIT: [""]})
            assert eventually(lambda: bench.link() is LinkState.UP)
        assert [recording.name for recording in bench.recordings()] == ["HR_1", "HR_0"]
    assert bench.repository.link_figures(NAME).day_bytes == 2 * RECORD_BYTES
    with bench.with_settings(max_relay_bytes_per_day=10 * RECORD_BYTES).session():
        assert eventually(lambda: bench.is_stored("HR_2"))
        assert eventually(lambda: bench.alarms() == {})


def test_a_trigger_whose_record_must_wait_says_so(bench: Bench, relay: ScriptedRelay) -> None:
    relay.write_record("HR_0")
    with bench.with_settings(max_relay_bytes_per_day=RECORD_BYTES).session():
        assert eventually(lambda: bench.is_stored("HR_0"))
        request_id = bench.request()
        assert bench.reaches(request_id, RecordingRequestState.FAILED)
    assert "max_relay_bytes_per_day" in (bench.requested(request_id).reason or "")


def test_an_allowance_begins_anew_each_day_of_utc() -> None:
    allowance = DailyAllowance(3 * BLOCK_BYTES)
    assert allowance.allows((10 * BLOCK_BYTES,), now_ns=0), "the first record of a day"
    allowance.charge(1, now_ns=0)
    assert allowance.allows((BLOCK_BYTES, 1), now_ns=1)
    assert not allowance.allows((BLOCK_BYTES + 1, 1), now_ns=NANOSECONDS_PER_DAY - 1)
    assert allowance.allows((BLOCK_BYTES + 1, 1), now_ns=NANOSECONDS_PER_DAY)
    assert (allowance.day, allowance.used_bytes) == (1, 0)


def test_what_did_not_come_uses_up_nothing_of_the_day(bench: Bench, relay: ScriptedRelay) -> None:
    relay.busy = True
    relay.write_record("HR_1", b"x" * 3 * BLOCK_BYTES)
    with bench.session():
        assert eventually(lambda: bench.recording("HR_1") is not None)
        time.sleep(1.0)  # it is asked for again and again
        relay.busy = False
        assert eventually(lambda: bench.is_stored("HR_1"))
    assert bench.repository.link_figures(NAME).day_bytes == 4 * BLOCK_BYTES, "with a block for the .CFG"


def test_a_name_that_cannot_be_trusted_is_an_alarm_while_it_is_listed(
    bench: Bench, relay: ScriptedRelay
) -> None:
    hostile = relay.events / "HR_1\x1b[2J.CFG"
    hostile.write_bytes(b"clears the screen of whoever reads the log")
    relay.write_record("HR_2")
    with bench.session():
        assert eventually(lambda: bench.is_stored("HR_2"))
    with bench.session():
        assert eventually(lambda: bench.link() is LinkState.UP)
        (subject,) = bench.alarms()[AlarmKind.FILE_REFUSED]
        assert subject == "'EVENTS/HR_1\\x1b[2J.CFG'"
        hostile.unlink()
        assert eventually(lambda: bench.alarms() == {})
    assert len(bench.repository.alarms(limit=10).items) == 1, "a restart raises no second one"


def test_a_record_that_grows_for_ever_is_an_alarm_until_it_stops(bench: Bench, relay: ScriptedRelay) -> None:
    bench.with_record_policy(replace(RECORD_POLICY, unsteady_s=0.5))
    relay.write_file("HR_1.CFG", b"configuration")
    size = 0
    with bench.session():
        deadline_s = time.monotonic() + 20
        while bench.alarms() == {} and time.monotonic() < deadline_s:
            size += 1
            relay.write_file("HR_1.DAT", b"x" * size)
            time.sleep(0.03)  # the relay writes faster than anybody looks
        assert bench.alarms() == {AlarmKind.FILE_UNSTEADY: ["HR_1"]}
        assert bench.recordings() == []
        assert eventually(lambda: bench.is_stored("HR_1"))
        assert eventually(lambda: bench.alarms() == {})
    recording = bench.recording("HR_1")
    assert recording is not None
    assert recording.size_bytes == size + len(b"configuration")


def shifty(bench: Bench) -> list[RecordingState]:
    return [recording.state for recording in bench.recordings() if recording.name == "SHIFTY"]


def test_a_record_of_another_size_at_each_look_is_asked_for_a_few_times_only(
    bench: Bench, relay: ScriptedRelay
) -> None:
    bench.with_record_policy(replace(RECORD_POLICY, wrong_listings_a_day=3))
    relay.shifts = True
    relay.write_record("SHIFTY")
    with bench.session():
        assert eventually(lambda: bench.alarms() == {AlarmKind.FILE_UNSTEADY: ["SHIFTY"]})
        relay.write_record("HR_2")
        assert eventually(lambda: bench.is_stored("HR_2")), "the others do not suffer"
        assert eventually(lambda: shifty(bench) == [RecordingState.REJECTED] * 3)
        assert all("before it could be pulled" in (r.reason or "") for r in bench.recordings() if r.reason)
    relay.shifts = False
    with bench.session():
        assert eventually(lambda: bench.is_stored("SHIFTY"))
        assert eventually(lambda: bench.alarms() == {})


def test_a_record_discarded_before_it_was_pulled_is_told_and_may_come_back(
    bench: Bench, relay: ScriptedRelay
) -> None:
    relay.busy = True
    relay.write_record("HR_1")
    with bench.session():
        assert eventually(lambda: bench.recording("HR_1") is not None)
        files = {path: path.read_bytes() for path in relay.events.iterdir()}
        for path in files:
            path.rename(relay.root / path.name)
        assert eventually(lambda: [r.state for r in bench.recordings()] == [RecordingState.REJECTED])
        (gone,) = bench.recordings()
        assert gone.reason == "HR_1: the relay discarded or changed it before it could be pulled"
        relay.busy = False
        for path in files:
            (relay.root / path.name).rename(path)
        assert eventually(lambda: bench.is_stored("HR_1"))


def test_nothing_is_deleted_on_a_relay(bench: Bench, relay: ScriptedRelay) -> None:
    relay.write_record("HR_1", b"x" * 200_000)
    relay.write_record("HR_2")
    before = {path: path.read_bytes() for path in relay.events.iterdir()}
    request_id = bench.request()
    with bench.session():
        assert bench.reaches(request_id, RecordingRequestState.FETCHED)
    assert before.items() <= {path: path.read_bytes() for path in relay.events.iterdir()}.items()
    of_clients = {name for name in PROTOTYPES if "Connection_" in name and "file" in name.lower()}
    reading = {"getFileDirectory", "fileOpen", "fileRead", "fileReadAsync", "fileClose"}
    assert {name.partition("_")[2] for name in of_clients} == reading, "there is no way to ask for more"


def test_nothing_is_written_outside_the_store(bench: Bench, relay: ScriptedRelay, tmp_path: Path) -> None:
    for name in (
        "..HR_1.CFG",
        "...CFG",
        "HR 1.CFG",
        "HR_1.CFG.CFG",
        "CON.DAT",
        "\u00fc\u00df.CFG",
        "-rf.CFG",
    ):
        relay.write_file(name, name.encode())
    relay.write_record("HR_2")
    before = {path for path in tmp_path.rglob("*") if path.is_file()}
    with bench.session():
        assert eventually(lambda: bench.is_stored("HR_2"))
    written = {path for path in tmp_path.rglob("*") if path.is_file()} - before
    data = bench.settings.data_directory
    assert {path for path in written if bench.store.root not in path.parents} <= set(data.glob("*.sqlite*"))
