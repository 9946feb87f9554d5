"""A motor on its busbar with its load and its sensors, simulated on demand.

Nothing is simulated between windows. A window is simulated from a little before its start, long enough for
the motor to settle. Supply, load and fault are functions of the time since the simulator's start, so that
windows of one plant are consistent with each other and the same every time. With a trajectory, a window that
follows soon goes on where the one before it was.
"""

from dataclasses import dataclass, replace
from math import ceil, floor, inf, sqrt

import numpy as np
from numpy.typing import NDArray

from core.machines.parameters import Motor
from ied_sim.motor.cage import USUAL_CAGE, Cage, cage_loops
from ied_sim.motor.contactor import Closure, Contactor
from ied_sim.motor.course import Points, value_at
from ied_sim.motor.deep_bars import UNSATURATED, DeepBars, LeakageSaturation
from ied_sim.motor.driving import drive
from ied_sim.motor.eccentricity import CENTRED, Eccentricity
from ied_sim.motor.fault import FaultCourse, TurnFault
from ied_sim.motor.feeder import MOTOR_ALONE, Feeder
from ied_sim.motor.integration import Loops, integrate
from ied_sim.motor.interpolation import MARGIN, interpolated
from ied_sim.motor.joint import JointCourse
from ied_sim.motor.load import Load
from ied_sim.motor.rotor import RotorLoops, three_coils
from ied_sim.motor.running_state import RunningMotor
from ied_sim.motor.saturation import LINEAR_IRON, MainSaturation, flux_per_current
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.slip_rings import SlipRings, sections
from ied_sim.motor.slots import SlotWinding
from ied_sim.motor.supply import Supply
from ied_sim.motor.trajectory import Trajectory
from ied_sim.motor.warming import COLD, ResistanceFactors, Warming
from ied_sim.motor.windings import WindingCircuit, winding_circuit

Array = NDArray[np.float64]

STEP_RATE_HZ = 20_000.0
METERING_STEP_RATE_HZ = 4_000.0
HIGHEST_STEP_RATE_HZ = 200_000.0
RATE_PER_STEP = 2.0
"""Fastest decay resolved, in decays a step. RK4 is stable up to 2.78; such a mode follows its drive."""
SETTLING_S = 1.0
"""Least time that a motor is simulated before a window, so that it has settled."""
TIME_CONSTANTS_TO_SETTLE = 6.0
"""That time over the time constant of the load's speed, where this is longer."""
DISTURBANCE_MEMORY_S = 2.0
"""Time after a supply event for which a window is simulated from before the event."""
START_MEMORY_S = 10.0
"""Least time after the contactor's closing for which a window is simulated from rest."""
RUN_UPS_REMEMBERED = 5.0
"""That time over the run-up with rated torque, where this is longer."""
RATED_POWER_FACTOR_TIMES_EFFICIENCY = 0.7
SAME_MOMENT_S = 1e-9

_OF_ROTOR = 1
"""Tells the random rotor angle of a moment from the random noise of a window."""


@dataclass(frozen=True, slots=True)
class Operation:
    """True operation of the motor: line currents and phase voltages, shape (3, n), and speed, shape (n,)."""

    currents_A: Array
    voltages_V: Array
    speed_rad_s: Array


@dataclass(frozen=True, slots=True)
class MotorPlant:
    """A motor with its supply, load, sensors and contactor.

    `fault` is None for a healthy motor, and `seed` is that of the noise. With `warming` None the windings
    keep the resistance of the parameters. `broken_bars` is the broken share of the bars of the `cage`, or its
    course over time, and `joint` a bad one in a line. The rotor's angle is random at the beginning of each
    window, and with it the phase of all that turns with it, unless the window goes on from an earlier one's
    `trajectory`. The contactor connects the motor, which then starts from rest; with None the motor always
    runs. `slip_rings` are those of a wound rotor, which has no bars. A fault in a coil needs the `winding` by
    its slots. `deep_bars` and `leakage_saturation` make a start another motor's than the running one, and
    `main_saturation` lets the main inductance follow the voltage. The `feeder` holds what else lies behind
    the relay's transformers.
    """

    motor: Motor
    supply: Supply
    load: Load
    sensors: Sensors
    fault: FaultCourse | None = None
    seed: int = 0
    warming: Warming | None = None
    broken_bars: float | Points = 0.0
    contactor: Contactor | None = None
    joint: JointCourse | None = None
    cage: Cage = USUAL_CAGE
    eccentricity: Eccentricity = CENTRED
    trajectory: Trajectory | None = None
    slip_rings: SlipRings | None = None
    winding: SlotWinding | None = None
    deep_bars: DeepBars | None = None
    leakage_saturation: LeakageSaturation = UNSATURATED
    main_saturation: MainSaturation = LINEAR_IRON
    feeder: Feeder = MOTOR_ALONE

    def window(
        self, start_s: float, duration_s: float, sample_rate_hz: float, *, step_rate_hz: float = STEP_RATE_HZ
    ) -> Array:
        """Return measured samples of IA IB IC [A], VA VB VC [V], shape (6, n), from `start_s` on.

        The motor is integrated in steps of 1 / step_rate_hz, or finer ones where its fault needs them.
        """
        delays_s = self.sensors.delays(start_s)
        samples = round(duration_s * sample_rate_hz)
        times = start_s + np.arange(samples) / sample_rate_hz
        true = np.empty((6, samples))
        true[:3] = self._delayed_currents(start_s, samples, sample_rate_hz, delays_s[:3], step_rate_hz)
        for delay_s in np.unique(delays_s[3:]):
            late = np.flatnonzero(delays_s[3:] == delay_s)
            true[3 + late] = self.supply.phase_voltages(times - delay_s)[late]
        random = np.random.default_rng([self.seed, round(start_s * 1e6) % 2**63])
        return self.sensors.measure(true, self.rated_values, random, start_s)

    def _delayed_currents(
        self, start_s: float, samples: int, sample_rate_hz: float, delays_s: Array, step_rate_hz: float
    ) -> Array:
        """Return line currents, shape (3, samples), each as it was its delay ago."""
        if np.ptp(delays_s) == 0:
            return self._line_currents(
                start_s - float(delays_s[0]), samples, sample_rate_hz, self.settling_s, step_rate_hz
            )[0]
        # Channels apart by less than a sample are read off a finer grid.
        fineness = max(1, ceil(step_rate_hz / sample_rate_hz))
        fine_hz = sample_rate_hz * fineness
        begin_s = start_s - float(delays_s.max()) - MARGIN / fine_hz
        spread = ceil(float(np.ptp(delays_s)) * fine_hz)
        count = samples * fineness + spread + 2 * MARGIN
        fine, _ = self._line_currents(begin_s, count, fine_hz, self.settling_s, step_rate_hz)
        firsts = (start_s - delays_s - begin_s) * fine_hz
        return np.vstack(
            [
                interpolated(one, float(first), fineness, samples)
                for one, first in zip(fine, firsts, strict=True)
            ]
        )

    @property
    def inertia_kgm2(self) -> float:
        """Moment of inertia of motor and load."""
        return self.motor.parameters.inertia_kgm2 + self.load.inertia_kgm2

    @property
    def settling_s(self) -> float:
        """Time that the motor is simulated before a window, so that it has settled.

        A motor of usual inertia needs no more than SETTLING_S; a heavy load does.
        """
        nameplate = self.motor.nameplate
        synchronous = 2 * np.pi * nameplate.rated_frequency_Hz / nameplate.pole_pairs
        pull = self._running.torque_over_slip(0.0, nameplate.rated_frequency_Hz)
        time_constant_s = self.load.inertia_kgm2 * synchronous / pull
        return max(SETTLING_S, TIME_CONSTANTS_TO_SETTLE * time_constant_s)

    @property
    def start_memory_s(self) -> float:
        """Time after the contactor's closing for which a window is simulated from rest."""
        nameplate = self.motor.nameplate
        speed = 2 * np.pi * nameplate.rated_frequency_Hz / nameplate.pole_pairs
        run_up_s = self.inertia_kgm2 * speed / nameplate.rated_torque_Nm
        steps_s = 0.0 if self.slip_rings is None else self.slip_rings.start_ends_s
        return max(START_MEMORY_S, RUN_UPS_REMEMBERED * run_up_s, steps_s + SETTLING_S)

    @property
    def rated_values(self) -> Array:
        """Rated line current (estimated) and phase voltage of the six channels, rms, shape (6,)."""
        return np.repeat([rated_current(self.motor), self.motor.nameplate.rated_voltage_V / sqrt(3)], 3)

    def operation(
        self,
        start_s: float,
        duration_s: float,
        sample_rate_hz: float,
        *,
        settling_s: float | None = None,
        current_delay_s: float = 0.0,
        step_rate_hz: float = STEP_RATE_HZ,
    ) -> Operation:
        """Return the true operation, simulated from `settling_s` before the window, or long enough with None.

        With `current_delay_s` the currents are those of so much earlier than the voltages beside them.
        """
        samples = round(duration_s * sample_rate_hz)
        currents, speed = self._line_currents(
            start_s - current_delay_s,
            samples,
            sample_rate_hz,
            self.settling_s if settling_s is None else settling_s,
            step_rate_hz,
        )
        times = start_s + np.arange(samples) / sample_rate_hz
        return Operation(currents, self.supply.phase_voltages(times), speed)

    def _line_currents(
        self, begin_s: float, samples: int, sample_rate_hz: float, settling_s: float, step_rate_hz: float
    ) -> tuple[Array, Array]:
        """Return line currents, shape (3, samples), and speed from `begin_s` on."""
        end_s = begin_s + samples / sample_rate_hz
        always = (Closure(),)
        closures = always if self.contactor is None else self.contactor.closures(begin_s, end_s)
        currents, speed = np.zeros((3, samples)), np.zeros(samples)
        for closure in closures:
            here = self._connected(closure, begin_s, samples, sample_rate_hz, settling_s, step_rate_hz)
            first, line_currents, turning = here
            connected = slice(first, first + turning.size)
            currents[:, connected] = line_currents
            speed[connected] = turning
            if turning.size and not self.feeder.inside_delta:
                times = begin_s + np.arange(first, first + turning.size) / sample_rate_hz
                currents[:, connected] += self.feeder.currents(self.supply, self.motor.nameplate, times)
        beside = self._other_motor()
        if beside is not None and not self.feeder.inside_delta:
            length_s = samples / sample_rate_hz
            currents += beside.operation(
                begin_s, length_s, sample_rate_hz, settling_s=settling_s, step_rate_hz=step_rate_hz
            ).currents_A
        return currents, speed

    def _other_motor(self) -> "MotorPlant | None":
        """Return the other motor behind the transformers, on the same supply, with a contactor of its own."""
        other = self.feeder.other_motor
        if other is None:
            return None
        contactor = None
        if other.since_s > -inf:
            contactor = Contactor(open_at_first=True)
            contactor.close(other.since_s)
        return MotorPlant(
            other.motor, self.supply, other.load, self.sensors, seed=self.seed + 1, contactor=contactor
        )

    def _connected(
        self,
        closure: Closure,
        begin_s: float,
        samples: int,
        sample_rate_hz: float,
        settling_s: float,
        step_rate_hz: float,
    ) -> tuple[int, Array, Array]:
        """Return first sample, line currents and speed while connected, of `samples` from `begin_s` on."""
        last = samples
        if closure.opened_s < inf:
            last = min(samples, ceil((closure.opened_s - begin_s) * sample_rate_hz))
        if begin_s - closure.closed_s > self.start_memory_s:
            circuit = self.circuit(begin_s)
            from_s = self.supply.disturbed_since(begin_s, DISTURBANCE_MEMORY_S) - settling_s
            state, settling = self._before(circuit, closure, from_s, begin_s, sample_rate_hz)
            from_s = begin_s - settling / sample_rate_hz

            def simulate(first_s: float, count: int) -> tuple[Array, Array]:
                return self._simulate(circuit, state, first_s, count, sample_rate_hz, step_rate_hz)

            samples = settling + last
            if self.trajectory is None:
                currents, speed = simulate(from_s, samples)
            else:
                currents, speed = self.trajectory.simulated(simulate, state, from_s, samples, sample_rate_hz)
            return 0, currents[:, settling:], speed[settling:]
        return self._from_rest(closure.closed_s, begin_s, last, sample_rate_hz, step_rate_hz)

    def _before(
        self, circuit: WindingCircuit, closure: Closure, from_s: float, begin_s: float, sample_rate_hz: float
    ) -> tuple[Array, int]:
        """Return a state of the running motor some samples before `begin_s`, and how many these are.

        It is one passed since `from_s`, or else an estimate at about that time.
        """
        passed = None
        if self.trajectory is not None:
            size = circuit.loops + 2
            passed = self.trajectory.latest(closure, from_s=from_s, to_s=begin_s, size=size)
        if passed is None:
            settling = ceil((begin_s - from_s) * sample_rate_hz)
            return self._running_state(circuit, begin_s - settling / sample_rate_hz), settling
        state = passed.state.copy()
        settling = floor((begin_s - passed.time_s) * sample_rate_hz)
        apart_s = begin_s - settling / sample_rate_hz - passed.time_s
        if apart_s > SAME_MOMENT_S:  # windows have grids of their own
            self._simulate(circuit, state, passed.time_s, 2, 1 / apart_s, STEP_RATE_HZ)
        return state, settling

    def _from_rest(
        self, closed_s: float, begin_s: float, last: int, sample_rate_hz: float, step_rate_hz: float
    ) -> tuple[int, Array, Array]:
        """Do as `_connected` does, for a motor at rest until `closed_s`, on the grid of `begin_s`."""
        first = ceil((closed_s - begin_s) * sample_rate_hz)
        if last <= first:
            return 0, np.zeros((3, 0)), np.zeros(0)
        circuit = self.circuit(closed_s, closed_s)
        first_s = begin_s + first / sample_rate_hz
        state = np.zeros(circuit.loops + 2)
        if first_s > closed_s:
            # The contactor may close between samples: the time up to the first sample is simulated apart.
            self._simulate(circuit, state, closed_s, 2, 1 / (first_s - closed_s), step_rate_hz)
        currents, speed = np.zeros((3, last - first)), np.zeros(last - first)
        steps = sections(self.slip_rings, first_s - closed_s, last - first, sample_rate_hz)
        for closing_s, step, next_step in steps:
            circuit = self.circuit(closed_s + closing_s, closed_s)
            from_s, here = first_s + step / sample_rate_hz, slice(step, next_step + 1)
            currents[:, here], speed[here] = self._simulate(
                circuit, state, from_s, next_step - step + 1, sample_rate_hz, step_rate_hz
            )
        seen = max(0, -first)
        return max(0, first), currents[:, seen:], speed[seen:]

    def start_up(self, start_s: float, duration_s: float, sample_rate_hz: float) -> Operation:
        """Return a start from rest; the voltage comes at `start_s`."""
        samples = round(duration_s * sample_rate_hz)
        _, currents, speed = self._from_rest(start_s, start_s, samples, sample_rate_hz, STEP_RATE_HZ)
        times = start_s + np.arange(samples) / sample_rate_hz
        return Operation(currents, self.supply.phase_voltages(times), speed)

    def fault_at(self, time_s: float) -> TurnFault | None:
        """Return the fault at one moment, None where the motor is as good as healthy."""
        if self.fault is None:
            return None
        fault = self.fault.at(time_s)
        level = fault.equivalent_level(self.motor.parameters.stator_resistance_ohm)
        return fault if level > fault.negligible_level else None

    def broken_share(self, time_s: float) -> float:
        """Return the share of the bars that are broken at one moment."""
        if isinstance(self.broken_bars, tuple):
            return value_at(self.broken_bars, time_s)
        return self.broken_bars

    def rotor(self, time_s: float, closed_s: float = -inf) -> RotorLoops:
        """Return the rotor's loops at one moment, the contactor having closed at another."""
        parameters, broken = self.motor.parameters, self.broken_share(time_s)
        if self.slip_rings is not None:
            outside = self.slip_rings.added_resistance(time_s, time_s - closed_s)
            return replace(three_coils(parameters), outside=outside)
        if broken == 0:
            return three_coils(parameters) if self.deep_bars is None else self.deep_bars.loops(parameters)
        return cage_loops(parameters, self.motor.nameplate.pole_pairs, self.cage, broken)

    def circuit(self, time_s: float, closed_s: float = -inf) -> WindingCircuit:
        """Return the winding circuit at one moment, the contactor having closed at another; see `rotor`."""
        line_ohm = [0.0, 0.0, 0.0]
        if self.joint is not None:
            line_ohm[self.joint.phase] = self.joint.resistance_ohm(time_s)
        cable = self.feeder.cable
        line_ohm = [one + cable.resistance_ohm for one in line_ohm]
        return winding_circuit(
            self.motor,
            self.fault_at(time_s),
            winding=self.winding,
            harmonic_cage=self.cage,
            rotor=self.rotor(time_s, closed_s),
            resistance_factors=self.resistance_factors(time_s),
            line_resistance_ohm=(line_ohm[0], line_ohm[1], line_ohm[2]),
            line_inductance_H=cable.reactance_ohm / self.motor.nameplate.rated_angular_frequency,
            neutral=self.feeder.neutral,
        )

    def resistance_factors(self, time_s: float) -> ResistanceFactors:
        """Return the windings' resistances at one moment over those of the parameters."""
        return COLD if self.warming is None else self.warming.factors(time_s, self._levels_while_connected)

    def _levels_while_connected(self, time_s: Array) -> Array:
        """Return the load at the times [s], NaN where the motor is not connected."""
        levels = self.load.levels(time_s)
        if self.contactor is None:
            return levels
        connected = np.zeros(time_s.shape, bool)
        for closure in self.contactor.closures(float(time_s.min()), float(time_s.max())):
            connected |= (closure.closed_s <= time_s) & (time_s < closure.opened_s)
        return np.where(connected, levels, np.nan)

    def _simulate(
        self,
        circuit: WindingCircuit,
        state: Array,
        first_s: float,
        samples: int,
        sample_rate_hz: float,
        step_rate_hz: float,
    ) -> tuple[Array, Array]:
        """Return line currents, shape (3, samples), and speed from `first_s` on."""
        needed_hz = max(step_rate_hz, circuit.fastest_rate / RATE_PER_STEP)
        steps_per_sample = max(1, ceil(needed_hz / sample_rate_hz))
        step = 1 / (sample_rate_hz * steps_per_sample)
        half_steps = np.arange(2 * (samples - 1) * steps_per_sample + 1, dtype=np.float64)
        times = first_s + half_steps * (step / 2)
        nameplate = self.motor.nameplate
        driven = drive(circuit, self.supply, self.load, nameplate, times, step)
        loops = Loops(
            circuit.leakage,
            circuit.deep_leakage,
            circuit.constant,
            circuit.cosine,
            circuit.sine,
            circuit.resistance,
            nameplate.pole_pairs,
            self.inertia_kgm2,
            self.eccentricity.static,
            self.eccentricity.dynamic,
            circuit.stator_current,
            self.leakage_saturation.share,
            self.leakage_saturation.knee_A,
            circuit.rotor_current,
            self.main_saturation.share,
            self.main_saturation.exponent,
            flux_per_current(self.motor),
        )
        currents, speed = integrate(loops, driven, steps_per_sample, state)
        if self.feeder.inside_delta:
            return np.ascontiguousarray(currents[:, :3].T), speed
        return circuit.line_currents(currents), speed

    def _running_state(self, circuit: WindingCircuit, time_s: float) -> Array:
        """Estimate a state close enough to settle from."""
        load_level, angle = self.load.level_at(time_s), self._rotor_angle(time_s)
        return self._running.state(circuit, time_s, load_level=load_level, angle=angle)

    @property
    def _running(self) -> RunningMotor:
        return RunningMotor(self.motor, self.supply, self.slip_rings)

    def _rotor_angle(self, time_s: float) -> float:
        """Return an electrical angle of the running rotor: any of a turn of the shaft, always the same."""
        random = np.random.default_rng([self.seed, round(time_s * 1e6) % 2**63, _OF_ROTOR])
        return self.motor.nameplate.pole_pairs * float(random.uniform(0.0, 2 * np.pi))


def rated_current(motor: Motor) -> float:
    """Estimate the line current at rated power [A rms], for a nameplate that does not tell it."""
    nameplate = motor.nameplate
    return nameplate.rated_power_W / (
        sqrt(3) * nameplate.rated_voltage_V * RATED_POWER_FACTOR_TIMES_EFFICIENCY
    )
