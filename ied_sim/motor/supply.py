"""The busbar: three phase voltages as a function of time alone, so that any two windows of it agree."""

from dataclasses import dataclass
from math import pi, sqrt
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ied_sim.motor.wander import Wander

Array = NDArray[np.float64]
Phasors = NDArray[np.complex128]


@dataclass(frozen=True, slots=True)
class Harmonic:
    """One harmonic voltage: its order, its share of the fundamental and its angle to it.

    Its order determines its sequence: the 5th is negative, the 7th positive. Orders divisible by three have
    none and drive no current into three wires.
    """

    order: int
    fraction: float
    angle_rad: float = 0.0


@dataclass(frozen=True, slots=True)
class SupplyEvent:
    """A dip, swell or interruption: voltages of `phases` times `factor` from `at_s` for `duration_s` [s].

    `phases` are indices, 0 to 2. The event is repeated every `every_s`; with None it comes once.
    """

    at_s: float
    duration_s: float
    factor: float
    phases: tuple[int, ...] = (0, 1, 2)
    every_s: float | None = None

    def under_way(self, time_s: Array) -> NDArray[np.bool_]:
        """Tell whether the event is under way at the times [s], same shape."""
        since = time_s - self.at_s
        if self.every_s is not None:
            since = np.where(since >= 0, since % self.every_s, since)
        happening: NDArray[np.bool_] = (since >= 0) & (since < self.duration_s)
        return happening

    def latest_begin_s(self, time_s: float) -> float | None:
        """Return when the event last began at or before `time_s`, None if never."""
        if time_s < self.at_s:
            return None
        if self.every_s is None:
            return self.at_s
        return time_s - (time_s - self.at_s) % self.every_s


@dataclass(frozen=True, slots=True)
class SupplyStep:
    """A lasting change at `at_s` [s]: relative, of the voltage; phasors over V1, of V2 and V0."""

    at_s: float
    voltage: float = 0.0
    unbalance: complex = 0.0
    zero_sequence: complex = 0.0


@dataclass(frozen=True, slots=True)
class SupplyWander:
    """How far voltage, V2/V1 and V0/V1 wander.

    Each is a standard deviation: that of the voltage relative, those of V2 and V0 of real and imaginary part.
    """

    voltage: float = 0.0
    unbalance: float = 0.0
    zero_sequence: float = 0.0
    time_constant_s: float = 10_800.0
    seed: int = 0

    def at(self, time_s: Array) -> "Sequences":
        """Return what the wander adds at the times [s]."""

        def wander(stream: int) -> Array:
            return Wander(self.seed, stream, self.time_constant_s).at(time_s)

        return Sequences(
            self.voltage * wander(0),
            np.asarray(self.unbalance * (wander(1) + 1j * wander(2)), complex),
            np.asarray(self.zero_sequence * (wander(3) + 1j * wander(4)), complex),
        )


class Sequences(NamedTuple):
    """Voltage over its mean, V2/V1 and V0/V1, shape (n,), or (1,) where they are constant."""

    voltage: Array
    unbalance: Phasors
    zero_sequence: Phasors


@dataclass(frozen=True, slots=True)
class Supply:
    """Voltages of a three-phase busbar.

    Parameters
    ----------
    line_voltage_V : float
        Positive-sequence line-to-line voltage, rms.
    frequency_Hz : float
        Mean frequency.
    frequency_drift_Hz, drift_period_s : float
        Amplitude and period of the frequency's swing about its mean.
    unbalance, unbalance_angle_rad : float
        Voltage unbalance factor |V2| / |V1| and the angle of V2 to V1.
    harmonics : tuple of Harmonic
        Harmonic voltages.
    sequence : {"abc", "acb"}
        Order of the phases. With acb motors turn backwards.
    events : tuple of SupplyEvent
        Dips, swells and interruptions.
    zero_sequence, zero_sequence_angle_rad : float
        |V0| / |V1| and the angle of V0 to V1. It drives no current into three wires.
    wander : SupplyWander, optional
        How far voltage, V2 and V0 wander.
    steps : tuple of SupplyStep
        Lasting changes.
    """

    line_voltage_V: float
    frequency_Hz: float
    frequency_drift_Hz: float = 0.0
    drift_period_s: float = 300.0
    unbalance: float = 0.0
    unbalance_angle_rad: float = 0.0
    harmonics: tuple[Harmonic, ...] = ()
    sequence: Literal["abc", "acb"] = "abc"
    events: tuple[SupplyEvent, ...] = ()
    zero_sequence: float = 0.0
    zero_sequence_angle_rad: float = 0.0
    wander: SupplyWander | None = None
    steps: tuple[SupplyStep, ...] = ()

    @property
    def direction(self) -> int:
        """Direction of the field: +1 from a to b to c, -1 the other way."""
        return 1 if self.sequence == "abc" else -1

    def frequency(self, time_s: float) -> float:
        """Return the frequency at one moment [Hz]."""
        return self.frequency_Hz + self.frequency_drift_Hz * float(
            np.sin(2 * pi * time_s / self.drift_period_s)
        )

    def angle(self, time_s: Array) -> Array:
        """Return the angle of the fundamental of phase a at the times [s], shape (n,) [rad]."""
        swing = self.frequency_drift_Hz * self.drift_period_s / (2 * pi)
        turns = self.frequency_Hz * time_s - swing * np.cos(2 * pi * time_s / self.drift_period_s)
        angle: Array = 2 * pi * turns
        return angle

    def sequences(self, time_s: Array) -> Sequences:
        """Return voltage, V2 and V0 at the times [s], shape (n,)."""
        voltage = np.ones(1)
        unbalance = np.array([self.unbalance * np.exp(1j * self.unbalance_angle_rad)])
        zero_sequence = np.array([self.zero_sequence * np.exp(1j * self.zero_sequence_angle_rad)])
        for step in self.steps:
            since = time_s >= step.at_s
            voltage = voltage + step.voltage * since
            unbalance = unbalance + step.unbalance * since
            zero_sequence = zero_sequence + step.zero_sequence * since
        if self.wander is not None:
            wander = self.wander.at(time_s)
            voltage = voltage + wander.voltage
            unbalance = unbalance + wander.unbalance
            zero_sequence = zero_sequence + wander.zero_sequence
        return Sequences(voltage, unbalance, zero_sequence)

    def phase_voltages(self, time_s: Array) -> Array:
        """Return phase voltages of a, b, c [V], shape (3, n), at the times [s], shape (n,)."""
        angle = self.angle(time_s)
        behind = self.direction * np.array([[0.0], [2 * pi / 3], [4 * pi / 3]])
        sequences = self.sequences(time_s)
        voltages: Array = np.cos(angle - behind)
        if np.any(sequences.unbalance):
            voltages += _oscillation(sequences.unbalance, angle + behind)
        if np.any(sequences.zero_sequence):
            voltages += _oscillation(sequences.zero_sequence, angle)
        for harmonic in self.harmonics:
            h = harmonic.order
            voltages += harmonic.fraction * np.cos(h * (angle - behind) + harmonic.angle_rad)
        voltages *= sqrt(2 / 3) * self.line_voltage_V * sequences.voltage
        for event in self.events:
            happening = event.under_way(time_s)
            for phase in event.phases:
                voltages[phase, happening] *= event.factor
        return voltages

    def disturbed_since(self, time_s: float, memory_s: float) -> float:
        """Return when the earliest event felt at `time_s` began; `time_s` if there is none.

        An event is felt up to `memory_s` after its end, a step so long after it.
        """
        begins = [time_s]
        begins += [step.at_s for step in self.steps if step.at_s <= time_s < step.at_s + memory_s]
        for event in self.events:
            begin_s = event.latest_begin_s(time_s)
            if begin_s is not None and time_s < begin_s + event.duration_s + memory_s:
                begins.append(begin_s)
        return min(begins)


def _oscillation(phasor: Phasors, angle: Array) -> Array:
    """Return the real part of a phasor that turns by `angle`."""
    turned: Array = np.abs(phasor) * np.cos(angle + np.angle(phasor))
    return turned
