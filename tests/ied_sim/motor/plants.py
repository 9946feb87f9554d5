"""Simulated motors on a clean supply."""

from math import sqrt

from core.machines.parameters import Motor
from ied_sim.motor.fault import FaultCourse
from ied_sim.motor.load import Load
from ied_sim.motor.plant import MotorPlant
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Supply
from testing.machines.motors import REFERENCE


def plant(
    motor: Motor = REFERENCE,
    *,
    level: float = 0.5,
    supply: Supply | None = None,
    fault: FaultCourse | None = None,
    sensors: Sensors | None = None,
    load: Load | None = None,
    seed: int = 0,
) -> MotorPlant:
    """A plant on a clean nominal supply with ideal sensors unless told otherwise."""
    nameplate = motor.nameplate
    return MotorPlant(
        motor=motor,
        supply=supply or Supply(nameplate.rated_voltage_V, nameplate.rated_frequency_Hz),
        load=load or Load(level),
        sensors=sensors or Sensors(1000 * sqrt(2), 2 * nameplate.rated_voltage_V),
        fault=fault,
        seed=seed,
    )


def short(turns: float, phase: int = 1, resistance_ohm: float = 0.0) -> FaultCourse:
    """A fault that does not develop."""
    return FaultCourse(phase, ((0.0, turns),), resistance_ohm)
