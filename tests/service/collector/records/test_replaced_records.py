"""A relay that writes a record over an old one while that is fetched: nothing mixed is stored."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from core.recordings import read
from ied_sim.misbehaviour import Kind, Misbehaviour
from mms import FileAnswer, FileOperation, FileRequest
from service.storage.states import LinkState, RecordingRequestState
from testing.relays.simulated import IED, scenario_of, simulated
from testing.waiting import eventually
from tests.service.collector.conftest import Bench
from tests.service.collector.expectations import at, expecting
from tests.service.collector.records.policies import with_first_pause
from tests.service.collector.scripted_relay import ScriptedRelay


@pytest.mark.parametrize("profile", ["sel-710-ed2", "rdre"])
def test_a_record_replaced_between_its_files_is_fetched_again(
    bench: Bench, tmp_path: Path, profile: str
) -> None:
    scenario = scenario_of(profile, Misbehaviour(Kind.RECORD_REPLACED, 2.0, at_s=0.0))
    assert scenario.profile.files is not None
    with simulated(tmp_path / "relays", scenario) as served:
        here = at(expecting(bench, served.document.ied(IED)), served)
        with here.session() as session:
            assert eventually(lambda: here.link() is LinkState.UP)
            request_id = here.request()
            session.wake()
            assert eventually(lambda: here.requested(request_id).state is RecordingRequestState.FETCHED, 30)
        recordings = [each for each in here.recordings() if each.digest is not None]
        assert len(recordings) == 1
        stored = here.store.find(recordings[0].digest or "")
        folder = tmp_path / "relays" / IED / scenario.profile.files.folder
        for file in here.store.directory(stored.digest).iterdir():
            assert file.read_bytes() == (folder / file.name).read_bytes()
        assert np.array_equal(
            read(here.store.entry(stored.digest)).samples, read(folder / stored.entry_name).samples
        )


def test_records_of_two_folders_are_fetched(bench: Bench, tmp_path: Path) -> None:
    scenario = scenario_of("sel-710-ed2", Misbehaviour(Kind.TWO_FOLDERS, at_s=0.0))
    with simulated(tmp_path / "relays", scenario) as served:
        here = at(expecting(bench, served.document.ied(IED)), served)
        with here.session() as session:
            for _ in range(2):
                request_id = here.request()
                session.wake()
                assert here.reaches(request_id, RecordingRequestState.FETCHED)
            assert here.repository.relay(here.relay.name).link_reason is None
        folders = {path.parent.name for path in (tmp_path / "relays" / IED).glob("*/*.DAT")}
        assert folders == {"EVENTS", "COMTRADE"}
        assert len(here.recordings()) == 2


def test_a_record_without_times_is_told_by_its_configuration(bench: Bench, relay: ScriptedRelay) -> None:
    """Listed without a time, another record of the same sizes looks the same."""
    written = iter(range(10))

    def overwrite(request: FileRequest) -> FileAnswer | None:
        if request.operation is FileOperation.OPEN and request.path.suffix == ".DAT":
            number = next(written)
            if number < 2:
                relay.write_untimed("HR_1.DAT", b"samples %d" % number)
                relay.write_untimed("HR_1.CFG", b"configuration %d" % number)
        return None

    relay.write_untimed("HR_1.DAT", b"samples X")
    relay.write_untimed("HR_1.CFG", b"configuration X")
    relay.on_file_request = overwrite
    with bench.with_record_policy(with_first_pause(0.005)).session():
        assert eventually(lambda: bench.is_stored("HR_1"))
    (recording,) = bench.recordings()
    assert recording.digest is not None
    directory = bench.store.directory(recording.digest)
    assert (directory / "HR_1.CFG").read_bytes() == b"configuration 1"
    assert (directory / "HR_1.DAT").read_bytes() == b"samples 1"


def test_fetched_records_are_kept_before_one_that_failed_is_tried(bench: Bench, relay: ScriptedRelay) -> None:
    """A file that ends the link again and again takes no other record with it."""
    relay.stuck.add("HR_1")
    relay.write_record("HR_1", report=False)
    for number in range(2, 6):
        relay.write_record(f"HR_{number}", report=False)
    policy = replace(with_first_pause(0.005), settle_s=0.0)
    with bench.with_record_policy(policy).with_settings(request_timeout_s=0.3).session():
        assert eventually(lambda: all(bench.is_stored(f"HR_{number}") for number in range(2, 6)), 30)
