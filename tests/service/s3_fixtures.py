"""A bucket of a server that is a process of its own, and that tests let fail."""

from collections.abc import Iterator

import pytest

from service.configuration.recordings_url import BucketPlace
from service.recording_store import bucket
from service.recording_store.bucket_client import forget_clients
from testing.service.s3_server import BUCKET, Fault, S3Server, serving_s3


@pytest.fixture(scope="session")
def s3_process(tmp_path_factory: pytest.TempPathFactory) -> Iterator[S3Server]:
    """A server for the session."""
    forget_clients()
    with serving_s3(tmp_path_factory.mktemp("s3")) as server:
        yield server
    forget_clients()


@pytest.fixture
def s3(s3_process: S3Server, monkeypatch: pytest.MonkeyPatch) -> Iterator[S3Server]:
    """The server, in order, and this process told of it. The store is asked whenever it is to be told of."""
    for name, value in s3_process.environment.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setattr(bucket, "LOOK_AGAIN_S", 0.0)
    s3_process.fail(Fault.NONE)
    yield s3_process
    s3_process.fail(Fault.NONE)


@pytest.fixture
def new_clients() -> Iterator[None]:
    """Have clients look into the environment that the test makes, and those after it into theirs."""
    forget_clients()
    yield
    forget_clients()


@pytest.fixture
def place(request: pytest.FixtureRequest) -> BucketPlace:
    """A place of the test's own."""
    return BucketPlace.of(f"s3://{BUCKET}/{request.node.name.partition('[')[0]}-{id(request.node)}")
