"""One recording of one motor, in the form on which every stage of the diagnosis works.

Stages see winding quantities in a positive-sequence supply (core.machines.winding_frame). The winding that a
stage names is turned back into the terminals' labels on the way out.
"""

from dataclasses import dataclass, replace
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array
from core.machines.parameters import Connection, Motor
from core.machines.playback import Window, window_of_record
from core.machines.stator_winding import Winding
from core.machines.supply import Supply, supply
from core.machines.winding_frame import terminal_winding, to_winding_frame
from core.signals.clarke import clarke
from core.signals.decimation import decimate
from core.signals.phasors import fundamental_phasors
from core.signals.sequence import PhaseSequence

LONGEST_WINDOW_S, LONGEST_RECORD_S = 1.0, 1.2
"""What is compared, and what is looked at: with it the cycles before and behind that delays reach to."""
FEWEST_SAMPLES_A_CYCLE = 40
"""Samples a cycle of a thinned record; they show its waveform up to the 13th harmonic."""


@dataclass(frozen=True, slots=True)
class Case:
    """One record in the winding frame: what the search and the refinement work on.

    Parameters
    ----------
    motor : Motor
        Nameplate, parameters, channel names and limits of the motor.
    supply : Supply
        Stator voltage on the models' time base.
    current_ab, voltage_ab : ndarray, shape (2, n)
        Winding quantities on Clarke axes [A, V].
    sample_rate_hz : float
        Sampling rate [Hz].
    frequency_hz : float
        Supply frequency [Hz].
    sequence : PhaseSequence
        Order of the supply's phases before mirroring.
    window : Window
        Part of the record that is simulated.
    voltages_assumed : bool, default False
        Whether no voltages were recorded.
    """

    motor: Motor
    supply: Supply
    current_ab: Array
    voltage_ab: Array
    sample_rate_hz: float
    frequency_hz: float
    sequence: PhaseSequence
    window: Window
    voltages_assumed: bool = False

    @property
    def line_per_winding_current(self) -> float:
        """Line current over winding current: sqrt 3 in delta, 1 in star."""
        return sqrt(3.0) if self.motor.nameplate.connection is Connection.DELTA else 1.0

    @property
    def samples_compared(self) -> int:
        """Samples of the record that enter the cost."""
        return self.window.last - self.window.compare_from

    def terminal_winding(self, winding: int) -> Winding:
        """Return the number under which the terminals know a winding."""
        return terminal_winding(winding, self.sequence, self.motor.nameplate.connection)

    def space_vector(self, x_ab: Array) -> NDArray[np.complex128]:
        """Return x_alpha + j x_beta over the compared samples."""
        compared = x_ab[:, self.window.compare_from - self.window.first :]
        return np.asarray(compared[0] + 1j * compared[1], dtype=np.complex128)


def case_of(
    motor: Motor,
    current_abc: Array,
    voltage_ab: Array,
    sample_rate_hz: float,
    frequency_hz: float,
    sequence: PhaseSequence,
) -> Case:
    """Bring one record into the winding frame."""
    current_ab, voltage_ab = to_winding_frame(
        clarke(current_abc), voltage_ab, sequence, motor.nameplate.connection
    )
    phasor = sqrt(2.0) * fundamental_phasors(voltage_ab, frequency_hz, sample_rate_hz)
    return Case(
        motor=motor,
        supply=supply(voltage_ab, sample_rate_hz, frequency_hz, phasor),
        current_ab=current_ab,
        voltage_ab=voltage_ab,
        sample_rate_hz=sample_rate_hz,
        frequency_hz=frequency_hz,
        sequence=sequence,
        window=window_of_record(current_ab.shape[1], sample_rate_hz, frequency_hz, LONGEST_WINDOW_S),
    )


def thinned(case: Case) -> Case:
    """Return the same record at a lower sample rate, for a search that only has to come near.

    Voltages and currents pass the same zero-phase filter, and the models are linear at constant speed: what
    is true of the record is true of its filtered copy.
    """
    factor = int(case.sample_rate_hz / case.frequency_hz / FEWEST_SAMPLES_A_CYCLE)
    if factor < 2:
        return case
    current_ab = decimate(case.current_ab, factor)
    voltage_ab = decimate(case.voltage_ab, factor)
    rate = case.sample_rate_hz / factor
    return replace(
        case,
        supply=supply(voltage_ab, rate, case.frequency_hz, case.supply.phasor),
        current_ab=current_ab,
        voltage_ab=voltage_ab,
        sample_rate_hz=rate,
        window=window_of_record(current_ab.shape[1], rate, case.frequency_hz, LONGEST_WINDOW_S),
    )
