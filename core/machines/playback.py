"""Measured voltages played through a stator model: what currents would this candidate have drawn?"""

from dataclasses import dataclass
from enum import Enum, IntEnum
from math import pi

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array, RotorAsymmetry, StatorModel
from core.machines.batch import find_rates, find_steady_states, play
from core.machines.parameters import Motor
from core.machines.steady_state import SteadyState
from core.machines.supply import Supply
from core.machines.turning_rotor import play_turning

DELAY_MARGIN_COLUMNS = 3
"""Columns at the ends of a record that the interpolation of a delayed voltage cannot reach."""


class LoadLaw(IntEnum):
    """How the load torque grows with speed: its exponent."""

    CONSTANT = 0
    LINEAR = 1
    QUADRATIC = 2


class Beginning(Enum):
    """What the machine does at the window's first sample."""

    STEADY_STATE = "steady state"
    REST = "rest"


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
        beginning: Beginning = Beginning.STEADY_STATE,
    ) -> None:
        self.model = model
        self.motor = motor
        self.supply = supply
        self.window = window
        self.load_law = load_law
        self.beginning = beginning
        self._first = window.first * supply.substeps
        self._last = (window.last - 1) * supply.substeps + 1
        reach = DELAY_MARGIN_COLUMNS - 1
        self._latest_delay = (self._first - reach) * supply.step_s
        self._earliest_delay = -(supply.voltage.shape[0] - self._last - reach) * supply.step_s
        nameplate, machine = motor.nameplate, motor.parameters
        w_s, w_b = supply.angular_frequency, nameplate.rated_angular_frequency
        self._phasor = supply.phasor * np.exp(1j * w_s * self._first * supply.step_s)
        self._torque_per_pole_pair = nameplate.rated_torque_Nm / nameplate.pole_pairs / w_b**load_law.value
        self._ripple_gain = nameplate.pole_pairs**2 / machine.inertia_kgm2
        # Slip of the healthy machine's greatest torque: R_r' over the impedance of R_s and the leakages.
        leakage = w_s * (machine.stator_leakage_H + machine.rotor_leakage_H)
        impedance = float(np.hypot(machine.stator_resistance_ohm, leakage))
        self._pull_out_slip = min(1.0, machine.rotor_resistance_ohm / impedance)

    def steady_state(self, candidates: Candidates) -> SteadyState:
        """Periodic steady state of every candidate at the window's first sample."""
        return self._steady_state(candidates, self._rates(candidates))

    def squared_error(self, candidates: Candidates, measured_ab: Array) -> Array:
        """Sum of squared distances of the model's to the measured current, (candidates,) [A^2] (6.25).

        measured_ab: Clarke currents of the whole record, shape (2, record samples) [A].
        """
        window = self.window
        measured = np.ascontiguousarray(measured_ab[:, window.first : window.last].T)
        error = np.empty(len(candidates))
        self._play(candidates, measured, error, np.empty((0, 2, 0)), np.empty((0, 0)))
        return error

    def trajectories(self, candidates: Candidates) -> Trajectories:
        """Currents and speed of every candidate over the window."""
        n, samples = len(candidates), self.window.last - self.window.first
        current, speed = np.empty((n, 2, samples)), np.empty((n, samples))
        self._play(candidates, np.empty((0, 2)), np.empty(n), current, speed)
        return Trajectories(current, speed)

    def _rates(self, candidates: Candidates) -> "_Rates":
        n = len(candidates)
        circuits = self.model.circuits(
            self.motor, candidates.fault_level, candidates.winding, candidates.path_ratio
        )
        load = np.zeros((n, 3))
        load[:, int(self.load_law)] = candidates.load_level * self._torque_per_pole_pair
        rates = _Rates(np.empty((n, 5, 5)), np.empty((n, 5, 5)), load, circuits.rotor_asymmetry)
        find_rates(circuits.inductance, circuits.resistance, rates.decay, rates.current_from_flux)
        return rates

    def _steady_state(self, candidates: Candidates, rates: "_Rates") -> SteadyState:
        n = len(candidates)
        state = SteadyState(
            flux=np.empty((5, n)),
            speed=np.empty(n),
            mean_speed=np.empty(n),
            current=np.empty((2, n), np.complex128),
            balanced=np.empty(n, np.bool_),
        )
        find_steady_states(
            rates.decay, rates.current_from_flux, rates.load, candidates.time_offset_s,
            self.supply.angular_frequency, self._phasor, self._pull_out_slip, self._ripple_gain,
            state.flux, state.speed, state.mean_speed, state.current, state.balanced,
        )  # fmt: skip
        return state

    def _play(
        self, candidates: Candidates, measured: Array, error: Array, current: Array, speed: Array
    ) -> None:
        delays = candidates.time_offset_s
        if delays.size and not (self._earliest_delay <= delays.min() and delays.max() <= self._latest_delay):
            raise ValueError(
                f"time offsets: expected {self._earliest_delay:g} to {self._latest_delay:g} s, for which "
                f"the record has voltages, found {delays.min():g} to {delays.max():g} s"
            )
        rates = self._rates(candidates)
        if self.beginning is Beginning.REST:
            flux_0, speed_0 = np.zeros((5, len(candidates))), np.zeros(len(candidates))
        else:
            state = self._steady_state(candidates, rates)
            flux_0, speed_0 = state.flux, state.speed
        supply, asymmetry = self.supply, rates.rotor_asymmetry
        compare_from = max(1, (self.window.compare_from - self.window.first) * supply.substeps)
        acceleration, turn = self._ripple_gain * supply.step_s, supply.angular_frequency * supply.step_s
        if asymmetry is None:
            play(
                supply.voltage, self._first, self._last, supply.step_s, supply.substeps, delays, rates.decay,
                rates.current_from_flux, rates.load, acceleration, turn, flux_0, speed_0, measured,
                compare_from, error, current, speed,
            )  # fmt: skip
        else:
            play_turning(
                supply.voltage, self._first, self._last, supply.step_s, supply.substeps, delays, rates.decay,
                rates.current_from_flux, rates.load, acceleration, turn, flux_0, speed_0,
                asymmetry.resistance, asymmetry.angle, measured, compare_from, error, current, speed,
            )  # fmt: skip


@dataclass(frozen=True, slots=True)
class _Rates:
    """What a batch is stepped with: -R inv(L) and inv(L) (n, 5, 5), the load's polynomial in the speed
    (n, 3), what of the rotor's resistance turns with it."""

    decay: Array
    current_from_flux: Array
    load: Array
    rotor_asymmetry: RotorAsymmetry | None


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
