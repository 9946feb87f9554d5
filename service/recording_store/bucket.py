"""Recordings in a bucket of an S3-compatible store.

    <prefix><digest[:2]>/<digest>/C_0001.CFG, C_0001.DAT, C_0001.HDR
    <prefix>unknown/<digest>/...                  which the database does not know

An object is seen once it is whole, and a key that has a digest never gets another content. So nobody needs a
lock to store: the same record is put to the same keys. A record is there when all of its objects are, which
whoever adds its row asks for while nobody may delete it. Files pass through a folder of this host.
"""

import shutil
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from functools import partial
from itertools import groupby
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Lock

from service.configuration.recordings_url import BucketPlace
from service.recording_store.arriving import Incoming
from service.recording_store.bucket_client import Bucket, ObjectGoneError, StoredObject
from service.recording_store.contents import (
    ENTRY_SUFFIXES,
    StoredFile,
    entry_name,
    is_digest,
    is_stored_name,
    manifest_digest,
    require_digest,
)
from service.recording_store.errors import RecordingStoreError, StoreError
from service.recording_store.recording import StoredRecording
from service.recording_store.store import RecordingStore
from service.recording_store.unknown_folders import APART, Folder

MOST_FILES = 100
"""A record has two or three."""
MOST_BYTES = 4 << 30
"""Of a record: more is none of ours, and would fill the disk of whoever reads it."""
LOOK_AGAIN_S = 5.0
"""So long it counts what the store has answered when it was last asked whether it is there."""


class BucketStore(RecordingStore):
    """Objects below a place. Several processes and hosts may store at once.

    scratch: a folder of this host that no other process uses at the same time, through which files pass, and
    that is cleared by `discard_incoming`; None for the system's folder of temporary files.
    """

    def __init__(self, place: BucketPlace, scratch: Path | None) -> None:
        self._place = place
        self._scratch = scratch
        self._bucket = Bucket(place)
        self._looking = Lock()
        self._looked_s: float | None = None
        self._problem: str | None = None
        if scratch is not None:
            scratch.mkdir(parents=True, exist_ok=True)

    def __reduce__(self) -> tuple[type["BucketStore"], tuple[BucketPlace, Path | None]]:
        """Let a process that gets it connect by itself."""
        return BucketStore, (self._place, self._scratch)

    @property
    def place(self) -> str:
        return str(self._place)

    @property
    def written(self) -> tuple[Path, ...]:
        return () if self._scratch is None else (self._scratch,)

    @property
    def unknown(self) -> "UnknownObjects":
        return UnknownObjects(self._bucket, f"{self._place}/{APART}")

    def problem(self) -> str | None:
        """Ask for one key at most, now and then: it is asked by many, and often."""
        with self._looking:
            if self._looked_s is None or time.monotonic() >= self._looked_s + LOOK_AGAIN_S:
                self._problem = self._found_problem()
                self._looked_s = time.monotonic()
            return self._problem

    def _found_problem(self) -> str | None:
        try:
            list(self._bucket.objects("", most=1))
        except StoreError as error:
            return str(error)
        return None

    @contextmanager
    def incoming(self) -> Iterator[Incoming]:
        with _folder(self._scratch) as directory, closing(Incoming(directory, self._keep)) as incoming:
            yield incoming

    def find(self, digest: str) -> StoredRecording:
        with _folder(self._scratch) as directory:
            return self._stored(digest, _fetched(self._bucket, self.place, digest, directory))

    def source(self, digest: str) -> "BucketSource":
        return BucketSource(self._place, require_digest(digest), self._scratch)

    def discard_incoming(self) -> int:
        left_over = [] if self._scratch is None else list(self._scratch.iterdir())
        for directory in left_over:
            shutil.rmtree(directory)
        return len(left_over)

    def set_aside(self, digest: str) -> None:
        for one in list(self._bucket.objects(_folder_key(digest))):
            self._bucket.delete(one.key)

    def remove_set_aside(self, digest: str | None = None) -> None:
        """Do nothing: what was set aside is gone."""

    def _keep(self, arrived: Path, digest: str, files: tuple[StoredFile, ...]) -> StoredRecording:
        """Put the files there, that by which others know a record last."""
        for file in sorted(files, key=lambda one: Path(one.name).suffix in ENTRY_SUFFIXES):
            self._bucket.put(_folder_key(digest) + file.name, arrived / file.name)
        return self._stored(digest, files)

    def _stored(self, digest: str, files: tuple[StoredFile, ...]) -> StoredRecording:
        return StoredRecording(digest, files, partial(self._has_all, digest, files))

    def _has_all(self, digest: str, files: tuple[StoredFile, ...]) -> bool:
        folder = _folder_key(digest)
        found = {(one.key, one.size_bytes) for one in self._bucket.objects(folder, most=MOST_FILES)}
        return found >= {(folder + file.name, file.size_bytes) for file in files}


@dataclass(frozen=True, slots=True)
class BucketSource:
    """Names a record in a bucket; whoever opens it fetches it, on whatever host."""

    place: BucketPlace
    digest: str
    scratch: Path | None

    @contextmanager
    def opened(self) -> Iterator[Path]:
        """Provide the files while the block lasts. They are those that were stored, byte by byte."""
        with _folder(self.scratch) as directory:
            files = _fetched(Bucket(self.place), str(self.place), self.digest, directory)
            yield directory / entry_name(file.name for file in files)

    def is_seen_here(self) -> bool:
        """Tell that it is: every host asks the store."""
        return True


class UnknownObjects:
    """The folders of a bucket. Those out of the way are copied first: a crash leaves them in both places."""

    def __init__(self, bucket: Bucket, apart: str) -> None:
        self._bucket = bucket
        self.apart = apart

    def stored(self, prefix: str) -> Iterator[Folder]:
        return self._folders(f"{prefix}/")

    def set_apart(self) -> Iterator[Folder]:
        return self._folders(f"{APART}/")

    def move_apart(self, digest: str) -> None:
        self._move(_folder_key(digest), f"{APART}/{digest}/")

    def put_back(self, digest: str) -> None:
        self._move(f"{APART}/{require_digest(digest)}/", _folder_key(digest))

    def remove(self, digest: str) -> None:
        for one in list(self._bucket.objects(f"{APART}/{require_digest(digest)}/")):
            self._bucket.delete(one.key)

    def _move(self, source: str, target: str) -> None:
        objects = list(self._bucket.objects(source))
        if not objects:
            raise FileNotFoundError(f"{source}: expected the files of a recording, found none")
        try:
            for one in objects:
                self._bucket.copy(one.key, target + one.key.removeprefix(source))
        except ObjectGoneError as error:  # somebody else has moved or deleted it
            raise FileNotFoundError(str(error)) from error
        for one in objects:
            self._bucket.delete(one.key)

    def _folders(self, below: str) -> Iterator[Folder]:
        def digest_of(one: StoredObject) -> str:
            return one.key.removeprefix(below).partition("/")[0]

        for digest, objects in groupby(self._bucket.objects(below), digest_of):
            if not is_digest(digest):  # whoever put it there may need it
                continue
            found = list(objects)
            yield Folder(digest, max(one.since_s for one in found), sum(one.size_bytes for one in found))


def objects_in(place: BucketPlace) -> Iterator[tuple[StoredObject, bool]]:
    """Yield all objects below a place, and whether each is a file of a record, also of one set apart.

    Raises StoreError.
    """
    for one in Bucket(place).objects(""):
        yield one, _is_of_record(one.key)


def _is_of_record(key: str) -> bool:
    folder, _, rest = key.partition("/")
    digest, _, name = rest.partition("/")
    return is_digest(digest) and folder in (digest[:2], APART) and is_stored_name(name)


def _fetched(bucket: Bucket, place: str, digest: str, directory: Path) -> tuple[StoredFile, ...]:
    """Fetch the files of a record. Raises RecordingStoreError where they are missing or not those stored."""
    folder = _folder_key(digest)
    objects = list(bucket.objects(folder, most=MOST_FILES + 1))
    if not objects:
        raise RecordingStoreError(f"recording {digest}: its files are missing from {place}")
    size_bytes = sum(one.size_bytes for one in objects)
    if len(objects) > MOST_FILES or size_bytes > MOST_BYTES:
        raise RecordingStoreError(
            f"recording {digest}: expected at most {MOST_FILES} files and {MOST_BYTES} bytes in {place}, "
            f"found {len(objects)} and {size_bytes}"
        )
    names = [one.key.removeprefix(folder) for one in objects]
    for name in names:
        if not is_stored_name(name):
            raise RecordingStoreError(
                f"recording {digest}: expected files such as C_0001.CFG in {place}, found {name[:100]!r}"
            )
    files = []
    for name, one in zip(names, objects, strict=True):
        with (directory / name).open("xb") as sink:
            files.append(StoredFile(name, one.size_bytes, bucket.get(one.key, one.size_bytes, sink)))
    if manifest_digest(files) != digest:
        raise RecordingStoreError(f"recording {digest}: its files in {place} are not those stored")
    return tuple(files)


def _folder_key(digest: str) -> str:
    return f"{require_digest(digest)[:2]}/{digest}/"


@contextmanager
def _folder(scratch: Path | None) -> Iterator[Path]:
    """Provide an empty folder of this host while the block lasts."""
    with TemporaryDirectory(prefix="recording-", dir=scratch, ignore_cleanup_errors=True) as directory:
        yield Path(directory)
