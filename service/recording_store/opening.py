"""Opens the store of the recordings that the settings name: a folder, or a bucket."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from service.configuration.recordings_url import BucketPlace
from service.configuration.settings import Settings
from service.recording_store.bucket import BucketStore
from service.recording_store.bucket_client import endpoint_problem, has_boto3, require_boto3
from service.recording_store.errors import StoreError
from service.recording_store.folder import FolderStore
from service.recording_store.store import RecordingStore

SCRATCH = "arriving"
"""The folder of the data directory through which files pass on their way from and to a bucket."""

SHARE_THEM = "use those of the service (setting recordings_directory or recordings_url)"

BACK_UP_OTHERWISE = (
    "back up the database by its own tools first (pg_dump), and then the bucket (its versions, a replica, or "
    "a copy such as `aws s3 sync`)"
)
"""In this order each recording that the copied database names is in the copied bucket, too."""


def open_store(settings: Settings, writer: str = "service") -> RecordingStore:
    """Open the store as a writer whose name no other process has at the same time, and this one again later.

    A bucket is not asked before it is needed. Raises OSError (StoreError where its library is missing).
    """
    require_usable(settings)
    if settings.recordings_url is None:
        return FolderStore(settings.recordings_directory, writer)
    return BucketStore(BucketPlace.of(settings.recordings_url), settings.data_directory / SCRATCH / writer)


def open_store_anywhere(settings: Settings) -> RecordingStore:
    """Open the store for readers on whatever host, which have no data directory. Raises OSError."""
    require_usable(settings)
    if settings.recordings_url is None:
        return FolderStore(settings.recordings_directory)
    return BucketStore(BucketPlace.of(settings.recordings_url), None)


def open_shared_store(settings: Settings, writer: str) -> RecordingStore:
    """Open the store that a service elsewhere has made. Raises StoreError where there is none."""
    root = settings.recordings_directory
    if settings.recordings_url is None and (not root.is_dir() or not any(root.iterdir())):
        raise StoreError(
            f"{root}: expected the recordings of the service, found none: mount the folder in which the "
            f"service keeps them, or {SHARE_THEM}"
        )
    store = open_store(settings, writer)
    if (problem := store.problem()) is not None:
        raise StoreError(f"{problem}; {SHARE_THEM}")
    return store


def require_usable(settings: Settings) -> None:
    """Raise StoreError where the program lacks what the store needs."""
    if settings.recordings_url is not None:
        require_boto3()


def store_warnings(settings: Settings) -> Sequence[str]:
    """Return what is odd about the way to the store, as this process finds it. Nobody is asked."""
    if settings.recordings_url is None or not has_boto3():
        return ()
    problem = endpoint_problem()
    return () if problem is None else (f"recordings_url: {problem}",)


def own_folders(settings: Settings) -> Mapping[str, Path]:
    """Return the folders beside the data directory that this host has to write to, by their settings."""
    if settings.recordings_url is None:
        return {"recordings_directory": settings.recordings_directory}
    return {}


def folder_of(settings: Settings) -> Path:
    """Return the folder of the recordings, for back-ups. Raises StoreError where they are in a bucket."""
    if settings.recordings_url is not None:
        raise StoreError(
            f"{settings.recordings_url}: expected the recordings in a folder, found them in an S3-compatible "
            f"store, which back-ups of StatorWatch do not cover: {BACK_UP_OTHERWISE}"
        )
    return settings.recordings_directory
