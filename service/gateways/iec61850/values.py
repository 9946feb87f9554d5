"""From what is told of the plant to the attributes of the IED's data model."""

import math
from collections.abc import Mapping
from typing import Final

from core.condition.kinds import State
from core.rotor.finding import RotorState
from mms import GOOD, Timestamp, Validity, Value
from mms import Quality as MmsQuality
from service.gateways.iec61850.description import ANALOGUES, CONFIGURATION_REVISION, INTEGERS, UNBALANCES
from service.gateways.kind_codes import KIND_CODES, ROTOR_CODES
from service.gateways.plant_state.device_health import DeviceHealth
from service.gateways.plant_state.figures import MotorFigures, PlantState, Quality, RelayFigures

OK, WARNING, ALARM = 1, 2, 3
"""Of EEHealth and PhyHealth (IEC 61850-7-4)."""

HEALTHS: Final[Mapping[DeviceHealth, int]] = {
    DeviceHealth.NORMAL: OK,
    DeviceHealth.OFF_SPEC: WARNING,
    DeviceHealth.CHECK_FUNCTION: WARNING,
    DeviceHealth.MAINTENANCE_REQUIRED: WARNING,
    DeviceHealth.FAILURE: ALARM,
}
UNKNOWN_TIME: Final = 0x4A
"""Quality of a time that is none: clock failure, and as many bits of a fraction as other times have."""
PERCENT: Final = 100.0
LONGEST_TEXT: Final = 255
PRINTABLE: Final = range(0x20, 0x7F)

Values = dict[str, Value | MmsQuality]


def motor_values(device: str, motor: MotorFigures, relay: RelayFigures | None) -> Values:
    """Return the attributes of a motor's logical device. device: its name with that of the IED."""
    quality, time = quality_of(motor), _time(motor.as_of_ns)
    low, high = motor.mu_f_ci95 or (None, None)
    likely = motor.phase_probabilities or (None, None, None)
    figures = (motor.mu_f, low, high, motor.detection_limit, motor.load_level, motor.change, *likely)
    values: Values = {
        **_state(f"{device}/ZMOT1.EEHealth", HEALTHS[motor.device_health], quality, time),
        **_phases(f"{device}/GAPC1.Str", motor, (State.WATCH, State.FAULT), quality, time),
        **_phases(f"{device}/GAPC1.Op", motor, (State.FAULT,), quality, time),
        **_state(f"{device}/GGIO1.IntIn1", KIND_CODES.index(motor.kind), quality, time),
        **_state(f"{device}/GGIO1.IntIn2", _rotor_code(motor.rotor), quality, time),
        **_relay_values(device, relay),
        **_unbalances(device, motor, quality),
    }
    for number, figure in enumerate(figures, start=1):
        values |= _analogue(f"{device}/GGIO1.AnIn{number}", figure, quality, time)
    return values


def plant_values(device: str, state: PlantState, before: PlantState | None = None) -> Values:
    """Return the group alarm and the group warning of the plant, or what of them has changed since before."""
    told = {} if before is None else _groups(before)
    values: Values = {}
    for name, (is_on, quality) in _groups(state).items():
        if told.get(name) != (is_on, quality):
            values |= _state(f"{device}/CALH1.{name}", is_on, quality, Timestamp(state.read_ns))
    return values


def _groups(state: PlantState) -> Mapping[str, tuple[bool, MmsQuality]]:
    quality = GOOD if state.is_current else MmsQuality(Validity.QUESTIONABLE, old_data=True)
    healths = {HEALTHS[motor.device_health] for motor in state.motors.values()}
    return {"GrAlm": (ALARM in healths, quality), "GrWrn": (WARNING in healths, quality)}


def names(device: str, text: str, vendor: str, model: str, revision: str) -> Values:
    """Return name plates, and what the numbers of a device are, for people."""
    values: Values = {
        f"{device}/LLN0.NamPlt.vendor": "StatorWatch",
        f"{device}/LLN0.NamPlt.swRev": printable(revision),
        f"{device}/LLN0.NamPlt.d": printable(text),
        f"{device}/LLN0.NamPlt.configRev": CONFIGURATION_REVISION,
        f"{device}/LPHD1.PhyNam.vendor": printable(vendor),
        f"{device}/LPHD1.PhyNam.model": printable(model),
        f"{device}/LPHD1.PhyNam.name": printable(text),
    }
    return values


def meanings(device: str) -> Values:
    """Return what the analogues and integers of a motor are, for people."""
    return {
        f"{device}/GGIO1.{kind}{number}.d": text
        for kind, texts in (("AnIn", ANALOGUES), ("IntIn", INTEGERS))
        for number, text in enumerate(texts, start=1)
    }


def quality_of(motor: MotorFigures) -> MmsQuality:
    """Return the quality of a motor's figures: old data where they are uncertain for their age."""
    if motor.quality is Quality.GOOD:
        return GOOD
    if motor.quality is Quality.BAD:
        return MmsQuality(Validity.INVALID)
    return MmsQuality(Validity.QUESTIONABLE, old_data=motor.stale)


def printable(text: str) -> str:
    """Return a text in the letters of a VisibleString; others become question marks."""
    return "".join(one if ord(one) in PRINTABLE else "?" for one in text)[:LONGEST_TEXT]


def _relay_values(device: str, relay: RelayFigures | None) -> Values:
    """Return the physical device's health: that of the relay, for which the service stands as a proxy."""
    health = WARNING if relay is None else HEALTHS[relay.device_health]
    time = _time(None if relay is None else relay.changed_ns)
    is_told = relay is not None and relay.quality is Quality.GOOD
    quality = GOOD if is_told else MmsQuality(Validity.QUESTIONABLE, old_data=True)
    return {
        **_state(f"{device}/LPHD1.PhyHealth", health, quality, time),
        **_state(f"{device}/LPHD1.Proxy", True, GOOD, time),  # noqa: FBT003 - the value of the attribute
    }


def _unbalances(device: str, motor: MotorFigures, quality: MmsQuality) -> Values:
    """Return the unbalance in the latest record that tells it; it is old where a later record does not."""
    time = _time(motor.unbalance_ns)
    if quality == GOOD and (motor.unbalance_ns or 0) < (motor.as_of_ns or 0):
        quality = MmsQuality(Validity.QUESTIONABLE, old_data=True)
    values: Values = {}
    for name, figure in zip(UNBALANCES, (motor.voltage_unbalance, motor.current_unbalance), strict=True):
        values |= _analogue(f"{device}/MSQI1.{name}", figure, quality, time)
    return values


def _time(time_ns: int | None) -> Timestamp:
    """Return a time; one that is not known says of itself that it cannot be relied on (ClockFailure)."""
    return Timestamp(0, UNKNOWN_TIME) if time_ns is None else Timestamp(time_ns)


def _state(name: str, value: Value, quality: MmsQuality, time: Timestamp) -> Values:
    return {f"{name}.stVal": value, f"{name}.q": quality, f"{name}.t": time}


def _phases(
    name: str, motor: MotorFigures, states: tuple[State, ...], quality: MmsQuality, time: Timestamp
) -> Values:
    """Return general and the phases of a start or an operation; without a phase, general stands alone."""
    is_on = motor.state in states
    values: Values = {f"{name}.general": is_on, f"{name}.q": quality, f"{name}.t": time}
    for phase in ("a", "b", "c"):
        values[f"{name}.phs{phase.upper()}"] = is_on and motor.phase == phase
    return values


def _analogue(name: str, figure: float | None, quality: MmsQuality, time: Timestamp) -> Values:
    """Return a figure in percent. One that is not known is no number, and invalid."""
    is_known = figure is not None and math.isfinite(figure)
    return {
        f"{name}.mag.f": PERCENT * figure if figure is not None and is_known else math.nan,
        f"{name}.q": quality if is_known else MmsQuality(Validity.INVALID),
        f"{name}.t": time,
    }


def _rotor_code(rotor: RotorState | None) -> int:
    return ROTOR_CODES.index(rotor) if rotor in ROTOR_CODES else 0
