"""Observations of a motor whose load and supply vary, from its T circuit, and what may happen to it."""

from dataclasses import replace
from math import pi

import numpy as np

from core.condition.observation import Observation
from core.machines.parameters import MachineParameters
from testing.service.observations import HOUR_NS, OBSERVATION
from testing.service.plants import NOW_NS

VOLTAGE_V, NOISE = 310.0, 1e-4
SLIPS = (0.01, 0.055)


def tracked_records(
    machine: MachineParameters,
    number: int,
    *,
    wrong_from: int | None = None,
    ratio: float = 1.05,
    seed: int = 3,
) -> list[Observation]:
    """Return hourly records at random loads; from one on the currents are read too small by a ratio."""
    random = np.random.default_rng(seed)
    w = 2.0 * pi * OBSERVATION.frequency_hz
    records = []
    for at in range(number):
        slip = random.uniform(*SLIPS)
        read_V = VOLTAGE_V if wrong_from is None or at < wrong_from else VOLTAGE_V / ratio
        unbalance = 0.004 * complex(*random.normal(size=2))
        first, second = NOISE * (random.normal(size=2) + 1j * random.normal(size=2))
        records.append(
            replace(
                OBSERVATION,
                time_ns=NOW_NS + at * HOUR_NS,
                positive_voltage_V=VOLTAGE_V + 0j,
                negative_voltage_V=VOLTAGE_V * unbalance,
                positive_current_A=complex(read_V * (1.0 + first) / _impedance(machine, w, slip)),
                negative_current_A=complex(
                    read_V * (unbalance + second) / _impedance(machine, w, 2.0 - slip)
                ),
                load_level=slip / SLIPS[1],
            )
        )
    return records


def _impedance(machine: MachineParameters, w: float, slip: float) -> complex:
    rotor = machine.rotor_resistance_ohm / slip + 1j * w * machine.rotor_leakage_H
    magnetising = 1j * w * machine.magnetising_inductance_H
    stator = machine.stator_resistance_ohm + 1j * w * machine.stator_leakage_H
    return stator + rotor * magnetising / (rotor + magnetising)
