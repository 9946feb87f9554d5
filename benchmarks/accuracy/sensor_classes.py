"""What one record tells, by the class of the sensors that the motor's file names."""

from collections.abc import Iterator
from concurrent.futures import Executor
from dataclasses import replace

import numpy as np

from benchmarks.accuracy.alarms import LEVEL_BANDS, STATED, Draw, count, draws_of, found_by_level
from benchmarks.reporting import table
from core.diagnosis.verdict import Verdict
from core.machines.sensors import SensorClass
from testing.machines.motors import REFERENCE

CLASSES = ((0.01, 50e-6), (0.01, 25e-6), (0.005, 25e-6), (0.002, 10e-6), (0.001, 5e-6))
"""Spans of gains and of delays [s], the same for voltages and currents."""
SHOWN_BANDS = LEVEL_BANDS[:4]


def sensor_classes(*, records: int, pool: Executor) -> Iterator[str]:
    """Healthy and faulty records whose channels err within the class that the diagnosis is told."""
    rows = []
    for gain, delay_s in CLASSES:
        motor = replace(REFERENCE, sensors=SensorClass(gain, gain, delay_s, delay_s))
        name = f"{gain:.1%}, {delay_s * 1e6:.0f} us"
        prototype = Draw(motor, 0, faulty=False, factors=STATED, cycles=25.0, sample_rate_hz=10_000.0)
        healthy = count(draws_of(prototype, records), f"{name} healthy", pool)
        faulty = count(draws_of(replace(prototype, faulty=True), records), f"{name} faulty", pool)
        limits = [one.diagnosis.detection_limit for one in healthy.outcomes]
        told = [limit for limit in limits if limit is not None]
        verdicts = ", ".join(
            f"{healthy.verdicts[one]} {one.value}" for one in (Verdict.HEALTHY, Verdict.WATCH, Verdict.FAULT)
        )
        found = found_by_level(faulty, SHOWN_BANDS)
        rows.append([f"+-{name}", f"{np.median(told):.2%}" if told else "none", verdicts, *found])
    bands = (f"{low:.1%} to {high:.1%}" for low, high in SHOWN_BANDS)
    yield from table(["gain, delay", "detection limit, median", "healthy records called", *bands], rows)
