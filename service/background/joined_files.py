"""Join the recordings of a series in a worker process."""

from dataclasses import dataclass
from zoneinfo import ZoneInfo

from core.recordings import RecordingError, read
from core.recordings.comtrade.writer import combined_bytes
from core.recordings.joining import join_longest
from core.recordings.local_time import in_utc
from service.recording_store.errors import RecordingStoreError
from service.recording_store.recording import Source


@dataclass(frozen=True, slots=True)
class JoinTask:
    """Name the recordings of a series, in the order of time, and how much is wanted of it.

    time_zone: IANA name of the zone in which the relay's clock runs; None for UTC.
    recorded_ns: when each was recorded [ns UTC].
    lenient: whether faults of their files are mended.
    """

    recordings: tuple[Source, ...]
    recorded_ns: tuple[int, ...]
    time_zone: str | None = None
    lenient: bool = False


@dataclass(frozen=True, slots=True)
class JoinedFile:
    """Hold a joined record as a combined COMTRADE file.

    name: that of its first part.  parts: which of the recordings it is made of.
    duration_s: its length.  refusals: why it has no more of them.
    """

    content: bytes
    name: str
    parts: tuple[int, ...]
    duration_s: float
    refusals: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class NotJoined:
    """Say why no two of the records can be joined."""

    reason: str


def join_files(task: JoinTask) -> JoinedFile | NotJoined:
    """Read the records of a series and join the longest run of them that belongs together. Raises OSError."""
    try:
        recordings, names = [], []
        for source in task.recordings:
            with source.opened() as entry:
                recordings.append(read(entry, lenient=task.lenient))
                names.append(entry.stem)
        if task.time_zone is not None:
            zone = ZoneInfo(task.time_zone)
            recordings = [
                in_utc(one, zone, near_ns) for one, near_ns in zip(recordings, task.recorded_ns, strict=True)
            ]
    except (RecordingError, RecordingStoreError) as error:
        return NotJoined(str(error))
    joined = join_longest(recordings)
    if len(joined.parts) < 2:
        return NotJoined("; ".join(joined.refusals) or "there is one record alone")
    content = combined_bytes(joined.recording, data_format="FLOAT32")
    return JoinedFile(
        content, names[joined.parts[0]], joined.parts, joined.recording.duration_s, joined.refusals
    )
