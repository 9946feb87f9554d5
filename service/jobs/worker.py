"""What runs in a worker process."""

from functools import lru_cache
from pathlib import Path

from core.diagnosis.baseline import Baseline
from core.diagnosis.errors import DiagnosisError
from core.diagnosis.stator import diagnose, learn_baseline
from core.machines.parameters import Motor
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
        diagnosis = diagnose(
            recording,
            task.motor,
            method=task.method,
            model=task.model,
            baseline=_learnt(task.baseline, task.motor) if task.baseline else None,
        )
    except (RecordingError, DiagnosisError) as error:
        return Rejected(str(error))
    return Diagnosed(diagnosis, recording.trigger_time_ns)


@lru_cache(maxsize=64)
def _learnt(healthy: tuple[Path, ...], motor: Motor) -> Baseline:
    """Stored files never change, so what was learnt from them once holds as long as this worker lives."""
    try:
        return learn_baseline((read(one) for one in healthy), motor)
    except (RecordingError, DiagnosisError) as error:
        raise DiagnosisError(f"the motor's baseline cannot be learnt: {error}") from error
