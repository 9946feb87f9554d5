"""The files of a recording as a ZIP archive, made while it is sent: it is neither in memory nor on disk."""

import io
import re
import zipfile
from collections.abc import Iterator

from core.time_stamps import SECONDS_END, rfc3339
from service.recording_store.recording import StoredRecording
from service.recording_store.store import RecordingStore
from service.storage.records import RecordingEntry

CHUNK_BYTES = 1 << 16

_UNSAFE = re.compile(r"[^A-Za-z0-9-]+")
"""Some system or header gives these a meaning of their own."""


def file_stem(recording: RecordingEntry) -> str:
    """Return MOTOR_TIME, such as "PUMP-A1_2026-01-31T12-00-00Z", which every system takes as a name.

    The time is that of the recording, or of its announcement where nobody has read it yet.
    """
    time_ns = recording.announced_ns if recording.recorded_ns is None else recording.recorded_ns
    time = rfc3339(time_ns)[:SECONDS_END].replace(":", "-")
    return f"{_UNSAFE.sub('_', recording.motor)}_{time}Z"


def zipped(store: RecordingStore, stored: StoredRecording) -> Iterator[bytes]:
    """Return the archive piece by piece. Raises RecordingStoreError, OSError."""
    sink = _Sink()
    with store.opened(stored.digest) as entry, zipfile.ZipFile(sink, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in stored.files:
            path = entry.with_name(file.name)
            about = zipfile.ZipInfo.from_file(path, arcname=file.name)
            about.compress_type = zipfile.ZIP_DEFLATED
            with path.open("rb") as source, archive.open(about, "w") as packed:
                while chunk := source.read(CHUNK_BYTES):
                    packed.write(chunk)
                    yield sink.taken()
    yield sink.taken()


class _Sink(io.RawIOBase):
    """A file that cannot be wound back; what is written waits until it is taken."""

    def __init__(self) -> None:
        super().__init__()
        self._waiting = bytearray()

    def writable(self) -> bool:
        return True

    def write(self, content: "bytes | bytearray | memoryview", /) -> int:  # type: ignore[override]  # narrower
        self._waiting += content
        return len(content)

    def taken(self) -> bytes:
        """Return what was written since the last time."""
        content = bytes(self._waiting)
        self._waiting.clear()
        return content
