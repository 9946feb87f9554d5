"""Records wait in their relay while the place of the recordings is away."""

from pathlib import Path

from service.configuration.recordings_url import BucketPlace
from service.recording_store.bucket import BucketStore
from service.storage.states import RecordingState
from testing.service.s3_server import Fault, S3Server
from testing.waiting import eventually
from tests.service.collector.conftest import Bench
from tests.service.collector.scripted_relay import ScriptedRelay


def test_a_record_waits_in_its_relay_until_the_bucket_is_there_again(
    bench: Bench, relay: ScriptedRelay, s3: S3Server, place: BucketPlace, tmp_path: Path
) -> None:
    bench.kept_in = store = BucketStore(place, tmp_path / "arriving")
    s3.fail(Fault.BUSY)
    with bench.session():
        relay.write_record("HR_1")
        assert eventually(lambda: bench.recording("HR_1") is not None)
        assert [one.state for one in bench.recordings()] == [RecordingState.ANNOUNCED]
        assert bench.alarms() == {}
        s3.fail(Fault.NONE)
        assert eventually(lambda: bench.is_stored("HR_1"))
    (recording,) = bench.recordings()
    assert recording.digest is not None
    assert {file.name for file in store.find(recording.digest).files} == {"HR_1.CFG", "HR_1.DAT"}
    assert list((tmp_path / "arriving").iterdir()) == []
