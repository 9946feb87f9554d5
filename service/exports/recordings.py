"""The table of recordings: which there are, what became of them, and the verdict of each."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

from core.diagnosis.verdict import Verdict
from core.operation import Operation
from core.units import NANOSECONDS_PER_SECOND
from service.exports.paging import pages
from service.exports.tables import Table, number, text, time, whole
from service.storage.records import RecordingEntry
from service.storage.repository import Repository
from service.storage.states import RecordingState


@dataclass(frozen=True, slots=True)
class JudgedRecording:
    """A recording with the verdict of its latest diagnosis, None without one."""

    entry: RecordingEntry
    verdict: Verdict | None


def _seconds(name: str) -> Callable[[JudgedRecording], float | None]:
    """Return what gives a duration of a recording in seconds."""

    def seconds(row: JudgedRecording) -> float | None:
        duration_ns = getattr(row.entry, name)
        return None if duration_ns is None else duration_ns / NANOSECONDS_PER_SECOND

    return seconds


TABLE: Table[JudgedRecording] = Table(
    "recordings",
    (
        text("motor", "motor", lambda row: row.entry.motor),
        time("recorded_time", "trigger time written in the record", lambda row: row.entry.recorded_ns),
        text("verdict", "verdict of its latest diagnosis", lambda row: row.verdict),
        text("state", "what became of it", lambda row: row.entry.state),
        text("operation", "what the motor does in it", lambda row: row.entry.operation),
        text(
            "operation_remark",
            "why the motor's parameters cannot be estimated from this start",
            lambda row: row.entry.operation_remark,
        ),
        text("reason", "why it was refused, or does not count", lambda row: row.entry.reason),
        text("copy_of", "recording of the same event that counts instead", lambda row: row.entry.copy_of),
        text("ied", "relay that made it", lambda row: row.entry.ied),
        text("source", "relay, upload or joined", lambda row: row.entry.source),
        text("name", "name of its files without the suffix", lambda row: row.entry.name),
        whole("size_bytes", "byte", "size of its files", lambda row: row.entry.size_bytes),
        time("announced_time", "when the service first saw it", lambda row: row.entry.announced_ns),
        time("fetched_time", "when its files were stored", lambda row: row.entry.fetched_ns),
        number("clock_offset_s", "s", "the relay's clock less the service's", _seconds("clock_offset_ns")),
        number("clock_uncertainty_s", "s", "uncertainty of that", _seconds("clock_uncertainty_ns")),
        text("clock_quality", "what the relay says of its clock", lambda row: row.entry.clock_quality),
        time("clock_measured_time", "when the clocks were compared", lambda row: row.entry.clock_measured_ns),
        text("recording_id", "id of the recording", lambda row: row.entry.id),
    ),
)


def recordings(
    repository: Repository,
    motors: Sequence[str] | None,
    *,
    state: RecordingState | None = None,
    operation: Operation | None = None,
) -> Iterator[Sequence[JudgedRecording]]:
    """Return the recordings of these motors, one motor after another, or of all; latest first."""
    for motor in motors or (None,):
        chosen = partial(repository.recordings, motor=motor, state=state, operation=operation)
        for entries in pages(chosen):
            verdicts = repository.verdicts([entry.id for entry in entries])
            yield [JudgedRecording(entry, verdicts.get(entry.id)) for entry in entries]
