"""Recordings that an S3-compatible store keeps, as the API brings them and tells that the store is away."""

import io
import logging
import zipfile
from collections.abc import MutableMapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from service.api import ApiContext, create_app
from service.configuration.recordings_url import BucketPlace
from service.recording_store.bucket import BucketStore
from service.recording_store.bucket_client import forget_clients
from testing.service.s3_server import SECRET, Fault, S3Server
from tests.service.api.recordings.test_recordings import FILES, upload
from tests.service.api.serving import serving


def test_the_store_is_told_to_be_away_and_its_credentials_to_nobody(
    context: ApiContext,
    s3: S3Server,
    place: BucketPlace,
    tmp_path: Path,
    logs: list[MutableMapping[str, Any]],
    caplog: pytest.LogCaptureFixture,
) -> None:
    store = BucketStore(place, tmp_path / "arriving")
    app = create_app(replace(context, store=store, readiness={"recordings": store.problem}))
    said: list[str] = []
    forget_clients()  # those to come tell the log where their credentials are from
    with caplog.at_level(logging.INFO, logger="botocore"), serving(app) as client:
        recording = upload(client, FILES)[1]["id"]
        assert client.get(f"/api/v1/recordings/{recording}/waveform").json()["channels"]
        archive = zipfile.ZipFile(io.BytesIO(client.get(f"/api/v1/recordings/{recording}/file").content))
        assert {name: archive.read(name) for name in archive.namelist()} == FILES
        assert client.get("/readyz").json()["parts"]["recordings"] == "ready"
        for fault, words in ((Fault.BUSY, "SlowDown"), (Fault.DENIED, "AccessDenied")):
            s3.fail(fault)
            ready = client.get("/readyz")
            assert ready.status_code == 503
            assert words in ready.json()["parts"]["recordings"]
            answer = client.get(f"/api/v1/recordings/{recording}/waveform")
            assert answer.status_code == 503
            assert words in answer.json()["detail"]
            said += [ready.text, answer.text, str(ready.headers), str(answer.headers)]
    said += [str(logs), caplog.text]
    assert "credentials in environment" in caplog.text
    assert not [text for text in said if SECRET in text]
