"""What is known of a motor by its nameplate and its parameters, and where that comes from."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from core.machines.parameters import Connection, Motor, WoundRotor
from core.machines.stator_winding import StatorWinding, winding_words
from core.quantity_text import with_unit
from service.condition.motor_data import motor_known
from service.condition.parameter_sources import SOURCES
from service.storage.records import MotorVersion
from service.web.words import percent

DIGITS: Final = 4


@dataclass(frozen=True, slots=True)
class Fact:
    """A figure by its name. origin: where it comes from; empty where that is plain."""

    name: str
    value: str
    origin: str = ""


@dataclass(frozen=True, slots=True)
class KnownMotor:
    """A motor as its files say it is.

    rated: of the nameplate.  parameters: of the equivalent circuit.  source: where those come from.
    settings: limits and classes.  since_ns: the files have said so since then; None from the beginning.
    """

    motor: Motor
    rated: Sequence[Fact]
    parameters: Sequence[Fact]
    source: str
    settings: Sequence[Fact]
    since_ns: int | None


def known_motor(name: str, versions: Sequence[MotorVersion]) -> KnownMotor | None:
    """Return what the files say of a motor now; None before a service has read them."""
    if not versions:
        return None
    latest = versions[-1]
    motor = motor_known(name, latest.document)
    return KnownMotor(
        motor=motor,
        rated=_rated(motor),
        parameters=_parameters(motor),
        source=SOURCES[motor.parameters_source],
        settings=_settings(motor),
        since_ns=latest.from_ns if len(versions) > 1 else None,
    )


def _rated(motor: Motor) -> list[Fact]:
    plate = motor.nameplate
    speed = 60.0 * plate.rated_frequency_Hz / plate.pole_pairs
    file = "motors file"
    return [
        Fact("Rated power at the shaft", with_unit(plate.rated_power_W, "W", DIGITS), file),
        Fact("Rated voltage, line to line", with_unit(plate.rated_voltage_V, "V", DIGITS), file),
        Fact("Rated frequency", with_unit(plate.rated_frequency_Hz, "Hz", DIGITS), file),
        Fact("Poles", f"{2 * plate.pole_pairs}, {speed:.0f} rpm without slip", file),
        Fact("Connection", "delta" if plate.connection is Connection.DELTA else "star", file),
        _of_winding(motor.winding),
        *_of_rotor(motor.wound_rotor),
    ]


def _of_winding(winding: StatorWinding | None) -> Fact:
    if winding is None:
        return Fact("Stator winding", "not given")
    return Fact("Stator winding", winding_words(winding), "motors file")


def _of_rotor(rotor: WoundRotor | None) -> list[Fact]:
    if rotor is None:
        return []
    volts = with_unit(rotor.open_circuit_voltage_V, "V", DIGITS)
    rated = f"wound, {volts}, {with_unit(rotor.rated_current_A, 'A', DIGITS)}"
    least, most = rotor.external_resistance_ohm
    known = with_unit(most, "ohm", DIGITS)
    between = known if least == most else f"{with_unit(least, 'ohm', DIGITS)} to {known}, unknown"
    return [
        Fact("Rotor", rated, "motors file"),
        Fact("At the slip rings while running", between if most > 0.0 else "shorted", "motors file"),
    ]


def _parameters(motor: Motor) -> list[Fact]:
    values, tolerances = motor.parameters, motor.tolerances
    known = (
        ("Stator resistance R_s", values.stator_resistance_ohm, "ohm", tolerances.stator_resistance_ohm),
        ("Rotor resistance R_r'", values.rotor_resistance_ohm, "ohm", tolerances.rotor_resistance_ohm),
        ("Stator leakage L_ls", values.stator_leakage_H, "H", tolerances.stator_leakage_H),
        ("Rotor leakage L_lr'", values.rotor_leakage_H, "H", tolerances.rotor_leakage_H),
        (
            "Stator self-inductance L_s",
            values.stator_self_inductance_H,
            "H",
            tolerances.stator_self_inductance_H,
        ),
    )
    facts = [
        Fact(name, with_unit(value, unit, DIGITS), f"within {percent(tolerance, 0)}")
        for name, value, unit, tolerance in known
    ]
    return [*facts, Fact("Inertia J of motor and load", with_unit(values.inertia_kgm2, "kg m²", DIGITS))]


def _settings(motor: Motor) -> list[Fact]:
    sensors = motor.sensors
    return [
        Fact("Limit of the fault level", percent(motor.limits.fault_level), "motors file"),
        Fact(
            "Voltage channels",
            f"within {percent(sensors.voltage_gain, 1)} and {1e6 * sensors.voltage_delay_s:.0f} µs",
            "sensor class",
        ),
        Fact(
            "Current channels",
            f"within {percent(sensors.current_gain, 1)} and {1e6 * sensors.current_delay_s:.0f} µs",
            "sensor class",
        ),
    ]
