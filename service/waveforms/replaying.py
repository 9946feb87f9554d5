"""Draw the currents of a diagnosis again, in a worker process."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.diagnosis.verdict import FittedParameters
from core.machines.motor_tables import layout_of
from core.machines.parameters import Motor
from core.recordings import RecordingError, read
from service.condition.healthy_records import MOST_VALUES, learnt
from service.recording_store.errors import RecordingStoreError
from service.recording_store.recording import Source


@dataclass(frozen=True, slots=True)
class ReplayTask:
    """Name a diagnosis to draw again: its recording, motor, model and fit, and its baseline."""

    recording: Source
    motor: Motor
    model: str
    fit: FittedParameters
    baseline: tuple[Source, ...] = ()
    currents_only: bool = False


@dataclass(frozen=True, slots=True)
class Replayed:
    """Hold measured and modelled line currents, single precision, shape (3, n) [A], from `first_s` on."""

    first_s: float
    sample_rate_hz: float
    measured_abc: NDArray[np.float32]
    modelled_abc: NDArray[np.float32]
    residual_rms_A: float


@dataclass(frozen=True, slots=True)
class NotReplayed:
    """Say why the currents cannot be drawn."""

    reason: str


def replay_recording(task: ReplayTask) -> Replayed | NotReplayed:
    """Read one recording and draw the model's currents."""
    from core.diagnosis.errors import DiagnosisError
    from core.diagnosis.replay import replay

    try:
        with task.recording.opened() as entry:
            motor = task.motor
            recording = read(
                entry, lenient=motor.reads_leniently, most_values=MOST_VALUES, layout=layout_of(motor)
            )
        drawn = replay(
            recording,
            task.motor,
            task.fit,
            model=task.model,
            baseline=learnt(task.baseline, task.motor) if task.baseline else None,
            currents_only=task.currents_only,
        )
    except (RecordingError, DiagnosisError, RecordingStoreError, OSError) as error:
        return NotReplayed(str(error))
    return Replayed(
        first_s=drawn.first_s,
        sample_rate_hz=drawn.sample_rate_hz,
        measured_abc=drawn.measured_abc.astype(np.float32),
        modelled_abc=drawn.modelled_abc.astype(np.float32),
        residual_rms_A=drawn.residual_rms_A,
    )
