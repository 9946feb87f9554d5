"""What runs in a worker process."""

from core.diagnosis.errors import DiagnosisError
from core.diagnosis.stator import diagnose
from core.recordings import RecordingError, read
from core.warm_up import warm_up
from service.jobs.task import Diagnosed, DiagnosisTask, Outcome, Rejected
from service.jobs.worker_process import follow_service


def prepare_worker() -> None:
    """Runs once in every worker before its first job, which then need not wait for the compiler."""
    follow_service()
    warm_up()


def diagnose_recording(task: DiagnosisTask) -> Outcome:
    """Reads and diagnoses one recording; what would fail again is an outcome, not an error."""
    try:
        recording = read(task.entry)
        diagnosis = diagnose(recording, task.motor, method=task.method, model=task.model)
    except (RecordingError, DiagnosisError) as error:
        return Rejected(str(error))
    return Diagnosed(diagnosis, recording.trigger_time_ns)
