"""COMTRADE 1999 binary: our strict reader against PyPI's comtrade."""

import tempfile
import tracemalloc
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import comtrade as peer
import numpy as np

from benchmarks.stopwatch import best_of
from core.recordings import Channel, Digitals, Quantity, Recording, comtrade, read
from testing.machines.motors import REFERENCE
from testing.machines.phase_circuits import recording, running


def measure() -> Iterator[str]:
    record = recording(running(REFERENCE, 0.5), seconds=1.0)
    channels = tuple(replace(channel, full_scale=1000.0) for channel in record.channels)
    with tempfile.TemporaryDirectory() as folder:
        path = comtrade.write(Path(folder) / "second.cfg", replace(record, channels=channels))
        yield f"1 s x 10 kHz x 6 channels: {_compared(path, rounds=10)}"
        path = comtrade.write(Path(folder) / "minute.cfg", _minute())
        yield f"60 s x 10 kHz x 6 channels and 32 states: {_compared(path, rounds=3)}"
        size = path.with_suffix(".dat").stat().st_size
        tracemalloc.start()
        read(path)
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        yield f"its {size / 1e6:.1f} MB take {peak / 1e6:.1f} MB to read: {peak / size:.2f} times"


def _compared(path: Path, rounds: int) -> str:
    ours = best_of(rounds, lambda: read(path))
    theirs = best_of(min(rounds, 3), lambda: peer.load(str(path)))
    numpy = best_of(min(rounds, 3), lambda: peer.load(str(path), use_numpy_arrays=True))
    return (
        f"ours {ours * 1e3:.1f} ms, comtrade {theirs * 1e3:.0f} ms (with numpy {numpy * 1e3:.0f} ms): "
        f"{theirs / ours:.0f} ({numpy / ours:.0f}) times faster"
    )


def _minute() -> Recording:
    rng = np.random.default_rng(1)
    samples = 600_000
    return Recording(
        samples=rng.uniform(-1, 1, (6, samples)),
        sample_rate_hz=10_000.0,
        start_time_ns=0,
        channels=tuple(Channel(name, Quantity.CURRENT, None, "A", 1.0) for name in "ABCDEF"),
        trigger_index=samples // 2,
        digitals=Digitals.of(tuple(f"S{k}" for k in range(32)), rng.random((samples, 32)) > 0.5),
    )
