"""A record in eight numbers: the ratios of its phasors that hypotheses are compared with, and their noise.

Only ratios to the positive-sequence voltage count. The negative- and zero-sequence voltages say what the
supply and the voltage channels do, the zero-sequence current what the current channels do: three lines into a
motor carry none.
"""

from dataclasses import dataclass
from math import sqrt
from typing import Final

import numpy as np

from core.diagnosis.case import Case
from core.diagnosis.channel_errors import SIXTH
from core.diagnosis.fundamental import Fundamental, phasors_of
from core.machines.base import Array
from core.machines.parameters import Connection, Nameplate
from core.signals.sequence import PhaseSequence
from core.signals.terminals import Terminals, VoltageChannels

PHASE_PER_SPACE_VECTOR: Final = sqrt(2.0 / 3.0)
"""Phasor of a phase over that of the power-invariant space vector."""


@dataclass(frozen=True, slots=True)
class RecordFigures:
    """Ratios of one record, as the windings in a positive-sequence supply see them.

    Parameters
    ----------
    angular_frequency : float
        w_s [rad/s].
    positive_voltage_V : float
        |V1| of a winding, peak of the space vector's forward phasor [V].
    relative_voltage : float
        V1 over the rated one.
    admittance : complex
        I1 / V1 [S].
    negative_current_S : complex
        I2 / V1 [S].
    negative_voltage : complex
        V2 / V1.
    zero_voltage : complex or None
        V0 / V1 of the terminals; None where no phase voltages are measured.
    zero_current : complex
        I0 / I1 of the terminals.
    sequence : PhaseSequence
        Order of the supply's phases at the terminals.
    voltage_channels : VoltageChannels or None
        Which voltages are measured; None where they are assumed.
    noise : ndarray, shape (6, 6)
        Covariance of re and im of I1/V1, I2/V1 and V2/V1 by the record's own scatter.
    cycles : int
        Number of cycles that the phasors are taken from.
    """

    angular_frequency: float
    positive_voltage_V: float
    relative_voltage: float
    admittance: complex
    negative_current_S: complex
    negative_voltage: complex
    zero_voltage: complex | None
    zero_current: complex
    sequence: PhaseSequence
    voltage_channels: VoltageChannels | None
    noise: Array
    cycles: int

    def relative_flux(self, nameplate: Nameplate) -> float:
        """Return the flux over that of rated voltage and frequency."""
        return self.relative_voltage * nameplate.rated_angular_frequency / self.angular_frequency


def figures_of(terminals: Terminals, case: Case, record: Fundamental) -> RecordFigures:
    """Take the ratios from a record's phasors."""
    zero = zero_sequence(terminals, case)
    V1, I1 = record.voltage.forward, record.current.forward
    V2 = record.voltage.backward.conjugate()
    I2 = record.current.backward.conjugate()
    plate = case.motor.nameplate
    delta = plate.connection is Connection.DELTA
    # The power-invariant space vector of a star is as long as the rms voltage of the line.
    rated_V = plate.rated_voltage_V * (sqrt(3.0) if delta else 1.0)
    per_phase = PHASE_PER_SPACE_VECTOR
    v0_turn = SIXTH * sqrt(3.0) if delta else 1.0 + 0.0j
    i0_turn = SIXTH / sqrt(3.0) if delta else 1.0 + 0.0j
    return RecordFigures(
        angular_frequency=record.angular_frequency,
        positive_voltage_V=abs(V1),
        relative_voltage=abs(V1) / rated_V,
        admittance=I1 / V1,
        negative_current_S=I2 / V1,
        negative_voltage=V2 / V1,
        zero_voltage=None if zero.voltage is None else zero.voltage / (per_phase * V1) * v0_turn,
        zero_current=zero.current / (per_phase * I1) * i0_turn,
        sequence=case.sequence,
        voltage_channels=None if case.voltages_assumed else terminals.voltages_measured,
        noise=_noise(record),
        cycles=record.cycles,
    )


@dataclass(frozen=True, slots=True)
class ZeroSequence:
    """Zero-sequence phasors of the terminals, at the instant of the record's other phasors.

    Parameters
    ----------
    voltage : complex or None
        V0, peak [V]; None where no phase voltages are measured.
    current : complex
        I0, peak [A].
    """

    voltage: complex | None
    current: complex


def zero_sequence(terminals: Terminals, case: Case) -> ZeroSequence:
    """Find the zero-sequence phasors of a record."""
    zero = [terminals.current_abc.mean(axis=0)]
    if terminals.voltages_measured is VoltageChannels.PHASE:
        zero.append(terminals.voltages.mean(axis=0))
    current, *voltage = phasors_of(np.stack(zero), case)
    return ZeroSequence(complex(voltage[0]) if voltage else None, complex(current))


def _noise(record: Fundamental) -> Array:
    """Covariance of re, im of I1/V1, I2/V1, V2/V1: each ratio is linear in small errors of its phasors."""
    V1, I1 = record.voltage.forward, record.current.forward
    I2, V2 = record.current.backward.conjugate(), record.voltage.backward.conjugate()
    of_current, of_voltage = np.zeros((6, 4)), np.zeros((6, 4))
    for column, unit in enumerate((1.0 + 0.0j, 1j)):
        # The backward phasors' conjugates are I2 and V2.
        parts = (
            (of_current, column, (unit / V1, 0j, 0j)),
            (of_current, 2 + column, (0j, unit.conjugate() / V1, 0j)),
            (of_voltage, column, (-I1 / V1**2 * unit, -I2 / V1**2 * unit, -V2 / V1**2 * unit)),
            (of_voltage, 2 + column, (0j, 0j, unit.conjugate() / V1)),
        )
        for matrix, at, ratios in parts:
            matrix[:, at] = [part for one in ratios for part in (one.real, one.imag)]
    current, voltage = record.current.covariance, record.voltage.covariance
    return np.asarray(of_current @ current @ of_current.T + of_voltage @ voltage @ of_voltage.T)
