"""Recordings of starts from physics that the estimator shares nothing with: the simulator's windings."""

from dataclasses import dataclass, replace
from math import sqrt
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from core.machines.motor_file.reader import Plate
from core.machines.parameters import ChannelNames, Limits, MachineParameters, Motor
from core.machines.sensors import SensorClass
from core.recordings import Channel, Quantity, Recording
from ied_sim.motor.deep_bars import UNSATURATED, DeepBars, LeakageSaturation
from ied_sim.motor.load import Load, LoadCycle
from ied_sim.motor.plant import MotorPlant
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Supply

Array = NDArray[np.float64]

TRUE_RATE_HZ = 20_000.0
"""Of the simulated currents, which are interpolated where the channels sample them."""
PERIOD_S = 1_000.0
"""Time within which a load that changes has its level: longer than any record."""


@dataclass(frozen=True, slots=True)
class StartRecord:
    """How a start is recorded: `before_s` ahead of the motor's switching on, `duration_s` after it.

    busbar: voltage transformers ahead of the contactor, live all the time; else they see nothing before.
    snr_db: of white noise on the currents, of their rms over the record; voltage_snr_db: on the voltages.
    switched_at_s: position of the start in the supply's cycle.
    voltage: over the rated one.  unbalance: V2/V1.
    broken_bars: broken share of the cage's bars.  resistances: of stator and rotor over the parameters'.
    deep_bars, leakage_saturation: what a start shows of the motor beside its parameters.
    load_change: by how much the load level changes, from when on after the switching on, and how long [s].
    """

    load_level: float = 0.5
    duration_s: float = 1.0
    before_s: float = 0.04
    sample_rate_hz: float = 10_000.0
    time_offset_s: float = 0.0
    busbar: bool = False
    lines: bool = False
    sequence: Literal["abc", "acb"] = "abc"
    snr_db: float | None = None
    voltage_snr_db: float | None = None
    switched_at_s: float = 0.0
    seed: int = 0
    voltage: float = 1.0
    unbalance: float = 0.0
    broken_bars: float = 0.0
    resistances: tuple[float, float] = (1.0, 1.0)
    deep_bars: DeepBars | None = None
    leakage_saturation: LeakageSaturation = UNSATURATED
    load_change: tuple[float, float, float] | None = None

    @property
    def load(self) -> Load:
        """What the motor drives."""
        if self.load_change is None:
            return Load(self.load_level)
        change, begins_s, lasts_s = self.load_change
        begin_s, after = self.switched_at_s + begins_s, self.load_level + change
        points = ((0.0, self.load_level), (begin_s, self.load_level), (begin_s + lasts_s, after))
        return Load(self.load_level, cycle=LoadCycle((*points, (PERIOD_S, after)), 2.0 * PERIOD_S))

    def of(self, motor: Motor) -> Recording:
        """The recording: IA IB IC and three phase or two line voltages."""
        plate = motor.nameplate
        supply = Supply(
            self.voltage * plate.rated_voltage_V,
            plate.rated_frequency_Hz,
            unbalance=self.unbalance,
            sequence=self.sequence,
        )
        stator, rotor = self.resistances
        turning = with_parameters(
            motor,
            stator_resistance_ohm=stator * motor.parameters.stator_resistance_ohm,
            rotor_resistance_ohm=rotor * motor.parameters.rotor_resistance_ohm,
        )
        plant = MotorPlant(
            turning, supply, self.load, Sensors(1.0, 1.0), broken_bars=self.broken_bars,
            deep_bars=self.deep_bars, leakage_saturation=self.leakage_saturation,
        )  # fmt: skip
        true = plant.start_up(self.switched_at_s, self.duration_s, TRUE_RATE_HZ)
        behind = np.arange(true.currents_A.shape[1]) / TRUE_RATE_HZ
        t = np.arange(round((self.duration_s + self.before_s) * self.sample_rate_hz)) / self.sample_rate_hz
        t = t[t <= self.before_s + behind[-1]] - self.before_s

        currents = np.zeros((3, t.size))
        late = t - self.time_offset_s
        currents[:, late >= 0.0] = CubicSpline(behind, true.currents_A, axis=1)(late[late >= 0.0])
        voltages = supply.phase_voltages(self.switched_at_s + t)
        if not self.busbar:
            voltages[:, t < 0.0] = 0.0
        random = np.random.default_rng(self.seed)
        currents += _noise(currents, self.snr_db, random)
        voltages += _noise(voltages, self.voltage_snr_db, random)
        return Recording(
            np.vstack([currents, _lines(voltages) if self.lines else voltages]),
            self.sample_rate_hz,
            0,
            _channels(motor, lines=self.lines),
            trigger_index=round(self.before_s * self.sample_rate_hz),
            nominal_frequency_hz=plate.rated_frequency_Hz,
            source=f"start at {self.load_level:.0%} load",
        )


def plate_of(motor: Motor, parameters: MachineParameters | None = None) -> Plate:
    """The motor's nameplate with what is known of its parameters."""
    return Plate(motor.name, motor.nameplate, parameters, ChannelNames(), Limits(), SensorClass())


def with_parameters(motor: Motor, **values: float) -> Motor:
    """The motor with some of its parameters changed."""
    return replace(motor, parameters=replace(motor.parameters, **values))


def _noise(x: Array, snr_db: float | None, random: np.random.Generator) -> Array:
    if snr_db is None:
        return np.zeros_like(x)
    level = float(np.sqrt(np.mean(x**2))) * 10.0 ** (-snr_db / 20.0)
    return np.asarray(level * random.standard_normal(x.shape))


def _lines(phases: Array) -> Array:
    return np.stack([phases[0] - phases[1], phases[1] - phases[2]])


def _channels(motor: Motor, *, lines: bool) -> tuple[Channel, ...]:
    amps = 20.0 * motor.nameplate.rated_power_W / motor.nameplate.rated_voltage_V
    volts = 2.0 * sqrt(2.0) * motor.nameplate.rated_voltage_V
    currents = [Channel(f"I{p.upper()}", Quantity.CURRENT, p, "A", amps) for p in "abc"]
    quantity = Quantity.LINE_VOLTAGE if lines else Quantity.PHASE_VOLTAGE
    names = ("ab", "bc") if lines else ("a", "b", "c")
    return (*currents, *(Channel(f"V{p.upper()}", quantity, p, "V", volts) for p in names))
