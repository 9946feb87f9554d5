"""Recordings with given observations, added to a service's database as its job runner does."""

from collections.abc import Iterable
from dataclasses import replace

from core.condition.copies import Outline
from core.condition.observation import Observation
from core.machines.parameters import Motor
from core.rotor.finding import RotorFinding
from service.condition.motor_data import document_of
from service.condition.worker import fold_due
from service.plant import Plant
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import ClaimedJob
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER
from testing.service.observations import HOUR_NS
from testing.service.plants import NOW_NS, healthy, motor, two_motor_plant

PUMP, FAN = "PUMP-A1", "FAN-A2"


class Recorder:
    """Brings recordings and their diagnoses."""

    def __init__(self, repository: Repository, store: RecordingStore) -> None:
        self._repository = repository
        self._store = store
        self._number = 0

    def record(
        self,
        observed: Observation | None,
        motor: str = PUMP,
        *,
        outline: Outline | None = None,
        rotor: RotorFinding | None = None,
    ) -> str:
        """Add a recording that is diagnosed with this observation; return its id."""
        self._number += 1
        stored = self._store.store({"E.CFF": f"record {self._number}".encode()})
        added = self._repository.add_recording(stored, motor=motor, now_ns=NOW_NS)
        self.finish(self.claim(), observed, outline, rotor)
        return added.recording.id

    def record_all(self, observed: Iterable[Observation], motor: str = PUMP) -> list[str]:
        return [self.record(one, motor) for one in observed]

    def claim(self) -> ClaimedJob:
        """Take what is queued."""
        claimed = self._repository.claim_job(now_ns=NOW_NS + HOUR_NS, runner=RUNNER)
        assert claimed is not None
        return claimed

    def finish(
        self,
        claimed: ClaimedJob,
        observed: Observation | None,
        outline: Outline | None = None,
        rotor: RotorFinding | None = None,
    ) -> None:
        assert self._repository.finish_job(
            claimed.job.id,
            findings_of(healthy(), observation=observed, rotor=rotor),
            recorded_ns=NOW_NS if observed is None else observed.time_ns,
            now_ns=NOW_NS,
            runner=RUNNER,
            outline=outline,
        )

    def diagnose(self, observed: Observation | None, outline: Outline | None = None) -> None:
        """Diagnose what is queued."""
        self.finish(self.claim(), observed, outline)

    def diagnose_again(
        self, recording_id: str, observed: Observation | None, outline: Outline | None = None
    ) -> None:
        self._repository.request_diagnosis(recording_id, now_ns=NOW_NS)
        self.diagnose(observed, outline)


def fold_all(repository: Repository, *edited: Motor) -> None:
    """Fold, in this process, until nothing is left to fold. edited: motors that are not as ever."""
    motors = {name: motor(name) for name in (PUMP, FAN)} | {one.name: one for one in edited}
    while names := repository.motors_to_fold():
        for name in names:
            fold_due(repository, motors[name])


def on_one_bus() -> Plant:
    """The small plant, with both motors on one bus."""
    plant = two_motor_plant()
    return replace(plant, motors=tuple(replace(one, bus="BUS-A") for one in plant.motors))


def note_motors(repository: Repository) -> None:
    """Let the small plant's motors be as the motors file has them, as the service does when it starts."""
    repository.note_motors({name: document_of(motor(name)) for name in (PUMP, FAN)}, now_ns=NOW_NS)
