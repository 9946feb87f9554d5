"""Sites, relays and motors as the repository hands them out."""

from dataclasses import dataclass
from enum import StrEnum

from core.machines.parameters import ParametersSource
from service.storage.states import ClockQuality, LinkState


class StopOf(StrEnum):
    """What a stop was planned of."""

    MOTOR = "motor"
    SITE = "site"


@dataclass(frozen=True, slots=True)
class PlannedStop:
    """When a motor, or all motors of a site, stop next, as somebody planned."""

    time_ns: int
    of: StopOf


@dataclass(frozen=True, slots=True)
class SiteEntry:
    name: str
    description: str


@dataclass(frozen=True, slots=True)
class IedEntry:
    """A relay and the state of its link; `last_success_ns` is the last request it answered.

    clock_...: the latest ClockReading, None before the first.
    """

    name: str
    site: str
    host: str
    port: int
    manufacturer: str
    type: str
    link_state: LinkState
    link_reason: str | None
    link_changed_ns: int | None
    last_success_ns: int | None
    clock_offset_ns: int | None
    clock_uncertainty_ns: int | None
    clock_quality: ClockQuality | None
    clock_measured_ns: int | None


@dataclass(frozen=True, slots=True)
class MotorEntry:
    """A motor; `schedule`, its own or its bus's, is a cron expression in UTC.

    parameters_source: where its parameters come from.
    """

    name: str
    description: str
    site: str
    ied: str
    schedule: str | None
    parameters_source: ParametersSource
