"""All motors of the plant as an overview shows them."""

from dataclasses import dataclass

from service.storage.records.conditions import ConditionEntry
from service.storage.records.diagnoses import LatestFigures
from service.storage.records.plant import MotorEntry
from service.storage.states import AlarmPriority, LinkState


@dataclass(frozen=True, slots=True)
class CallingAlarms:
    """The alarms of a motor that call for somebody: how many, and the most urgent one."""

    number: int
    urgency: int
    alarm: str
    priority: AlarmPriority
    raised_ns: int


@dataclass(frozen=True, slots=True)
class FleetMotor:
    """What an overview tells of a motor.

    link, link_changed_ns: of its relay. figures: of its latest recording that has any, or None.
    alarms: None where none calls.
    """

    motor: MotorEntry
    condition: ConditionEntry
    link: LinkState
    link_changed_ns: int | None
    figures: LatestFigures | None
    alarms: CallingAlarms | None
