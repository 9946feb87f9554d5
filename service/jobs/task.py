"""Define what goes to a worker process and what comes back; all of it can be pickled."""

from collections.abc import Callable
from dataclasses import dataclass

from core.classification.classification import Classification
from core.condition.observation import Observation
from core.diagnosis.verdict import Diagnosis
from core.machines.parameters import Motor
from core.rotor.finding import RotorFinding
from core.rotor.swing_findings import EccentricityFinding, PulsationFinding
from core.starts.examined import ExaminedStart
from core.supply.figures import SupplyFigures
from service.recording_store.recording import Source
from service.storage.records import RecordLength


@dataclass(frozen=True, slots=True)
class DiagnosisTask:
    """Name a recording to diagnose, its motor, and how to do it.

    baseline: the motor's healthy recordings, whose standing asymmetry is taken off; or none.
    time_zone: IANA name of the zone in which the relay's clock runs; None for UTC.
    near_ns: UTC near which the record was made: its trigger, or else when it was first seen [ns].
    """

    recording: Source
    motor: Motor
    method: str
    model: str
    baseline: tuple[Source, ...] = ()
    time_zone: str | None = None
    near_ns: int | None = None


@dataclass(frozen=True, slots=True)
class Diagnosed:
    """Hold a diagnosis, the time of its record, and all else that the record tells of its motor.

    recorded_ns: trigger time written in the record, UTC [ns].  observation: None where it tells nothing.
    operation_remark: why the motor's parameters cannot be estimated from this start; None where they can, and
    for other records.
    has_time_code: whether the record tells how far its times are ahead of UTC.
    length: that of the record.
    start: what a start shows; None of other records, and where nothing can be measured.  rotor, supply: what
    the record shows of them; None where it shows nothing.  classification: which causes are likely.
    eccentricity, pulsation: what it shows of the air gap and of a load that swings.
    """

    diagnosis: Diagnosis
    recorded_ns: int
    observation: Observation | None = None
    operation_remark: str | None = None
    has_time_code: bool = False
    start: ExaminedStart | None = None
    rotor: RotorFinding | None = None
    supply: SupplyFigures | None = None
    length: RecordLength | None = None
    classification: Classification | None = None
    eccentricity: EccentricityFinding | None = None
    pulsation: PulsationFinding | None = None


@dataclass(frozen=True, slots=True)
class Rejected:
    """Say why the record cannot be read or diagnosed as asked; trying again would give the same."""

    reason: str


Outcome = Diagnosed | Rejected
Task = Callable[[DiagnosisTask], Outcome]
"""A module-level function, because worker processes find it by name."""
