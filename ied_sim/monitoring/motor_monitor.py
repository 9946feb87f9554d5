"""Measurement of a motor from moment to moment, without a simulation for each measurement.

A motor that runs steadily is simulated again only when its load, its supply or its windings have changed. A
start is simulated once, as a whole.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ied_sim.monitoring.metering import METERING_CYCLES, Metering, meter, metered
from ied_sim.motor.contactor import Closure
from ied_sim.motor.plant import DISTURBANCE_MEMORY_S, METERING_STEP_RATE_HZ, MotorPlant

Array = NDArray[np.float64]

TRACE_RATE_HZ = 2_000.0

RUNNING_BELOW = 1.5
"""Multiple of the rated current to which the current has fallen when a start ends."""
NO_CURRENT = 0.05

_NOTICEABLE_LEVEL = 0.002
_NOTICEABLE_FAULT = 1e-4
_NOTICEABLE_BROKEN_BARS = 1e-3
_NOTICEABLE_RESISTANCE = 0.002
_NOTICEABLE_VOLTAGE = 2e-4
_NOTICEABLE_GAIN = 2e-4
_NOTICEABLE_HZ = 0.001


@dataclass(frozen=True, slots=True)
class Start:
    """A motor start from rest, as the relay measured it: one row for each METERING_CYCLES.

    `closed_s` is the time of the closing [s since the simulator's start]. `duration_s` is the time until the
    current had fallen; None where it did not within the plant's `start_memory_s`. `time_s` are the times of
    the rows after the closing, `current_A` and `voltage_V` the rms values.
    """

    closed_s: float
    duration_s: float | None
    time_s: Array
    current_A: Array
    voltage_V: Array


class MotorMonitor:
    """Measures one plant; used by one thread at a time. Times are seconds since the simulator's start."""

    def __init__(self, plant: MotorPlant, rated_current_A: float) -> None:
        self._plant = plant
        self._rated_A = rated_current_A
        self._steady: tuple[Array, Metering] | None = None
        self._trace: tuple[Closure, Array] | None = None

    def closure(self, time_s: float) -> Closure | None:
        """Return since when the motor is connected, None while it is not."""
        contactor = self._plant.contactor
        return Closure() if contactor is None else contactor.closure_at(time_s)

    def measure(self, time_s: float) -> Metering:
        """Return the metered values at one moment."""
        closure = self.closure(time_s)
        if closure is None:
            self._steady = None
            return meter(self._plant, time_s)
        if time_s - closure.closed_s <= self._plant.start_memory_s:
            return self._starting(closure, time_s)
        return self._running(time_s)

    def start(self, closure: Closure) -> Start:
        """Return the start that began with `closure`."""
        samples = self._start_samples(closure)
        rows = round(self._plant.start_memory_s * self._frequency(closure.closed_s) / METERING_CYCLES)
        time_s = (np.arange(rows) + 1) * METERING_CYCLES / self._frequency(closure.closed_s)
        metering = [self._metered(samples, closure.closed_s, closure.closed_s + each) for each in time_s]
        current_A = np.array([each.current_A for each in metering])
        still = np.flatnonzero(current_A > RUNNING_BELOW * self._rated_A)
        if still.size == 0:
            duration_s: float | None = float(time_s[0])
        else:
            duration_s = None if still[-1] == rows - 1 else float(time_s[still[-1] + 1])
        voltage_V = np.array([each.voltage_V for each in metering])
        return Start(closure.closed_s, duration_s, time_s, current_A, voltage_V)

    def _frequency(self, time_s: float) -> float:
        return self._plant.supply.frequency(time_s)

    def _running(self, time_s: float) -> Metering:
        plant = self._plant
        changes = self._over_noticeable(time_s)
        quiet = plant.supply.disturbed_since(time_s, DISTURBANCE_MEMORY_S) == time_s
        if self._steady is not None and quiet:
            before, metering = self._steady
            if np.all(np.abs(changes - before) <= 1):
                return self._at_frequency(metering, time_s)
        metering = meter(plant, time_s)
        self._steady = (changes, metering) if quiet else None
        return metering

    def _over_noticeable(self, time_s: float) -> Array:
        """Return all that develops slowly, each over the least change of it that is worth a simulation."""
        plant = self._plant
        fault = plant.fault_at(time_s)
        R_s = plant.motor.parameters.stator_resistance_ohm
        level = 0.0 if fault is None else fault.equivalent_level(R_s)
        joint = 0.0 if plant.joint is None else plant.joint.resistance_ohm(time_s) / R_s
        voltage, unbalance, zero_sequence = plant.supply.sequences(np.array([time_s]))
        phasors = np.array([voltage[0], unbalance[0], zero_sequence[0]], complex)
        delays = plant.sensors.delays(time_s) * 2 * np.pi * plant.supply.frequency_Hz
        return np.array(
            [
                plant.load.level_at(time_s) / _NOTICEABLE_LEVEL,
                level / _NOTICEABLE_FAULT,
                joint / _NOTICEABLE_RESISTANCE,
                plant.broken_share(time_s) / _NOTICEABLE_BROKEN_BARS,
                *(np.array(plant.resistance_factors(time_s)) / _NOTICEABLE_RESISTANCE),
                *(phasors.view(np.float64) / _NOTICEABLE_VOLTAGE),
                *(plant.sensors.gains(time_s) / _NOTICEABLE_GAIN),
                *(delays / _NOTICEABLE_GAIN),
            ]
        )

    def _at_frequency(self, metering: Metering, time_s: float) -> Metering:
        frequency_Hz = self._frequency(time_s)
        if abs(frequency_Hz - metering.frequency_Hz) < _NOTICEABLE_HZ:
            return metering
        return replace(metering, frequency_Hz=frequency_Hz)

    def _starting(self, closure: Closure, time_s: float) -> Metering:
        return self._metered(self._start_samples(closure), closure.closed_s, time_s)

    def _metered(self, samples: Array, closed_s: float, time_s: float) -> Metering:
        """Meter the last few cycles before `time_s`, from samples that begin as long before the closing."""
        frequency_Hz = self._frequency(closed_s)
        span = round(METERING_CYCLES / frequency_Hz * TRACE_RATE_HZ)
        first = round((time_s - closed_s) * TRACE_RATE_HZ)
        direction = self._plant.supply.direction
        return metered(samples[:, first : first + span], frequency_Hz, TRACE_RATE_HZ, direction)

    def _start_samples(self, closure: Closure) -> Array:
        """Simulate the start as if the motor stayed connected: it is measured only while it does."""
        if self._trace is None or self._trace[0].closed_s != closure.closed_s:
            before_s = (
                round(METERING_CYCLES / self._frequency(closure.closed_s) * TRACE_RATE_HZ) / TRACE_RATE_HZ
            )
            window = self._plant.window(
                closure.closed_s - before_s,
                before_s + self._plant.start_memory_s + before_s,
                TRACE_RATE_HZ,
                step_rate_hz=METERING_STEP_RATE_HZ,
            )
            self._trace = (closure, window)
        return self._trace[1]
