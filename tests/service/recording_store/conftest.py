"""Stores of both kinds: a folder, and a bucket of a server that is a process of its own."""

from collections.abc import Callable
from pathlib import Path

import pytest

from service.configuration.recordings_url import BucketPlace
from service.recording_store.bucket import BucketStore
from service.recording_store.folder import FolderStore
from service.recording_store.store import RecordingStore
from testing.service.s3_server import S3Server

StoreMaker = Callable[[str], RecordingStore]
"""Opens the same place for a writer of this name."""


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


@pytest.fixture
def known(store: RecordingStore, request: pytest.FixtureRequest, tmp_path: Path) -> Callable[[], set[str]]:
    """The digests of the records at their places, as somebody finds them who looks there."""
    if isinstance(store, FolderStore):
        return lambda: {folder.name for folder in (tmp_path / "recordings").glob("??/*")}
    server: S3Server = request.getfixturevalue("s3")
    prefix = request.getfixturevalue("place").prefix

    def in_the_bucket() -> set[str]:
        parts = [key.removeprefix(prefix).split("/") for key in server.keys_of() if key.startswith(prefix)]
        return {digest for folder, digest, _ in parts if len(folder) == len("ab")}

    return in_the_bucket
