"""One event, one recording, in whatever formats a relay writes it; and files that are no recording."""

from dataclasses import replace
from pathlib import Path

import pytest

from core.recordings import read
from service.collector.records.formats import one_format_an_event
from service.collector.records.life import Life, RecordState
from service.collector.records.listing import FolderListing, understand
from service.storage.states import AlarmKind, RecordingRequestState, RecordingState
from testing.relays.simulated import IED, scenario_of, simulated
from testing.waiting import eventually
from tests.service.collector.conftest import Bench
from tests.service.collector.expectations import at, expecting
from tests.service.collector.records.policies import WRONG_IN_A_ROW, with_first_pause
from tests.service.collector.records.test_listing import Entry, listed, understood
from tests.service.collector.scripted_relay import NAME, ScriptedRelay


def states_of(*names: str) -> list[RecordState]:
    return [RecordState(record) for record in understood(listed(*names)).records]


def chosen(*names: str) -> list[str]:
    return [state.record.file_names for state in one_format_an_event(states_of(*names)).states]


@pytest.mark.parametrize(
    ("names", "taken"),
    [
        (["CR_10007.CEV"], ["CR_10007.CEV"]),
        (["C4_10007.CEV", "CR_10007.CEV"], ["CR_10007.CEV"]),
        (["CR_10007.CEV", "HR_10007.CFG", "HR_10007.DAT"], ["HR_10007.CFG, HR_10007.DAT"]),
        (["X.CEV", "X.CFF"], ["X.CFF"]),
        (["X.CFF", "X.CFG", "X.DAT"], ["X.CFG, X.DAT"]),
        (["HR_10007.HDR", "CR_10007.CEV"], ["CR_10007.CEV"]),
        (["CR_10007.CEV", "HR_10008.CFG", "HR_10008.DAT"], ["CR_10007.CEV", "HR_10008.CFG, HR_10008.DAT"]),
        (
            [
                "OSC16B007.CFG",
                "OSC16B007.DAT",
                "OSC32F007.CFG",
                "OSC32F007.DAT",
                "OSCA007.CFG",
                "OSCA007.DAT",
            ],
            ["OSC32F007.CFG, OSC32F007.DAT"],
        ),
        (
            ["OSCA007.CFG", "OSCA007.DAT", "OSC16B007.CFG", "OSC16B007.DAT", "OSCA008.CFG", "OSCA008.DAT"],
            ["OSC16B007.CFG, OSC16B007.DAT", "OSCA008.CFG, OSCA008.DAT"],
        ),
        (["DR10007.CEV", "HR_10007.CFG"], ["DR10007.CEV", "HR_10007.CFG"]),
    ],
)
def test_one_format_of_each_event_is_taken(names: list[str], taken: list[str]) -> None:
    assert chosen(*names) == taken


def test_folders_that_number_their_own_events_are_told_apart() -> None:
    names = ["HR_10007.CFG", "HR_10007.DAT"]
    events = FolderListing("EVENTS", [*map(Entry, names), Entry("CR_10007.CEV")])
    comtrade = FolderListing("COMTRADE", [Entry(name, modified_ns=9) for name in names])
    states = [RecordState(record) for record in understand([events, comtrade]).records]
    taken = one_format_an_event(states).states
    assert [(state.record.directory, state.name) for state in taken] == [
        ("EVENTS", "HR_10007"),
        ("COMTRADE", "HR_10007"),
    ]
    assert len(one_format_an_event(states[1:]).states) == 1, "one event in two formats, in two folders"


def report_and_comtrade() -> tuple[RecordState, RecordState]:
    """Of one event."""
    both = states_of("CR_10007.CEV", "HR_10007.CFG", "HR_10007.DAT")
    report, comtrade = sorted(both, key=lambda state: state.name)
    return report, comtrade


def test_what_was_taken_stays_taken() -> None:
    report, comtrade = report_and_comtrade()
    report.life, report.in_store = Life.STORED, True
    kept = one_format_an_event([report, comtrade])
    assert kept.states == (report,)
    assert [(file.name, file.reason) for file in kept.passed_over] == [
        ("HR_10007.CFG, HR_10007.DAT", "the same event as CR_10007.CEV, which is taken")
    ]


def test_a_refused_format_comes_last() -> None:
    report, comtrade = report_and_comtrade()
    assert one_format_an_event([report, comtrade]).replaceable == {comtrade}
    report.life, comtrade.life = Life.INCOMPLETE, Life.REFUSED
    without = one_format_an_event([report, comtrade])
    assert without.states == (report,)
    assert without.replaceable == frozenset(), "the other one is refused"
    report.life = Life.REFUSED
    neither = one_format_an_event([report, comtrade])
    assert neither.states == (comtrade,)
    assert [file.reason for file in neither.passed_over] == [
        "the same event as HR_10007.CFG, HR_10007.DAT, refused, as this is"
    ]


def test_a_relay_of_event_reports_alone(bench: Bench, tmp_path: Path) -> None:
    """A request becomes a stored event report."""
    scenario = scenario_of("sel-710-ed1")
    record = scenario.profile.record.model_copy(update={"formats": ("CEV",)})
    scenario = replace(scenario, profile=scenario.profile.model_copy(update={"record": record}))
    with simulated(tmp_path / "relays", scenario) as served:
        here = at(expecting(bench, served.document.ied(IED)), served)
        request_id = here.request()
        with here.session():
            assert eventually(lambda: here.requested(request_id).state is RecordingRequestState.FETCHED, 20)
    (recording,) = here.recordings()
    assert recording.digest is not None
    stored = here.store.find(recording.digest)
    assert [file.name for file in stored.files] == [f"{recording.name}.CEV"]
    assert {channel.phase for channel in read(here.store.entry(stored.digest)).channels} >= set("abc")


def test_an_event_report_waits_for_its_comtrade(bench: Bench, relay: ScriptedRelay) -> None:
    relay.write_record("HR_10001")
    with bench.session():
        assert eventually(lambda: bench.is_stored("HR_10001"))
        relay.write_file("CR_10002.CEV", b"event report")
        assert not eventually(lambda: bench.recording("CR_10002") is not None, 0.6)
        relay.write_record("HR_10002")
        assert eventually(lambda: bench.is_stored("HR_10002"))
        assert eventually(lambda: "CR_10002.CEV" in ignored(bench))
        relay.write_file("CR_10003.CEV", b"an event report that has no other format")
        assert eventually(lambda: bench.is_stored("CR_10003"))
    assert len(bench.recordings()) == 3


def test_a_comtrade_that_comes_too_late_is_no_second_recording(bench: Bench, relay: ScriptedRelay) -> None:
    relay.write_file("CR_10001.CEV", b"the first this relay ever wrote")
    with bench.session():
        assert eventually(lambda: bench.is_stored("CR_10001"))
        relay.write_record("HR_10001")
        assert eventually(lambda: "HR_10001.CFG, HR_10001.DAT" in ignored(bench))
    with bench.session():  # nor after a restart
        relay.write_record("HR_10002")
        assert eventually(lambda: bench.is_stored("HR_10002"))
    assert sorted(recording.name for recording in bench.recordings()) == ["CR_10001", "HR_10002"]


def test_an_event_report_stands_in_for_a_comtrade_without_its_data(
    bench: Bench, relay: ScriptedRelay
) -> None:
    relay.write_file("HR_10001.CFG", b"configuration alone")
    relay.write_file("CR_10001.CEV", b"event report")
    with bench.session():
        assert eventually(lambda: bench.is_stored("CR_10001"))
    assert [recording.state for recording in bench.recordings()] == [RecordingState.FETCHED]


def states(bench: Bench) -> dict[str, RecordingState]:
    return {recording.name: recording.state for recording in bench.recordings()}


def test_an_event_report_stands_in_for_a_comtrade_too_large(bench: Bench, relay: ScriptedRelay) -> None:
    """The request gets the record, and is not failed by the refusal before."""
    relay.silent = True
    request_id = bench.request()
    with bench.session():
        assert bench.reaches(request_id, RecordingRequestState.TRIGGERED)
        relay.write_file("CR_10007.CEV", b"event report of the same event")
        relay.write_record("HR_10007", b"x" * 200_000)  # larger than max_file_bytes
        assert bench.reaches(request_id, RecordingRequestState.FETCHED), bench.requested(request_id).reason
        assert bench.alarms() == {AlarmKind.FILE_TOO_LARGE: ["HR_10007"]}
        taken = {"HR_10007.CFG, HR_10007.DAT": "the same event as CR_10007.CEV, which is taken"}
        assert eventually(lambda: ignored(bench) == taken)
    assert states(bench) == {"CR_10007": RecordingState.FETCHED, "HR_10007": RecordingState.REJECTED}
    report = bench.recording("CR_10007")
    assert report is not None
    assert bench.requested(request_id).recording_id == report.id
    refused = bench.recording("HR_10007")
    assert refused is not None
    assert "(setting max_file_bytes), found 200000" in (refused.reason or "")
    with bench.session():  # nor is any of it asked for again after a restart
        relay.write_record("HR_10008")
        assert eventually(lambda: bench.is_stored("HR_10008"))
    assert len(bench.recordings()) == 3


def test_a_refusal_of_the_past_hides_no_other_format(bench: Bench, relay: ScriptedRelay) -> None:
    relay.write_record("HR_10007", b"x" * 200_000)
    with bench.session():
        assert eventually(lambda: states(bench) == {"HR_10007": RecordingState.REJECTED})
    relay.write_file("CR_10007.CEV", b"event report of the same event")
    with bench.session():
        assert eventually(lambda: bench.is_stored("CR_10007"))


def test_a_request_fails_where_each_format_is_refused(bench: Bench, relay: ScriptedRelay) -> None:
    relay.silent = True
    request_id = bench.request()
    with bench.session():
        assert bench.reaches(request_id, RecordingRequestState.TRIGGERED)
        relay.write_file("CR_10007.CEV", b"x" * 150_000)
        relay.write_record("HR_10007", b"x" * 200_000)
        assert bench.reaches(request_id, RecordingRequestState.FAILED)
        assert "CR_10007.CEV: expected at most 100000 bytes" in (bench.requested(request_id).reason or "")
        listings = relay.listings
        assert eventually(lambda: relay.listings > listings + 3)
    refused = {"CR_10007": RecordingState.REJECTED, "HR_10007": RecordingState.REJECTED}
    assert states(bench) == refused
    assert len(bench.recordings()) == 2
    assert relay.opened == 0


def test_an_event_report_stands_in_for_a_comtrade_that_is_listed_only(
    bench: Bench, relay: ScriptedRelay
) -> None:
    bench.with_record_policy(with_first_pause(0.002))
    relay.absent = {"HR_10007"}
    relay.write_record("HR_10007")
    relay.write_file("CR_10007.CEV", b"event report of the same event")
    with bench.session():
        assert eventually(lambda: bench.is_stored("CR_10007"))
    refused = bench.recording("HR_10007")
    assert refused is not None
    assert (refused.state, refused.attempts) == (RecordingState.REJECTED, WRONG_IN_A_ROW)
    assert "EVENTS/HR_10007.CFG" in (refused.reason or "")


def test_files_that_are_no_recording_are_told(bench: Bench, relay: ScriptedRelay) -> None:
    relay.write_file("NOTES.TXT", b"nobody knows")
    relay.write_record("HR_1")
    with bench.session():
        assert eventually(lambda: bench.is_stored("HR_1"))
        assert eventually(lambda: list(ignored(bench)) == ["EVENTS/NOTES.TXT"])
        (relay.events / "NOTES.TXT").unlink()
        assert eventually(lambda: ignored(bench) == {})


def ignored(bench: Bench) -> dict[object, object]:
    findings = bench.repository.relay_findings(NAME)
    return {} if findings is None else {file["name"]: file["reason"] for file in findings.ignored_files}
