"""Measured voltages played through a stator model: what currents would this candidate have drawn?"""

from dataclasses import dataclass
from enum import IntEnum
from math import pi

import numpy as np
from numpy.typing import NDArray

from core.machines import kernel
from core.machines.base import Array, StatorModel
from core.machines.parameters import Motor
from core.machines.steady_state import SteadyState, fill_steady_state
from core.machines.supply import Supply

DELAY_MARGIN_COLUMNS = 3
"""Columns at the ends of a record that the interpolation of a delayed voltage cannot reach."""


class LoadLaw(IntEnum):
    """How the load torque grows with speed: its exponent."""

    CONSTANT = 0
    LINEAR = 1
    QUADRATIC = 2


@dataclass(frozen=True, slots=True)
class Candidates:
    """A batch of hypotheses on one motor, each field of shape (candidates,).

    fault_level: mu_f; winding: theta_f, 0, 1, 2; load_level: LL; time_offset_s: T_d, delay of the currents;
    path_ratio: r_f / (mu R_s) of the path bridging the turns.
    """

    fault_level: Array
    winding: NDArray[np.int64]
    load_level: Array
    time_offset_s: Array
    path_ratio: Array

    def __len__(self) -> int:
        return self.fault_level.size

    def part(self, rows: slice) -> "Candidates":
        """The candidates of some rows."""
        return Candidates(
            self.fault_level[rows],
            self.winding[rows],
            self.load_level[rows],
            self.time_offset_s[rows],
            self.path_ratio[rows],
        )


@dataclass(frozen=True, slots=True)
class Trajectories:
    """Stator current on the Clarke axes (candidates, 2, samples) [A], speed (candidates, samples)
    [electrical rad/s], both at the samples of the record's window."""

    current: Array
    speed: Array


@dataclass(frozen=True, slots=True)
class Window:
    """The part of a record that is simulated, in samples of the record: [first, last), with the comparison
    of currents beginning at `compare_from` when the start's own transient is over."""

    first: int
    last: int
    compare_from: int


class Playback:
    """One motor, one model, one window of measured voltages; any number of candidates."""

    def __init__(
        self,
        model: StatorModel,
        motor: Motor,
        supply: Supply,
        window: Window,
        load_law: LoadLaw = LoadLaw.CONSTANT,
    ) -> None:
        self.model = model
        self.motor = motor
        self.supply = supply
        self.window = window
        self.load_law = load_law
        self._first = window.first * supply.substeps
        self._last = (window.last - 1) * supply.substeps + 1

    def steady_state(self, candidates: Candidates) -> SteadyState:
        """Periodic steady state of every candidate at the window's first sample."""
        return self._steady_state(candidates, *self._circuits(candidates))

    def squared_error(self, candidates: Candidates, measured_ab: Array) -> Array:
        """Sum of squared distances of the model's to the measured current, (candidates,) [A^2] (6.25).

        measured_ab: Clarke currents of the whole record, shape (2, record samples) [A].
        """
        window = self.window
        measured = np.ascontiguousarray(measured_ab[:, window.first : window.last].T)
        errors = np.empty(len(candidates))
        for start in range(0, len(candidates), kernel.LANES):
            rows = slice(start, min(start + kernel.LANES, len(candidates)))
            error, _, _ = self._run(candidates.part(rows), measured, record=False)
            errors[rows] = error
        return errors

    def trajectories(self, candidates: Candidates) -> Trajectories:
        """Currents and speed of every candidate over the window."""
        samples = self.window.last - self.window.first
        currents, speeds = np.empty((len(candidates), 2, samples)), np.empty((len(candidates), samples))
        for start in range(0, len(candidates), kernel.LANES):
            rows = slice(start, min(start + kernel.LANES, len(candidates)))
            lanes = rows.stop - rows.start
            _, current, speed = self._run(candidates.part(rows), np.empty((0, 2)), record=True)
            currents[rows] = current[:, :: self.supply.substeps, :lanes].transpose(2, 0, 1)
            speeds[rows] = speed[:: self.supply.substeps, :lanes].T
        return Trajectories(currents, speeds)

    def _circuits(self, candidates: Candidates) -> tuple[Array, Array, Array]:
        circuits = self.model.circuits(
            self.motor, candidates.fault_level, candidates.winding, candidates.path_ratio
        )
        inverse = np.linalg.inv(circuits.inductance)
        decay = -circuits.resistance @ inverse
        nameplate = self.motor.nameplate
        exponent = int(self.load_law)
        load = np.zeros((len(candidates), 3))
        load[:, exponent] = (
            candidates.load_level
            * nameplate.rated_torque_Nm
            / nameplate.pole_pairs
            / nameplate.rated_angular_frequency**exponent
        )
        return decay, np.ascontiguousarray(inverse[:, :4, :]), load

    def _steady_state(
        self, candidates: Candidates, decay: Array, current_from_flux: Array, load: Array
    ) -> SteadyState:
        n = len(candidates)
        supply, machine = self.supply, self.motor.parameters
        w_s = supply.angular_frequency
        arrival = np.exp(1j * w_s * (self._first * supply.step_s - candidates.time_offset_s))
        voltage = arrival[:, np.newaxis] * supply.phasor
        state = SteadyState(
            flux=np.empty((5, n)),
            speed=np.empty(n),
            mean_speed=np.empty(n),
            current=np.empty((2, n), np.complex128),
            balanced=np.empty(n, np.bool_),
        )
        fill_steady_state(
            decay, current_from_flux, load, w_s, voltage, self._pull_out_slip(),
            self.motor.nameplate.pole_pairs**2 / machine.inertia_kgm2,
            state.flux, state.speed, state.mean_speed, state.current, state.balanced,
        )  # fmt: skip
        return state

    def _pull_out_slip(self) -> float:
        """Slip of the healthy machine's greatest torque, R_r' / |Z of the leakages and R_s| (Thevenin)."""
        machine = self.motor.parameters
        reactance = self.supply.angular_frequency * (machine.stator_leakage_H + machine.rotor_leakage_H)
        return min(
            1.0, machine.rotor_resistance_ohm / float(np.hypot(machine.stator_resistance_ohm, reactance))
        )

    def _run(self, candidates: Candidates, measured: Array, *, record: bool) -> tuple[Array, Array, Array]:
        lanes = len(candidates)
        decay, current_from_flux, load = self._circuits(candidates)
        start = self._steady_state(candidates, decay, current_from_flux, load)
        delays, source = np.unique(candidates.time_offset_s, return_inverse=True)
        voltage = self.supply.delayed(delays)[:, self._first : self._last]
        flux, speed = np.zeros((5, kernel.LANES)), np.zeros(kernel.LANES)
        flux[:, :lanes], speed[:lanes] = start.flux, start.speed
        output, loads = np.zeros((4, 5, kernel.LANES)), np.zeros((3, kernel.LANES))
        output[:, :, :lanes], loads[:, :lanes] = current_from_flux.transpose(1, 2, 0), load.T
        columns = voltage.shape[1] if record else 0
        current, speed_out = np.empty((2, columns, kernel.LANES)), np.empty((columns, kernel.LANES))
        error = np.zeros(kernel.LANES)
        step = self.supply.step_s
        compare_from = (self.window.compare_from - self.window.first) * self.supply.substeps
        kernel.simulate(
            voltage, source.astype(np.int64), step, decay, output, loads,
            step * self.motor.nameplate.pole_pairs**2 / self.motor.parameters.inertia_kgm2,
            flux, speed, measured, self.supply.substeps, max(1, compare_from), error, current, speed_out,
            lanes,
        )  # fmt: skip
        return error[:lanes], current, speed_out


def window_of_record(samples: int, sample_rate_hz: float, frequency_hz: float, longest_s: float) -> Window:
    """The last `longest_s` of a record, less the cycle in front that a delay of up to one cycle reaches back
    to, the half cycle behind for a delay that is an advance, and one cycle for the model to settle."""
    cycle = sample_rate_hz / frequency_hz
    first = int(np.ceil(cycle)) + DELAY_MARGIN_COLUMNS
    last = samples - int(np.ceil(cycle / 2)) - DELAY_MARGIN_COLUMNS
    first = max(first, last - round(longest_s * sample_rate_hz) - int(np.ceil(cycle)))
    return Window(first, last, first + int(np.ceil(cycle)))


def electrical_to_rpm(speed: Array, pole_pairs: int) -> Array:
    """Shaft speed from electrical angular speed [rad/s] [rpm]."""
    return speed / pole_pairs * 60.0 / (2.0 * pi)
