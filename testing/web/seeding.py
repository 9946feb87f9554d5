"""A plant with something to see on every page, put into a database without relays and workers.

It is the demo's plant. PUMP-A1 has shorted turns, folded from 80 records. FAN-A2 has real recordings of a
start and of a running motor. MILL-A3 is watched. CONVEYOR-B1 is healthy. COMPRESSOR-B2 has no recent record,
and its relay is down. PUMP-B3 stands still.
"""

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import scl
from core.condition.events import Event, EventKind
from core.condition.observation import Observation
from core.diagnosis.verdict import Diagnosis
from core.machines.parameters import Motor
from core.operation import Operation
from core.recordings import comtrade, read
from core.rotor.finding import RotorFinding
from core.rotor.swing_findings import EccentricityFinding, PulsationFinding
from core.starts.examined import ExaminedStart
from core.supply.figures import SupplyFigures
from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from service.condition.motor_data import document_of
from service.condition.worker import fold_due
from service.configuration.settings import sqlite_url
from service.demo import MOTORS
from service.jobs.task import Diagnosed, DiagnosisTask
from service.jobs.worker import diagnose_recording
from service.plant import Plant
from service.plant.files import plant_of_files
from service.recording_store.folder import FolderStore
from service.recording_store.recording import LocalFile
from service.recording_store.store import RecordingStore
from service.storage import Repository, connect
from service.storage.records import Actor, RelayFindings, Role, Sample
from service.storage.states import AlarmKind, LinkState
from testing.service.conditions import DRIFTING, HEALTHY, tell
from testing.service.database import make_database
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER, register_runner
from testing.service.links import set_link_state
from testing.service.observations import records_of_a_motor
from testing.service.plants import fault, healthy, undiagnosable
from testing.service.rotor_and_supply import ECCENTRIC_ROTOR, SOUND_ROTOR, SUPPLY, SWINGING_LOAD

EXAMPLES = Path(__file__).parents[2] / "examples"
HOUR_NS = 3600 * NANOSECONDS_PER_SECOND
BY = Actor("ann", "127.0.0.1", frozenset({Role.ENGINEER}))

FAULTY, RECORDED, WATCHED, WELL, STALE, STANDING = (
    "PUMP-A1", "FAN-A2", "MILL-A3", "CONVEYOR-B1", "COMPRESSOR-B2", "PUMP-B3",
)  # fmt: skip

RECORDS, FAULT_FROM = 80, 50
METERED = {
    "ia_A": 1.51, "ib_A": 1.49, "ic_A": 1.5, "vab_V": 381.2, "vbc_V": 379.8, "vca_V": 380.1,
    "power_W": 612.5, "frequency_Hz": 50.01,
}  # fmt: skip
SAMPLES = 300


def demo_plant() -> Plant:
    """The plant that is seeded."""
    return plant_of_files(scl.DEMO_PLANT_SCD, MOTORS)


@dataclass(frozen=True, slots=True)
class _Seeding:
    """What the plant is written with."""

    repository: Repository
    store: RecordingStore
    plant: Plant
    now_ns: int

    def record(
        self,
        motor: str,
        diagnosis: Diagnosis,
        time_ns: int,
        observed: Observation | None = None,
        *,
        rotor: RotorFinding | None = None,
        supply: SupplyFigures | None = None,
        eccentricity: EccentricityFinding | None = None,
        pulsation: PulsationFinding | None = None,
    ) -> str:
        """Add a recording without a waveform that can be read, and its diagnosis."""
        files = {"EVENT.CFF": f"{motor} {time_ns}".encode()}
        return self.add(
            motor,
            files,
            diagnosis,
            time_ns,
            observed,
            rotor=rotor,
            supply=supply,
            eccentricity=eccentricity,
            pulsation=pulsation,
        )

    def add(
        self,
        motor: str,
        files: dict[str, bytes],
        diagnosis: Diagnosis,
        time_ns: int,
        observed: Observation | None,
        start: ExaminedStart | None = None,
        *,
        rotor: RotorFinding | None = None,
        supply: SupplyFigures | None = None,
        eccentricity: EccentricityFinding | None = None,
        pulsation: PulsationFinding | None = None,
    ) -> str:
        """Add a recording and its diagnosis; return its id."""
        added = self.repository.add_recording(self.store.store(files), motor=motor, now_ns=time_ns)
        claimed = self.repository.claim_job(now_ns=time_ns, runner=RUNNER)
        assert claimed is not None
        assert self.repository.finish_job(
            claimed.job.id,
            findings_of(
                diagnosis,
                observation=observed,
                start=start,
                rotor=rotor,
                supply=supply,
                eccentricity=eccentricity,
                pulsation=pulsation,
            ),
            recorded_ns=time_ns,
            now_ns=time_ns,
            runner=RUNNER,
        )
        return added.recording.id

    def add_example(self, motor: str, name: str, time_ns: int, folder: Path) -> str:
        """Add a recording of the examples as if it had been made then, and diagnose it."""
        recording = read(EXAMPLES / f"{name}.CFG")
        trigger_ns = recording.trigger_time_ns
        start_ns = recording.start_time_ns
        assert trigger_ns is not None
        assert start_ns is not None
        moved = replace(recording, start_time_ns=start_ns + time_ns - trigger_ns)
        entry = comtrade.write(folder / f"{name}.CFG", moved)
        found = diagnose_recording(
            DiagnosisTask(LocalFile(entry), self.motor(motor), "hcpa", "split-winding", near_ns=time_ns)
        )
        assert isinstance(found, Diagnosed), found
        files = {path.name: path.read_bytes() for path in folder.glob(f"{name}.*")}
        return self.add(
            motor,
            files,
            found.findings.diagnosis,
            found.recorded_ns,
            found.findings.observation,
            found.findings.start,
            rotor=found.findings.rotor,
            supply=found.findings.supply,
        )

    def motor(self, name: str) -> Motor:
        """Return a motor as the motors file has it."""
        return next(one.motor for one in self.plant.motors if one.name == name)

    def fold(self, name: str) -> None:
        """Have a motor's condition follow from its records."""
        while name in self.repository.motors_to_fold():
            fold_due(self.repository, self.motor(name))


def seed(data: Path, *, now_ns: int | None = None) -> str:
    """Put a database and recordings of the plant into a data directory; return the database's URL."""
    make_database(data)
    url = sqlite_url(data)
    engine = connect(url)
    repository = Repository(engine)
    plant = demo_plant()
    now_ns = time.time_ns() if now_ns is None else now_ns
    began_ns = now_ns - 90 * NANOSECONDS_PER_DAY
    repository.sync_plant(plant, noted_ns=began_ns)
    register_runner(repository)
    repository.note_motors({one.name: document_of(one.motor) for one in plant.motors}, now_ns=began_ns)
    seeding = _Seeding(repository, FolderStore(data / "recordings"), plant, now_ns)
    _seed_motors(seeding, data)
    _seed_relays(seeding)
    repository.settle_alarms(now_ns=now_ns)
    engine.dispose()
    return url


def acknowledge_all(repository: Repository, motor: str) -> None:
    """Acknowledge the alarms of a motor."""
    for alarm in repository.open_alarms(motor=motor, limit=100).items:
        repository.acknowledge_alarms([alarm.id], by=BY, comment=None, now_ns=time.time_ns())


def _seed_motors(seeding: _Seeding, data: Path) -> None:
    repository, now_ns = seeding.repository, seeding.now_ns
    for observed in _developing(now_ns):
        seeding.record(
            FAULTY,
            fault(),
            observed.time_ns,
            observed,
            rotor=SOUND_ROTOR,
            supply=SUPPLY,
            eccentricity=ECCENTRIC_ROTOR,
            pulsation=SWINGING_LOAD,
        )
    seeding.fold(FAULTY)
    note = Event(now_ns - 40 * NANOSECONDS_PER_DAY, EventKind.NOTE, "bearings greased")
    repository.add_event(FAULTY, note, by=BY, now_ns=now_ns)

    folder = data / "examples"
    folder.mkdir()
    seeding.add_example(RECORDED, "START", now_ns - 9 * NANOSECONDS_PER_DAY, folder)
    seeding.add_example(RECORDED, "RUNNING", now_ns - 2 * HOUR_NS, folder)
    seeding.fold(RECORDED)

    for motor, condition, days in ((WATCHED, DRIFTING, 0.1), (WELL, HEALTHY, 0.2), (STALE, HEALTHY, 60.0)):
        last_ns = now_ns - round(days * NANOSECONDS_PER_DAY)
        for ago in range(5, -1, -1):
            seeding.record(motor, healthy(), last_ns - ago * NANOSECONDS_PER_DAY)
        told = replace(condition, motor=motor, as_of_ns=last_ns)
        if told.since_ns is not None:
            told = replace(told, since_ns=last_ns - NANOSECONDS_PER_DAY)
        tell(repository, told, now_ns=last_ns)
    for ago in range(6, 2, -1):
        seeding.record(STANDING, healthy(), now_ns - ago * NANOSECONDS_PER_DAY)
    standing_ns = now_ns - 3 * NANOSECONDS_PER_DAY
    tell(repository, replace(HEALTHY, motor=STANDING, as_of_ns=standing_ns), now_ns=standing_ns)
    stands = replace(undiagnosable(), operation=Operation.NOT_RUNNING, reasons=("the motor stands still",))
    seeding.record(STANDING, stands, now_ns - HOUR_NS)
    repository.add_samples(
        Sample(motor, now_ns - at * 60 * NANOSECONDS_PER_SECOND, METERED)
        for motor in (FAULTY, RECORDED)
        for at in range(SAMPLES, 0, -1)
    )


def _developing(now_ns: int) -> Sequence[Observation]:
    """Records of two months, the last an hour ago, with a fault in the last third of them."""
    step_ns = 18 * HOUR_NS
    records = records_of_a_motor(RECORDS, fault_from=FAULT_FROM)
    last = len(records) - 1
    return [replace(one, time_ns=now_ns - HOUR_NS - (last - at) * step_ns) for at, one in enumerate(records)]


def _seed_relays(seeding: _Seeding) -> None:
    repository, now_ns = seeding.repository, seeding.now_ns
    for relay in seeding.plant.relays:
        began_ns = now_ns - 30 * NANOSECONDS_PER_DAY
        set_link_state(repository, relay.name, LinkState.UP, None, now_ns=began_ns)
    down = next(one.relay for one in seeding.plant.motors if one.name == STALE)
    set_link_state(repository, down, LinkState.DOWN, "no answer: connection refused", now_ns=now_ns - HOUR_NS)
    first = seeding.plant.relays[0].name
    acquisition = {
        "asked": True,
        "trigger": f"{first}CON/RBGGIO1.SPCSO01",
        "trigger_action": "set-reset",
        "control_model": "direct-with-normal-security",
        "record_made": f"{first}PRO/FLTRDRE1.RcdMade",
        "record_number": None,
        "records_told_by": "polling",
        "report_control": None,
        "events_directory": "EVENTS",
        "overridden": [],
        "remarks": [],
    }
    missing = {"kind": "logical-node", "expected": f"{first}PRO/FLTRDRE1", "found": None}
    ignored = {"name": "NOTES.TXT", "reason": "no file of a recording"}
    repository.note_findings(RelayFindings(first, now_ns - HOUR_NS, acquisition, [missing], [ignored], 1))
    repository.raise_alarm(
        first,
        AlarmKind.FILE_REFUSED,
        "HR_00042.CFG",
        "expected 12 channels, found 3",
        now_ns=now_ns - HOUR_NS,
    )
