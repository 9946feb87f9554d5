"""Stores of both kinds: a folder, and a bucket of a server that is a process of its own."""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from service.configuration.recordings_url import BucketPlace
from service.recording_store import bucket, bucket_client
from service.recording_store.bucket import BucketStore
from service.recording_store.bucket_client import forget_clients
from service.recording_store.folder import FolderStore
from service.recording_store.store import RecordingStore
from testing.service.s3_server import BUCKET, Fault, S3Server, serving_s3

StoreMaker = Callable[[str], RecordingStore]
"""Opens the same place for a writer of this name."""


@pytest.fixture(scope="session")
def s3_process(tmp_path_factory: pytest.TempPathFactory) -> Iterator[S3Server]:
    with serving_s3(tmp_path_factory.mktemp("s3")) as server:
        yield server


@pytest.fixture
def s3(s3_process: S3Server, monkeypatch: pytest.MonkeyPatch) -> Iterator[S3Server]:
    """The server, in order, and this process told of it; limits of time that a test can wait for."""
    for name, value in s3_process.environment.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setattr(bucket, "LOOK_AGAIN_S", 0.0)
    forget_clients()
    s3_process.fail(Fault.NONE)
    yield s3_process
    s3_process.fail(Fault.NONE)
    forget_clients()


@pytest.fixture
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("ANSWER_S", "QUICK_ANSWER_S"):
        monkeypatch.setattr(bucket_client, name, 2.0)
    forget_clients()


@pytest.fixture
def place(request: pytest.FixtureRequest) -> BucketPlace:
    """A place of the test's own."""
    return BucketPlace.of(f"s3://{BUCKET}/{request.node.name.partition('[')[0]}-{id(request.node)}")


@pytest.fixture
def in_bucket(s3: S3Server, place: BucketPlace, tmp_path: Path) -> BucketStore:
    return BucketStore(place, tmp_path / "arriving" / "service")


@pytest.fixture(params=["folder", "bucket"])
def opened_by(request: pytest.FixtureRequest, tmp_path: Path) -> StoreMaker:
    if request.param == "folder":
        return lambda writer: FolderStore(tmp_path / "recordings", writer)
    request.getfixturevalue("s3")
    place = request.getfixturevalue("place")
    return lambda writer: BucketStore(place, tmp_path / "arriving" / writer)


@pytest.fixture
def store(opened_by: StoreMaker) -> RecordingStore:
    return opened_by("service")
