"""One recording of one motor, brought into the form every stage works on.

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
from core.machines.supply import Supply, supply
from core.machines.winding_frame import Winding, terminal_winding, to_winding_frame
from core.signals.clarke import clarke
from core.signals.decimation import decimate
from core.signals.phasors import fundamental_phasors
from core.signals.sequence import PhaseSequence

LONGEST_WINDOW_S, LONGEST_RECORD_S = 1.0, 1.2
"""What is compared, and what is looked at: with it the cycles before and behind that delays reach to."""
FEWEST_SAMPLES_A_CYCLE = 40
"""Of a thinned record: up to the 13th harmonic its shape is kept."""


@dataclass(frozen=True, slots=True)
class Case:
    """What the search and the refinement work on.

    current_ab, voltage_ab: of the windings on the Clarke axes, shape (2, n) [A, V]; line_per_winding_current
    turns the current's magnitude into that of the lines (sqrt 3 in delta).
    sequence: that of the supply, before mirroring.  voltages_assumed: none were recorded.
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
        return sqrt(3.0) if self.motor.nameplate.connection is Connection.DELTA else 1.0

    @property
    def samples_compared(self) -> int:
        """Samples of the record that enter the cost."""
        return self.window.last - self.window.compare_from

    def terminal_winding(self, winding: int) -> Winding:
        """The winding as the terminals label it."""
        return terminal_winding(winding, self.sequence, self.motor.nameplate.connection)

    def space_vector(self, x_ab: Array) -> NDArray[np.complex128]:
        """x_alpha + j x_beta over the compared samples, from values over the window, shape (2, window)."""
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
    """Winding quantities in a positive-sequence world; inputs as measured at the terminals."""
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
    """The same case at a lower sample rate, for a search that only has to come near.

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
