"""A running motor as it can be estimated beforehand: torque at a small slip, and a state to settle from."""

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
from numpy.typing import NDArray

from core.machines.parameters import Connection, Motor
from ied_sim.motor.slip_rings import SlipRings
from ied_sim.motor.supply import Supply
from ied_sim.motor.windings import WindingCircuit


@dataclass(frozen=True, slots=True)
class RunningMotor:
    """A motor on its supply, with what is at its slip rings if it has any."""

    motor: Motor
    supply: Supply
    rings: SlipRings | None = None

    def torque_over_slip(self, time_s: float, frequency_Hz: float) -> float:
        """Return the torque over the slip where this is small [N m]."""
        nameplate, R_r = self.motor.nameplate, self.motor.parameters.rotor_resistance_ohm
        if self.rings is not None:
            R_r += self.rings.turns_ratio**2 * self.rings.outside_ohm(time_s)
        w, star = 2 * pi * frequency_Hz, nameplate.connection is Connection.STAR
        winding_V = self.supply.line_voltage_V / sqrt(3) if star else self.supply.line_voltage_V
        return 3 * nameplate.pole_pairs * winding_V**2 / (w * R_r)

    def state(
        self, circuit: WindingCircuit, time_s: float, *, load_level: float, angle: float
    ) -> NDArray[np.float64]:
        """Estimate a state close enough to settle from: no-load fluxes, and slip in proportion to torque."""
        nameplate = self.motor.nameplate
        w = 2 * np.pi * self.supply.frequency(time_s)
        quarter_cycle_ago = np.array([time_s - np.pi / 2 / w])
        flux = circuit.drive @ self.supply.phase_voltages(quarter_cycle_ago)[:, 0] / w
        stator = np.flatnonzero(circuit.drive.any(axis=1))
        inductance = circuit.inductance(angle)
        currents = np.zeros(circuit.loops)
        currents[stator] = np.linalg.solve(inductance[np.ix_(stator, stator)], flux[stator])
        pull = self.torque_over_slip(time_s, self.supply.frequency(time_s))
        slip = load_level * nameplate.rated_torque_Nm / pull
        speed = self.supply.direction * (1 - slip) * w / nameplate.pole_pairs
        return np.concatenate((inductance @ currents, [speed, angle]))
