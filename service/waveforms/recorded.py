"""Stored recordings, found and opened with the motor as it was when they were made."""

from collections.abc import Mapping
from concurrent.futures import BrokenExecutor
from dataclasses import dataclass, field

from core.diagnosis.verdict import FittedParameters, is_relative
from core.machines.motor_tables import layout_of
from core.machines.parameters import Motor
from core.recordings.envelope import Envelope
from core.recordings.reading import read_envelope
from core.units import NANOSECONDS_PER_SECOND
from service.condition.motor_data import MotorHistory
from service.recording_store.store import RecordingStore
from service.storage.records import DiagnosisEntry, RecordingEntry
from service.storage.repository import Repository
from service.waveforms.computing import ANSWER_TIMEOUT_S, Compute, NoAnswerError, compute_here
from service.waveforms.opened import Opened, opened
from service.waveforms.replaying import NotReplayed, Replayed, ReplayTask, replay_recording


class NotStoredError(LookupError):
    """A recording has no files; the message says why."""


class NoReplayError(LookupError):
    """A diagnosis cannot be drawn again; the message says why."""


@dataclass(frozen=True, slots=True)
class Recorded:
    """Recordings in the store. motors: of the plant, by name.  compute: who has the numbers loaded."""

    repository: Repository
    store: RecordingStore
    motors: Mapping[str, Motor] = field(default_factory=dict)
    compute: Compute = compute_here

    def open(self, entry: RecordingEntry) -> Opened:
        """Read a recording. Raises NotStoredError, RecordingStoreError, RecordingError, OSError."""
        with self.store.opened(digest_of(entry)) as file:
            return opened(file, self.motor_of(entry))

    def envelope(self, entry: RecordingEntry, intervals: int) -> Envelope:
        """Read the envelope of a recording of any length. Raises as `open`."""
        motor = self.motors.get(entry.motor)
        lenient = motor is not None and motor.reads_leniently
        with self.store.opened(digest_of(entry)) as file:
            layout = layout_of(self.motor_of(entry))
            return read_envelope(file, lambda _, samples: min(intervals, samples), layout, lenient=lenient)

    def motor_of(self, entry: RecordingEntry) -> Motor | None:
        """Return the motor as it was when it was recorded; None where the plant's files have it no more."""
        motor = self.motors.get(entry.motor)
        if motor is None or entry.recorded_ns is None:
            return motor
        return MotorHistory(motor, self.repository.motor_versions(entry.motor)).at(entry.recorded_ns)

    def replay(self, entry: RecordingEntry, diagnosis: DiagnosisEntry | None) -> Replayed:
        """Draw the currents of a diagnosis again.

        Raises NotStoredError, RecordingStoreError, NoReplayError, NoAnswerError.
        """
        task = self._replay_task(entry, diagnosis)
        try:
            outcome = self.compute(replay_recording, task).result(ANSWER_TIMEOUT_S)
        except (NoAnswerError, BrokenExecutor, TimeoutError) as error:
            raise NoAnswerError(f"no worker has drawn the model's currents: {error}") from error
        if isinstance(outcome, NotReplayed):
            raise NoReplayError(outcome.reason)
        return outcome

    def _replay_task(self, entry: RecordingEntry, diagnosis: DiagnosisEntry | None) -> ReplayTask:
        motor = self.motor_of(entry)
        if diagnosis is None:
            raise NoReplayError("the recording is not diagnosed yet")
        if motor is None:
            raise NoReplayError(
                f"motor {entry.motor} is not in the plant's files: its parameters are unknown"
            )
        document = diagnosis.document
        if document.get("residual_rms_A") is None:
            raise NoReplayError("the recording was refused: no current was modelled")
        fit = document.get("fit")
        if not isinstance(fit, Mapping):
            raise NoReplayError("the diagnosis kept no parameters of its fit")
        reasons = document.get("reasons")
        relative = isinstance(reasons, list) and is_relative(str(reason) for reason in reasons)
        healthy = self.repository.baseline(entry.motor).recordings if relative else ()
        return ReplayTask(
            recording=self.store.source(digest_of(entry)),
            motor=motor,
            model=str(document["model"]),
            fit=FittedParameters(**fit),
            baseline=tuple(self.store.source(digest_of(one)) for one in healthy),
            currents_only=document.get("currents_only") is True,
        )


def digest_of(entry: RecordingEntry) -> str:
    """Return where the files of a recording lie. Raises NotStoredError."""
    if entry.digest is None:
        reason = "" if entry.reason is None else f": {entry.reason}"
        raise NotStoredError(f"the recording is {entry.state}, not stored{reason}")
    return entry.digest


def begin_ns(entry: RecordingEntry, shown: Opened) -> int | None:
    """Return UTC of the first sample [ns]; None where neither file nor diagnosis tells a time.

    The file may have local time; its diagnosis found out the UTC of its trigger.
    """
    if entry.recorded_ns is None:
        return shown.recording.start_time_ns
    return entry.recorded_ns - round(shown.trigger_s * NANOSECONDS_PER_SECOND)
