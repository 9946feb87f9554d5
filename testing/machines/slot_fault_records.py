"""Records of motors with turns shorted inside one coil: simulated in time, or made of steady phasors.

`SlotFaultCase.recording` integrates the simulator's circuits (speed ripple, transients that have settled, a
tenth of a second a record). `SlotFaultCase.steady_recording` samples phasors of one slip (some milliseconds):
for statistics over thousands. Sensors, quantisation and noise are the same in both. `drawn_case` draws a
motor, its winding, a fault and all that records have besides.
"""

from dataclasses import dataclass, replace
from math import pi

import numpy as np
from numpy.typing import NDArray

from core.machines.parameters import Connection, Motor
from core.machines.sensors import SensorClass
from core.recordings import Recording
from ied_sim.motor.cage import USUAL_CAGE, Cage
from ied_sim.motor.fault import FaultCourse
from ied_sim.motor.load import Load
from ied_sim.motor.plant import MotorPlant, rated_current
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.slots import SlotWinding
from ied_sim.motor.supply import Harmonic, Supply
from testing.machines.disturbed_records import record_of
from testing.machines.phase_circuits import Operation
from testing.machines.rated_motors import POLES, POWERS_KW, rated_motor
from testing.machines.slot_faults import CoilFault, SteadyCoils

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

IDEAL = SensorClass(0.0, 0.0, 0.0, 0.0)
PRECISE = SensorClass(0.002, 0.002, 5e-6, 5e-6)
USUAL = SensorClass(0.01, 0.01, 25e-6, 25e-6)
FULL_SCALE_CURRENT = 12.0
FULL_SCALE_VOLTAGE = 2.0
WINDINGS = {
    2: (("lap", 24, 2, 10), ("lap", 36, 2, 15), ("concentric", 24, 1, None)),
    4: (("lap", 24, 2, 5), ("lap", 36, 2, 8), ("lap", 48, 2, 10), ("concentric", 36, 1, None)),
    6: (("lap", 36, 2, 5), ("lap", 54, 2, 8), ("concentric", 36, 1, None)),
    8: (("lap", 48, 2, 5), ("lap", 72, 2, 8), ("concentric", 48, 1, None)),
}
"""Kind, slots, layers and pitch of windings that motors have, by their poles."""


def windings_of(poles: int) -> tuple[SlotWinding, ...]:
    """Windings that motors of so many poles have."""
    made = []
    for kind, slots, layers, pitch in WINDINGS[poles]:
        made.append(SlotWinding("lap" if kind == "lap" else "concentric", slots, layers, pitch))
    return tuple(made)


@dataclass(frozen=True, slots=True)
class SlotFaultCase:
    """A running motor with a winding by slots, and what a relay records of it.

    fault: None for a healthy one.  load_level: over rated torque.  unbalance, zero_sequence: V2/V1 and V0/V1.
    relative_voltage: V1 over the rated one.  harmonics: of the voltage.  reverse: the supply turns a-c-b.
    sensors: errors of the channels are drawn from this class, uniform, by `seed`.  common_delay_s: of the
    currents.  noise: white, over rated values, rms.  seed: also of noise and of the supply's angle.
    record: its number among those of a motor: channels stay, noise and the supply's angle are others.
    inertia_kgm2: added to the motor's, in time alone: the speed of a steady case is constant.
    """

    motor: Motor
    winding: SlotWinding
    fault: CoilFault | None = None
    load_level: float = 0.6
    unbalance: complex = 0.0
    zero_sequence: complex = 0.0
    relative_voltage: float = 1.0
    harmonics: tuple[Harmonic, ...] = ()
    reverse: bool = False
    sensors: SensorClass = IDEAL
    common_delay_s: float = 0.0
    noise: float = 0.0
    sample_rate_hz: float = 4_000.0
    duration_s: float = 0.5
    seed: int = 0
    record: int = 0
    cage: Cage = USUAL_CAGE
    inertia_kgm2: float = 0.0

    @property
    def equivalent_level(self) -> float:
        """Truth: m = mu / (1 + p) of all turns of the phase, 0 of a healthy motor."""
        return 0.0 if self.fault is None else self.fault.equivalent_level(self.winding)

    @property
    def axis_rad(self) -> float:
        """Truth: angle of the faulted coil's axis from its phase's, positive from a towards b."""
        coil = 1 if self.fault is None else self.fault.coil
        return self.winding.axis_rad(self.motor.nameplate.pole_pairs, coil)

    def steady(self) -> Operation:
        """True line currents and phase voltages (rms phasors of a, b, c) and slip, with all of the field."""
        return self._coils().running(
            self.load_level,
            unbalance=self.unbalance,
            relative_voltage=self.relative_voltage,
            reverse=self.reverse,
            zero_sequence=self.zero_sequence,
        )

    def measured_phasors(self) -> Operation:
        """`steady` as the channels show it, with their gains and delays and without noise."""
        true = self.steady()
        delays_s, gains = self._delays_s(), 1.0 + np.array(self._gain_errors())
        w = self.motor.nameplate.rated_angular_frequency
        seen = np.concatenate((true.line_current, true.phase_voltage)) * gains * np.exp(-1j * w * delays_s)
        return Operation(seen[:3], seen[3:], true.slip)

    def steady_recording(self) -> Recording:
        """What a relay records at constant speed, by phasors of the fundamental and the harmonics."""
        true, coils = self.steady(), self._coils()
        w, delays_s = self.motor.nameplate.rated_angular_frequency, self._delays_s()
        times = np.arange(round(self.duration_s * self.sample_rate_hz)) / self.sample_rate_hz
        samples = np.zeros((6, times.size))
        angle = float(np.random.default_rng([self.seed, 2, self.record]).uniform(0.0, 2 * pi))
        waves = [(1, true.line_current, true.phase_voltage)]
        slip = 2.0 - true.slip if self.reverse else true.slip
        for harmonic in self.harmonics:
            voltage = self._harmonic_voltage(harmonic)
            waves.append(
                (harmonic.order, coils.currents(voltage, slip, harmonic.order)[0], voltage),
            )
        for order, current, voltage in waves:
            phasors = np.concatenate((current, voltage))[:, None]
            phase = order * (w * (times - delays_s[:, None]) + angle)
            samples += np.sqrt(2) * np.real(phasors * np.exp(1j * phase))
        random = np.random.default_rng([self.seed, 3, self.record])
        plant = self.plant()
        return record_of(plant.sensors.measure(samples, plant.rated_values, random), self.sample_rate_hz)

    def recording(self, *, start_s: float = 0.0) -> Recording:
        """What a relay records from `start_s` on, simulated in time."""
        window = self.plant().window(start_s, self.duration_s, self.sample_rate_hz)
        return record_of(window, self.sample_rate_hz)

    def plant(self) -> MotorPlant:
        """The simulated motor."""
        nameplate, fault = self.motor.nameplate, None
        if self.fault is not None and self.fault.share > 0.0:
            turns = self.fault.of(self.motor, self.winding)
            fault = FaultCourse(
                turns.phase, ((0.0, turns.turns),), turns.resistance_ohm, 0.0, turns.coil, turns.branches
            )
        return MotorPlant(
            self.motor,
            Supply(
                nameplate.rated_voltage_V * self.relative_voltage,
                nameplate.rated_frequency_Hz,
                unbalance=abs(self.unbalance),
                unbalance_angle_rad=float(np.angle(self.unbalance)),
                harmonics=self.harmonics,
                sequence="acb" if self.reverse else "abc",
                zero_sequence=abs(self.zero_sequence),
                zero_sequence_angle_rad=float(np.angle(self.zero_sequence)),
            ),
            Load(self.load_level, inertia_kgm2=self.inertia_kgm2),
            Sensors(
                FULL_SCALE_CURRENT * np.sqrt(2) * rated_current(self.motor),
                FULL_SCALE_VOLTAGE * np.sqrt(2 / 3) * nameplate.rated_voltage_V,
                gain_errors=self._gain_errors(),
                noise=self.noise,
                delays_s=tuple(self._delays_s().tolist()),
            ),
            fault=fault,
            seed=self.seed,
            cage=self.cage,
            winding=self.winding,
        )

    def _coils(self) -> SteadyCoils:
        return SteadyCoils.of(self.motor, self.winding, self.fault, cage=self.cage)

    def _harmonic_voltage(self, harmonic: Harmonic) -> Complex:
        behind = (-1 if self.reverse else 1) * 2 * pi / 3 * np.arange(3)
        volts = self.motor.nameplate.rated_voltage_V / np.sqrt(3) * self.relative_voltage * harmonic.fraction
        return np.asarray(volts * np.exp(1j * (harmonic.angle_rad - harmonic.order * behind)), np.complex128)

    def _gain_errors(self) -> tuple[float, ...]:
        drawn = np.random.default_rng([self.seed, 0]).uniform(-1.0, 1.0, 6)
        return tuple((drawn * np.repeat([self.sensors.current_gain, self.sensors.voltage_gain], 3)).tolist())

    def _delays_s(self) -> Array:
        drawn = np.random.default_rng([self.seed, 1]).uniform(-1.0, 1.0, 6)
        spans = np.repeat([self.sensors.current_delay_s, self.sensors.voltage_delay_s], 3)
        common = np.repeat([self.common_delay_s, 0.0], 3)
        return np.asarray(drawn * spans + common, np.float64)


def drawn_case(
    seed: int,
    *,
    level: float | None,
    power_kW: float | None = None,
    poles: int | None = None,
    winding: SlotWinding | None = None,
    sensors: SensorClass = USUAL,
    most_path_ratio: float = 4.0,
    most_unbalance: float = 0.02,
    connection: Connection = Connection.STAR,
) -> SlotFaultCase:
    """A case drawn by its seed: rating, poles, winding, coil, path, load, supply and channels.

    level: the equivalent one, m; None for a healthy motor. The path is drawn up to `most_path_ratio`, as far
    as one coil has the turns: m (1 + p) N <= 1; a winding whose coils have too few is not drawn.
    Load 0.2 to 1, V1 within 3 %, V0/V1 up to 0.3 %, harmonics of order 5 and 7 up to 1.5 %, noise 0.1 to
    0.3 % of rated, currents up to 100 us late.
    """
    random = np.random.default_rng([seed, 17])
    power_kW = float(random.choice(POWERS_KW)) if power_kW is None else power_kW
    poles = int(random.choice(POLES)) if poles is None else poles
    motor = rated_motor(power_kW, poles, connection)
    if winding is None:
        made = [one for one in windings_of(poles) if level is None or level * one.coils_per_phase() <= 1]
        if not made:
            raise ValueError(f"no winding of {poles} poles has {level:g} of a phase's turns in one coil")
        winding = made[int(random.integers(len(made)))]
    N = winding.coils_per_phase()
    fault = None
    if level is not None:
        path_ratio = float(random.uniform(0.0, min(most_path_ratio, 1 / (level * N) - 1)))
        share = level * N * (1 + path_ratio)
        fault = CoilFault(int(random.integers(3)), int(random.integers(1, N + 1)), share, path_ratio)
    angle = random.uniform(0.0, 2 * pi, 4)
    case = SlotFaultCase(
        motor,
        winding,
        fault,
        load_level=float(random.uniform(0.2, 1.0)),
        unbalance=complex(random.uniform(0.0, most_unbalance) * np.exp(1j * angle[0])),
        zero_sequence=complex(random.uniform(0.0, 0.003) * np.exp(1j * angle[1])),
        relative_voltage=float(random.uniform(0.97, 1.03)),
        harmonics=(
            Harmonic(5, float(random.uniform(0.0, 0.015)), float(angle[2])),
            Harmonic(7, float(random.uniform(0.0, 0.015)), float(angle[3])),
        ),
        sensors=sensors,
        common_delay_s=float(random.uniform(0.0, 100e-6)),
        noise=float(random.uniform(0.001, 0.003)),
        seed=seed,
    )
    return replace(case, reverse=bool(random.integers(2)))


def with_other_parameters(motor: Motor, seed: int, span: float = 0.1) -> Motor:
    """The motor as its file knows it: five parameters wrong by up to `span`, each for itself."""
    names = (
        "stator_resistance_ohm",
        "rotor_resistance_ohm",
        "stator_leakage_H",
        "rotor_leakage_H",
        "stator_self_inductance_H",
    )
    factors = 1.0 + np.random.default_rng([seed, 23]).uniform(-span, span, len(names))
    machine = motor.parameters
    wrong = {
        name: getattr(machine, name) * factor for name, factor in zip(names, factors.tolist(), strict=True)
    }
    return replace(motor, parameters=replace(machine, **wrong))
