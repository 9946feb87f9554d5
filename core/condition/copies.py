"""Whether two observations are of one event, which a relay gave in two formats: it counts once.

A relay records one event at a time, so that records of one recorder and one trigger time differ in nothing
but how finely their format has the values.
"""

from core.condition.observation import Observation
from core.units import NANOSECONDS_PER_MILLISECOND

SAME_TIME_NS = NANOSECONDS_PER_MILLISECOND
"""Formats have the trigger time to a millisecond at least."""
SAME = 1e-3
"""Largest difference of the phasors of two formats, over the positive sequence."""


def is_copy(one: Observation, other: Observation) -> bool:
    """Tell whether two observations are of one event of one recorder.

    Parameters
    ----------
    one, other : Observation
        The observations.

    Returns
    -------
    bool
        Whether they agree in recorder, time and waveform, to the quantisation of their formats.
    """
    beside = (one.recorder, one.sequence, one.voltage_channels, one.cycles)
    if beside != (other.recorder, other.sequence, other.voltage_channels, other.cycles):
        return False
    if abs(one.time_ns - other.time_ns) >= SAME_TIME_NS:
        return False
    volts, amps = abs(one.positive_voltage_V), abs(one.positive_current_A)
    return all(
        abs(a - b) <= SAME * unit
        for a, b, unit in zip(_phasors(one), _phasors(other), (volts, volts, amps, amps), strict=True)
    )


def _phasors(observation: Observation) -> tuple[complex, complex, complex, complex]:
    """Return the sequences, turned so that the positive voltage is real: their common angle is free."""
    volts = abs(observation.positive_voltage_V)
    turn = observation.positive_voltage_V.conjugate() / volts if volts else 1.0
    return (
        observation.positive_voltage_V * turn,
        observation.negative_voltage_V * turn,
        observation.positive_current_A * turn,
        observation.negative_current_A * turn,
    )
