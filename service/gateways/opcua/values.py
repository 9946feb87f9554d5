"""From what is told of motors and relays to OPC UA values, with status and the time of each."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

from asyncua import ua

from service.gateways.opcua.companion_types import STATES, STRING
from service.gateways.opcua.history import EPOCH, utc
from service.gateways.plant_state.device_health import DeviceHealth
from service.gateways.plant_state.figures import MotorFigures, PlantState, Quality, RelayFigures
from service.gateways.plant_state.running_state import RunningState
from service.storage.states import AlarmPriority

HEALTHS: Final[Mapping[DeviceHealth, int]] = {
    DeviceHealth.NORMAL: 0,
    DeviceHealth.FAILURE: 1,
    DeviceHealth.CHECK_FUNCTION: 2,
    DeviceHealth.OFF_SPEC: 3,
    DeviceHealth.MAINTENANCE_REQUIRED: 4,
}
"""DeviceHealthEnumeration of OPC 10000-100."""

ITEM_STATES: Final[Mapping[RunningState, str]] = {
    RunningState.RUNNING: "Executing",
    RunningState.STANDING: "NotExecuting",
}
"""States of MachineryItemState (OPC 40001-1)."""

STATUS: Final[Mapping[Quality, int]] = {
    Quality.GOOD: ua.StatusCodes.Good,
    Quality.UNCERTAIN: ua.StatusCodes.UncertainLastUsableValue,
    Quality.BAD: ua.StatusCodes.BadWaitingForInitialData,
}
SEVERITIES: Final[Mapping[AlarmPriority, int]] = {
    AlarmPriority.CRITICAL: 900,
    AlarmPriority.HIGH: 700,
    AlarmPriority.MEDIUM: 500,
    AlarmPriority.LOW: 300,
}
DOUBLE, TIME = ua.VariantType.Double, ua.VariantType.DateTime
FLAG, NUMBER = ua.VariantType.Boolean, ua.VariantType.UInt32

INITIAL: Final[Mapping[ua.VariantType, object]] = {
    DOUBLE: 0.0,
    STRING: "",
    TIME: EPOCH,
    FLAG: False,
    NUMBER: 0,
}
"""What a node is made with, for the moment until its value is written."""


@dataclass(frozen=True, slots=True)
class MotorVariable:
    """A variable of each motor. meaning: for people. read: its value; None where it is not known."""

    name: str
    kind: ua.VariantType
    meaning: str
    read: Callable[[MotorFigures], object]


def _level_low(motor: MotorFigures) -> float | None:
    return None if motor.mu_f_ci95 is None else motor.mu_f_ci95[0]


def _level_high(motor: MotorFigures) -> float | None:
    return None if motor.mu_f_ci95 is None else motor.mu_f_ci95[1]


def _change_low(motor: MotorFigures) -> float | None:
    return None if motor.change_ci95 is None else motor.change_ci95[0]


def _change_high(motor: MotorFigures) -> float | None:
    return None if motor.change_ci95 is None else motor.change_ci95[1]


MOTOR_VARIABLES: Final = (
    MotorVariable("State", STRING, "healthy, watch, fault or unknown", lambda one: str(one.state)),
    MotorVariable("Kind", STRING, "what stands out", lambda one: str(one.kind)),
    MotorVariable("Finding", STRING, "what stands out, in words", lambda one: one.finding),
    MotorVariable("Phase", STRING, "phase of what stands out", lambda one: one.phase),
    MotorVariable("LikelyPhases", STRING, "phases that it may be in", lambda one: one.likely_phases),
    MotorVariable("FaultLevel", DOUBLE, "share of the phase's turns", lambda one: one.mu_f),
    MotorVariable("FaultLevelLow", DOUBLE, "lower end of its 95 % interval", _level_low),
    MotorVariable("FaultLevelHigh", DOUBLE, "upper end of its 95 % interval", _level_high),
    MotorVariable("Change", DOUBLE, "of the level since the reference", lambda one: one.change),
    MotorVariable("ChangeLow", DOUBLE, "lower end of its 95 % interval", _change_low),
    MotorVariable("ChangeHigh", DOUBLE, "upper end of its 95 % interval", _change_high),
    MotorVariable("DetectionLimit", DOUBLE, "of the latest record", lambda one: one.detection_limit),
    MotorVariable("Load", DOUBLE, "over the rated load", lambda one: one.load_level),
    MotorVariable("Rotor", STRING, "watch or fault", lambda one: one.rotor and str(one.rotor)),
    MotorVariable("Stale", FLAG, "the latest record is too old", lambda one: one.stale),
    MotorVariable("AsOf", TIME, "time of the latest record", lambda one: _time(one.as_of_ns)),
    MotorVariable("Since", TIME, "since when the state is so", lambda one: _time(one.since_ns)),
    MotorVariable("Advice", STRING, "what to do", lambda one: one.advice),
    MotorVariable("Reasons", STRING, "why", lambda one: "; ".join(one.reasons)),
    MotorVariable("Alarms", NUMBER, "that call for somebody", lambda one: one.alarms),
    MotorVariable("Priority", STRING, "of the most urgent alarm", lambda one: str(one.priority or "")),
    MotorVariable("QualityReason", STRING, "why values are not good", lambda one: one.quality_reason),
)  # fmt: skip
BESIDE_RECORDS: Final = frozenset({"Stale", "Alarms", "Priority", "QualityReason"})
"""Variables that are no figures of a record: each has the time at which it was read to be so."""

HISTORIES: Final[Mapping[str, str]] = {"FaultLevel": "condition_level", "Load": "load_level"}
"""Variables with a history, and the figure of the trend (core.quantities).

The level is that of the motor's condition, as its variable has it: a record alone may show another.
"""


def motor_value(variable: MotorVariable, motor: MotorFigures, state: PlantState) -> ua.DataValue:
    """Return the value of a motor's variable; one that is not known is bad, or an empty text."""
    value = variable.read(motor)
    if value is None and variable.kind is STRING:
        value = ""
    if variable.name in BESIDE_RECORDS:
        quality = Quality.GOOD if state.is_current else Quality.UNCERTAIN
        return _told_always(ua.Variant(value, variable.kind), quality, state.read_ns)
    if value is None:
        return ua.DataValue(
            StatusCode=ua.StatusCode(ua.StatusCodes.BadNoData), SourceTimestamp=_time(motor.as_of_ns)
        )
    return ua.DataValue(
        ua.Variant(value, variable.kind),
        StatusCode=ua.StatusCode(STATUS[motor.quality]),
        SourceTimestamp=_time(motor.as_of_ns),
    )


def health_value(health: DeviceHealth, quality: Quality, time_ns: int | None) -> ua.DataValue:
    """Return the health of a device."""
    return _told_always(ua.Variant(HEALTHS[health], ua.VariantType.Int32), quality, time_ns)


def item_state_values(motor: MotorFigures, namespace: int) -> tuple[ua.DataValue, ua.DataValue]:
    """Return CurrentState and its Id. namespace: index of that of OPC UA for Machinery.

    A machine whose relay does not answer may run: NotAvailable would say that it does nothing.
    """
    if motor.running is RunningState.UNKNOWN:
        unknown = ua.DataValue(
            StatusCode=ua.StatusCode(ua.StatusCodes.BadNoCommunication),
            SourceTimestamp=_time(motor.running_ns),
        )
        return unknown, unknown
    name = ITEM_STATES[motor.running]
    node, _, _ = STATES[name]
    text = ua.Variant(ua.LocalizedText(name, "en"), ua.VariantType.LocalizedText)
    place = ua.Variant(ua.NodeId(node, namespace), ua.VariantType.NodeId)
    state, of_node = (_told_always(one, motor.running_quality, motor.running_ns) for one in (text, place))
    return state, of_node


def _told_always(value: ua.Variant, quality: Quality, time_ns: int | None) -> ua.DataValue:
    """Return a value that is told also where the motor's figures are not, as that is its point."""
    status = ua.StatusCodes.Good if quality is Quality.BAD else STATUS[quality]
    return ua.DataValue(value, StatusCode=ua.StatusCode(status), SourceTimestamp=_time(time_ns))


def relay_value(text: str, relay: RelayFigures) -> ua.DataValue:
    """Return a text about a relay."""
    return ua.DataValue(
        ua.Variant(text, STRING),
        StatusCode=ua.StatusCode(STATUS[relay.quality]),
        SourceTimestamp=_time(relay.changed_ns),
    )


def text_value(text: str, kind: ua.VariantType) -> ua.DataValue:
    """Return a text or a localised text; an empty one is not known."""
    if not text:
        return ua.DataValue(StatusCode=ua.StatusCode(ua.StatusCodes.BadNoData))
    return ua.DataValue(ua.Variant(ua.LocalizedText(text) if kind is not STRING else text, kind))


def _time(time_ns: int | None) -> object:
    return None if time_ns is None else utc(time_ns)
