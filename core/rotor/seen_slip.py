"""The motor as it runs: with the rotor resistance at which its model slips as the current shows."""

from dataclasses import replace

from core.machines.parameters import Motor
from core.rotor.baseband import Baseband
from core.rotor.running_point import running_point
from core.speed.finding import SpeedFinding
from core.speed.record import LONGEST_S

PLACED = "the sidebands are placed by the speed that is seen in the current"


def at_seen_slip(baseband: Baseband, motor: Motor, speed: SpeedFinding | None) -> Motor:
    """Correct the rotor resistance of a motor by the slip that is seen.

    At a given torque the slip goes with the rotor resistance, which a warm rotor raises by a third. The
    torque is that of the stretch in which the speed was seen.

    Parameters
    ----------
    baseband : Baseband
        The record, currents in step with the voltages.
    motor : Motor
        The motor as its file has it.
    speed : SpeedFinding or None
        The speed of the record.

    Returns
    -------
    Motor
        The motor; as it was where no speed is seen, or it does not slip by the model.
    """
    seen = None if speed is None else speed.seen_slip
    if seen is None or motor.wound_rotor is not None:
        return motor
    end = baseband.time_s >= baseband.time_s[-1] - LONGEST_S
    part = replace(
        baseband,
        time_s=baseband.time_s[end],
        angular_frequency=baseband.angular_frequency[end],
        voltage=baseband.voltage[end],
        current=baseband.current[end],
    )
    expected = running_point(part, motor).slip(motor)
    if expected <= 0.0 or seen <= 0.0:
        return motor
    machine = motor.parameters
    resistance_ohm = machine.rotor_resistance_ohm * seen / expected
    return replace(motor, parameters=replace(machine, rotor_resistance_ohm=resistance_ohm))
