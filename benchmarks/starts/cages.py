"""Broken bars in a start: how often the sideband's path shows them, by run-up and number of bars."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import log10
from typing import Final

import numpy as np

from core.commissioning.errors import CommissioningError
from core.commissioning.start_detection import start_of
from core.machines.parameters import Motor
from core.rotor.finding import RotorState
from core.rotor.start_finding import StartSideband
from core.rotor.starts import start_sideband
from core.starts.measuring import measure_start
from testing.machines.motors import LARGE, MEDIUM, REFERENCE, VERY_LARGE
from testing.machines.starts import StartRecord, with_parameters

Generator = np.random.Generator
BARS: Final = 28
MOTORS: Final = (
    ("800 W", REFERENCE, 1.0, 1.5, (0.1, 0.7)),
    ("800 W", REFERENCE, 4.0, 2.5, (0.1, 0.7)),
    ("7.5 kW", MEDIUM, 16.0, 2.0, (0.1, 0.7)),
    ("37 kW", LARGE, 4.0, 2.5, (0.1, 0.5)),
    ("250 kW", VERY_LARGE, 1.0, 3.5, (0.02, 0.15)),
)
"""Name, motor, inertias, length of the record [s], and range of the load."""
PARAMETER_ERROR: Final = 0.03
"""Standard deviation of the parameters that the examination knows, as commissioning leaves them at most."""


@dataclass(frozen=True, slots=True)
class Row:
    """What starts of one motor with so many broken bars showed."""

    motor: str
    run_up_s: float
    bars: int
    states: Counter[RotorState]
    error_dB: float | None
    covered: int


def measure(repeats: int, *, seed: int = 2026) -> Iterator[Row]:
    """Yield what starts show, by motor and number of broken bars."""
    for number, (name, motor, inertias, duration_s, loads) in enumerate(MOTORS):
        driving = with_parameters(motor, inertia_kgm2=inertias * motor.parameters.inertia_kgm2)
        random = np.random.default_rng([seed, number])
        for bars in range(4):
            found, lasted_s = [], []
            for _ in range(repeats):
                record = _record(random, duration_s, loads, bars)
                sideband, run_up_s = _sideband(record, driving, random)
                found.append(sideband)
                lasted_s.append(run_up_s)
            yield _row(f"{name}, {inertias:g} J", found, lasted_s, bars)


def _record(random: Generator, duration_s: float, loads: tuple[float, float], bars: int) -> StartRecord:
    return StartRecord(
        load_level=float(random.uniform(*loads)),
        duration_s=duration_s,
        switched_at_s=0.02 * float(random.uniform()),
        snr_db=float(random.uniform(35.0, 55.0)),
        voltage_snr_db=60.0,
        voltage=float(random.uniform(0.9, 1.05)),
        unbalance=float(random.uniform(0.0, 0.02)),
        broken_bars=bars / BARS,
        seed=int(random.integers(2**31)),
    )


def _sideband(record: StartRecord, motor: Motor, random: Generator) -> tuple[StartSideband, float]:
    recording = record.of(motor)
    figures = measure_start(recording, motor)
    try:
        start = start_of(recording, motor.nameplate, motor.channels)
    except CommissioningError as refused:  # a motor that hangs at half of its speed looks wired wrongly
        return StartSideband(RotorState.UNSUPPORTED, None, None, None, 0, (str(refused),)), figures.i2t_over_s
    parameters = motor.parameters

    def off() -> float:
        return 1.0 + PARAMETER_ERROR * float(random.standard_normal())

    known = replace(
        parameters,
        stator_resistance_ohm=off() * parameters.stator_resistance_ohm,
        rotor_resistance_ohm=off() * parameters.rotor_resistance_ohm,
        stator_leakage_H=off() * parameters.stator_leakage_H,
        rotor_leakage_H=off() * parameters.rotor_leakage_H,
    )
    run_up_s = figures.acceleration_s or figures.i2t_over_s
    return start_sideband(start.air_gap(known), known, run_up_s), run_up_s


def _row(motor: str, found: list[StartSideband], lasted_s: list[float], bars: int) -> Row:
    told = [one for one in found if one.state in (RotorState.WATCH, RotorState.FAULT)]
    true_dB = 20.0 * log10(bars / BARS) if bars else None
    errors = [
        one.severity_dB - true_dB for one in told if true_dB is not None and one.severity_dB is not None
    ]
    covered = sum(
        one.severity_dB_ci95 is not None
        and true_dB is not None
        and (one.severity_dB_ci95[0] is None or one.severity_dB_ci95[0] <= true_dB)
        and true_dB <= one.severity_dB_ci95[1]
        for one in told
    )
    return Row(
        motor,
        float(np.median(lasted_s)),
        bars,
        Counter(one.state for one in found),
        float(np.sqrt(np.mean(np.square(errors)))) if errors else None,
        covered,
    )
