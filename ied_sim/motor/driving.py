"""What drives a motor, and what loads it, over time."""

import numpy as np
from numpy.typing import NDArray

from core.machines.parameters import Nameplate
from ied_sim.motor.integration import Drive
from ied_sim.motor.load import Load
from ied_sim.motor.supply import Supply
from ied_sim.motor.windings import WindingCircuit

Array = NDArray[np.float64]


def drive(
    circuit: WindingCircuit, supply: Supply, load: Load, nameplate: Nameplate, times: Array, step_s: float
) -> Drive:
    """Return what drives and what loads a motor at the times [s], which are half a step apart."""
    rated_torque = supply.direction * nameplate.rated_torque_Nm
    pulsations = load.pulsations
    supply_angle = supply.angle(times)
    angles = np.zeros((times.size, len(pulsations)))
    for k, pulsation in enumerate(pulsations):
        angles[:, k] = pulsation.angle(times, supply_angle)
    return Drive(
        np.ascontiguousarray(supply.phase_voltages(times).T @ circuit.drive.T),
        rated_torque * load.levels(times),
        rated_torque * np.array([pulsation.depth for pulsation in pulsations]),
        np.array([pulsation.order(nameplate.pole_pairs, supply.direction) for pulsation in pulsations]),
        angles,
        step_s,
    )
