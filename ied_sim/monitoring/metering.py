"""Metered values as on the relay's front panel: phasors of a few cycles, and what follows from them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ied_sim.motor.plant import METERING_STEP_RATE_HZ, MotorPlant

METERING_CYCLES = 5

_TURN = np.exp(2j * np.pi / 3)


@dataclass(frozen=True, slots=True)
class Metering:
    """Metered values: currents and voltages as rms phasors (angles to V_a), power with motor convention.

    Sequence components are positive, negative and zero with respect to the supply's own phase rotation, as in
    a relay whose rotation setting is right.
    """

    frequency_Hz: float
    currents_A: NDArray[np.complex128]
    phase_voltages_V: NDArray[np.complex128]
    direction: int

    @property
    def line_voltages_V(self) -> NDArray[np.complex128]:
        """V_ab, V_bc, V_ca."""
        return self.phase_voltages_V - np.roll(self.phase_voltages_V, -1)

    @property
    def complex_power_VA(self) -> complex:
        """P + jQ into the motor."""
        return complex(np.sum(self.phase_voltages_V * self.currents_A.conj()))

    @property
    def power_factor(self) -> float:
        """P / |S|; 0 where nothing flows."""
        apparent = abs(self.complex_power_VA)
        return self.complex_power_VA.real / apparent if apparent > 0 else 0.0

    @property
    def current_A(self) -> float:
        """Mean of the three currents."""
        return float(np.mean(np.abs(self.currents_A)))

    @property
    def voltage_V(self) -> float:
        """Mean of the three line voltages."""
        return float(np.mean(np.abs(self.line_voltages_V)))

    @property
    def unbalance(self) -> float:
        """|I2| / |I1|; 0 where nothing flows."""
        positive, negative, _ = np.abs(self.sequence(self.currents_A))
        return float(negative / positive) if positive > 0 else 0.0

    def sequence(self, phasors: NDArray[np.complex128]) -> NDArray[np.complex128]:
        """Positive, negative and zero sequence of three phasors."""
        a = _TURN**self.direction
        to_sequences = np.array([[1, a, a**2], [1, a**2, a], [1, 1, 1]]) / 3
        return to_sequences @ phasors


def meter(plant: MotorPlant, time_s: float) -> Metering:
    """Meter the last few cycles before a time since the simulator's start."""
    frequency_Hz = plant.supply.frequency(time_s)
    duration_s = METERING_CYCLES / frequency_Hz
    rate_Hz = METERING_STEP_RATE_HZ
    samples = plant.window(time_s - duration_s, duration_s, rate_Hz, step_rate_hz=rate_Hz)
    return metered(samples, frequency_Hz, rate_Hz, plant.supply.direction)


def metered(samples: NDArray[np.float64], frequency_Hz: float, rate_Hz: float, direction: int) -> Metering:
    """Fit phasors to samples of IA IB IC VA VB VC, shape (6, n), a few cycles long."""
    angle = 2 * np.pi * frequency_Hz / rate_Hz * np.arange(samples.shape[1])
    # The phasors are fitted, because the window need not hold a whole number of samples per cycle.
    basis = np.vstack((np.cos(angle), -np.sin(angle)))
    fitted, *_ = np.linalg.lstsq(basis.T, samples.T)
    phasors = (fitted[0] + 1j * fitted[1]) / np.sqrt(2)
    phasors *= np.exp(-1j * np.angle(phasors[3]))
    return Metering(frequency_Hz, phasors[:3], phasors[3:], direction)


def metered_values(metering: Metering, mmxu: str | None, msqi: str | None) -> dict[str, float | complex]:
    """Return the values of the metering data objects by their reference; complex ones are vectors."""
    power = metering.complex_power_VA
    values: dict[str, float | complex] = {}
    vectors = {}
    if mmxu is not None:
        values = {
            f"{mmxu}.Hz": metering.frequency_Hz,
            f"{mmxu}.TotW": power.real,
            f"{mmxu}.TotVAr": power.imag,
            f"{mmxu}.TotVA": abs(power),
            f"{mmxu}.TotPF": metering.power_factor,
        }
        vectors = {
            f"{mmxu}.A": (("phsA", "phsB", "phsC"), metering.currents_A),
            f"{mmxu}.PhV": (("phsA", "phsB", "phsC"), metering.phase_voltages_V),
            f"{mmxu}.PPV": (("phsAB", "phsBC", "phsCA"), metering.line_voltages_V),
        }
    if msqi is not None:
        vectors[f"{msqi}.SeqA"] = (("c1", "c2", "c3"), metering.sequence(metering.currents_A))
        vectors[f"{msqi}.SeqV"] = (("c1", "c2", "c3"), metering.sequence(metering.phase_voltages_V))
    for reference, (names, phasors) in vectors.items():
        values |= {
            f"{reference}.{name}": complex(phasor) for name, phasor in zip(names, phasors, strict=True)
        }
    return values
