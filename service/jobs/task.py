"""Define what goes to a worker process and what comes back; all of it can be pickled."""

from collections.abc import Callable
from dataclasses import dataclass

from core.condition.copies import Outline
from core.findings.findings import Findings
from core.machines.parameters import Motor
from service.recording_store.recording import Source


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
    """Hold what a record tells of its motor, and the time at which it was made.

    recorded_ns: trigger time written in the record, UTC [ns].  has_time_code: whether the record tells how
    far its times are ahead of UTC.  outline: what tells copies of its event; None where it cannot have any.
    """

    findings: Findings
    recorded_ns: int
    has_time_code: bool = False
    outline: Outline | None = None


@dataclass(frozen=True, slots=True)
class Rejected:
    """Say why the record cannot be read or diagnosed as asked; trying again would give the same."""

    reason: str


Outcome = Diagnosed | Rejected
Task = Callable[[DiagnosisTask], Outcome]
"""A module-level function, because worker processes find it by name."""
