"""Records of motors with broken rotor bars and with loads that swing, from the simulator's own physics."""

from dataclasses import dataclass, field, replace
from math import log10, pi

import numpy as np
from numpy.typing import NDArray

from core.machines.parameters import Motor
from core.recordings import Recording
from ied_sim.motor.cage import cage_loops
from ied_sim.motor.load import Load
from ied_sim.motor.plant import MotorPlant, Operation, rated_current
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Harmonic, Supply
from testing.machines.disturbed_records import record_of

FREQUENCY_HZ = 50.03
STEP_RATE_HZ = 10_000.0
HARMONICS = (Harmonic(5, 0.02), Harmonic(7, 0.01, 1.0))


@dataclass(frozen=True, slots=True)
class RotorCase:
    """A motor in steady running.

    broken_share: of the cage's bars.  swing: of the load's torque, over the rated one, at swing_hz.
    noise: white, of rated values.  inertia_factor: true inertia over that of the parameters.
    supply: instead of one with harmonics and a little unbalance.
    """

    motor: Motor
    load_level: float = 0.6
    broken_share: float = 0.0
    swing: float = 0.0
    swing_hz: float = 1.0
    noise: float = 0.002
    inertia_factor: float = 1.0
    supply: Supply | None = field(default=None)

    @property
    def plant(self) -> MotorPlant:
        """The simulated motor."""
        nameplate, machine = self.motor.nameplate, self.motor.parameters
        heavy = replace(machine, inertia_kgm2=self.inertia_factor * machine.inertia_kgm2)
        supply = Supply(nameplate.rated_voltage_V, FREQUENCY_HZ, unbalance=0.01, harmonics=HARMONICS)
        amps = rated_current(self.motor)
        return MotorPlant(
            replace(self.motor, parameters=heavy),
            self.supply or supply,
            Load(self.load_level, self.swing, 1.0 / self.swing_hz),
            Sensors(10.0 * amps, 2.0 * nameplate.rated_voltage_V, offsets=(0.002,) * 6, noise=self.noise),
            broken_bars=self.broken_share,
        )

    def operation(self, duration_s: float, sample_rate_hz: float, settling_s: float = 2.0) -> Operation:
        """True operation."""
        return self.plant.operation(
            0.0, duration_s, sample_rate_hz, settling_s=settling_s, step_rate_hz=STEP_RATE_HZ
        )

    def record(self, duration_s: float, sample_rate_hz: float = 5_000.0, *, seed: int = 0) -> Recording:
        """What a relay records."""
        return measured(self, self.operation(duration_s, sample_rate_hz), sample_rate_hz, seed)

    @property
    def asymmetry_dB(self) -> float:
        """Half the difference of the conductances of the simulated cage's axes, over their mean [dB].

        They are those of its network of bars and rings at the slip zero.
        """
        plant = self.plant
        machine, pole_pairs = plant.motor.parameters, plant.motor.nameplate.pole_pairs
        cage = cage_loops(machine, pole_pairs, plant.cage, self.broken_share)
        low, high = np.linalg.eigvalsh(cage.axes @ np.linalg.solve(cage.resistance, cage.axes.T))
        return 20.0 * log10(float((high - low) / (high + low)))

    def slip(self) -> float:
        """Mean slip, from the simulated speed over a slow swing's period or a second."""
        operation = self.operation(max(1.0, 1.0 / self.swing_hz), 1_000.0)
        synchronous = 2.0 * pi * FREQUENCY_HZ / self.motor.nameplate.pole_pairs
        return 1.0 - float(operation.speed_rad_s.mean()) / synchronous


def measured(case: RotorCase, operation: Operation, sample_rate_hz: float, seed: int) -> Recording:
    """Samples of a true operation, with noise of their own."""
    plant = case.plant
    true = np.vstack([operation.currents_A, operation.voltages_V])
    return record_of(
        plant.sensors.measure(true, plant.rated_values, np.random.default_rng(seed)), sample_rate_hz
    )


def one_phase(record: Recording) -> NDArray[np.float64]:
    """Samples of the current of phase a."""
    return np.asarray(record.samples[0])
