"""Motors the tests of the plant simulation speak of."""

from math import sqrt

from core.machines.parameters import Connection, MachineParameters, Motor, Nameplate
from ied_sim.motor.fault import FaultCourse
from ied_sim.motor.load import Load
from ied_sim.motor.plant import MotorPlant
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Supply

REFERENCE = Motor(
    "reference", Nameplate(800, 380, 50, 2), MachineParameters(8.4, 8.2, 0.0328, 0.0328, 0.4377, 0.0229)
)
DELTA = Motor(
    "delta",
    Nameplate(37_000, 400, 50, 2, Connection.DELTA),
    MachineParameters(0.247, 0.1509, 0.002172, 0.002172, 0.05422, 0.37),
)
SMALL = Motor(
    "7.5 kW",
    Nameplate(7_500, 400, 50, 2),
    MachineParameters(0.7384, 0.7402, 0.003045, 0.003045, 0.08273, 0.0343),
)


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
