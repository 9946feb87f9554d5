"""Measured voltages played through a stator model: the currents that a candidate would have drawn."""

from dataclasses import dataclass
from enum import Enum
from math import pi

import numpy as np

from core.machines.base import Array, StatorModel
from core.machines.batch import play
from core.machines.candidates import Candidates, LoadLaw
from core.machines.parameters import Motor
from core.machines.running import SteadyRunning
from core.machines.steady_state import SteadyState
from core.machines.stepping import Comparison, InitialState, SteppedVoltage, Track
from core.machines.supply import Supply
from core.machines.turning_rotor import play_turning

DELAY_MARGIN_COLUMNS = 3
"""Columns at the ends of a record that the interpolation of a delayed voltage cannot reach."""


class Beginning(Enum):
    """What the machine does at the window's first sample."""

    STEADY_STATE = "steady state"
    REST = "rest"


@dataclass(frozen=True, slots=True)
class Trajectories:
    """What a batch does over the window, at the samples of the record.

    Parameters
    ----------
    current : ndarray, shape (candidates, 2, samples)
        Stator current on the Clarke axes [A].
    speed : ndarray, shape (candidates, samples)
        Electrical speed [rad/s].
    """

    current: Array
    speed: Array


@dataclass(frozen=True, slots=True)
class Window:
    """The part of a record that is simulated, in samples of the record.

    Parameters
    ----------
    first, last : int
        Samples [first, last) are simulated.
    compare_from : int
        First sample whose current is compared, when the simulation's own transient is over.
    """

    first: int
    last: int
    compare_from: int


class Playback:
    """One motor, one model, one window of measured voltages; any number of candidates.

    Parameters
    ----------
    model : StatorModel
        Machine model.
    motor : Motor
        Nameplate, parameters, channel names and limits of the motor.
    supply : Supply
        Stator voltage on the model's time base.
    window : Window
        Part of the record that is simulated.
    load_law : LoadLaw, default LoadLaw.CONSTANT
        How the load torque grows with speed.
    beginning : Beginning, default Beginning.STEADY_STATE
        What the machine does at the window's first sample.
    """

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
        first = window.first * supply.substeps
        last = (window.last - 1) * supply.substeps + 1
        reach = DELAY_MARGIN_COLUMNS - 1
        self._latest_delay = (first - reach) * supply.step_s
        self._earliest_delay = -(supply.voltage.shape[0] - last - reach) * supply.step_s
        self._compare_from = max(1, (window.compare_from - window.first) * supply.substeps)
        w_s = supply.angular_frequency
        self._feed = SteppedVoltage(supply.voltage, first, last, supply.step_s, supply.substeps, w_s)
        at_first = supply.phasor * np.exp(1j * w_s * first * supply.step_s)
        self._running = SteadyRunning(model, motor, w_s, at_first, load_law)

    def steady_state(self, candidates: Candidates) -> SteadyState:
        """Return the periodic steady state of every candidate at the window's first sample.

        Parameters
        ----------
        candidates : Candidates
            The batch of hypotheses.

        Returns
        -------
        SteadyState
            The steady states.
        """
        return self._running.state(candidates)

    def squared_error(self, candidates: Candidates, measured_ab: Array) -> Array:
        """Sum the squared distances of the model's current to the measured one (6.25).

        Parameters
        ----------
        candidates : Candidates
            The batch of hypotheses.
        measured_ab : ndarray, shape (2, n)
            Measured currents on Clarke axes over the whole record [A].

        Returns
        -------
        ndarray, shape (candidates,)
            Sums [A^2]; infinite for a candidate whose currents are not finite.
        """
        window = self.window
        measured = np.ascontiguousarray(measured_ab[:, window.first : window.last].T)
        comparison = Comparison(measured, self._compare_from, np.empty(len(candidates)))
        self._play(candidates, comparison, Track(np.empty((0, 2, 0)), np.empty((0, 0))))
        return comparison.squared_error

    def trajectories(self, candidates: Candidates) -> Trajectories:
        """Return currents and speed of every candidate over the window.

        Parameters
        ----------
        candidates : Candidates
            The batch of hypotheses.

        Returns
        -------
        Trajectories
            Currents and speeds.
        """
        n, samples = len(candidates), self.window.last - self.window.first
        track = Track(np.empty((n, 2, samples)), np.empty((n, samples)))
        self._play(candidates, Comparison(np.empty((0, 2)), self._compare_from, np.empty(n)), track)
        return Trajectories(track.current, track.speed)

    def _play(self, candidates: Candidates, comparison: Comparison, track: Track) -> None:
        delays = candidates.time_offset_s
        if delays.size and not (self._earliest_delay <= delays.min() and delays.max() <= self._latest_delay):
            raise ValueError(
                f"time offsets: expected {self._earliest_delay:g} to {self._latest_delay:g} s, for which "
                f"the record has voltages, found {delays.min():g} to {delays.max():g} s"
            )
        rates = self._running.rates(candidates)
        if self.beginning is Beginning.REST:
            beginning = InitialState(np.zeros((5, len(candidates))), np.zeros(len(candidates)))
        else:
            state = self._running.state(candidates, rates)
            beginning = InitialState(state.flux, state.speed)
        if rates.rotor_asymmetry is None:
            play(self._feed, delays, rates.machines, beginning, comparison, track)
        else:
            play_turning(
                self._feed, delays, rates.machines, rates.rotor_asymmetry, beginning, comparison, track
            )


def window_of_record(samples: int, sample_rate_hz: float, frequency_hz: float, longest_s: float) -> Window:
    """Choose the window at the end of a record.

    Left out are a cycle in front, to which a delay of up to one cycle reaches back, and half a cycle behind
    for a delay that is an advance. One cycle more is left to the model to settle.

    Parameters
    ----------
    samples : int
        Length of the record.
    sample_rate_hz : float
        Sampling rate [Hz].
    frequency_hz : float
        Supply frequency [Hz].
    longest_s : float
        Longest part that is compared [s].

    Returns
    -------
    Window
        The window.
    """
    cycle = sample_rate_hz / frequency_hz
    first = int(np.ceil(cycle)) + DELAY_MARGIN_COLUMNS
    last = samples - int(np.ceil(cycle / 2)) - DELAY_MARGIN_COLUMNS
    first = max(first, last - round(longest_s * sample_rate_hz) - int(np.ceil(cycle)))
    return Window(first, last, first + int(np.ceil(cycle)))


def electrical_to_rpm(speed: Array, pole_pairs: int) -> Array:
    """Convert electrical angular speed into shaft speed.

    Parameters
    ----------
    speed : ndarray
        Electrical angular speed, of any shape [rad/s].
    pole_pairs : int
        Number of pole pairs.

    Returns
    -------
    ndarray
        Shaft speed [rpm].
    """
    return speed / pole_pairs * 60.0 / (2.0 * pi)
