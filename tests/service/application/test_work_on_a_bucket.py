"""A service, a relay, and workers on another host, with all recordings in a bucket of a real server.

Its parts are tested by themselves: the relay's (collector/records/test_store_away.py), the worker's
(test_rediagnosis.py), the API's (api/recordings/test_recordings_in_a_bucket.py).
"""

import io
import zipfile
from pathlib import Path

import pytest

from service.client.rest_client import ServiceClient
from service.configuration.recordings_url import BucketPlace
from service.storage import Repository, connect
from service.storage.states import RecordingState
from testing.service.processes import (
    running_service,
    simulated_plant,
)
from testing.service.s3_server import Fault, S3Server
from testing.waiting import wait_until
from tests.service.application.working import workers

START_LIMIT_S = 120.0
RELAY, MOTOR = "A1_SEL710", "PUMP-A1"


@pytest.mark.campaign
@pytest.mark.timeout(600)  # a simulator, a service and a host of workers load the numbers
def test_a_record_comes_by_the_bucket_to_the_other_host_and_to_the_page(
    tmp_path: Path, postgresql_url: str, s3: S3Server, place: BucketPlace
) -> None:
    settings = {
        "MCC_DATABASE_URL": postgresql_url,
        "MCC_WORKERS": "1",
        "MCC_RECORDINGS_URL": str(place),
        "MCC_POLL_PERIOD_S": "0.5",
    }
    engine = connect(postgresql_url)
    repository = Repository(engine)
    (tmp_path / "service").mkdir()
    with (
        simulated_plant(tmp_path, [RELAY]) as plant,
        running_service(tmp_path / "service", plant.scd, **settings) as service,
        ServiceClient(service.url) as client,
        workers(tmp_path / "host", {**settings, "MCC_SCD": str(plant.scd)}) as host,
    ):
        wait_until(lambda: len(repository.job_runners()) == 2, within_s=START_LIMIT_S)
        by_host = next(one.id for one in repository.job_runners() if one.process_id == host.pid)
        assert by_host
        # The store is away while the relay records: the record waits in the relay.
        s3.fail(Fault.BUSY)
        wait_until(lambda: "SlowDown" in (client.what_is_not_ready() or ""), within_s=60)
        client.request_recording(MOTOR)
        wait_until(lambda: plant.records(), within_s=60)
        wait_until(
            lambda: [one.state for one in repository.recordings(limit=5).items] == [RecordingState.ANNOUNCED],
            within_s=60,
        )
        s3.fail(Fault.NONE)
        wait_until(
            lambda: [one.state for one in repository.recordings(limit=5).items] == [RecordingState.DIAGNOSED],
            within_s=120,
        )
        (recording,) = repository.recordings(limit=5).items
        waveform = client.get(f"/recordings/{recording.id}/waveform")
        assert waveform["channels"]
        with client.download_recording(recording.id) as file:
            archive = zipfile.ZipFile(io.BytesIO(file.read()))
        relayed = {path.name.upper(): path.read_bytes() for path in plant.events(RELAY).iterdir()}
        assert {name: archive.read(name) for name in archive.namelist()} == relayed
        assert not (service.data / "recordings").exists()
        assert list((service.data / "arriving").glob("*/*")) == []
    assert len([key for key in s3.keys_of() if key.startswith(place.prefix)]) == len(relayed)
    engine.dispose()
