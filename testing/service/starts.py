"""Recorded starts for tests, without a worker that measures them."""

from dataclasses import replace

from core.operation import Operation
from core.starts.examined import ExaminedStart
from core.starts.figures import MotorStart, StartCurve
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER
from testing.service.plants import NOW_NS, SECOND_NS, undiagnosable

START = MotorStart(
    is_from_rest=True,
    acceleration_s=1.25,
    peak_current_A=94.6,
    crest_current_A=154.3,
    running_current_A=9.0,
    lowest_voltage_V=371.5,
    i2t_A2s=333.5,
    i2t_over_s=1.25,
    rated_current_A=18.0,
    rated_voltage_V=400.0,
    curve=StartCurve(0.01, 0.02, (87.7, 84.1, 9.0), (371.5, 380.0, 399.0)),
)


class RecordedStarts:
    """Recordings of starts, one a second."""

    def __init__(self, repository: Repository, store: RecordingStore) -> None:
        self.repository, self._store, self._number = repository, store, 0

    def add(
        self, start: MotorStart | ExaminedStart | None, motor: str = "PUMP-A1", *, at_ns: int | None = None
    ) -> str:
        """Add the recording of a start with what it shows; return its id."""
        self._number += 1
        now_ns = NOW_NS + self._number * SECOND_NS if at_ns is None else at_ns
        stored = self._store.store({f"S{self._number}.CFF": f"start of {motor} {self._number}".encode()})
        added = self.repository.add_recording(stored, motor=motor, now_ns=now_ns)
        self.diagnose(start, now_ns)
        return added.recording.id

    def diagnose(self, start: MotorStart | ExaminedStart | None, recorded_ns: int) -> None:
        """Have the next recording that waits diagnosed."""
        claimed = self.repository.claim_job(now_ns=recorded_ns + 1000 * SECOND_NS, runner=RUNNER)
        assert claimed is not None
        seen = replace(undiagnosable(), operation=Operation.START)
        self.repository.finish_job(
            claimed.job.id,
            findings_of(seen, start=ExaminedStart(start) if isinstance(start, MotorStart) else start),
            recorded_ns=recorded_ns,
            now_ns=recorded_ns,
            runner=RUNNER,
        )
