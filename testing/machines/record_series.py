"""A motor's records over time as COMTRADE files, from the tests' independent model."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from core.machines.parameters import Motor
from core.recordings import comtrade
from core.units import NANOSECONDS_PER_SECOND
from testing.machines.phase_circuits import Fault, recording, running

BEGUN_NS = 1_767_603_600 * NANOSECONDS_PER_SECOND
HOUR_NS = 3600 * NANOSECONDS_PER_SECOND


def write_series(
    folder: Path,
    motor: Motor,
    count: int,
    *,
    fault: Callable[[int], Fault | None] = lambda _: None,
    seed: int = 1,
    first: int = 0,
) -> list[Path]:
    """Write hourly records R0000.CFG, ... of a motor whose load and supply vary and whose relay has errors.

    fault: of each record by its number.
    """
    rng = np.random.default_rng(seed)
    written = []
    for k in range(first, first + count):
        operation = running(
            motor,
            rng.uniform(0.4, 0.9),
            fault=fault(k),
            unbalance=0.01 * complex(rng.standard_normal(), rng.standard_normal()),
        )
        record = recording(
            operation,
            sample_rate_hz=4_000.0,
            seconds=0.3,
            noise=0.002,
            current_gains=(1.0, 1.004, 0.997),
            seed=seed + k,
        )
        channels = tuple(
            replace(channel, full_scale=2.0 * float(np.abs(x).max()))
            for channel, x in zip(record.channels, record.samples, strict=True)
        )
        record = replace(record, channels=channels, start_time_ns=BEGUN_NS + k * HOUR_NS)
        written.append(comtrade.write(folder / f"R{k:04d}.CFG", record))
    return written
