"""Diagnose recordings in a worker process.

The service's own process imports this module to name what its workers do. The numbers, and the compiler
behind them, are imported where the work is done: without them the service starts sooner and stays smaller.
"""

from dataclasses import replace
from typing import TYPE_CHECKING
from zoneinfo import ZoneInfo

from core.commissioning.errors import CommissioningError
from core.diagnosis.errors import DiagnosisError
from core.machines.motor_tables import layout_of
from core.machines.parameters import Motor
from core.operation import Operation
from core.recordings import Recording, RecordingError, read
from core.recordings.fidelity import fidelity_of
from core.recordings.local_time import in_utc
from service.condition.healthy_records import MOST_VALUES, learnt
from service.jobs.task import Diagnosed, DiagnosisTask, Outcome, Rejected
from service.jobs.worker_process import follow_service
from service.recording_store.errors import RecordingStoreError

if TYPE_CHECKING:
    from core.starts.examined import ExaminedStart


def prepare_worker() -> None:
    """Prepare a worker for its first job, which then need not wait for the compiler."""
    from core.warm_up import warm_up

    follow_service()
    warm_up()  # nothing is left to do where its parent has done it


def diagnose_recording(task: DiagnosisTask) -> Outcome:
    """Read and diagnose one recording; what would fail again is an outcome, not an error.

    Raises OSError where it cannot be had for now.
    """
    from core.condition.copies import outline_of
    from core.findings.examining import examine

    try:
        with task.recording.opened() as entry:
            motor, fidelity = task.motor, fidelity_of(entry)
            recording = read(
                entry, lenient=motor.reads_leniently, most_values=MOST_VALUES, layout=layout_of(motor)
            )
        if task.time_zone is not None:
            recording = in_utc(recording, ZoneInfo(task.time_zone), task.near_ns)
        recorded_ns = recording.trigger_time_ns  # a lenient reader may have found none
        found = examine(
            recording,
            motor,
            method=task.method,
            model=task.model,
            baseline=learnt(task.baseline, motor) if task.baseline else None,
        )
    except (RecordingError, DiagnosisError, RecordingStoreError) as error:
        return Rejected(str(error))
    if found.diagnosis.operation is Operation.START:
        found = replace(
            found,
            start=_measured(recording, motor),
            not_commissioned_from=_why_not_commissioned_from(recording, motor),
        )
    outline = outline_of(recording, motor, fidelity)
    return Diagnosed(found, recorded_ns, recording.has_time_code, outline)


def _why_not_commissioned_from(recording: Recording, motor: Motor) -> str | None:
    """Return why a motor's parameters cannot be estimated from a start; None where they can."""
    from core.commissioning.start_detection import start_of

    try:
        start_of(recording, motor.nameplate, motor.channels, transformers=motor.transformers)
    except (RecordingError, CommissioningError) as error:
        return f"{error.field}: expected {error.expected}, found {error.found}"
    return None


def _measured(recording: Recording, motor: Motor) -> "ExaminedStart | None":
    """Return what a start shows; None where nothing can be measured."""
    from core.starts.examining import examine_start

    try:
        return examine_start(recording, motor)
    except RecordingError:
        return None
