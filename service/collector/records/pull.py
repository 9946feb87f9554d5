"""Pulls one record from a relay into the recording store: every byte of every file, or nothing."""

from collections.abc import Callable
from typing import BinaryIO

from mms import Client
from service.collector.records.listing import ListedRecord
from service.recording_store.store import RecordingStore, StoredRecording


class RecordTooLargeError(ValueError):
    """The relay lists a file that is larger than a setting allows."""


class _Counted:
    """A file that reports how much was written to it."""

    def __init__(self, sink: BinaryIO, on_bytes: Callable[[int], None]) -> None:
        self._sink = sink
        self._on_bytes = on_bytes

    def write(self, chunk: bytes, /) -> None:
        self._sink.write(chunk)
        self._on_bytes(len(chunk))


def pull(
    client: Client,
    record: ListedRecord,
    store: RecordingStore,
    *,
    max_file_bytes: int,
    on_bytes: Callable[[int], None],
) -> StoredRecording:
    """Stream the files of one record into the store; `on_bytes` gets the size of every part that came.

    The store keeps the record only when all files are there. Raises RecordTooLargeError, MmsError
    (FileSizeMismatch when a file is not as long as listed), RecordingStoreError for a name the store refuses,
    OSError when the disk does.
    """
    for file in record.files:
        if file.size > max_file_bytes:
            raise RecordTooLargeError(
                f"{file.local_name}: expected at most {max_file_bytes} bytes (setting max_file_bytes), "
                f"found {file.size}"
            )
    with store.incoming() as incoming:
        for file in record.files:
            with incoming.create(file.local_name) as sink:
                client.download(file.remote_name, _Counted(sink, on_bytes), expected_size=file.size)
        return incoming.keep()
