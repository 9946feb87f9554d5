"""Observations for tests of the storage: figures of a healthy motor, of which one tells the record."""

from dataclasses import replace

from core.condition.observation import Observation, VoltageChannels
from core.signals.sequence import PhaseSequence
from core.units import NANOSECONDS_PER_SECOND
from testing.service.plants import NOW_NS

HOUR_NS = 3600 * NANOSECONDS_PER_SECOND

OBSERVATION = Observation(
    time_ns=NOW_NS,
    recorder="A1_SEL710 100:1",
    sequence=PhaseSequence.ABC,
    voltage_channels=VoltageChannels.PHASE,
    frequency_hz=50.02,
    positive_voltage_V=325.0 + 1.5j,
    negative_voltage_V=-1.25 + 0.5j,
    zero_voltage_V=0.1 - 0.3j,
    positive_current_A=2.1 - 1.3j,
    negative_current_A=0.02 + 0.011j,
    zero_current_A=1e-3 + 2e-3j,
    scatter=1.2e-8,
    cycles=12,
    load_level=0.48,
)


def observation(hour: float, negative_voltage_V: complex = OBSERVATION.negative_voltage_V) -> Observation:
    """The observation of a record so many hours after NOW_NS."""
    time_ns = NOW_NS + round(hour * HOUR_NS)
    return replace(OBSERVATION, time_ns=time_ns, negative_voltage_V=negative_voltage_V)
