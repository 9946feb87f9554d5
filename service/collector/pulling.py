"""One record from a relay to the recording store: every file, every byte, or nothing."""

from mms import Client
from service.collector.listing import ListedRecord
from service.recordings import RecordingStore, StoredRecording


class RecordTooLargeError(ValueError):
    """The relay lists a file that is larger than a setting allows."""


def pull(
    client: Client, record: ListedRecord, store: RecordingStore, *, max_file_bytes: int
) -> StoredRecording:
    """Stream the files of one record into the store.

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
                client.download(file.remote_name, sink, expected_size=file.size)
        return incoming.keep()
