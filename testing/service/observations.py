"""Observations for tests of the storage: figures of a healthy motor, of which one tells the record."""

from dataclasses import replace
from math import pi

import numpy as np

from core.condition.measuring.impedance import WARM
from core.condition.observation import Observation, VoltageChannels
from core.machines.coil_fault import AirGap, SequencePair, air_gap, faulty_currents
from core.signals.sequence import PhaseSequence
from core.units import NANOSECONDS_PER_SECOND
from testing.machines.motors import REFERENCE
from testing.service.plants import NOW_NS

HOUR_NS = 3600 * NANOSECONDS_PER_SECOND
LEVEL = 0.02

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


def records_of_a_motor(number: int, *, fault_from: int | None = None, seed: int = 1) -> list[Observation]:
    """Hourly records of the demo plant's motor on a supply that wanders, at loads from little to rated.

    From a record on it has shorted turns of an equivalent level of 2 %. Its currents are those of its
    equivalent circuit, so that its parameters stay what they are.
    """
    rng = np.random.default_rng(seed)
    Z2 = complex(15.0, 20.5)
    standing = 0.002 + 0.001j
    records = []
    for at in range(number):
        v2 = 0.008 * rng.random() * np.exp(2j * np.pi * rng.random())
        noise = 2e-4 * complex(*rng.normal(size=2))
        gap = _air_gap(slip=rng.uniform(0.01, 0.05))
        I1, I2 = 310.0 / (gap.stator + gap.forward), complex(310.0 * (v2 + standing) / Z2)
        if fault_from is not None and at >= fault_from:
            seen = SequencePair(310.0 + 0j, 0j)
            faulty = faulty_currents(gap, seen, gap.stator / LEVEL, 1.0 + 0j, 1.0 + 0j, 0.0, 0)
            I1, I2 = faulty.positive, I2 + faulty.negative
        records.append(
            replace(
                OBSERVATION,
                time_ns=NOW_NS + at * HOUR_NS,
                positive_voltage_V=310.0 + 0.0j,
                negative_voltage_V=complex(310.0 * (v2 + noise)),
                positive_current_A=I1,
                negative_current_A=I2,
            )
        )
    return records


def _air_gap(slip: float) -> AirGap:
    """Return the impedances of the demo plant's warm motor."""
    machine = REFERENCE.parameters
    w = 2.0 * pi * OBSERVATION.frequency_hz
    return air_gap(
        complex(WARM * machine.stator_resistance_ohm, w * machine.stator_leakage_H),
        w * machine.magnetising_inductance_H,
        WARM * machine.rotor_resistance_ohm,
        w * machine.rotor_leakage_H,
        slip,
    )
