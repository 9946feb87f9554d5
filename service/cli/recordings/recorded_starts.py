"""The starts of a motor that a service has recorded, fetched to estimate the motor's parameters from them."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from core.commissioning.errors import CommissioningError
from core.commissioning.start_detection import start_of
from core.error_words import one_line
from core.machines.motor_file.reader import Plate
from core.machines.motor_tables import layout_of
from core.recordings import Recording, RecordingError, read
from service.cli.output import CommandError
from service.client.recording_download import download_recording
from service.client.rest_client import Document, ServiceClient
from service.client.verdicts import local_time

MOST_STARTS = 5
"""So many of the latest starts are fitted together; more make the intervals hardly narrower."""

RECORD_ONE = (
    "have its relay record one (docs/how-to/commissioning.md#how-to-get-it-from-a-relay says how); mcc "
    "health tells when it has come"
)


@dataclass(frozen=True, slots=True)
class RecordedStart:
    """A start that can be used.

    id: of the recording.  time: when it was recorded, for people.
    """

    id: str
    time: str
    recording: Recording


@dataclass(frozen=True, slots=True)
class FetchedStarts:
    """The starts that are used, and why others are not, in words."""

    used: tuple[RecordedStart, ...]
    left_out: tuple[str, ...]


def fetch_starts(service: ServiceClient, plate: Plate, chosen: Sequence[str], folder: Path) -> FetchedStarts:
    """Fetch the chosen recordings of a motor or, where none is chosen, its latest starts.

    Raises ServiceError, OSError, CommandError where none can be used.
    """
    listed = (
        [_of_motor(service, one, plate.name) for one in chosen] if chosen else _starts(service, plate.name)
    )
    used: list[RecordedStart] = []
    left_out: list[str] = []
    for one in listed:
        if len(used) == MOST_STARTS and not chosen:
            break
        name = f"{local_time(one['recorded_time'] or one['announced_time'])} ({one['id']})"
        remark = None if chosen else one["operation_remark"]
        if remark is None:
            found = _usable(service, str(one["id"]), plate, folder)
            if isinstance(found, Recording):
                used.append(RecordedStart(str(one["id"]), name, found))
                continue
            remark = found
        left_out.append(one_line(f"{name}: {remark}"))
    if not used:
        raise CommandError(_none(plate.name, left_out), details={"type": "NoStart", "left_out": left_out})
    return FetchedStarts(tuple(used), tuple(left_out))


def _starts(service: ServiceClient, motor: str) -> list[Document]:
    found = service.list_recordings_of_motor(motor, operation="start")
    return [one for one in found if one["copy_of"] is None]


def _of_motor(service: ServiceClient, recording_id: str, motor: str) -> Document:
    found = service.get_recording(recording_id)
    if found["motor"] != motor:
        raise CommandError(
            f"--recording {recording_id}: expected a recording of {motor}, found one of {found['motor']}",
            details={"type": "OtherMotor", "recording": recording_id},
        )
    return found


def _usable(service: ServiceClient, recording_id: str, plate: Plate, folder: Path) -> Recording | str:
    """Return a recording, or why it cannot be used. Raises ServiceError, OSError."""
    entry = download_recording(service, recording_id, folder / recording_id)
    try:
        recording = read(entry, layout=layout_of(plate))
        start_of(recording, plate.nameplate, plate.channels, transformers=plate.transformers)
    except (RecordingError, CommissioningError) as error:
        return f"{error.field}: expected {error.expected}, found {error.found}"
    return recording


def _none(motor: str, left_out: Sequence[str]) -> str:
    if not left_out:
        return f"{motor}: no start of it was recorded yet; {RECORD_ONE}"
    return f"{motor}: none of its recorded starts can be used: {'; '.join(left_out)}; {RECORD_ONE}"
