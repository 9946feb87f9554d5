"""What one record tells about its motor's condition: 24 numbers, kept for every record."""

from dataclasses import dataclass
from typing import Final

from core.signals.sequence import PhaseSequence
from core.signals.terminals import VoltageChannels
from core.units import NANOSECONDS_PER_SECOND

__all__ = ["SAME_SUPPLY_WITHIN_NS", "Observation", "VoltageChannels"]

SAME_SUPPLY_WITHIN_NS: Final = 60 * NANOSECONDS_PER_SECOND
"""Records of a bus that are no further apart than this have the same supply."""


@dataclass(frozen=True, slots=True)
class Observation:
    """Phasors of one record at supply frequency, and how far they may be trusted.

    The phasors are those of windings in a positive-sequence supply (`core.machines.winding_frame`): mirrored
    where the supply turns a-c-b, turned into windings in delta. Their common angle is free: only ratios to
    `positive_voltage_V` count.

    Parameters
    ----------
    time_ns : int
        Trigger time of the record, UTC [ns].
    recorder : str
        What measured: relay and ratios of its transformers. Another text means other sensors.
    sequence : PhaseSequence
        Order of the supply's phases at the terminals.
    voltage_channels : VoltageChannels
        Which voltages were measured.
    frequency_hz : float
        Supply frequency [Hz].
    positive_voltage_V, negative_voltage_V : complex
        V1 and V2 of the windings, peak [V].
    zero_voltage_V : complex or None
        V0 of the terminals, peak [V]; None where no phase voltages were measured.
    positive_current_A, negative_current_A : complex
        I1 and I2 of the windings, peak [A].
    zero_current_A : complex
        I0 of the terminals' line currents, peak [A].
    scatter : float
        Variance of y = V2/V1 - Z2 I2/V1 (complex, both parts together) from the record's own noise.
    cycles : int
        Number of cycles that the phasors are taken from.
    load_level : float or None
        Load torque over rated torque, from the power that crosses the air gap; losses of shorted turns count
        as load. None where it is not known.
    """

    time_ns: int
    recorder: str
    sequence: PhaseSequence
    voltage_channels: VoltageChannels
    frequency_hz: float
    positive_voltage_V: complex
    negative_voltage_V: complex
    zero_voltage_V: complex | None
    positive_current_A: complex
    negative_current_A: complex
    zero_current_A: complex
    scatter: float
    cycles: int
    load_level: float | None = None
