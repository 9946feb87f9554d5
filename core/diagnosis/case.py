"""One recording of one motor, brought into the form every stage works on.

Stages see winding quantities in a positive-sequence world: a delta is turned into its windings, and a supply
of sequence a-c-b is mirrored, so that rotation, slip and load always count positive. The winding a stage
names is turned back into the terminals' labels on the way out.
"""

from dataclasses import dataclass, replace
from math import pi, sqrt
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array
from core.machines.parameters import Connection, Motor
from core.machines.playback import Window, window_of_record
from core.machines.supply import Supply, supply
from core.signals.clarke import clarke
from core.signals.decimation import decimate
from core.signals.phasors import fundamental_phasors
from core.signals.sequence import PhaseSequence

LONGEST_WINDOW_S, LONGEST_RECORD_S = 1.0, 1.2
"""What is compared, and what is looked at: with it the cycles before and behind that delays reach to."""
FEWEST_SAMPLES_A_CYCLE = 40
"""Of a thinned record: up to the 13th harmonic its shape is kept."""
Winding = Literal[0, 1, 2]

_TURNED: dict[tuple[Connection, PhaseSequence], tuple[Winding, Winding, Winding]] = {
    (Connection.STAR, PhaseSequence.ABC): (0, 1, 2),
    (Connection.DELTA, PhaseSequence.ABC): (0, 1, 2),
    # Mirroring swaps terminals b and c: in delta the windings a-b and c-a change places.
    (Connection.STAR, PhaseSequence.ACB): (0, 2, 1),
    (Connection.DELTA, PhaseSequence.ACB): (2, 1, 0),
}


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
        return _TURNED[self.motor.nameplate.connection, self.sequence][winding]

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
    current_ab, voltage_ab = winding_frame(
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


def winding_frame(
    current_ab: Array, voltage_ab: Array, sequence: PhaseSequence, connection: Connection
) -> tuple[Array, Array]:
    """Currents and voltages of the windings, positive sequence, from those of the terminals, all (2, n)."""
    if sequence is PhaseSequence.ACB:
        mirror = np.array([[1.0], [-1.0]])
        current_ab, voltage_ab = mirror * current_ab, mirror * voltage_ab
    if connection is Connection.DELTA:
        # v_ab = v_a - v_b and i_a = i_ab - i_ca turn and stretch the space vectors by sqrt 3 and 30 degrees.
        ahead = _rotation(pi / 6.0)
        current_ab, voltage_ab = ahead @ current_ab / sqrt(3.0), ahead @ voltage_ab * sqrt(3.0)
    return current_ab, voltage_ab


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


def _rotation(angle: float) -> Array:
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
