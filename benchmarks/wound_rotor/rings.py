"""What the backward-turning current tells of the resistance at the rings, beside what channels make of it."""

from concurrent.futures import Executor
from dataclasses import replace
from math import hypot, sqrt

from benchmarks.reporting import Section, table
from benchmarks.wound_rotor.cases import LARGEST_SHARE, MOTORS, rotor_of
from core.machines.parameters import Motor
from core.machines.wound_rotor import external_resistance_ohm

UNBALANCES = (0.005, 0.01, 0.02)
LOAD_LEVEL = 0.6


def sections(pool: Executor, *, quick: bool) -> list[Section]:
    """The table by motor and unbalance."""
    del pool, quick
    rows = [
        [name, f"{unbalance:.1%}", f"{_by_rings(motor, unbalance):.1%}", f"{_by_channels(motor):.1%}"]
        for name, motor in MOTORS.items()
        for unbalance in UNBALANCES
    ]
    lines = [
        f"At {LOAD_LEVEL:.0%} load. The forward-turning current does not depend on the resistance at all. "
        "The backward-turning one does where the supply is unbalanced: what all the range of the resistance "
        f"(0 to {LARGEST_SHARE:.0%} of that of rated torque at standstill) makes of it, beside the standard "
        "deviation that channels of the usual class (1 %, 25 us) have. Both are shares of the "
        "forward-turning current.",
        "",
        *table(["motor", "unbalance of the supply", "all the range", "channels"], rows),
    ]
    command = "python -m benchmarks.wound_rotor --subject rings"
    return [Section("rings", "What the backward-turning current tells", command, tuple(lines))]


def _by_rings(motor: Motor, unbalance: float) -> float:
    span = (0.0, LARGEST_SHARE * rotor_of(motor).standstill_impedance_ohm)
    most = external_resistance_ohm(
        replace(motor, wound_rotor=replace(rotor_of(motor), external_resistance_ohm=span))
    )[1]
    R_r, s = motor.parameters.rotor_resistance_ohm, _slip(motor)
    R = R_r + most
    change = _admittance(motor, R / (2.0 - s * R / R_r)) - _admittance(motor, R_r / (2.0 - s))
    return unbalance * abs(change / _admittance(motor, R_r / s))


def _by_channels(motor: Motor) -> float:
    R_r, s, sensors = motor.parameters.rotor_resistance_ohm, _slip(motor), motor.sensors
    frequency_hz = motor.nameplate.rated_frequency_Hz
    per_volt = abs(_admittance(motor, R_r / (2.0 - s)) / _admittance(motor, R_r / s))
    of_voltages = sensors.voltage_deviation(frequency_hz) * per_volt
    return hypot(sensors.current_deviation(frequency_hz), of_voltages) / sqrt(3.0)


def _slip(motor: Motor) -> float:
    """About the slip with shorted rings, in proportion to the load."""
    slip = motor.nameplate.rated_slip
    assert slip is not None
    return LOAD_LEVEL * slip


def _admittance(motor: Motor, rotor_ohm: float) -> complex:
    machine, w = motor.parameters, motor.nameplate.rated_angular_frequency
    rotor = 1.0 / complex(rotor_ohm, w * machine.rotor_leakage_H)
    air_gap = 1.0 / (rotor + 1.0 / (1j * w * machine.magnetising_inductance_H))
    return 1.0 / (machine.stator_resistance_ohm + 1j * w * machine.stator_leakage_H + air_gap)
